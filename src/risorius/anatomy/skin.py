"""The skin that the muscles move: its mirror image, its stiffness, what lies beneath it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix, diags
from scipy.spatial import cKDTree

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.mouth import Mouth, measure_mouth
from risorius.anatomy.outwards import unit
from risorius.anatomy.skull import dental_arches
from risorius.anatomy.skull_fit import MIRROR, FittedSkull, hidden_skin
from risorius.anatomy.smooth_step import smooth_step
from risorius.mesh.connectivity import edges
from risorius.mesh.core import TriMesh
from risorius.mesh.laplacian import cotangent_laplacian, mass
from risorius.mesh.normals import vertex_normals
from risorius.spatial.raycast import Scene

__all__ = ["Skin", "build_skin", "mirror_partners"]

# A vertex has a partner if one lies this near to its mirror image, and faces like it [mm].
_NEAR, _NORMAL = 0.25, 1.0
# Where tissue depth is looked for, and its limits [mm].
_DEEPEST, _LEAST, _MOST, _NONE = 45.0, 2.0, 25.0, 25.0
# Passive stiffness over 8 mm of tissue, of lids and of the lips' attachment (frenulum).
_PASSIVE, _LID, _FRENULUM = 0.035, 2.0, 0.35
# How the passive stiffness falls with depth, and the range of 8 mm / depth that counts.
_DEPTH_POWER, _DEPTH_RANGE = 1.5, (0.1, 1.2)
# Cartilage of the nose.
_NOSE = 1.0
# The lining of the mouth follows the lips.
_LINING = 0.005
_LID_BAND = 9.0


@dataclass(frozen=True, eq=False)
class Skin:
    """A welded skin of n vertices, measured for muscles.

    Parameters
    ----------
    mesh : TriMesh
        Canonical frame [mm].
    scale : float
        Size of the head over that of the built-in one; lengths of the map are multiplied by it.
    normals, broad_normals : (n, 3) float64
        Unit normals, of the vertex and of its surroundings.
    partner : (n,) int32 or None
        Vertex at the mirror image of each; None for a skin that is not symmetric.
    mouth : Mouth
    depth : (n,) float64
        Tissue over bone and teeth, in millimetres of the built-in head.
    lids : (n,) float64
        1 at the lid margins, 0 away from them.
    mobility : (n,) float64
        1 where muscles act, 0 at the back, the ears, the crown and down the neck.
    hidden : (n,) bool
        Skin that lies inside: mouth bag, eye sockets.
    passive : (n,) float64
        How strongly tissue holds the skin in place.
    """

    mesh: TriMesh
    scale: float
    normals: FloatArray
    broad_normals: FloatArray
    partner: IntArray | None
    mouth: Mouth
    depth: FloatArray
    lids: FloatArray
    mobility: FloatArray
    hidden: BoolArray
    passive: FloatArray

    @property
    def positions(self) -> FloatArray:
        """Vertices at rest (n, 3) [mm]."""
        return self.mesh.positions

    @cached_property
    def average(self) -> csr_matrix:
        """(n, n) mean of the neighbours of each vertex and itself, one half each."""
        matrix = averaging(self.mesh)
        if self.partner is None:
            return matrix
        # Polygons may be cut into triangles one way on the left and another on the right.
        return csr_matrix(0.5 * (matrix + matrix[self.partner][:, self.partner]))

    @cached_property
    def mass(self) -> FloatArray:
        """(n,) vertex areas [mm^2]."""
        return self.even(mass(self.mesh.positions, self.mesh.faces))

    @cached_property
    def stiff(self) -> csr_matrix:
        """(n, n) cotangent Laplacian, mirror-symmetric on a symmetric skin."""
        matrix = cotangent_laplacian(self.mesh.positions, self.mesh.faces)
        if self.partner is None:
            return matrix
        return csr_matrix(0.5 * (matrix + matrix[self.partner][:, self.partner]))

    def even(self, values: FloatArray) -> FloatArray:
        """Return scalars (n,) averaged with their mirror image, where the skin has one."""
        return values if self.partner is None else 0.5 * (values + values[self.partner])

    def mirrored(self, vectors: FloatArray) -> FloatArray:
        """Return the mirror image (n, 3) of a field on a symmetric skin."""
        return vectors if self.partner is None else vectors[self.partner] * MIRROR

    def even_vectors(self, vectors: FloatArray) -> FloatArray:
        """Return vectors (n, 3) averaged with their mirror image, where the skin has one."""
        return vectors if self.partner is None else 0.5 * (vectors + self.mirrored(vectors))

    def smoothed(self, values: FloatArray, passes: int) -> FloatArray:
        """Return `values` (n, ...) averaged `passes` times with the neighbours."""
        for _ in range(passes):
            values = self.average @ values
        return values


def averaging(mesh: TriMesh) -> csr_matrix:
    """Return the (n, n) matrix that takes half of each vertex and half of its neighbours' mean."""
    pairs = edges(mesh.faces)
    n = mesh.vertex_count
    both = np.concatenate([pairs, pairs[:, ::-1]])
    graph = csr_matrix(coo_matrix((np.ones(len(both)), (both[:, 0], both[:, 1])), shape=(n, n)))
    degree = np.asarray(graph.sum(axis=1)).ravel()
    alone = degree == 0.0
    half = diags(np.where(alone, 1.0, 0.5))
    return csr_matrix(diags(0.5 / np.where(alone, 1.0, degree)) @ graph + half)


