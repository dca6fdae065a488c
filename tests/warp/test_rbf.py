"""Warps by radial basis functions."""

from __future__ import annotations

import pickle
import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ParameterError, RisoriusWarning, ShapeError, SolverError
from risorius.warp import kernels
from risorius.warp.centres import nearest_distances
from risorius.warp.rbf import RbfWarp
from risorius.warp.similarity import fit_affine
from tests.mesh.shapes import rotation

SEEDS = st.integers(0, 2**32 - 1)
# Order 2 kernels need at least the plane.
CHOICES = [
    (kernel, polynomial)
    for kernel in kernels.KERNELS
    for polynomial in ("affine", "in_plane", "similarity", "none")
    if kernels.KERNELS[kernel].order == 1 or polynomial in ("affine", "in_plane")
]
every_choice = pytest.mark.parametrize(("kernel", "polynomial"), CHOICES)
every_kernel = pytest.mark.parametrize("kernel", kernels.KERNELS)


def pairs(count: int = 25, seed: int = 0, size: float = 80.0) -> tuple[np.ndarray, np.ndarray]:
    """Return landmarks of a head and of a moderately different one."""
    generator = np.random.default_rng(seed)
    source = size * generator.uniform(-1, 1, size=(count, 3))
    return source, 1.1 * source + 0.1 * size * generator.normal(size=source.shape)


@every_choice
def test_centres_meet_their_targets(kernel: str, polynomial: str):
    source, target = pairs()
    warp = RbfWarp.fit(source, target, kernel=kernel, polynomial=polynomial)
    np.testing.assert_allclose(warp(source), target, atol=1e-9 * 80)
    assert warp.residual < 1e-9 * 80


@given(SEEDS, st.integers(4, 40))
def test_multiquadrics_interpolate_whatever_the_points(seed: int, count: int):
    source, target = pairs(count, seed)
    np.testing.assert_allclose(RbfWarp.fit(source, target)(source), target, atol=1e-7)


@every_kernel
@given(seed=SEEDS)
def test_affine_maps_are_reproduced(kernel: str, seed: int):
    generator = np.random.default_rng(seed)
    linear, shift = generator.normal(size=(3, 3)), 100.0 * generator.normal(size=3)
    source = generator.normal(size=(20, 3))
    points = 3.0 * generator.normal(size=(30, 3))
    warp = RbfWarp.fit(source, source @ linear.T + shift, kernel=kernel)
    np.testing.assert_allclose(warp(points), points @ linear.T + shift, atol=1e-9)
    np.testing.assert_allclose(warp.jacobian(points), np.stack([linear] * 30), atol=1e-9)


@every_choice
def test_similarities_are_reproduced_unless_there_is_no_polynomial(kernel: str, polynomial: str):
    generator = np.random.default_rng(0)
    source, points = generator.normal(size=(20, 3)), 3.0 * generator.normal(size=(30, 3))
    linear = 2.0 * rotation(generator)
    warp = RbfWarp.fit(source, source @ linear.T + 7.0, kernel=kernel, polynomial=polynomial)
    error = np.abs(warp(points) - points @ linear.T - 7.0).max()
    assert (error < 1e-9) == (polynomial != "none")


@every_choice
def test_warp_turns_scales_and_moves_with_source_and_target(kernel: str, polynomial: str):
    generator = np.random.default_rng(1)
    source, target = pairs()
    points = 100.0 * generator.normal(size=(30, 3))
    rest = RbfWarp.fit(source, target, kernel=kernel, polynomial=polynomial)(points)
    for scale in (1e-3, 1.0, 1e3):
        first, second = rotation(generator), rotation(generator)
        shift = 500.0 * generator.normal(size=(2, 3))
        moved = RbfWarp.fit(
            scale * (source @ first.T + shift[0]),
            7.0 * (target @ second.T + shift[1]),
            kernel=kernel,
            polynomial=polynomial,
        )
        np.testing.assert_allclose(
            moved(scale * (points @ first.T + shift[0])),
            7.0 * (rest @ second.T + shift[1]),
            atol=1e-6,
        )


