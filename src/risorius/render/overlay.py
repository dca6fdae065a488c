"""Lines and dots in space, drawn over a picture: landmarks, muscles, vectors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, as_number, as_points
from risorius.errors import ShapeError
from risorius.render.camera import Camera
from risorius.render.colours import display_rgb, linear_rgb
from risorius.render.kernels.stroke import stamp
from risorius.render.scene import Float32Array

__all__ = ["Marker", "Overlay", "Polyline", "draw_overlay"]


@dataclass(frozen=True, eq=False)
class Overlay:
    """What lines and dots have in common.

    Parameters
    ----------
    positions : (k, 3) array_like
        Points [mm].
    colour : (3,) tuple
        Linear RGB in 0..1; overlays are not lit.
    width : float
        Thickness of the line or diameter of the dots [pixels].
    opacity : float
        Opacity of what is in view, in 0..1.
    hidden_opacity : float
        Opacity of what is behind an opaque surface, in 0..1.
    """

    positions: FloatArray
    colour: tuple[float, float, float] = linear_rgb("#2f6fd0")
    width: float = 2.0
    opacity: float = 1.0
    hidden_opacity: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "positions", as_points("positions", self.positions))
        if np.shape(self.colour) != (3,):
            raise ShapeError(f"colour: expected shape (3,), got {np.shape(self.colour)}")
        as_number("width", self.width, low=0.0, high=1000.0)
        as_number("opacity", self.opacity, low=0.0, high=1.0)
        as_number("hidden_opacity", self.hidden_opacity, low=0.0, high=1.0)

    def strokes(self) -> FloatArray:
        """Return the pieces (k, 2, 3) to be drawn, both ends of each [mm]."""
        return np.repeat(self.positions[:, None], 2, axis=1)


class Marker(Overlay):
    """Dots at `positions`."""


class Polyline(Overlay):
    """A line through `positions`."""

    def strokes(self) -> FloatArray:
        """Return the segments (k - 1, 2, 3) of the line, both ends of each [mm]."""
        return np.stack([self.positions[:-1], self.positions[1:]], axis=1)


def draw_overlay(
    overlay: Overlay,
    camera: Camera,
    picture: Float32Array,
    inverse_depth: Float32Array,
    *,
    lift: float,
    scratch: Float32Array,
) -> None:
    """Draw `overlay` upon `picture`.

    Parameters
    ----------
    overlay : Overlay
    camera : Camera
    picture : (h, w, 3) float32
        sRGB in 0..255.
    inverse_depth : (i, j) float32
        Of the opaque surfaces for each sample, i and j multiples of h and w [1/mm].
    lift : float
        How far the overlay is pulled to the front [mm], so that points on a surface are not
        half buried in it.
    scratch : (h, w) float32
        Zero before and after.
    """
    height, width = scratch.shape
    ends = _clipped(overlay.strokes(), camera)
    if not len(ends):
        return
    projected = camera.project(ends.reshape(-1, 3), (width, height)).reshape(-1, 2, 3)
    colour: npt.NDArray[np.float64] = display_rgb(overlay.colour).astype(np.float64)
    stamp(
        *(projected, 0.5 * overlay.width, lift, inverse_depth, len(inverse_depth) // height),
        *(colour, overlay.opacity, overlay.hidden_opacity, scratch, picture),
    )


def _clipped(strokes: FloatArray, camera: Camera) -> FloatArray:
    """Return the parts of `strokes` (k, 2, 3) beyond the near plane."""
    depth = (strokes - camera.eye) @ camera.axes[2]
    kept = (depth > camera.near).any(axis=1)
    strokes, depth = strokes[kept].copy(), depth[kept]
    for end in (0, 1):
        cut = depth[:, end] <= camera.near
        near, far = depth[cut, end], depth[cut, 1 - end]
        part = (1.001 * camera.near - near) / (far - near)
        other = strokes[cut, 1 - end]
        strokes[cut, end] += np.minimum(part, 1.0)[:, None] * (other - strokes[cut, end])
    return strokes
