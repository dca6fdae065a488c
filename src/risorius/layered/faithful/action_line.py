"""Action lines: polylines of surface points over several surfaces, and samples on them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray, as_number
from risorius.anatomy.outwards import unit
from risorius.errors import ParameterError, ShapeError
from risorius.layered.faithful.parameters import FaithfulParameters
from risorius.mesh.core import TriMesh
from risorius.mesh.surface_point import SurfacePoints
from risorius.spatial.closest import closest_points
from risorius.spatial.raycast import Scene

__all__ = ["ActionLine", "Ground", "GroundHits", "sample_line", "split_segment"]

# Rays start this far outside what they look for, and end as far inside [mm].
_OUTSIDE, _REACH = 60.0, 130.0
# A hit farther than this below the drawn point is the far side of a hollow [mm].
_DEEPEST = 15.0
# Points nearer to one another than this are one point [mm].
_SAME = 1e-6

Outwards = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True, eq=False)
class ActionLine:
    """An ordered row of surface points, from origin to insertion, or around an opening.

    Parameters
    ----------
    points : SurfacePoints
        On the faces of all surfaces together; they follow bone and muscle.
    closed : bool
        Whether the last point is joined to the first.
    """

    points: SurfacePoints
    closed: bool = False

    def __post_init__(self) -> None:
        if len(self.points) < 2:
            raise ShapeError(
                f"action line: {len(self.points)} distinct surface points are no line; draw at "
                "least two"
            )

    def places(self, positions: FloatArray, faces: IntArray) -> FloatArray:
        """Return where the points (k, 3) are now [mm]."""
        return self.points.interpolate(positions, faces)

    @property
    def reversed(self) -> ActionLine:
        """The line from its other end."""
        return ActionLine(self.points.take(np.arange(len(self.points))[::-1]), self.closed)


@dataclass(frozen=True, eq=False)
class Ground:
    """The deeper surfaces that a muscle is laid on.

    Parameters
    ----------
    positions : (n, 3) float64
        Vertices of all surfaces [mm].
    faces : (m, 3) int32
        Faces of all surfaces.
    rows : (k,) int32
        Those of them that belong to the ground.
    out : callable
        The direction (q, 3) out of the head at points (q, 3): averaged normals of rims and teeth
        point anywhere (finding S10).
    parameters : FaithfulParameters
    """

    positions: FloatArray
    faces: IntArray
    rows: IntArray
    out: Outwards
    parameters: FaithfulParameters

    @cached_property
    def mesh(self) -> TriMesh:
        """The ground alone, on all vertices."""
        return TriMesh(self.positions, self.faces[self.rows])

    @cached_property
    def _scene(self) -> Scene:
        return Scene([self.mesh])

    def project(self, points: FloatArray) -> tuple[SurfacePoints, BoolArray]:
        """Return the surface points (q,) under `points`, and which (q,) missed.

        They name faces of the ground's own mesh, where rays from outside meet it; where rays miss,
        over holes of the bone, the closest point.
        """
        out = self.out(points)
        hits = self.cast(points + _OUTSIDE * out, -out, _REACH)
        face, bary = hits.faces.copy(), hits.bary.copy()
        missed = (face < 0) | ~(hits.distance < _OUTSIDE + _DEEPEST)
        if missed.any():
            near = closest_points(self.mesh, points[missed]).surface_points()
            face[missed], bary[missed] = near.faces, near.bary
        return SurfacePoints(face, bary), missed

    def lay(
        self, points: FloatArray, *, closed: bool = False, name: str = "action line"
    ) -> ActionLine:
        """Return the action line through `points`, its segments split over what lies between.

        Parameters
        ----------
        points : (k, 3) float64
            As drawn [mm].
        closed : bool
            Whether the last point is joined to the first.
        name : str
            What a refusal calls the line.

        Raises
        ------
        ShapeError
            If fewer than two distinct points remain.
        """
        own, _ = self.project(points)
        places = own.positions(self.mesh)
        gap = np.linalg.norm(np.diff(places, axis=0), axis=1)
        own = own.take(np.concatenate([[True], gap > _SAME]))
        if len(own) < 2:
            raise ShapeError(
                f"{name}: {len(own)} distinct surface points are no line; draw at least two"
            )
        rows = [own.take([0])]
        ends = [*range(1, len(own)), 0] if closed else [*range(1, len(own))]
        for end in ends:
            start = own.take([end - 1 if end else len(own) - 1])
            last = own.take([end])
            rows += split_segment(self, start, last)
            if end:
                rows.append(last)
        face = np.concatenate([row.faces for row in rows])
        bary = np.concatenate([row.bary for row in rows])
        return ActionLine(SurfacePoints(self.rows[face], bary), closed)

    def cast(self, origins: FloatArray, directions: FloatArray, reach: float) -> GroundHits:
        """Return the first hits of rays from origins (q, 3) along directions (q, 3) [mm]."""
        hits = self._scene.cast(origins, directions, max_distance=reach)
        return GroundHits(hits.distance, hits.face, np.nan_to_num(hits.bary))


@dataclass(frozen=True, eq=False)
class GroundHits:
    """Where rays meet the ground.

    Parameters
    ----------
    distance : (q,) float64
        Infinite on a miss [mm].
    faces : (q,) int32
        Faces of the ground's own mesh, -1 on a miss.
    bary : (q, 3) float64
    """

    distance: FloatArray
    faces: IntArray
    bary: FloatArray


def split_segment(
    ground: Ground, start: SurfacePoints, end: SurfacePoints, *, level: int = 0
) -> list[SurfacePoints]:
    """Return the surface points between two, so that the line lies on the ground (spec 2.3).

    From half a segment outside its middle a ray looks for the ground: under a convex part as
    well as over a concave one. Ground deeper than the gap is bridged.
    """
    p = ground.parameters
    first, last = start.positions(ground.mesh)[0], end.positions(ground.mesh)[0]
    length = float(np.linalg.norm(last - first))
    if level > p.split_levels or length < 1.0:
        return []
    middle = 0.5 * (first + last)[None]
    out = ground.out(middle)
    reach = 0.5 * length
    hits = ground.cast(middle + reach * out, -out, 2.0 * reach)
    if hits.faces[0] < 0:
        return []
    depth = float(hits.distance[0]) - reach
    if depth > p.split_gap * length or abs(depth) <= p.split_tolerance * length:
        return []
    found = SurfacePoints(hits.faces, hits.bary)
    before = split_segment(ground, start, found, level=level + 1)
    return [*before, found, *split_segment(ground, found, end, level=level + 1)]


def sample_line(
    values: FloatArray,
    count: int,
    *,
    contraction: float = 0.0,
    closed: bool = False,
    along: FloatArray | None = None,
) -> FloatArray:
    """Return samples (count, d) of a polyline, drawn together towards its first point.

    ``a_i = (1 - c) i / (N - 1) L`` along the current length, i / N on a closed line (thesis 4.1-
    4.5, erratum E9).

    Parameters
    ----------
    values : (k, d) float64
        Points of the line [mm], or normals at them.
    count : int
    contraction : float
        c, below 1.
    closed : bool
    along : (k, 3) float64, optional
        Points whose lengths count, where `values` are not the points themselves [mm].

    Raises
    ------
    ParameterError
        If c is not in [0, 1).
    """
    as_number("contraction", contraction, low=0.0)
    if contraction >= 1.0:
        raise ParameterError(f"contraction: {contraction:g} leaves no length; keep it below 1")
    places = values if along is None else along
    if closed:
        places = np.concatenate([places, places[:1]])
        values = np.concatenate([values, values[:1]])
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    length = np.concatenate([[0.0], np.cumsum(steps)])
    share = np.arange(count) / (count if closed else max(count - 1, 1))
    wanted = (1.0 - contraction) * share * length[-1]
    result = np.empty((count, values.shape[1]))
    for axis in range(values.shape[1]):
        result[:, axis] = np.interp(wanted, length, values[:, axis])
    return unit(result) if along is not None else result
