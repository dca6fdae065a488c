"""Lining of the mouth does not come out through the skin."""

from __future__ import annotations

from functools import cache

import numpy as np

from risorius.anatomy.lining_contact import LiningContact
from risorius.anatomy.skin import Skin
from tests.layered.faces import made_up_layered


def _skin() -> Skin:
    return made_up_layered().skin


@cache
def _contact() -> LiningContact:
    return LiningContact.build(_skin(), made_up_layered().mechanics.lips)


def _nearer(moved: np.ndarray) -> np.ndarray:
    """Return how far (k,) the lining came nearer to the skin in front of it [mm]."""
    contact = _contact()
    front = np.einsum("kc,kcd->kd", contact.shares, moved[contact.corners])
    return np.einsum("kd,kd->k", moved[contact.vertices] - front, contact.directions)


def test_lining_with_skin_in_front_is_found() -> None:
    skin, contact = _skin(), _contact()
    assert len(contact.vertices) > 20
    assert skin.hidden[contact.vertices].all()
    assert not skin.hidden[contact.corners].any()
    assert (contact.slack >= 0.0).all()


def test_lining_that_keeps_its_distance_is_left_alone() -> None:
    together = np.tile([1.0, -2.0, 9.0], (len(_skin().positions), 1))
    assert _contact().hold_back(together) is together


def test_lining_pushed_forwards_ends_behind_the_skin_which_stays() -> None:
    skin, contact = _skin(), _contact()
    moved = np.zeros_like(skin.positions)
    moved[skin.hidden] = [0.0, 0.0, 25.0]
    held = contact.hold_back(moved)
    assert _nearer(moved).max() > contact.slack.max() + 5.0
    assert (_nearer(held) <= contact.slack + 1e-9).all()
    np.testing.assert_array_equal(held[~skin.hidden], moved[~skin.hidden])


def test_skin_that_sinks_pushes_the_lining_ahead_of_it() -> None:
    skin, contact = _skin(), _contact()
    moved = np.zeros_like(skin.positions)
    moved[~skin.hidden] = [0.0, 0.0, -15.0]
    held = contact.hold_back(moved)
    assert (_nearer(held) <= contact.slack + 1e-9).all()
    assert (held[contact.vertices] * contact.directions).sum(axis=1).min() < -1.0
