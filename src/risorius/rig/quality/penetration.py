"""How deep the visible skin sinks into teeth and eyeballs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.head.head import Head
from risorius.mesh.connectivity import components
from risorius.mesh.core import TriMesh
from risorius.mesh.volume import capped_volumes
from risorius.rig.quality.rigid import rigid_motions
from risorius.rig.quality.subject import part_deltas
from risorius.rig.rig import Rig
from risorius.spatial.closest import closest_points, winding_numbers

__all__ = ["COLLIDERS", "Penetration", "depths_inside", "penetrations", "solid"]

COLLIDERS = ("teeth_upper", "teeth_lower", "eye_left", "eye_right")
"""Parts that the skin must stay out of."""

# Skin that moved less than this against the part keeps its rest depth [mm].
_SAME = 1e-6


@dataclass(frozen=True)
class Penetration:
    """Skin inside one part.

    Parameters
    ----------
    depth : float
        Depth of the deepest visible skin vertex below the part's surface [mm].
    added : float
        Largest growth of a vertex's depth over the neutral head's [mm].
    vertex : int
        Vertex of the file whose depth grew most, -1 if none did.
    """

    depth: float
    added: float
    vertex: int


def solid(mesh: TriMesh) -> TriMesh:
    """Return a mesh that winding numbers understand: pieces look outwards, none lies in another.

    Every tooth may be a closed piece, or a whole arch one open strip. An iris inside the eyeball
    is dropped, it would be taken for the surface.
    """
    pieces = components(mesh.faces, mesh.vertex_count)
    volumes = capped_volumes(mesh.positions, mesh.faces, pieces)
    faces = mesh.faces.copy()
    inward = volumes[pieces.of_face] < 0.0
    faces[inward] = faces[inward][:, [0, 2, 1]]
    low = np.full((pieces.piece_count, 3), np.inf)
    high = np.full((pieces.piece_count, 3), -np.inf)
    for corner in range(3):
        points = mesh.positions[mesh.faces[:, corner]]
        np.minimum.at(low, pieces.of_face, points)
        np.maximum.at(high, pieces.of_face, points)
    encloses = np.all((low[:, None] < low[None]) & (high[:, None] > high[None]), axis=2)
    enclosed: BoolArray = np.asarray(np.any(encloses, axis=0))
    return TriMesh(mesh.positions, faces[~enclosed[pieces.of_face]])


def penetrations(
    rig: Rig, head: Head, skin: FloatArray, visible: BoolArray
) -> dict[str, list[Penetration]]:
    """Measure the depth of the skin in every part of `COLLIDERS` that the head has.

    A vertex is inside where the part winds around it by more than one half (which also holds for
    an open strip of teeth), and its depth is the distance to the part's surface.

    Parameters
    ----------
    rig : Rig
    head : Head
    skin : (s, w, 3) float64
        Displacements of the welded skin [mm].
    visible : (w,) bool
        Skin that is judged: not the mouth bag and the sockets.

    Returns
    -------
    dict of str to list of Penetration
        By part; one entry per shape.

    Notes
    -----
    Where a part moves as a rigid body the skin is carried back into its rest frame, so that all
    shapes are answered by one query.
    """
    reach = np.sqrt((skin * skin).sum(axis=2).max(axis=0, initial=0.0))
    result: dict[str, list[Penetration]] = {}
    for kind in COLLIDERS:
        part = head.part(kind)
        if part is None:
            continue
        moved = part_deltas(rig, head, part)
        near = _within_reach(head.skin.mesh.positions, reach, part.mesh.positions, moved)
        chosen = np.flatnonzero(visible & near)
        rest, motion = head.skin.mesh.positions[chosen], skin[:, chosen]
        depth, rest_depth = _depth_in_shapes(solid(part.mesh), moved, rest, motion)
        result[kind] = _summary(depth, rest_depth, head.skin.first_source()[chosen])
    return result


def _within_reach(
    points: FloatArray, reach: FloatArray, body: FloatArray, moved: FloatArray
) -> BoolArray:
    """Return the points (w,) that may come into the bounding box of a body (k, 3) in some shape."""
    posed = body + moved
    low = np.minimum(posed.min(axis=(0, 1), initial=np.inf), body.min(axis=0))
    high = np.maximum(posed.max(axis=(0, 1), initial=-np.inf), body.max(axis=0))
    outside = np.maximum(np.maximum(low - points, points - high), 0.0)
    return np.asarray(np.max(outside, axis=1) <= reach)


def _depth_in_shapes(
    body: TriMesh, moved: FloatArray, rest: FloatArray, motion: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the depth (s, k) of points in a solid in all shapes, and at rest (k,)."""
    rest_depth = depths_inside(body, rest)
    rigid = rigid_motions(body.positions, moved)
    posed = rest + motion
    local = np.einsum("skj,sji->ski", posed - rigid.offset[:, None], rigid.rotation)
    local[~rigid.fits] = rest
    changed = np.abs(local - rest).max(axis=2, initial=0.0) > _SAME
    depth = np.broadcast_to(rest_depth, changed.shape).copy()
    depth[changed] = depths_inside(body, local[changed])
    for shape in np.flatnonzero(~rigid.fits).tolist():
        depth[shape] = depths_inside(body.at(body.positions + moved[shape]), posed[shape])
    return depth, rest_depth


def _summary(depth: FloatArray, rest_depth: FloatArray, source: IntArray) -> list[Penetration]:
    if not depth.shape[1]:
        return [Penetration(0.0, 0.0, -1) for _ in depth]
    added = depth - rest_depth
    deepest = added.argmax(axis=1)
    result: list[Penetration] = []
    for shape, row in enumerate(deepest.tolist()):
        growth = float(added[shape, row])
        vertex = int(source[row]) if growth > 0.0 else -1
        result.append(Penetration(float(depth[shape].max()), max(growth, 0.0), vertex))
    return result


def depths_inside(body: TriMesh, points: FloatArray) -> FloatArray:
    """Return how deep (q,) [mm] the points (q, 3) lie inside a body of `solid`, 0 outside."""
    depth = np.zeros(len(points))
    if not body.face_count:
        return depth
    used = body.positions[np.unique(body.faces)]
    near = np.flatnonzero(((points > used.min(axis=0)) & (points < used.max(axis=0))).all(axis=1))
    inside = near[winding_numbers(body, points[near]) > 0.5]
    if len(inside):
        depth[inside] = closest_points(body, points[inside]).distance
    return depth
