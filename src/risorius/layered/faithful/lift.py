"""Bring the muscles to the skin: landmarks are lifted onto them, what sticks out sinks in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.outwards import outwards, unit
from risorius.anatomy.skull_fit import MIRROR
from risorius.anatomy.smooth_step import smooth_step
from risorius.layered.faithful.anatomy import Anatomy, rebuilt
from risorius.mesh.core import TriMesh
from risorius.spatial.raycast import Scene
from risorius.warp.rbf import RbfWarp

__all__ = ["Pairs", "lifted_bones", "lifted_pairs", "muscle_tops", "tissue_depth"]

# Skin landmarks of spec 3.3 and the pairs between which further ones are looked for.
_LANDMARKS = (
    "11.1", "11.2", "11.3", "11.4", "4.1", "4.2", "4.3", "4.4", "4.5", "4.6", "3.7", "3.8",
    "3.11", "3.12", "5.1", "5.2", "5.3", "5.4", "9.6", "9.7", "9.12", "9.15", "2.1", "2.10",
    "2.11", "2.12", "2.13", "2.14", "7.1", "10.9", "10.10",
)  # fmt: skip
_BETWEEN = (
    ("11.1", "4.1"), ("11.1", "4.2"), ("11.2", "4.6"), ("11.3", "4.5"), ("4.1", "4.2"),
    ("4.5", "3.7"), ("4.6", "3.8"), ("3.7", "5.3"), ("3.8", "5.4"), ("5.1", "2.11"),
    ("5.2", "2.12"), ("5.3", "2.13"), ("5.4", "2.14"), ("9.15", "2.10"), ("2.11", "2.13"),
    ("2.12", "2.14"),
)  # fmt: skip
# A muscle lies this deep, in its thickness, and a lifted landmark moves so far at most [mm].
_LEAST, _MOST, _LONGEST = 0.5, 2.0, 8.0
# Muscle that lies well stays where this many points on it are [-], this far apart [mm].
_KEPT, _APART = 75, 3.0
# Rays come from this far outside and end as far inside [mm].
_OUTSIDE, _INSIDE = 80.0, 120.0
# Bone within this distance of what sticks out sinks with it [mm].
_REACH = 14.0
_LIFTS, _SINKS = 2, 6


@dataclass(frozen=True, eq=False)
class Pairs:
    """Points of a fitted skull, landmarks lifted onto its muscles among them, and where they go.

    Parameters
    ----------
    sources, targets : (k, 3) float64
        [mm].
    lifted : int
        How many of the first ones are landmarks.
    """

    sources: FloatArray
    targets: FloatArray
    lifted: int

    def warp(self) -> RbfWarp:
        """Return the warp that carries sources onto targets."""
        return RbfWarp.fit(self.sources, self.targets)


def muscle_tops(anatomy: Anatomy) -> tuple[FloatArray, FloatArray]:
    """Return all muscles' top vertices (k, 3) and their thickness (k,) in the map [mm]."""
    tops = [
        anatomy.positions[m.surface.first + m.mesh.bottom_count : m.surface.last]
        for m in anatomy.muscles
    ]
    thickness = [np.full(len(t), m.muscle.thickness) for t, m in zip(tops, anatomy.muscles)]
    return np.concatenate(tops), np.concatenate(thickness)


def tissue_depth(skin: TriMesh, points: FloatArray, *, scale: float = 1.0) -> FloatArray:
    """Return how deep (k,) points lie under the skin, seen from outside; negative beyond it [mm].

    Infinite depths, where the ray finds no skin, are not returned: they count as on the skin.
    """
    way, far = outwards(points / scale), _OUTSIDE * scale
    hits = Scene([skin]).cast(points + far * way, -way, max_distance=(_OUTSIDE + _INSIDE) * scale)
    return np.where(hits.hit, far - hits.distance, 0.0)


def lifted_bones(
    drawn: Anatomy, bones: Mapping[str, FloatArray], mechanics: Mechanics, *, scale: float,
    symmetric: bool,
) -> dict[str, FloatArray]:  # fmt: skip
    """Return the vertices of fitted `bones`, moved so that the muscles on them lie under the skin.

    Where muscle covers a landmark of the skull, the landmark is lifted onto the muscle before the
    last warp (thesis 4.5.2, spec 2.9 steps 4 and 5); with the muscle's own depth below the skin,
    not in it as published. Between landmarks muscles may still come through the skin: bone under
    them sinks until they do not.

    Parameters
    ----------
    drawn : Anatomy
        Laid on the skull as it was before the fit.
    bones : mapping of str to (k, 3) float64
        Vertices of every bone after the fit [mm].
    mechanics : Mechanics
        Of the head.
    scale : float
        Size of the head over that of the built-in one.
    symmetric : bool
        Whether the head is mirror-symmetric; then so is the result.
    """
    result = dict(bones)
    for _ in range(_LIFTS):
        anatomy = rebuilt(drawn, result, scale=scale)
        pairs = lifted_pairs(anatomy, mechanics, scale=scale, symmetric=symmetric)
        warp = pairs.warp()
        result = {name: warp(places) for name, places in result.items()}
    for _ in range(_SINKS):
        anatomy = rebuilt(drawn, result, scale=scale)
        tops, thickness = muscle_tops(anatomy)
        depth = tissue_depth(mechanics.head.skin.mesh, tops, scale=scale)
        missing = _LEAST * thickness * scale - depth
        bad = (missing > 0.0) & (depth > -_LONGEST * scale)
        if not bad.any():
            break
        result = {
            name: _sunk(places, tops[bad], missing[bad], scale) for name, places in result.items()
        }
    return result


