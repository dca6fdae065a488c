"""A made-up head: a flat skin with a mouth slit, and a ball and a box that it may sink into."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from risorius.head import Frame, Head, Part
from risorius.landmarks import Landmark, LandmarkSet
from risorius.mesh.core import TriMesh
from risorius.mesh.lips import LipSides
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.mesh.slit import Slit
from risorius.rig import MorphTarget, Rig

COLUMNS = 41
WIDTH = 40.0


def grid(columns: int = 7, rows: int = 6, *, step: float = 1.0) -> TriMesh:
    """Return a flat sheet of columns x rows vertices that faces +z."""
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    positions = step * np.stack([x.ravel(), y.ravel(), 0.0 * x.ravel()], axis=1)
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    right, up = first + 1, first + columns
    faces = np.concatenate(
        [np.stack([first, right, up + 1], axis=1), np.stack([first, up + 1, up], axis=1)]
    )
    return TriMesh(positions, faces.astype(np.int32))


def ball(centre: tuple[float, float, float], radius: float, *, rings: int = 24) -> TriMesh:
    """Return a closed sphere whose faces look outwards."""
    pitch = np.linspace(-0.5 * np.pi, 0.5 * np.pi, rings + 1)[1:-1]
    yaw = np.linspace(0.0, 2.0 * np.pi, 2 * rings, endpoint=False)
    p, y = np.meshgrid(pitch, yaw, indexing="ij")
    shell = np.stack([np.cos(p) * np.sin(y), np.sin(p), np.cos(p) * np.cos(y)], axis=2)
    points = np.concatenate([shell.reshape(-1, 3), [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]]])
    count, n = 2 * rings, len(pitch)
    here = np.arange(count)
    beside = (here + 1) % count
    south, north = n * count, n * count + 1
    faces = [np.stack([here, np.full(count, south), beside], axis=1)]
    for row in range(n - 1):
        low, high = row * count, (row + 1) * count
        faces.append(np.stack([low + here, low + beside, high + beside], axis=1))
        faces.append(np.stack([low + here, high + beside, high + here], axis=1))
    top = (n - 1) * count
    faces.append(np.stack([top + here, top + beside, np.full(count, north)], axis=1))
    return TriMesh(radius * points + np.asarray(centre), np.concatenate(faces).astype(np.int32))


def head_of(parts: Mapping[str, TriMesh], marks: Mapping[str, int] | None = None) -> Head:
    """Return a head in the canonical frame whose parts follow one another in the file.

    `marks` are landmarks at vertices of the first part.
    """
    starts = np.cumsum([0, *(mesh.vertex_count for mesh in parts.values())])
    positions = np.concatenate([mesh.positions for mesh in parts.values()])
    faces = np.concatenate([m.faces + start for m, start in zip(parts.values(), starts)])
    source = PolygonMesh.from_polygons(positions, faces.tolist())
    bound = {
        kind: Part(
            kind,
            mesh,
            np.arange(start, start + mesh.vertex_count, dtype=np.int32),
            np.arange(mesh.vertex_count, dtype=np.int32),
        )
        for (kind, mesh), start in zip(parts.items(), starts)
    }
    landmarks = [Landmark(name, (vertex,), (1.0,)) for name, vertex in (marks or {}).items()]
    return Head(source, Frame.canonical(), bound, LandmarkSet(landmarks, positions))


def rig_of(head: Head, shapes: Mapping[str, np.ndarray]) -> Rig:
    """Return a rig of dense displacements (n, 3)."""
    targets = tuple(MorphTarget.from_dense(name, deltas) for name, deltas in shapes.items())
    return Rig(head.source, targets)


def mouth() -> tuple[Head, LipSides, np.ndarray, np.ndarray]:
    """Return a head with two lip lines, its lips, and the place 0..1 along each line.

    The lines share their ends; the last vertex of the skin is the chin. Faces do not matter.
    """
    place = np.linspace(0.0, 1.0, COLUMNS)
    upper = np.stack([WIDTH * (0.5 - place), 0.0 * place, 0.0 * place], axis=1)
    lower = upper[1:-1] - [0.0, 0.05, 0.0]
    positions = np.concatenate([upper, lower, [[0.0, -40.0, 0.0]]])
    chin = len(positions) - 1
    skin = TriMesh(positions, np.array([[0, 1, chin]], np.int32))
    upper_line = np.arange(COLUMNS, dtype=np.int32)
    lower_line = np.concatenate([[0], np.arange(COLUMNS, chin), [COLUMNS - 1]]).astype(np.int32)
    away = np.full(len(positions), 10.0)
    slit = Slit(upper_line, lower_line, np.zeros(len(positions), bool), 1.0)
    corner = np.abs(np.abs(positions[:, 0]) - 0.5 * WIDTH)
    lips = LipSides(slit, away, away, WIDTH, corner)
    return head_of({"skin": skin}, {"2.1": chin}), lips, place, place
