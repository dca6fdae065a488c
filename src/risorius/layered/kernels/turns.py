# pyright: basic
"""The best rotation of every vertex's edges, and what it pushes its neighbours by.

The rotation is found by turning towards the covariance of rest and posed edges about its own
torque (Mueller et al. 2016, "A robust method to extract the rotational part of deformations"):
no decomposition, never a reflection.
"""

import math

import numpy as np
from numba import njit

__all__ = ["best_turns", "turn_forces"]

_ROUNDS = 24
# The torque shrinks fast: what is left after a step this small does not show [rad].
_STILL = 1e-4


@njit(cache=True, nogil=True, error_model="numpy")
def _turn(covariance, rotation):
    """Turn `rotation` (3, 3) in place to the rotational part of `covariance` (3, 3)."""
    for _ in range(_ROUNDS):
        x = y = z = size = 0.0
        for k in range(3):
            rx, ry, rz = rotation[0, k], rotation[1, k], rotation[2, k]
            ax, ay, az = covariance[0, k], covariance[1, k], covariance[2, k]
            x += ry * az - rz * ay
            y += rz * ax - rx * az
            z += rx * ay - ry * ax
            size += rx * ax + ry * ay + rz * az
        scale = 1.0 / (abs(size) + 1e-12)
        x, y, z = x * scale, y * scale, z * scale
        angle = math.sqrt(x * x + y * y + z * z)
        if angle < 1e-12:
            return
        x, y, z = x / angle, y / angle, z / angle
        s, c = math.sin(angle), math.cos(angle)
        for k in range(3):
            rx, ry, rz = rotation[0, k], rotation[1, k], rotation[2, k]
            along = (x * rx + y * ry + z * rz) * (1.0 - c)
            rotation[0, k] = rx * c + (y * rz - z * ry) * s + x * along
            rotation[1, k] = ry * c + (z * rx - x * rz) * s + y * along
            rotation[2, k] = rz * c + (x * ry - y * rx) * s + z * along
        if angle < _STILL:
            return


@njit(cache=True, nogil=True, error_model="numpy")
def best_turns(starts, columns, weights, rest, moved, turns):
    """Write into `turns` (n, 3, 3) the rotation of each vertex's edges, minus the identity.

    `starts` (n + 1,) and `columns` (e,) list the neighbours, `weights` (e,) their stiffness,
    `rest` and `moved` (n, 3) places and displacements.
    """
    covariance = np.empty((3, 3))
    rotation = np.empty((3, 3))
    for i in range(len(starts) - 1):
        covariance[:] = 0.0
        still = True
        for e in range(starts[i], starts[i + 1]):
            j = columns[e]
            for a in range(3):
                posed = rest[i, a] - rest[j, a] + moved[i, a] - moved[j, a]
                if moved[i, a] != moved[j, a]:
                    still = False
                for b in range(3):
                    covariance[a, b] += weights[e] * posed * (rest[i, b] - rest[j, b])
        if still:
            turns[i] = 0.0
            continue
        rotation[:] = 0.0
        for a in range(3):
            rotation[a, a] = 1.0
        _turn(covariance, rotation)
        turns[i] = rotation
        for a in range(3):
            turns[i, a, a] -= 1.0


@njit(cache=True, nogil=True, error_model="numpy")
def turn_forces(starts, columns, weights, rest, turns, forces):
    """Write into `forces` (n, 3) what turned edges push each vertex by."""
    for i in range(len(starts) - 1):
        x = y = z = 0.0
        for e in range(starts[i], starts[i + 1]):
            j = columns[e]
            dx, dy, dz = rest[i, 0] - rest[j, 0], rest[i, 1] - rest[j, 1], rest[i, 2] - rest[j, 2]
            w = 0.5 * weights[e]
            x += w * (
                (turns[i, 0, 0] + turns[j, 0, 0]) * dx
                + (turns[i, 0, 1] + turns[j, 0, 1]) * dy
                + (turns[i, 0, 2] + turns[j, 0, 2]) * dz
            )
            y += w * (
                (turns[i, 1, 0] + turns[j, 1, 0]) * dx
                + (turns[i, 1, 1] + turns[j, 1, 1]) * dy
                + (turns[i, 1, 2] + turns[j, 1, 2]) * dz
            )
            z += w * (
                (turns[i, 2, 0] + turns[j, 2, 0]) * dx
                + (turns[i, 2, 1] + turns[j, 2, 1]) * dy
                + (turns[i, 2, 2] + turns[j, 2, 2]) * dz
            )
        forces[i, 0], forces[i, 1], forces[i, 2] = x, y, z
