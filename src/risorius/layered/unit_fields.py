"""One linear field per muscle: the skin's answer to full contraction."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_matrix, csc_matrix, csr_matrix, diags
from scipy.spatial import cKDTree

from risorius._check import FloatArray
from risorius.anatomy.skin import Skin
from risorius.anatomy.smooth_step import smooth_step
from risorius.layered.pulls.pull import Pull
from risorius.mesh.factorisation import factorise
from risorius.mesh.lips import LipSides

__all__ = ["FieldSolver"]

# How far the skin carries a step and rounds a kink [mm].
_LENGTH, _BEND = 7.0, 3.0
# Skin farther than this from all that a muscle holds does not move, and the share of it over
# which motion fades [mm].
_RANGE, _FADE = 75.0, 0.5
# Lips closer than this hold together, this strongly, within so many millimetres of their line.
_SEAL_GAP, _SEAL, _SEAL_REACH = 3.5, 5.0, 5.0


@dataclass(frozen=True, eq=False)
class FieldSolver:
    """Solves for unit fields on one skin.

    Minimises ``sum m (p |u|^2 + k w |u - d|^2) + a^2 |grad u|^2 + b^4 |lap u|^2`` with p the
    passive stiffness, w and d weight and goal of the muscle: one symmetric positive definite
    system per muscle, restricted to the skin that it can reach.
    """

    skin: Skin
    lips: LipSides

    @cached_property
    def _base(self) -> csr_matrix:
        skin = self.skin
        length, bend = _LENGTH * skin.scale, _BEND * skin.scale
        inverse = diags(1.0 / np.maximum(skin.mass, 1e-9))
        rounded = skin.stiff @ inverse @ skin.stiff
        held = diags(skin.mass * skin.passive)
        return csr_matrix(held + length**2 * skin.stiff + bend**4 * rounded)

    @cached_property
    def _sealed(self) -> csr_matrix:
        return csr_matrix(self._base + _SEAL * self._seal_matrix())

    def solve(self, pull: Pull) -> FloatArray:
        """Return the displacement (n, 3) [mm] of the skin at full contraction."""
        skin = self.skin
        reach = self._reach(pull.weight)
        rows = np.flatnonzero(reach > 0.0)
        field = np.zeros_like(skin.positions)
        if not len(rows):
            return field
        held = skin.mass[rows] * pull.weight[rows]
        matrix = (self._sealed if pull.seal else self._base)[rows][:, rows] + diags(held)
        field[rows] = factorise(csc_matrix(matrix))(held[:, None] * pull.goal[rows])
        return field * (skin.mobility * reach)[:, None]

    def _reach(self, weight: FloatArray) -> FloatArray:
        """Return 1 on the skin (n,) that a muscle can move, fading to 0 where it is held still."""
        skin = self.skin
        centre = np.flatnonzero(weight > 0.02 * weight.max(initial=0.0))
        if not len(centre):
            return np.zeros(len(weight))
        limit = _RANGE * skin.scale
        found = cKDTree(skin.positions[centre]).query(skin.positions, distance_upper_bound=limit)[0]
        fade = smooth_step((1.0 - np.minimum(found / limit, 1.0)) / _FADE)
        return fade * (skin.mobility > 0.0) * (skin.mass > 1e-9)

    def _seal_matrix(self) -> csr_matrix:
        """Return the Laplacian (n, n) of springs between opposite lip margins."""
        skin, lips = self.skin, self.lips
        n, scale = len(skin.positions), skin.scale
        near = (skin.mouth.distance < _SEAL_REACH) & ~lips.inside
        upper = np.flatnonzero(near & (skin.mouth.side > 0.0))
        lower = np.flatnonzero(near & (skin.mouth.side < 0.0))
        if not (len(upper) and len(lower)):
            return csr_matrix((n, n))
        pairs: list[npt.NDArray[np.intp]] = []
        for own, other in ((upper, lower), (lower, upper)):
            gap, nearest = cKDTree(skin.positions[other]).query(skin.positions[own])
            kept = np.asarray(gap) < _SEAL_GAP * scale
            pairs.append(np.stack([own[kept], other[nearest[kept]]], axis=1))
        ends = np.concatenate(pairs)
        spring = np.full(len(ends), 0.5 * float(np.median(skin.mass)))
        both = np.concatenate([ends, ends[:, ::-1]])
        graph = csr_matrix(coo_matrix((np.tile(spring, 2), (both[:, 0], both[:, 1])), shape=(n, n)))
        if skin.partner is not None:
            graph = csr_matrix(0.5 * (graph + graph[skin.partner][:, skin.partner]))
        return csr_matrix(diags(np.asarray(graph.sum(axis=1)).ravel()) - graph)
