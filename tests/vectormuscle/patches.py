"""Flat and curved pieces of skin with made-up muscles on them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import BoolArray, FloatArray
from risorius.anatomy.regions import REGIONS, Regions
from risorius.mesh.core import TriMesh
from risorius.mesh.normals import vertex_normals
from risorius.vectormuscle.kinds import LinearMuscle
from risorius.vectormuscle.muscle import FaceContext
from tests.face_fixtures import builtin_face


def patch(columns: int = 41, rows: int = 61, *, step: float = 1.0, bulge: float = 0.0) -> TriMesh:
    """Return a sheet that faces +z, symmetric about x = 0, from y = 0 down to -(rows - 1) step.

    `bulge` bends it backwards by ``bulge (x^2 + y^2)``.
    """
    x, y = np.meshgrid(step * (np.arange(columns) - (columns - 1) / 2), -step * np.arange(rows))
    positions = np.stack([x, y, -bulge * (x * x + y * y)], axis=-1).reshape(-1, 3)
    grid = np.arange(columns * rows).reshape(rows, columns)
    a, b, c, d = (g.ravel() for g in (grid[:-1, :-1], grid[:-1, 1:], grid[1:, :-1], grid[1:, 1:]))
    return TriMesh(positions, np.concatenate([np.stack([a, c, b], 1), np.stack([b, c, d], 1)]))


def context(
    mesh: TriMesh, *, lower: BoolArray | None = None, support: float = 0.0, **changes: Any
) -> FaceContext:
    """Return what muscles see of a patch: one region (upper), or lower where `lower` (n,)."""
    weights = np.zeros((mesh.vertex_count, len(REGIONS) - 1))
    where = np.zeros(mesh.vertex_count, bool) if lower is None else lower
    weights[:, REGIONS.index("upper")] = ~where
    weights[:, REGIONS.index("lower")] = where
    normals = vertex_normals(mesh.positions, mesh.faces)
    values: dict[str, Any] = {
        "positions": mesh.positions,
        "normals": normals,
        "mechanics": builtin_face().mechanics,
        "regions": Regions(weights, np.ones(mesh.vertex_count)),
        "angular": "smooth",
        "outward": normals,
        "support": support,
    }
    return FaceContext(**(values | changes))


def linear(**changes: Any) -> LinearMuscle:
    """Return a muscle that hangs down from the middle of the upper edge of a patch."""
    values: dict[str, Any] = {
        "name": "pull",
        "origin": np.zeros(3),
        "insertion": np.array([0.0, -30.0, 0.0]),
        "start_radius": 30.0,
        "finish_radius": 50.0,
        "half_angle": 35.0,
    }
    return LinearMuscle(**(values | changes))


def move_by(muscle: LinearMuscle, mesh: TriMesh, contraction: float = 1.0) -> FloatArray:
    """Return the displacement (n, 3) of a patch by one muscle in one step."""
    bound = muscle.bind(context(mesh))
    result = np.zeros_like(mesh.positions)
    result[bound.vertices] = bound.displace(mesh.positions[bound.vertices], contraction)
    return result


def local_maxima(values: npt.ArrayLike) -> int:
    """Return how many inner entries of a row of values exceed both neighbours."""
    v = np.asarray(values)
    return int(((v[1:-1] > v[:-2]) & (v[1:-1] > v[2:])).sum())
