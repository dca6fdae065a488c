from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from risorius.errors import ParameterError, RisoriusWarning
from risorius.mesh.core import TriMesh
from risorius.vectormuscle.kinds import LinearMuscle
from risorius.vectormuscle.muscle import KINDS, FaceContext
from risorius.vectormuscle.profile import fold_limit
from tests.face_fixtures import builtin_face
from tests.vectormuscle.patches import context, linear, move_by, patch

MESH = patch()
MUSCLE = linear()
ENTRY = {
    "name": "pull",
    "kind": "linear",
    "origin": [0.0, 0.0, 0.0],
    "insertion": [0.0, -30.0, 0.0],
    "start_radius": 30.0,
    "finish_radius": 50.0,
    "half_angle": 35.0,
}


def _read(**changes: object) -> LinearMuscle:
    return KINDS["linear"](ENTRY | changes, "set: muscle 0 (pull)")


def test_the_hand_calculation_on_the_axis_comes_out() -> None:
    # Halfway to the start the effect is cos(pi / 4); the pull is 0.4 times the shorter radius.
    moved = move_by(MUSCLE, MESH)
    vertex = int(np.argmin(np.linalg.norm(MESH.positions - [0.0, -15.0, 0.0], axis=1)))
    np.testing.assert_allclose(
        moved[vertex], [0.0, 0.4 * 20.0 * np.cos(np.pi / 4), 0.0], atol=1e-12
    )


def test_the_skin_moves_towards_the_origin() -> None:
    moved = move_by(MUSCLE, MESH)
    before = np.linalg.norm(MESH.positions, axis=1)
    after = np.linalg.norm(MESH.positions + moved, axis=1)
    touched = np.linalg.norm(moved, axis=1) > 0.0
    assert touched.sum() > 500
    assert (after[touched] < before[touched]).all()
    away = np.cross(MESH.positions[touched], moved[touched])
    np.testing.assert_allclose(away, 0.0, atol=1e-9)


def test_a_vertex_at_the_origin_stays() -> None:
    vertex = int(np.argmin(np.linalg.norm(MESH.positions, axis=1)))
    assert np.linalg.norm(MESH.positions[vertex]) == 0.0
    np.testing.assert_array_equal(move_by(MUSCLE, MESH)[vertex], 0.0)


def test_contraction_scales_the_step() -> None:
    half, whole = move_by(MUSCLE, MESH, 0.5), move_by(MUSCLE, MESH, 1.0)
    np.testing.assert_allclose(half, 0.5 * whole, atol=1e-15)
    np.testing.assert_array_equal(move_by(MUSCLE, MESH, 0.0), 0.0)


@given(st.tuples(*[st.floats(-180, 180)] * 3), st.floats(0.01, 100.0))
def test_muscle_and_skin_may_be_turned_and_scaled_together(angles, scale: float) -> None:
    turn = scale * Rotation.from_euler("xyz", angles, degrees=True).as_matrix()
    small = patch(9, 13, step=4.0)
    turned = TriMesh(small.positions @ turn.T, small.faces)
    muscle = linear(
        insertion=turn @ MUSCLE.insertion, start_radius=30.0 * scale, finish_radius=50.0 * scale
    )
    np.testing.assert_allclose(
        move_by(muscle, turned), move_by(MUSCLE, small) @ turn.T, atol=1e-6 * scale
    )


def test_the_mirror_image_pulls_the_mirror_image() -> None:
    muscle = linear(name="pull_l", origin=np.array([3.0, 0.0, 0.0]))
    mirror = np.array([-1.0, 1.0, 1.0])
    flipped = TriMesh(MESH.positions * mirror, MESH.faces[:, ::-1])
    assert muscle.mirrored().name == "pull_r"
    assert muscle.mirrored().mirrored().origin.tolist() == muscle.origin.tolist()
    np.testing.assert_allclose(
        move_by(muscle.mirrored(), flipped) * mirror, move_by(muscle, MESH), atol=1e-12
    )


def test_a_warp_carries_both_ends_and_scales_the_radii_with_them() -> None:
    fitted = MUSCLE.fitted(lambda points: 2.0 * np.asarray(points) + 1.0)
    np.testing.assert_array_equal(fitted.origin, 1.0)
    np.testing.assert_array_equal(fitted.insertion, [1.0, -59.0, 1.0])
    assert (fitted.start_radius, fitted.finish_radius) == (60.0, 100.0)
    assert fitted.half_angle == MUSCLE.half_angle
    assert fitted.pull == pytest.approx(2.0 * MUSCLE.pull)