@every_kernel
def test_smoothing_means_the_same_in_every_unit(kernel: str):
    source, target = pairs()
    points = source + 5.0
    rest = RbfWarp.fit(source, target, kernel=kernel, regularisation=0.1)(points)
    metres = RbfWarp.fit(source / 1e3, target / 1e3, kernel=kernel, regularisation=0.1)
    np.testing.assert_allclose(1e3 * metres(points / 1e3), rest, atol=1e-8)


@every_kernel
def test_more_regularisation_misses_more(kernel: str):
    source, target = pairs()
    missed = [
        float(
            np.linalg.norm(
                RbfWarp.fit(source, target, kernel=kernel, radii=20.0, regularisation=share)(source)
                - target
            )
        )
        for share in (0.0, 1e-3, 1e-2, 0.1, 1.0, 10.0, 1e4)
    ]
    assert missed == sorted(missed)
    assert missed[0] < 1e-6 < missed[1]
    assert len(set(missed)) == len(missed)


@every_kernel
def test_endless_regularisation_leaves_the_best_affine_map(kernel: str):
    source, target = pairs()
    points = 2.0 * source[::2]
    warp = RbfWarp.fit(source, target, kernel=kernel, regularisation=1e9)
    np.testing.assert_allclose(warp(points), fit_affine(source, target).apply(points), atol=1e-4)


def test_an_outlier_can_be_smoothed_alone():
    source, _ = pairs()
    target = 1.5 * source + 3.0
    target[4] += 60.0
    smoothing = np.zeros(len(source))
    smoothing[4] = 1e9
    warp = RbfWarp.fit(source, target, regularisation=smoothing)
    np.testing.assert_allclose(warp(source), 1.5 * source + 3.0, atol=1e-4)


@every_choice
def test_jacobian_is_the_derivative(kernel: str, polynomial: str):
    source, target = pairs()
    warp = RbfWarp.fit(source, target, kernel=kernel, polynomial=polynomial)
    points = 60.0 * np.random.default_rng(2).normal(size=(10, 3))
    step = 1e-3
    numeric = np.stack(
        [
            (warp(points + step * axis) - warp(points - step * axis)) / (2 * step)
            for axis in np.eye(3)
        ],
        axis=2,
    )
    np.testing.assert_allclose(warp.jacobian(points), numeric, atol=1e-6)


def test_chunks_do_not_show(monkeypatch: pytest.MonkeyPatch):
    source, target = pairs()
    points = 100.0 * np.random.default_rng(3).normal(size=(501, 3))
    warp = RbfWarp.fit(source, target)
    whole, slopes = warp(points), warp.jacobian(points)
    monkeypatch.setattr(kernels, "_PAIRS_AT_ONCE", 7 * len(source))
    assert len(list(kernels.blocks(501, len(source)))) == 72
    np.testing.assert_allclose(warp(points), whole, atol=1e-11)
    np.testing.assert_allclose(warp.jacobian(points), slopes, atol=1e-13)


def test_radii_default_to_the_nearest_other_centre():
    source, target = pairs()
    warp = RbfWarp.fit(source, target)
    gaps = np.linalg.norm(source[:, None] - source, axis=2) + np.diag([np.inf] * len(source))
    np.testing.assert_allclose(warp.radii, gaps.min(axis=1))
    given_radii = RbfWarp.fit(source, target, radii=gaps.min(axis=1))
    points = source + 3.0
    np.testing.assert_allclose(given_radii(points), warp(points), atol=1e-9)
    assert np.abs(RbfWarp.fit(source, target, radii=40.0)(points) - warp(points)).max() > 0.1


def test_multiquadrics_follow_the_published_formula():
    source, target = pairs(8)
    r = nearest_distances(source)
    phi = np.sqrt(np.linalg.norm(source[:, None] - source, axis=2) ** 2 + r**2)
    t = np.column_stack([source, np.ones(8)])
    system = np.block([[phi, t], [t.T, np.zeros((4, 4))]])
    solution = np.linalg.solve(system, np.vstack([target, np.zeros((4, 3))]))
    points = source + np.array([4.0, -3.0, 9.0])
    kernel = np.sqrt(np.linalg.norm(points[:, None] - source, axis=2) ** 2 + r**2)
    expected = kernel @ solution[:8] + np.column_stack([points, np.ones(8)]) @ solution[8:]
    np.testing.assert_allclose(RbfWarp.fit(source, target)(points), expected, atol=1e-8)


