"""How long a person waits for nine faces: ``python -m benchmarks.tuning.page``.

Vector muscles with all their genes (asked: 0.3 s) and the intensities of a layered face (asked:
2 s), on the real head, warm. The ratio is that to faces made and drawn one after the other, each
in full, in the same run.
"""

from __future__ import annotations

import argparse
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from time import perf_counter, process_time

import numpy as np

from benchmarks.expressive.truths import Truths
from risorius.cli.tuning_pictures import FacePage
from risorius.controls.presets import default_presets
from risorius.errors import RisoriusWarning
from risorius.head.head import Head
from risorius.layered.face import LayeredFace
from risorius.render.heads import Portrait
from risorius.render.picture import render
from risorius.render.png import write_png
from risorius.render.sheet import contact_sheet
from risorius.tuning import Candidates, MuscleCandidates, PoseCandidates, Session
from risorius.tuning.candidates import Gallery
from risorius.vectormuscle import VectorFace
from risorius.vectormuscle.export_points import find_features
from tests.tools import real_data_folder

_ROUNDS = 7
_LABELS = [str(number + 1) for number in range(9)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=None, help="folder of the real heads")
    parser.add_argument("--expressions", nargs="*", default=["joy", "anger"])
    parser.add_argument("--methods", nargs="*", default=["vector", "layered"])
    options = parser.parse_args()
    warnings.simplefilter("ignore", RisoriusWarning)
    head = Truths.load((options.data or real_data_folder()) / "ict_facekit").head()
    page = FacePage(head)
    for method in options.methods:
        make = {"vector": vector, "layered": layered}[method]
        for expression, candidates in make(head, options.expressions).items():
            session = Session(candidates.genome)
            with tempfile.TemporaryDirectory() as folder:
                report(f"{method} {expression}", candidates, session, page, Path(folder))


def vector(head: Head, expressions: list[str]) -> dict[str, Candidates]:
    face, presets = VectorFace.build(head), default_presets()
    width = find_features(head).width
    made: dict[str, Candidates] = {}
    for name in expressions:
        pose = presets.fit(presets.emotions[name], face.controls).pose
        muscles = tuple(muscle for muscle in pose if muscle in face.bound)
        made[name] = MuscleCandidates(face, muscles, pose, width, genes="all")
    return made


def layered(head: Head, expressions: list[str]) -> dict[str, Candidates]:
    face, presets = LayeredFace.build(head), default_presets()
    fitted = {name: presets.fit(presets.emotions[name], face.controls).pose for name in expressions}
    return {name: PoseCandidates(face, pose) for name, pose in fitted.items()}


def report(
    title: str, candidates: Candidates, session: Session, page: FacePage, folder: Path
) -> None:
    """Print milliseconds and the ratio; the pictures of both ways must be alike."""
    rows = session.generation.candidates
    path = folder / "nine.png"
    portrait = Portrait.of(page.head)
    camera = portrait.camera(page.view)

    def pictures(posed: list[np.ndarray]) -> list[np.ndarray]:
        return [render(portrait.surfaces(each), camera, size=page.size) for each in posed]

    def quick() -> None:
        page.write(path, Gallery(candidates).faces(rows), _LABELS, title=title)

    def slow() -> None:
        genome = candidates.genome
        posed = [candidates.positions(genome.named(row)) for row in rows]
        write_png(path, contact_sheet(pictures(posed), _LABELS, columns=3, title=title))

    posed = Gallery(candidates).faces(rows)
    apart = np.abs(
        np.stack(page.series.pictures(posed)).astype(int) - np.stack(pictures(posed)).astype(int)
    )
    assert (apart.max(axis=-1) > 16).mean() < 0.002, "the quick pictures are others"
    faces = seconds(lambda: Gallery(candidates).faces(rows))
    whole, before = seconds(quick), seconds(slow)
    print(
        f"{title:16} {len(candidates.genome)} genes: nine faces {_told(faces)}, with their page "
        f"{_told(whole)}, one after the other {_told(before)}; ratio {before[0] / whole[0]:.1f}",
        flush=True,
    )


def seconds(work: Callable[[], object]) -> tuple[float, float]:
    """Return the least time that `work` takes, warm, and its least time on the processor."""
    work()
    taken: list[tuple[float, float]] = []
    for _ in range(_ROUNDS):
        start, busy = perf_counter(), process_time()
        work()
        taken.append((perf_counter() - start, process_time() - busy))
    return min(wall for wall, _ in taken), min(busy for _, busy in taken)


def _told(both: tuple[float, float]) -> str:
    return f"{1e3 * both[0]:.0f} ms ({1e3 * both[1]:.0f} ms of processor)"


if __name__ == "__main__":
    main()
