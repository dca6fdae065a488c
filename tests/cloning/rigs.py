"""A rig of the built-in head and copies of that head, for all tests of cloning."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache

import numpy as np
import numpy.typing as npt

from risorius import Head, Rig, bake
from risorius.anatomy.template import builtin_head
from risorius.cloning import Cloning
from risorius.landmarks import LandmarkSpec
from risorius.mesh.polygon_mesh import PolygonMesh
from tests.face_fixtures import builtin_face

FloatArray = npt.NDArray[np.float64]

POSES = {
    "jawOpen": {"jaw_pitch": 14.0},
    "smile": {"zygomaticus_major_l": 1.0, "zygomaticus_major_r": 1.0},
    "pucker": {"orbicularis_oris": 1.0},
    "blink": {"lid_upper_l": 1.0, "lid_upper_r": 1.0},
    "look": {"gaze_yaw_l": 20.0, "gaze_yaw_r": 20.0},
}


@cache
def source_rig() -> Rig:
    """Return five shapes on the built-in head."""
    face = builtin_face()
    known = {control.name for control in face.controls}
    poses = {
        name: {control: value for control, value in pose.items() if control in known}
        for name, pose in POSES.items()
    }
    return bake(face, poses)


def specs_of(head: Head) -> dict[str, LandmarkSpec]:
    """Return the landmarks of a head as a file would hold them."""
    return {name: LandmarkSpec(vertex=mark.vertex) for name, mark in head.landmarks.items()}


def copy_of(
    head: Head,
    positions: FloatArray,
    *,
    specs: Mapping[str, LandmarkSpec] | None = None,
) -> Head:
    """Return the same head with other vertex positions [file unit]."""
    mesh: PolygonMesh = replace(head.source, positions=positions)
    return Head.from_mesh(mesh, specs_of(head) if specs is None else specs)


def other_face(points: FloatArray) -> FloatArray:
    """Give the built-in head another shape: broader below, longer, a larger nose."""
    x, y, z = points.T
    low = 1.0 / (1.0 + np.exp((y + 40.0) / 25.0))
    nose = np.exp(-(x**2 + (y + 40.0) ** 2) / 400.0) * (z > 40.0)
    return np.stack([x * (1.0 + 0.08 * low), y * (1.0 + 0.05 * low), z + 3.0 * nose], axis=1)


@cache
def other_head() -> Head:
    """Return the built-in head with another shape, same vertices."""
    head = builtin_head()
    moved = head.frame.to_input(other_face(head.positions))
    return copy_of(head, moved)


@cache
def self_cloning() -> Cloning:
    """Return the built-in head bound to itself."""
    return Cloning.build(builtin_head(), builtin_head())


@cache
def other_cloning() -> Cloning:
    """Return the built-in head bound to its other shape."""
    return Cloning.build(builtin_head(), other_head())


def dense(rig: Rig) -> FloatArray:
    """Return all shapes (s, n, 3) of a rig."""
    return np.stack([target.dense(rig.mesh.vertex_count) for target in rig.targets])
