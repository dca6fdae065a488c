"""Pairs of heads for which the true shapes of the target are known, all made from ICT-FaceKit.

The model is linear: a random identity keeps the expression displacements of the mean head.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import numpy.typing as npt
import pyfqmr
from scipy.spatial.transform import Rotation

from risorius.head import Head
from risorius.head.mouth import find_head_lips
from risorius.io.landmarks import read_landmarks
from risorius.landmarks import LandmarkSpec, feature_points
from risorius.mesh import TriMesh
from risorius.mesh.connectivity import edge_faces, edges
from risorius.mesh.normals import vertex_normals
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.rig import MorphTarget, Rig
from risorius.rig.bake import empty_rig
from risorius.spatial import closest_points
from tests.tools import real_data_folder

FloatArray = npt.NDArray[np.float64]

# Polygons of face, head and neck; behind them mouth bag and eye sockets, teeth, eyes, lashes.
_FACE_POLYGONS = 11144
MAKEHUMAN = ("caucasian_male_young", "african_female_young", "asian_male_old")


@dataclass(frozen=True, eq=False)
class Pair:
    """A source rig, a target head, and the true displacements of the target.

    Parameters
    ----------
    name : str
    source : Rig
    target : Head
    truth : (s, n, 3) float64 or None
        Of the target's vertices [target's file unit]; None where nobody knows it.
    """

    name: str
    source: Rig
    target: Head
    truth: FloatArray | None


@dataclass(frozen=True, eq=False)
class Model:
    """ICT-FaceKit, whole or the skin alone without what lies behind lips and lids."""

    mesh: PolygonMesh
    landmarks: Mapping[str, LandmarkSpec]
    names: tuple[str, ...]
    deltas: FloatArray
    identities: FloatArray

    def moved(self, positions: FloatArray) -> PolygonMesh:
        return replace(self.mesh, positions=positions)

    def identity(self, seed: int) -> FloatArray:
        weights = np.random.default_rng(seed).standard_normal(len(self.identities))
        return self.mesh.positions + np.einsum("i,ijk->jk", weights, self.identities)


@cache
def model(*, whole: bool = False) -> Model:
    """Return the model; `whole` with mouth bag, sockets, teeth and eyes."""
    folder = real_data_folder() / "ict_facekit"
    data = np.load(folder / "ict_facekit.npz")
    specs = read_landmarks(folder / "landmarks.json")
    names = tuple(str(name) for name in data["expression_names"])
    head = Head.load(folder / "ict_neutral.obj", folder / "landmarks.json")
    positions = data["vertices"].astype(np.float64)
    deltas, identities = data["expression_deltas"].astype(float), data["identity_deltas"]
    if whole:
        mesh = replace(head.source, positions=positions)
        return Model(mesh, specs, names, deltas, identities.astype(float))
    polygons = data["polygons"][:_FACE_POLYGONS]
    used = np.unique(polygons[polygons >= 0])
    place = np.full(len(positions), -1)
    place[used] = np.arange(len(used))
    lists = [[int(place[v]) for v in polygon if v >= 0] for polygon in polygons]
    table = feature_points()
    kept = {
        name: LandmarkSpec(vertex=int(place[spec.vertex]))
        for name, spec in specs.items()
        if table[name].part == "skin" and spec.vertex is not None and place[spec.vertex] >= 0
    }
    mesh = PolygonMesh.from_polygons(positions[used], lists)
    return Model(mesh, kept, names, deltas[:, used], identities[:, used].astype(float))


def rig_of(mesh: PolygonMesh, specs: Mapping[str, LandmarkSpec], shapes: Model) -> Rig:
    """Return the rig with the model's shapes on another neutral of the same vertices."""
    return rig_with(mesh, specs, shapes.names, shapes.deltas)


def rig_with(
    mesh: PolygonMesh, specs: Mapping[str, LandmarkSpec], names: tuple[str, ...], deltas: FloatArray
) -> Rig:
    """Return a rig of dense shapes."""
    head = Head.from_mesh(mesh, specs)
    return empty_rig(head).with_targets(
        MorphTarget.from_dense(name, moved) for name, moved in zip(names, deltas)
    )


