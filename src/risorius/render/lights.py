"""Lights that travel with the camera."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from risorius._check import FloatArray, as_number
from risorius.errors import ParameterError

__all__ = ["Light", "Lights"]

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Light:
    """A light far away.

    Parameters
    ----------
    towards : (3,) tuple
        Direction to the light as the camera sees it: right, up, towards the camera.
    colour : (3,) tuple
        Linear RGB, already multiplied by the intensity.
    """

    towards: Triple
    colour: Triple

    def row(self) -> FloatArray:
        """Return (6,): unit direction in the picture's axes (right, down, away), colour."""
        direction = np.array(self.towards, dtype=np.float64)
        length = float(np.linalg.norm(direction))
        if not (np.isfinite(length) and length > 0.0):
            raise ParameterError(f"towards: {self.towards} is not a direction")
        return np.concatenate([direction / length * [1.0, -1.0, -1.0], self.colour])


@dataclass(frozen=True)
class Lights:
    """Three lights, a sky and a floor, fixed to the camera.

    Parameters
    ----------
    key, fill, rim : Light
        The modelling light, its softer counterpart, and the one from behind.
    sky, ground : (3,) tuple
        Linear RGB of the ambient light from above and from below.
    occlusion : float
        How dark folds, nostrils and the inside of the mouth get: 0 off, 1 strong.
    occlusion_radius : float, optional
        How far away things still darken each other [mm]; default: 5 % of the diagonal of what
        is drawn.
    """

    key: Light = Light((-0.58, 0.52, 0.75), (1.12, 1.06, 0.98))
    fill: Light = Light((0.85, 0.12, 0.60), (0.24, 0.27, 0.32))
    rim: Light = Light((0.55, 0.55, -0.75), (0.55, 0.58, 0.64))
    sky: Triple = (0.34, 0.36, 0.40)
    ground: Triple = (0.15, 0.13, 0.12)
    occlusion: float = 1.0
    occlusion_radius: float | None = None

    def __post_init__(self) -> None:
        as_number("occlusion", self.occlusion, low=0.0, high=1.0)
        if self.occlusion_radius is not None:
            as_number("occlusion_radius", self.occlusion_radius, low=0.0)

    def rows(self) -> FloatArray:
        """Return (3, 6) directions and colours for the kernels."""
        return np.stack([light.row() for light in (self.key, self.fill, self.rim)])

    def mirrored(self) -> Lights:
        """Return the same lights with left and right exchanged."""

        def flip(light: Light) -> Light:
            x, y, z = light.towards
            return Light((-x, y, z), light.colour)

        return replace(self, key=flip(self.key), fill=flip(self.fill), rim=flip(self.rim))