def test_the_zone_is_what_the_effect_reaches_and_no_more() -> None:
    bound = MUSCLE.bind(context(MESH))
    effect = MUSCLE.influence(MESH.positions)
    np.testing.assert_array_equal(bound.vertices, np.flatnonzero(effect > 0.0))
    distance = np.linalg.norm(MESH.positions[bound.vertices], axis=1)
    assert distance.max() < MUSCLE.finish_radius


def test_the_published_profile_reaches_as_far_and_pulls_harder_at_the_side() -> None:
    smooth = MUSCLE.influence(MESH.positions)
    published = MUSCLE.influence(MESH.positions, smooth=False)
    np.testing.assert_array_equal(published > 0.0, smooth > 0.0)
    assert (published >= smooth - 1e-15).all()
    assert published.max() == smooth.max()


def test_static_skin_does_not_move() -> None:
    still = MESH.positions[:, 0] > 0.0
    regions = context(MESH).regions
    fixed = type(regions)(regions.weights, np.where(still, 0.0, 1.0))
    bound = MUSCLE.bind(context(MESH, regions=fixed))
    assert len(bound.vertices) > 100
    assert not still[bound.vertices].any()


def test_full_support_keeps_the_skin_on_its_surface() -> None:
    deep = linear(origin=np.array([0.0, 0.0, -20.0]), start_radius=40.0, finish_radius=60.0)
    for support, inward in ((0.0, True), (1.0, False)):
        bound = deep.bind(context(MESH, support=support))
        moved = bound.displace(MESH.positions[bound.vertices], 1.0)
        assert (moved[:, 2].min() < -1.0) == inward
        if not inward:
            np.testing.assert_allclose(moved[:, 2], 0.0, atol=1e-12)


def test_out_pushes_along_the_normal_by_its_share_of_the_pull() -> None:
    pushed = move_by(linear(out=0.25), MESH) - move_by(MUSCLE, MESH)
    length = np.linalg.norm(move_by(MUSCLE, MESH), axis=1)
    np.testing.assert_allclose(pushed[:, 2], 0.25 * length, atol=1e-9)
    np.testing.assert_allclose(pushed[:, :2], 0.0, atol=1e-12)


def test_the_pull_stops_below_the_fold_limit() -> None:
    limit = fold_limit(start_radius=30.0, finish_radius=50.0)
    assert linear(strength=1.0).pull == pytest.approx(8.0)
    with pytest.warns(RisoriusWarning, match="strength 50 would fold the skin; taken as 1.56"):
        strong = linear(strength=50.0)
    assert strong.pull == pytest.approx(0.98 * limit)
    # Told once: the muscle that was clamped may be carried around in silence.
    assert strong.mirrored().fitted(np.asarray).strength == strong.strength


def test_a_muscle_without_length_is_refused() -> None:
    with pytest.raises(ParameterError, match="muscle pull: origin and insertion are one point"):
        linear(insertion=np.zeros(3))


@pytest.mark.parametrize(("given", "taken"), [(0.0, 1.0), (-20.0, 1.0), (90.0, 89.0), (700, 89.0)])
def test_an_angle_outside_0_to_90_is_clamped_with_a_warning(given: float, taken: float) -> None:
    with pytest.warns(RisoriusWarning, match=f"half_angle {given:g} clamped to {taken:g}"):
        assert linear(half_angle=given).half_angle == taken


@pytest.mark.parametrize("start", [-1.0, 0.0, 50.0, 80.0])
def test_a_start_radius_out_of_order_becomes_70_percent_of_the_finish(start: float) -> None:
    with pytest.warns(
        RisoriusWarning, match="must lie between 0 and finish_radius 50; taken as 35"
    ):
        assert linear(start_radius=start).start_radius == pytest.approx(35.0)


@pytest.mark.parametrize("finish", [0.0, -3.0])
def test_a_finish_radius_of_nothing_is_refused(finish: float) -> None:
    with pytest.raises(ParameterError, match="muscle pull: finish_radius must be above 0"):
        linear(finish_radius=finish)


def test_an_entry_is_read_and_written_back() -> None:
    entry = ENTRY | {
        "strength": 1.2,
        "regions": ["lower"],
        "out": 0.1,
        "corner": 0.5,
        "wrinkles": {"count": 3, "height": 0.2},
    }
    assert KINDS["linear"](entry, "set").to_json() == entry
    assert _read().to_json() == ENTRY | {"strength": 1.0}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"origin": [0.0, 1.0]}, "origin must be three finite numbers"),
        ({"origin": [0.0, 1.0, float("nan")]}, "origin must be three finite numbers"),
        ({"insertion": None}, "insertion must be three finite numbers"),
        ({"start_radius": None}, "start_radius: None is not a number"),
        ({"finish_radius": "wide"}, "finish_radius: 'wide' is not a number"),
        ({"strength": float("inf")}, "strength: inf is not finite"),
        ({"regions": "upper"}, "regions must be a list of region names"),
        ({"regions": [1]}, "regions must be a list of region names"),
    ],
)
def test_a_bad_entry_is_refused_by_place(changes: dict, message: str) -> None:
    with pytest.raises(ParameterError, match=rf"^set: muscle 0 \(pull\): {message}"):
        _read(**changes)


