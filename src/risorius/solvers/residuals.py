"""How far the constraints of a model are from being kept."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from risorius._check import FloatArray
from risorius.solvers import gradients
from risorius.solvers.constraints import Areas, Bends, Distances
from risorius.solvers.model import Control, Model

__all__ = ["Residual", "residuals", "rest_weights"]


class Residual(NamedTuple):
    """Errors of all constraints of one kind, as numbers without unit.

    Lengths, areas and volumes relative to their rest values, angles in radians, gaps to targets
    relative to the model's size.
    """

    largest: float
    mean_square_root: float


def _summed(errors: FloatArray) -> Residual:
    if not errors.size:
        return Residual(0.0, 0.0)
    return Residual(float(np.abs(errors).max()), float(np.sqrt(np.mean(errors**2))))


def residuals(
    model: Model, positions: FloatArray, control: Control | None = None
) -> dict[str, Residual]:
    """Return the residual of every kind of constraint of one pose."""
    c = model.constraints
    control = control or Control()
    length = gradients.distance_value(positions[c.distances.particles])
    short = np.maximum(c.distances.rest, 1e-9 * max(model.size, 1e-300))
    area = gradients.area_value(positions[c.areas.particles])
    turn = gradients.bend_value(positions[c.bends.particles]) - c.bends.rest
    wanted = control.rest_volumes
    volumes = [
        gradients.volume_value(positions, volume.faces, holes=volume.holes) / rest - 1.0
        for volume, rest in zip(
            c.volumes, [v.rest for v in c.volumes] if wanted is None else np.ravel(wanted)
        )
    ]
    targets = control.targets
    if targets is None:
        targets = model.rest_positions[c.holds.particles]
    gaps = gradients.hold_value(positions[c.holds.particles], targets) / max(model.size, 1e-300)
    return {
        "holds": _summed(gaps),
        "distances": _summed((length - c.distances.rest) / short),
        "areas": _summed(area / c.areas.rest - 1.0),
        "bends": _summed((turn + np.pi) % (2.0 * np.pi) - np.pi),
        "volumes": _summed(np.asarray(volumes)),
    }


def rest_weights(model: Model, table: Distances | Areas | Bends) -> FloatArray:
    """Return W = sum w |grad C|^2 (k,) of every constraint of a table at rest."""
    gradient: Callable[[FloatArray], FloatArray] = {
        Distances: gradients.distance_gradient,
        Areas: gradients.area_gradient,
        Bends: gradients.bend_gradient,
    }[type(table)]
    squares = (gradient(model.rest_positions[table.particles]) ** 2).sum(axis=-1)
    return (model.weights[table.particles] * squares).sum(axis=-1)
