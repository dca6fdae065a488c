"""Lines and dots over pictures."""

import numpy as np
import pytest

from risorius.errors import ParameterError, ShapeError
from risorius.render import Camera, Marker, Overlay, Polyline, display_rgb, render
from tests.render.scenes import AHEAD, BLACK, PLAIN, WHITE, square

GREEN = (0.0, 1.0, 0.0)
SIZE = (80, 80)


def drawn(*overlays: Overlay, walls: int = 0, size: tuple[int, int] = SIZE) -> np.ndarray:
    scene = [square(half=40.0, z=0.0, colour=BLACK, specular=0.0)][:walls]
    return render(scene, AHEAD, size=size, lights=PLAIN, background=BLACK, overlays=overlays)


def test_a_dot_has_its_place_its_colour_and_its_area() -> None:
    place = np.array([[4.0, 6.0, 10.0]])
    picture = drawn(Marker(place, colour=GREEN, width=12.0))
    x, y, _ = AHEAD.project(place, SIZE)[0]
    weight = picture[:, :, 1] / 255.0
    assert weight.sum() == pytest.approx(np.pi * 36.0, rel=0.01)
    rows, columns = np.mgrid[:80, :80] + 0.5
    assert (weight * columns).sum() / weight.sum() == pytest.approx(x, abs=0.02)
    assert (weight * rows).sum() / weight.sum() == pytest.approx(y, abs=0.02)
    assert (picture[int(y), int(x)] == display_rgb(GREEN)).all()


def test_a_line_covers_its_length_times_its_width() -> None:
    line = np.array([[-10.0, -8.0, 0.0], [10.0, 8.0, 0.0]])
    ends = AHEAD.project(line, SIZE)[:, :2]
    weight = drawn(Polyline(line, colour=GREEN, width=3.0))[:, :, 1] / 255.0
    expected = 3.0 * np.linalg.norm(ends[1] - ends[0]) + np.pi * 1.5**2
    assert weight.sum() == pytest.approx(expected, rel=0.02)


def test_what_is_behind_a_surface_is_hidden_or_faint() -> None:
    behind, before = np.array([[0.0, 0.0, -10.0]]), np.array([[0.0, 0.0, 10.0]])
    assert not drawn(Marker(behind, colour=GREEN, width=9.0), walls=1).any()
    front = drawn(Marker(before, colour=GREEN, width=9.0), walls=1)
    faint = drawn(Marker(behind, colour=GREEN, width=9.0, hidden_opacity=0.4), walls=1)
    assert front[40, 40, 1] == 255
    assert faint[40, 40, 1] == pytest.approx(0.4 * 255, abs=1)


def test_a_point_on_the_surface_itself_is_in_view() -> None:
    on_it = drawn(Marker(np.zeros((1, 3)), colour=GREEN, width=9.0), walls=1)
    free = drawn(Marker(np.zeros((1, 3)), colour=GREEN, width=9.0))
    np.testing.assert_array_equal(on_it, free)


def test_a_line_through_a_surface_shows_its_front_half() -> None:
    line = Polyline(np.array([[-12.0, 0.0, -12.0], [12.0, 0.0, 12.0]]), colour=GREEN, width=3.0)
    row = drawn(line, walls=1)[40, :, 1] > 128
    assert not row[:38].any()
    assert row[44:60].all()


def test_a_faint_line_is_not_denser_where_its_pieces_meet() -> None:
    points = np.column_stack([np.linspace(-9.0, 9.0, 40), np.zeros(40), np.zeros(40)])
    many = drawn(Polyline(points, colour=GREEN, width=4.0, opacity=0.5))
    one = drawn(Polyline(points[[0, -1]], colour=GREEN, width=4.0, opacity=0.5))
    assert np.abs(many.astype(int) - one).max() <= 1
    assert one.max() == pytest.approx(128, abs=1)


def test_later_overlays_lie_on_top() -> None:
    dots = [Marker(np.zeros((1, 3)), colour=colour, width=9.0) for colour in (GREEN, WHITE)]
    assert (drawn(*dots)[40, 40] == 255).all()
    assert (drawn(*dots[::-1])[40, 40] == [0, 255, 0]).all()


def test_a_line_that_runs_past_the_eye_is_cut() -> None:
    ahead = np.array([[3.0, 0.0, 0.0], [3.0, 0.0, 500.0]])
    weight = drawn(Polyline(ahead, colour=GREEN, width=3.0))[:, :, 1]
    x = AHEAD.project(ahead[:1], SIZE)[0, 0]
    behind = np.array([0.0, 0.0, 200.0])
    assert (weight[40, int(x) + 1 :] == 255).all()
    assert not weight[:, : int(x) - 3].any()
    assert not drawn(Polyline(ahead + behind, colour=GREEN)).any()
    assert not drawn(Marker(ahead[1:], colour=GREEN)).any()


def test_overlays_off_the_picture_or_empty_draw_nothing() -> None:
    off = np.array([[1e6, 0.0, 0.0], [1e6, 10.0, 0.0]])
    nothing = [Polyline(np.zeros((1, 3))), Polyline(np.zeros((0, 3))), Marker(np.zeros((0, 3)))]
    assert not drawn(Polyline(off), Marker(-off), Marker(off[:, ::-1]), *nothing).any()
    assert not drawn(Marker(np.zeros((1, 3)), width=0.0), size=(9, 9)).any()


def test_overlays_do_not_depend_on_supersampling_in_free_view() -> None:
    camera = Camera.framing(np.eye(3))
    line = [Polyline(np.eye(3), colour=GREEN, width=2.5)]
    one, other = (render([], camera, size=(30, 30), supersample=k, overlays=line) for k in (1, 3))
    np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize(
    ("look", "error", "message"),
    [
        ({"positions": [[0.0, np.inf, 0.0]]}, ShapeError, "positions: row 0"),
        ({"colour": (1.0, 0.0)}, ShapeError, "colour: expected shape"),
        ({"width": -1.0}, ParameterError, "width: -1 is below 0"),
        ({"hidden_opacity": 2.0}, ParameterError, "hidden_opacity: 2 is above 1"),
    ],
)
def test_bad_overlays_are_refused(look: dict, error: type, message: str) -> None:
    with pytest.raises(error, match=message):
        Marker(**({"positions": np.zeros((1, 3))} | look))
