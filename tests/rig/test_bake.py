"""Poses of a face become morph targets."""

from __future__ import annotations

import numpy as np

from risorius.controls import default_presets, list_shapes
from risorius.rig import bake
from risorius.rig.bake import displacement
from tests.face_fixtures import builtin_face


def test_a_shape_made_upon_another_is_what_it_changes_there() -> None:
    face, book = builtin_face(), default_presets()
    shapes = list_shapes(face.controls, book, sets=("singles", "arkit"))
    assert set(shapes.upon) == {"mouthClose", "lips_together"}
    assert shapes.upon["mouthClose"] == book.arkit["jawOpen"]
    chosen = {name: shapes.poses[name] for name in ("jawOpen", "mouthClose")}
    rig = bake(face, chosen, upon=shapes.upon)
    posed = rig.frame.to_canonical(rig.posed({"jawOpen": 1.0, "mouthClose": 1.0}))
    wanted = face.pose({**chosen["jawOpen"], **chosen["mouthClose"]})
    np.testing.assert_allclose(posed, wanted, atol=1e-3)
    # It does not depend on which other shapes are baked along.
    alone = bake(face, {"mouthClose": chosen["mouthClose"]}, upon=shapes.upon)
    np.testing.assert_array_equal(
        alone.target("mouthClose").deltas, rig.target("mouthClose").deltas
    )


def test_poses_that_share_a_control_add_up_before_the_difference_is_taken() -> None:
    face = builtin_face()
    moved = displacement(face, {"jaw_pitch": 4.0}, upon={"jaw_pitch": 8.0})
    wanted = face.displace({"jaw_pitch": 12.0}) - face.displace({"jaw_pitch": 8.0})
    np.testing.assert_array_equal(moved, wanted)


def test_left_and_right_add_up_to_the_face_that_does_both() -> None:
    face, book = builtin_face(), default_presets()
    names = ("mouthSmileLeft", "mouthSmileRight", "mouthStretchLeft", "mouthStretchRight")
    rig = bake(face, {name: book.arkit[name] for name in names})
    for stem in ("mouthSmile", "mouthStretch"):
        sides = f"{stem}Left", f"{stem}Right"
        both = {**book.arkit[sides[0]], **book.arkit[sides[1]]}
        posed = rig.frame.to_canonical(rig.posed(dict.fromkeys(sides, 1.0)))
        np.testing.assert_allclose(posed, face.pose(both), atol=1e-3)
        alone = sum(face.displace(book.arkit[side]) for side in sides)
        # Without the shares the sum is off.
        assert np.abs(alone - face.displace(both)).max() > 0.1


def test_a_side_does_not_depend_on_which_other_shapes_are_baked_along() -> None:
    face, book = builtin_face(), default_presets()
    poses = {name: book.arkit[name] for name in ("jawOpen", "mouthSmileLeft", "mouthSmileRight")}
    alone = bake(face, {"mouthSmileLeft": poses["mouthSmileLeft"]}).target("mouthSmileLeft")
    among = bake(face, poses).target("mouthSmileLeft")
    np.testing.assert_array_equal(alone.vertices, among.vertices)
    np.testing.assert_array_equal(alone.deltas, among.deltas)