# Degenerate centres


def test_coincident_centres_with_one_target_count_once():
    source, target = pairs()
    rest = RbfWarp.fit(source, target)(source + 5.0)
    again = [3, 3, 7]
    with pytest.warns(RisoriusWarning, match="3 source point"):
        warp = RbfWarp.fit(
            np.concatenate([source, source[again]]), np.concatenate([target, target[again]])
        )
    assert len(warp.centres) == len(source)
    np.testing.assert_allclose(warp(source + 5.0), rest, atol=1e-9)


def test_coincident_centres_with_two_targets_are_named():
    source, target = pairs()
    source[9] = source[2]
    with pytest.raises(
        ParameterError, match=r"points 2 and 9 lie at one place .* correct or remove"
    ):
        RbfWarp.fit(source, target)


@pytest.mark.parametrize("kernel", ["multiquadric", "biharmonic", "thin_plate", "triharmonic"])
def test_centres_in_a_plane_interpolate_with_a_warning(kernel: str):
    generator = np.random.default_rng(0)
    turn = rotation(generator)
    source = (60.0 * generator.uniform(-1, 1, size=(12, 3)) * [1, 1, 0]) @ turn.T + 20.0
    target = 1.2 * source + 5.0 * generator.normal(size=source.shape)
    with pytest.warns(RisoriusWarning, match="the 12 centres lie in one plane"):
        warp = RbfWarp.fit(source, target, kernel=kernel)
    np.testing.assert_allclose(warp(source), target, atol=1e-8)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        asked_for = RbfWarp.fit(source, target, kernel=kernel, polynomial="in_plane")
    points = source + 3.0
    np.testing.assert_allclose(asked_for(points), warp(points), atol=1e-9)


def test_a_flat_contour_keeps_the_direction_across():
    # A similarity of flat centres moves also the points above and below the plane.
    generator = np.random.default_rng(0)
    flat = generator.normal(size=(10, 3)) * [1, 1, 0]
    linear = 1.7 * rotation(generator)
    warp = RbfWarp.fit(flat, flat @ linear.T + 4.0, polynomial="in_plane")
    points = generator.normal(size=(20, 3))
    np.testing.assert_allclose(warp(points), points @ linear.T + 4.0, atol=1e-9)


def test_affine_maps_within_the_plane_are_reproduced():
    generator = np.random.default_rng(0)
    flat = generator.normal(size=(10, 3)) * [1, 1, 0]
    linear = np.array([[4, 1, 0], [0, 1, 0], [0.5, 0, 1.0]])
    warp = RbfWarp.fit(flat, flat @ linear.T, polynomial="in_plane")
    points = generator.normal(size=(20, 3)) * [1, 1, 0]
    np.testing.assert_allclose(warp(points), points @ linear.T, atol=1e-9)


@pytest.mark.parametrize("kernel", ["multiquadric", "thin_plate"])
def test_centres_on_a_line_interpolate_with_a_warning(kernel: str):
    source = np.outer([0.0, 1, 3, 4, 8], [1, 2, -1])
    target = source + np.random.default_rng(0).normal(size=source.shape)
    with pytest.warns(RisoriusWarning, match="the 5 centres lie on one line"):
        warp = RbfWarp.fit(source, target, kernel=kernel)
    np.testing.assert_allclose(warp(source), target, atol=1e-9)
    assert np.isfinite(warp([[5, 5, 5]])).all()


def test_a_single_point_moves_everything_along():
    with pytest.warns(RisoriusWarning, match="1 point"):
        warp = RbfWarp.fit([[1, 2, 3]], [[2, 2, 2]])
    np.testing.assert_allclose(warp([[0, 0, 0], [9, 9, 9]]), [[1, 0, -1], [10, 9, 8]])
    np.testing.assert_array_equal(warp.jacobian([[0, 0, 0]]), [np.eye(3)])


