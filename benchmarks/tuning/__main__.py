"""Made-up users choose among nine: ``python -m benchmarks.tuning [--seeds 10]``.

Writes ``out/tuning/errors.csv`` and one plot per error rate.
"""

from __future__ import annotations

import argparse
import csv
import warnings
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

from benchmarks.expressive.truths import Truths
from benchmarks.tuning.plot import write_plot
from benchmarks.tuning.wishes import SHAPES, Wish
from risorius.errors import RisoriusWarning
from risorius.tuning import Session
from risorius.tuning.objective import MadeUpUser
from risorius.vectormuscle import VectorFace
from tests.tools import real_data_folder

_GENERATIONS = 10
_FLOOR_STEPS = 10


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=None, help="folder of the real heads")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--errors", type=float, nargs="*", default=[0.0, 0.2])
    parser.add_argument("--strategies", nargs="*", default=["genetic", "preference", "cma"])
    parser.add_argument("--shapes", nargs="*", default=list(SHAPES))
    parser.add_argument("--genes", choices=("published", "all"), default="all")
    parser.add_argument("--no-floor", action="store_true", help="do not look for the best face")
    parser.add_argument("--out", type=Path, default=Path("out/tuning"))
    options = parser.parse_args()
    warnings.simplefilter("ignore", RisoriusWarning)
    truths = Truths.load((options.data or real_data_folder()) / "ict_facekit")
    face = VectorFace.build(truths.head())
    options.out.mkdir(parents=True, exist_ok=True)
    wishes = {name: Wish.of(face, truths, name, genes=options.genes) for name in options.shapes}
    effects = {shape: wish.sensitivity() for shape, wish in wishes.items()}
    floors = {name: np.nan if options.no_floor else floor(w) for name, w in wishes.items()}
    rows: list[list[object]] = []
    for error in options.errors:
        lines: dict[str, list[np.ndarray]] = {strategy: [] for strategy in options.strategies}
        for strategy in options.strategies:
            for shape, wish in wishes.items():
                made = [run(wish, strategy, n, error, effects[shape]) for n in range(options.seeds)]
                median = np.median(made, axis=0)
                share = median / median[0]
                lines[strategy].append(share)
                least = floors[shape]
                rows.append([strategy, error, shape, round(least, 4), *median.round(4).tolist()])
                halved = next((step for step, value in enumerate(share) if value <= 0.5), "-")
                print(
                    f"{strategy:10} errs {error:.1f} {shape:13} first {median[0]:.3f} mm, after "
                    f"{_GENERATIONS} {median[-1]:.3f} = {share[-1]:.2f}, halved at {halved}; "
                    f"best known {least:.3f} = {least / median[0]:.2f}",
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


def floor(wish: Wish) -> float:
    """Return the least error [mm] that a bounded least-squares search finds."""
    genome = wish.candidates.genome
    low, width = genome.low, genome.high - genome.low
    counted = np.flatnonzero(wish.weights > 0.0)
    root = np.sqrt(wish.weights / wish.weights.sum())[counted, None]

    def residual(place: np.ndarray) -> np.ndarray:
        return (root * (wish.skin(low + place * width) - wish.truth)[counted]).ravel()

    # From the middle of the ranges rather than from an edge, where slopes vanish.
    start = np.clip((genome.start - low) / width, 0.1, 0.9)
    found = least_squares(residual, start, bounds=(0, 1), diff_step=0.02, max_nfev=_FLOOR_STEPS)
    return float(np.sqrt(2.0 * found.cost))


if __name__ == "__main__":
    main()
