"""Meshes with known geometry for tests."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from risorius._check import FloatArray, IntArray
from risorius.mesh.core import TriMesh


def sphere(levels: int = 3, radius: float = 1.0) -> TriMesh:
    """Return an icosphere, faces outwards."""
    golden = (1.0 + 5.0**0.5) / 2.0
    corners = [(-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0)]
    points = np.array(
        corners + [(z, x, y) for x, y, z in corners] + [(y, z, x) for x, y, z in corners], float
    )
    points /= np.linalg.norm(points[0])
    near = np.linalg.norm(points[:, None] - points, axis=2)
    edge = near[near > 1e-9].min() * 1.01
    faces = [
        (i, j, k)
        for i in range(12)
        for j in range(i + 1, 12)
        for k in range(j + 1, 12)
        if max(near[i, j], near[j, k], near[i, k]) < edge
    ]
    faces = [(i, j, k) if np.linalg.det(points[[i, j, k]]) > 0 else (i, k, j) for i, j, k in faces]
    mesh = TriMesh(points, np.array(faces))
    for _ in range(levels):
        mesh = _subdivided(mesh)
        lengths = np.linalg.norm(mesh.positions, axis=1, keepdims=True)
        mesh = mesh.at(mesh.positions / lengths)
    return mesh.at(radius * mesh.positions)


def _subdivided(mesh: TriMesh) -> TriMesh:
    sides = np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    pairs, middle = np.unique(sides, axis=0, return_inverse=True)
    middle = middle.reshape(-1, 3) + mesh.vertex_count
    points = np.concatenate([mesh.positions, mesh.positions[pairs].mean(axis=1)])
    a, b, c = mesh.faces.T
    ab, bc, ca = middle.T
    faces = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return TriMesh(points, np.concatenate([np.stack(face, axis=1) for face in faces]))


def grid(columns: int = 10, rows: int = 10, width: float = 1.0, height: float = 1.0) -> TriMesh:
    """Return a flat sheet in the plane z = 0 that looks towards +z."""
    x, y = np.meshgrid(np.linspace(0.0, width, columns + 1), np.linspace(0.0, height, rows + 1))
    points = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    start = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    a, b, c, d = start, start + 1, start + columns + 2, start + columns + 1
    return TriMesh(
        points, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    )


def torus(around: int = 24, across: int = 12, radius: float = 3.0, tube: float = 1.0) -> TriMesh:
    """Return a torus about the z axis, faces outwards."""
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * u.ravel() / around, 2 * np.pi * v.ravel() / across
    ring = radius + tube * np.cos(b)
    points = np.stack([ring * np.cos(a), ring * np.sin(a), tube * np.sin(b)], axis=1)

    def at(i: IntArray, j: IntArray) -> IntArray:
        return ((i % around) * across + j % across).ravel()

    p, q, r, s = at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)
    faces = np.concatenate([np.stack([p, q, r], axis=1), np.stack([p, r, s], axis=1)])
    return TriMesh(points, faces)


def cube() -> TriMesh:
    """Return the unit cube, faces outwards."""
    points = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return TriMesh(points, np.array([f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))]))


def joined(*meshes: TriMesh) -> TriMesh:
    """Return several meshes as one."""
    starts = np.cumsum([0, *(mesh.vertex_count for mesh in meshes)])
    return TriMesh(
        np.concatenate([mesh.positions for mesh in meshes]),
        np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts)]),
    )


def without_faces(mesh: TriMesh, faces: object) -> TriMesh:
    """Return the mesh with some faces cut out."""
    return TriMesh(mesh.positions, np.delete(mesh.faces, np.asarray(faces), axis=0))


def star_of(mesh: TriMesh, vertex: int) -> IntArray:
    """Return the faces around a vertex."""
    return np.flatnonzero((mesh.faces == vertex).any(axis=1)).astype(np.int32)


def rotation(generator: np.random.Generator) -> FloatArray:
    """Return a random rotation."""
    q, r = np.linalg.qr(generator.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


def triangle_soups(vertices: int = 8, faces: int = 14) -> st.SearchStrategy[TriMesh]:
    """Draw meshes without any manners: repeated corners, non-manifold edges, loose points."""
    count = st.integers(3, vertices)

    def build(n: int) -> st.SearchStrategy[TriMesh]:
        table = arrays(
            np.int32, st.tuples(st.integers(0, faces), st.just(3)), elements=st.integers(0, n - 1)
        )
        points = np.random.default_rng(n).normal(size=(n, 3))
        return table.map(lambda rows: TriMesh(points, rows))

    return count.flatmap(build)
