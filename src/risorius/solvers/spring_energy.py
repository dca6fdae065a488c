"""The energy whose gradient the forces of a spring network are."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.solvers.springs import SpringControl, SpringNetwork

__all__ = ["energy_at"]


def energy_at(network: SpringNetwork, positions: FloatArray, control: SpringControl) -> float:
    """Return the potential energy [force mm] at `positions` (n, 3) [mm].

    ``1/2 k (L - L0)^2 + 1/2 s k max(L - L1, 0)^2`` of an edge, ``1/2 k (L - L0)^2`` of an anchor
    spring, ``1/2 k |x - q|^2`` of a hold, ``-f.x`` of a load.
    """
    given = control.resolved(network)
    first, second = positions[network.edges[:, 0]], positions[network.edges[:, 1]]
    length = np.linalg.norm(first - second, axis=1)
    beyond = np.maximum(length - given["knee_lengths"], 0.0)
    squares = (length - given["rest_lengths"]) ** 2 + network.stiffening * beyond**2
    energy = 0.5 * float(network.stiffness @ squares)
    reach = np.linalg.norm(positions[network.anchored] - given["anchors"], axis=1)
    energy += 0.5 * float(given["anchor_stiffness"] @ (reach - network.anchor_lengths) ** 2)
    away = ((positions - given["hold_targets"]) ** 2).sum(axis=1)
    energy += 0.5 * float(given["hold_stiffness"] @ away)
    return energy - float((given["load"] * positions).sum())
