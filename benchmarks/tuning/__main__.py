"""Made-up users choose among nine: ``python -m benchmarks.tuning [--seeds 10]``.

Writes ``out/tuning/errors.csv`` and one plot per error rate.
"""

from __future__ import annotations

import argparse
import csv
import warnings
from pathlib import Path

import numpy as np

from benchmarks.expressive.truths import Truths
from benchmarks.tuning.plot import write_plot
from benchmarks.tuning.wishes import SHAPES, Wish
from risorius.errors import RisoriusWarning
from risorius.tuning import Session
from risorius.tuning.objective import MadeUpUser
from risorius.vectormuscle import VectorFace
from tests.tools import real_data_folder

_GENERATIONS = 10
_FLOOR_GENERATIONS = 30


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=None, help="folder of the real heads")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--errors", type=float, nargs="*", default=[0.0, 0.2])
    parser.add_argument("--strategies", nargs="*", default=["genetic", "preference"])
    parser.add_argument("--out", type=Path, default=Path("out/tuning"))
    options = parser.parse_args()
    warnings.simplefilter("ignore", RisoriusWarning)
    truths = Truths.load((options.data or real_data_folder()) / "ict_facekit")
    face = VectorFace.build(truths.head())
    options.out.mkdir(parents=True, exist_ok=True)
    wishes = {shape: Wish.of(face, truths, shape) for shape in SHAPES}
    effects = {shape: wish.sensitivity() for shape, wish in wishes.items()}
    floors = {shape: floor(wish, effects[shape]) for shape, wish in wishes.items()}
    rows: list[list[object]] = []
    for error in options.errors:
        medians = {
            (strategy, shape): np.median(
                [run(wish, strategy, seed, error, effects[shape]) for seed in range(options.seeds)],
                axis=0,
            )
            for strategy in options.strategies
            for shape, wish in wishes.items()
        }
        lines = {strategy: np.zeros((0, _GENERATIONS + 1)) for strategy in options.strategies}
        for (strategy, shape), median in medians.items():
            others = [medians[other, shape].min() for other in options.strategies]
            lowest = min(floors[shape], *others)
            share = (median - lowest) / max(median[0] - lowest, 1e-9)
            lines[strategy] = np.vstack([lines[strategy], share])
            rows.append([strategy, error, shape, round(lowest, 4), *median.round(4).tolist()])
            halved = next((step for step, value in enumerate(share) if value <= 0.5), "-")
            print(
                f"{strategy:10} errs {error:.1f} {shape:13} first {median[0]:.3f} mm, "
                f"after {_GENERATIONS} {median[-1]:.3f}, best known {lowest:.3f}; of what can be "
                f"gained is left {share[-1]:.2f}, halved at {halved}",
                flush=True,
            )
        title = f"error left of what can be gained, median of shapes; user errs {error:.0%}"
        curves = {strategy: np.median(line, axis=0) for strategy, line in lines.items()}
        write_plot(options.out / f"errs_{round(100 * error):02d}.png", curves, title=title)
    with (options.out / "errors.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        steps = [f"generation_{step}_mm" for step in range(_GENERATIONS + 1)]
        writer.writerow(["strategy", "error_rate", "shape", "best_known_mm", *steps])
        writer.writerows(rows)


def run(wish: Wish, strategy: str, seed: int, error: float, effect: np.ndarray) -> list[float]:
    """Return the error [mm] of the best face picked so far, from the face carried onwards."""
    genome = wish.candidates.genome
    session = Session(genome, strategy=strategy, seed=seed, sensitivity=effect)
    known: dict[bytes, float] = {}

    def distance(values: np.ndarray) -> float:
        key = values.tobytes()
        if key not in known:
            known[key] = wish.distance(values)
        return known[key]

    user = MadeUpUser(distance, error=error, seed=seed)
    errors = [distance(genome.start)]
    for _ in range(_GENERATIONS):
        session.pick(user(session.generation))
        # What a person would take: the first pick of this generation.
        errors.append(distance(genome.values(session.best)))
    return errors


def floor(wish: Wish, effect: np.ndarray) -> float:
    """Return the least error [mm] that a long search without a person finds."""
    genome = wish.candidates.genome
    session = Session(genome, strategy="preference", seed=99, sensitivity=effect)
    best = wish.distance(genome.start)
    for _ in range(_FLOOR_GENERATIONS):
        errors = [wish.distance(values) for values in session.generation.candidates]
        best = min(best, *errors)
        session.pick(np.argsort(errors, kind="stable").tolist())
    return best


if __name__ == "__main__":
    main()
