"""Where a picture is taken from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, as_number, as_points
from risorius.errors import ParameterError, ShapeError

__all__ = ["Camera", "picture_size"]

_LONGEST_SIDE = 16384


def picture_size(size: tuple[int, int]) -> tuple[int, int]:
    """Return `size` as (width, height) in pixels.

    Raises
    ------
    ParameterError
        Unless both are whole numbers in 1..16384.
    """
    try:
        width, height = (int(side) for side in size)
    except (TypeError, ValueError):
        raise ParameterError(f"size: {size!r} is not (width, height) in pixels") from None
    if not (1 <= width <= _LONGEST_SIDE and 1 <= height <= _LONGEST_SIDE):
        raise ParameterError(f"size: {width} x {height}, each side must lie in 1..{_LONGEST_SIDE}")
    return width, height


@dataclass(frozen=True, eq=False)
class Camera:
    """Pinhole camera: what lies at `target` appears in the middle of the picture.

    Parameters
    ----------
    eye, target : (3,) array_like
        Centre of projection and the point looked at [mm].
    up : (3,) array_like
        Direction that points up in the picture.
    fov_degrees : float
        Vertical angle of view [deg].

    Raises
    ------
    ParameterError
        If `eye` lies at `target`, `up` along the view, or the angle outside 0.1..170.
    """

    eye: FloatArray
    target: FloatArray
    up: FloatArray
    fov_degrees: float

    def __post_init__(self) -> None:
        for name in ("eye", "target", "up"):
            value = np.asarray(getattr(self, name), dtype=np.float64)
            if value.shape != (3,):
                raise ShapeError(f"{name}: expected shape (3,), got {value.shape}")
            object.__setattr__(self, name, as_points(name, value[None])[0])
        fov = as_number("fov_degrees", self.fov_degrees, low=0.1, high=170.0)
        object.__setattr__(self, "fov_degrees", fov)
        if not self.distance > 0.0:
            raise ParameterError("eye: lies at the target; move one of them")
        right = np.cross(self.target - self.eye, self.up)
        if np.linalg.norm(right) <= 1e-9 * self.distance * np.linalg.norm(self.up):
            raise ParameterError("up: is zero or points along the view; choose another direction")

    @property
    def distance(self) -> float:
        """Distance from `eye` to `target` [mm]."""
        return float(np.linalg.norm(self.target - self.eye))

    @property
    def near(self) -> float:
        """Depth before which nothing is drawn [mm]: a thousandth of `distance`."""
        return 1e-3 * self.distance

    @property
    def axes(self) -> FloatArray:
        """(3, 3) rows: the directions right, up and forward of the picture."""
        forward = (self.target - self.eye) / self.distance
        right = np.cross(forward, self.up)
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(right, forward), forward])

    def focal(self, height: int) -> float:
        """Return the focal length of a picture of `height` [pixels]."""
        return 0.5 * height / float(np.tan(np.radians(self.fov_degrees) / 2.0))

    def project(self, points: npt.ArrayLike, size: tuple[int, int]) -> FloatArray:
        """Return where `points` appear in a picture of `size` = (width, height).

        ``x = width / 2 + f r / d`` and ``y = height / 2 - f u / d`` with r, u, d the coordinates
        right, up and forward from the eye.

        Parameters
        ----------
        points : (n, 3) array_like
            Points [mm].

        Returns
        -------
        (n, 3) float64
            Column, row [pixels; the first pixel's centre is at 0.5] and depth along the view
            [mm]. Column and row are NaN for points that are not in front of the eye.
        """
        width, height = picture_size(size)
        view = (as_points("points", points) - self.eye) @ self.axes.T
        depth = view[:, 2]
        scale = np.full(len(view), np.nan)
        np.divide(self.focal(height), depth, out=scale, where=depth > 0.0)
        return np.stack(
            [width / 2 + scale * view[:, 0], height / 2 - scale * view[:, 1], depth], axis=1
        )

    @staticmethod
    def framing(
        points: npt.ArrayLike,
        *,
        yaw: float = 0.0,
        pitch: float = 0.0,
        margin: float = 1.1,
        fov_degrees: float = 15.0,
        aspect: float = 1.0,
    ) -> Camera:
        """Return the camera that just sees all `points`, by default from the front (+Z).

        Parameters
        ----------
        points : (n, 3) array_like
            What to look at [mm], for example the vertices of the head or of one eye.
        yaw, pitch : float
            Turn of the camera about the points [deg]; yaw > 0 shows the character's left
            side, pitch > 0 looks from above; pitch within +-89.
        margin : float
            Size of the picture over the size of the points in it.
        fov_degrees : float
            Vertical angle of view [deg]; small is flat as through a long lens.
        aspect : float
            Width over height of the picture to be taken.
        """
        focus = as_points("points", points)
        if not len(focus):
            raise ShapeError("points: at least one point is needed to frame a picture")
        margin = as_number("margin", margin, low=0.01, high=1000.0)
        aspect = as_number("aspect", aspect, low=0.01, high=100.0)
        fov = as_number("fov_degrees", fov_degrees, low=0.1, high=170.0)
        side = np.radians(as_number("yaw", yaw))
        lift = np.radians(as_number("pitch", pitch, low=-89.0, high=89.0))
        back = np.array([np.sin(side) * np.cos(lift), np.sin(lift), np.cos(side) * np.cos(lift)])
        up = np.array([0.0, 1.0, 0.0])
        right = np.array([np.cos(side), 0.0, -np.sin(side)])
        frame = np.stack([right, np.cross(back, right), back])
        seen = focus @ frame.T
        middle = (seen.min(axis=0) + seen.max(axis=0)) / 2.0
        seen -= middle
        slope = float(np.tan(np.radians(fov) / 2.0)) / margin
        reach = np.maximum(np.abs(seen[:, 0]) / aspect, np.abs(seen[:, 1])) / slope
        # Points in a row along the view have no size in the picture: keep off the first.
        distance = float(max((seen[:, 2] + reach).max(), 1.2 * seen[:, 2].max()))
        target = middle @ frame
        if distance <= 1e-9 * (1.0 + float(np.abs(target).max())):
            distance = 1.0
        return Camera(target + distance * back, target, up, fov)
