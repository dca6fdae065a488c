"""Pieces of skin with a known shape, and heads whose muscles many tests look at."""

from __future__ import annotations

from functools import cache

import numpy as np

from risorius._check import FloatArray
from risorius.mesh.core import TriMesh
from risorius.mesh.laplacian import averaging
from risorius.mesh.normals import vertex_normals
from risorius.springmuscle.bones import builtin_bones
from risorius.springmuscle.fit import Ground, fit_muscles
from risorius.springmuscle.fit_parameters import FitParameters
from risorius.springmuscle.grid import Layer, Layout, find_patch
from risorius.springmuscle.measure import REFERENCE_WIDTH, FaceMeasure
from risorius.springmuscle.muscle_set import MuscleSet
from risorius.springmuscle.recipe import MuscleOutline, OutlinePoint
from risorius.springmuscle.recipe_file import default_recipe
from risorius.springmuscle.refine import Refined, refine
from risorius.springmuscle.surface import SkinSurface
from tests.springmuscle.faces import builtin_mechanics

_HALF = 0.5 * REFERENCE_WIDTH
MARKS = {
    "3.7": np.array([_HALF, 0.0, -30.0]),
    "3.12": np.array([-_HALF, 0.0, -30.0]),
    "2.2": np.array([0.0, -70.0, 0.0]),
    "2.3": np.array([0.0, -70.0, 0.0]),
    "2.1": np.array([0.0, -110.0, 0.0]),
    "4.1": np.array([10.0, 17.0, 0.0]),
}


def surface_of(height, *, count: int = 33, size: float = 40.0) -> SkinSurface:
    """Return the skin z = `height`(x, y) over a square of half width `size` [mm]."""
    side = np.linspace(-size, size, count)
    x, y = np.meshgrid(side, side, indexing="ij")
    positions = np.stack([x, y, height(x, y)], axis=2).reshape(-1, 3)
    number = np.arange(count * count).reshape(count, count)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    faces = np.concatenate(
        [np.stack([a, b, c], axis=2).reshape(-1, 3), np.stack([a, c, d], axis=2).reshape(-1, 3)]
    ).astype(np.int32)
    normals = vertex_normals(positions, faces)
    average, broad = averaging(faces, len(positions)), normals
    for _ in range(8):
        broad = average @ broad
    broad = broad / np.linalg.norm(broad, axis=1, keepdims=True)
    none = np.zeros(len(positions), np.int8)
    measure = FaceMeasure(MARKS, REFERENCE_WIDTH, 70.0)
    mesh = TriMesh(positions, faces)
    return SkinSurface(mesh, measure, none, none, none.astype(bool), normals, broad)


def square_outline(name: str = "square", **settings) -> MuscleOutline:
    """Return an outline of two rows; where it lies is told by `fit_to`."""
    row = (OutlinePoint(("2.2",)), OutlinePoint(("2.3",)))
    return MuscleOutline(name, "sheet", (row, row), mirror=False, **settings)


def fit_to(
    surface: SkinSurface,
    parameters: FitParameters,
    *,
    half: float = 20.0,
    outline: MuscleOutline | None = None,
) -> Refined:
    """Fit a square grid of half width `half` in the middle of `surface`."""
    corners = np.array([[[-half, half], [half, half]], [[-half, -half], [half, -half]]])
    points = np.concatenate([corners, np.full((2, 2, 1), 1.5 * half)], axis=2)
    hits = surface.scene.cast(points.reshape(-1, 3), [0.0, 0.0, -1.0])
    layout = Layout(hits.positions.reshape(2, 2, 3), False, np.ones((2, 2), bool))
    layer = Layer(outline or square_outline(), surface, parameters)
    return refine(layout, layer, find_patch(layout, surface, parameters), mirror=False)


def sphere(radius: float):
    """Return the height of a cap of a sphere whose top is at 0 [mm]."""
    return lambda x, y: np.sqrt(radius**2 - x**2 - y**2) - radius


def depths(surface: SkinSurface, points: FloatArray, normals: FloatArray) -> FloatArray:
    """Return the signed distances (q,) of points to the skin along their normals."""
    hits = surface.scene.cast(points, normals, both_directions=True)
    return hits.distance


@cache
def builtin_ground(profile: str = "improved") -> Ground:
    """Return the built-in head, measured for muscles."""
    parameters = FitParameters.of_profile(profile)
    return Ground.build(builtin_mechanics(), builtin_bones(builtin_mechanics()), parameters)


@cache
def builtin_muscles(profile: str = "improved") -> MuscleSet:
    """Return the default muscles of the built-in head."""
    return fit_muscles(default_recipe(), builtin_ground(profile))
