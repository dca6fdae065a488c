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
from risorius.controls.pair_names import pair_name
from risorius.controls.presets import mirrored
from risorius.rig.face import Face
from risorius.rig.rig import MorphTarget, Rig
from risorius.rig.sides import other_side

__all__ = ["CorrectivePair", "find_pairs", "with_pairs"]

Progress = Callable[[int, int, str], None]

_STILL = 1e-3  # displacement that counts as none [mm]
_HOPE = 0.5  # share of the motion in common that a sum is at most off by
_COMMON = 0.02  # motion in common, root mean square over the head, below which a pair adds up [mm]
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


def find_pairs(
    face: Face,
    poses: Mapping[str, Pose],
    *,
    budget: int = 20,
    upon: Mapping[str, Pose] | None = None,
    progress: Progress | None = None,
) -> tuple[CorrectivePair, ...]:
    """Return the pairs whose sum is farthest from the simulation, the worst first.

    Parameters
    ----------
    face : Face
    poses : mapping of str to Pose
        Shapes by name, such as those of ARKit.
    budget : int
        How many pairs, 1..1000. A pair and its mirror image are taken both or not at all.
    upon : mapping of str to Pose, optional
        As for `risorius.rig.bake`. Shapes that are made upon another mean nothing beside others
        and form no pairs.
    progress : callable, optional
        Called with (done, all, name).

    Notes
    -----
    Passed over: pairs whose shapes have next to no motion in common (unless one shows only together
    with others, as mouthClose does), contrary ones, such as a gaze to both sides, and the two
    sides of one shape, whose targets add up as they are baked. Of a pair and
    its mirror image one is tried for both; pairs with most in common are tried first, until the
    rest can no longer be among the best. Cost: one evaluation of the face per pair tried, four to
    six more for those that are kept.
    """
    budget = int(as_number("budget", budget, low=1, high=1000))
    poses = {name: pose for name, pose in poses.items() if name not in (upon or {})}
    alone = {name: face.displace(pose) for name, pose in poses.items()}
    candidates = _candidates(face, poses, alone)
    ranked: list[tuple[float, tuple[tuple[str, str], ...]]] = []
    for done, (common, same) in enumerate(candidates):
        a, b = same[0]
        if progress is not None:
            progress(done, len(candidates), f"{a} + {b}")
        if common < _HOPE * _bar(ranked, budget):
            break
        missing = face.displace(_together(poses[a], poses[b])) - alone[a] - alone[b]
        # The whole head in the mean: a small spot far off counts less than a mouth.
        ranked.append((_whole(missing), same))
    ranked.sort(key=lambda entry: (-entry[0], entry[1]))
    kept: list[tuple[str, str]] = []
    for distance, same in ranked:
        if distance > _STILL and len(kept) + len(same) <= budget:
            kept.extend(same)
    measure = _Measure(face, poses, alone)
    found = [measure.of(*names) for names in kept]
    found.sort(key=lambda pair: (-_whole(pair.deltas), pair.first, pair.second))
    return tuple(found)


def _whole(vectors: FloatArray) -> float:
    return float(np.sqrt((vectors**2).sum(axis=1).mean()))


def _bar(ranked: list[tuple[float, tuple[tuple[str, str], ...]]], budget: int) -> float:
    """Return the distance that a pair must have to be among the best `budget` so far."""
    distances = sorted((distance for distance, same in ranked for _ in same), reverse=True)
    return distances[budget - 1] if len(distances) >= budget else 0.0


