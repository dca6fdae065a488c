from __future__ import annotations

import numpy as np
import pytest

from risorius.head import Head
from risorius.mesh.core import TriMesh
from risorius.mesh.lids import LidMargins
from risorius.mesh.slit import Slit
from risorius.rig.quality.lid_gap import lid_gaps
from tests.rig.quality.made_heads import ball, head_of

CENTRE = np.array([30.0, 0.0, -14.0])
RADIUS = 12.0
COUNT = 21
SPAN = np.radians(55.0)
YAW = np.linspace(-SPAN, SPAN, COUNT)
PITCH = np.radians(20.0) * np.cos(0.5 * np.pi * YAW / SPAN)


def on_ball(yaw: np.ndarray, pitch: np.ndarray, radius: float = RADIUS) -> np.ndarray:
    ring = np.stack([np.sin(yaw), 0.0 * yaw, np.cos(yaw)], axis=1)
    # Turn about the x axis through the centre: the pitch as the eye sees it.
    y = ring[:, 2] * np.sin(pitch)
    z = ring[:, 2] * np.cos(pitch)
    return CENTRE + radius * np.stack([ring[:, 0], y, z], axis=1)


def eye(*, with_ball: bool = True) -> tuple[Head, LidMargins]:
    upper = on_ball(YAW, PITCH)
    lower = on_ball(YAW, -PITCH)[1:-1]
    positions = np.concatenate([upper, lower])
    skin = TriMesh(positions, np.array([[0, 1, COUNT]], np.int32))
    upper_line = np.arange(COUNT, dtype=np.int32)
    inner = np.arange(COUNT, 2 * COUNT - 2)
    lower_line = np.concatenate([[0], inner, [COUNT - 1]]).astype(np.int32)
    n = len(positions)
    slit = Slit(upper_line, lower_line, np.zeros(n, bool), 1.0)
    width = float(np.linalg.norm(upper[-1] - upper[0]))
    margins = LidMargins(slit, np.zeros(n), np.zeros(n), width, 8.0)
    parts = {"skin": skin}
    if with_ball:
        parts["eye_left"] = ball((30.0, 0.0, -14.0), RADIUS)
    return head_of(parts), margins


HEAD, MARGINS = eye()


def moved(upper: np.ndarray, lower: np.ndarray, radius: float = RADIUS) -> np.ndarray:
    rest = HEAD.skin.mesh.positions
    posed = rest.copy()
    posed[MARGINS.slit.upper[1:-1]] = on_ball(YAW, upper, radius)[1:-1]
    posed[MARGINS.slit.lower[1:-1]] = on_ball(YAW, lower, radius)[1:-1]
    return posed - rest


@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 0.9, 1.0])
def test_lids_that_close_by_a_share_leave_the_rest(share: float) -> None:
    closing = moved(PITCH * (1.0 - 2.0 * share), -PITCH)
    gap = lid_gaps(HEAD, MARGINS, "l", closing[None])[0]
    assert gap.left == pytest.approx(100.0 * (1.0 - share), abs=0.5)
    assert gap.overlap == pytest.approx(0.0, abs=0.5)


def test_a_lid_that_bulges_out_is_judged_along_the_line_of_sight() -> None:
    near, far = (
        lid_gaps(HEAD, MARGINS, "l", moved(0.2 * PITCH, -0.2 * PITCH, radius)[None])[0]
        for radius in (RADIUS, 1.3 * RADIUS)
    )
    assert far.left == pytest.approx(near.left, rel=0.01)


def test_margins_that_pass_each_other_overlap_and_leave_nothing() -> None:
    gap = lid_gaps(HEAD, MARGINS, "l", moved(-0.6 * PITCH, -0.2 * PITCH)[None])[0]
    assert gap.left == pytest.approx(0.0, abs=0.5)
    assert gap.overlap == pytest.approx(20.0, abs=0.5)


def test_the_widest_place_decides() -> None:
    pitch = -PITCH.copy()
    pitch[8] = 0.5 * PITCH[8]
    gap = lid_gaps(HEAD, MARGINS, "l", moved(pitch, -PITCH)[None])[0]
    assert 20.0 < gap.left < 80.0


def test_a_margin_that_runs_to_and_fro_closes_where_any_part_of_it_does() -> None:
    yaw, share = YAW.copy(), -np.ones(COUNT)
    # From column 6 the margin jumps to column 14, comes back open, and covers the way once more.
    yaw[7:13] = np.linspace(YAW[14], YAW[6], 6)
    share[8:12] = 1.0
    yaw[13] = YAW[6]
    posed = HEAD.skin.mesh.positions.copy()
    pitch = share * np.radians(20.0) * np.cos(0.5 * np.pi * yaw / SPAN)
    posed[MARGINS.slit.upper[1:-1]] = on_ball(yaw, pitch)[1:-1]
    deltas = posed - HEAD.skin.mesh.positions
    assert lid_gaps(HEAD, MARGINS, "l", deltas[None])[0].left < 10.0


def test_an_eye_without_a_ball_is_measured_from_where_its_centre_would_be() -> None:
    head, margins = eye(with_ball=False)
    closing = moved(-PITCH, -PITCH)
    still, closed = lid_gaps(head, margins, "l", np.stack([0.0 * closing, closing]))
    assert still.left == pytest.approx(100.0, rel=1e-12)
    assert closed.left < 1.0


def test_the_right_eye_is_measured_like_the_left_one() -> None:
    flip = np.array([-1.0, 1.0, 1.0])
    parts = {
        "skin": TriMesh(HEAD.skin.mesh.positions * flip, HEAD.skin.mesh.faces),
        "eye_right": ball((-30.0, 0.0, -14.0), RADIUS),
    }
    closing = moved(0.1 * PITCH, -0.3 * PITCH)
    right = lid_gaps(head_of(parts), MARGINS, "r", (closing * flip)[None])[0]
    assert right.left == pytest.approx(lid_gaps(HEAD, MARGINS, "l", closing[None])[0].left)
