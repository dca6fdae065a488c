"""Pages with all shapes of a rig."""

from __future__ import annotations

import numpy as np
import pytest

from risorius import Rig
from risorius.errors import ParameterError
from risorius.render.rig_sheet import rig_sheet, view_sheet
from risorius.rig import MorphTarget
from tests.synthetic import quad_mesh


def _rig(*names: str) -> Rig:
    mesh = quad_mesh()
    lift = np.zeros_like(mesh.positions)
    lift[4] = [0.0, 0.0, 2.0]
    return Rig(mesh, tuple(MorphTarget.from_dense(name, lift) for name in names))


def _rows(page: np.ndarray) -> int:
    """Count the rows of pictures: bands that are not the colour of the page."""
    inked = (page[:, 40] != page[0, 0]).any(axis=1)
    runs = np.flatnonzero(np.diff(np.concatenate([[0], inked, [0]]).astype(int)) == 1)
    ends = np.flatnonzero(np.diff(np.concatenate([[0], inked, [0]]).astype(int)) == -1)
    return int((ends - runs > 30).sum())


def test_every_shape_is_drawn_once_after_the_neutral_and_the_emotions_come_first() -> None:
    seen: list[str] = []
    rig = _rig("one", "jawOpen", "joy", "two")
    rig_sheet(
        rig, cell=40, progress=lambda done, count, name: seen.append(f"{done}/{count} {name}")
    )
    assert seen == ["0/5 neutral", "1/5 joy", "2/5 jawOpen", "3/5 one", "4/5 two"]


def test_the_width_is_that_of_the_columns_and_rows_are_filled_up() -> None:
    names = [f"shape_{number}" for number in range(7)]
    page = rig_sheet(_rig(*names), columns=3, cell=48)
    assert page.shape[1] == 3 * (48 + 6) + 6
    assert _rows(page) == 1 + 3


def test_emotions_are_larger() -> None:
    small = rig_sheet(_rig("one"), columns=10, cell=40)
    assert _rows(small) == 2
    with_emotion = rig_sheet(_rig("joy"), columns=10, cell=40)
    assert _rows(with_emotion) == 1


def test_the_same_rig_makes_the_same_page() -> None:
    rig = _rig("joy", "one")
    assert (rig_sheet(rig, cell=40) == rig_sheet(rig, cell=40)).all()


def test_a_page_without_columns_is_refused() -> None:
    with pytest.raises(ParameterError, match="at least 1 column"):
        rig_sheet(_rig("joy"), columns=0)


def test_a_page_of_views_has_a_row_per_pose_and_a_column_per_view() -> None:
    seen: list[str] = []
    page = view_sheet(
        _rig("joy"),
        {"neutral": {}, "much joy": {"joy": 1.0}},
        ["front", "profile", "three-quarter"],
        cell=40,
        progress=lambda done, count, name: seen.append(name),
    )
    assert page.shape[1] == 3 * 46 + 6
    assert _rows(page) == 2
    assert len(seen) == 6
    assert seen[3] == "much joy, front"
    # The triangle that joy lifts is seen from the side in the middle column.
    middle = page[:, 46:92].astype(int)
    half = len(page) // 2
    assert (middle[:half] != middle[half : 2 * half]).any()
