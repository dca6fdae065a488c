"""Corrective pairs: what two shapes make together, beyond the sum of both.

A rig adds its targets up; a face does not: lips that open and are pressed, a smile over an open
jaw. For the pairs whose simulated pose differs most from the sum, the difference is baked as one
more target, ``pair_A__B``, and driven by the product of the weights of A and B.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from risorius._check import FloatArray, as_number
from risorius.controls.control import Pose
from risorius.rig.face import Face
from risorius.rig.rig import MorphTarget, Rig

__all__ = ["CorrectivePair", "find_pairs", "pair_name", "pair_of", "with_pairs"]

Progress = Callable[[int, int, str], None]

PREFIX = "pair_"
_JOINT = "__"
_STILL = 1e-3  # displacement that counts as none [mm]
_HALF = 0.5


@dataclass(frozen=True, eq=False)
class CorrectivePair:
    """Two shapes and what is missing from their sum.

    Parameters
    ----------
    first, second : str
        Names of the shapes.
    deltas : (n, 3) float64
        Simulated pose minus neutral and both shapes [mm, canonical frame].
    before, after : float
        What the simulation of both makes beyond that of each alone, without and with the
        corrective: root mean square over the vertices that move, over four mixes: both whole, one
        half, both half [mm]. That a shape alone bends between its ends is not counted.
    largest : float
        Largest distance without the corrective, both whole [mm].
    """

    first: str
    second: str
    deltas: FloatArray
    before: float
    after: float
    largest: float

    @property
    def name(self) -> str:
        """Name of the corrective's target."""
        return pair_name(self.first, self.second)


def pair_name(first: str, second: str) -> str:
    """Return the name of the corrective of two shapes: ``pair_jawOpen__mouthClose``."""
    return f"{PREFIX}{first}{_JOINT}{second}"


def pair_of(name: str) -> tuple[str, str] | None:
    """Return the two shapes that a corrective called `name` belongs to, or None."""
    first, joint, second = name.removeprefix(PREFIX).partition(_JOINT)
    return (first, second) if name.startswith(PREFIX) and joint and first and second else None


def find_pairs(
    face: Face,
    poses: Mapping[str, Pose],
    *,
    budget: int = 20,
    progress: Progress | None = None,
) -> tuple[CorrectivePair, ...]:
    """Return the pairs whose sum is farthest from the simulation, the worst first.

    Parameters
    ----------
    face : Face
    poses : mapping of str to Pose
        Shapes by name, such as those of ARKit.
    budget : int
        How many pairs, 1..1000.
    progress : callable, optional
        Called with (done, all, name).

    Notes
    -----
    Pairs whose shapes move no vertex in common are passed over, unless one of them shows only
    together with others (mouthClose). Cost: one evaluation of the face per remaining pair, eleven
    more for those that are kept.
    """
    budget = int(as_number("budget", budget, low=1, high=1000))
    alone = {name: face.displace(pose) for name, pose in poses.items()}
    moves = {name: (d * d).sum(axis=1) > _STILL * _STILL for name, d in alone.items()}
    candidates = [
        (a, b)
        for a, b in combinations(poses, 2)
        if (moves[a] & moves[b]).any() or not moves[a].any() or not moves[b].any()
    ]
    ranked: list[tuple[float, str, str]] = []
    for done, (a, b) in enumerate(candidates):
        if progress is not None:
            progress(done, len(candidates), f"{a} + {b}")
        missing = face.displace(_together(poses[a], poses[b])) - alone[a] - alone[b]
        # The whole head in the mean: a small spot far off counts less than a mouth.
        ranked.append((float(np.sqrt((missing**2).sum(axis=1).mean())), a, b))
    ranked.sort(key=lambda entry: (-entry[0], entry[1], entry[2]))
    return tuple(
        _measured(face, poses, alone, (a, b))
        for distance, a, b in ranked[:budget]
        if distance > _STILL
    )


def _together(a: Pose, b: Pose, *, of_a: float = 1.0, of_b: float = 1.0) -> dict[str, float]:
    pose = {name: of_a * value for name, value in a.items()}
    for name, value in b.items():
        pose[name] = pose.get(name, 0.0) + of_b * value
    return pose


def _part(face: Face, pose: Pose, share: float) -> FloatArray:
    return face.displace({name: share * value for name, value in pose.items()})


def _rms(vectors: FloatArray, rows: np.ndarray) -> float:
    return float(np.sqrt((vectors[rows] ** 2).sum(axis=1).mean())) if rows.any() else 0.0


def _measured(
    face: Face, poses: Mapping[str, Pose], alone: Mapping[str, FloatArray], names: tuple[str, str]
) -> CorrectivePair:
    a, b = names
    whole = face.displace(_together(poses[a], poses[b]))
    deltas = whole - alone[a] - alone[b]
    rows = (alone[a] ** 2 + alone[b] ** 2 + deltas**2).sum(axis=1) > _STILL * _STILL
    without: list[float] = []
    corrected: list[float] = []
    for x, y in ((1.0, 1.0), (1.0, _HALF), (_HALF, 1.0), (_HALF, _HALF)):
        pose = _together(poses[a], poses[b], of_a=x, of_b=y)
        missing = face.displace(pose) - _part(face, poses[a], x) - _part(face, poses[b], y)
        without.append(_rms(missing, rows))
        corrected.append(_rms(missing - x * y * deltas, rows))
    largest = float(np.sqrt((deltas**2).sum(axis=1).max()))
    before, after = (float(np.sqrt(np.mean(np.square(each)))) for each in (without, corrected))
    return CorrectivePair(a, b, deltas, before, after, largest)


def with_pairs(rig: Rig, pairs: tuple[CorrectivePair, ...]) -> Rig:
    """Return the rig with one target more for each pair."""
    targets = [
        MorphTarget.from_dense(
            pair.name,
            np.where(
                (pair.deltas**2).sum(axis=1, keepdims=True) > _STILL * _STILL,
                rig.frame.vectors_to_input(pair.deltas),
                0.0,
            ),
        )
        for pair in pairs
    ]
    return rig.with_targets((*rig.targets, *targets))
