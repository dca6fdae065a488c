"""The acceptance list of the published spring muscles on whole heads, as far as it is geometry.

The number of a test is that of its item. Items 1 to 3 and the numbers of 5 and 6 on made-up muscles
and skins stand in tests/springmuscle; the springs' items stand with the skin and the solver.
"""

from __future__ import annotations

import warnings
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from risorius.anatomy.jaw import JawPose
from risorius.anatomy.mechanics import Mechanics
from risorius.errors import RisoriusWarning
from risorius.head import Head
from risorius.springmuscle.binding import bind_muscle
from risorius.springmuscle.bones import builtin_bones, cut_bones
from risorius.springmuscle.contraction import Contraction
from risorius.springmuscle.ellipsoid import Ellipsoids
from risorius.springmuscle.fit import Ground, fit_muscles
from risorius.springmuscle.muscle import JAW, SKULL
from risorius.springmuscle.muscle_set import MuscleSet
from risorius.springmuscle.recipe_file import default_recipe
from tests.springmuscle.coarse import decimated
from tests.springmuscle.faces import builtin_mechanics
from tests.springmuscle.skins import builtin_ground, builtin_muscles

HEADS = (
    "ict_facekit/ict_neutral.obj",
    "makehuman_head/african_female_young.obj",
    "makehuman_head/asian_male_old.obj",
    "makehuman_head/caucasian_male_young.obj",
)
MOUTH = ("orbicularis_oris", "orbicularis_oris_funnel")


@cache
def _real(path: Path) -> tuple[Mechanics, Ground, MuscleSet]:
    with warnings.catch_warnings():
        # Two pairs of the landmark files are exchanged; the reader says so.
        warnings.simplefilter("ignore", RisoriusWarning)
        mechanics = Mechanics.build(Head.load(path, path.with_name("landmarks.json")))
    ground = Ground.build(mechanics, builtin_bones(mechanics))
    return mechanics, ground, fit_muscles(default_recipe(), ground)


@pytest.fixture(
    params=["builtin", *(pytest.param(head, marks=pytest.mark.real) for head in HEADS)],
    ids=lambda name: Path(name).stem,
)
def fitted(request: pytest.FixtureRequest) -> tuple[Mechanics, Ground, MuscleSet]:
    if request.param == "builtin":
        return builtin_mechanics(), builtin_ground(), builtin_muscles()
    return _real(request.getfixturevalue("real_data") / request.param)


def _number(muscles: MuscleSet, name: str) -> int:
    return [muscle.name for muscle in muscles.muscles].index(name)


def test_04_feet_stay_on_their_ellipsoids_for_all_contractions_and_jaw_angles(fitted) -> None:
    mechanics, ground, muscles = fitted
    number = _number(muscles, "zygomaticus_major_l")
    found = bind_muscle(
        muscles, number, positions=ground.surface.mesh.positions, normals=ground.surface.normals,
        lips=ground.surface.lips,
    )  # fmt: skip
    contract = Contraction(muscles)
    for amount in (0.0, 0.5, 1.0):
        for angle in (0.0, 15.0):
            points, aims = muscles.moved_with_jaw(mechanics.jaw, JawPose(angle))
            values = muscles.contractions({"zygomaticus_major_l": amount})
            moved = contract(values, points=points, aims=aims)
            solids = Ellipsoids.of(muscles, moved)
            places = moved.positions(found.segments, found.feet)
            unit = solids.local(places, found.segments) / solids.half_axes[found.segments]
            assert np.abs((unit**2).sum(axis=1) - 1.0).max() < 1e-9


def test_05_the_smiling_muscle_merges_with_the_ring_and_links_hold_when_the_jaw_opens(
    fitted,
) -> None:
    mechanics, _, muscles = fitted
    links = muscles.links
    ring = _number(muscles, "orbicularis_oris")
    owners = muscles.fibre_muscle[links.ends[:, 0]]
    hosts = muscles.fibre_muscle[links.hosts[:, 0]]
    hung = {muscles.muscles[k].base_name for k in owners[hosts == ring]}
    assert {"risorius", "levator_labii_inner"} <= hung
    assert len(hung) >= 5
    for (_, end), (_, segment) in zip(links.ends, links.hosts):
        inside = Ellipsoids.of(muscles).inside(muscles.points[[end]], [segment])
        assert inside[0]
    points, aims = muscles.moved_with_jaw(mechanics.jaw, JawPose(12.0))
    moved = Contraction(muscles)(np.zeros(len(muscles.muscles)), points=points, aims=aims)
    first = muscles.segment_points[links.hosts[:, 1]]
    gaps = []
    for way in (muscles.points, moved.points):
        ends = way[links.ends[:, 1]]
        gaps.append(
            np.stack([np.linalg.norm(ends - way[first + k], axis=1) for k in (0, 1)], axis=1)
        )
    # Links over-constrain (finding S8): the median holds within one per cent, not every one.
    change = np.abs(gaps[1] / np.maximum(gaps[0], 0.5) - 1.0)
    assert np.median(change) < 0.01


