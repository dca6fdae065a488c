# pyright: basic
# ruff: noqa: PLR0913, PLR0917
"""Springs, one pose in float64, spring after spring: the reference, and the leapfrog around it."""

import math

from numba import njit

from risorius.solvers.kernels.formulas import FLAGS, measure_distance

__all__ = ["add_anchors", "add_edges", "leapfrog"]


@njit(**FLAGS)
def add_edges(x, t, forces):
    """Add to `forces` (n, 3) what the biphasic edges of the tables `t` exert at `x` (n, 3).

    Stiffness k up to the knee length L1, beta k beyond (Kaehler et al. 2001, section 4):
    ``f = k (L - L0) + (beta - 1) k max(L - L1, 0)``, continuous at L1.
    """
    for e in range(t.rest_lengths.size):
        i, j = t.edges[e, 0], t.edges[e, 1]
        dx, dy, dz, length, per_length = measure_distance(
            x[i, 0], x[i, 1], x[i, 2], x[j, 0], x[j, 1], x[j, 2]
        )
        beyond = max(length - t.knee_lengths[e], 0.0)
        pull = t.stiffness[e] * (length - t.rest_lengths[e] + t.stiffening * beyond)
        pull *= per_length
        forces[i, 0] -= pull * dx
        forces[i, 1] -= pull * dy
        forces[i, 2] -= pull * dz
        forces[j, 0] += pull * dx
        forces[j, 1] += pull * dy
        forces[j, 2] += pull * dz


@njit(**FLAGS)
def add_anchors(x, t, forces):
    """Add what springs to moving anchors and the holds exert."""
    for a in range(t.anchored.size):
        i = t.anchored[a]
        dx, dy, dz, length, per_length = measure_distance(
            x[i, 0], x[i, 1], x[i, 2], t.anchors[a, 0], t.anchors[a, 1], t.anchors[a, 2]
        )
        pull = t.anchor_stiffness[a] * (length - t.anchor_lengths[a]) * per_length
        forces[i, 0] -= pull * dx
        forces[i, 1] -= pull * dy
        forces[i, 2] -= pull * dz
    for i in range(len(x)):
        for axis in range(3):
            forces[i, axis] += t.load[i, axis] - t.hold_stiffness[i] * (
                x[i, axis] - t.hold_targets[i, axis]
            )


@njit(**FLAGS)
def leapfrog(x, v, t, forces, dt, drag, kinetic, tolerance, limit):
    """Move `x` and `v` (n, 3) by up to `limit` steps; return the steps taken and the residual.

    ``v += dt f / m; x += dt v`` with drag ``v *= exp(-drag dt)``. With `kinetic`, all velocities
    are reset whenever the forces work against the motion: the energy of motion has just peaked.
    Ends when no force exceeds `tolerance` times its mass.
    """
    kept = math.exp(-drag * dt)
    residual = 0.0
    for step in range(limit):
        forces[:] = 0.0
        add_edges(x, t, forces)
        add_anchors(x, t, forces)
        residual = 0.0
        power = 0.0
        for i in range(len(x)):
            w = t.inv_mass[i]
            square = 0.0
            for axis in range(3):
                f = forces[i, axis] * w
                square += f * f
                power += forces[i, axis] * v[i, axis]
            residual = max(residual, square)
        if residual <= tolerance * tolerance or not residual < 1e24:
            return step, math.sqrt(residual)
        if kinetic and power < 0.0:
            v[:] = 0.0
        for i in range(len(x)):
            for axis in range(3):
                v[i, axis] = kept * (v[i, axis] + dt * t.inv_mass[i] * forces[i, axis])
                x[i, axis] += dt * v[i, axis]
    return limit, math.sqrt(residual)
