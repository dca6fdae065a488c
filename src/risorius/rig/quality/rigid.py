"""Find the shapes in which a part moves as a rigid body."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from risorius._check import BoolArray, FloatArray

__all__ = ["RigidMotions", "rigid_motions"]

# A part is rigid in a shape if no vertex is off the best rigid motion by more than this [mm].
_TOLERANCE = 0.01


class RigidMotions(NamedTuple):
    """The best rigid motion of one part in every shape: ``posed = rotation @ rest + offset``.

    Parameters
    ----------
    rotation : (s, 3, 3) float64
    offset : (s, 3) float64
        [mm].
    fits : (s,) bool
        Whether the part really moves like that.
    """

    rotation: FloatArray
    offset: FloatArray
    fits: BoolArray


def rigid_motions(rest_positions: FloatArray, deltas: FloatArray) -> RigidMotions:
    """Fit rotation and translation to every shape by least squares.

    Parameters
    ----------
    rest_positions : (n, 3) float64
        The part at rest [mm].
    deltas : (s, n, 3) float64
        Its displacements [mm].

    References
    ----------
    Kabsch 1976, "A solution for the best rotation to relate two sets of vectors".
    """
    shapes = len(deltas)
    centre = rest_positions.mean(axis=0)
    arms = rest_positions - centre
    shift = deltas.mean(axis=1)
    posed = arms + deltas - shift[:, None]
    left, _, right = np.linalg.svd(np.einsum("ni,snj->sij", arms, posed))
    turn = np.sign(np.linalg.det(left @ right))
    right = right * np.stack([np.ones(shapes), np.ones(shapes), turn], axis=1)[:, :, None]
    rotation = np.swapaxes(left @ right, 1, 2)
    still = ~(deltas != 0.0).any(axis=(1, 2))
    rotation[still] = np.eye(3)
    error = np.einsum("sij,nj->sni", rotation, arms) - posed
    fits = np.linalg.norm(error, axis=2).max(axis=1, initial=0.0) <= _TOLERANCE
    offset = centre + shift - np.einsum("sij,j->si", rotation, centre)
    offset[still] = 0.0
    return RigidMotions(rotation, offset, fits)
