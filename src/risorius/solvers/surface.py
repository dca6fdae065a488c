"""The constraints of a triangulated surface: stretch, bending, area, volume."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.errors import MeshError, RisoriusWarning
from risorius.mesh.boundary import boundary_loops
from risorius.mesh.connectivity import edge_faces, opposite_corners
from risorius.mesh.core import TriMesh
from risorius.solvers.constraints import Areas, Bends, Constraints, Distances, Volume
from risorius.solvers.gradients import area_value, bend_value, distance_value, volume_value

__all__ = [
    "SurfaceStiffness",
    "edge_distances",
    "face_areas",
    "flap_distances",
    "flaps",
    "rest_distances",
    "surface_bends",
    "surface_constraints",
    "surface_volume",
]

# Below this share of the mesh's size a length counts as zero (areas: its square).
_NO_LENGTH = 1e-9


@dataclass(frozen=True)
class SurfaceStiffness:
    """Stiffness k of each kind; the defaults are the published ones of the skin."""

    stretch: float = 0.15
    bend: float = 0.95
    area: float = 0.95
    volume: float = 1.0


def rest_distances(positions: FloatArray, pairs: IntArray, stiffness: float) -> Distances:
    """Return constraints that keep pairs (k, 2) of particles as far apart as they are now."""
    return Distances(pairs, distance_value(positions[pairs]), np.full(len(pairs), stiffness))


def edge_distances(mesh: TriMesh, stiffness: float) -> Distances:
    """Return one constraint per edge; edges without length are left out."""
    table = rest_distances(mesh.positions, edge_faces(mesh.faces).edges, stiffness)
    return _rows(table, table.rest > _NO_LENGTH * mesh.size)


def flaps(mesh: TriMesh) -> IntArray:
    """Return the four vertices (k, 4) of every interior edge: its ends, the two far corners.

    The first far corner belongs to the face whose sides run from the first end to the second.
    An edge of more than two faces keeps its first two, with a warning.
    """
    table = edge_faces(mesh.faces)
    crowded = np.flatnonzero(table.counts > 2)
    if len(crowded):
        warnings.warn(
            f"{len(crowded)} edges have more than two faces, first {table.edges[crowded[0]]}: "
            "only the first two of each are kept from bending; repair the mesh to keep all",
            RisoriusWarning,
            stacklevel=2,
        )
    corners = opposite_corners(mesh.faces, table)
    inner = np.flatnonzero((corners >= 0).all(axis=1))
    ends, corners = table.edges[inner], corners[inner]
    own = mesh.faces[table.faces[inner, 0]]
    forward = ((own == ends[:, :1]) & (np.roll(own, -1, axis=1) == ends[:, 1:])).any(axis=1)
    corners = np.where(forward[:, None], corners, corners[:, ::-1])
    result = np.concatenate([ends, corners], axis=1).astype(np.int32)
    # Two faces with the same three corners have nothing to bend.
    return result[corners[:, 0] != corners[:, 1]]


def flap_distances(mesh: TriMesh, stiffness: float) -> Distances:
    """Return one constraint per interior edge, between the far corners of its two faces."""
    table = rest_distances(mesh.positions, flaps(mesh)[:, 2:], stiffness)
    return _rows(table, table.rest > _NO_LENGTH * mesh.size)


def surface_bends(mesh: TriMesh, stiffness: float) -> Bends:
    """Return one constraint per interior edge; those next to a face without area are left out."""
    table = flaps(mesh)
    corners = mesh.positions[table]
    least = (_NO_LENGTH * mesh.size) ** 2
    firm = (area_value(corners[:, :3]) > least) & (area_value(corners[:, [0, 1, 3]]) > least)
    table, corners = table[firm], corners[firm]
    return Bends(table, bend_value(corners), np.full(len(table), stiffness))


def face_areas(mesh: TriMesh, stiffness: float) -> Areas:
    """Return one constraint per face; faces without area are left out."""
    areas = area_value(mesh.positions[mesh.faces])
    firm = areas > (_NO_LENGTH * mesh.size) ** 2
    return Areas(mesh.faces[firm], areas[firm], np.full(int(firm.sum()), stiffness))


def surface_volume(mesh: TriMesh, stiffness: float) -> Volume:
    """Return the constraint on the volume inside `mesh`, its holes capped.

    Raises
    ------
    MeshError
        If the mesh encloses nothing: it is flat, or its faces disagree in orientation.
    """
    holes = tuple(boundary_loops(mesh.faces))
    rest = volume_value(mesh.positions - mesh.positions.mean(axis=0), mesh.faces, holes=holes)
    if abs(rest) <= (1e-4 * mesh.size) ** 3:
        raise MeshError(
            f"mesh of {mesh.face_count} faces: it encloses {rest:g} mm^3, nothing to keep; "
            "orient its faces, or leave the volume out"
        )
    return Volume(mesh.faces, rest, stiffness, holes)


def surface_constraints(
    mesh: TriMesh, stiffness: SurfaceStiffness | None = None, *, with_volume: bool = True
) -> Constraints:
    """Return all constraints of a skin (spec section 2.10), without its anchors.

    Notes
    -----
    E + E_int distances, E_int bends, F areas and one volume: E + 2 E_int + F + 1 (acceptance 12),
    less those that an edge without length or a face without area would give; these are counted in
    a warning.
    """
    k = stiffness or SurfaceStiffness()
    edge_table, flap_table = edge_distances(mesh, k.stretch), flap_distances(mesh, k.stretch)
    bends, areas = surface_bends(mesh, k.bend), face_areas(mesh, k.area)
    edge_count, flap_count = len(edge_faces(mesh.faces).edges), len(bends.particles)
    wanted = edge_count + mesh.face_count
    lost = wanted - len(edge_table.particles) - len(areas.particles)
    if lost:
        warnings.warn(
            f"{lost} edges and faces of the mesh have no length or no area; they are not kept "
            f"from changing ({flap_count} edges are kept from bending)",
            RisoriusWarning,
            stacklevel=2,
        )
    volumes = (surface_volume(mesh, k.volume),) if with_volume else ()
    return Constraints(Distances.joined([edge_table, flap_table]), areas, bends, volumes)


def _rows(table: Distances, keep: BoolArray) -> Distances:
    return Distances(table.particles[keep], table.rest[keep], table.stiffness[keep])