def test_skin_around_the_insertion_follows_where_the_muscle_drags() -> None:
    plain = builtin_face()
    muscle = next(m for m in plain.vectors.muscles if m.name == "zygomaticus_major_l")
    assert isinstance(muscle, LinearMuscle)
    dragging = plain.with_muscles([replace(muscle, drag=0.5, reach=70.0)])
    before = plain.displace_skin({muscle.name: 1.0})
    after = dragging.displace_skin({muscle.name: 1.0})
    moved = np.linalg.norm(after, axis=1)
    assert (moved > 0.0).sum() > 1.3 * (np.linalg.norm(before, axis=1) > 0.0).sum()
    # What the cone moves fully hardly moves further; nothing beyond the reach moves.
    assert moved.max() < 1.1 * np.linalg.norm(before, axis=1).max()
    away = np.linalg.norm(plain.head.skin.mesh.positions - muscle.insertion, axis=1)
    fresh = (moved > 0.0) & ~before.any(axis=1)
    assert away[fresh].max() < 70.0
    along = muscle.origin - muscle.insertion
    assert (after[fresh] @ along).sum() > 0.0
    half = dragging.displace_skin({muscle.name: 0.5})
    assert np.abs(half[fresh] - 0.5 * after[fresh]).max() < 1e-9


def test_bulge_pushes_what_follows_outwards_and_the_plain_muscle_drags_nothing() -> None:
    face = builtin_face()
    muscle = next(m for m in face.vectors.muscles if m.name == "depressor_anguli_l")
    assert isinstance(muscle, LinearMuscle)
    flat = muscle.bind(face.context)
    dragged = replace(muscle, drag=0.5).bind(face.context)
    bulging = replace(muscle, drag=0.5, bulge=0.4).bind(face.context)
    assert not len(flat.field)
    assert len(dragged.field) == len(bulging.field) == len(bulging.vertices)
    push = bulging.field - dragged.field
    normals = face.context.normals[bulging.vertices]
    assert (np.einsum("kd,kd->k", push, normals) >= 0.0).all()
    assert push.any()
    strict = replace(face.context, drag=False)
    assert not len(replace(muscle, drag=0.5).bind(strict).field)


def test_skin_sinks_around_the_insertion_towards_what_supports_it_and_nowhere_else() -> None:
    face = builtin_face()
    muscle = next(m for m in face.vectors.muscles if m.name == "zygomaticus_major_l")
    assert isinstance(muscle, LinearMuscle)
    plain, sunk = (_field(replace(muscle, sink=share), face.context) for share in (0.0, 0.5))
    moved = sunk - plain
    away = np.linalg.norm(face.context.positions - muscle.insertion, axis=1)
    assert not moved[away > 0.6 * np.linalg.norm(muscle.insertion - muscle.origin)].any()
    inward = -np.einsum("nd,nd->n", moved, face.context.outward)
    np.testing.assert_allclose(np.linalg.norm(moved, axis=1), inward, atol=1e-9)
    assert 0.3 * muscle.pull < inward.max() <= 0.5 * muscle.pull + 1e-9
    np.testing.assert_allclose(_field(replace(muscle, sink=-0.5), face.context) - plain, -moved)
    strict = replace(face.context, drag=False)
    np.testing.assert_array_equal(_field(replace(muscle, sink=0.5), strict), _field(muscle, strict))


def _field(muscle: LinearMuscle, seen: FaceContext) -> np.ndarray:
    """Return the displacement (n, 3) at contraction 1 of the whole skin."""
    bound = muscle.bind(seen)
    result = np.zeros_like(seen.positions)
    result[bound.vertices] = bound.displace(seen.positions[bound.vertices], 1.0)
    return result


@pytest.mark.parametrize("change", [{"sink": 3.0}, {"drag": 1.5}, {"drag": -0.1}, {"reach": 0.0}])
def test_a_drag_outside_its_range_is_refused(change: dict[str, float]) -> None:
    muscle = next(m for m in builtin_face().vectors.muscles if isinstance(m, LinearMuscle))
    with pytest.raises(ParameterError, match=next(iter(change))):
        replace(muscle, **change)
