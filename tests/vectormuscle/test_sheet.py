from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from risorius.errors import ParameterError
from risorius.vectormuscle.kinds import SheetMuscle
from risorius.vectormuscle.muscle import KINDS
from tests.face_fixtures import builtin_face
from tests.vectormuscle.patches import context, patch

MESH = patch(41, 61)
ENTRY = {
    "name": "lift",
    "kind": "sheet",
    "origin": [0.0, -5.0, 0.0],
    "insertion": [0.0, -45.0, 0.0],
    "half_width": 15.0,
    "pull": 8.0,
    "fixed": 0.25,
    "fade_origin": 0.1,
    "fade_insertion": 0.3,
}
SHEET = KINDS["sheet"](ENTRY, "set: muscle 0 (lift)")


def _moved(muscle=SHEET, **changes) -> np.ndarray:
    bound = muscle.bind(context(MESH, **changes))
    result = np.zeros_like(MESH.positions)
    result[bound.vertices] = bound.displace(MESH.positions[bound.vertices], 1.0)
    return result


def _row(y: float) -> np.ndarray:
    return np.flatnonzero(np.isclose(MESH.positions[:, 1], y))


def test_the_insertion_rises_by_the_pull_and_the_fixed_line_stays() -> None:
    moved = _moved()
    middle = MESH.positions[:, 0] == 0.0
    for y, lift in ((-45.0, 8.0), (-15.0, 0.0), (-30.0, 4.0), (-5.0, -8.0 / 3.0)):
        vertex = np.intersect1d(_row(y), np.flatnonzero(middle))
        np.testing.assert_allclose(moved[vertex], [[0.0, lift, 0.0]], atol=1e-12)


def test_the_motion_is_even_along_the_fibre_and_fades_beyond_its_ends() -> None:
    place = np.linspace(-0.2, 1.4, 500)
    motion = SHEET.profile(place)
    slope = np.diff(motion) / np.diff(place)
    inside = (place[:-1] > 0.01) & (place[1:] < 0.99)
    np.testing.assert_allclose(slope[inside], 1.0 / 0.75, rtol=1e-9)
    assert motion[0] == motion[-1] == 0.0
    assert np.abs(np.diff(motion)).max() < 0.06


def test_fibres_beside_the_sheet_do_not_move() -> None:
    moved = np.linalg.norm(_moved(), axis=1)
    aside = np.abs(MESH.positions[:, 0])
    np.testing.assert_array_equal(moved[aside >= 15.0], 0.0)
    row = _row(-45.0)
    assert (np.diff(moved[row][MESH.positions[row, 0] >= 0.0]) <= 1e-12).all()


def test_skin_slides_along_its_support() -> None:
    tilted = np.tile([0.0, 0.6, 0.8], (MESH.vertex_count, 1))
    moved = _moved(outward=tilted)
    np.testing.assert_allclose((moved * tilted).sum(axis=1), 0.0, atol=1e-12)
    assert np.abs(moved[:, 2]).max() > 3.0


def test_regions_and_static_skin_are_respected() -> None:
    lower = MESH.positions[:, 1] < -30.0
    muscle = KINDS["sheet"](ENTRY | {"regions": ["upper"]}, "set")
    moved = _moved(muscle, lower=lower)
    np.testing.assert_array_equal(moved[lower], 0.0)
    np.testing.assert_array_equal(moved[~lower], _moved()[~lower])


def test_the_mirror_image_lies_on_the_other_side() -> None:
    left = KINDS["sheet"](ENTRY | {"name": "lift_l", "origin": [4.0, -5.0, 0.0]}, "set")
    mirror = np.array([-1.0, 1.0, 1.0])
    flipped = np.arange(MESH.vertex_count).reshape(61, 41)[:, ::-1].ravel()
    assert left.mirrored().name == "lift_r"
    np.testing.assert_allclose(_moved(left.mirrored())[flipped] * mirror, _moved(left), atol=1e-12)


def test_a_warp_scales_width_and_pull() -> None:
    fitted = SHEET.fitted(lambda points: 3.0 * np.asarray(points))
    assert fitted.half_width == pytest.approx(45.0)
    assert fitted.pull == pytest.approx(24.0)
    assert fitted.length == pytest.approx(120.0)


def test_an_entry_is_read_and_written_back() -> None:
    assert SHEET.to_json() == ENTRY
    full = ENTRY | {"regions": ["upper"], "wrinkles": {"count": 4, "height": 0.15}}
    assert KINDS["sheet"](full, "set").to_json() == full


def test_a_sheet_without_length_is_refused() -> None:
    with pytest.raises(ParameterError, match="muscle s: origin and insertion are one point"):
        SheetMuscle("s", np.ones(3), np.ones(3), 10.0, 5.0)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"half_width": 0.0}, "half_width: 0 is below"),
        ({"pull": None}, "pull: None is not a number"),
        ({"fixed": 0.95}, "fixed: 0.95 is above 0.9"),
        ({"fade_origin": 0.0}, "fade_origin: 0 is below"),
        ({"origin": "here"}, "origin must be three finite numbers"),
    ],
)
def test_a_bad_entry_is_refused_by_place(changes: dict, message: str) -> None:
    with pytest.raises(ParameterError, match=rf"^set: muscle 0 \(lift\): {message}"):
        KINDS["sheet"](ENTRY | changes, "set: muscle 0 (lift)")


def test_skin_beside_a_sheet_follows_and_what_moves_may_bulge() -> None:
    face = builtin_face()
    muscle = next(m for m in face.vectors.muscles if m.name == "frontalis_inner_l")
    assert isinstance(muscle, SheetMuscle)
    plain = muscle.bind(face.context)
    dragged = replace(muscle, drag=0.4).bind(face.context)
    assert set(plain.vertices) < set(dragged.vertices)
    fresh = ~np.isin(dragged.vertices, plain.vertices)
    assert (dragged.field[fresh, 1] > 0.0).mean() > 0.95
    bulging = replace(muscle, out=0.3).bind(face.context)
    push = bulging.field - plain.field
    size = 0.3 * np.linalg.norm(plain.field, axis=1, keepdims=True)
    assert np.allclose(push, size * face.context.normals[plain.vertices])
    entry = replace(muscle, drag=0.4, out=0.3, reach=50.0).to_json()
    assert KINDS["sheet"](entry, "set").to_json() == entry
