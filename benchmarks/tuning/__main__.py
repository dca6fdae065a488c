"""Made-up users choose among nine: ``python -m benchmarks.tuning [--seeds 10]``.

Writes ``out/tuning/errors.csv`` and one plot per error rate. What was run before with the same
arguments is taken from ``out/tuning/runs.json``.
"""

from __future__ import annotations

import argparse
import csv
import json
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.expressive.truths import Truths
from benchmarks.tuning.floor import floor
from benchmarks.tuning.plot import write_plot
from benchmarks.tuning.wishes import GENES, SHAPES, Wish
from risorius.errors import RisoriusWarning
from risorius.layered.face import LayeredFace
from risorius.tuning import Session
from risorius.tuning.objective import MadeUpUser
from risorius.vectormuscle import VectorFace
from tests.tools import real_data_folder

_GENERATIONS = 10
_FACES = {"vector": VectorFace, "layered": LayeredFace}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=None, help="folder of the real heads")
    parser.add_argument("--method", choices=sorted(_FACES), default="vector")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--errors", type=float, nargs="*", default=[0.0, 0.2])
    parser.add_argument("--strategies", nargs="*", default=["genetic", "preference", "cma"])
    parser.add_argument("--shapes", nargs="*", default=list(SHAPES))
    parser.add_argument("--genes", choices=GENES, default="all")
    parser.add_argument("--wild", action="store_true", help="show folded and torn faces as well")
    parser.add_argument("--floor", action="store_true", help="look for the best face as well")
    parser.add_argument("--out", type=Path, default=Path("out/tuning"))
    options = parser.parse_args()
    warnings.simplefilter("ignore", RisoriusWarning)
    truths = Truths.load((options.data or real_data_folder()) / "ict_facekit")
    face = _FACES[options.method].build(truths.head())
    options.out.mkdir(parents=True, exist_ok=True)
    known = _Runs(options.out / "runs.json")
    wishes = {name: Wish.of(face, truths, name, genes=options.genes) for name in options.shapes}
    rows: list[list[object]] = []
    key = f"{options.method} {options.genes} {'wild' if options.wild else 'safe'}"
    for error in options.errors:
        lines: dict[str, list[np.ndarray]] = {strategy: [] for strategy in options.strategies}
        for shape, wish in wishes.items():
            least = np.nan
            if options.floor:
                least = known.get(f"{key} {shape} floor", partial(floor, wish))[0]
            for strategy in options.strategies:
                made = [
                    known.get(
                        f"{key} {shape} {strategy} {error} {seed}",
                        partial(run, wish, strategy, seed, error, wild=options.wild),
                    )
                    for seed in range(options.seeds)
                ]
                median = np.median(made, axis=0)
                share = median / median[0]
                lines[strategy].append(share)
                rows.append([strategy, error, shape, round(least, 4), *median.round(4).tolist()])
                halved = next((step for step, value in enumerate(share) if value <= 0.5), "-")
                print(
                    f"{strategy:10} errs {error:.1f} {shape:13} {len(wish.genome)} genes, first "
                    f"{median[0]:.3f} mm, after 5 {share[5]:.2f}, after {_GENERATIONS} "
                    f"{median[-1]:.3f} = {share[-1]:.2f}, halved at {halved}; "
                    f"best known {least / median[0]:.2f}",
                    flush=True,
                )
        title = f"error / first error, median of shapes; user errs {error:.0%}"
        curves = {strategy: np.median(line, axis=0) for strategy, line in lines.items()}
        write_plot(options.out / f"errs_{round(100 * error):02d}.png", curves, title=title)
    with (options.out / "errors.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        steps = [f"generation_{step}_mm" for step in range(_GENERATIONS + 1)]
        writer.writerow(["strategy", "error_rate", "shape", "best_known_mm", *steps])
        writer.writerows(rows)


def run(wish: Wish, strategy: str, seed: int, error: float, *, wild: bool = False) -> list[float]:
    """Return the error [mm] of the best face picked so far, from the face carried onwards."""
    genome = wish.genome
    admit = None if wild else wish.admit
    session = Session(genome, strategy=strategy, seed=seed, looks=wish.looks, admit=admit)
    user = MadeUpUser(wish.distance, error=error, seed=seed)
    errors = [wish.distance(genome.start)]
    for _ in range(_GENERATIONS):
        session.pick(user(session.generation))
        # What a person would take: the first pick of this generation.
        errors.append(wish.distance(genome.values(session.best)))
    return errors


class _Runs:
    """Results by what was asked, kept in a file."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._known: dict[str, list[float]] = json.loads(path.read_text()) if path.exists() else {}

    def get(self, key: str, make: Callable[[], list[float]]) -> list[float]:
        if key not in self._known:
            self._known[key] = make()
            self._path.write_text(json.dumps(self._known))
        return self._known[key]


if __name__ == "__main__":
    main()
