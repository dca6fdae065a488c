"""Contraction, bulge and links: Kaehler et al. 2001, section 4, with errata E1 to E6."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ParameterError, ShapeError
from risorius.springmuscle.contraction import Contraction, bulge_factors, turn_between
from risorius.springmuscle.ellipsoid import Ellipsoids
from risorius.springmuscle.merging import merge_muscles
from risorius.springmuscle.muscle import FittedMuscle, MuscleAction
from risorius.springmuscle.muscle_set import MuscleSet
from tests.springmuscle.made_up import NO_GRID, REPORT, fibre, muscle

UP = (0.0, 0.0, 1.0)
BENT = np.array([[0.0, 0, 0], [10, 0, 0], [10, 10, 0], [20, 10, 5], [20, 25, 5]])


def _set(points=BENT, **changes) -> MuscleSet:
    made = muscle("bent", [fibre(np.asarray(points, float), UP)], max_contraction=1.0)
    return MuscleSet((replace(made, action=replace(made.action, **changes)),))


def _ring(aim, count: int = 12, *, pivot=None, shares=None) -> MuscleSet:
    angle = np.linspace(0.0, 2.0 * np.pi, count + 1)
    points = np.stack([20 * np.cos(angle), 12 * np.sin(angle), np.zeros(count + 1)], axis=1)
    points[-1] = points[0]
    shares = np.ones(count + 1) if shares is None else shares
    one = replace(fibre(points, UP), aims=np.tile(aim, (count + 1, 1)), shares=shares)
    made = FittedMuscle(
        "ring", "sphincter", MuscleAction("ring"), (one,), True, pivot, NO_GRID, NO_GRID, NO_GRID,
        REPORT,
    )  # fmt: skip
    return MuscleSet((made,))


def _arc(points) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _distance_to_line(points, line) -> float:
    worst = 0.0
    for point in points:
        best = np.inf
        for a, b in pairwise(line):
            share = np.clip((point - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
            best = min(best, float(np.linalg.norm(point - a - share * (b - a))))
        worst = max(worst, best)
    return worst


def test_a_resting_muscle_is_its_input_to_the_last_bit() -> None:
    for muscles in (_set(), _ring([0.0, 0.0, 15.0])):
        rest = Contraction(muscles)([0.0])
        assert (rest.points == muscles.points).all()
        assert (rest.heights == 1.0).all()
        assert np.abs(rest.axes - muscles.frames).max() < 1e-15
        assert (rest.centres == muscles.centres).all()


@given(c=st.floats(0.0, 1.0))
def test_points_slide_along_their_own_fibre_and_the_origin_stays(c: float) -> None:
    muscles = _set()
    moved = Contraction(muscles)([c]).points
    total = _arc(BENT)
    kept = max(1.0 - c, 0.01)
    assert (moved[0] == BENT[0]).all()
    assert _distance_to_line(moved, BENT) < 1e-12 * total
    # Straight pieces between points of a bent fibre are shorter than its arc.
    lengths = np.linalg.norm(np.diff(BENT, axis=0), axis=1)
    wanted = kept * np.concatenate([[0.0], np.cumsum(lengths)])
    for point, place in zip(moved, wanted):
        k = int(np.searchsorted(np.cumsum(lengths), place - 1e-9))
        start = np.concatenate([[0.0], np.cumsum(lengths)])[k]
        expected = BENT[k] + (BENT[k + 1] - BENT[k]) * (place - start) / lengths[k]
        assert np.abs(point - expected).max() < 1e-12 * total


def test_length_falls_with_contraction_and_no_segment_vanishes() -> None:
    muscles = _set(np.linspace([0, 0, 0], [30.0, 0, 0], 6))
    contract = Contraction(muscles)
    lengths = [_arc(contract([c]).points) for c in np.linspace(0.0, 1.0, 21)]
    assert (np.diff(lengths) < 0.0).all()
    shortest = np.linalg.norm(np.diff(contract([1.0]).points, axis=0), axis=1).min()
    assert shortest >= 0.01 * 6.0 * (1.0 - 1e-12)


def test_half_contraction_is_the_polyline_computed_by_hand() -> None:
    points = [[0.0, 0, 0], [10, 0, 0], [20, 0, 0], [20, 20, 0]]
    moved = Contraction(_set(points))([0.5]).points
    assert np.abs(moved - [[0, 0, 0], [5, 0, 0], [10, 0, 0], [20, 0, 0]]).max() < 1e-12


def test_a_fixed_point_inside_the_fibre_draws_both_ends_to_it() -> None:
    points = np.linspace([0, 0, 0], [40.0, 0, 0], 5)
    moved = Contraction(_set(points, fixed_point=0.25))([0.5]).points[:, 0]
    assert np.abs(moved - (10.0 + 0.5 * (points[:, 0] - 10.0))).max() < 1e-12


def test_a_sphincter_goes_half_way_to_its_aim_at_half_contraction() -> None:
    aim = np.array([1.0, 2.0, 15.0])
    muscles = _ring(aim)
    moved = Contraction(muscles)([0.5]).points
    assert np.abs(moved - 0.5 * (muscles.points + aim)).max() < 1e-12
    assert (moved[0] == moved[-1]).all()
    closed = Contraction(muscles)([1.0]).points
    assert np.abs(closed - aim - 0.01 * (muscles.points - aim)).max() < 1e-12


def test_shares_hold_parts_of_a_ring() -> None:
    shares = np.ones(13)
    shares[3:9] = 0.0
    muscles = _ring(np.zeros(3), shares=shares)
    moved = Contraction(muscles)([0.5]).points
    assert (moved[3:9] == muscles.points[3:9]).all()
    assert np.abs(moved[10] - 0.5 * muscles.points[10]).max() < 1e-12


def test_a_ring_around_an_eye_keeps_its_distance_from_the_eyes_axis() -> None:
    pivot = np.array([0.0, 0.0, -20.0])
    muscles = _ring([0.0, -2.0, 3.0], pivot=pivot)
    moved = Contraction(muscles)([0.6]).points
    before = np.hypot(muscles.points[:, 1] - pivot[1], muscles.points[:, 2] - pivot[2])
    after = np.hypot(moved[:, 1] - pivot[1], moved[:, 2] - pivot[2])
    assert np.abs(after - before).max() < 1e-12 * before.max()
    assert np.abs(moved - muscles.points).max() > 5.0


@pytest.mark.parametrize(
    ("count", "centre"), [(3, 2.98), (5, 2.98), (7, 2.98), (4, 2.76), (6, 2.9)]
)
def test_the_middle_bulges_and_the_ends_stay_flat(count: int, centre: float) -> None:
    points = np.linspace([0, 0, 0], [30.0, 0, 0], count + 1)
    heights = Contraction(_set(points))([1.0]).heights
    assert heights[0] == heights[-1] == 1.0
    assert abs(heights.max() - centre) < 0.011
    assert np.abs(heights - heights[::-1]).max() < 1e-12


def test_two_segments_bulge_plainly_and_a_ring_bulges_evenly() -> None:
    heights = Contraction(_set(BENT[:3]))([0.5]).heights
    assert np.abs(heights - [2.0, 2.0]).max() < 1e-12
    ring = Contraction(_ring(np.zeros(3)))([0.5]).heights
    assert np.abs(ring - 2.0).max() < 1e-12


@given(stretch=st.floats(0.0, 10.0))
def test_stretched_segments_get_thinner_but_never_vanish(stretch: float) -> None:
    height = bulge_factors(np.array([stretch]), np.ones(1), np.array([2.0]))[0]
    assert height >= 0.2
    assert (height < 1.0) == (stretch > 1.0) or stretch == 1.0


def test_points_on_an_ellipsoid_stay_on_it_whatever_the_muscle_does() -> None:
    muscles = _set()
    rng = np.random.default_rng(3)
    segments = rng.integers(0, 4, 200).astype(np.int32)
    solids = Ellipsoids.of(muscles)
    feet = solids.closest(muscles.centres[segments] + rng.normal(size=(200, 3)) * 6.0, segments)
    local = solids.local(feet, segments)
    turned = muscles.points @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
    for c in (0.0, 0.3, 0.9, 1.0):
        for points in (None, turned, 1.4 * muscles.points):
            moved = Contraction(muscles)([c], points=points)
            solid = Ellipsoids.of(muscles, moved)
            places = moved.positions(segments, local)
            unit = solid.local(places, segments) / solid.half_axes[segments]
            assert np.abs((unit**2).sum(axis=1) - 1.0).max() < 1e-9


def test_frames_turn_by_the_smallest_rotation() -> None:
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(2, 50, 3))
    a /= np.linalg.norm(a, axis=1, keepdims=True)
    b /= np.linalg.norm(b, axis=1, keepdims=True)
    b[0] = -a[0]
    turn = turn_between(a, b)
    assert np.abs(np.einsum("sij,sj->si", turn, a) - b).max() < 1e-9
    assert np.abs(turn @ turn.transpose(0, 2, 1) - np.eye(3)).max() < 1e-9
    assert np.abs(np.linalg.det(turn) - 1.0).max() < 1e-9
    angle = np.arccos(np.clip(0.5 * (np.trace(turn, axis1=1, axis2=2) - 1.0), -1.0, 1.0))
    between = np.arccos(np.clip((a * b).sum(axis=1), -1.0, 1.0))
    assert np.abs(angle - between).max() < 1e-6


def _crossing(end_x: float, yielding: float = 1.0) -> MuscleSet:
    """Return a host along y and a guest along x that ends at `end_x`."""
    host = muscle("host", [fibre(np.linspace([20, -15, 0], [20.0, 15, 0], 4), UP)])
    guest = muscle("guest", [fibre(np.linspace([-10, 0, 0], [end_x, 0.0, 0], 6), UP)])
    return merge_muscles((host, guest), yielding=yielding)


def test_an_end_inside_another_muscle_is_linked_and_a_crossing_body_is_not() -> None:
    linked = _crossing(20.0)
    assert len(linked.links.ends) == 1
    assert linked.fibre_muscle[linked.links.ends[0, 0]] == 1
    assert linked.fibre_muscle[linked.links.hosts[0, 0]] == 0
    assert len(linked.links.groups) == 1
    assert len(linked.links.groups[0]) == 2
    through = _crossing(40.0)
    assert len(through.links.ends) == 0
    assert through.links.groups == ()


def test_muscles_of_opposite_sides_and_closed_hosts_are_not_linked() -> None:
    host = muscle("host_l", [fibre(np.linspace([20, -15, 0], [20.0, 15, 0], 4), UP)])
    guest = muscle("guest_r", [fibre(np.linspace([-10, 0, 0], [20, 0.0, 0], 6), UP)])
    assert len(merge_muscles((host, guest), yielding=1.0).links.ends) == 0
    shut = replace(host, name="host", action=replace(host.action, host=False))
    assert len(merge_muscles((shut, guest), yielding=1.0).links.ends) == 0


def test_linked_distances_are_kept_and_the_pulled_muscle_gets_longer_and_thinner() -> None:
    muscles = _crossing(20.0)
    moved = Contraction(muscles)([0.4, 0.0])
    end, (first, second) = muscles.links.ends[0, 1], (1, 2)
    for host in (first, second):
        before = np.linalg.norm(muscles.points[end] - muscles.points[host])
        after = np.linalg.norm(moved.points[end] - moved.points[host])
        assert abs(after / before - 1.0) < 0.01
    guest = muscles.segment_muscle == 1
    assert _arc(moved.points[4:]) > _arc(muscles.points[4:])
    assert (moved.heights[guest] < 1.0).all()
    # The origin hangs on bone.
    assert (moved.points[4] == muscles.points[4]).all()


def test_a_contracting_muscle_drags_its_host_more_when_it_yields_less() -> None:
    ways = []
    for yielding in (1.0, 0.2):
        muscles = _crossing(20.0, yielding)
        moved = Contraction(muscles)([0.0, 0.5]).points
        ways.append(muscles.points[9, 0] - moved[9, 0])
    assert ways[1] > 1.3 * ways[0] > 0.0


def test_contraction_is_the_same_whatever_was_asked_before() -> None:
    contract = Contraction(_crossing(20.0))
    first = contract([0.3, 0.6]).points.copy()
    contract([1.0, 0.1])
    assert (contract([0.3, 0.6]).points == first).all()


def test_contraction_outside_0_to_1_is_clamped_and_controls_are_scaled() -> None:
    muscles = _set()
    assert (Contraction(muscles)([7.0]).points == Contraction(muscles)([1.0]).points).all()
    weak = _set(max_contraction=0.4)
    assert weak.contractions({"bent": 0.5}) == [0.2]
    assert weak.contractions({"bent": 3.0}) == [0.4]
    assert weak.contractions({}) == [0.0]


def test_wrong_sizes_are_refused_with_what_was_expected() -> None:
    with pytest.raises(ShapeError, match=r"one per muscle \(1,\), got \(2,\)"):
        Contraction(_set())([0.1, 0.2])
    with pytest.raises(ShapeError, match="expected 5 rows"):
        Contraction(_set())([0.1], points=BENT[:3])
    with (
        np.errstate(invalid="ignore"),
        pytest.raises(ParameterError, match="points 1 and 2 are the same; merge them"),
    ):
        fibre(np.array([[0.0, 0, 0], [1, 0, 0], [1, 0, 0]]), UP)
    with pytest.raises(ParameterError, match="bent is there twice"):
        MuscleSet((*_set().muscles, *_set().muscles))


def test_ellipsoids_turn_with_their_segments() -> None:
    muscles = _set()
    turn = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
    moved = Contraction(muscles)([0.3], points=muscles.points @ turn.T)
    along = np.diff(moved.points, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    first = moved.axes[:, :, 0] / np.linalg.norm(moved.axes[:, :, 0], axis=1, keepdims=True)
    assert np.abs(first - along).max() < 1e-9
    gram = moved.axes.transpose(0, 2, 1) @ moved.axes
    assert np.abs(gram[:, 0, 1:]).max() < 1e-9


def test_a_pulled_ring_stays_closed() -> None:
    ring = _ring(np.zeros(3)).muscles[0]
    start = ring.fibres[0].points[0]
    guest = muscle("guest", [fibre(np.linspace(start + [25.0, 3.0, 0.0], start, 6), UP)])
    muscles = merge_muscles((ring, guest), yielding=1.0)
    assert len(muscles.links.ends) >= 1
    moved = Contraction(muscles)([0.0, 0.5]).points
    last = len(ring.fibres[0].points) - 1
    assert (moved[0] == moved[last]).all()
    assert np.linalg.norm(moved[0] - start) > 1.0


def test_the_origin_of_a_host_stays_on_its_bone() -> None:
    host = muscle("host", [fibre(np.linspace([20, -15, 0], [20.0, 15, 0], 4), UP)])
    guest = muscle("guest", [fibre(np.linspace([-10, -10, 0], [20, -10.0, 0], 6), UP)])
    muscles = merge_muscles((host, guest), yielding=1.0)
    assert muscles.links.hosts[0, 1] == 0
    moved = Contraction(muscles)([0.0, 0.6]).points
    assert (moved[0] == muscles.points[0]).all()
    assert np.linalg.norm(moved[1] - muscles.points[1]) > 0.5
