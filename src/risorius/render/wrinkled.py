"""Pictures of wrinkled skin, as an engine with the normal maps shows it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.mesh.normals import vertex_normals
from risorius.render.heads import Portrait, part_look
from risorius.render.materials import look_of_material
from risorius.render.picture import render
from risorius.render.sheet import contact_sheet
from risorius.render.surface import Surface
from risorius.wrinkles import Relief, Wrinkler, WrinkleSet
from risorius.wrinkles.chart import source_triangles
from risorius.wrinkles.relief import slope_of

__all__ = ["wrinkle_sheet", "wrinkled_skin"]

Picture = npt.NDArray[np.uint8]
Progress = Callable[[int, int, str], None]

# The wrinkled patch is drawn above the smooth skin, so that it hides it [mm].
_ABOVE = 0.02


def wrinkled_skin(wrinkler: Wrinkler, relief: Relief, weights: Mapping[str, float]) -> Surface:
    """Return the wrinkled patch of a posed skin; draw it with the rest of the head.

    Parameters
    ----------
    wrinkler : Wrinkler
    relief : Relief
        One of its reliefs.
    weights : mapping of str to float
        Of the shapes in the picture.
    """
    mesh = wrinkler.skin.mesh
    posed = mesh.positions + wrinkler.displacement(weights)
    patch = relief.patch
    normals = patch.carry(vertex_normals(posed, mesh.faces))
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    placed = patch.carry(posed)
    slope = slope_of(replace(patch.mesh, positions=placed), relief.height)
    raised = placed + (relief.height + relief.reach + _ABOVE)[:, None] * normals
    look = look_of_material("skin")
    look["colour"] = _colours(wrinkler)[patch.coarse_face]
    return Surface(raised, patch.mesh.faces, normals=normals - slope, **look)


def _colours(wrinkler: Wrinkler) -> FloatArray:
    """Return the colour of each face (m, 3) of the skin by its material."""
    mesh = wrinkler.rig.mesh
    # The last row is for what has no material.
    names = (*mesh.materials.names, "")
    table = np.array([part_look("skin", name)["colour"] for name in names])
    if not len(mesh.materials.of_polygon):
        return np.tile(table[-1], (wrinkler.skin.mesh.face_count, 1))
    source = source_triangles(wrinkler.rig, wrinkler.skin)
    material = mesh.materials.of_polygon[mesh.triangle_polygon[source]]
    return table[np.where(source >= 0, material, -1)]


def wrinkle_sheet(
    wrinkles: WrinkleSet, *, cell: int = 420, progress: Progress | None = None
) -> Picture:
    """Return a page with the face in every group of shapes at weight 1, wrinkled.

    Parameters
    ----------
    wrinkles : WrinkleSet
    cell : int
        Width of a picture [pixels].
    progress : callable, optional
        Called with (done, all, name) before each picture.

    Returns
    -------
    (h, w, 3) uint8
    """
    wrinkler = wrinkles.wrinkler
    portrait = Portrait.of(wrinkler.rig)
    camera = portrait.camera("face")
    pictures: list[Picture] = []
    for done, made in enumerate(wrinkles.maps):
        if progress is not None:
            progress(done, len(wrinkles.maps), made.group.name)
        weights = dict.fromkeys(made.group.shapes, 1.0)
        surfaces = portrait.surfaces(portrait.posed(weights))
        surfaces.append(wrinkled_skin(wrinkler, made.relief, weights))
        pictures.append(render(surfaces, camera, size=(cell, cell), supersample=2))
    names = [made.group.name for made in wrinkles.maps]
    return contact_sheet(pictures, names, columns=min(4, max(len(pictures), 1)))
