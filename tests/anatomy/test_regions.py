from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.regions import REGIONS, Regions, find_regions
from risorius.errors import ParameterError
from tests.face_fixtures import builtin_face, made_up_head, made_up_mechanics, mirror_vertices

HEAD, MECHANICS = builtin_face().head, builtin_face().mechanics
FOUND = find_regions(HEAD, MECHANICS.lips, dict(MECHANICS.margins))
LIPS = MECHANICS.lips


def _label(name: str) -> str:
    return str(FOUND.labels[HEAD.skin_vertex(name)])


def test_shares_of_the_regions_add_up_to_one() -> None:
    assert FOUND.weights.min() >= 0.0
    np.testing.assert_allclose(FOUND.weights.sum(axis=1), 1.0, rtol=1e-12)
    assert FOUND.mobility.min() >= 0.0
    assert FOUND.mobility.max() == 1.0


@pytest.mark.parametrize(
    ("names", "region"),
    [
        (("4.1", "4.2", "4.3", "11.1"), "upper"),
        (("8.1", "8.5", "5.1", "5.3"), "middle"),
        (("9.3",), "nose"),
        (("8.2", "2.3", "2.10", "8.7"), "lower"),
        (("10.1", "10.2", "11.4", "3.1", "3.3"), "static"),
    ],
)
def test_landmarks_lie_in_their_region(names, region: str) -> None:
    assert {_label(name) for name in names} == {region}


def test_the_upper_side_is_not_lower_face_to_the_last_bit() -> None:
    upper = LIPS.upper & (LIPS.to_corner > 0.1 * LIPS.width)
    assert upper.sum() > 1000
    np.testing.assert_array_equal(FOUND.permission(("lower",))[LIPS.upper], 0.0)
    lower_lip = LIPS.slit.lower[LIPS.to_corner[LIPS.slit.lower] > 0.1 * LIPS.width]
    np.testing.assert_array_equal(FOUND.permission(("upper", "middle", "nose"))[lower_lip], 0.0)


def test_regions_change_gently_across_the_cheek_and_the_brow() -> None:
    mesh = HEAD.skin.mesh
    lip_line = np.zeros(mesh.vertex_count, bool)
    lip_line[LIPS.distance < 0.6 * LIPS.width] = True
    edges = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]]])
    away = edges[~lip_line[edges].any(axis=1) & ~LIPS.inside[edges].any(axis=1)]
    length = np.linalg.norm(mesh.positions[away[:, 0]] - mesh.positions[away[:, 1]], axis=1)
    step = np.abs(FOUND.weights[away[:, 0]] - FOUND.weights[away[:, 1]]).max(axis=1)
    assert (step / np.maximum(length, 1.0)).max() < 0.25


def test_all_regions_together_permit_everything() -> None:
    np.testing.assert_allclose(FOUND.permission(REGIONS), 1.0, rtol=1e-12)
    np.testing.assert_array_equal(FOUND.permission(("static",)), 0.0)
    np.testing.assert_array_equal(FOUND.permission(()), 0.0)


def test_an_unknown_region_is_refused_with_the_known_ones() -> None:
    with pytest.raises(
        ParameterError, match="forehead is not one of upper, middle, lower, nose, static"
    ):
        FOUND.permission(("upper", "forehead"))


def test_static_skin_is_what_cannot_move() -> None:
    regions = Regions(np.eye(4), np.array([1.0, 0.0, 0.5, 1.0]))
    assert regions.labels.tolist() == ["upper", "static", "lower", "nose"]
    assert set(FOUND.labels) == set(REGIONS)


def test_both_sides_are_labelled_alike() -> None:
    partner = mirror_vertices(HEAD.skin.mesh.positions)
    near = LIPS.distance < 2.0 * LIPS.width
    np.testing.assert_allclose(FOUND.weights[partner][near], FOUND.weights[near], atol=1e-9)
    np.testing.assert_allclose(FOUND.mobility[partner], FOUND.mobility, atol=1e-9)


def test_the_back_of_the_head_is_still() -> None:
    behind = HEAD.skin.mesh.positions[:, 2] < MECHANICS.jaw.hinge[2] - 10.0
    assert behind.sum() > 500
    np.testing.assert_array_equal(FOUND.mobility[behind], 0.0)


def test_a_head_without_lids_has_regions_too() -> None:
    head = made_up_head()
    regions = find_regions(head, made_up_mechanics().lips, {})
    assert str(regions.labels[head.skin_vertex("8.2")]) == "lower"
    assert str(regions.labels[head.skin_vertex("8.1")]) == "middle"