def _sunk(places: FloatArray, points: FloatArray, push: FloatArray, scale: float) -> FloatArray:
    """Return bone (k, 3) moved inwards by the largest push (b,) around, fading with distance."""
    reach = _REACH * scale
    pairs = cKDTree(places).sparse_distance_matrix(cKDTree(points), reach, output_type="ndarray")
    amount = np.zeros(len(places))
    share = push[pairs["j"]] * smooth_step(1.0 - pairs["v"] / reach)
    np.maximum.at(amount, pairs["i"], share)
    return places - amount[:, None] * outwards(places / scale)


def lifted_pairs(anatomy: Anatomy, mechanics: Mechanics, *, scale: float, symmetric: bool) -> Pairs:
    """Return the landmarks lifted onto muscles, and muscle that stays where it is.

    Parameters
    ----------
    anatomy : Anatomy
        Fitted into the head.
    mechanics : Mechanics
        Of the head.
    scale : float
        Size of the head over that of the built-in one.
    symmetric : bool
        Whether pairs come with their mirror images.
    """
    sources, targets = _landmark_pairs(anatomy, mechanics, scale)
    lifted = len(sources)
    skin = mechanics.head.skin.mesh
    tops, thickness = muscle_tops(anatomy)
    seen = _seen(anatomy, tops, scale) & (tops[:, 2] > mechanics.jaw.hinge[2])
    if symmetric:
        seen &= tops[:, 0] >= -1e-6
    rows = np.flatnonzero(seen)
    depth = tissue_depth(skin, tops[rows], scale=scale)
    well = depth >= _LEAST * thickness[rows] * scale
    kept = tops[rows[well]]
    kept = kept[spread_out(kept, _KEPT, 2.0 * _APART * scale)]
    sources = np.concatenate([sources, kept])
    targets = np.concatenate([targets, kept])
    apart = spread_out(sources, len(sources), _APART * scale)
    lifted = int((apart < lifted).sum())
    sources, targets = sources[apart], targets[apart]
    if symmetric:
        sources, targets = _with_mirror(sources, targets, 0.5 * _APART * scale)
    return Pairs(sources, targets, lifted)


def _landmark_pairs(
    anatomy: Anatomy, mechanics: Mechanics, scale: float
) -> tuple[FloatArray, FloatArray]:
    """Return where horizontal rays to landmarks meet muscle (k, 3) and where that goes [mm]."""
    marks, mesh = mechanics.head.landmarks, mechanics.head.skin.mesh
    points = [marks.position(name) for name in _LANDMARKS if name in marks]
    points += [
        0.5 * (marks.position(a) + marks.position(b))
        for a, b in _BETWEEN
        if a in marks and b in marks
    ]
    places = np.array(points).reshape(-1, 3)
    way = places - mesh.positions.mean(axis=0)
    way[:, 1] = 0.0
    way, far = unit(way), _OUTSIDE * scale
    limit = (_OUTSIDE + 0.5 * _OUTSIDE) * scale
    on_skin = Scene([mesh]).cast(places + far * way, -way, max_distance=limit)
    beneath = Scene([TriMesh(anatomy.positions, anatomy.faces)]).cast(
        places + far * way, -way, max_distance=limit
    )
    thickness = scale * _thickness_of_faces(anatomy)
    covered = on_skin.hit & beneath.hit & (places[:, 2] > mechanics.jaw.hinge[2])
    covered[covered] &= thickness[beneath.face[covered]] > 0.0
    depth = beneath.distance[covered] - on_skin.distance[covered]
    thick = thickness[beneath.face[covered]]
    wanted = np.clip(depth, _LEAST * thick, _MOST * thick)
    lift = np.clip(depth - wanted, -_LONGEST * scale, _LONGEST * scale)
    found = beneath.positions[covered]
    return found, found + lift[:, None] * way[covered]


def _thickness_of_faces(anatomy: Anatomy) -> FloatArray:
    result = np.zeros(len(anatomy.faces))
    for laid in anatomy.muscles:
        result[laid.surface.rows] = laid.muscle.thickness
    return result


def _seen(anatomy: Anatomy, tops: FloatArray, scale: float) -> BoolArray:
    """Return which tops (k,) no other muscle covers."""
    way, far = outwards(tops / scale), _OUTSIDE * scale
    hits = Scene([TriMesh(anatomy.positions, anatomy.faces)]).cast(
        tops + far * way, -way, max_distance=2.0 * far
    )
    return ~hits.hit | (hits.distance > far - 0.5 * scale)


def spread_out(points: FloatArray, count: int, apart: float) -> IntArray:
    """Return up to `count` rows of points (k, 3), early ones first, all at least `apart` away."""
    kept: list[int] = []
    for row in range(len(points)):
        if len(kept) == count:
            break
        near = np.linalg.norm(points[kept] - points[row], axis=1)
        if not len(near) or float(near.min()) > apart:
            kept.append(row)
    return np.array(kept, np.int32)


def _with_mirror(
    sources: FloatArray, targets: FloatArray, middle: float
) -> tuple[FloatArray, FloatArray]:
    """Return pairs with their mirror images; those near the middle are put onto it."""
    on_middle = np.abs(sources[:, 0]) <= middle
    aside = sources[:, 0] > middle
    flat = np.array([0.0, 1.0, 1.0])
    return tuple(
        np.concatenate([row[on_middle] * flat, row[aside], row[aside] * MIRROR])
        for row in (sources, targets)
    )  # pyright: ignore[reportReturnType]
