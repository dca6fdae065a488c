"""Pictures."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ParameterError, ShapeError
from risorius.render import BACKDROP, Camera, Lights, Surface, bands, display_rgb, render
from tests.render.scenes import AHEAD, BLACK, PLAIN, WHITE, ball, linear, square

MATT = {"specular": 0.0}


def head_like() -> Surface:
    """Return a ball with a nose on its left half and a dent on its right."""
    shape = ball(32)
    way = shape.positions / 10.0
    bump = 4.0 * np.exp(-30.0 * ((way - [0.4, 0.1, 0.9]) ** 2).sum(axis=1))
    dent = 5.0 * np.exp(-20.0 * ((way - [-0.5, 0.2, 0.8]) ** 2).sum(axis=1))
    return replace(shape, positions=shape.positions + way * (bump - dent)[:, None])


def mirrored(surface: Surface) -> Surface:
    return replace(
        surface, positions=surface.positions * [-1.0, 1.0, 1.0], faces=surface.faces[:, ::-1]
    )


def test_repeated_runs_give_the_same_bytes_with_any_number_of_threads(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene = [head_like(), square(half=14.0, z=4.0, opacity=0.4)]
    pictures = []
    for workers in (1, 1, 2, 5):
        monkeypatch.setattr(bands, "_cpu_count", lambda count=workers: count)
        pictures.append(render(scene, AHEAD, size=(150, 140)).tobytes())
    assert len(set(pictures)) == 1


def test_an_empty_scene_is_the_background_from_top_to_bottom() -> None:
    picture = render([], AHEAD, size=(9, 200))
    assert picture.shape == (200, 9, 3) and picture.dtype == np.uint8
    assert (picture == picture[:, :1]).all()
    ends = display_rgb(BACKDROP).astype(int)
    assert np.abs(picture[[0, -1], 0].astype(int) - ends).max() <= 1
    assert (np.diff(picture[:, 0].astype(int), axis=0) <= 0).all()


def test_one_background_colour_fills_the_picture() -> None:
    picture = render([], AHEAD, size=(5, 4), background=(0.2, 0.5, 1.0))
    assert (picture == display_rgb((0.2, 0.5, 1.0))).all()


def test_a_mirrored_scene_gives_the_mirrored_picture() -> None:
    shape = head_like()
    one = render([shape], AHEAD, size=(120, 120)).astype(float)
    other = render([mirrored(shape)], AHEAD, size=(120, 120), lights=Lights().mirrored())
    gap = np.abs(one - other[:, ::-1])
    assert gap.mean() < 0.5
    assert np.quantile(gap, 0.99) < 6.0
    # The scene is lopsided enough for the comparison to mean something.
    assert np.abs(one - one[:, ::-1]).mean() > 4.0


def test_the_lights_travel_with_the_camera() -> None:
    shape = head_like()
    turn = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    camera = Camera(AHEAD.eye @ turn.T, AHEAD.target, AHEAD.up, AHEAD.fov_degrees)
    turned = replace(shape, positions=shape.positions @ turn.T)
    one = render([shape], AHEAD, size=(80, 80)).astype(int)
    assert np.abs(one - render([turned], camera, size=(80, 80))).max() <= 1


def test_a_transparent_surface_mixes_front_and_back_by_its_opacity() -> None:
    far_away = Camera(np.array([0.0, 0.0, 1000.0]), np.zeros(3), np.array([0.0, 1.0, 0.0]), 0.5)

    def middle(*surfaces: Surface) -> np.ndarray:
        picture = render(surfaces, far_away, size=(9, 9), lights=PLAIN, background=(0.1, 0.3, 0.2))
        return linear(picture[4, 4])

    front = square(z=5.0, colour=(0.7, 0.1, 0.1), **MATT)
    back = square(z=-5.0, colour=(0.1, 0.2, 0.6), **MATT)
    for opacity in (0.0, 0.25, 0.8):
        thin = replace(front, opacity=opacity)
        expected = opacity * middle(front) + (1.0 - opacity) * middle(back)
        np.testing.assert_allclose(middle(thin, back), expected, atol=0.006)
        expected = opacity * middle(front) + (1.0 - opacity) * np.array([0.1, 0.3, 0.2])
        np.testing.assert_allclose(middle(thin), expected, atol=0.006)
    # Half of the red, then half of the blue through it, then what is left of the backdrop.
    thin, thin_back = replace(front, opacity=0.5), replace(back, opacity=0.5)
    expected = 0.5 * middle(front) + 0.25 * middle(back) + 0.25 * np.array([0.1, 0.3, 0.2])
    np.testing.assert_allclose(middle(thin_back, thin), expected, atol=0.006)


def test_the_order_of_transparent_surfaces_does_not_matter() -> None:
    colours = [(0.8, 0.1, 0.1), (0.1, 0.8, 0.1), (0.1, 0.1, 0.8)]
    layers = [
        square(z=z, half=6.0 + z, colour=colour, opacity=0.5)
        for z, colour in zip((-3.0, 0.0, 3.0), colours, strict=True)
    ]
    scene = [*layers, square(z=-8.0, half=12.0)]
    one = render(scene, AHEAD, size=(60, 60))
    np.testing.assert_array_equal(one, render(scene[::-1], AHEAD, size=(60, 60)))
    swapped = [
        replace(layers[0], colour=colours[2]),
        layers[1],
        replace(layers[2], colour=colours[0]),
    ]
    assert (one[30, 30] != render([*swapped, scene[3]], AHEAD, size=(60, 60))[30, 30]).any()


def test_a_transparent_surface_behind_an_opaque_one_is_hidden() -> None:
    front = square(z=5.0)
    picture = render([front], AHEAD, size=(30, 30))
    behind = square(z=-5.0, half=8.0, opacity=0.5)
    np.testing.assert_array_equal(render([behind, front], AHEAD, size=(30, 30)), picture)


def test_back_faces_are_darker_than_front_faces() -> None:
    front = square(**MATT)
    back = replace(front, faces=front.faces[:, ::-1])
    seen = [
        linear(render([side], AHEAD, size=(9, 9), lights=PLAIN)[4, 4]).sum()
        for side in (front, back)
    ]
    assert 0.2 * seen[0] < seen[1] < 0.5 * seen[0]


def pit(depth: float) -> Surface:
    """Return a plate with a square hole of half-width 3 and a bottom `depth` below."""
    ring = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
    levels = [(16.0, 0.0), (3.0, 0.0), (3.0, -depth)]
    positions = np.array([[half * x, half * y, z] for half, z in levels for x, y in ring])
    faces = [[8, 9, 10], [8, 10, 11]]
    for level in (0, 4):
        for k in range(4):
            a, b, c, d = level + k, level + (k + 1) % 4, level + 4 + (k + 1) % 4, level + 4 + k
            faces += [[a, b, c], [a, c, d]]
    return Surface(positions, np.array(faces), smooth=False, **MATT)


def test_deep_holes_read_dark_and_open_faces_do_not() -> None:
    lights = Lights(occlusion_radius=8.0)

    def bottom_and_plate(depth: float, strength: float) -> np.ndarray:
        shade = replace(lights, occlusion=strength)
        picture = linear(render([pit(depth)], AHEAD, size=(101, 101), lights=shade))
        return picture[[50, 50], [50, 85]].sum(axis=1)

    plain, deep, flat = (bottom_and_plate(*at) for at in ((12.0, 0.0), (12.0, 1.0), (0.01, 1.0)))
    assert plain[0] == pytest.approx(plain[1], rel=0.05)
    assert deep[0] < 0.35 * deep[1]
    assert deep[1] == pytest.approx(plain[1], rel=0.05)
    assert flat[0] == pytest.approx(plain[0], rel=0.05)


def test_a_ramp_keeps_an_edge_sharper_than_the_mesh() -> None:
    place = np.array([0.0, 1.0, 1.0, 0.0])
    ramp = np.array([BLACK] * 50 + [WHITE] * 50)
    look = {**MATT, "smooth": False}
    stepped = render([square(colour=place, ramp=ramp, **look)], AHEAD, size=(64, 64))[32]
    blended = render([square(colour=np.outer(place, WHITE), **look)], AHEAD, size=(64, 64))[32]

    def between(row: np.ndarray) -> int:
        inside = row[16:48].astype(int).sum(axis=1)
        return int(((inside > 40) & (inside < inside.max() - 40)).sum())

    assert between(stepped) <= 2
    assert between(blended) > 15


def test_vertex_face_and_uniform_colours_agree_where_they_say_the_same() -> None:
    tone = np.array([0.3, 0.5, 0.2])
    pictures = [
        render([square(colour=colour)], AHEAD, size=(40, 40), supersample=1)
        for colour in (tone, np.tile(tone, (4, 1)), np.tile(tone, (2, 1)))
    ]
    for other in pictures[1:]:
        assert np.abs(pictures[0].astype(int) - other).max() <= 1


def test_face_colours_do_not_bleed() -> None:
    colour = np.array([[0.9, 0.0, 0.0], [0.0, 0.0, 0.9]])
    picture = render([square(colour=colour, **MATT)], AHEAD, size=(40, 40), lights=PLAIN)
    assert picture[26, 24, 0] > 100 and picture[26, 24, 2] < 20
    assert picture[14, 16, 2] > 100 and picture[14, 16, 0] < 20


def test_given_normals_replace_the_computed_ones() -> None:
    lamp = replace(PLAIN, sky=BLACK, ground=BLACK)
    upright = square(**MATT)
    away = replace(upright, normals=np.tile([0.0, -1.0, -0.1], (4, 1)))
    one, other = (
        render([shape], AHEAD, size=(9, 9), lights=lamp)[4, 4].sum() for shape in (upright, away)
    )
    assert other < 0.3 * one
    flat = render([replace(away, smooth=False)], AHEAD, size=(9, 9), lights=lamp)[4, 4].sum()
    assert flat == one


@pytest.mark.parametrize("supersample", [2, 3, 4])
def test_a_pixel_on_an_outline_is_the_mean_of_its_samples(supersample: int) -> None:
    look = {"colour": WHITE, "smooth": False, **MATT}
    fine = (40 * supersample, 40 * supersample)
    samples = linear(render([ball(12, **look)], AHEAD, size=fine, supersample=1, lights=PLAIN))
    mean = samples.reshape(40, supersample, 40, supersample, 3).mean(axis=(1, 3))
    picture = render(
        [ball(12, **look)], AHEAD, size=(40, 40), supersample=supersample, lights=PLAIN
    )
    np.testing.assert_allclose(linear(picture), mean, atol=0.01)


def test_few_samples_do_for_smooth_insides() -> None:
    # Vertex colours switch the short cut off: the same picture with and without it.
    tone = np.array([0.6, 0.4, 0.3])
    quick = render([ball(48, colour=tone)], AHEAD, size=(90, 90)).astype(int)
    shape = ball(48, colour=np.tile(tone, (len(ball(48).positions), 1)))
    slow = render([replace(shape, smooth=True)], AHEAD, size=(90, 90))
    assert np.abs(quick - slow).max() <= 3


@given(st.integers(1, 50), st.integers(1, 50), st.integers(1, 4))
def test_any_size_works(width: int, height: int, supersample: int) -> None:
    picture = render([ball(6)], AHEAD, size=(width, height), supersample=supersample)
    assert picture.shape == (height, width, 3)


def test_triangles_around_and_behind_the_eye_are_drawn_where_they_are_in_view() -> None:
    inside = Camera(np.array([0.0, 1.0, 2.0]), np.zeros(3), np.array([0.0, 1.0, 0.0]), 100.0)
    room = ball(10, radius=20.0)
    picture = render([room, square(z=90.0)], inside, size=(50, 40), background=WHITE)
    assert (picture < 250).all()


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"size": (0, 4)}, ParameterError, "size: 0 x 4"),
        ({"supersample": 9}, ParameterError, "supersample: 9 is above 4"),
        ({"supersample": 1.5}, ParameterError, "supersample: 1.5 is not a whole number"),
        ({"background": (1.0, 2.0)}, ShapeError, "background: expected shape"),
        ({"background": (9.0, 0.0, 0.0)}, ParameterError, "background: linear colours"),
    ],
)
def test_bad_options_are_refused(options: dict, error: type, message: str) -> None:
    with pytest.raises(error, match=message):
        render([], AHEAD, **({"size": (4, 4)} | options))


def test_bad_lights_are_refused() -> None:
    with pytest.raises(ParameterError, match="occlusion: 2 is above 1"):
        Lights(occlusion=2.0)
    dark = replace(Lights().key, towards=(0.0, 0.0, 0.0))
    with pytest.raises(ParameterError, match=r"towards: .* is not a direction"):
        render([], AHEAD, size=(4, 4), lights=Lights(key=dark))