@pytest.mark.parametrize("count", [2, 3])
def test_fewer_than_four_points_give_a_similarity_only(count: int):
    source, _ = pairs(count)
    linear = 2.0 * rotation(np.random.default_rng(5))
    target = source @ linear.T + 9.0
    with pytest.warns(RisoriusWarning, match="give at least four"):
        warp = RbfWarp.fit(source, target)
    np.testing.assert_allclose(warp(source), target, atol=1e-10)
    lengths = np.linalg.norm(warp([[1, 0, 0], [0, 1, 0], [0, 0, 1]]) - warp([[0, 0, 0]]), axis=1)
    np.testing.assert_allclose(lengths, 2.0)
    np.testing.assert_array_equal(warp.coefficients, 0.0)


def test_a_warp_that_misses_is_refused():
    # Cubic kernels of centres that nearly coincide lose all digits.
    generator = np.random.default_rng(0)
    cluster = 1e-7 * generator.normal(size=(10, 3))
    source = np.concatenate([generator.normal(size=(6, 3)), cluster])
    target = generator.normal(size=(16, 3))
    with pytest.raises(SolverError, match=r"misses its targets by .* add regularisation"):
        RbfWarp.fit(source, target, kernel="triharmonic")


# Refusals


@pytest.mark.parametrize("kernel", ["thin_plate", "triharmonic"])
@pytest.mark.parametrize("polynomial", ["none", "similarity"])
def test_kernels_that_need_a_polynomial_say_so(kernel: str, polynomial: str):
    with pytest.raises(ParameterError, match=f'the {kernel} kernel needs "affine" or "in_plane"'):
        RbfWarp.fit(*pairs(), kernel=kernel, polynomial=polynomial)


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"kernel": "gauss"}, ParameterError, "kernel: 'gauss' is not one of biharmonic, multi"),
        ({"polynomial": "cubic"}, ParameterError, "polynomial: 'cubic' is not one of affine"),
        ({"radii": "largest"}, ParameterError, "radii: 'largest' is not one of nearest"),
        ({"radii": -1.0}, ParameterError, "radii: must be finite and at least 0"),
        ({"radii": np.ones(3)}, ShapeError, r"radii: expected a number or shape \(25,\)"),
        ({"regularisation": np.nan}, ParameterError, "regularisation: must be finite"),
        ({"regularisation": np.ones(3)}, ShapeError, "regularisation: expected a number"),
    ],
)
def test_bad_options_are_refused(options: dict, error: type[Exception], message: str):
    with pytest.raises(error, match=message):
        RbfWarp.fit(*pairs(), **options)


def test_bad_points_are_refused():
    source, target = pairs()
    with pytest.raises(ShapeError, match="25 and 24 points do not correspond"):
        RbfWarp.fit(source, target[:-1])
    with pytest.raises(ShapeError, match=r"source: expected shape \(n, 3\)"):
        RbfWarp.fit(source[:, :2], target)
    with pytest.raises(ParameterError, match="no points"):
        RbfWarp.fit(np.zeros((0, 3)), np.zeros((0, 3)))
    with pytest.raises(ShapeError, match=r"points: expected shape \(n, 3\)"):
        RbfWarp.fit(source, target)([1.0, 2.0, 3.0])
    with pytest.raises(ShapeError, match="target: row 3"):
        RbfWarp.fit(source, np.where(np.arange(25)[:, None] == 3, np.nan, target))


def test_a_warp_survives_pickling():
    source, target = pairs()
    warp = RbfWarp.fit(source, target)
    copy = pickle.loads(pickle.dumps(warp))
    np.testing.assert_array_equal(copy(source + 1.0), warp(source + 1.0))


def test_no_points_no_images():
    warp = RbfWarp.fit(*pairs())
    assert warp(np.zeros((0, 3))).shape == (0, 3)
    assert warp.jacobian(np.zeros((0, 3))).shape == (0, 3, 3)
