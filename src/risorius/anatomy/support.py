"""What bone, teeth and fat do to moving skin: it slides over them instead of sinking in."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray

__all__ = ["support_directions"]

# Half axes of the ellipsoid that stands for the front of the skull, in face heights.
_AXES = (0.62, 1.25, 0.85)


def support_directions(points: FloatArray, *, hinge: FloatArray, face_height: float) -> FloatArray:
    """Return the outward unit normal (n, 3) of the support beneath each point.

    The normals of an ellipsoid about the middle of the condyles: smooth, and the same for the
    lining of the lips as for their outside, where the skin's own normals turn over.

    Parameters
    ----------
    points : (n, 3) float64
        Skin, canonical frame [mm].
    hinge : (3,) float64
        Middle of the condyles [mm].
    face_height : float
        Eyes to chin [mm].
    """
    axes = face_height * np.asarray(_AXES)
    normal = (points - hinge) / (axes * axes)
    return normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
