"""Motion on a target finer than the source: smooth between the source's vertices.

Patches over the source's faces show their edges on a finer target, and tear it where a face of
the source spans a corner of the mouth. The target's own skin knows better how motion gets from
one source vertex to the next: the field that bends least.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, diags

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.cloning.mapping import Mapping
from risorius.cloning.polyline import place_on_line
from risorius.cloning.seam_zones import edge_length
from risorius.cloning.subject import Subject
from risorius.mesh.core import TriMesh
from risorius.mesh.factorisation import factorise
from risorius.mesh.laplacian import cotangent_laplacian, mass
from risorius.mesh.normals import vertex_normals
from risorius.spatial.closest import closest_points

__all__ = ["FineField", "fading"]

# The target counts as finer if the source's edges are longer by this factor.
_FINER = 1.25
# Distance over which kinks are rounded: this share of the geometric mean of both edges.
_BEND = 0.27
# How much a source vertex counts for, compared with the patches on as much skin.
_SAMPLE = 3.0
# The same for the patches in the eye sockets, whose skin moves by fractions of a millimetre.
_FIRM = 30.0
# Cavities beyond this number are sockets, see `Subject.cavity`.
_MOUTH = 1
# Samples farther from the target, or turned farther, are none; the same along the contact lines
# [mm], [deg].
_FARTHEST, _TURNED, _OFF_LINE = 4.0, 60.0, 6.0


class FineField:
    """Rounds the kinks of a carried field; see `FineField.of`.

    Minimises sum_i f_i m_i |u_i - t_i|^2 + w sum_v a_v |C_v u - d_v|^2 + bend^4 |lap u|^2: t the
    motion by patches, d that of the source's vertices, C_v u the field where vertex v lies on
    the target, m and a the areas of the vertices on both.

    Parameters
    ----------
    mesh : TriMesh
        The target's skin [mm].
    firm : (n,) float64
        How much the motion by patches counts for at each vertex; 1 is ordinary.
    samples : (k, n) csr_matrix
        C.
    vertices : (k,) int32
        Source vertices of the samples.
    areas : (k,) float64
        [mm^2].
    bend : float
        [mm].
    """

    def __init__(
        self,
        mesh: TriMesh,
        firm: FloatArray,
        samples: csr_matrix,
        *,
        vertices: IntArray,
        areas: FloatArray,
        bend: float,
    ) -> None:
        stiff = cotangent_laplacian(mesh.positions, mesh.faces)
        weight = mass(mesh.positions, mesh.faces)
        # Unused vertices keep what they have.
        weight = np.where(weight > 0.0, weight, 1.0)
        self._weight = weight * firm
        self._vertices = vertices
        self._pull = csr_matrix(samples.T @ diags(_SAMPLE * areas))
        bent = stiff @ diags(1.0 / weight) @ stiff
        system = self._pull @ samples + diags(self._weight) + bend**4 * bent
        self._solve = factorise(csc_matrix(system))

    @staticmethod
    def of(source: Subject, target: Subject, fitted: TriMesh) -> FineField | None:
        """Return the field for a finer target, or None if the target is not finer.

        Parameters
        ----------
        source, target : Subject
        fitted : TriMesh
            The source's skin on the target's [mm].
        """
        ours = edge_length(fitted, ~source.inside)
        theirs = edge_length(target.mesh, ~target.inside)
        if not ours > _FINER * theirs:
            return None
        samples, vertices = _samples(source, target, fitted)
        areas = mass(fitted.positions, fitted.faces)[vertices]
        bend = _BEND * float(np.sqrt(ours * theirs))
        firm = np.where(target.cavity > _MOUTH, _FIRM, 1.0)
        return FineField(target.mesh, firm, samples, vertices=vertices, areas=areas, bend=bend)

    def rounded(self, carried: FloatArray, moved: FloatArray) -> FloatArray:
        """Return the field (n, d) for the motion by patches `carried` (n, d).

        Parameters
        ----------
        carried : (n, d) float64
            [mm].
        moved : (v, d) float64
            Displacements of the source's vertices, in the target's frame and size [mm].
        """
        right = self._weight[:, None] * carried + self._pull @ moved[self._vertices]
        return self._solve(right)


def fading(mapping: Mapping, moves: BoolArray, cavity: IntArray) -> FloatArray:
    """Return (n,) by how much motion fades where a place lies between moving and resting corners.

    A coarse source knows that a corner moves and the next does not, but not where between them
    the motion ends; it fades with zero slope and curvature, as skin does. Eye sockets are left
    alone.

    Parameters
    ----------
    mapping : Mapping
    moves : (v,) bool
        Moving vertices of the source's skin.
    cavity : (n,) int32
        `Subject.cavity` of the target.
    """
    return np.where(cavity > _MOUTH, 1.0, mapping.moving_share(moves) ** 3)


def _samples(source: Subject, target: Subject, fitted: TriMesh) -> tuple[csr_matrix, IntArray]:
    """Return where source vertices lie on the target: weights (k, n) and their numbers (k,)."""
    mesh = target.mesh
    face, bary = _on_skin(source, target, fitted)
    corners = mesh.faces[np.maximum(face, 0)]
    ours, theirs = source.lines(), target.lines()
    for name in (name for name in ours if name in theirs):
        line = theirs[name]
        start, along, off = place_on_line(fitted.positions[ours[name]], mesh.positions[line])
        near = off < _OFF_LINE
        rows = ours[name][near]
        first, second = line[start[near]], line[start[near] + 1]
        corners[rows] = np.stack([first, second, second], axis=1)
        bary[rows] = np.stack([1.0 - along[near], along[near], 0.0 * along[near]], axis=1)
        face[rows] = 0
    vertices = np.flatnonzero(face >= 0).astype(np.int32)
    rows = np.repeat(np.arange(len(vertices)), 3)
    weights = (bary[vertices].ravel(), (rows, corners[vertices].ravel()))
    return csr_matrix(weights, shape=(len(vertices), mesh.vertex_count)), vertices


def _on_skin(source: Subject, target: Subject, fitted: TriMesh) -> tuple[IntArray, FloatArray]:
    """Return face (v,), -1 for none, and barycentric coordinates (v, 3) of source vertices."""
    normals = vertex_normals(fitted.positions, fitted.faces)
    face = np.full(fitted.vertex_count, -1, np.int32)
    bary = np.zeros((fitted.vertex_count, 3))
    sided = source.lips is not None and target.lips is not None
    ours = source.side if sided else np.zeros_like(source.side)
    for side in (0, 1, -1):
        rows = np.flatnonzero((ours == side) & ~source.inside)
        mask = ~target.face_inside
        if side:
            mask &= target.face_side * side >= 0
        if not len(rows) or not mask.any():
            continue
        found = closest_points(
            target.mesh,
            fitted.positions[rows],
            normals=normals[rows],
            max_angle=_TURNED,
            face_mask=mask,
        )
        near = (found.face >= 0) & (found.distance < _FARTHEST)
        face[rows[near]], bary[rows[near]] = found.face[near], found.bary[near]
    return face, bary
