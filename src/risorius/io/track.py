"""Motion of a rig over time: weights of its targets and turns of the whole head."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.errors import ShapeError

__all__ = ["TurnTrack", "WeightTrack", "show_of_shapes"]

_SECONDS_PER_SHAPE = 1.0
_UNIT = 1e-6


@dataclass(frozen=True, eq=False)
class TurnTrack:
    """Turns of the whole head about one point.

    Parameters
    ----------
    pivot : (3,) float64
        The point that stays [file frame and unit].
    rotations : (k, 4) float64
        Unit quaternions (x, y, z, w) in the file's axes, one for each moment.
    """

    pivot: FloatArray
    rotations: FloatArray

    def __post_init__(self) -> None:
        if self.pivot.shape != (3,) or self.rotations.shape != (len(self.rotations), 4):
            raise ShapeError(
                f"turns: pivot {self.pivot.shape} and rotations {self.rotations.shape} must be "
                "(3,) and (k, 4)"
            )
        if (np.abs((self.rotations**2).sum(axis=1) - 1.0) > _UNIT).any():
            raise ShapeError("turns: rotations must be unit quaternions")


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
    turns : TurnTrack, optional
        How the whole head turns at the same moments.
    """

    times: FloatArray
    weights: npt.NDArray[np.float32]
    name: str = "stream"
    turns: TurnTrack | None = None

    def __post_init__(self) -> None:
        if self.weights.ndim != 2 or self.times.shape != (len(self.weights),):
            raise ShapeError(
                f"track: times {self.times.shape} and weights {self.weights.shape} must be (k,) "
                "and (k, t)"
            )
        if not len(self.times) or self.times[0] < 0.0 or (np.diff(self.times) <= 0.0).any():
            raise ShapeError("track: there must be moments, and they must rise from 0 or above")
        if self.turns is not None and len(self.turns.rotations) != len(self.times):
            raise ShapeError(
                f"track: {len(self.turns.rotations)} turns for {len(self.times)} moments"
            )

    def require_fits(self, count: int) -> None:
        """Refuse a track that was not made for a rig of `count` targets.

        Raises
        ------
        ShapeError
            If it has another number of weights.
        """
        if self.weights.shape[1] != count:
            raise ShapeError(
                f"track: has weights of {self.weights.shape[1]} targets, the rig has {count}"
            )


def show_of_shapes(count: int) -> WeightTrack:
    """Return the track in which each of `count` shapes comes and goes, one after the other."""
    times = np.arange(2.0 * count + 1.0, dtype=np.float64) * (0.5 * _SECONDS_PER_SHAPE)
    weights = np.zeros((len(times), count), np.float32)
    weights[2 * np.arange(count) + 1, np.arange(count)] = 1.0
    return WeightTrack(times, weights, "shapes")
