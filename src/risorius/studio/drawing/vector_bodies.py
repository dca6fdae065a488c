"""Vector muscles as bodies that can be seen and picked: a spindle from head to tail."""

from __future__ import annotations

import numpy as np

from risorius.anatomy.outwards import unit
from risorius.mesh.core import TriMesh
from risorius.vectormuscle.face import VectorFace

__all__ = ["vector_bodies"]

_RINGS, _SIDES = 9, 8
_RADIUS = 1.6


def vector_bodies(face: VectorFace) -> dict[str, TriMesh]:
    """Return a spindle for every muscle, from its head to its tail [mm]."""
    size = _RADIUS * face.head.height / 230.0
    return {muscle.name: _spindle(*muscle.ends(), radius=size) for muscle in face.vectors.muscles}


def _spindle(head: np.ndarray, tail: np.ndarray, *, radius: float) -> TriMesh:
    axis = tail - head
    if float(np.linalg.norm(axis)) < 1e-6:
        axis = np.array([0.0, 0.0, 1e-3])
    along = unit(axis[None])[0]
    aside = unit(np.cross(along, np.eye(3)[np.argmin(np.abs(along))])[None])[0]
    other = np.cross(along, aside)
    share = np.linspace(0.0, 1.0, _RINGS)
    # Thick at the bone, thin where it ends in the skin.
    thick = radius * (0.25 + np.sqrt(np.sin(np.pi * share)) * (1.0 - 0.5 * share))
    angle = np.linspace(0.0, 2.0 * np.pi, _SIDES, endpoint=False)
    ring = np.cos(angle)[:, None] * aside + np.sin(angle)[:, None] * other
    points = (head + share[:, None] * axis)[:, None] + thick[:, None, None] * ring
    corner = np.arange((_RINGS - 1) * _SIDES)
    beside = corner - corner % _SIDES + (corner + 1) % _SIDES
    first = np.stack([corner, beside, corner + _SIDES], axis=1)
    second = np.stack([beside, beside + _SIDES, corner + _SIDES], axis=1)
    return TriMesh(points.reshape(-1, 3), np.concatenate([first, second]).astype(np.int32))
