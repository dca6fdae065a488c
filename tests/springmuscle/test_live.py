"""The live session: steps that fit into a frame, the same rest as a bake."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import ParameterError
from risorius.springmuscle.live import steps_that_fit
from risorius.springmuscle.parameters import SpringParameters
from tests.springmuscle.faces import SMILE, smiling

FAITHFUL = SpringParameters.of_profile("faithful")


def test_steps_fill_the_slot_and_there_is_always_one() -> None:
    # Acceptance 12: the adaptive rule yields at least one step.
    assert steps_that_fit(0.02, 1e-3) == 20
    assert steps_that_fit(0.0, 1e-3) == 1
    assert steps_that_fit(0.02, 10.0) == 1
    assert steps_that_fit(0.02, 0.0) >= 1
    assert steps_that_fit(1e9, 1e-6) < 1000


def test_a_session_begins_at_rest() -> None:
    face = smiling()
    assert (face.live().step(steps=3) == face.head.positions).all()


def test_a_session_comes_to_rest_where_the_bake_does() -> None:
    face, session = smiling(), smiling().live()
    session.set({**SMILE, "jaw_pitch": 5.0})
    for _ in range(12):
        found = session.step(steps=40)
    expected = face.pose({**SMILE, "jaw_pitch": 5.0})
    assert np.abs(found - expected).max() < 0.02 * np.abs(expected - face.head.positions).max()
    assert session.steps == 0


def _after_letting_go(parameters: SpringParameters | None) -> np.ndarray:
    """Return how far every vertex is from rest after a smile and an open mouth."""
    face = smiling(parameters)
    session = face.live()
    found = face.head.positions
    for pose in (SMILE, {"jaw_pitch": 15.0}, {}):
        session.set(pose)
        for _ in range(20):
            found = session.step(steps=100)
    return np.linalg.norm(found - face.head.positions, axis=1)


def test_letting_go_returns_exactly_to_the_input() -> None:
    assert (_after_letting_go(None) == 0.0).all()


def test_published_springs_return_within_the_tolerance() -> None:
    left = _after_letting_go(FAITHFUL)
    assert np.median(left) < 0.1
    assert left.max() < 5.0


def test_the_first_step_is_most_of_the_way() -> None:
    # The over-relaxation takes the skin along before any spring pulls.
    face, session = smiling(), smiling().live()
    session.set(SMILE)
    expected = face.pose(SMILE)
    way = np.linalg.norm(expected - face.head.positions)
    assert np.linalg.norm(session.step(steps=1) - expected) < 0.2 * way


def test_the_same_frames_give_the_same_bytes() -> None:
    results = []
    for _ in range(2):
        session = smiling().live()
        session.set(SMILE)
        results.append([session.step(steps=7).tobytes() for _ in range(3)])
    assert results[0] == results[1]


def test_frames_by_the_clock_take_steps_and_stay_finite() -> None:
    session = smiling().live()
    session.set(SMILE)
    taken = 0
    for _ in range(4):
        found = session.step(0.002)
        taken += session.steps
    assert taken >= 4
    assert np.isfinite(found).all()


def test_wild_changes_never_explode() -> None:
    face, session = smiling(), smiling().live()
    generator = np.random.default_rng(7)
    for _ in range(40):
        session.set(
            {
                "zygomaticus_major_l": float(generator.random() < 0.5),
                "zygomaticus_major_r": generator.random(),
                "jaw_pitch": 18.0 * generator.random(),
            }
        )
        found = session.step(steps=3)
        assert np.abs(found - face.head.positions).max() < 80.0


def test_what_cannot_be_asked_for_is_refused() -> None:
    session = smiling().live()
    with pytest.raises(ParameterError, match="slot"):
        session.step(-1.0)
    with pytest.raises(ParameterError, match="steps"):
        session.step(steps=0)
    with pytest.raises(ParameterError, match="no_such"):
        session.set({"no_such": 1.0})
