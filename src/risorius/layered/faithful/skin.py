"""The skin as a model of the solver: its own constraints, anchors, lids."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.eyelids import Eyelids
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.smooth_step import smooth_step
from risorius.errors import MeshError, RisoriusWarning
from risorius.layered.faithful.binding import Anchors
from risorius.layered.faithful.parameters import FaithfulParameters
from risorius.mesh.core import TriMesh
from risorius.solvers.constraints import Areas, Bends, Constraints, Contacts, Distances, Holds
from risorius.solvers.model import Control, Model
from risorius.solvers.pbd import Solver
from risorius.solvers.surface import surface_constraints

__all__ = ["SkinModel", "build_skin_model"]


@dataclass(frozen=True, eq=False)
class SkinModel:
    """Skin vertices as particles, followed by one particle per anchor that only muscles move.

    Parameters
    ----------
    model : Model
    vertex_count : int
        n.
    lid_vertices : (k,) int32
        Vertices that lids hold; `holds` of the model name the same.
    notes : tuple of str
        What the mesh did not allow.
    solver : Solver
        Keeps the tables of the model.
    """

    model: Model
    vertex_count: int
    lid_vertices: IntArray
    notes: tuple[str, ...]
    solver: Solver = field(default_factory=Solver)

    def control(
        self, places: FloatArray, lids: FloatArray, contacts: Contacts | None = None
    ) -> Control:
        """Return what is asked of the skin.

        Parameters
        ----------
        places : (a, 3) float64
            Of the anchors' points, or (s, a, 3) of s poses [mm].
        lids : (n, 3) float64
            Skin with its lids in place, or (s, n, 3) [mm].
        contacts : Contacts, optional
        """
        wanted = np.concatenate([lids, places], axis=-2)
        held, pinned = lids[..., self.lid_vertices, :], wanted[..., self.model.pinned, :]
        return Control(held, pinned, contacts=contacts)


def build_skin_model(
    mechanics: Mechanics,
    anchors: Anchors,
    places: FloatArray,
    influence: FloatArray,
    parameters: FaithfulParameters,
    *,
    scale: float,
) -> SkinModel:
    """Return the model of a head's skin (spec 2.10): stretch, bending, area, volume, anchors.

    Parameters
    ----------
    mechanics : Mechanics
        Of the head.
    anchors : Anchors
    places : (a, 3) float64
        Where their points are at rest [mm].
    influence : (n,) float64
        Vertices without influence do not move.
    parameters : FaithfulParameters
    scale : float
        Size of the head over that of the built-in one.
    """
    p, mesh = parameters, mechanics.head.skin.mesh
    n = mesh.vertex_count
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", RisoriusWarning)
        own = _own_constraints(mesh, p)
        follow = _lid_weights(mechanics.lids)
        inv_mass = np.concatenate(
            [np.where(influence > 0.0, 1.0, 0.0), np.zeros(len(anchors.vertices))]
        )
        held = np.array([v for v in follow if inv_mass[v] > 0.0], np.int32)
        stiffness = np.array([follow[int(v)] for v in held])
        inv_mass[held[stiffness > p.lid_pinned]] = 0.0
        hung = np.stack([anchors.vertices, n + np.arange(len(places))], axis=1).astype(np.int32)
        bony = anchors.on("cranium", "mandible")
        hold = np.where(bony, p.bone_anchor, p.anchor) * _corner_share(mechanics, anchors, scale, p)
        anchored = Distances(hung, anchors.lengths, hold)
        constraints = replace(
            _eased(own, inv_mass == 0.0),
            distances=Distances.joined([own.distances, anchored]),
            holds=Holds(held, p.lid_hold * stiffness),
        )
        model = Model(np.concatenate([mesh.positions, places]), constraints, inv_mass)
    notes = tuple(dict.fromkeys(str(warning.message) for warning in caught))
    return SkinModel(model, n, held, notes)


def _corner_share(
    mechanics: Mechanics, anchors: Anchors, scale: float, p: FaithfulParameters
) -> FloatArray:
    """Return the share (a,) of its stiffness that each anchor keeps beside the mouth corners."""
    near = mechanics.lips.to_corner[anchors.vertices]
    return p.corner_hold + (1.0 - p.corner_hold) * smooth_step(near / (p.corner_reach * scale))


def _own_constraints(mesh: TriMesh, p: FaithfulParameters) -> Constraints:
    try:
        return surface_constraints(mesh, p.skin)
    except MeshError as error:
        warnings.warn(f"the skin's volume is not kept: {error}", RisoriusWarning, stacklevel=2)
        return surface_constraints(mesh, p.skin, with_volume=False)


def _eased(constraints: Constraints, pinned: BoolArray) -> Constraints:
    """Switch off the bends and areas between vertices that do not move; they stay in the count."""

    def still(table: Bends | Areas) -> FloatArray:
        return np.where(pinned[table.particles].all(axis=1), 0.0, table.stiffness)

    bends, areas = constraints.bends, constraints.areas
    return replace(
        constraints,
        bends=Bends(bends.particles, bends.rest, still(bends)),
        areas=Areas(areas.particles, areas.rest, still(areas)),
    )


def _lid_weights(lids: Mapping[str, Eyelids]) -> dict[int, float]:
    result: dict[int, float] = {}
    for lid in lids.values():
        for vertex, weight in zip(lid.vertices.tolist(), lid.weight.tolist()):
            result[vertex] = max(result.get(vertex, 0.0), min(weight, 1.0))
    return result
