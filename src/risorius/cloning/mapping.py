"""The mapping: the place on the source from which each target vertex takes its motion."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_matrix, eye

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.smooth_step import smooth_step
from risorius.cloning.evening import evening
from risorius.cloning.mouth_corners import CornerPlaces, MouthCorners
from risorius.cloning.seam_zones import seam_zones
from risorius.cloning.subject import Subject
from risorius.mesh.connectivity import edges
from risorius.mesh.core import TriMesh
from risorius.mesh.laplacian import SmoothField
from risorius.mesh.normals import vertex_normals
from risorius.spatial.closest import ClosestPoints, closest_points

__all__ = ["Mapping", "identity_filling", "map_skin"]

# Full motion up to the first distance from the source's surface, none beyond the second, as
# shares of the face's height: a bust may reach farther down than the source's neck.
_NEAR, _FAR = 0.05, 0.12
_TURNED = 75.0
# Neighbours that count for less do not set a vertex in motion.
_COUNTS = 0.02
# Barycentric shares below this are rounding.
_ROUNDING = 1e-9
# Over what distance places are evened out: at least the first [mm], or a share of the source's
# mean edge.
_EVEN, _EVEN_EDGES = 3.0, 0.3


@dataclass(frozen=True, eq=False)
class Mapping:
    """Place of every target vertex on the source.

    Parameters
    ----------
    faces : (n, 3) int32
        Source vertices of the face that a target vertex lies on.
    bary : (n, 3) float64
    distance : (n,) float64
        From the target vertex to that place [mm].
    weight : (n,) float64
        1 where the motion is taken over, 0 where the source has no skin near by.
    offset : (n, 3, 3) float64
        Place less each of the corners [mm].
    filling : (n, n) csr_matrix
        Replaces vertices whose place is in doubt by what lies around them; else the identity.
    """

    faces: IntArray
    bary: FloatArray
    distance: FloatArray
    weight: FloatArray
    offset: FloatArray
    filling: csr_matrix

    @property
    def unmapped(self) -> BoolArray:
        """(n,) mask of target vertices that take over nothing."""
        return self.weight == 0.0

    def moved(self, moves: BoolArray) -> BoolArray:
        """Return (n,) whether any corner moves, for a mask (v,) of moving source vertices."""
        taken = np.asarray(moves[self.faces].any(axis=1)) & ~self.unmapped
        return np.asarray(np.abs(self.filling) @ taken.astype(np.float64) > _COUNTS)

    def moving_share(self, moves: BoolArray) -> FloatArray:
        """Return (n,) the share of each place that lies at moving corners, for a mask (v,)."""
        return np.einsum("nc,nc->n", self.bary, moves[self.faces].astype(np.float64))

    def matrix(self, rest: TriMesh, *, curved: bool) -> csr_matrix:
        """Return the (n, v) matrix from source displacements to those of the target.

        Flat: u = sum_i b_i u_i. Curved, with g_i the gradient of u at corner i and p the place:
        u = sum_i b_i (u_i + g_i (p - p_i) / 2), exact for linear and, where the gradients are,
        for quadratic fields; equal to u_i at the corners.
        """
        n, v = len(self.faces), rest.vertex_count
        rows = np.repeat(np.arange(n), 3)
        columns = self.faces.ravel()
        share = self.bary * self.weight[:, None]
        result = csr_matrix((share.ravel(), (rows, columns)), shape=(n, v))
        if curved:
            for axis, gradient in enumerate(_gradients(rest)):
                entries = (0.5 * share * self.offset[:, :, axis]).ravel()
                result = result + csr_matrix((entries, (rows, columns)), shape=(n, v)) @ gradient
        return csr_matrix(self.filling @ result)


def map_skin(
    source: Subject,
    target: Subject,
    rest: TriMesh,
    registered: TriMesh,
    *,
    laid: FloatArray | None = None,
) -> Mapping:
    """Find the place of each target vertex on the source.

    A vertex of one lip finds faces of that lip only, one that lies in the mouth or in a socket
    finds the source's mouth or socket if it has one; the rest must face the same way. The places
    found on the registered source are then evened out: how far each is from the target vertex is
    smoothed over the target, and the smoothed place is projected back.

    Parameters
    ----------
    source, target : Subject
    rest : TriMesh
        The source's skin at rest, moved by the similarity [mm].
    registered : TriMesh
        The same faces, registered.
    laid : (n, 3) float64, optional
        The target's vertices, registered on `rest` instead: of two heads the finer one is laid
        over the coarser, so that the way there and the way back agree [mm].
    """
    mesh = target.mesh
    normals = vertex_normals(mesh.positions, mesh.faces)
    groups = _groups(source, target)
    corners_of_mouth = MouthCorners.of(source, target)
    if laid is None:
        surface, points = registered, mesh.positions
    else:
        surface, points = rest, laid
        normals = vertex_normals(laid, mesh.faces)
    found = _search(groups, surface, points, normals)
    _put(*corners_of_mouth.search(surface, points, normals), found)
    found = _without_rounding(found)
    height = target.head.height
    fade = 1.0 - smooth_step((found.distance / height - _NEAR) / (_FAR - _NEAR))
    fade[target.inside & np.isfinite(found.distance)] = 1.0
    fade[~np.isfinite(found.distance)] = 0.0
    places = np.einsum("nc,ncj->nj", found.bary, rest.positions[rest.faces[found.face]])
    shift = places - mesh.positions
    bend = max(_EVEN, _EVEN_EDGES * _edge_length(rest))
    pull = np.where(target.inside, 0.1, 1.0) * np.maximum(fade, 1e-3)
    even = SmoothField(mesh, pull, length=0.5 * bend, bend=bend).solve(shift)
    wanted = mesh.positions + even
    # Normals of the places, not of the target: the evened place lies on the source at rest.
    there = vertex_normals(rest.positions, rest.faces)[rest.faces[found.face]]
    turned = np.einsum("nc,ncj->nj", found.bary, there)
    final = _search(groups, rest, wanted, turned)
    _put(*corners_of_mouth.search(rest, wanted, turned), final)
    final = _without_rounding(final)
    corners = rest.faces[final.face]
    offset = final.places[:, None] - rest.positions[corners]
    zones = seam_zones(source, target, rest)
    filling = evening(zones, rest, mesh, corners, final.bary)
    return Mapping(corners, final.bary, found.distance, fade, offset, filling)


@dataclass(frozen=True, eq=False)
class _Found:
    face: IntArray
    bary: FloatArray
    distance: FloatArray
    places: FloatArray


def _search(
    groups: list[tuple[IntArray, BoolArray, bool]],
    surface: TriMesh,
    points: FloatArray,
    normals: FloatArray,
) -> _Found:
    n = len(points)
    result = _Found(np.zeros(n, np.int32), np.zeros((n, 3)), np.full(n, np.inf), np.array(points))
    for rows, mask, by_normal in groups:
        if not mask.any():
            continue
        found = closest_points(
            surface,
            points[rows],
            face_mask=mask,
            normals=normals[rows] if by_normal else None,
            max_angle=_TURNED,
        )
        _put(rows, found, result)
        lost = rows[found.face < 0]
        if len(lost):
            _put(lost, closest_points(surface, points[lost], face_mask=mask), result)
    return result


def _without_rounding(found: _Found) -> _Found:
    bary = np.where(found.bary < _ROUNDING, 0.0, found.bary)
    return replace(found, bary=bary / np.maximum(bary.sum(axis=1, keepdims=True), 1e-300))


def _edge_length(mesh: TriMesh) -> float:
    pairs = edges(mesh.faces)
    ends = mesh.positions[pairs]
    return float(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).mean())


def _put(rows: IntArray, found: ClosestPoints | CornerPlaces, into: _Found) -> None:
    hit = found.face >= 0
    into.face[rows[hit]], into.bary[rows[hit]] = found.face[hit], found.bary[hit]
    into.distance[rows[hit]] = found.distance[hit]
    into.places[rows[hit]] = found.positions[hit]


def _groups(source: Subject, target: Subject) -> list[tuple[IntArray, BoolArray, bool]]:
    """Return target vertices, the source faces that they may lie on, and whether normals count."""
    sided = source.lips is not None and target.lips is not None
    ours = source.face_side if sided else np.zeros_like(source.face_side)
    theirs = target.side if sided else np.zeros_like(target.side)
    groups: list[tuple[IntArray, BoolArray, bool]] = []
    corners = source.cavity[source.mesh.faces]
    lining = [np.asarray((corners == cavity).any(axis=1)) for cavity in range(4)]
    for side in (0, 1, -1):
        fits = ours * side >= 0
        for cavity in range(4):
            chosen = (theirs == side) & (target.cavity == cavity)
            mask = fits & lining[cavity]
            if not mask.any():
                mask = fits & lining[0]
            rows = np.flatnonzero(chosen).astype(np.int32)
            if len(rows):
                groups.append((rows, mask, cavity == 0))
    return groups


def identity_filling(vertex_count: int) -> csr_matrix:
    """Return the filling (n, n) of a mapping without doubtful vertices."""
    return csr_matrix(eye(vertex_count))


def _gradients(mesh: TriMesh) -> list[csr_matrix]:
    """Return three (n, n) matrices: d/dx, d/dy, d/dz of a field at the vertices, along the skin.

    Mean of the gradients of the faces around, weighted by area; that of a face is
    sum_i f_i (n x e_i) / (2 area) with e_i the side facing corner i.
    """
    corners = mesh.positions[mesh.faces]
    sides = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
    doubled = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(doubled, axis=1)
    normal = doubled / np.maximum(length, 1e-300)[:, None]
    # Area times gradient; thin faces weigh little by themselves.
    slopes = 0.5 * np.cross(normal[:, None], sides)
    n = mesh.vertex_count
    area = np.bincount(mesh.faces.ravel(), np.repeat(0.5 * length, 3), n)
    rows = np.repeat(mesh.faces, 3, axis=1).ravel()
    columns = np.tile(mesh.faces, (1, 3)).ravel()
    scale = 1.0 / np.maximum(area[rows], 1e-300)
    return [
        csr_matrix((np.tile(slopes[:, :, axis], (1, 3)).ravel() * scale, (rows, columns)), (n, n))
        for axis in range(3)
    ]
