"""Judge cloning on all pairs and draw it: python -m benchmarks.cloning.run [PAIR ...] [options].

Prints one row for each pair and method; --pictures FOLDER draws five shapes of every pair.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.cloning.baselines import deformation_transfer, nearest_copy
from benchmarks.cloning.judge import Judge
from benchmarks.cloning.pairs import PAIRS, FloatArray, Pair, as_text, to_makehuman
from risorius.cloning import Cloning, clone_parameters, clone_with_report
from risorius.head import Head
from risorius.render import write_png
from risorius.render.rig_sheet import rig_sheet
from risorius.rig import Rig

_SHOWN = ("jawOpen", "mouthSmile_L", "mouthPucker", "eyeBlink_L", "browInnerUp_L")


def shapes_of(pair: Pair) -> tuple[tuple[str, ...], FloatArray]:
    """Return names and dense shapes; pupils move no skin and are left out."""
    kept = [target for target in pair.source.targets if "Pupil" not in target.name]
    n = pair.source.mesh.vertex_count
    return tuple(t.name for t in kept), np.stack([t.dense(n) for t in kept])


def _by_profile(profile: str) -> Callable[[Head, Head, FloatArray], FloatArray]:
    def run(source: Head, target: Head, deltas: FloatArray) -> FloatArray:
        bound = Cloning.build(
            source,
            target,
            moving=deltas.any(axis=(0, 2)),
            parameters=clone_parameters(profile),
        )
        return bound.carry(deltas)

    return run


METHODS: dict[str, Callable[[Head, Head, FloatArray], FloatArray]] = {
    "improved": _by_profile("improved"),
    "faithful": _by_profile("faithful"),
    "transfer": deformation_transfer,
    "nearest": nearest_copy,
}


def judge_pair(name: str, method: str) -> dict[str, float]:
    """Return the measures of one method on one pair of known truth."""
    pair = PAIRS[name]()
    names, deltas = shapes_of(pair)
    rows = [pair.source.names.index(each) for each in names]
    source = Head.from_mesh(pair.source.mesh, pair.source.landmarks)
    start = time.perf_counter()
    made = METHODS[method](source, pair.target, deltas)
    seconds = time.perf_counter() - start
    assert pair.truth is not None
    score = Judge(pair.target, names, pair.truth[rows]).score(made)
    return score.summary | {"seconds": seconds}


def round_trip(makehuman: str, method: str) -> dict[str, float]:
    """Clone to a MakeHuman head and back, judged against the original shapes."""
    pair = to_makehuman(makehuman)
    names, deltas = shapes_of(pair)
    source = Head.from_mesh(pair.source.mesh, pair.source.landmarks)
    there = METHODS[method](source, pair.target, deltas)
    back = METHODS[method](pair.target, source, there)
    return Judge(source, names, deltas).score(back).summary


def draw(name: str, folder: Path) -> None:
    """Draw five shapes of a pair's clone on one page."""
    pair = PAIRS[name]()
    shown = [each for each in _SHOWN if each in pair.source.names]
    made: Rig = clone_with_report(pair.source.subset(shown), pair.target).rig
    write_png(folder / f"{name}.png", rig_sheet(made))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pairs", nargs="*", default=[p for p in PAIRS if not p.startswith("to_")])
    parser.add_argument("--methods", default="improved")
    parser.add_argument("--round-trip", metavar="HEAD", action="append", default=[])
    parser.add_argument("--pictures", type=Path)
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    for method in given.methods.split(","):
        for name in given.pairs:
            if not name.startswith("to_"):
                print(method, name, as_text(judge_pair(name, method)), flush=True)
        for head in given.round_trip:
            print(method, f"round trip {head}", as_text(round_trip(head, method)), flush=True)
    if given.pictures is not None:
        given.pictures.mkdir(exist_ok=True)
        for name in given.pairs:
            draw(name, given.pictures)


if __name__ == "__main__":
    main()
