"""Find the parts of a head: by hand, by name, by geometry."""

from __future__ import annotations

import warnings
from collections.abc import Mapping

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from risorius._check import FloatArray, IntArray
from risorius.errors import MeshError, ParameterError, RisoriusWarning
from risorius.head.part import PART_KINDS
from risorius.head.part_geometry import kind_of_component, side_of_component, upper_or_lower
from risorius.head.part_names import kind_of_name
from risorius.landmarks.feature_points import feature_points
from risorius.landmarks.landmark_set import LandmarkSet
from risorius.mesh.polygon_mesh import Labels, PolygonMesh
from risorius.mesh.welding import weld

__all__ = ["assign_parts"]


def assign_parts(
    mesh: PolygonMesh,
    positions: FloatArray,
    landmarks: LandmarkSet,
    *,
    given: Mapping[str, str] | None = None,
) -> IntArray:
    """Return the part kind (m,) of every polygon as an index into `PART_KINDS`.

    Parameters
    ----------
    mesh : PolygonMesh
    positions : (n, 3) float64
        Its vertices in the canonical frame [mm].
    landmarks : LandmarkSet
        In the canonical frame.
    given : mapping of str to str, optional
        Part kind -> object, group or material name, decided by a person.

    Raises
    ------
    ParameterError
        If `given` names a kind or an object that does not exist.
    MeshError
        If no part can be the skin.
    """
    named = _by_name(mesh, given or {})
    component = _components(mesh, positions)
    kinds = np.full(mesh.polygon_count, -1, np.int32)
    start = mesh.offsets[:-1]
    has_corners = np.diff(mesh.offsets) > 0
    vertex = mesh.corners[np.minimum(start, max(len(mesh.corners) - 1, 0))]
    polygon_component = np.where(has_corners, component[vertex], -1)
    skin_component = _skin_component(component, landmarks)
    groups: dict[tuple[str, int], list[int]] = {}
    for polygon, number in enumerate(polygon_component.tolist()):
        groups.setdefault((named[polygon], number), []).append(polygon)
    for (name, number), polygons in groups.items():
        points = positions[np.unique(_corners_of(mesh, polygons))]
        kind = _settle(name, points, landmarks, is_skin=number == skin_component)
        kinds[polygons] = PART_KINDS.index(kind)
    if not (kinds == PART_KINDS.index("skin")).any():
        raise MeshError(
            "head: no part carries the landmarks of the skin; name it by hand with "
            "--part skin=NAME (object, group or material)"
        )
    return kinds


def _corners_of(mesh: PolygonMesh, polygons: list[int]) -> IntArray:
    chosen = np.asarray(polygons)
    sizes = np.diff(mesh.offsets)[chosen]
    first = np.cumsum(sizes) - sizes
    inside = np.arange(int(sizes.sum())) - np.repeat(first, sizes)
    return mesh.corners[np.repeat(mesh.offsets[:-1][chosen], sizes) + inside]


def _settle(name: str, points: FloatArray, landmarks: LandmarkSet, *, is_skin: bool) -> str:
    if name in PART_KINDS and name != "skin":
        return name
    if is_skin:
        return "skin"
    if name in ("eye", "lashes"):
        return f"{name}_{side_of_component(points, landmarks)}"
    if name == "teeth":
        return f"teeth_{upper_or_lower(points, landmarks)}"
    # A loose piece named skin (an eye inside "head") is judged by its shape like a nameless one.
    return kind_of_component(points, landmarks)


def _by_name(mesh: PolygonMesh, given: Mapping[str, str]) -> list[str]:
    result = [""] * mesh.polygon_count
    for labels in (mesh.materials, mesh.groups, mesh.objects):
        if not len(labels.of_polygon):
            continue
        kinds = [kind_of_name(name) or "" for name in labels.names]
        for polygon, label in enumerate(labels.of_polygon.tolist()):
            if label >= 0 and kinds[label]:
                result[polygon] = kinds[label]
    for kind, name in given.items():
        if kind not in PART_KINDS:
            raise ParameterError(f"part: {kind!r} is not one of {', '.join(PART_KINDS)}")
        polygons = _polygons_named(mesh, name)
        if not len(polygons):
            known = sorted({*mesh.objects.names, *mesh.groups.names, *mesh.materials.names})
            raise ParameterError(
                f"part: nothing in the file is named {name!r}; "
                f"it has {', '.join(known) or 'no names'}"
            )
        for polygon in polygons.tolist():
            result[polygon] = kind
    return result


def _polygons_named(mesh: PolygonMesh, name: str) -> IntArray:
    labels: Labels
    for labels in (mesh.objects, mesh.groups, mesh.materials):
        polygons = labels.polygons(name)
        if len(polygons):
            return polygons
    return np.zeros(0, np.int32)


def _components(mesh: PolygonMesh, positions: FloatArray) -> IntArray:
    """Label (n,) the connected pieces; vertices split at seams count as one."""
    joined = weld(positions, tolerance=1e-6)
    triangles = joined.representative[mesh.triangles]
    count = int(joined.representative.max()) + 1 if len(positions) else 0
    rows = triangles[:, [0, 1]].ravel()
    columns = triangles[:, [1, 2]].ravel()
    graph = coo_matrix((np.ones(len(rows), np.int8), (rows, columns)), shape=(count, count))
    labels = connected_components(graph, directed=False)[1]
    return labels[joined.representative].astype(np.int32)


def _skin_component(component: IntArray, landmarks: LandmarkSet) -> int:
    table = feature_points()
    votes = [
        int(component[landmarks.vertex(name)])
        for name in landmarks
        if name not in table or table[name].part == "skin"
    ]
    numbers, counts = np.unique(votes, return_counts=True)
    winner = int(numbers[np.argmax(counts)])
    if counts.max() < 0.6 * len(votes):
        warnings.warn(
            "head: the skin landmarks lie on several loose pieces; the one with the most is taken "
            "as skin, name it with --part skin=NAME if that is wrong",
            RisoriusWarning,
            stacklevel=3,
        )
    return winner
