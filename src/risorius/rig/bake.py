"""Bake: poses of any face become the morph targets of a rig."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

import numpy as np

from risorius._check import FloatArray
from risorius.controls.control import Pose
from risorius.head.head import Head
from risorius.landmarks.landmark_set import Landmark, LandmarkSpec
from risorius.rig.face import Face, ManyPoses
from risorius.rig.rig import MorphTarget, Rig

__all__ = ["bake", "displacement", "empty_rig"]

# Motion below this is noise of the arithmetic and is left out of the targets [mm].
_STILL = 1e-4
# Poses that are asked for at once, where a face can: few enough to be interrupted soon.
_SIDE_BY_SIDE = 32

Progress = Callable[[int, int, str], None]


def bake(
    face: Face,
    poses: Mapping[str, Pose],
    *,
    left_out: Mapping[str, str] | None = None,
    upon: Mapping[str, Pose] | None = None,
    progress: Progress | None = None,
) -> Rig:
    """Evaluate `face` in every pose and collect the displacements.

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
    targets: list[MorphTarget] = []
    for name, pose, moved in _displaced(face, poses, upon or {}, progress):
        moved[(moved * moved).sum(axis=1) <= _STILL * _STILL] = 0.0
        targets.append(MorphTarget.from_dense(name, head.frame.vectors_to_input(moved), pose=pose))
    return empty_rig(head).with_targets(
        targets, controls=face.controls, left_out=dict(left_out or {})
    )


def displacement(face: Face, pose: Pose, *, upon: Pose | None = None) -> FloatArray:
    """Return what a shape adds to a face (n, 3) [mm, canonical frame].

    Parameters
    ----------
    face : Face
    pose : Pose
    upon : Pose, optional
        Pose that the shape is made for: the answer is what it changes there. Lips that close on an
        open jaw would be pushed apart again by contact on a closed one.
    """
    if upon is None:
        return face.displace(pose)
    return face.displace(_both(upon, pose)) - face.displace(upon)


def _both(upon: Pose, pose: Pose) -> Pose:
    return {name: upon.get(name, 0.0) + pose.get(name, 0.0) for name in {**upon, **pose}}


def _displaced(
    face: Face,
    poses: Mapping[str, Pose],
    upon: Mapping[str, Pose],
    progress: Progress | None,
) -> Iterator[tuple[str, Pose, FloatArray]]:
    """Yield name, pose and displacement (n, 3) [mm] of every target, in order."""
    names = list(poses)
    step = _SIDE_BY_SIDE if isinstance(face, ManyPoses) else 1
    for first in range(0, len(names), step):
        part = names[first : first + step]
        if progress is not None:
            progress(first, len(names), part[0])
        if not isinstance(face, ManyPoses):
            for name in part:
                yield name, poses[name], displacement(face, poses[name], upon=upon.get(name))
            continue
        above = [name for name in part if name in upon]
        wanted = [_both(upon.get(name, {}), poses[name]) for name in part]
        found = face.displace_all([*wanted, *(upon[name] for name in above)])
        beneath = dict(zip(above, found[len(part) :]))
        for name, moved in zip(part, found):
            yield name, poses[name], moved - beneath[name] if name in beneath else moved


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
