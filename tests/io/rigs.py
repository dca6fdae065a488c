"""A made-up rig that has everything a file must carry."""

from __future__ import annotations

import numpy as np

from risorius.controls.control import Control
from risorius.head.frame import Frame
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.polygon_mesh import Labels, PolygonMesh
from risorius.rig.rig import MorphTarget, Rig

SIDE = 7  # vertices along each side of the skin
SKIN = np.arange(SIDE * SIDE)
LOOSE = SIDE * SIDE
TEETH = LOOSE + 1 + np.arange(9)
EYE = int(TEETH[-1]) + 1 + np.arange(8)


def _skin() -> tuple[np.ndarray, list[list[int]]]:
    x, y = np.meshgrid(np.linspace(-3, 3, SIDE), np.linspace(-3, 3, SIDE))
    z = 2.0 - 0.1 * (x * x + y * y)
    corner = [[r * SIDE + c for c in range(SIDE - 1)] for r in range(SIDE - 1)]
    quads = [[i, i + 1, i + 1 + SIDE, i + SIDE] for row in corner for i in row]
    # The last two quads become triangles and a pentagon would not be flat, so keep quads.
    a, b, c, d = quads.pop()
    quads += [[a, b, c], [a, c, d]]
    return np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1), quads


def _teeth() -> tuple[np.ndarray, list[list[int]]]:
    """An arrow head, the fan of which folds over, and a pentagon."""
    arrow = [[0, -1], [1, 1], [0, 0.4], [-1, 1]]
    angles = 2 * np.pi * np.arange(5) / 5
    flat = np.concatenate([arrow, np.stack([3 + np.cos(angles), np.sin(angles)], axis=1)])
    points = np.concatenate([0.2 * flat, np.full((9, 1), 0.5)], axis=1)
    # The fan from the arrow's second corner is wrong, the one from its first or third right.
    return points, [[1, 2, 3, 0], [4, 5, 6, 7, 8]]


def _eye() -> tuple[np.ndarray, list[list[int]]]:
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return corners * 0.5 + [1, 1, 0.5], sides


def make_mesh() -> PolygonMesh:
    """A skin with a UV seam and two materials, teeth, a still eye and a loose vertex."""
    parts = [_skin(), _teeth(), _eye()]
    starts = [int(SKIN[0]), int(TEETH[0]), int(EYE[0])]
    positions = np.concatenate([parts[0][0], [[9.0, 8.0, 7.0]], parts[1][0], parts[2][0]])
    polygons = [[start + i for i in p] for start, (_, ps) in zip(starts, parts) for p in ps]
    counts = [len(ps) for _, ps in parts]
    mesh = PolygonMesh.from_polygons(positions, polygons)
    centre = np.array([positions[p].mean(axis=0) for p in polygons])
    uvs, uv_corners = _uvs(mesh, centre, counts[0])
    kind = np.repeat(np.arange(3), counts).astype(np.int32)
    lips = (kind == 0) & (np.abs(centre[:, 1]) < 1) & (np.abs(centre[:, 0]) < 2)
    return PolygonMesh(
        positions,
        mesh.corners,
        mesh.offsets,
        uvs=uvs,
        uv_corners=uv_corners,
        objects=Labels(("Head", "Teeth"), np.array([0, 1, -1], np.int32)[kind]),
        groups=Labels(("lower", "upper half"), (centre[:, 1] >= 0).astype(np.int32)),
        materials=Labels(
            ("Face", "Lips ü", "enamel"),
            np.where(lips, 1, np.array([0, 2, -1])[kind]).astype(np.int32),
        ),
    )


def _uvs(mesh: PolygonMesh, centre: np.ndarray, skin_count: int) -> tuple[np.ndarray, np.ndarray]:
    """Left and right half of the skin have their own sheet, teeth and eye have none."""
    polygon = np.repeat(np.arange(mesh.polygon_count), np.diff(mesh.offsets))
    flat = 0.5 + mesh.positions[SKIN][:, :2] / 12.0
    uvs = np.concatenate([flat, flat + np.array([0.0, 0.25])])
    right = centre[polygon, 0] < 0
    return uvs, np.where(polygon < skin_count, mesh.corners + len(flat) * right, -1).astype(
        np.int32
    )


