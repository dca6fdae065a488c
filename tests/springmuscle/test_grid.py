"""Grids below skin of a known shape: Kaehler et al. 2001, section 5."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from risorius.errors import LandmarkError, ParameterError
from risorius.mesh.core import TriMesh
from risorius.springmuscle.fit_parameters import FitParameters
from risorius.springmuscle.grid import Layout, cell_normals, find_patch, lay_out
from risorius.springmuscle.measure import FaceMeasure
from risorius.springmuscle.recipe import MuscleOutline, OutlinePoint, OutlineSettings
from risorius.springmuscle.surface import SkinSurface
from tests.springmuscle.skins import depths, fit_to, sphere, square_outline, surface_of

FAITHFUL = FitParameters.of_profile("faithful")
IMPROVED = FitParameters()
LOW, HIGH, START = 2.5, 4.0, 3.25


def test_flat_skin_needs_no_division_and_the_grid_lies_at_the_published_depth() -> None:
    surface = surface_of(lambda x, y: 0.0 * x)
    fit = fit_to(surface, FAITHFUL)
    assert fit.points.shape == (2, 2, 3)
    assert np.abs(fit.points[..., 2] + START).max() < 1e-9
    assert fit.report.passes == 1
    assert fit.report.stopped == "fits"
    assert fit.report.inside == 1.0
    # Twice the way to the skin's underside (erratum E4: the grid is the middle of the muscle).
    assert np.abs(fit.report.thickness - 2.5).max() < 1e-9


@pytest.mark.parametrize("parameters", [FAITHFUL, IMPROVED], ids=["faithful", "improved"])
def test_on_a_sphere_every_sample_lies_in_the_layer(parameters: FitParameters) -> None:
    surface = surface_of(sphere(70.0))
    fit = fit_to(surface, parameters)
    report = fit.report
    assert report.passes <= 12
    assert ((report.near == 0.0) & (report.far == 0.0)).mean() >= 0.95
    assert (report.thickness >= 1.0).all()
    assert (report.thickness <= 4.0).all()
    middle = 0.25 * (
        fit.points[1:, 1:] + fit.points[:-1, 1:] + fit.points[1:, :-1] + fit.points[:-1, :-1]
    ).reshape(-1, 3)
    normals = middle + [0.0, 0.0, 70.0]
    depth = depths(surface, middle, normals / np.linalg.norm(normals, axis=1, keepdims=True))
    assert (depth > LOW - 0.05).all()
    assert (depth < HIGH + 0.05).all()


def test_the_smaller_the_sphere_the_more_cells() -> None:
    counts = []
    for radius in (2000.0, 300.0, 120.0, 70.0):
        fit = fit_to(surface_of(sphere(radius)), FAITHFUL)
        counts.append(fit.report.near.size)
    assert counts == sorted(counts)
    assert counts[0] == 1
    assert counts[-1] >= 9


def test_finer_skin_has_at_least_as_many_cells_and_coarse_skin_is_not_divided() -> None:
    coarse = fit_to(surface_of(sphere(70.0), count=4), FAITHFUL)
    middle = fit_to(surface_of(sphere(70.0), count=17), FAITHFUL)
    fine = fit_to(surface_of(sphere(70.0), count=33), FAITHFUL)
    assert coarse.report.near.size <= middle.report.near.size <= fine.report.near.size
    assert coarse.report.stopped == "small"
    assert coarse.report.final.any()


def test_cells_outside_the_layer_are_those_too_small_to_divide() -> None:
    wavy = surface_of(lambda x, y: 2.5 * np.sin(x / 2.5), count=41)
    fit = fit_to(wavy, replace(FAITHFUL, passes=100, rows=200, columns=200))
    outside = (fit.report.near > 0.0) | (fit.report.far > 0.0)
    assert outside.any()
    assert fit.report.final[outside].all() or fit.report.stopped == "stagnation"


def test_long_cells_are_divided_in_the_improved_profile() -> None:
    fit = fit_to(surface_of(lambda x, y: 0.0 * x), IMPROVED)
    steps = np.linalg.norm(np.diff(fit.points, axis=0), axis=2)
    assert steps.max() <= IMPROVED.segment + 1e-9
    assert fit.points.shape == (5, 5, 3)
    assert np.abs(fit.rows - [0.0, 0.25, 0.5, 0.75, 1.0]).max() < 1e-12


def test_thickness_of_skin_and_muscle_follow_the_recipe() -> None:
    surface = surface_of(lambda x, y: 0.0 * x)
    thick = square_outline(settings=OutlineSettings(skin=5.0, thickness=(2.0, 6.0)))
    fit = fit_to(surface, FAITHFUL, outline=thick)
    assert np.abs(fit.points[..., 2] + 7.0).max() < 1e-9
    assert np.abs(fit.report.thickness - 4.0).max() < 1e-9
    sloping = square_outline(settings=OutlineSettings(skin={"3.7": 1.0, "3.12": 4.0}))
    depth = -fit_to(surface, IMPROVED, outline=sloping).points[..., 2]
    assert depth[:, 0].mean() > depth[:, -1].mean() + 0.3


def test_walls_of_a_groove_are_not_fitted_under() -> None:
    def groove(x, y):
        return -6.0 * np.exp(-((x / 1.5) ** 2))

    surface = surface_of(groove, count=81)
    corners = np.array([[[-20.0, 20.0], [20.0, 20.0]], [[-20.0, -20.0], [20.0, -20.0]]])
    layout = Layout(np.concatenate([corners, np.zeros((2, 2, 1))], axis=2), False, np.ones((2, 2)))
    all_of_it = find_patch(layout, surface, FAITHFUL)
    patch = find_patch(layout, surface, IMPROVED)
    assert all_of_it.taken.all()
    assert (patch.faces == all_of_it.faces).all()
    steep = np.abs(all_of_it.middles[:, 0]) < 2.5
    steep &= all_of_it.normals[:, 2] < 0.45
    assert steep.sum() > 50
    assert not patch.taken[steep].any()
    # Walls hide what lies behind them.
    middles, normals = patch.middles[~patch.taken], patch.normals[~patch.taken]
    assert (patch.cast(middles - normals, normals)[1] == -1).all()
    assert (all_of_it.cast(middles - normals, normals)[1] >= 0).all()
    fit = fit_to(surface, IMPROVED)
    assert fit.report.inside >= 0.95
    assert np.abs(fit.points[..., :2]).max() < 21.0


def test_refinement_never_touches_the_outline() -> None:
    surface = surface_of(sphere(70.0))
    outline = MuscleOutline(
        "m",
        "sheet",
        (
            (OutlinePoint(("2.2",), (-0.2, 0.9, 0.0)), OutlinePoint(("2.2",), (0.2, 0.9, 0.0))),
            (OutlinePoint(("2.2",), (-0.2, 1.2, 0.0)), OutlinePoint(("2.2",), (0.2, 1.2, 0.0))),
        ),
        mirror=False,
    )
    before = outline.rows
    layout = lay_out(outline, surface)
    again = lay_out(outline, surface)
    assert outline.rows == before
    assert (layout.points == again.points).all()
    assert layout.found.all()


def _outline(*rows) -> MuscleOutline:
    made = tuple(tuple(OutlinePoint(("2.2",), place) for place in row) for row in rows)
    return MuscleOutline("m", "sheet", made, mirror=False)


def test_ragged_rows_are_filled_evenly_along_their_length() -> None:
    surface = surface_of(lambda x, y: 0.0 * x)
    outline = _outline(
        [(-0.2, 0.9, 0.0), (0.2, 0.9, 0.0)],
        [(-0.2, 1.1, 0.0), (-0.1, 1.1, 0.0), (0.1, 1.1, 0.0), (0.2, 1.1, 0.0)],
    )
    points = lay_out(outline, surface).points
    assert points.shape == (2, 4, 3)
    steps = np.diff(points[0, :, 0])
    assert np.abs(steps - steps.mean()).max() < 1e-9 * np.abs(points).max()


def test_impossible_outlines_are_refused_with_the_row() -> None:
    surface = surface_of(lambda x, y: 0.0 * x)
    crossing = _outline([(-0.2, 0.9, 0.0), (0.2, 0.9, 0.0)], [(0.2, 1.1, 0.0), (-0.2, 1.1, 0.0)])
    with pytest.raises(ParameterError, match="outline m: rows 0 and 1 cross"):
        lay_out(crossing, surface)
    with pytest.raises(ParameterError, match="row 1: points 0 and 1 coincide"):
        lay_out(_outline([(-0.2, 0.9, 0), (0.2, 0.9, 0)], [(0.1, 1, 0), (0.1, 1, 0)]), surface)
    row = (OutlinePoint(("8.1",)), OutlinePoint(("8.1",), (0.1, 0.0, 0.0)))
    with pytest.raises(LandmarkError, match=r"outline m: .*needs 8\.1; add it"):
        lay_out(MuscleOutline("m", "sheet", (row, row), mirror=False), surface)


def test_points_beside_the_skin_keep_their_place_and_are_counted() -> None:
    surface = surface_of(lambda x, y: 0.0 * x, size=15.0)
    outline = _outline([(-0.4, 0.9, 0.0), (0.4, 0.9, 0.0)], [(-0.4, 1.1, 0.0), (0.4, 1.1, 0.0)])
    layout = lay_out(outline, surface)
    assert not layout.found.any()


def test_a_cell_without_area_takes_its_normal_from_its_neighbours() -> None:
    points = np.zeros((3, 2, 3))
    points[:, 1, 0] = 1.0
    points[:, :, 1] = [[0.0, 0.0], [0.0, 0.0], [1.0, 1.0]]
    out = np.zeros((3, 2, 3))
    out[..., 2] = 1.0
    normals = cell_normals(points, out)
    assert (normals[1, 0] == [0.0, 0.0, 1.0]).all()
    assert np.abs(normals[0, 0]).max() == 0.0


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"least": 3.0, "most": 2.0}, "least 3 and most 2 must be above 0, least first"),
        ({"part": 0.0}, "part: 0 is below 0.1"),
        ({"overlap": 3.0}, "overlap: 3 is above 2"),
        ({"segment": 0.0}, "segment 0 and breadth 10 must be above 0"),
        ({"columns": 1}, "columns: 1 is below 2"),
        ({"yielding": 0.0}, "yielding: 0 is below 0.01"),
    ],
)
def test_impossible_numbers_of_the_fit_are_refused(changes, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        replace(IMPROVED, **changes)


def test_profiles_are_known_by_name() -> None:
    assert FitParameters.of_profile("improved") == IMPROVED
    assert FAITHFUL.radius == 8.0
    with pytest.raises(ParameterError, match="'printed' is not one of faithful, improved"):
        FitParameters.of_profile("printed")


@pytest.mark.parametrize("parameters", [FAITHFUL, IMPROVED], ids=["faithful", "improved"])
@pytest.mark.parametrize("size", [0.5, 3.0])
def test_a_larger_head_has_the_same_grid_larger(parameters: FitParameters, size: float) -> None:
    small = surface_of(lambda x, y: sphere(70.0)(x, y) + np.sin(x / 6.0))
    measure = small.measure
    large = SkinSurface(
        TriMesh(size * small.mesh.positions, small.mesh.faces),
        FaceMeasure(
            {name: size * place for name, place in measure.landmarks.items()},
            size * measure.width,
            size * measure.height,
        ),
        small.lips, small.sides, small.hidden, small.normals, small.broad_normals,
    )  # fmt: skip
    first, second = fit_to(small, parameters), fit_to(large, parameters, half=20.0 * size)
    assert first.points.shape == second.points.shape
    assert np.abs(second.points - size * first.points).max() < 1e-6 * size * 70.0
    assert np.abs(second.report.thickness - size * first.report.thickness).max() < 1e-6 * size