def test_06_at_least_95_percent_of_every_muscle_lies_in_its_layer(fitted) -> None:
    _, _, muscles = fitted
    for muscle in muscles.muscles:
        report = muscle.report
        assert report.inside >= 0.95, (muscle.name, report.inside)
        assert report.covered >= 0.9, (muscle.name, report.covered)
        assert (report.thickness > 0.0).all()
        assert report.passes <= 30


def test_07_a_muscle_is_refitted_the_same_from_the_recipe(fitted) -> None:
    _, ground, muscles = fitted
    again = fit_muscles(default_recipe(), ground)
    assert again.points.tobytes() == muscles.points.tobytes()


def test_08_no_vertex_of_one_lip_hangs_on_the_other_half_of_the_ring(fitted) -> None:
    _, ground, muscles = fitted
    surface = ground.surface

    def wrong(name: str, **options) -> tuple[int, int]:
        found = bind_muscle(
            muscles, _number(muscles, name), positions=surface.mesh.positions,
            normals=surface.normals, lips=surface.lips, **options,
        )  # fmt: skip
        product = surface.lips[found.vertices] * muscles.lips[found.segments]
        return int((product < 0).sum()), int((product > 0).sum())

    for name in MOUTH:
        crossed, right = wrong(name)
        assert crossed == 0
        assert right > 100
    # What was printed takes feet of the other lip.
    assert wrong(MOUTH[0], guard=False, weighting="product")[0] > 20


def test_09_upper_rows_of_the_ring_hang_on_the_skull_and_lower_ones_on_the_jaw(fitted) -> None:
    _, ground, muscles = fitted
    marks = ground.surface.measure.landmarks
    fibre = muscles.muscles[_number(muscles, "orbicularis_oris")].fibres[0]
    middle = np.abs(fibre.points[:, 0]) < 0.6 * abs(marks["2.4"][0])
    above = fibre.points[:, 1] > 0.5 * (marks["2.2"] + marks["2.3"])[1]
    assert (fibre.bones[middle & above] == SKULL).all()
    assert (fibre.bones[middle & ~above] == JAW).all()
    assert (middle & above).sum() >= 2
    assert (middle & ~above).sum() >= 2


def test_15_the_mouth_follows_the_jaw_and_then_purses_forwards(fitted) -> None:
    mechanics, _, muscles = fitted
    contract, own = Contraction(muscles), muscles.point_muscle == _number(muscles, MOUTH[0])
    rest = contract(np.zeros(len(muscles.muscles))).points[own]
    points, aims = muscles.moved_with_jaw(mechanics.jaw, JawPose(15.0))
    opened = contract(np.zeros(len(muscles.muscles)), points=points, aims=aims).points[own]
    pursed = contract(
        muscles.contractions({"orbicularis_oris": 1.0}), points=points, aims=aims
    ).points[own]
    assert opened[:, 1].min() < rest[:, 1].min() - 8.0
    assert opened[:, 1].max() > rest[:, 1].max() - 4.0
    assert np.ptp(pursed[:, 0]) < 0.75 * np.ptp(opened[:, 0])
    assert pursed[:, 2].mean() > opened[:, 2].mean() + 2.0


@pytest.mark.parametrize("share", [0.5, 0.2])
def test_16_the_recipe_rebuilds_on_coarse_versions_of_every_head(fitted, share: float) -> None:
    mechanics, _, muscles = fitted
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RisoriusWarning)
        coarse = Mechanics.build(decimated(mechanics.head, share))
    ground = Ground.build(coarse, cut_bones(mechanics))
    rebuilt = fit_muscles(default_recipe(), ground)
    assert [m.name for m in rebuilt.muscles] == [m.name for m in muscles.muscles]
    assert len(rebuilt.centres) < len(muscles.centres)
    inside = np.array([m.report.inside for m in rebuilt.muscles])
    assert (inside >= 0.95).mean() > 0.6
    assert inside.min() > 0.6
    moved = Contraction(rebuilt)(np.ones(len(rebuilt.muscles)))
    assert np.isfinite(moved.axes).all()
