"""Small models with known behaviour for tests of solvers."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from risorius._check import FloatArray, IntArray
from risorius.mesh.core import TriMesh
from risorius.solvers.constraints import Constraints, Holds
from risorius.solvers.model import Model
from risorius.solvers.surface import SurfaceStiffness, surface_constraints
from tests.mesh.shapes import sphere, star_of, torus, without_faces

TETRAHEDRON = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)], np.int32)
SOFT = SurfaceStiffness(stretch=0.15, bend=0.3, area=0.4, volume=0.7)


def dodecahedron() -> TriMesh:
    """Return a regular dodecahedron, each face a fan of five triangles around its middle."""
    g = (1.0 + 5.0**0.5) / 2.0
    points = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    for a in (-1 / g, 1 / g):
        points += [(0, a, b) for b in (-g, g)]
        points += [(a, b, 0) for b in (-g, g)]
        points += [(b, 0, a) for b in (-g, g)]
    corners = np.array(points, float)
    middles = [(0, b, a) for a in (-1, 1) for b in (-g, g)]
    middles += [(b, a, 0) for a in (-1, 1) for b in (-g, g)]
    middles += [(a, 0, b) for a in (-1, 1) for b in (-g, g)]
    faces, tops = [], []
    for direction in np.array(middles, float):
        height = corners @ direction
        ring = np.flatnonzero(height > height.max() - 1e-9)
        centre = corners[ring].mean(axis=0)
        first = corners[ring[0]] - centre
        second = np.cross(direction, first)
        second *= np.linalg.norm(first) / np.linalg.norm(second)
        offset = corners[ring] - centre
        ring = ring[np.argsort(np.arctan2(offset @ second, offset @ first))]
        top = len(corners) + len(tops)
        tops.append(centre)
        faces += [(ring[i], ring[(i + 1) % len(ring)], top) for i in range(len(ring))]
    return TriMesh(np.concatenate([corners, np.array(tops)]), np.array(faces))


def skin(mesh: TriMesh, *, held: int = 3, stiffness: SurfaceStiffness = SOFT) -> Model:
    """Return a model of `mesh` in which every `held`-th vertex is drawn to a target."""
    found = surface_constraints(mesh, stiffness)
    holds = Holds(np.arange(0, mesh.vertex_count, held), 0.2)
    return Model(
        mesh.positions,
        Constraints(found.distances, found.areas, found.bends, found.volumes, holds),
        inv_mass=np.linspace(0.5, 2.0, mesh.vertex_count),
    )


def meshes() -> st.SearchStrategy[TriMesh]:
    """Draw closed and open surfaces, bumpy and of any scale."""

    def build(kind: str, seed: int, scale: float) -> TriMesh:
        generator = np.random.default_rng(seed)
        mesh = {
            "sphere": lambda: sphere(2),
            "torus": lambda: torus(12, 8),
            "open": lambda: without_faces(sphere(2), star_of(sphere(2), seed % 162)),
            "two holes": lambda: without_faces(
                sphere(2), np.union1d(star_of(sphere(2), 0), star_of(sphere(2), 3))
            ),
        }[kind]()
        bumps = 0.03 * generator.normal(size=mesh.positions.shape)
        return mesh.at(scale * (mesh.positions * (1.0, 1.3, 0.9) + bumps))

    kinds = st.sampled_from(("sphere", "torus", "open", "two holes"))
    return st.builds(build, kinds, st.integers(0, 10**6), st.sampled_from((1e-3, 1.0, 100.0)))


def pulled(model: Model, seed: int, share: float = 0.05) -> tuple[FloatArray, FloatArray]:
    """Return shaken positions (n, 3) and shaken targets (k, 3) of `model`."""
    generator = np.random.default_rng(seed)
    held = model.rest_positions[model.constraints.holds.particles]
    size = share * model.size
    shaken = model.rest_positions + 0.1 * size * generator.normal(size=model.rest_positions.shape)
    return shaken, held + size * generator.uniform(-1.0, 1.0, held.shape)


def momenta(
    positions: FloatArray, before: FloatArray, mass: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the linear and the angular momentum of a move."""
    moved = mass[:, None] * (positions - before)
    return moved.sum(axis=0), np.cross(before, moved).sum(axis=0)


def pairs_of(*rows: tuple[int, ...]) -> IntArray:
    """Return a table of particles."""
    return np.array(rows, np.int32)
