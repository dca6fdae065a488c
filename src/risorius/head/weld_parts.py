"""Build the welded mesh of every part."""

from __future__ import annotations

import warnings

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray, IntArray
from risorius.errors import RisoriusWarning
from risorius.head.part import PART_KINDS, Part
from risorius.landmarks.landmark_set import LandmarkSet
from risorius.mesh.core import TriMesh
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.mesh.welding import weld

__all__ = ["build_parts"]

# Faces this close to the tip of the nose look forward as a whole [mm].
_NOSE = 15.0


def build_parts(
    mesh: PolygonMesh, positions: FloatArray, kinds: IntArray, landmarks: LandmarkSet
) -> dict[str, Part]:
    """Return the parts by kind.

    Parameters
    ----------
    mesh : PolygonMesh
    positions : (n, 3) float64
        Canonical [mm].
    kinds : (m,) int32
        Part kind of every polygon, from `assign_parts`.
    landmarks : LandmarkSet
        Canonical; tells touching lips from a texture seam.
    """
    triangle_kind = kinds[mesh.triangle_polygon]
    triangles = mesh.triangles
    if _looks_inwards(positions, triangles[triangle_kind == PART_KINDS.index("skin")], landmarks):
        warnings.warn(
            "head: its faces look inwards; they are turned inside and kept in the output (turn "
            "them in the modelling program if the head is to be seen from outside)",
            RisoriusWarning,
            stacklevel=3,
        )
        triangles = triangles[:, ::-1]
    parts: dict[str, Part] = {}
    for number, kind in enumerate(PART_KINDS):
        faces = triangles[triangle_kind == number]
        if len(faces):
            apart = _touching_lips(positions, landmarks) if kind == "skin" else None
            parts[kind] = _build(kind, positions, faces, apart)
    return parts


def _looks_inwards(positions: FloatArray, faces: IntArray, landmarks: LandmarkSet) -> bool:
    """Return whether the skin as a whole, and its nose too, show their back."""
    if not len(faces) or "9.3" not in landmarks:
        return False
    corners = positions[faces]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    middles = corners.mean(axis=1)
    volume = float(np.einsum("ij,ij", areas, middles - middles.mean(axis=0)))
    nose = np.linalg.norm(middles - landmarks.position("9.3"), axis=1) < _NOSE
    return volume < 0.0 and float(areas[nose, 2].sum()) < 0.0


def _build(kind: str, positions: FloatArray, faces: IntArray, apart: IntArray | None) -> Part:
    source = np.unique(faces).astype(np.int32)
    local = np.zeros(len(positions), np.int32)
    local[source] = np.arange(len(source))
    points = positions[source]
    keep = None
    if apart is not None and len(apart):
        inside = np.isin(apart, source).all(axis=1)
        keep = local[apart[inside]]
    joined = weld(points, tolerance=1e-6, keep_apart=keep)
    welded = joined.representative.astype(np.int32)
    triangles = welded[local[faces]]
    first = np.zeros(int(welded.max()) + 1, np.int32)
    first[welded[::-1]] = np.arange(len(source))[::-1]
    return Part(kind, TriMesh(points[first], triangles), source, welded)


def _touching_lips(positions: FloatArray, landmarks: LandmarkSet) -> IntArray | None:
    """Return pairs (k, 2) of coincident vertices along the closed mouth, if the lips coincide.

    They coincide when the two middle points of the inner lip contours are different vertices at
    one place; then every coincident pair between the mouth corners is upper and lower lip.
    """
    if landmarks.missing(("2.2", "2.3", "2.4", "2.5")):
        return None
    upper, lower = landmarks.vertex("2.2"), landmarks.vertex("2.3")
    left, right = landmarks.positions(("2.4", "2.5"))
    mouth_width = float(np.linalg.norm(left - right))
    close = 1e-5 * mouth_width
    if upper == lower or np.linalg.norm(positions[upper] - positions[lower]) > close:
        return None
    middle = landmarks.position("2.2")
    near = np.flatnonzero(np.linalg.norm(positions - middle, axis=1) < 0.75 * mouth_width)
    between = near[
        (positions[near, 0] < max(left[0], right[0]) - close)
        & (positions[near, 0] > min(left[0], right[0]) + close)
        & (np.abs(positions[near, 1] - middle[1]) < 0.3 * mouth_width)
    ]
    pairs = cKDTree(positions[between]).query_pairs(close, output_type="ndarray")
    return between[pairs].astype(np.int32) if len(pairs) else None
