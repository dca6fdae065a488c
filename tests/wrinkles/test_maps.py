"""Normal maps of wrinkles, on the built-in head."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from risorius.controls import default_presets
from risorius.errors import LandmarkError, MeshError, ParameterError
from risorius.rig import Rig, bake
from risorius.wrinkles import WrinkleGroup, Wrinkler, parse_group, wrinkle_maps
from risorius.wrinkles.chart import chart_of
from tests.layered.faces import builtin_layered

SHAPES = ("browInnerUp", "browOuterUpLeft", "browOuterUpRight", "jawOpen")
BROW = WrinkleGroup.of("brow_up", SHAPES[:3])
FLAT = np.array([128, 128, 255])


@cache
def rig() -> Rig:
    face, book = builtin_layered(), default_presets()
    poses = {name: book.fit(book.arkit[name], face.controls).pose for name in SHAPES}
    return bake(face, poses)


@cache
def brow_map():
    return wrinkle_maps(rig(), [BROW], size=512).maps[0]


def test_raised_brows_wrinkle_the_forehead_across_and_nothing_else() -> None:
    relief = brow_map().relief
    deep = relief.height < -0.1
    assert deep.sum() > 200
    head = Wrinkler(rig()).subject.head
    assert head is not None
    eyes = head.landmarks["3.7"].at(head.positions)[1]
    assert (relief.patch.mesh.positions[deep, 1] > eyes).all()
    # Lines run from side to side: the slope is mostly up and down.
    steep = np.linalg.norm(relief.slope, axis=1) > 0.1
    size = np.abs(relief.slope[steep]).mean(axis=0)
    assert size[1] > 2.0 * size[0]
    assert 0.1 < relief.deepest < 1.5


def test_a_map_shows_the_slope_of_its_relief() -> None:
    normals = brow_map().normals.astype(float) / 127.5 - 1.0
    wrinkled = (brow_map().normals != FLAT).any(axis=2)
    np.testing.assert_allclose(np.linalg.norm(normals[wrinkled], axis=1), 1.0, atol=0.02)
    assert 0.002 < wrinkled.mean() < 0.4
    # The texture of the head stands upright, so does the slope in it.
    spread = normals[wrinkled].std(axis=0)
    assert spread[1] > 1.5 * spread[0]


def test_depth_and_spacing_are_factors() -> None:
    wrinkler = Wrinkler(rig())
    weights = dict.fromkeys(BROW.shapes, 1.0)
    plain, deep = wrinkler.relief(weights), wrinkler.relief(weights, depth=2.0)
    assert plain is not None
    assert deep is not None
    np.testing.assert_allclose(deep.height, 2.0 * plain.height, atol=1e-9)
    wide = wrinkler.relief(weights, spacing=2.0)
    assert wide is not None
    assert wide.deepest == pytest.approx(2.0 * plain.deepest, rel=0.1)


def test_a_shape_at_rest_wrinkles_nothing() -> None:
    assert Wrinkler(rig()).relief({"browInnerUp": 0.0}) is None


def test_the_side_map_tells_left_from_right() -> None:
    made = wrinkle_maps(rig(), [BROW], size=256)
    assert set(np.unique(made.side)) >= {0, 255}
    uvs, mesh = rig().mesh.uvs, rig().mesh
    x = mesh.positions[mesh.corners, 0]
    for corner in np.flatnonzero(np.abs(x) > 25.0)[::977]:
        u, v = uvs[mesh.uv_corners[corner]]
        row, column = int((1.0 - v) * 255), int(u * 255)
        if mesh.triangle_polygon.size and made.side[row, column] in (0, 255):
            assert (made.side[row, column] == 255) == (x[corner] > 0.0)


def test_maps_follow_texture_coordinates_to_another_tile_and_over_a_mirror() -> None:
    plain = brow_map().normals.astype(int)
    mesh = rig().mesh
    moved = replace(rig(), mesh=replace(mesh, uvs=mesh.uvs + [3.0, 1.0]))
    made = wrinkle_maps(moved, [BROW], size=512)
    assert made.tile == (3, 1)
    np.testing.assert_allclose(made.maps[0].normals, plain, atol=1)
    flipped = replace(rig(), mesh=replace(mesh, uvs=[1.0, 0.0] + mesh.uvs * [-1.0, 1.0]))
    mirrored = wrinkle_maps(flipped, [BROW], size=512).maps[0].normals[:, ::-1].astype(int)
    wrinkled = (plain != FLAT).any(axis=2) & (mirrored != FLAT).any(axis=2)
    # Red points along u, which now runs the other way; green is as it was.
    np.testing.assert_allclose(mirrored[wrinkled, 0] - 127.5, 127.5 - plain[wrinkled, 0], atol=6)
    np.testing.assert_allclose(mirrored[wrinkled, 1], plain[wrinkled, 1], atol=6)


def test_groups_without_shapes_or_pressure_are_left_out_with_the_reason() -> None:
    made = wrinkle_maps(rig(), [WrinkleGroup.of("smile", ["mouthSmileLeft"])], size=64)
    assert made.maps == ()
    assert made.left_out == {"smile": "the rig has no mouthSmileLeft"}


def test_what_cannot_be_wrinkled_is_refused_in_one_sentence() -> None:
    mesh = rig().mesh
    none = {"uvs": np.zeros((0, 2)), "uv_corners": np.zeros(0, np.int32)}
    bare = replace(rig(), mesh=replace(mesh, **none))
    with pytest.raises(MeshError, match="no texture coordinates"):
        wrinkle_maps(bare, [BROW])
    with pytest.raises(LandmarkError, match="lids and lips say how fine skin is"):
        wrinkle_maps(replace(rig(), landmarks={}), [BROW])
    with pytest.raises(ParameterError, match="size: 63"):
        wrinkle_maps(rig(), [BROW], size=63)
    with pytest.raises(ParameterError, match="two maps share a name"):
        wrinkle_maps(rig(), [BROW, BROW])
    with pytest.raises(ParameterError, match="no target"):
        Wrinkler(rig()).relief({"beauty": 1.0})


def test_groups_are_read_from_words() -> None:
    group = parse_group("nose = noseSneerLeft + noseSneerRight")
    assert group == WrinkleGroup("nose", ("noseSneerLeft",), ("noseSneerRight",))
    middle = WrinkleGroup.of("a", ["mouthPucker"])
    assert middle.left == middle.right == middle.shapes == ("mouthPucker",)
    for text in ("nose", "=a", "a/b=c", "a=b++c", "a=b+b"):
        with pytest.raises(ParameterError):
            parse_group(text)


def test_the_same_rig_gives_the_same_maps() -> None:
    np.testing.assert_array_equal(
        wrinkle_maps(rig(), [BROW], size=512).maps[0].normals, brow_map().normals
    )


def test_a_map_leans_down_the_slope_of_its_relief() -> None:
    wrinkler = Wrinkler(rig())
    relief = brow_map().relief
    wanted = np.zeros(wrinkler.skin.mesh.face_count, bool)
    wanted[relief.patch.coarse_face] = True
    chart = chart_of(rig(), wrinkler.skin, wanted)
    column, row = chart.places(relief.patch, 512).mean(axis=1).astype(int).T
    slope = chart.slopes(relief.patch, relief.slope).mean(axis=1)
    shown = brow_map().normals[row, column, :2] / 127.5 - 1.0
    steep = np.abs(slope).max(axis=1) > 0.1
    for axis in range(2):
        assert np.corrcoef(shown[steep, axis], slope[steep, axis])[0, 1] < -0.8
