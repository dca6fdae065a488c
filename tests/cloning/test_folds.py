"""Skin that folds or tears on the target and not on the source is smoothed."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from risorius.cloning import CloneParameters, Cloning
from risorius.cloning.folds import FoldRelief, least_progress
from risorius.mesh.core import TriMesh
from tests.cloning.rigs import dense, other_cloning, other_head, self_cloning, source_rig


def plane(count: int = 9) -> TriMesh:
    """Return a square grid of triangles in the plane z = 0, edges of 1 mm."""
    x, y = np.meshgrid(np.arange(count), np.arange(count), indexing="ij")
    points = np.stack([x.ravel(), y.ravel(), np.zeros(count * count)], axis=1).astype(float)
    at = np.arange(count * count).reshape(count, count)
    a, b, c, d = at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]
    faces = np.concatenate([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)])
    return TriMesh(points, faces.reshape(-1, 3).astype(np.int32))


def test_progress_is_one_at_rest_and_under_a_shift() -> None:
    mesh = plane()
    assert least_progress(mesh, np.zeros_like(mesh.positions)) == pytest.approx(1.0)
    assert least_progress(mesh, np.full_like(mesh.positions, 3.0)) == pytest.approx(1.0)


@pytest.mark.parametrize("angle", [0.0, 25.0, 70.0])
def test_progress_under_a_squeeze_is_its_factor_in_whatever_direction(angle: float) -> None:
    mesh = plane()
    turn = Rotation.from_euler("z", angle, degrees=True).as_matrix()
    squeeze = turn @ np.diag([0.4, 1.0, 1.0]) @ turn.T
    moved = mesh.positions @ (squeeze - np.eye(3)).T
    assert least_progress(mesh, moved) == pytest.approx(0.4)


def test_progress_under_a_turn_is_its_cosine_and_negative_when_turned_over() -> None:
    mesh = plane()
    for angle, wanted in ((60.0, 0.5), (180.0, -1.0)):
        turn = Rotation.from_euler("y", angle, degrees=True).as_matrix()
        moved = mesh.positions @ (turn - np.eye(3)).T
        assert least_progress(mesh, moved) == pytest.approx(wanted)


def cliff() -> np.ndarray:
    """Return motion of the other head's skin that slides the forehead down over what rests."""
    points = other_cloning().target.mesh.positions
    marks = other_head().landmarks
    middle = 0.5 * (marks.position("11.1") + marks.position("4.1"))
    away = np.linalg.norm(points - middle, axis=1)
    moved = np.zeros_like(points)
    moved[away < 14.0] = [0.0, -12.0, 0.0]
    return moved


def test_a_fold_that_the_source_does_not_have_is_smoothed_and_nothing_far_from_it() -> None:
    bound = other_cloning()
    relief = FoldRelief(bound.source, bound.target, bound.skin.mapping)
    moved, still = cliff(), np.zeros_like(bound.source.mesh.positions)
    assert relief.excess(still, moved).max() == 1.0
    made = relief.relieve(still, moved)
    before, after = (least_progress(bound.target.mesh, field) for field in (moved, made))
    assert before.min() < -0.5
    assert after.min() > 0.0
    # Fades along the skin within the reach of 0.8 x 12 mm; the edge of the slide tears as well.
    changed = np.flatnonzero((made != moved).any(axis=1))
    edge = np.flatnonzero((relief.excess(still, moved) > 0.25) | (relief.torn(still, moved) > 0.0))
    points = bound.target.mesh.positions
    gap = np.linalg.norm(points[changed, None] - points[None, edge], axis=2).min(axis=1)
    assert gap.max() <= 0.8 * 12.0


def test_a_fold_that_the_source_has_as_well_is_kept_to_the_bit() -> None:
    bound = self_cloning()
    relief = FoldRelief(bound.source, bound.target, bound.skin.mapping)
    points = bound.source.mesh.positions
    top = bound.source.head.landmarks.position("11.1")
    moved = np.where(np.linalg.norm(points - top, axis=1)[:, None] < 14.0, [0.0, -12.0, 0.0], 0.0)
    assert least_progress(bound.source.mesh, moved).min() < 0.0
    assert relief.relieve(moved, moved).tobytes() == moved.tobytes()


def torn_corner() -> tuple[np.ndarray, int]:
    """Return motion in which one vertex beside the mouth's corner lags 4 mm behind, and its row."""
    target = other_cloning().target
    assert target.lips is not None
    points, lips = target.mesh.positions, target.lips
    rows = np.flatnonzero((lips.to_corner < 0.1 * lips.width) & ~target.inside & (points[:, 0] > 0))
    row = int(rows[np.argmax(lips.to_corner[rows])])
    moved = np.zeros_like(points)
    moved[lips.to_corner < 0.4 * lips.width] = [0.0, -6.0, -2.0]
    moved[row] += [0.0, 4.0, 1.0]
    return moved, row


def test_an_edge_that_tears_beside_the_mouth_is_mended() -> None:
    bound = other_cloning()
    relief = FoldRelief(bound.source, bound.target, bound.skin.mapping)
    moved, row = torn_corner()
    still = np.zeros_like(bound.source.mesh.positions)
    torn = relief.torn(still, moved)
    assert torn[row] > 0.0
    made = relief.relieve(still, moved)
    assert made[row] == pytest.approx([0.0, -6.0, -2.0], abs=0.5)


def test_a_pair_without_folds_is_carried_alike_with_and_without_relief() -> None:
    bound = Cloning.build(
        other_cloning().source.head, other_head(), parameters=CloneParameters(fold_relief=False)
    )
    made = bound.carry(dense(source_rig())[:1])
    carried = other_cloning().carry(dense(source_rig())[:1])
    assert made.tobytes() == carried.tobytes()
