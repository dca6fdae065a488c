"""Write polygon meshes as OBJ text that reads back the same."""

from __future__ import annotations

from itertools import chain, pairwise

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.mesh.polygon_mesh import Labels, PolygonMesh

__all__ = ["ObjText"]

_HEADER = "# written by risorius\n"


class ObjText:
    """The OBJ text of a mesh and of shapes of it.

    Everything but the moved vertices is formatted once. Numbers are written so that they read
    back bit by bit; statements without a name (``g``) end a label.

    Parameters
    ----------
    mesh : PolygonMesh
    """

    def __init__(self, mesh: PolygonMesh) -> None:
        self._vertices = _lines("v", mesh.positions)
        self._rest = "".join(chain(_lines("vt", mesh.uvs), _polygons(mesh)))

    def neutral(self) -> bytes:
        """Return the file of the mesh itself."""
        return self._file(self._vertices)

    def shape(self, vertices: IntArray, positions: FloatArray) -> bytes:
        """Return the file with `vertices` (k,) at `positions` (k, 3)."""
        lines = self._vertices.copy()
        for vertex, line in zip(vertices.tolist(), _lines("v", positions)):
            lines[vertex] = line
        return self._file(lines)

    def _file(self, vertices: list[str]) -> bytes:
        return "".join([_HEADER, *vertices, self._rest]).encode()


def _lines(keyword: str, rows: FloatArray) -> list[str]:
    """Return one line per row; `repr` of a float reads back the same."""
    return [f"{keyword} {' '.join(map(repr, row))}\n" for row in rows.tolist()]


def _polygons(mesh: PolygonMesh) -> list[str]:
    """Return the lines of all polygons and of the names that change before them."""
    tokens = _corners(mesh)
    offsets = mesh.offsets.tolist()
    lines = [f"f {' '.join(tokens[a:b])}\n" for a, b in pairwise(offsets)]
    for keyword, labels in (
        ("usemtl", mesh.materials),
        ("g", mesh.groups),
        ("o", mesh.objects),
    ):
        for polygon, name in _changes(labels):
            lines[polygon] = f"{keyword} {name}".rstrip() + "\n" + lines[polygon]
    return lines


def _corners(mesh: PolygonMesh) -> list[str]:
    vertices = (mesh.corners + 1).tolist()
    if not len(mesh.uv_corners):
        return list(map(str, vertices))
    pairs = zip(vertices, (mesh.uv_corners + 1).tolist())
    return [f"{vertex}/{uv}" if uv else str(vertex) for vertex, uv in pairs]


def _changes(labels: Labels) -> list[tuple[int, str]]:
    """Return the polygons before which a label changes, and what it changes to."""
    if not len(labels.of_polygon):
        return []
    before = np.concatenate([[-1], labels.of_polygon[:-1]])
    places = np.flatnonzero(labels.of_polygon != before)
    # Neither a line end nor a continued line may stand in a name.
    names = [*(" ".join(name.split()).rstrip("\\ ") for name in labels.names), ""]
    return [(int(place), names[labels.of_polygon[place]]) for place in places]
