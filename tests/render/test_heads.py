"""Portraits: parts in their colours, framed by landmarks."""

from __future__ import annotations

import numpy as np
import pytest

from risorius import Rig, builtin_head
from risorius.errors import LandmarkError, ParameterError, ShapeError
from risorius.render.heads import Portrait
from risorius.render.views import VIEWS
from risorius.rig import MorphTarget
from risorius.rig.bake import empty_rig
from tests.synthetic import quad_mesh


@pytest.fixture(scope="module")
def portrait() -> Portrait:
    return Portrait.of(builtin_head())


def test_every_triangle_of_the_head_is_drawn_once(portrait: Portrait) -> None:
    drawn = sum(len(surface.faces) for surface in portrait.surfaces())
    assert drawn == len(builtin_head().source.triangles)


def test_surfaces_follow_the_vertices(portrait: Portrait) -> None:
    up = [0.0, 5.0, 0.0]
    rest, moved = portrait.surfaces(), portrait.surfaces(portrait.positions + up)
    for before, after in zip(rest, moved, strict=True):
        assert np.allclose(after.positions - before.positions, up)
        assert np.allclose(after.normals, before.normals)


def test_normals_agree_on_both_sides_of_a_seam() -> None:
    # A square folded along its diagonal.
    positions = np.array([[0.0, 0, 0], [1, 0, 0.5], [1, 1, 0], [0, 1, 0.5]])
    whole = quad_mesh().from_polygons(positions, [[0, 1, 2], [0, 2, 3]])
    cut = quad_mesh().from_polygons(positions[[0, 1, 2, 0, 2, 3]], [[0, 1, 2], [3, 4, 5]])
    (one,) = Portrait.of(Rig(whole, ())).surfaces()
    (two,) = Portrait.of(Rig(cut, ())).surfaces()
    assert np.allclose(two.normals, one.normals[[0, 1, 2, 0, 2, 3]])


def test_an_eye_without_iris_is_painted(portrait: Portrait) -> None:
    mesh = builtin_head().source
    bare = type(mesh)(mesh.positions, mesh.corners, mesh.offsets)
    rig = empty_rig(builtin_head())
    plain = Portrait.of(Rig(bare, (), rig.part_names, rig.part_of_vertex))
    painted = [surface for surface in plain.surfaces() if surface.ramp is not None]
    assert len(painted) == 2


def test_views_show_what_they_are_called_after(portrait: Portrait) -> None:
    size = (200, 200)
    marks = portrait.landmarks
    for view, names in {
        "face": ("2.1", "3.7", "3.12", "4.3", "4.4"),
        "front": ("2.1", "3.7", "3.12", "11.4"),
        "profile": ("2.1", "9.3", "3.7", "10.1"),
        "mouth": ("2.4", "2.5", "8.1", "8.2", "2.1"),
        "eyes": ("3.7", "3.11", "3.8", "3.12"),
    }.items():
        seen = portrait.camera(view).project(marks.positions(names), size)
        assert ((seen[:, :2] > 0) & (seen[:, :2] < 200)).all(), view
    for view in ("three-quarter", "profile"):
        left, right = portrait.camera(view).project(marks.positions(("3.7", "3.12")), size)
        assert left[2] < right[2], "the character's left side is nearer"
    mouth = portrait.camera("mouth").project(marks.positions(("2.4", "2.5")), size)
    assert mouth[0, 0] - mouth[1, 0] > 60  # the character's left is at the right of the picture
    assert set(VIEWS) == {"front", "three-quarter", "profile", "face", "mouth", "eyes"}


def test_shoulders_do_not_change_the_frame(portrait: Portrait) -> None:
    usual = portrait.camera("front")
    wide = portrait.positions.copy()
    wide[0] = [0.0, -900.0, 0.0]
    from risorius.render.views import camera_for

    again = camera_for("front", portrait.landmarks, wide)
    assert np.allclose(usual.eye, again.eye)


def test_without_landmarks_the_whole_is_framed_and_close_ups_are_refused() -> None:
    portrait = Portrait.of(Rig(quad_mesh(), ()))
    seen = portrait.camera("front").project(portrait.positions, (100, 100))
    assert ((seen[:, :2] > 0) & (seen[:, :2] < 100)).all()
    with pytest.raises(LandmarkError, match=r"the view of the mouth needs 2\.4"):
        portrait.camera("mouth")
    with pytest.raises(ParameterError, match="'behind' is not one of"):
        portrait.camera("behind")


def test_the_pose_of_a_rig_is_drawn_in_the_canonical_frame() -> None:
    mesh = quad_mesh()
    lift = np.zeros_like(mesh.positions)
    lift[4] = [0.0, 0.0, 0.5]
    rig = Rig(mesh, (MorphTarget.from_dense("lift", lift),))
    portrait = Portrait.of(rig)
    moved = portrait.posed({"lift": 2.0})
    assert np.allclose(moved[4] - portrait.positions[4], [0.0, 0.0, 1.0])
    camera = portrait.camera("front", yaw=40.0)
    rest = portrait.picture(camera, size=(64, 64))
    posed = portrait.picture(camera, size=(64, 64), weights={"lift": 2.0})
    assert (rest != posed).any()
    with pytest.raises(ParameterError, match="no target 'sink'"):
        portrait.posed({"sink": 1.0})


def test_positions_of_another_head_are_refused(portrait: Portrait) -> None:
    with pytest.raises(ShapeError, match="positions: expected shape"):
        portrait.surfaces(np.zeros((3, 3)))
