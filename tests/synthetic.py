"""Small made-up heads for tests: only their landmarks look like a face."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from risorius.landmarks import Landmark, LandmarkSet, mirror_name
from risorius.mesh.polygon_mesh import PolygonMesh

# Canonical frame [mm]; the right side follows by mirroring.
_LEFT_AND_CENTRE = {
    "2.1": (0.0, -115.0, 75.0),
    "2.2": (0.0, -72.0, 86.0),
    "2.3": (0.0, -72.5, 86.0),
    "2.4": (22.0, -73.0, 74.0),
    "2.6": (11.0, -72.0, 83.0),
    "2.8": (11.0, -72.6, 83.0),
    "3.7": (46.0, -1.0, 60.0),
    "3.11": (17.0, 1.0, 68.0),
    "8.1": (0.0, -66.0, 90.0),
    "8.2": (0.0, -82.0, 89.0),
    "8.3": (25.0, -73.0, 73.0),
    "8.5": (12.0, -66.0, 86.0),
    "8.7": (12.0, -81.0, 85.0),
    "9.3": (0.0, -45.0, 104.0),
    "10.1": (72.0, 10.0, -10.0),
}


def landmark_points() -> dict[str, tuple[float, float, float]]:
    """Return the places of 26 landmarks of an adult in the canonical frame [mm]."""
    points = dict(_LEFT_AND_CENTRE)
    for name, (x, y, z) in _LEFT_AND_CENTRE.items():
        if mirror_name(name) != name:
            points[mirror_name(name)] = (-x, y, z)
    return points


def landmark_set(
    points: Mapping[str, npt.ArrayLike] | None = None,
    *,
    rotation: npt.ArrayLike | None = None,
    scale: float = 1.0,
    origin: npt.ArrayLike = (0.0, 0.0, 0.0),
) -> LandmarkSet:
    """Return landmarks, one vertex each, moved by ``scale * rotation @ p + origin``."""
    points = landmark_points() if points is None else points
    turn = np.eye(3) if rotation is None else np.asarray(rotation)
    places = scale * np.array([*points.values()], dtype=np.float64) @ turn.T + np.asarray(origin)
    marks = [Landmark(name, (vertex,), (1.0,)) for vertex, name in enumerate(points)]
    return LandmarkSet(marks, places)


def quad_mesh() -> PolygonMesh:
    """Return a unit square, a triangle on it and a pentagon beside it: 8 vertices."""
    positions = np.array(
        [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.5, 2.0, 0.0],
            [2.0, -0.5, 0.0],
            [3.0, 0.5, 0.0],
            [2.0, 1.5, 0.0],
        ]
    )
    return PolygonMesh.from_polygons(positions, [[0, 1, 2, 3], [3, 2, 4], [1, 5, 6, 7, 2]])
