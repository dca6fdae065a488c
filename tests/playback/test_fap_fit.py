from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from risorius.controls.fap import faps
from risorius.errors import LandmarkError, ParameterError
from risorius.io.motion import read_stream
from risorius.playback.clamping import clamped
from risorius.playback.fap_fit import FapFit
from risorius.playback.fap_shapes import solve_fap_shapes
from risorius.rig import MorphTarget, bake
from tests.face_fixtures import builtin_face
from tests.playback.rigs import played_rig


@pytest.fixture(scope="module")
def fit() -> FapFit:
    return FapFit.of_rig(played_rig())


def test_rest_asks_for_no_weight(fit: FapFit) -> None:
    assert not fit.weights({}).any()
    assert not fit.weights({"fap_3": 0.0, "fap_12": 0.0}).any()


def test_weights_stay_within_their_bounds_however_much_is_asked(fit: FapFit) -> None:
    weights = fit.weights({fap.target: fap.high for fap in faps().values()})
    assert weights.min() >= 0.0
    assert weights.max() <= 1.0
    assert weights.max() == 1.0


def test_parameters_that_muscles_make_come_back_within_a_unit(fit: FapFit) -> None:
    rng = np.random.default_rng(5)
    worst = []
    for _ in range(10):
        weights = np.zeros(fit.matrix.shape[1])
        chosen = rng.choice(fit.basis, 6, replace=False)
        weights[chosen] = rng.uniform(0.0, 0.8, 6)
        # No face moves a control both of its ways.
        weights[fit.basis[fit.contraries[:, 1]]] = 0.0
        asked = fit.values(weights)
        again = fit.values(fit.weights(asked))
        worst.append(
            max(abs(again[n] - v) for n, v in asked.items() if faps()[int(n[4:])].unit != "AU")
        )
    assert max(worst) < 0.5
    assert np.median(worst) < 0.1


def test_no_control_goes_both_of_its_ways_at_once(fit: FapFit) -> None:
    names = played_rig().names
    ends = {(names[fit.basis[a]], names[fit.basis[b]]) for a, b in fit.contraries}
    assert ("jaw_pitch", "jaw_pitch_neg") in ends
    assert ("gaze_yaw_l", "gaze_yaw_l_neg") in ends
    rng = np.random.default_rng(11)
    for _ in range(20):
        asked = {f.target: float(rng.uniform(f.low, f.high)) for f in faps().values()}
        weights = fit.weights(asked)[fit.basis]
        assert not (weights[fit.contraries] > 0.0).all(axis=1).any()


def test_what_moves_slowly_is_answered_without_jumps(fit: FapFit) -> None:
    rng = np.random.default_rng(3)
    lengths = [faps()[n].unit != "AU" for n in fit.reading.numbers]
    shares = np.linspace(0.0, 1.0, 121)
    for _ in range(6):
        start, end = (
            {f.target: float(rng.uniform(f.low, f.high)) for f in faps().values()} for _ in range(2)
        )
        path = np.array(
            [
                fit.matrix @ fit.weights({n: v + share * (end[n] - v) for n, v in start.items()})
                for share in shares
            ]
        )[:, lengths]
        jumps = np.abs(np.diff(path, axis=0)).max(axis=1)
        assert jumps.max() < 0.15 * np.abs(path[-1] - path[0]).max()


def test_the_answer_does_not_depend_on_earlier_frames(fit: FapFit) -> None:
    asked = {"fap_3": 300.0, "fap_12": 120.0}
    first = fit.weights(asked)
    fit.weights({"fap_3": 900.0, "fap_31": 100.0})
    assert np.array_equal(fit.weights(asked), first)


def test_a_rig_of_parameter_shapes_plays_them_in_their_units() -> None:
    face = builtin_face()
    poses = solve_fap_shapes(face, numbers=(3, 12, 13)).poses()
    fit = FapFit.of_rig(bake(face, poses))
    made = fit.values(fit.weights({"fap_12": 150.0}))
    assert made["fap_12"] == pytest.approx(150.0, rel=0.05)
    below = fit.values(fit.weights({"fap_12": -150.0}))
    assert below["fap_12"] == pytest.approx(-150.0, rel=0.05)


def test_a_rig_without_landmarks_or_motion_is_refused() -> None:
    rig = played_rig()
    with pytest.raises(LandmarkError, match="units of MPEG-4 parameters need them"):
        FapFit.of_rig(replace(rig, landmarks={}))
    still = MorphTarget("still", np.zeros(0, np.int32), np.zeros((0, 3)))
    with pytest.raises(ParameterError, match="no target moves anything"):
        FapFit.of_rig(rig.with_targets([still]))


@pytest.mark.real
@pytest.mark.filterwarnings("ignore::risorius.errors.RisoriusWarning")
def test_a_real_stream_is_followed_where_the_face_can(real_data: Path, fit: FapFit) -> None:
    differences: dict[str, list[float]] = {}
    for frame in clamped(read_stream(real_data / "xface_fap" / "joy.fap")):
        made = fit.values(fit.weights(frame.values))
        for name in ("fap_6", "fap_7", "fap_12", "fap_13", "fap_5", "fap_19"):
            differences.setdefault(name, []).append(made[name] - frame.values[name])
    for name, found in differences.items():
        assert np.sqrt(np.square(found).mean()) < 40.0, name


def test_a_parameter_alone_moves_its_point_by_what_is_asked_where_muscles_reach(
    fit: FapFit,
) -> None:
    met = set()
    for number in fit.reading.numbers:
        fap = faps()[number]
        for sign in (1,) if fap.one_way else (1, -1):
            asked = {fap.target: 100.0 * sign}
            made = fit.values(fit.weights(asked))[fap.target]
            assert sign * made < 110.0
            if sign * made > 90.0:
                met.add(number)
    # Ears, pupils and bulging eyes have no muscles; the turns of the head are no weights.
    assert len(met) >= 45
    assert {3, 4, 5, 6, 7, 12, 13, 14, 16, 19, 20, 23, 24, 25, 26, 31, 32, 45, 51, 52} <= met
