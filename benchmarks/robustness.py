"""Random control sequences on a face: nothing explodes, nothing is remembered.

Run as ``python -m benchmarks.robustness --method layered --count 10000``.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any

import numpy as np

from risorius.anatomy.template import builtin_head
from risorius.project import Project
from risorius.project.assemble import face_of

FARTHEST = 80.0
"""What no vertex of a human face may exceed [mm of the built-in head]; a chin goes half as far."""


@dataclass(frozen=True)
class Trial:
    """What a run of sequences showed."""

    poses: int
    finite: bool
    farthest: float
    history_free: bool
    back_at_rest: bool


def sequences(face: Any, *, count: int, length: int, seed: int) -> Trial:
    """Pose `count` random sequences of `length` poses, rest after each.

    A third of the controls moves in each pose, a third of these at an end of its range; the last
    pose of a sequence is asked for again after the rest and must be the same to the bit.
    """
    rng = np.random.default_rng(seed)
    controls = list(face.controls)
    neutral = face.head.positions
    finite, same, rest, farthest, poses = True, True, True, 0.0, 0
    for _ in range(count):
        pose: dict[str, float] = {}
        posed = neutral
        for _ in range(length):
            pose = _random_pose(controls, rng)
            posed = face.pose(pose)
            poses += 1
            finite &= bool(np.isfinite(posed).all())
            farthest = max(farthest, float(np.linalg.norm(posed - neutral, axis=1).max()))
        rest &= np.array_equal(face.pose({}), neutral)
        same &= np.array_equal(face.pose(pose), posed)
    return Trial(poses, finite, farthest, same, rest)


def _random_pose(controls: list[Any], rng: np.random.Generator) -> dict[str, float]:
    chosen = rng.random(len(controls)) < 1 / 3
    pose: dict[str, float] = {}
    for control, wanted in zip(controls, chosen, strict=True):
        if wanted:
            low, high = control.low, control.high
            extreme = rng.random() < 1 / 3
            value = rng.choice([low, high]) if extreme else rng.uniform(low, high)
            pose[control.name] = float(value)
    return pose


def _main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--method", default="layered")
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--length", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0)
    chosen = parser.parse_args()
    head = builtin_head()
    face = face_of(Project(method=chosen.method), head)
    print(sequences(face, count=chosen.count, length=chosen.length, seed=chosen.seed))


if __name__ == "__main__":
    _main()
