"""The relief of wrinkled skin: valleys where it is pressed together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from risorius._check import BoolArray, FloatArray, as_number
from risorius.anatomy.smooth_step import smooth_step
from risorius.errors import ParameterError
from risorius.mesh.core import TriMesh
from risorius.mesh.normals import face_areas, face_normals, vertex_normals
from risorius.rig.quality.subject import Subject, part_deltas, subject_of
from risorius.rig.rig import Rig
from risorius.wrinkles.refine import Patch, refine
from risorius.wrinkles.strain import principal, surface_strain
from risorius.wrinkles.stripes import stripe_wave
from risorius.wrinkles.supple import suppleness_of

__all__ = ["Relief", "Wrinkler", "slope_of"]

# Compression at which skin begins to wrinkle, and at which it does so fully [1].
_FIRST, _FULL = 0.06, 0.16
# Skin that is drawn out along its wrinkles is smoothed by it, from and up to this strain [1].
_DRAWN, _SMOOTHED = 0.08, 0.28
_MOST = 0.3
# How much of the length that a sheet must lose goes into its relief; the rest is compressed.
_INTO_RELIEF = 0.3
# Valleys are narrow, ridges round: h = exp(k (wave - 1)).
_SHARP = 3.0
# Skin that is readier than this is worth cutting finely [1].
_FAINT = 0.01
# Fine edges to a wrinkle.
_SAMPLES = 4.0


@dataclass(frozen=True, eq=False)
class Relief:
    """Wrinkles on a patch of skin.

    Parameters
    ----------
    patch : Patch
        The part of the skin that wrinkles, finely cut.
    height : (v,) float64
        Along the normal, 0 on the smooth skin, below 0 in valleys [mm].
    reach : (v,) float64
        Depth that a valley has here [mm].
    slope : (v, 3) float64
        Gradient of the height within the surface, canonical frame [1].
    """

    patch: Patch
    height: FloatArray
    reach: FloatArray
    slope: FloatArray

    @property
    def deepest(self) -> float:
        """Depth of the deepest valley [mm]."""
        return float(-self.height.min(initial=0.0))


class Wrinkler:
    """Makes reliefs for the shapes of one rig.

    Parameters
    ----------
    rig : Rig
        Of any method or maker, with landmarks.

    Raises
    ------
    LandmarkError
        If the rig has no landmarks, or its lids or lips are not found.
    """

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self.subject: Subject = subject_of(rig, None)
        self._supple = suppleness_of(self.subject)
        head = self.subject.head
        assert head is not None
        self.skin = head.skin
        self._normals = vertex_normals(self.skin.mesh.positions, self.skin.mesh.faces)

    def displacement(self, weights: Mapping[str, float]) -> FloatArray:
        """Return the displacement (w, 3) of the welded skin for weights of shapes [mm]."""
        head = self.subject.head
        assert head is not None
        single = self.rig.subset(weights)
        deltas = part_deltas(single, head, self.skin)
        return np.einsum("s,swd->wd", np.array(list(weights.values())), deltas)

    def relief(
        self, weights: Mapping[str, float], *, depth: float = 1.0, spacing: float = 1.0
    ) -> Relief | None:
        """Return the relief for weights of shapes; None where no skin wrinkles.

        A sheet that keeps its length while its ends approach by the share e waves with the height
        ``spacing / pi * sqrt(e)``; skin does so with a part of it.

        Parameters
        ----------
        weights : mapping of str to float
        depth, spacing : float
            Factors on the depth of wrinkles and on their distance.

        Raises
        ------
        ParameterError
            If a shape is unknown or a factor out of range.
        """
        depth = as_number("depth", depth, low=0.0, high=5.0)
        spacing = as_number("spacing", spacing, low=0.3, high=5.0)
        if not weights:
            raise ParameterError("wrinkles: give at least one shape")
        mesh = self.skin.mesh
        strain = surface_strain(mesh, self.displacement(weights))
        ready = self._ready(strain)
        wrinkled: BoolArray = np.asarray(np.any((ready > _FAINT)[mesh.faces], axis=1))
        if not wrinkled.any():
            return None
        distance = spacing * self._supple.spacing
        fine = float(np.quantile(distance[mesh.faces[wrinkled]], 0.1))
        patch = refine(mesh, wrinkled, fine / _SAMPLES)
        normals = patch.carry(self._normals)
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        pressed, direction, _ = principal(patch.carry(strain), normals)
        local, strength = patch.carry(distance), patch.carry(ready)
        wave = stripe_wave(patch.mesh, direction, local, strength=np.maximum(strength, 0.02))
        lost = np.clip(-pressed, 0.0, _MOST)
        reach = depth * _INTO_RELIEF * local / np.pi * np.sqrt(lost) * strength
        height = -reach * np.exp(_SHARP * (wave - 1.0))
        return Relief(patch, height, reach, slope_of(patch.mesh, height))

    def _ready(self, strain: FloatArray) -> FloatArray:
        """Return how far the skin (n,) wrinkles under a strain, 0..1."""
        pressed, _, pulled = principal(strain, self._normals)
        begun = smooth_step((-pressed - _FIRST) / (_FULL - _FIRST))
        drawn = smooth_step((pulled - _DRAWN) / (_SMOOTHED - _DRAWN))
        return begun * (1.0 - drawn) * self._supple.share


def slope_of(mesh: TriMesh, height: FloatArray) -> FloatArray:
    """Return the gradient (v, 3) of heights (v,) on a surface, the mean of the faces around."""
    points, faces = mesh.positions, mesh.faces
    corners = points[faces]
    normals, areas = face_normals(points, faces), face_areas(points, faces)
    # Each corner's height falls off across the opposite side.
    against = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
    across = np.cross(normals[:, None, :], against)
    doubled = np.einsum("mk,mkd->md", height[faces], across)
    total = np.zeros_like(points)
    for corner in range(3):
        np.add.at(total, faces[:, corner], 0.5 * doubled)
    weight = np.zeros(len(points))
    for corner in range(3):
        weight += np.bincount(faces[:, corner], areas, len(points))
    return total / np.maximum(weight, 1e-12)[:, None]
