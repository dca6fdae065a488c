"""Skull and jaw inside a head, three ways, and what of the skin lies on them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import mirror_partners
from risorius.anatomy.skull import Skull, builtin_skull
from risorius.anatomy.skull_fit import fit_skull, hidden_skin
from risorius.errors import ParameterError
from risorius.mesh.core import TriMesh
from risorius.spatial.raycast import Scene
from risorius.springmuscle.bone_cut import cut_head
from risorius.springmuscle.muscle import JAW, SKULL
from risorius.springmuscle.surface import SkinSurface

__all__ = ["Bones", "SkinBones", "builtin_bones", "cut_bones", "find_bones", "given_bones"]

BoneWay = Literal["given", "builtin", "cut"]

# Tissue over a skull cut from the head itself [mm at the reference width].
_TISSUE = 7.0


@dataclass(frozen=True, eq=False)
class SkinBones:
    """What each of n skin vertices lies on.

    Parameters
    ----------
    bones : (n,) int8
        `SKULL`, `JAW`, or 0 for skin without bone below it, such as lips and cheeks.
    feet : (n, 3) float64
        Where the ray inwards meets the bone; the vertex itself without one [mm].
    depths : (n,) float64
        Distance of the two [mm].
    """

    bones: npt.NDArray[np.int8]
    feet: FloatArray
    depths: FloatArray


@dataclass(frozen=True, eq=False)
class Bones:
    """Skull and jaw of one head, for all resolutions of it.

    Parameters
    ----------
    skull, jaw : TriMesh
        In the head's canonical frame [mm]; either may have no face.
    way : {"given", "builtin", "cut"}
        Where they come from.
    """

    skull: TriMesh
    jaw: TriMesh
    way: BoneWay

    def under(self, surface: SkinSurface, *, max_depth: float) -> SkinBones:
        """Find the bone below each vertex of a skin.

        A ray goes inwards along the normal of the surroundings; the nearest bone within
        `max_depth` counts. Upper lip on jaw and lower lip on skull are no attachment.

        Parameters
        ----------
        surface : SkinSurface
            Of this head at any resolution.
        max_depth : float
            Deepest that bone may lie [mm at the reference width].
        """
        positions = surface.mesh.positions
        bones = np.zeros(len(positions), np.int8)
        feet, depths = positions.copy(), np.zeros(len(positions))
        meshes = [mesh for mesh in (self.skull, self.jaw) if mesh.face_count]
        if not meshes:
            return SkinBones(bones, feet, depths)
        kinds = np.array([SKULL if mesh is self.skull else JAW for mesh in meshes], np.int8)
        asked = np.flatnonzero(~surface.hidden & (surface.broad_normals != 0.0).any(axis=1))
        hits = Scene(meshes).cast(
            positions[asked], -surface.broad_normals[asked], max_distance=max_depth * surface.scale
        )
        found, sides = np.where(hits.hit, kinds[hits.mesh], 0), surface.sides[asked]
        astray = ((found == JAW) & (sides > 0)) | ((found == SKULL) & (sides < 0))
        kept = (found > 0) & ~astray
        rows = asked[kept]
        bones[rows] = found[kept]
        feet[rows], depths[rows] = hits.positions[kept], hits.distance[kept]
        return SkinBones(bones, feet, depths)


def given_bones(mechanics: Mechanics, skull: Skull) -> Bones:
    """Fit a skull (`anatomy.load_skull`) to the head by landmarks and rays."""
    return _fitted(mechanics, skull, "given")


def builtin_bones(mechanics: Mechanics) -> Bones:
    """Fit the built-in skull to the head."""
    return _fitted(mechanics, builtin_skull(), "builtin")


def cut_bones(mechanics: Mechanics, *, tissue: float = _TISSUE) -> Bones:
    """Make skull and jaw from the head's own skin, for heads without a skull.

    The skin is cut into jaw and rest, opened where there is no bone, shrunk inwards by the tissue's
    thickness and simplified (Kaehler et al. 2001, section 3.1; the cut itself is ours).

    Parameters
    ----------
    mechanics : Mechanics
        Of the head; the hinge of its jaw is where the cut begins.
    tissue : float
        Thickness of the tissue [mm at the reference width].
    """
    skull, jaw = cut_head(SkinSurface.build(mechanics), mechanics.jaw.hinge, tissue)
    return Bones(skull, jaw, "cut")


def find_bones(mechanics: Mechanics, way: str, *, skull: Skull | None = None) -> Bones:
    """Return the bones of a head in one of the three ways.

    Raises
    ------
    ParameterError
        If `way` is none of them, or ``"given"`` comes without a skull.
    """
    if way == "cut":
        return cut_bones(mechanics)
    if way == "builtin":
        return builtin_bones(mechanics)
    if way != "given":
        raise ParameterError(f"bones: {way!r} is not one of builtin, cut, given")
    if skull is None:
        raise ParameterError("bones: 'given' needs a skull; name its files or use builtin or cut")
    return given_bones(mechanics, skull)


def _fitted(mechanics: Mechanics, skull: Skull, way: BoneWay) -> Bones:
    head = mechanics.head
    symmetric = mirror_partners(head.skin.mesh) is not None
    hidden = hidden_skin(mechanics.lips, mechanics.margins)
    fitted = fit_skull(skull, head, symmetric=symmetric, hidden=hidden)
    return Bones(fitted.cranium, fitted.mandible, way)