def remeshed(
    positions: FloatArray, deltas: FloatArray, specs: Mapping[str, LandmarkSpec], count: int
) -> tuple[PolygonMesh, FloatArray, dict[str, LandmarkSpec]]:
    """Decimate to about `count` vertices; displacements by place on the dense surface."""
    dense = TriMesh(positions, model().mesh.triangles)
    tool = pyfqmr.Simplify()
    tool.setMesh(dense.positions, dense.faces)
    tool.simplify_mesh(
        target_count=2 * count, aggressiveness=5, preserve_border=count > 1000, verbose=False
    )
    points, faces, _ = tool.getMesh()
    return _carried(dense, deltas, specs, np.asarray(points, float), np.asarray(faces, np.int32))


def subdivided(
    positions: FloatArray, deltas: FloatArray, specs: Mapping[str, LandmarkSpec]
) -> tuple[PolygonMesh, FloatArray, dict[str, LandmarkSpec]]:
    """Split every edge in two: four times the triangles, indices permuted."""
    faces = model().mesh.triangles
    table = edge_faces(faces)
    pairs = edges(faces)
    middle = len(positions) + table.face_edges
    new = np.concatenate(
        [np.stack([faces[:, k], middle[:, k], middle[:, k - 1]], axis=1) for k in range(3)]
        + [middle]
    )
    points = np.concatenate([positions, positions[pairs].mean(axis=1)])
    moved = np.concatenate([deltas, deltas[:, pairs].mean(axis=2)], axis=1)
    order = np.random.default_rng(5).permutation(len(points))
    place = np.argsort(order)
    lists = place[new].tolist()
    kept = {name: LandmarkSpec(vertex=int(place[spec.vertex or 0])) for name, spec in specs.items()}
    return PolygonMesh.from_polygons(points[order], lists), moved[:, order], kept


def _carried(
    dense: TriMesh,
    deltas: FloatArray,
    specs: Mapping[str, LandmarkSpec],
    points: FloatArray,
    faces: npt.NDArray[np.int32],
) -> tuple[PolygonMesh, FloatArray, dict[str, LandmarkSpec]]:
    used = np.unique(faces)
    place = np.full(len(points), -1)
    place[used] = np.arange(len(used))
    points, faces = points[used], place[faces].astype(np.int32)
    normals = vertex_normals(points, faces)
    found = closest_points(dense, points, normals=normals, max_angle=80.0)
    corners = dense.faces[found.face]
    moved = np.einsum("kc,skcj->skj", found.bary, deltas[:, corners])
    lips = find_head_lips(Head.from_mesh(model().moved(dense.positions), specs))
    upper = lips.upper[corners].sum(axis=1) >= 2
    kept = {}
    for name, spec in specs.items():
        distance = np.linalg.norm(points - dense.positions[spec.vertex], axis=1)
        # A lip's landmark stays on its lip, however near the other one is.
        distance[upper != lips.upper[spec.vertex]] *= 1e3
        kept[name] = LandmarkSpec(vertex=int(distance.argmin()))
    return PolygonMesh.from_polygons(points, faces.tolist()), moved, kept


def noisy(
    mesh: PolygonMesh, specs: Mapping[str, LandmarkSpec], seed: int
) -> dict[str, LandmarkSpec]:
    """Move every landmark at random by about 1 % of the head's height, along the surface."""
    random = np.random.default_rng(seed)
    height = np.ptp(mesh.positions[:, 1])
    # Vertices that can be reached along the skin, so that a lip's landmark stays on its lip.
    from scipy.sparse.csgraph import dijkstra

    from risorius.mesh.slit import edge_graph

    graph = edge_graph(mesh.tri_mesh())
    result = {}
    for name, spec in specs.items():
        distance = dijkstra(graph, indices=spec.vertex, limit=0.012 * height)
        ring = np.flatnonzero((distance > 0.003 * height) & np.isfinite(distance))
        result[name] = LandmarkSpec(vertex=int(random.choice(ring)) if len(ring) else spec.vertex)
    return result


