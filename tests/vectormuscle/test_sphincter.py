from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import ParameterError
from risorius.vectormuscle.kinds import SphincterMuscle
from risorius.vectormuscle.muscle import KINDS
from tests.face_fixtures import builtin_face
from tests.vectormuscle.patches import context, patch

MESH = patch(61, 61)
CENTRE = np.array([0.0, -30.0, 0.0])
RING = SphincterMuscle("ring", CENTRE, (25.0, 15.0), (0.3, 0.2), forward=4.0)
ENTRY = {
    "name": "ring",
    "kind": "sphincter",
    "centre": [0.0, -30.0, 0.0],
    "radii": [25.0, 15.0],
    "shrink": [0.3, 0.2],
    "forward": 4.0,
    "part": 0.0,
    "inner": 0.3,
}
OFFSET = MESH.positions - CENTRE
RHO = np.sqrt((OFFSET[:, 0] / 25.0) ** 2 + (OFFSET[:, 1] / 15.0) ** 2)


def _moved(muscle: SphincterMuscle = RING) -> np.ndarray:
    bound = muscle.bind(context(MESH))
    result = np.zeros_like(MESH.positions)
    result[bound.vertices] = bound.displace(MESH.positions[bound.vertices], 1.0)
    return result


def test_inside_the_inner_ellipse_the_effect_is_full() -> None:
    moved, inner = _moved(), RHO < 0.3
    assert inner.sum() > 50
    np.testing.assert_allclose(moved[inner, 0], -0.3 * OFFSET[inner, 0], atol=1e-12)
    np.testing.assert_allclose(moved[inner, 1], -0.2 * OFFSET[inner, 1], atol=1e-12)
    np.testing.assert_allclose(moved[inner, 2], 4.0, atol=1e-12)


def test_outside_the_ellipse_nothing_moves() -> None:
    moved = _moved()
    np.testing.assert_array_equal(moved[RHO >= 1.0], 0.0)
    assert np.abs(moved[(RHO > 0.97) & (RHO < 1.0)]).max() < 0.05


def test_skin_draws_towards_the_centre_and_keeps_its_order() -> None:
    after = OFFSET + _moved()
    np.testing.assert_array_less(
        np.abs(after[RHO < 1.0, :2]), np.abs(OFFSET[RHO < 1.0, :2]) + 1e-12
    )
    for row in range(0, 61, 10):
        x = after[np.isclose(MESH.positions[:, 1], -float(row)), 0]
        assert (np.diff(x) > 0.0).all()


def test_contraction_scales_the_field() -> None:
    bound = RING.bind(context(MESH))
    points = MESH.positions[bound.vertices]
    np.testing.assert_array_equal(bound.displace(points, 0.0), 0.0)
    np.testing.assert_allclose(bound.displace(points, 0.25), 0.25 * bound.field)


def test_lower_only_spares_the_skin_above() -> None:
    half = SphincterMuscle("ring", CENTRE, (25.0, 15.0), (0.3, 0.2), lower_only=1.0)
    moved = np.linalg.norm(_moved(half), axis=1)
    np.testing.assert_array_equal(moved[OFFSET[:, 1] > 0.3 * 15.0], 0.0)
    assert moved[OFFSET[:, 1] < 0.0].max() > 0.5


def test_skin_far_behind_the_plane_of_the_muscle_stays() -> None:
    behind = MESH.positions - np.array([0.0, 0.0, 60.0])
    bound = RING.bind(context(type(MESH)(behind, MESH.faces)))
    assert len(bound.vertices) == 0


def test_the_mouth_parts_its_lips_apart() -> None:
    face = builtin_face()
    skin = face.head.skin
    moved = face.displace({"orbicularis_oris_funnel": 1.0})[skin.first_source()]
    upper, lower = face.head.skin_vertex("2.2"), face.head.skin_vertex("2.3")
    assert moved[upper, 1] > 1.0
    assert moved[lower, 1] < -1.0
    assert min(moved[upper, 2], moved[lower, 2]) > 1.0


def test_a_warp_scales_the_axes_and_the_pout() -> None:
    fitted = RING.fitted(lambda points: np.asarray(points) * [2.0, 3.0, 2.0])
    assert fitted.radii == pytest.approx((50.0, 45.0))
    assert fitted.forward == pytest.approx(8.0)
    assert fitted.shrink == RING.shrink


def test_the_mirror_image_has_its_centre_on_the_other_side() -> None:
    eye = SphincterMuscle("eye_l", np.array([30.0, 0.0, 1.0]), (9.0, 9.0), (0.1, 0.1))
    assert eye.mirrored().name == "eye_r"
    np.testing.assert_array_equal(eye.mirrored().centre, [-30.0, 0.0, 1.0])


def test_an_entry_is_read_and_written_back() -> None:
    assert KINDS["sphincter"](ENTRY, "set").to_json() == ENTRY
    lower = ENTRY | {"lower_only": 0.5}
    assert KINDS["sphincter"](lower, "set").to_json() == lower


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"radii": [1.0]}, "radii must be two numbers"),
        ({"shrink": 0.2}, "shrink must be two numbers"),
        ({"shrink": [0.2, None]}, "shrink: None is not a number"),
        ({"inner": 1.0}, "inner: 1 is above 0.95"),
        ({"lower_only": -0.1}, "lower_only: -0.1 is below 0"),
        ({"centre": [0.0, float("inf"), 0.0]}, "centre must be three finite numbers"),
    ],
)
def test_a_bad_entry_is_refused_by_place(changes: dict, message: str) -> None:
    with pytest.raises(ParameterError, match=rf"^set: muscle 0 \(ring\): {message}"):
        KINDS["sphincter"](ENTRY | changes, "set: muscle 0 (ring)")


def test_an_ellipse_without_width_is_refused() -> None:
    with pytest.raises(ParameterError, match="muscle ring: radii must be above 0"):
        SphincterMuscle("ring", CENTRE, (0.0, 5.0), (0.1, 0.1))
