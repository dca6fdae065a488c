from __future__ import annotations

import numpy as np
import pytest

from risorius.head import Head
from risorius.mesh.core import TriMesh
from risorius.mesh.lids import LidMargins
from risorius.mesh.slit import Slit
from risorius.rig.quality.lid_gap import LidGap, lid_gaps
from tests.rig.quality.made_heads import ball, head_of

CENTRE = np.array([30.0, 0.0, -14.0])
RADIUS = 12.0
COUNT, ROWS = 41, 8
SPAN = np.radians(40.0)
YAW = np.linspace(-SPAN, SPAN, COUNT)
PITCH = np.radians(20.0) * np.cos(0.5 * np.pi * YAW / SPAN)
EDGE = np.radians(75.0)


def on_ball(yaw: np.ndarray, pitch: np.ndarray, radius: float) -> np.ndarray:
    """Return points around the eye's centre: aside by `yaw`, then turned up by `pitch`."""
    aside, ahead = np.sin(yaw), np.cos(yaw)
    return CENTRE + radius * np.stack(
        [aside, ahead * np.sin(pitch), ahead * np.cos(pitch)], axis=-1
    )


def lids(upper: np.ndarray, lower: np.ndarray, radius: float = RADIUS) -> np.ndarray:
    """Return the skin: rows of the upper lid from its margin outwards, then of the lower lid."""
    rows = np.linspace(0.0, 1.0, ROWS)[:, None]
    yaw = np.broadcast_to(YAW, (ROWS, COUNT))
    above = on_ball(yaw, upper + rows * (EDGE - upper), radius)
    below = on_ball(yaw, lower - rows * (EDGE + lower), radius)
    return np.concatenate([above.reshape(-1, 3), below.reshape(-1, 3)])


def eye(*, with_ball: bool = True, mirrored: bool = False) -> tuple[Head, LidMargins]:
    positions = lids(PITCH, -PITCH)
    first = (np.arange(ROWS - 1)[:, None] * COUNT + np.arange(COUNT - 1)).ravel()
    half = np.concatenate(
        [
            np.stack([first, first + 1, first + 1 + COUNT], axis=1),
            np.stack([first, first + 1 + COUNT, first + COUNT], axis=1),
        ]
    )
    count = ROWS * COUNT
    faces = np.concatenate([half, half + count])
    # Both lids share the corners.
    faces[faces == count] = 0
    faces[faces == count + COUNT - 1] = COUNT - 1
    upper = np.arange(COUNT, dtype=np.int32)
    lower = np.concatenate([[0], count + np.arange(1, COUNT - 1), [COUNT - 1]]).astype(np.int32)
    n = len(positions)
    width = float(np.linalg.norm(positions[COUNT - 1] - positions[0]))
    slit = Slit(upper, lower, np.zeros(n, bool), 1.0)
    margins = LidMargins(slit, np.zeros(n), np.zeros(n), width, 8.0)
    flip = np.array([-1.0, 1.0, 1.0]) if mirrored else np.ones(3)
    parts = {"skin": TriMesh(positions * flip, faces)}
    if with_ball:
        centre = CENTRE * flip
        kind = "eye_right" if mirrored else "eye_left"
        parts[kind] = ball((centre[0], centre[1], centre[2]), 0.98 * RADIUS)
    return head_of(parts), margins


HEAD, MARGINS = eye()


def gap_of(upper: np.ndarray, lower: np.ndarray, radius: float = RADIUS) -> LidGap:
    deltas = lids(upper, lower, radius) - HEAD.skin.mesh.positions
    return lid_gaps(HEAD, MARGINS, "l", deltas[None])[0]


@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 0.9, 1.0])
def test_lids_that_close_by_a_share_leave_the_rest(share: float) -> None:
    gap = gap_of(PITCH * (1.0 - 2.0 * share), -PITCH)
    assert gap.left == pytest.approx(100.0 * (1.0 - share), abs=1.5)
    assert gap.overlap == pytest.approx(0.0, abs=0.5)


def test_an_eye_that_opens_wide_is_more_than_open() -> None:
    assert gap_of(1.4 * PITCH, -PITCH).left == pytest.approx(120.0, abs=1.5)


def test_a_lid_that_bulges_out_is_judged_along_the_line_of_sight() -> None:
    near, far = (gap_of(0.2 * PITCH, -0.2 * PITCH, radius) for radius in (RADIUS, 1.3 * RADIUS))
    assert near.left == pytest.approx(20.0, abs=1.5)
    assert far.left == pytest.approx(near.left, abs=1.5)


def test_margins_that_pass_each_other_overlap_and_leave_nothing() -> None:
    gap = gap_of(-0.6 * PITCH, -0.2 * PITCH)
    assert gap.left == pytest.approx(0.0, abs=0.5)
    assert gap.overlap == pytest.approx(20.0, abs=1.5)


def test_the_widest_place_decides() -> None:
    upper = -PITCH.copy()
    # Column 12 lies at the place 0.3.
    upper[11:14] = 0.5 * PITCH[11:14]
    expected = 100.0 * 1.5 * PITCH[12] / (2.0 * PITCH.max())
    assert gap_of(upper, -PITCH).left == pytest.approx(expected, abs=1.5)


def test_a_margin_traced_behind_the_rim_does_not_open_a_closed_eye() -> None:
    # The trace runs along the second row; what one sees does not change.
    line = MARGINS.slit.upper.copy()
    line[1:-1] += COUNT
    slit = Slit(line, MARGINS.slit.lower, MARGINS.slit.inside, 1.0)
    traced = LidMargins(slit, MARGINS.to_upper, MARGINS.to_lower, MARGINS.width, MARGINS.height)
    deltas = lids(-PITCH, -PITCH) - HEAD.skin.mesh.positions
    assert lid_gaps(HEAD, traced, "l", deltas[None])[0].left < 1.5


def test_an_eye_without_a_ball_is_measured_from_where_its_centre_would_be() -> None:
    head, margins = eye(with_ball=False)
    closing = lids(-PITCH, -PITCH) - HEAD.skin.mesh.positions
    still, closed = lid_gaps(head, margins, "l", np.stack([0.0 * closing, closing]))
    assert (still.left, still.overlap) == (100.0, 0.0)
    assert closed.left < 1.5


def test_the_right_eye_is_measured_like_the_left_one() -> None:
    head, margins = eye(mirrored=True)
    for pose in ((0.1 * PITCH, -0.3 * PITCH), (-0.6 * PITCH, -0.2 * PITCH)):
        deltas = lids(*pose) - HEAD.skin.mesh.positions
        right = lid_gaps(head, margins, "r", (deltas * [-1.0, 1.0, 1.0])[None])[0]
        left = gap_of(*pose)
        assert right.left == pytest.approx(left.left, abs=1.0)
        assert right.overlap == pytest.approx(left.overlap, abs=0.1)


def test_an_eye_that_skin_covers_at_rest_is_not_measured() -> None:
    closed = HEAD.skin.mesh.at(lids(-0.1 * PITCH, 0.1 * PITCH))
    head = head_of({"skin": closed, "eye_left": HEAD.parts["eye_left"].mesh})
    assert lid_gaps(head, MARGINS, "l", np.zeros((2, closed.vertex_count, 3))) == []
