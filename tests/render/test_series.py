"""Many pictures of one head from one place."""

from __future__ import annotations

import numpy as np
import pytest

from risorius import builtin_head
from risorius.errors import ParameterError
from risorius.render import render
from risorius.render.bands import in_bands, in_parallel
from risorius.render.heads import Portrait
from risorius.render.series import Series
from tests.face_fixtures import builtin_face

POSES = ({}, {"jaw_pitch": 14.0}, {"zygomaticus_major_l": 1.0, "gaze_yaw_l": 20.0})


@pytest.fixture(scope="module")
def portrait() -> Portrait:
    return Portrait.of(builtin_head())


@pytest.mark.parametrize("view", ["face", "three-quarter", "mouth"])
def test_a_series_shows_what_a_portrait_shows_whatever_moves(portrait: Portrait, view: str) -> None:
    posed = [builtin_face().pose(pose) for pose in POSES]
    quick = Series.of(portrait, view, size=(150, 120)).pictures(posed)
    camera = portrait.camera(view, aspect=150 / 120)
    for positions, picture in zip(posed, quick, strict=True):
        whole = render(portrait.surfaces(positions), camera, size=(150, 120))
        apart = np.abs(picture.astype(int) - whole.astype(int)).max(axis=-1)
        assert (apart > 8).mean() < 2e-3


def test_what_the_camera_never_sees_is_left_out(portrait: Portrait) -> None:
    whole = sum(len(surface.faces) for surface in portrait.surfaces())
    seen = portrait.seen_from(portrait.camera("mouth"))
    assert sum(len(surface.faces) for surface in seen.surfaces()) < 0.75 * whole


def test_an_unknown_view_is_refused(portrait: Portrait) -> None:
    with pytest.raises(ParameterError, match="view"):
        Series.of(portrait, "inside", size=(10, 10))


def test_side_by_side_keeps_the_order_and_draws_each_in_its_own_thread() -> None:
    rows: list[tuple[int, int]] = []

    def made(number: int) -> int:
        in_bands(lambda first, last: rows.append((first, last)), range(512))
        return number

    assert in_parallel(made, list(range(5))) == list(range(5))
    assert rows == [(0, 512)] * 5
    assert in_parallel(made, []) == []