def _exact(name: str, seed: int | None, change: Callable[[FloatArray], FloatArray]) -> Pair:
    m = model()
    base = m.mesh.positions if seed is None else m.identity(seed)
    points = change(base)
    truth = change(base + m.deltas.reshape(-1, *base.shape)) - points
    target = Head.from_mesh(m.moved(points), m.landmarks)
    return Pair(name, rig_of(m.mesh, m.landmarks, m), target, truth)


def self_pair() -> Pair:
    return _exact("self", None, lambda points: points)


def similar() -> Pair:
    turn = Rotation.from_euler("yxz", [20.0, 8.0, -5.0], degrees=True).as_matrix()
    return _exact("similar", None, lambda points: 10.0 * points @ turn.T + [3.0, -40.0, 12.0])


def identity(seed: int) -> Pair:
    return _exact(f"identity_{seed}", seed, lambda points: points)


def identity_noisy(seed: int, noise: int) -> Pair:
    pair = identity(seed)
    m = model()
    mesh = pair.target.source
    target = Head.from_mesh(mesh, noisy(mesh, m.landmarks, noise))
    return replace(pair, name=f"identity_{seed}_noise_{noise}", target=target)


def decimated(seed: int | None) -> Pair:
    m = model()
    base = m.mesh.positions if seed is None else m.identity(seed)
    mesh, truth, specs = remeshed(base, m.deltas, m.landmarks, 5650)
    name = f"decimated_{seed or 'same'}"
    return Pair(name, rig_of(m.mesh, m.landmarks, m), Head.from_mesh(mesh, specs), truth)


def dense(seed: int) -> Pair:
    m = model()
    mesh, truth, specs = subdivided(m.identity(seed), m.deltas, m.landmarks)
    return Pair("subdivided", rig_of(m.mesh, m.landmarks, m), Head.from_mesh(mesh, specs), truth)


def coarse(seed: int) -> Pair:
    m = model()
    mesh, deltas, specs = remeshed(m.mesh.positions, m.deltas, m.landmarks, 500)
    target = Head.from_mesh(m.moved(m.identity(seed)), m.landmarks)
    return Pair("coarse", rig_with(mesh, specs, m.names, deltas), target, m.deltas)


@cache
def makehuman(name: str) -> Head:
    folder = real_data_folder() / "makehuman_head"
    return Head.load(folder / f"{name}.obj", folder / "landmarks.json")


def to_makehuman(name: str) -> Pair:
    m = model(whole=True)
    return Pair(f"to_{name}", rig_of(m.mesh, m.landmarks, m), makehuman(name), None)


def whole_identity(seed: int) -> Pair:
    """All parts: teeth, tongue, eyes and lashes as well."""
    m = model(whole=True)
    target = Head.from_mesh(m.moved(m.identity(seed)), m.landmarks)
    return Pair(f"whole_{seed}", rig_of(m.mesh, m.landmarks, m), target, m.deltas)


PAIRS: dict[str, Callable[[], Pair]] = {
    "self": self_pair,
    "similar": similar,
    "identity_11": lambda: identity(11),
    "identity_12": lambda: identity(12),
    "noise_1": lambda: identity_noisy(11, 1),
    "noise_2": lambda: identity_noisy(12, 2),
    "decimated_same": lambda: decimated(None),
    "decimated_11": lambda: decimated(11),
    "subdivided": lambda: dense(11),
    "coarse": lambda: coarse(11),
    "whole_11": lambda: whole_identity(11),
    **{f"to_{name}": (lambda name=name: to_makehuman(name)) for name in MAKEHUMAN},
}
"""Pair name -> maker."""


def as_text(summary: Mapping[str, float]) -> str:
    """Return a summary as JSON."""
    return json.dumps({key: round(float(value), 4) for key, value in summary.items()})
