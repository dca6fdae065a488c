"""How the skins correspond, by either profile."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.sparse import csr_matrix

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.cloning.fine_field import FineField, fading
from risorius.cloning.landmark_pairs import LandmarkPairs
from risorius.cloning.lid_trace import LidPair, trusted_lids
from risorius.cloning.mapping import Mapping, map_skin
from risorius.cloning.parameters import CloneParameters
from risorius.cloning.refinement import ray_mapping, refine
from risorius.cloning.registration import Registration, register
from risorius.cloning.rough_fit import rough_fit
from risorius.cloning.subject import Subject
from risorius.mesh.core import TriMesh
from risorius.spatial.closest import closest_points
from risorius.warp.rbf import RbfWarp

__all__ = ["Correspondence", "SkinCarrier", "correspond"]

# Above this share of the source's seen vertices, and below this number, the target is laid over
# the source instead.
_FINER, _LARGE = 1.4, 20000
_EYES = {"l": "left", "r": "right"}


class SkinCarrier(Protocol):
    """Carries displacements of the source's skin to the target's."""

    def __call__(self, deltas: FloatArray) -> FloatArray:
        """Return (n, 3) [mm, target's frame] for `deltas` (v, 3) [mm, source's frame]."""
        ...


@dataclass(frozen=True, eq=False)
class Correspondence:
    """Everything that links the two skins.

    Parameters
    ----------
    pairs : LandmarkPairs
    warp : RbfWarp
        From the source, moved by the similarity, to the target.
    fitted : TriMesh
        The source's skin on the target [mm].
    residual : (v,) float64
        Distance of its vertices to the target; NaN where unknown [mm].
    mapping : Mapping
    carry : SkinCarrier
    lids : mapping of str to LidPair
        By side, where both heads have them.
    notes : tuple of str
    """

    pairs: LandmarkPairs
    warp: RbfWarp
    fitted: TriMesh
    residual: FloatArray
    mapping: Mapping
    carry: SkinCarrier
    lids: dict[str, LidPair]
    notes: tuple[str, ...]


def correspond(
    source: Subject,
    target: Subject,
    pairs: LandmarkPairs,
    moving: BoolArray,
    parameters: CloneParameters,
) -> Correspondence:
    """Make the skins correspond.

    Parameters
    ----------
    source, target : Subject
    pairs : LandmarkPairs
    moving : (v,) bool
        Source vertices that move in any shape.
    parameters : CloneParameters
    """
    if parameters.profile == "faithful":
        return _faithful(source, target, pairs, moving, parameters)
    fit = rough_fit(source, target, pairs)
    found = register(source, target, fit)
    rest = found.mesh.at(fit.positions)
    laid = None
    if _is_finer(target, source):
        found, laid = _laid(source, target, pairs, rest)
    mapping = map_skin(source, target, rest, found.mesh, laid=laid)
    matrix = mapping.matrix(rest, curved=parameters.curved)
    linear = np.broadcast_to(pairs.similarity.linear, (rest.vertex_count, 3, 3))
    if parameters.local_scale > 0.0:
        change = fit.warp.jacobian(rest.positions) - np.eye(3)
        linear = (np.eye(3) + parameters.local_scale * change) @ linear
    fine = FineField.of(source, target, found.mesh) if parameters.curved else None
    carry = _Improved(
        mapping, matrix, linear, rest, target.mesh.positions, parameters, target.cavity, fine
    )
    lids = trusted_lids(source, target, found.mesh.positions, fit.lines)
    notes = [
        f"{_EYES[side]} eye: its landmarks do not fit the others; the lids are matched by the skin"
        for side in lids
        if f"lid_upper_{side}" not in fit.lines
    ]
    return Correspondence(
        pairs, fit.warp, found.mesh, found.residual, mapping, carry, lids, tuple(notes)
    )


def _is_finer(target: Subject, source: Subject) -> bool:
    """Return whether the target's skin is finer, and small enough to be registered itself."""
    ours, theirs = (int((~each.inside).sum()) for each in (source, target))
    return theirs > _FINER * ours and theirs < _LARGE


