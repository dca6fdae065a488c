"""Skin that a sheet draws slides over bone and teeth, and sinks in no farther than tissue gives."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.layered.support import Support
from tests.layered.faces import builtin_layered

FACE = builtin_layered()
SUPPORT = Support.of(FACE.skin, FACE.mechanics)
SHEETS = ("zygomaticus_major_l", "risorius_l", "levator_labii_l", "buccinator_r", "platysma_l")


def _inwards(field: np.ndarray) -> np.ndarray:
    return -np.einsum("nd,nd->n", field, SUPPORT.out)


def test_motion_outwards_and_along_the_support_is_left_alone() -> None:
    random = np.random.default_rng(3).normal(scale=5.0, size=SUPPORT.out.shape)
    along = random - np.einsum("nd,nd->n", random, SUPPORT.out)[:, None] * SUPPORT.out
    for field in (along, along + 3.0 * SUPPORT.out):
        np.testing.assert_allclose(SUPPORT.settle(field), field, atol=1e-12)


def test_motion_inwards_ends_where_the_tissue_is_pressed_together() -> None:
    for amount in (0.1, 5.0, 1000.0):
        left = _inwards(SUPPORT.settle(-amount * SUPPORT.out))
        assert (left > 0.0).all()
        assert (left <= np.minimum(amount, SUPPORT.give) * (1.0 + 1e-12)).all()
    slight = 0.02 * SUPPORT.give
    settled = _inwards(SUPPORT.settle(-slight[:, None] * SUPPORT.out))
    np.testing.assert_allclose(settled, slight, rtol=1e-3)


@pytest.mark.parametrize("name", SHEETS)
def test_no_sheet_draws_the_skin_deeper(name: str) -> None:
    field = FACE.fields[name]
    assert (_inwards(field) <= SUPPORT.give + 1e-9).all()
    assert np.linalg.norm(field, axis=1).max() > 2.0


def test_thin_skin_gives_less_than_thick() -> None:
    shown = ~FACE.skin.hidden & (FACE.skin.mobility > 0.5)
    thin, thick = FACE.skin.depth < 5.0, FACE.skin.depth > 11.0
    assert (shown & thin).sum() > 20 < (shown & thick).sum()
    assert SUPPORT.give[shown & thin].mean() < 0.5 * SUPPORT.give[shown & thick].mean()


def test_the_chin_stays_before_the_teeth_in_a_smile() -> None:
    smile = FACE.fields["zygomaticus_major_l"] + FACE.fields["zygomaticus_major_r"]
    landmark = FACE.head.skin_vertex
    assert smile[landmark("2.10"), 2] > -2.5
    assert smile[landmark("2.4"), 0] > 4.0
