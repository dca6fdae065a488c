"""Ellipsoids on the segments of fibres: inside test, normal, closest point, rays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import BoolArray, FloatArray, IntArray, as_points, require_indices
from risorius.errors import ParameterError, ShapeError
from risorius.springmuscle.contraction import Contracted
from risorius.springmuscle.kernels.ellipsoid import cast_rays, closest_on
from risorius.springmuscle.muscle_set import MuscleSet

__all__ = ["Ellipsoids"]


@dataclass(frozen=True, eq=False)
class Ellipsoids:
    """s ellipsoids.

    Parameters
    ----------
    centres : (s, 3) float64
        [mm].
    frames : (s, 3, 3) float64
        Columns are unit vectors along the axes.
    half_axes : (s, 3) float64
        Positive [mm].
    """

    centres: FloatArray
    frames: FloatArray
    half_axes: FloatArray

    @staticmethod
    def of(muscles: MuscleSet, contracted: Contracted | None = None) -> Ellipsoids:
        """Return the ellipsoids of `muscles`, relaxed or as `contracted`."""
        if contracted is None:
            return Ellipsoids(muscles.centres, muscles.frames, muscles.half_axes)
        scale = np.linalg.norm(contracted.axes, axis=1)
        frames = contracted.axes / scale[:, None, :]
        return Ellipsoids(contracted.centres, frames, muscles.half_axes * scale)

    @property
    def count(self) -> int:
        """Number of ellipsoids."""
        return len(self.centres)

    def local(self, points: npt.ArrayLike, segments: npt.ArrayLike) -> FloatArray:
        """Return `points` (q, 3) in the coordinates of their ellipsoids `segments` (q,) [mm]."""
        places, which = self._pairs(points, segments)
        return np.einsum("qij,qi->qj", self.frames[which], places - self.centres[which])

    def inside(self, points: npt.ArrayLike, segments: npt.ArrayLike) -> BoolArray:
        """Return which points (q,) lie in their ellipsoids `segments` (q,), the surface included.

        ``|S^-1 R^T (x - m)| <= 1``.
        """
        local = self.local(points, segments)
        _, which = self._pairs(points, segments)
        return ((local / self.half_axes[which]) ** 2).sum(axis=1) <= 1.0

    def normals(self, points: npt.ArrayLike, segments: npt.ArrayLike) -> FloatArray:
        """Return the outward unit normals (q, 3) at `points` on their ellipsoids `segments` (q,).

        ``R S^-2 R^T (x - m)``, normalised; anywhere but in the centre it is that of the
        ellipsoid of the same shape through the point.
        """
        _, which = self._pairs(points, segments)
        steep = self.local(points, segments) / self.half_axes[which] ** 2
        normals = np.einsum("qij,qj->qi", self.frames[which], steep)
        return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)

    def closest(self, points: npt.ArrayLike, segments: npt.ArrayLike) -> FloatArray:
        """Return the nearest points (q, 3) on the surfaces of the ellipsoids `segments` (q,)."""
        _, which = self._pairs(points, segments)
        local = self.local(points, segments)
        feet = np.empty_like(local)
        closest_on(local, self.half_axes[which], feet)
        return self.centres[which] + np.einsum("qij,qj->qi", self.frames[which], feet)

    def cast(
        self, origins: npt.ArrayLike, directions: npt.ArrayLike
    ) -> tuple[FloatArray, IntArray]:
        """Return distance (q,) [mm] and ellipsoid (q,) of the first hit of rays; inf, -1 for none.

        Parameters
        ----------
        origins, directions : (q, 3) array_like
            Rays; directions of any length but zero. From inside, the far surface is hit.
        """
        start, ahead = as_points("origins", origins), as_points("directions", directions)
        if len(ahead) != len(start):
            raise ShapeError(f"directions: expected {len(start)} rows, got {len(ahead)}")
        length = np.linalg.norm(ahead, axis=1, keepdims=True)
        if (length == 0.0).any():
            raise ParameterError(f"directions: row {int(np.argmin(length))} is zero")
        distances, hit = np.full(len(start), np.inf), np.full(len(start), -1, np.int32)
        cast_rays(start, ahead / length, *self._tables, distances, hit)
        return distances, hit

    @property
    def _tables(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        return self.centres, np.ascontiguousarray(self.frames), self.half_axes

    def _pairs(self, points: npt.ArrayLike, segments: npt.ArrayLike) -> tuple[FloatArray, IntArray]:
        places = as_points("points", points)
        which = np.asarray(segments, np.int32)
        if which.shape != (len(places),):
            raise ShapeError(f"segments: expected {len(places)} numbers, got {which.shape}")
        require_indices("segments", which, count=self.count)
        return places, which
