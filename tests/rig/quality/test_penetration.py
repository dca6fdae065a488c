from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from risorius.mesh.core import TriMesh
from risorius.rig.quality.penetration import Penetration, penetrations, solid
from risorius.rig.quality.rigid import rigid_motions
from tests.rig.quality.made_heads import ball, grid, head_of, rig_of

SKIN = grid(9, 9)
MIDDLE = 40
BALL = ball((4.0, 4.0, -6.0), 5.0)
HEAD = head_of({"skin": SKIN, "eye_left": BALL})
COUNT = HEAD.vertex_count
VISIBLE = np.ones(SKIN.vertex_count, bool)


def measured(deltas: np.ndarray, visible: np.ndarray = VISIBLE) -> Penetration:
    rig = rig_of(HEAD, {"shape": deltas})
    skin = deltas[None, : SKIN.vertex_count]
    return penetrations(rig, HEAD, skin, visible)["eye_left"][0]


def pushed(depth: float) -> np.ndarray:
    deltas = np.zeros((COUNT, 3))
    deltas[MIDDLE, 2] = -1.0 - depth
    return deltas


@pytest.mark.parametrize("depth", [0.2, 1.0, 2.5])
def test_a_vertex_pushed_into_the_ball_is_as_deep_as_it_was_pushed(depth: float) -> None:
    found = measured(pushed(depth))
    assert found.depth == pytest.approx(depth, abs=0.05)
    assert found.added == found.depth
    assert found.vertex == MIDDLE


def test_outside_is_no_depth_at_all() -> None:
    assert measured(pushed(-0.2)) == Penetration(0.0, 0.0, -1)


def test_hidden_skin_is_not_judged() -> None:
    hidden = VISIBLE.copy()
    hidden[MIDDLE] = False
    assert measured(pushed(1.0), hidden).depth == 0.0


def test_a_part_that_moves_along_is_not_entered() -> None:
    deltas = pushed(1.0)
    deltas[SKIN.vertex_count :, 2] = -2.0
    assert measured(deltas).depth == 0.0


def test_a_ball_that_turns_is_as_deep_as_one_that_rests() -> None:
    turn = Rotation.from_euler("yx", [40.0, -20.0], degrees=True).as_matrix()
    deltas = pushed(1.0)
    centre = np.array([4.0, 4.0, -6.0])
    deltas[SKIN.vertex_count :] = (BALL.positions - centre) @ turn.T + centre - BALL.positions
    assert measured(deltas).depth == pytest.approx(1.0, abs=0.05)


def test_a_ball_that_comes_out_enters_skin_that_rests() -> None:
    deltas = np.zeros((COUNT, 3))
    deltas[SKIN.vertex_count :, 2] = 1.7
    assert measured(deltas).depth == pytest.approx(0.7, abs=0.05)


def test_a_part_that_bends_is_met_in_its_bent_shape() -> None:
    deltas = np.zeros((COUNT, 3))
    front = BALL.positions[:, 2] > -2.0
    deltas[SKIN.vertex_count :][front, 2] = 1.7
    assert measured(deltas).depth == pytest.approx(0.7, abs=0.05)


def test_only_what_is_deeper_than_at_rest_counts_as_added() -> None:
    skin = SKIN.at(SKIN.positions - [0.0, 0.0, 2.0])
    head = head_of({"skin": skin, "eye_left": BALL})
    deltas = np.zeros((COUNT, 3))
    deltas[MIDDLE, 2] = -0.5
    rig = rig_of(head, {"rest": np.zeros((COUNT, 3)), "deeper": deltas})
    motion = np.stack([0.0 * deltas, deltas])[:, : SKIN.vertex_count]
    rest, deeper = penetrations(rig, head, motion, VISIBLE)["eye_left"]
    assert rest.depth == pytest.approx(1.0, abs=0.05)
    assert rest.added == 0.0
    assert deeper.added == pytest.approx(0.5, abs=0.05)
    assert deeper.depth == pytest.approx(1.5, abs=0.05)


def test_pieces_that_look_inwards_are_turned_and_pieces_within_others_dropped() -> None:
    inner = ball((4.0, 4.0, -6.0), 4.0)
    beside = ball((40.0, 0.0, 0.0), 2.0)
    points = np.concatenate([BALL.positions, inner.positions, beside.positions])
    start = BALL.vertex_count
    faces = np.concatenate(
        [BALL.faces[:, ::-1], inner.faces + start, beside.faces + start + inner.vertex_count]
    )
    body = solid(TriMesh(points, np.ascontiguousarray(faces)))
    expected = np.concatenate([BALL.faces, beside.faces + start + inner.vertex_count])
    rows = {tuple(np.roll(face, -int(np.argmin(face)))) for face in body.faces.tolist()}
    assert rows == {tuple(np.roll(face, -int(np.argmin(face)))) for face in expected.tolist()}


def test_a_rigid_motion_is_recognised_and_given_back() -> None:
    turn = Rotation.from_euler("xyz", [20.0, -50.0, 100.0], degrees=True).as_matrix()
    shift = np.array([3.0, -40.0, 7.0])
    posed = BALL.positions @ turn.T + shift
    found = rigid_motions(BALL.positions, np.stack([posed - BALL.positions, 0.0 * posed]))
    assert found.fits.all()
    np.testing.assert_allclose(found.rotation[0], turn, atol=1e-12)
    np.testing.assert_allclose(found.offset[0], shift, atol=1e-11)
    np.testing.assert_array_equal(found.rotation[1], np.eye(3))


@pytest.mark.parametrize("factor", [(1.1, 1.0, 1.0), (-1.0, 1.0, 1.0)])
def test_stretching_and_mirroring_are_not_rigid(factor: tuple[float, float, float]) -> None:
    points = np.random.default_rng(3).normal(size=(30, 3)) * 10.0
    assert not rigid_motions(points, (points * factor - points)[None]).fits[0]
