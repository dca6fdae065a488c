"""Skull and jaw under the skin, given, built in or cut from the head itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from risorius.anatomy.skull import builtin_skull, load_skull
from risorius.errors import MeshError, ParameterError
from risorius.layered.muscle_map import default_muscle_map
from risorius.mesh.core import TriMesh
from risorius.spatial.closest import signed_distance
from risorius.springmuscle.bones import (
    Bones,
    SkinBones,
    builtin_bones,
    cut_bones,
    find_bones,
    given_bones,
)
from risorius.springmuscle.muscle import JAW, SKULL
from risorius.springmuscle.row_bones import grow_bones
from risorius.springmuscle.surface import SkinSurface
from tests.springmuscle.coarse import coarse_mechanics
from tests.springmuscle.faces import builtin_mechanics
from tests.springmuscle.skins import builtin_ground, surface_of

MIRROR = [-1.0, 1.0, 1.0]


def _under(bones: Bones, share: float | None = None, depth: float = 16.0) -> SkinBones:
    mechanics = builtin_mechanics() if share is None else coarse_mechanics(share)
    return bones.under(SkinSurface.build(mechanics), max_depth=depth)


def _at(name: str, found: SkinBones) -> int:
    return int(found.bones[builtin_mechanics().head.skin_vertex(name)])


@pytest.mark.parametrize("way", ["builtin", "cut"])
def test_forehead_lies_on_skull_chin_on_jaw_and_lips_on_nothing(way: str) -> None:
    found = _under(find_bones(builtin_mechanics(), way))
    assert _at("4.1", found) == SKULL
    assert _at("11.1", found) == SKULL
    assert _at("2.10", found) == JAW
    assert _at("8.1", found) == 0 or way == "builtin"
    assert _at("2.4", found) == 0
    sides = SkinSurface.build(builtin_mechanics()).sides
    assert not ((found.bones == JAW) & (sides > 0)).any()
    assert not ((found.bones == SKULL) & (sides < 0)).any()


def test_feet_lie_on_the_bone_below_the_skin() -> None:
    bones = builtin_bones(builtin_mechanics())
    found = _under(bones)
    surface = SkinSurface.build(builtin_mechanics())
    held = found.bones > 0
    assert held.sum() > 2000
    assert (found.depths[held] > 0.0).all()
    assert (found.depths[held] <= 16.0 * surface.scale).all()
    way = surface.mesh.positions - found.feet
    assert np.abs(np.linalg.norm(way, axis=1) - found.depths).max() < 1e-9
    assert (found.feet[~held] == surface.mesh.positions[~held]).all()
    assert (found.depths[~held] == 0.0).all()
    # Shallower bone is held by fewer vertices.
    assert (_under(bones, depth=8.0).bones > 0).sum() < held.sum()


def test_the_head_cut_in_two_agrees_with_the_built_in_skull() -> None:
    cut = _under(cut_bones(builtin_mechanics()))
    fitted = _under(builtin_bones(builtin_mechanics()))
    both = (cut.bones > 0) & (fitted.bones > 0)
    assert both.sum() > 1500
    assert (cut.bones == fitted.bones)[both].mean() >= 0.98


def test_the_cut_lies_inside_the_skin_and_is_simple() -> None:
    bones = cut_bones(builtin_mechanics())
    skin = builtin_mechanics().head.skin.mesh
    assert 100 < bones.jaw.face_count < bones.skull.face_count <= 3000
    points = np.concatenate([bones.skull.positions, bones.jaw.positions])
    depth = -signed_distance(skin, points)
    assert np.median(depth) > 4.0
    assert (depth > 0.0).mean() > 0.99
    # Both are as symmetric as the skin that they come from.
    middle = np.abs(bones.jaw.positions[:, 0].max() + bones.jaw.positions[:, 0].min())
    assert middle < 1.0


@pytest.mark.parametrize("share", [0.5, 0.2])
def test_bones_of_the_whole_head_serve_its_coarse_versions(share: float) -> None:
    bones = cut_bones(builtin_mechanics())
    coarse, whole = _under(bones, share), _under(bones)
    fine, rough = builtin_mechanics().head.skin.mesh, coarse_mechanics(share).head.skin.mesh
    apart = np.linalg.norm(rough.positions[:, None] - fine.positions[None, ::4], axis=2)
    near = apart.argmin(axis=1) * 4
    both = (coarse.bones > 0) & (whole.bones[near] > 0)
    assert both.sum() > 200
    assert (coarse.bones == whole.bones[near])[both].mean() > 0.97


def test_given_and_built_in_are_one_when_the_given_one_is_the_built_in() -> None:
    given = given_bones(builtin_mechanics(), builtin_skull())
    built = builtin_bones(builtin_mechanics())
    assert (given.way, built.way) == ("given", "builtin")
    assert (given.jaw.positions == built.jaw.positions).all()
    assert (given.skull.positions == built.skull.positions).all()


def test_ways_are_refused_by_name_and_given_needs_a_skull() -> None:
    with pytest.raises(ParameterError, match="'xray' is not one of builtin, cut, given"):
        find_bones(builtin_mechanics(), "xray")
    with pytest.raises(ParameterError, match="'given' needs a skull"):
        find_bones(builtin_mechanics(), "given")
    assert find_bones(builtin_mechanics(), "given", skull=builtin_skull()).way == "given"


def test_a_head_whose_hinge_leaves_no_jaw_is_refused() -> None:
    mechanics = builtin_mechanics()
    forward = replace(mechanics.jaw, hinge=mechanics.jaw.hinge + [0.0, 0.0, 300.0])
    with pytest.raises(MeshError, match=r"cutting it leaves \d+ triangles for the jaw"):
        cut_bones(replace(mechanics, jaw=forward))


def test_no_bone_holds_nothing() -> None:
    nothing = TriMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int32))
    found = Bones(nothing, nothing, "given").under(surface_of(lambda x, y: 0 * x), max_depth=9.0)
    assert not found.bones.any()
    assert not grow_bones(surface_of(lambda x, y: 0 * x), found).bones.any()


def test_attachment_grows_over_the_skin_but_never_to_the_other_lip() -> None:
    surface = surface_of(lambda x, y: 0.0 * x, count=9)
    x = surface.mesh.positions[:, 0]
    sides = np.where(x > 1.0, 1, np.where(x < -1.0, -1, 0)).astype(np.int8)
    split = replace(surface, sides=sides)
    # Cut at x = 0, so that the sides touch nowhere but in the neutral column.
    bones = np.zeros(len(x), np.int8)
    bones[x > 30.0], bones[x < -30.0] = SKULL, JAW
    held = SkinBones(bones, surface.mesh.positions, np.zeros(len(x)))
    grown = grow_bones(split, held).bones
    assert (grown[x > 1.0] == SKULL).all()
    assert (grown[x < -1.0] == JAW).all()
    alone = np.where(x > 30.0, SKULL, 0).astype(np.int8)
    touching = replace(surface, sides=np.where(x > -1.0, 1, -1).astype(np.int8))
    far = grow_bones(touching, SkinBones(alone, surface.mesh.positions, np.zeros(len(x)))).bones
    assert (far[x > -1.0] == SKULL).all()
    assert not far[x < -1.0].any()


def test_bones_of_a_symmetric_head_are_symmetric() -> None:
    found = builtin_ground().skin_bones
    points = builtin_mechanics().head.skin.mesh.positions
    order = np.lexsort(np.round(points, 6).T)
    flipped = np.lexsort(np.round(points * MIRROR, 6).T)
    same = found.bones[order] == found.bones[flipped]
    assert same.mean() > 0.995


def test_an_upper_lip_never_lies_on_the_jaw_nor_a_lower_one_on_the_skull() -> None:
    surface = surface_of(lambda x, y: 0.0 * x, count=9)
    x = surface.mesh.positions[:, 0]
    plate = TriMesh(surface.mesh.positions - [0.0, 0.0, 5.0], surface.mesh.faces)
    nothing = TriMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int32))
    sides = np.sign(np.round(x)).astype(np.int8)
    split = replace(surface, sides=sides)
    on_jaw = Bones(nothing, plate, "given").under(split, max_depth=9.0).bones
    on_skull = Bones(plate, nothing, "given").under(split, max_depth=9.0).bones
    inner = np.abs(surface.mesh.positions[:, :2]).max(axis=1) < 39.0
    assert (on_jaw[inner] == np.where(sides > 0, 0, JAW)[inner]).all()
    assert (on_skull[inner] == np.where(sides < 0, 0, SKULL)[inner]).all()


@pytest.mark.real
def test_a_foreign_skull_serves_as_well_as_the_built_in_one(real_data) -> None:
    folder = real_data / "myosim_skull"
    skull = load_skull(
        (folder / "skull_yup_zfwd.obj", folder / "mandible_yup_zfwd.obj"),
        folder / "landmarks.json",
        marks=default_muscle_map().landmarks,
    )
    given = _under(given_bones(builtin_mechanics(), skull))
    built = _under(builtin_bones(builtin_mechanics()))
    both = (given.bones > 0) & (built.bones > 0)
    assert both.sum() > 2000
    assert (given.bones == built.bones)[both].mean() > 0.98
