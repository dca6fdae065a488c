"""Spring faces that many tests look at; each is built once."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.template import builtin_head
from risorius.mesh.normals import vertex_normals
from risorius.springmuscle.bones import builtin_bones
from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.muscle_set import MuscleSet
from risorius.springmuscle.parameters import SpringParameters
from risorius.springmuscle.surface import SkinSurface
from tests.springmuscle.made_up import fibre, muscle

DEPTH = 3.2
SMILE = {"zygomaticus_major_l": 1.0, "zygomaticus_major_r": 1.0}


@cache
def builtin_mechanics() -> Mechanics:
    """Return the moving parts of the built-in head."""
    return Mechanics.build(builtin_head())


def cheek_points(side: float = 1.0) -> tuple[FloatArray, FloatArray]:
    """Return points (7, 3) under the cheek, from the cheek bone to the corner, and what is out."""
    head = builtin_head()
    mesh = head.skin.mesh
    corner, eye = head.landmarks.position("2.4"), head.landmarks.position("3.7")
    line = np.linspace(eye + [4.0, -32.0, 0.0], corner + [3.0, 2.0, 0.0], 7)
    _, near = cKDTree(mesh.positions).query(line, k=6)
    normals = vertex_normals(mesh.positions, mesh.faces)[near].mean(axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    points = mesh.positions[near].mean(axis=1) - DEPTH * normals
    return points * [side, 1.0, 1.0], normals.mean(axis=0) * [side, 1.0, 1.0]


@cache
def smiling_muscles(radius: float = 14.0) -> MuscleSet:
    """Return a zygomaticus of one fibre on each side of the built-in head."""
    muscles = []
    for side, name in ((1.0, "l"), (-1.0, "r")):
        points, out = cheek_points(side)
        fibres = [fibre(points, out.tolist())]
        muscles.append(
            muscle(f"zygomaticus_major_{name}", fibres, max_contraction=0.4, radius=radius)
        )
    return MuscleSet(tuple(muscles))


@cache
def smiling(parameters: SpringParameters | None = None) -> SpringFace:
    """Return the built-in head on these two muscles."""
    attachment = None
    if parameters is not None and parameters.holding == "bone":
        surface = SkinSurface.build(builtin_mechanics())
        attachment = builtin_bones(builtin_mechanics()).under(surface, max_depth=16.0)
    return SpringFace.of_muscles(
        builtin_head(),
        smiling_muscles(),
        attachment=attachment,
        mechanics=builtin_mechanics(),
        parameters=parameters,
    )
