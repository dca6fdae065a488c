"""Cut skull and jaw out of a head's own skin."""

from __future__ import annotations

import igl
import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.errors import MeshError
from risorius.mesh.core import TriMesh
from risorius.springmuscle.surface import SkinSurface

__all__ = ["cut_head"]

# Bone meshes serve the start only; this many triangles show all that the tissue lets through.
_FACES = 3000
_FEWEST = 20


def cut_head(surface: SkinSurface, hinge: FloatArray, tissue: float) -> tuple[TriMesh, TriMesh]:
    """Return skull and jaw.

    The jaw is the skin below the plane through condyles and lip line, in front of the ramus and
    above the plane from the angle of the jaw to the chin; lips, cheeks, sockets, the soft nose and
    the neck are cut out of both.

    Parameters
    ----------
    surface : SkinSurface
    hinge : (3,) float64
        Middle between the condyles [mm].
    tissue : float
        How far bone lies below the skin [mm at the reference width].

    Raises
    ------
    MeshError
        If there is no jaw in front of the hinge.
    """
    points = surface.mesh.positions
    jaw, above = _jaw_side(surface, hinge)
    soft = _soft(surface) | _neck(surface, hinge, above) | surface.hidden
    shrunk = points - tissue * surface.scale * surface.broad_normals
    meshes: list[TriMesh] = []
    for name, wanted in (("skull", ~jaw), ("jaw", jaw)):
        chosen = (wanted & ~soft)[surface.mesh.faces].all(axis=1)
        if chosen.sum() < _FEWEST:
            raise MeshError(
                f"head: cutting it leaves {int(chosen.sum())} triangles for the {name}; check the "
                "landmarks of lips and chin (2.1 2.2 2.3), or use the built-in skull"
            )
        meshes.append(_simplified(shrunk, surface.mesh.faces[chosen]))
    return meshes[0], meshes[1]


def _jaw_side(surface: SkinSurface, hinge: FloatArray) -> tuple[BoolArray, BoolArray]:
    """Return which vertices (n,) belong to the jaw, and which lie above its underside."""
    points, measure, scale = surface.mesh.positions, surface.measure, surface.scale
    lips = 0.5 * (measure.landmarks["2.2"] + measure.landmarks["2.3"])
    chin = measure.landmarks["2.1"]
    below = (points - hinge) @ _upwards(np.array([1.0, 0.0, 0.0]), lips - hinge) < 0.0
    angle = hinge + [0.0, -0.85 * measure.height, -0.02 * measure.width]
    slope = (points[:, 1] - angle[1]) / (hinge[1] - angle[1])
    front = points[:, 2] > angle[2] + slope * (hinge[2] - angle[2])
    base = chin + np.array([0.0, -4.0, -30.0]) * scale - angle
    above = (points - angle) @ _upwards(np.array([1.0, 0.0, 0.0]), base) > -6.0 * scale
    return below & front & above, above


def _upwards(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return the upward unit normal (3,) of the plane along two vectors (3,)."""
    normal = np.cross(first, second)
    return normal * np.sign(normal[1]) / np.linalg.norm(normal)


def _soft(surface: SkinSurface) -> BoolArray:
    """Return the skin (n,) without bone: lips, cheeks, sockets, the lower nose."""
    points, marks, unit = surface.mesh.positions, surface.measure.landmarks, surface.measure.unit
    width, height, _ = unit
    lips = 0.5 * (marks["2.2"] + marks["2.3"])
    mouth = _in_ellipse(points, lips, 0.36 * width, 0.27 * height)
    soft = mouth & (points[:, 2] > lips[2] - 0.44 * width)
    for side, corner, outer, inner in ((1.0, "2.4", "3.7", "3.11"), (-1.0, "2.5", "3.12", "3.8")):
        place = (points - marks[corner]) / unit * [side, 1.0, 1.0]
        cheek = (place[:, 0] > -0.05) & (np.abs(place[:, 1] - 0.05) < 0.28)
        cheek &= (place[:, 2] > -0.55) & (place[:, 2] < 0.05) & (side * points[:, 0] > 0.0)
        eye = 0.5 * (marks[outer] + marks[inner])
        socket = _in_ellipse(points, eye, 0.23 * width, 0.2 * height)
        soft |= cheek | (socket & (points[:, 2] > eye[2] - 0.25 * width))
    eyes = 0.5 * (marks["3.7"] + marks["3.12"])
    nose = (np.abs(points[:, 0]) < 0.2 * width) & (points[:, 1] < eyes[1] - 0.3 * height)
    nose &= (points[:, 1] > lips[1] + 0.1 * height) & (points[:, 2] > lips[2] - 0.05 * width)
    return soft | nose


def _neck(surface: SkinSurface, hinge: FloatArray, above: BoolArray) -> BoolArray:
    points, measure = surface.mesh.positions, surface.measure
    chin = measure.landmarks["2.1"]
    low = points[:, 1] < chin[1] - 0.15 * measure.height
    return (low & (points[:, 2] < chin[2] - 0.45 * measure.width)) | (
        ~above & (points[:, 2] > hinge[2])
    )


def _in_ellipse(
    points: FloatArray, centre: FloatArray, half_width: float, half_height: float
) -> BoolArray:
    place = (points - centre)[:, :2] / [half_width, half_height]
    return (place**2).sum(axis=1) < 1.0


def _simplified(positions: FloatArray, faces: IntArray) -> TriMesh:
    """Return the used part of a mesh, with few triangles where it can be simplified."""
    faces = _without_pinches(faces)
    used, local = np.unique(faces, return_inverse=True)
    mesh = TriMesh(positions[used], local.reshape(-1, 3).astype(np.int32))
    if mesh.face_count <= _FACES:
        return mesh
    points, triangles, *_ = igl.decimate(mesh.positions, mesh.faces.astype(np.int64), _FACES)
    # Collapsing needs a manifold; what is none serves as it is.
    if not len(triangles):
        return mesh
    return TriMesh(np.asarray(points), np.asarray(triangles, np.int32))


def _without_pinches(faces: IntArray) -> IntArray:
    """Return `faces` (m, 3) without those at edges or vertices where the surface is pinched."""
    while len(faces):
        sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        ordered = np.sort(sides, axis=1)
        edges, count = np.unique(ordered, axis=0, return_counts=True)
        _, same = np.unique(sides, axis=0, return_counts=True)
        open_ends = np.bincount(edges[count == 1].ravel(), minlength=int(faces.max()) + 1)
        bad = open_ends > 2
        bad[edges[count > 2].ravel()] = True
        if not bad.any():
            return faces if (same == 1).all() else faces[:0]
        faces = faces[~bad[faces].any(axis=1)]
    return faces
