"""Tell what can be seen."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from risorius._check import BoolArray, as_points
from risorius.errors import ShapeError
from risorius.spatial.raycast import Scene

__all__ = ["visible_along", "visible_from"]

# Obstacles nearer to the point than this share of the scene's size are the point's own surface.
_CONTACT = 1e-4


def visible_from(scene: Scene, points: npt.ArrayLike, eye: npt.ArrayLike) -> BoolArray:
    """Return which points (q,) an eye can see.

    Parameters
    ----------
    scene : Scene
        What stands in the way; the surface that the points lie on may be part of it.
    points : (q, 3) array_like
        Points [mm].
    eye : (3,) array_like
        Where the eye is [mm].
    """
    goals, eyes = as_points("points", points), as_points("eye", np.atleast_2d(eye))
    if len(eyes) != 1:
        raise ShapeError(f"eye: expected one position (3,), got {len(eyes)}")
    away = goals - eyes
    distance = np.linalg.norm(away, axis=1)
    seen = np.ones(len(goals), bool)
    rows = np.flatnonzero(distance > 0.0)
    hits = scene.cast(np.broadcast_to(eyes, (len(rows), 3)), away[rows])
    seen[rows] = hits.distance >= distance[rows] - _CONTACT * scene.bounds[1]
    return seen


def visible_along(scene: Scene, points: npt.ArrayLike, direction: npt.ArrayLike) -> BoolArray:
    """Return which points (q,) can be seen from infinitely far away.

    Parameters
    ----------
    scene : Scene
        What stands in the way.
    points : (q, 3) array_like
        Points [mm].
    direction : (3,) array_like
        From the points to the eye: (0, 0, 1) looks at a head from the front.
    """
    goals = as_points("points", points)
    towards = as_points("direction", np.atleast_2d(direction))
    towards = towards / np.linalg.norm(towards)
    middle, size = scene.bounds
    # Start outside of the scene and of the point itself.
    height = (goals - middle) @ towards[0]
    back = np.maximum(size - height, size)
    hits = scene.cast(goals + back[:, None] * towards, -towards[0])
    return hits.distance >= back - _CONTACT * size