def _laid(
    source: Subject, target: Subject, pairs: LandmarkPairs, rest: TriMesh
) -> tuple[Registration, FloatArray]:
    """Register the target on the source; return the source's skin as it lies on the target.

    Returns
    -------
    Registration
        What `register` would have found the other way round.
    laid : (n, 3) float64
        The target's vertices on `rest` [mm].
    """
    back = pairs.reversed()
    fit = rough_fit(target, source, back)
    found = register(target, source, fit)
    laid = pairs.similarity.apply(found.mesh.positions)
    near = closest_points(found.mesh, source.mesh.positions)
    corners = found.mesh.faces[near.face]
    positions = np.einsum("vc,vcj->vj", near.bary, target.mesh.positions[corners])
    scale = pairs.similarity.scale
    return Registration(rest.at(positions), scale * near.distance), laid


def _faithful(
    source: Subject,
    target: Subject,
    pairs: LandmarkPairs,
    moving: BoolArray,
    parameters: CloneParameters,
) -> Correspondence:
    found = refine(source, target, pairs, moving, parameters)
    fitted = found.rest.at(found.warp(found.rest.positions))
    mapping = ray_mapping(source, target, fitted, found.ray)
    matrix = mapping.matrix(fitted, curved=False)
    residual = np.full(source.mesh.vertex_count, np.nan)
    residual[moving] = found.misses[-1] if found.misses else 0.0
    linear = pairs.similarity.linear
    carry = _Published(
        mapping, matrix, linear, found.rest, fitted, found.warp, target.mesh.positions, parameters
    )
    said = f"{found.centre_count} centres after {found.pass_count} passes, rays {found.ray:.1f} mm"
    lids = {
        side: LidPair(own, target.lids[side])
        for side, own in source.lids.items()
        if side in target.lids
    }
    return Correspondence(pairs, found.warp, fitted, residual, mapping, carry, lids, (said,))


@dataclass(frozen=True, eq=False)
class _Improved:
    mapping: Mapping
    matrix: csr_matrix
    linear: FloatArray
    rest: TriMesh
    target: FloatArray
    parameters: CloneParameters
    cavity: IntArray
    fine: FineField | None

    def __call__(self, deltas: FloatArray) -> FloatArray:
        moves = _moves(deltas, self.parameters)
        kept = np.where(moves[:, None], deltas, 0.0)
        turned = np.einsum("vij,vj->vi", self.linear, kept)
        result = self.matrix @ turned
        if self.fine is not None:
            fade = fading(self.mapping, moves, self.cavity)
            result = self.fine.rounded(result, turned) * fade[:, None]
        if self.parameters.form == "absolute":
            places = _at(self.mapping, self.rest.positions)
            result = result + (places - self.target) * ~self.mapping.unmapped[:, None]
        result[~self.mapping.moved(moves)] = 0.0
        return result


@dataclass(frozen=True, eq=False)
class _Published:
    """S_j = G(moved source), taken at the places of the neutral (spec 2.7, erratum E7)."""

    mapping: Mapping
    matrix: csr_matrix
    linear: FloatArray
    rest: TriMesh
    fitted: TriMesh
    warp: RbfWarp
    target: FloatArray
    parameters: CloneParameters

    def __call__(self, deltas: FloatArray) -> FloatArray:
        moves = _moves(deltas, self.parameters)
        moved = self.fitted.positions.copy()
        if moves.any():
            moved[moves] = self.warp(self.rest.positions[moves] + deltas[moves] @ self.linear.T)
        if self.parameters.form == "absolute":
            result = _at(self.mapping, moved) - self.target
        else:
            result = self.matrix @ (moved - self.fitted.positions)
        result[~self.mapping.moved(moves)] = 0.0
        return result


def _moves(deltas: FloatArray, parameters: CloneParameters) -> BoolArray:
    return np.asarray(np.linalg.norm(deltas, axis=1) > parameters.still)


def _at(mapping: Mapping, positions: FloatArray) -> FloatArray:
    return np.einsum("nc,ncj->nj", mapping.bary, positions[mapping.faces])
