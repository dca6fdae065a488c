"""Bake: poses of any face become the morph targets of a rig."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray
from risorius.controls.control import Pose
from risorius.head.head import Head
from risorius.landmarks.landmark_set import Landmark, LandmarkSpec
from risorius.rig.face import Face, ManyPoses
from risorius.rig.rig import MorphTarget, Rig
from risorius.rig.sides import added, fair_share, other_side

__all__ = ["bake", "displacement", "empty_rig"]

# Motion below this is noise of the arithmetic and is left out of the targets [mm].
_STILL = 1e-4
# Poses that are asked for at once, where a face can: few enough to be interrupted soon.
_SIDE_BY_SIDE = 32

Progress = Callable[[int, int, str], None]
Key = frozenset[tuple[str, float]]


def bake(
    face: Face,
    poses: Mapping[str, Pose],
    *,
    left_out: Mapping[str, str] | None = None,
    upon: Mapping[str, Pose] | None = None,
    progress: Progress | None = None,
) -> Rig:
    """Evaluate `face` in every pose and collect the displacements; left and right add up.

    Parameters
    ----------
    face : Face
    poses : mapping of str to Pose
        Target name -> pose, in the order of the rig's targets.
    left_out : mapping of str to str, optional
        Shapes that were asked for and cannot be made, with the reason; written into the rig.
    upon : mapping of str to Pose, optional
        Target name -> pose on top of which it is made; see `displacement`.
    progress : callable, optional
        Called with (done, all, name) before each pose, or before each group that is solved at once.

    Returns
    -------
    Rig
        In the input's frame, unit and vertex order; its neutral is the input bit for bit.
    """
    head = face.head
    targets: dict[str, MorphTarget] = {}
    for name, moved in _displaced(face, poses, upon or {}, progress):
        moved[(moved * moved).sum(axis=1) <= _STILL * _STILL] = 0.0
        deltas = head.frame.vectors_to_input(moved)
        targets[name] = MorphTarget.from_dense(name, deltas, pose=poses[name])
    return empty_rig(head).with_targets(
        [targets[name] for name in poses], controls=face.controls, left_out=dict(left_out or {})
    )


def displacement(face: Face, pose: Pose, *, upon: Pose | None = None) -> FloatArray:
    """Return what a shape adds to a face (n, 3) [mm, canonical frame].

    A shape of one side carries its share of what both sides make together (`fair_share`): then
    left and right add up to the face's own pose.

    Parameters
    ----------
    face : Face
    pose : Pose
    upon : Pose, optional
        Pose that the shape is made for: the answer is what it changes there. Lips that close on an
        open jaw would be pushed apart again by contact on a closed one.
    """
    shape = _Shape.of(face, pose, upon)
    return shape.displacement([face.displace(needed) for needed in shape.needed])


@dataclass(frozen=True)
class _Shape:
    """What has to be simulated for one shape: itself, and what it is compared with."""

    needed: tuple[Pose, ...]
    sided: bool

    @staticmethod
    def of(face: Face, pose: Pose, upon: Pose | None) -> _Shape:
        if upon is not None:
            return _Shape((added(upon, pose), upon), sided=False)
        other = other_side(pose, face.controls)
        if other is None:
            return _Shape((pose,), sided=False)
        return _Shape((pose, other, added(pose, other)), sided=True)

    def displacement(self, found: Sequence[FloatArray]) -> FloatArray:
        if self.sided:
            return fair_share(*found)
        return found[0] - found[1] if len(found) == 2 else found[0].copy()


def _displaced(
    face: Face,
    poses: Mapping[str, Pose],
    upon: Mapping[str, Pose],
    progress: Progress | None,
) -> Iterator[tuple[str, FloatArray]]:
    """Yield name and displacement (n, 3) [mm] of every target; sides follow one another."""
    shapes = {name: _Shape.of(face, pose, upon.get(name)) for name, pose in poses.items()}
    step = _SIDE_BY_SIDE if isinstance(face, ManyPoses) else 1
    done = 0
    for names in _batches(shapes, step):
        if progress is not None:
            progress(done, len(poses), names[0])
        wanted = {_key(pose): pose for name in names for pose in shapes[name].needed}
        if isinstance(face, ManyPoses):
            found = face.displace_all(list(wanted.values()))
        else:
            found = [face.displace(pose) for pose in wanted.values()]
        known = dict(zip(wanted, found, strict=True))
        for name in names:
            shape = shapes[name]
            yield name, shape.displacement([known[_key(pose)] for pose in shape.needed])
        done += len(names)


def _batches(shapes: Mapping[str, _Shape], step: int) -> Iterator[list[str]]:
    """Yield names whose simulations are done at once, both sides of a shape always together."""
    groups: dict[frozenset[Key], list[str]] = {}
    for name, shape in shapes.items():
        # Left and right need the same three poses.
        groups.setdefault(frozenset(map(_key, shape.needed)), []).append(name)
    batch: list[str] = []
    needed = 0
    for group, names in groups.items():
        if batch and needed + len(group) > step:
            yield batch
            batch, needed = [], 0
        batch.extend(names)
        needed += len(group)
    if batch:
        yield batch


def _key(pose: Pose) -> Key:
    return frozenset(pose.items())


def empty_rig(head: Head) -> Rig:
    """Return the rig of a head without targets: neutral, parts, landmarks, frame."""
    part_of_vertex = np.full(head.vertex_count, -1, np.int32)
    names = tuple(head.parts)
    for number, kind in enumerate(names):
        part_of_vertex[head.parts[kind].source] = number
    landmarks = {name: _spec(mark, head) for name, mark in head.landmarks.items()}
    return Rig(head.source, (), names, part_of_vertex, landmarks, head.frame)


def _spec(mark: Landmark, head: Head) -> LandmarkSpec:
    if len(mark.vertices) == 1:
        return LandmarkSpec(vertex=mark.vertices[0], confidence=mark.confidence)
    x, y, z = (float(value) for value in mark.at(head.source.positions))
    return LandmarkSpec(position=(x, y, z), confidence=mark.confidence)
