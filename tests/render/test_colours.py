"""Colours and the looks of materials."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ParameterError, ShapeError
from risorius.render import (
    SKIN,
    Surface,
    colour_of_material,
    display_rgb,
    eye_paint,
    heat_colours,
    heat_ramp,
    linear_rgb,
    look_of_material,
    render,
)
from tests.render.scenes import AHEAD, PLAIN, ball, linear


@given(st.integers(0, 0xFFFFFF))
def test_codes_survive_the_way_to_linear_light_and_back(value: int) -> None:
    code = f"#{value:06x}"
    assert "#" + bytes(display_rgb(linear_rgb(code))).hex() == code
    np.testing.assert_allclose(linear(display_rgb(linear_rgb(code))), linear_rgb(code), atol=1e-9)


@pytest.mark.parametrize("code", ["red", "#12345", "#1234567", "123456", "#12345g"])
def test_a_wrong_code_is_refused(code: str) -> None:
    with pytest.raises(ParameterError, match="is not of the form"):
        linear_rgb(code)


def test_heat_runs_from_pale_to_dark_and_stays_at_its_ends() -> None:
    colours = heat_colours(np.linspace(0.0, 4.0, 41), 0.0, 4.0)
    luminance = colours @ [0.2126, 0.7152, 0.0722]
    assert colours.min() >= 0.0 and colours.max() <= 1.0
    # Yellow is no darker than clay, from there on it goes down.
    assert (np.diff(luminance[7:]) < 0.0).all()
    beyond = heat_colours([-9.0, 0.0, 4.0, 99.0], 0.0, 4.0)
    np.testing.assert_array_equal(beyond[[0, 3]], beyond[[1, 2]])


def test_heat_of_an_unknown_number_is_grey() -> None:
    colours = heat_colours([np.nan, 1.0], 0.0, 1.0)
    assert np.ptp(colours[0]) < 0.01
    assert np.ptp(colours[1]) > 0.1


def test_the_heat_ramp_is_the_scale_itself() -> None:
    np.testing.assert_allclose(heat_ramp(7), heat_colours(np.linspace(0, 1, 7), 0.0, 1.0))


def test_an_empty_or_nested_scale_is_refused() -> None:
    with pytest.raises(ParameterError, match="high: 1 must be above low = 1"):
        heat_colours([0.0], 1.0, 1.0)
    with pytest.raises(ShapeError, match="values: expected shape"):
        heat_colours([[0.0]], 0.0, 1.0)


@pytest.mark.parametrize(
    ("names", "other"),
    [
        (("skin", "Head_Skin", "eyelid_upper", "eye_socket"), "eye_left"),
        (("lips", "LipLower", "vermilion"), "skin"),
        (("teeth_upper", "Tooth.001", "upperTeeth"), "gums"),
        (("eye_left", "sclera", "Eyeball"), "iris"),
        (("lashes_left", "eyelashes", "EyeLash"), "eye_left"),
        (("mouth_inside", "mouthBag", "oral_cavity"), "lips"),
        (("gums", "gums_tongue"), "tongue"),
        (("mandible", "skull"), "teeth"),
        (("thing", "", "1234"), "skin"),
    ],
)
def test_materials_are_known_by_the_words_in_their_names(
    names: tuple[str, ...], other: str
) -> None:
    assert len({colour_of_material(name) for name in names}) == 1
    assert colour_of_material(names[0]) != colour_of_material(other)


def test_every_look_makes_a_surface() -> None:
    shape = ball(4)
    for name in ("skin", "lips", "teeth", "lashes", "eye", "iris", "pupil", "muscle", "unknown"):
        surface = Surface(shape.positions, shape.faces, **look_of_material(name))
        assert tuple(surface.colour_array) == colour_of_material(name)
    assert look_of_material("lashes")["opacity"] < 1.0
    assert colour_of_material("skin") == SKIN


@given(st.integers(0, 2**16))
def test_a_painted_eye_looks_where_it_is_told(seed: int) -> None:
    draw = np.random.default_rng(seed)
    axis = draw.normal(size=3)
    axis /= np.linalg.norm(axis)
    shape = ball(12, radius=12.0)
    positions = shape.positions + draw.uniform(-50.0, 50.0, 3)
    place, ramp = eye_paint(positions, forward=5.0 * axis)
    angle = np.degrees(np.arccos(np.clip(shape.positions @ axis / 12.0, -1.0, 1.0)))
    found = np.degrees(np.arctan2(np.hypot(place[:, 0], place[:, 1]), place[:, 2]))
    np.testing.assert_allclose(found, angle, atol=1e-4)
    at = np.rint(np.array([0.0, 20.0, 50.0]) / 180.0 * (len(ramp) - 1)).astype(int)
    pupil, iris, white = ramp[at].sum(axis=1)
    assert pupil < 0.3 * iris < 0.3 * white
    Surface(positions, shape.faces, colour=place, ramp=ramp)


def test_the_iris_is_round_on_a_coarse_eyeball() -> None:
    # Six faces around: places blended between the corners would make a hexagon of the iris.
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    shape = ball(3, radius=12.0)
    positions = shape.positions @ turn.T
    place, ramp = eye_paint(positions)
    eye = Surface(positions, shape.faces, colour=place, ramp=ramp, specular=0.0)
    picture = render([eye], AHEAD, size=(120, 120), lights=PLAIN)
    inside = np.hypot(*(np.mgrid[:120, :120] - 59.5)) < 28.0
    iris = inside & (picture[:, :, 2] > 1.1 * picture[:, :, 0])
    row, column = np.nonzero(iris)
    away = np.hypot(row - 59.5, column - 59.5)
    bearing = np.arctan2(row - 59.5, column - 59.5)
    rim = [
        away[np.abs(np.angle(np.exp(1j * (bearing - at)))) < 0.15].max()
        for at in np.linspace(0, 2 * np.pi, 12, endpoint=False)
    ]
    assert min(rim) > 0.9 * max(rim)


def test_an_eye_without_a_direction_is_refused() -> None:
    with pytest.raises(ShapeError, match="forward direction"):
        eye_paint(ball(4).positions, forward=(0.0, 0.0, 0.0))
    with pytest.raises(ShapeError, match="at least 4 positions"):
        eye_paint(np.eye(3))
    with pytest.raises(ShapeError, match="iris: expected shape"):
        eye_paint(ball(4).positions, iris=(0.1, 0.2))
    with pytest.raises(ParameterError, match="pupil_degrees: 30 is above 20"):
        eye_paint(ball(4).positions, iris_degrees=20.0, pupil_degrees=30.0)


@given(st.floats(1.0, 80.0), st.floats(0.0, 1.0))
def test_every_iris_ends_in_white(iris_degrees: float, share: float) -> None:
    _, ramp = eye_paint(
        ball(4).positions, iris_degrees=iris_degrees, pupil_degrees=share * iris_degrees
    )
    outside = ramp[int(np.ceil((iris_degrees + 2.0) * 4))]
    assert outside.min() > 0.4 and ramp.min() >= 0.0 and ramp.max() <= 1.0