def mirror_partners(mesh: TriMesh, *, tolerance: float = _NEAR) -> IntArray | None:
    """Return the vertex (n,) at each vertex's mirror image, None if the mesh has no such pairs.

    Parameters
    ----------
    mesh : TriMesh
        Canonical frame [mm].
    tolerance : float
        Farthest that a partner may be from the mirror image [mm].
    """
    normals = vertex_normals(mesh.positions, mesh.faces)
    features = np.concatenate([mesh.positions, _NORMAL * normals], axis=1)
    partner = np.asarray(cKDTree(features).query(features * np.tile(MIRROR, 2))[1], np.int32)
    off = np.linalg.norm(mesh.positions[partner] - mesh.positions * MIRROR, axis=1)
    paired = (partner[partner] == np.arange(len(partner))).all()
    return partner if paired and off.max(initial=0.0) <= tolerance else None


def build_skin(mechanics: Mechanics, fitted: FittedSkull, partner: IntArray | None) -> Skin:
    """Measure the skin of a head.

    Parameters
    ----------
    mechanics : Mechanics
        Of the head.
    fitted : FittedSkull
        The skull inside it.
    partner : (n,) int32 or None
        From `mirror_partners`.
    """
    head, lips = mechanics.head, mechanics.lips
    mesh, scale = head.skin.mesh, fitted.scale
    normals = vertex_normals(mesh.positions, mesh.faces)
    hidden = hidden_skin(lips, mechanics.margins)
    blank = np.zeros(mesh.vertex_count)
    mouth = measure_mouth(head, lips, scale)
    skin = Skin(
        mesh, scale, normals, normals, partner, mouth, blank, blank, blank, hidden, blank
    )  # fmt: skip
    normals = unit(skin.even_vectors(normals))
    broad = unit(skin.even_vectors(skin.smoothed(normals, 15)))
    depth, bony = _tissue(skin, mechanics, fitted)
    lids = skin.even(_lid_band(mechanics, scale))
    low, high = _DEPTH_RANGE
    held = _PASSIVE * np.clip(8.0 / depth, low, high) ** _DEPTH_POWER
    held = held * np.where(bony, 1.0, 0.25) + _NOSE * _nose(mechanics)
    far = (0.95 - np.abs(mouth.place)) / 0.6
    frenulum = smooth_step(1.0 - (mouth.distance - 3.0) / 9.0) * smooth_step(far)
    held = held + _FRENULUM * frenulum * (mouth.side != 0.0)
    held = np.where(hidden & (lids <= 0.0), _LINING, held + _LID * lids)
    passive = skin.even(held)
    return Skin(
        mesh, scale, normals, broad, partner, mouth, depth, lids,
        skin.even(_mobility(mechanics)), hidden, passive,
    )  # fmt: skip


