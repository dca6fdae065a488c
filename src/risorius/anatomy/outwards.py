"""The direction out of the head, for laying muscles on bone."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.template import builtin_head

__all__ = ["outwards", "unit"]

# The axis of a capsule inside the skull, in its own space: from y to y at depth z [mm].
_LOW, _HIGH, _DEPTH = -95.0, 30.0, 10.0


def unit(vectors: FloatArray) -> FloatArray:
    """Return `vectors` (..., 3) at length 1; zero stays zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.maximum(length, 1e-12)


def outwards(points: FloatArray) -> FloatArray:
    """Return the unit direction (q, 3) out of the built-in skull at `points` (q, 3).

    Away from the axis of a capsule: smooth everywhere, where averaged normals of rims and teeth
    point anywhere (finding S10). Canonical frame of the built-in head.
    """
    shift = builtin_head().frame.to_canonical(np.zeros((1, 3)))[0]
    centre = np.zeros_like(points)
    centre[:, 1] = np.clip(points[:, 1], _LOW + shift[1], _HIGH + shift[1])
    centre[:, 2] = _DEPTH + shift[2]
    return unit(points - centre)