def make_rig(mesh: PolygonMesh | None = None) -> Rig:
    """Four targets: one-sided, over two parts, one that moves nothing, and a twin vertex's."""
    mesh = mesh or make_mesh()
    n = mesh.vertex_count
    x, y = mesh.positions[:, 0], mesh.positions[:, 1]
    skin = np.isin(np.arange(n), SKIN)
    smile = np.zeros((n, 3))
    smile[skin & (x > 0.5) & (y < 0)] = [0.1, 0.3, -0.05]
    jaw = np.zeros((n, 3))
    jaw[skin & (y < -0.5)] = [0.0, -0.7, -0.9]
    jaw[TEETH] = [0.0, -0.5, 0.0]
    part = np.full(n, -1, np.int32)
    part[SKIN], part[TEETH], part[EYE] = 0, 2, 1
    return Rig(
        mesh,
        (
            MorphTarget.from_dense("mouthSmileLeft", smile, pose={"zygomaticus_major_l": 0.8}),
            MorphTarget.from_dense("jawOpen", jaw, pose={"jaw_pitch": 10.0}),
            MorphTarget.from_dense("noseSneer", np.zeros((n, 3))),
        ),
        ("skin", "eye_left", "teeth_lower"),
        part,
        {
            "2.1": LandmarkSpec(vertex=3, confidence="documented"),
            "2.2": LandmarkSpec(face=5, bary=(0.5, 0.25, 0.25)),
            "8.3": LandmarkSpec(position=(0.125, -1.5, 1.75)),
        },
        Frame(
            np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]]), 10.0, np.array([0.5, 0, 1]), "cm"
        ),
        (
            Control("jaw_pitch", -4.0, 18.0, 0.0, "deg", "jaw", "jaw_pitch"),
            Control("jaw_yaw", -5.0, 5.0, 0.0, "deg", "jaw", "jaw_yaw", -1.0),
        ),
        {"tongueOut": "the head has no tongue"},
    )


def make_seam_rig(*, apart: bool) -> Rig:
    """Two quads that touch along an edge whose vertices the file holds twice.

    With `apart` a target pulls the two copies away from each other, as lips do.
    """
    positions = np.array(
        [
            [-1, 0, -0.5],
            [0, 0, 0],
            [0, 1, 0],
            [-1, 1, -0.5],
            [0, 0, 0],
            [1, 0, -0.5],
            [1, 1, -0.5],
            [0, 1, 0],
        ],
        float,
    )
    mesh = PolygonMesh.from_polygons(positions, [[0, 1, 2, 3], [4, 5, 6, 7]])
    deltas = np.zeros((8, 3))
    deltas[[1, 2, 4, 7]] = [0, 0, 0.5]
    if apart:
        deltas[[4, 7]] = [0, 0, -0.5]
    return Rig(mesh, (MorphTarget.from_dense("open", deltas),), ("skin",), np.zeros(8, np.int32))


def assert_same_rig(found: Rig, expected: Rig, *, rounding: float) -> None:
    """Compare everything; numbers may differ by `rounding` times the size of the mesh."""
    size = float(np.ptp(expected.mesh.positions, axis=0).max())
    one, other = found.mesh, expected.mesh
    near = {"rtol": 0.0, "atol": rounding * size}
    np.testing.assert_allclose(one.positions, other.positions, **near)
    np.testing.assert_array_equal(one.corners, other.corners)
    np.testing.assert_array_equal(one.offsets, other.offsets)
    assert one.corners.dtype == one.offsets.dtype == np.int32
    np.testing.assert_array_equal(one.uv_corners < 0, other.uv_corners < 0)
    has_uv = other.uv_corners >= 0
    np.testing.assert_allclose(
        one.uvs[one.uv_corners[has_uv]], other.uvs[other.uv_corners[has_uv]], rtol=0, atol=rounding
    )
    for kind in ("objects", "groups", "materials"):
        assert getattr(one, kind).names == getattr(other, kind).names
        np.testing.assert_array_equal(
            getattr(one, kind).of_polygon, getattr(other, kind).of_polygon
        )
    assert found.names == expected.names
    for target in expected.targets:
        mine = found.by_name[target.name]
        np.testing.assert_array_equal(mine.vertices, target.vertices)
        np.testing.assert_allclose(mine.deltas, target.deltas, **near)
        assert mine.pose == target.pose
    assert found.part_names == expected.part_names
    np.testing.assert_array_equal(found.part_of_vertex, expected.part_of_vertex)
    assert dict(found.landmarks) == dict(expected.landmarks)
    assert found.controls == expected.controls
    assert dict(found.left_out) == dict(expected.left_out)
    assert found.frame.unit == expected.frame.unit
    assert found.frame.scale == expected.frame.scale
    np.testing.assert_array_equal(found.frame.rotation, expected.frame.rotation)
    np.testing.assert_array_equal(found.frame.origin, expected.frame.origin)
