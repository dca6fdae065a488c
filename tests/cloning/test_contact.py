"""Lids close by the share that one sees; lips that stay closed on the source do not gape."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from risorius.cloning.lid_contact import LidContact
from risorius.cloning.lip_seal import LipSeal
from risorius.cloning.lip_sight import LIP_PLACES, LipSight
from risorius.cloning.local_field import LocalField
from risorius.cloning.subject import Subject
from risorius.rig.quality.lid_gap import LidGap, lid_gaps
from tests.cloning.rigs import dense, other_cloning, self_cloning, source_rig

STILL = np.zeros_like(self_cloning().source.mesh.positions)


@cache
def skin_of(name: str) -> np.ndarray:
    """Return a shape of the built-in head on its welded skin [mm]."""
    head = self_cloning().source.head
    row = source_rig().names.index(name)
    return head.frame.vectors_to_canonical(dense(source_rig())[row])[head.skin.first_source()]


def gap(subject: Subject, moved: np.ndarray) -> LidGap:
    return lid_gaps(subject.head, subject.lids["l"], "l", moved[None])[0]


@pytest.mark.parametrize("share", [0.7, 1.2])
def test_lids_that_close_too_little_or_too_far_close_as_the_source_s(share: float) -> None:
    source, target = self_cloning().source, other_cloning().target
    contact = LidContact(source, target, "l")
    moved = share * skin_of("blink")
    step = contact.correct(skin_of("blink"), moved)
    assert step is not None
    wanted, made = gap(source, skin_of("blink")), gap(target, moved + step)
    assert made.left == pytest.approx(wanted.left, abs=5.0)
    assert made.overlap == pytest.approx(wanted.overlap, abs=5.0)
    before = gap(target, moved)
    assert abs(before.left - wanted.left) + abs(before.overlap - wanted.overlap) > 10.0


def test_lids_that_close_alike_are_left_alone() -> None:
    source = self_cloning().source
    assert LidContact(source, source, "l").correct(skin_of("blink"), skin_of("blink")) is None


def test_lids_that_only_narrow_are_left_alone() -> None:
    source, target = self_cloning().source, other_cloning().target
    narrow = 0.3 * skin_of("blink")
    assert LidContact(source, target, "l").correct(narrow, 0.2 * skin_of("blink")) is None


def parted(subject: Subject, height: float) -> np.ndarray:
    """Return motion that parts the lips by `height` near the left corner, fading elsewhere."""
    lips = subject.lips
    assert lips is not None
    lines = (lips.slit.upper, lips.slit.lower)
    field = LocalField(
        subject.mesh,
        np.asarray(lips.distance < 0.3 * lips.width),
        lines,
        length=0.15 * lips.width,
        bend=0.05 * lips.width,
    )
    goal = np.zeros_like(subject.mesh.positions)
    for line, sign in zip(lines, (0.5, -0.5)):
        place = np.linspace(0.0, 1.0, len(line))
        bump = np.exp(-(((place - 0.15) / 0.1) ** 2)) * np.minimum(place / 0.05, 1.0)
        goal[line, 1] = sign * height * bump
    result = np.zeros_like(goal)
    result[field.vertices] = field.solve(goal)
    return result


def grown(subject: Subject, moved: np.ndarray) -> np.ndarray:
    assert subject.lips is not None
    sight = LipSight(subject.head, subject.lips)
    return sight.gaps(moved) - sight.gaps(np.zeros_like(moved))


def test_the_gap_is_seen_where_the_lips_part_and_as_high_as_they_do() -> None:
    source = self_cloning().source
    seen = grown(source, parted(source, 3.0))
    assert 1.5 < seen.max() < 3.5
    assert 0.05 < LIP_PLACES[seen.argmax()] < 0.3
    assert seen[LIP_PLACES > 0.6].max() == 0.0


def test_lips_that_gape_beside_a_source_s_closed_ones_are_sealed() -> None:
    source, target = self_cloning().source, other_cloning().target
    assert target.lips is not None
    seal = LipSeal(source, target, turn=np.eye(3), scale=1.0)
    gaping = parted(target, 3.0)
    assert grown(target, gaping).max() > 1.5
    step = seal.correct(STILL, gaping)
    assert step is not None
    assert grown(target, gaping + step).max() < 0.025 * target.lips.width
    assert not step[target.lips.distance > 0.5 * target.lips.width].any()


@pytest.mark.parametrize("name", ["jawOpen", "smile"])
def test_lips_that_open_as_the_source_s_do_are_left_alone(name: str) -> None:
    source = self_cloning().source
    seal = LipSeal(source, source, turn=np.eye(3), scale=1.0)
    assert seal.correct(skin_of(name), skin_of(name)) is None
