"""Many small pictures of one head from one place, as fast as they can be drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.render.bands import in_parallel
from risorius.render.camera import Camera
from risorius.render.heads import Portrait
from risorius.render.lights import Lights
from risorius.render.picture import OCCLUSION_SHARE, render
from risorius.render.scene import diagonal

__all__ = ["Series"]


@dataclass(frozen=True, eq=False)
class Series:
    """A head in many poses, all seen from the same place.

    What the camera sees in no pose is left out once for all, and several pictures are drawn at
    the same time. To the eye they are those that `Portrait.picture` draws.

    Parameters
    ----------
    portrait : Portrait
        What is left of the head.
    camera : Camera
    size : (width, height)
        Of each picture [pixels].
    lights : Lights
    """

    portrait: Portrait
    camera: Camera
    size: tuple[int, int]
    lights: Lights

    @staticmethod
    def of(portrait: Portrait, view: str, *, size: tuple[int, int]) -> Series:
        """Return the series of a named view.

        Raises
        ------
        ParameterError
            If there is no such view.
        LandmarkError
            If a close-up lacks its landmarks.
        """
        aspect = size[0] / size[1]
        camera = portrait.camera(view, aspect=aspect)
        radius = OCCLUSION_SHARE * diagonal(portrait.surfaces())
        lights = Lights(occlusion_radius=radius)
        return Series(portrait.seen_from(camera, aspect=aspect), camera, size, lights)

    def pictures(self, posed: Sequence[FloatArray]) -> list[npt.NDArray[np.uint8]]:
        """Return a picture (h, w, 3) of each pose, vertices (n, 3) [mm]."""

        def picture(positions: FloatArray) -> npt.NDArray[np.uint8]:
            surfaces = self.portrait.surfaces(positions)
            return render(surfaces, self.camera, size=self.size, lights=self.lights)

        return in_parallel(picture, posed)
