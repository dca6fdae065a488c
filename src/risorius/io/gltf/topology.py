"""The input's own vertices and polygons inside our GLB files, and the way back to them.

A GLB holds triangles whose vertices are split at seams and material borders. Beside them our
files keep, per input polygon, its corners as vertices of the GLB, and per vertex of the GLB the
input vertex (an attribute), so that order, polygons and names return.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray
from risorius.errors import FormatError
from risorius.io.gltf.document import Document, optional_index
from risorius.io.gltf.soup import Soup
from risorius.io.json_fields import Fields, finite_number, whole_number
from risorius.io.rig_json import labels_from_json, labels_to_json, runs_from_json, runs_to_json
from risorius.mesh.polygon_mesh import Labels, PolygonMesh
from risorius.rig.rig import Rig

__all__ = ["Restored", "restore", "topology_to_json"]

LongArray = npt.NDArray[np.int64]

CORNERS, SIZES = "risorius.corners", "risorius.sizes"
"""Names of the two buffer views; a program that rewrites the file drops or renames them."""


@dataclass(frozen=True, eq=False)
class Restored:
    """The input as far as a GLB of our own gives it back.

    Parameters
    ----------
    mesh : PolygonMesh
    vertex : (g,) int64
        Input vertex of each vertex in the GLB.
    part_of_vertex : (n,) int32
    has_polygons : bool
        Whether the polygons are the input's; else they are triangles.
    """

    mesh: PolygonMesh
    vertex: LongArray
    part_of_vertex: IntArray
    has_polygons: bool


def topology_to_json(rig: Rig, *, corners_view: int, sizes_view: int) -> dict[str, Any]:
    """Return what `restore` reads, with the views that hold the polygons."""
    mesh = rig.mesh
    used = np.zeros(mesh.vertex_count, bool)
    used[mesh.corners] = True
    loose = np.flatnonzero(~used)
    return {
        "vertex_count": mesh.vertex_count,
        "corners": corners_view,
        "sizes": sizes_view,
        "loose": loose.tolist(),
        "loose_positions": mesh.positions[loose].ravel().tolist(),
        "objects": labels_to_json(mesh.objects),
        "groups": labels_to_json(mesh.groups),
        "materials": labels_to_json(mesh.materials),
        "part_of_vertex": runs_to_json(rig.part_of_vertex),
    }


def restore(document: Document, fields: Fields, soup: Soup, *, part_count: int) -> Restored:
    """Return the input that `soup` was split from.

    Raises
    ------
    FormatError
        If the file contradicts itself.
    """
    assert soup.source is not None
    vertex = soup.source
    count = fields.integer("vertex_count", low=1)
    positions = _positions(fields, soup, vertex, count)
    part_of_vertex = runs_from_json(fields, "part_of_vertex", count=count, high=part_count - 1)
    corners = _numbers(document, fields, "corners", CORNERS)
    sizes = _numbers(document, fields, "sizes", SIZES)
    if corners is None or sizes is None:
        plain = soup.mesh()
        mesh = PolygonMesh(
            positions,
            vertex[plain.corners].astype(np.int32),
            plain.offsets,
            uvs=plain.uvs,
            uv_corners=plain.uv_corners,
            objects=plain.objects,
            materials=plain.materials,
        )
        return Restored(mesh, vertex, part_of_vertex, False)
    if int(sizes.sum()) != len(corners) or corners.max(initial=0) >= len(vertex):
        raise FormatError(f"{fields.where}: polygons and vertices contradict each other")
    mesh = PolygonMesh(
        positions,
        vertex[corners].astype(np.int32),
        np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32),
        uvs=soup.uvs if soup.has_uv.any() else np.zeros((0, 2)),
        uv_corners=soup.uv_corners(corners),
        objects=_labels(fields, "objects", len(sizes)),
        groups=_labels(fields, "groups", len(sizes)),
        materials=_labels(fields, "materials", len(sizes)),
    )
    return Restored(mesh, vertex, part_of_vertex, True)


def _positions(fields: Fields, soup: Soup, vertex: LongArray, count: int) -> FloatArray:
    loose = [whole_number(v, fields.place("loose")) for v in fields.items("loose")]
    where = fields.place("loose_positions")
    values = [finite_number(x, where) for x in fields.items("loose_positions")]
    # Counted before anything of that size is allocated.
    if len(values) != 3 * len(loose) or count > len(vertex) + len(loose):
        raise FormatError(f"{fields.where}: {count} vertices are more than the file holds")
    known = np.zeros(count, bool)
    for index in (vertex, np.array(loose, np.int64)):
        if index.max(initial=0) >= count:
            raise FormatError(f"{fields.where}: a vertex of the input is beyond {count}")
        known[index] = True
    if not known.all():
        raise FormatError(f"{fields.where}: input vertex {int(np.argmin(known))} is missing")
    positions = np.zeros((count, 3))
    positions[vertex] = soup.positions
    positions[loose] = np.array(values).reshape(-1, 3)
    return positions


def _labels(fields: Fields, key: str, count: int) -> Labels:
    return labels_from_json(fields.fields(key), count)


def _numbers(document: Document, fields: Fields, key: str, name: str) -> LongArray | None:
    """Return the uint32 numbers in a view, or None where another program took it away."""
    index = optional_index(fields, key)
    if index is None or index not in document.elements("bufferViews"):
        return None
    where = fields.place(key)
    if document.element("bufferViews", index, where).text("name", default="") != name:
        return None
    data, _ = document.view(index, where)
    if len(data) % 4:
        raise FormatError(f"{where}: {len(data)} bytes are no list of numbers")
    document.spend(len(data) // 4, where)
    return np.frombuffer(data, "<u4").astype(np.int64)