def _candidates(
    face: Face, poses: Mapping[str, Pose], alone: Mapping[str, FloatArray]
) -> list[tuple[float, tuple[tuple[str, str], ...]]]:
    """Return the pairs worth trying: motion in common [mm], pair and its mirror image.

    Those with most in common come first; a pair that shows only together has no end of it.
    """
    sizes = {name: np.sqrt((moved**2).sum(axis=1)) for name, moved in alone.items()}
    still = {name for name, size in sizes.items() if not (size > _STILL).any()}
    mirror = _mirrors(face, poses)
    order = {name: place for place, name in enumerate(poses)}
    result: list[tuple[float, tuple[tuple[str, str], ...]]] = []
    seen: set[frozenset[str]] = set()
    for a, b in combinations(poses, 2):
        if frozenset((a, b)) in seen or _contrary(poses[a], poses[b]):
            continue
        if mirror.get(a) == b and other_side(poses[a], face.controls) is not None:
            continue
        common = float(np.sqrt((np.minimum(sizes[a], sizes[b]) ** 2).mean()))
        common = float("inf") if {a, b} & still else common
        if common < _COMMON:
            continue
        same = [(a, b)]
        other = frozenset((mirror.get(a, a), mirror.get(b, b)))
        if len(other) == 2 and other != frozenset((a, b)):
            first, second = sorted(other, key=order.__getitem__)
            same.append((first, second))
        seen |= {frozenset(names) for names in same}
        result.append((common, tuple(same)))
    result.sort(key=lambda entry: -entry[0])
    return result


def _contrary(a: Pose, b: Pose) -> bool:
    """Return whether two poses ask a control for both of its ways, so that nobody mixes them."""
    return any(value * b.get(name, 0.0) < 0.0 for name, value in a.items())


def _mirrors(face: Face, poses: Mapping[str, Pose]) -> dict[str, str]:
    """Return the shape whose pose is the mirror image, for shapes that have one."""
    controls = {control.name: control for control in face.controls}
    names = {frozenset(pose.items()): name for name, pose in poses.items()}
    result: dict[str, str] = {}
    for name, pose in poses.items():
        found = names.get(frozenset(mirrored(pose, controls).items()))
        if found is not None:
            result[name] = found
    return result


def _together(a: Pose, b: Pose, *, of_a: float = 1.0, of_b: float = 1.0) -> dict[str, float]:
    pose = {name: of_a * value for name, value in a.items()}
    for name, value in b.items():
        pose[name] = pose.get(name, 0.0) + of_b * value
    return pose


def _rms(vectors: FloatArray, rows: np.ndarray) -> float:
    return float(np.sqrt((vectors[rows] ** 2).sum(axis=1).mean())) if rows.any() else 0.0


class _Measure:
    """Tries mixes of two shapes; what each makes by itself is tried once."""

    def __init__(
        self, face: Face, poses: Mapping[str, Pose], alone: Mapping[str, FloatArray]
    ) -> None:
        self._face = face
        self._poses = poses
        self._alone = alone
        self._halves: dict[str, FloatArray] = {}

    def of(self, first: str, second: str) -> CorrectivePair:
        """Return the corrective of two shapes and what it brings."""
        a, b = self._alone[first], self._alone[second]
        deltas = self._beyond((first, second), (1.0, 1.0))
        rows = (a**2 + b**2 + deltas**2).sum(axis=1) > _STILL * _STILL
        without, corrected = [_rms(deltas, rows)], [0.0]
        for shares in ((1.0, _HALF), (_HALF, 1.0), (_HALF, _HALF)):
            missing = self._beyond((first, second), shares)
            without.append(_rms(missing, rows))
            corrected.append(_rms(missing - shares[0] * shares[1] * deltas, rows))
        largest = float(np.sqrt((deltas**2).sum(axis=1).max()))
        before, after = (float(np.sqrt(np.mean(np.square(each)))) for each in (without, corrected))
        return CorrectivePair(first, second, deltas, before, after, largest)

    def _beyond(self, names: tuple[str, str], shares: tuple[float, float]) -> FloatArray:
        a, b = (self._poses[name] for name in names)
        both = self._face.displace(_together(a, b, of_a=shares[0], of_b=shares[1]))
        return both - self._part(names[0], shares[0]) - self._part(names[1], shares[1])

    def _part(self, name: str, share: float) -> FloatArray:
        if share == 1.0:
            return self._alone[name]
        if name not in self._halves:
            half = {control: share * value for control, value in self._poses[name].items()}
            self._halves[name] = self._face.displace(half)
        return self._halves[name]


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