def _tissue(skin: Skin, mechanics: Mechanics, fitted: FittedSkull) -> tuple[FloatArray, BoolArray]:
    """Return the depth of bone or teeth (n,) in built-in millimetres, and where there is some."""
    meshes = [fitted.cranium, fitted.mandible, *dental_arches(mechanics.head)]
    scale = skin.scale
    sound = (skin.normals != 0.0).any(axis=1)
    inwards = np.where(sound[:, None], -skin.normals, [0.0, 0.0, -1.0])
    hits = Scene(meshes).cast(skin.positions, inwards, max_distance=_DEEPEST * scale)
    facing = np.einsum("nd,nd->n", np.nan_to_num(hits.normals), skin.normals) > 0.1
    bony = hits.hit & facing & sound
    depth = np.where(bony, np.where(bony, hits.distance, 0.0) / scale, _NONE)
    depth = skin.smoothed(np.clip(depth, _LEAST, _MOST), 8)
    if skin.partner is not None:
        bony = bony & bony[skin.partner]
    return skin.even(depth), bony


def _lid_band(mechanics: Mechanics, scale: float) -> FloatArray:
    points = mechanics.head.skin.mesh.positions
    band = np.zeros(len(points))
    for margins in mechanics.margins.values():
        first, second = points[list(margins.slit.corners)]
        across = (second - first) / margins.width
        beside = np.abs((points - 0.5 * (first + second)) @ across) / (0.5 * margins.width)
        fade = 1.0 - smooth_step((margins.distance - scale) / (_LID_BAND * scale))
        fade = np.where(np.isfinite(margins.distance), fade, 0.0)
        fade = fade * np.clip((1.35 - beside) / 0.35, 0.0, 1.0)
        band = np.maximum(band, np.where(margins.slit.inside, 1.0, fade))
    return band


def _nose(mechanics: Mechanics) -> FloatArray:
    """Return 1 (n,) on bridge and tip of the nose, 0 on its wings and beside it."""
    marks, points = mechanics.head.landmarks, mechanics.head.skin.mesh.positions
    eyes = marks.positions(("3.7", "3.11", "3.8", "3.12")).mean(axis=0)
    tip, lip = marks.position("9.3"), marks.positions(("8.1", "2.2"))[:, 1].max()
    height = float(eyes[1] - tip[1])
    half = 0.36 * height
    if not marks.missing(("9.1", "9.2")):
        half = 0.5 * float(np.ptp(marks.positions(("9.1", "9.2"))[:, 0]))
    beside = smooth_step((0.95 - np.abs(points[:, 0]) / half) / 0.45)
    base = tip[1] - 0.45 * (tip[1] - lip)
    above = smooth_step((points[:, 1] - base) / (0.15 * height))
    below = smooth_step((eyes[1] - 0.25 * height - points[:, 1]) / (0.4 * height))
    front = points[:, 2] > 0.5 * (eyes[2] + tip[2]) - 0.3 * height
    return beside * above * below * front


def _mobility(mechanics: Mechanics) -> FloatArray:
    """Return where muscles act: nothing that must be still on a head may move with the face."""
    head = mechanics.head
    points, marks = head.skin.mesh.positions, head.landmarks
    eyes = marks.positions(("3.7", "3.11", "3.8", "3.12")).mean(axis=0)
    chin = float(marks.position("2.1")[1])
    height = float(eyes[1]) - chin
    corner = marks.positions(("3.7", "3.12"))
    # The neck takes part farther back than the face, where the ears are.
    low = smooth_step((chin + 0.1 * height - points[:, 1]) / (0.25 * height))
    behind = float(corner[:, 2].mean()) - (0.62 + 0.4 * low) * height
    side = smooth_step((points[:, 2] - behind) / ((0.3 - 0.1 * low) * height))
    neck = smooth_step((points[:, 1] - (chin - 0.58 * height)) / (0.24 * height))
    top = smooth_step((float(eyes[1]) + 0.9 * height - points[:, 1]) / (0.25 * height))
    return side * neck * top
