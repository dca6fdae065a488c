"""What each pixel sees."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from risorius.render import Camera, Surface, bands, buffers
from risorius.render.buffers import nearest, transparent_layers
from risorius.render.scene import gather
from tests.render.scenes import AHEAD, ball, square

UP = np.array([0.0, 1.0, 0.0])


def test_a_known_triangle_covers_its_pixels() -> None:
    # Focal length 100 at depth 100: one pixel is one millimetre. Pixel centres lie at half
    # integers, so the triangle with legs of 30 holds 0 + 1 + ... + 29 of them and those on
    # the long side.
    fov = 2.0 * np.degrees(np.arctan(0.5))
    camera = Camera(np.array([0.0, 0.0, 100.0]), np.zeros(3), UP, fov)
    positions = np.array([[-10.0, -10.0, 0.0], [20.0, -10.0, 0.0], [-10.0, 20.0, 0.0]])
    seen = buffers([Surface(positions, np.array([[0, 1, 2]]))], camera, (100, 100))
    column, row = np.meshgrid(np.arange(100), np.arange(100))
    right, above = column + 0.5 - 40.0, 60.0 - (row + 0.5)
    inside = (right > 0.0) & (above > 0.0) & (right + above < 30.0 - 1e-6)
    edge = np.abs(right + above - 30.0) < 1e-6
    np.testing.assert_array_equal((seen.face == 0)[~edge], inside[~edge])
    assert inside.sum() == 29 * 30 // 2
    np.testing.assert_allclose(seen.depth[inside], 100.0, rtol=1e-12)
    np.testing.assert_allclose(
        seen.bary[inside][:, 1:], np.stack([right, above], axis=2)[inside] / 30.0, atol=1e-12
    )


def test_nothing_is_seen_in_an_empty_scene() -> None:
    for surfaces in ([], [Surface(np.zeros((0, 3)), np.zeros((0, 3), int))]):
        seen = buffers(surfaces, AHEAD, (7, 5))
        assert seen.depth.shape == (5, 7)
        assert np.isinf(seen.depth).all()
        assert (seen.face == -1).all() and (seen.surface == -1).all()
        assert not seen.bary.any()


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
def test_the_nearest_surface_wins_whatever_the_order(order: tuple[int, ...]) -> None:
    layers = [square(z=5.0, half=4.0), square(z=0.0), square(z=-5.0, opacity=0.5, half=16.0)]
    seen = buffers([layers[index] for index in order], AHEAD, (64, 64))
    which = np.array(order)[seen.surface]
    assert which[32, 32] == 0 and which[32, 14] == 1 and which[32, 6] == 2
    np.testing.assert_allclose(seen.depth[32, [32, 14, 6]], [95.0, 100.0, 105.0])
    # In pixels above and below the diagonal, in every layer; face counts start anew in each.
    assert {*seen.face[[40, 24], 32], *seen.face[[50, 14], 14], *seen.face[[58, 6], 6]} == {0, 1}


def test_layers_are_empty_outside_their_rows_whatever_memory_held() -> None:
    thin = square(z=5.0, half=3.3, opacity=0.5)
    garbage = [np.full((64, 64), 7, np.int32) for _ in range(8)]
    del garbage
    scene = gather([square(z=0.0), thin], AHEAD, (64, 64))
    inverse_depth, _ = nearest(scene, 0, scene.opaque_face_count)
    layers, rows = transparent_layers(scene, inverse_depth, 3)
    assert len(layers) == 1 and 0 < rows.start < rows.stop < 64
    outside = np.delete(layers[0], np.arange(rows.start, rows.stop), axis=0)
    assert (outside == -1).all()
    assert (layers[0] >= 0).any()


@given(arrays(np.float64, (6, 3), elements=st.floats(-20.0, 20.0)), st.integers(0, 2**16))
def test_barycentric_coordinates_lead_back_to_the_pixel(corners: np.ndarray, seed: int) -> None:
    corners = corners + np.random.default_rng(seed).normal(size=corners.shape)
    surface = Surface(corners, np.array([[0, 1, 2], [3, 4, 5]]))
    seen = buffers([surface], AHEAD, (40, 30))
    hit = seen.face >= 0
    row, column = np.nonzero(hit)
    bary = seen.bary[hit]
    points = np.einsum("pk,pkd->pd", bary, corners[surface.faces[seen.face[hit]]])
    back = AHEAD.project(points, (40, 30))
    assert bary.min(initial=0.0) >= 0.0
    np.testing.assert_allclose(bary.sum(axis=1), 1.0, atol=1e-9)
    expected = np.stack([column + 0.5, row + 0.5, seen.depth[hit]], axis=1)
    np.testing.assert_allclose(back, expected, atol=1e-6)


@given(st.integers(0, 2**16), st.integers(1, 40))
def test_faces_that_share_an_edge_leave_no_gap(seed: int, count: int) -> None:
    draw = np.random.default_rng(seed)
    angle = np.sort(draw.uniform(0.0, 2.0 * np.pi, count))
    ring = np.concatenate([[[-40.0, -40.0], [40.0, -40.0], [40.0, 40.0], [-40.0, 40.0]]])
    spokes = 50.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    outline = np.concatenate([ring * 2.0, spokes * 3.0])
    outline = outline[np.argsort(np.arctan2(outline[:, 1], outline[:, 0]))]
    hub = draw.uniform(-5.0, 5.0, 2)
    flat = np.concatenate([outline, [hub]])
    depth = draw.uniform(-5.0, 5.0, len(flat))
    n = len(outline)
    faces = [[n, k, (k + 1) % n] for k in range(n)]
    surface = Surface(np.column_stack([flat, depth]), np.array(faces))
    assert (buffers([surface], AHEAD, (33, 33)).face >= 0).all()


def test_a_closed_ball_has_no_holes_and_its_round_outline() -> None:
    seen = buffers([ball(40)], AHEAD, (201, 201)).face >= 0
    column, row = np.meshgrid(np.arange(201) - 100.0, np.arange(201) - 100.0)
    focal = 100.5 / np.tan(np.radians(10.0))
    away = np.hypot(column, row)
    # The outline of a sphere of radius r at distance d lies at f tan(asin(r / d)).
    rim = focal * np.tan(np.arcsin(0.1))
    assert seen[away < 0.98 * rim].all()
    assert not seen[away > rim].any()


def test_a_floor_that_runs_through_the_eye_is_cut_not_lost() -> None:
    camera = Camera(np.array([0.0, 10.0, 0.0]), np.array([0.0, 10.0, -1.0]), UP, 60.0)
    far = 1e4
    floor = Surface(
        np.array([[-far, 0.0, -far], [0.0, 0.0, far], [far, 0.0, -far]]), np.array([[0, 1, 2]])
    )
    seen = buffers([floor], camera, (40, 40))
    assert (seen.face[:20] == -1).all()
    below = np.arange(20) + 0.5
    assert (seen.face[21:] == 0).all()
    np.testing.assert_allclose(seen.depth[21:, 20], 10.0 * camera.focal(40) / below[1:], rtol=1e-9)


def test_what_lies_behind_the_eye_is_not_seen() -> None:
    behind = square(z=150.0)
    assert (buffers([behind], AHEAD, (20, 20)).face == -1).all()
    assert (buffers([square(z=100.0 - 0.5 * AHEAD.near)], AHEAD, (20, 20)).face == -1).all()
    assert (buffers([square(z=100.0 - 2.0 * AHEAD.near)], AHEAD, (20, 20)).face >= 0).all()


@given(arrays(np.float64, (9, 3), elements=st.floats(allow_nan=False, allow_infinity=False)))
def test_no_triangle_is_too_large_or_too_thin(corners: np.ndarray) -> None:
    seen = buffers([Surface(corners, np.arange(9).reshape(3, 3))], AHEAD, (16, 16))
    hit = seen.face >= 0
    assert np.isfinite(seen.depth[hit]).all()
    assert (seen.depth[hit] >= 0.99 * AHEAD.near).all()


def test_the_number_of_threads_does_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    results = []
    for workers in (1, 2, 7):
        monkeypatch.setattr(bands, "_cpu_count", lambda count=workers: count)
        results.append(buffers([ball()], AHEAD, (150, 333)))
    for other in results[1:]:
        np.testing.assert_array_equal(results[0].face, other.face)
        np.testing.assert_array_equal(results[0].depth, other.depth)
