"""Weights over time, as the animation of a GLB."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.errors import ShapeError
from risorius.io.gltf.binary import BinaryBuilder

__all__ = ["WeightTrack", "show_of_shapes", "track_to_json"]

_SECONDS_PER_SHAPE = 1.0


@dataclass(frozen=True, eq=False)
class WeightTrack:
    """Weights of all targets of a rig over time, straight between the moments.

    Parameters
    ----------
    times : (k,) float64
        Rising from 0 or above [s].
    weights : (k, t) float32
        In the order of the rig's targets.
    name : str
        Of the animation.
    """

    times: FloatArray
    weights: npt.NDArray[np.float32]
    name: str = "stream"

    def __post_init__(self) -> None:
        if self.weights.ndim != 2 or self.times.shape != (len(self.weights),):
            raise ShapeError(
                f"track: times {self.times.shape} and weights {self.weights.shape} must be (k,) "
                "and (k, t)"
            )
        if not len(self.times) or self.times[0] < 0.0 or (np.diff(self.times) <= 0.0).any():
            raise ShapeError("track: there must be moments, and they must rise from 0 or above")


def show_of_shapes(count: int) -> WeightTrack:
    """Return the track in which each of `count` shapes comes and goes, one after the other."""
    times = np.arange(2.0 * count + 1.0, dtype=np.float64) * (0.5 * _SECONDS_PER_SHAPE)
    weights = np.zeros((len(times), count), np.float32)
    weights[2 * np.arange(count) + 1, np.arange(count)] = 1.0
    return WeightTrack(times, weights, "shapes")


def track_to_json(
    track: WeightTrack, nodes: Sequence[int], binary: BinaryBuilder
) -> dict[str, Any]:
    """Add a track to `binary` and return the animation that moves the weights of `nodes` by it."""
    sampler = {
        "input": binary.accessor(track.times.astype("<f4"), target=None, bounds=True),
        "output": binary.accessor(track.weights.astype("<f4").ravel(), target=None),
        "interpolation": "LINEAR",
    }
    targets = [{"node": node, "path": "weights"} for node in nodes]
    return {
        "name": track.name,
        "samplers": [sampler],
        "channels": [{"sampler": 0, "target": target} for target in targets],
    }
