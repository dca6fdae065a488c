from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.template import builtin_head
from risorius.controls.fap import faps
from risorius.playback import FapReading
from risorius.rig.bake import empty_rig
from tests.face_fixtures import builtin_face

HEAD = builtin_head()
READING = FapReading.of_head(HEAD)


def _value(values: np.ndarray, number: int) -> float:
    return float(values[READING.numbers.index(number)])


def test_every_parameter_is_read_or_left_out_with_a_reason() -> None:
    assert set(READING.numbers) | set(READING.left_out) == set(faps())
    assert not set(READING.numbers) & set(READING.left_out)
    assert set(READING.left_out) == {29, 30, 47, 48, 49, 50}


def test_a_head_at_rest_reads_zero_everywhere() -> None:
    assert not READING.values(np.zeros_like(HEAD.positions)).any()


def test_lifting_the_whole_head_is_read_in_the_units_of_each_point() -> None:
    deltas = np.zeros_like(HEAD.positions)
    deltas[:, 1] = 2.0
    values = READING.values(deltas)
    for number, sign in ((3, -1), (5, 1), (12, 1), (19, -1), (31, 1), (51, -1)):
        unit = READING.unit[READING.numbers.index(number)]
        assert _value(values, number) == pytest.approx(sign * 2.0 / unit)
    assert abs(_value(values, 23)) < 1e-6
    assert _value(values, 6) == 0.0


def test_reading_is_linear_for_points() -> None:
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(2, *HEAD.positions.shape))
    # Turns are not, nor is the centre of what turns.
    points = [faps()[n].unit != "AU" and n not in (27, 28) for n in READING.numbers]
    summed = READING.values(a) + 2 * READING.values(b)
    assert np.allclose(READING.values(a + 2 * b)[points], summed[points])


@pytest.mark.parametrize(("axis", "number"), [(1, 23), (0, 25)])
def test_a_turned_eyeball_is_read_as_its_angle(axis: int, number: int) -> None:
    angle = np.radians(20.0)
    rows = READING.eyes["3.5"]
    rest = HEAD.positions[rows]
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array(
        [[c, 0, s], [0, 1, 0], [-s, 0, c]] if axis else [[1, 0, 0], [0, c, -s], [0, s, c]]
    )
    deltas = np.zeros_like(HEAD.positions)
    deltas[rows] = (rest - rest.mean(axis=0)) @ turn.T - (rest - rest.mean(axis=0))
    values = READING.values(deltas)
    assert _value(values, number) == pytest.approx(angle / 1e-5, rel=1e-9)
    assert abs(_value(values, number + 1)) < 1e-6


def test_a_rig_reads_as_the_head_it_was_made_of() -> None:
    reading = FapReading.of_rig(empty_rig(HEAD))
    assert reading.numbers == READING.numbers
    assert np.allclose(reading.unit, READING.unit)
    deltas = np.random.default_rng(1).normal(size=HEAD.positions.shape)
    assert np.allclose(reading.values(deltas), READING.values(deltas))


def test_an_eyeball_that_turns_is_not_thrust_and_one_that_comes_out_is() -> None:
    face = builtin_face()
    reading = FapReading.of_head(face.head)
    row, turn = reading.numbers.index(27), reading.numbers.index(23)
    turned = face.displace({"gaze_yaw_l": 30.0, "gaze_pitch_l": -20.0})
    thrust = reading.point_motion(turned)[row]
    assert np.linalg.norm(thrust) < 0.3  # the cornea bends the sphere that is fitted a little
    assert reading.values(turned)[turn] > 4e4
    out = np.zeros_like(turned)
    out[reading.eyes["3.5"]] = (0.0, 0.0, 2.0)
    both = reading.point_motion(turned + out)[row]
    np.testing.assert_allclose(both - thrust, (0, 0, 2), atol=0.2)
    np.testing.assert_allclose(reading.point_motion(out)[row], (0, 0, 2), atol=1e-9)
