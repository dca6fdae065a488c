from __future__ import annotations

from pathlib import Path

import pytest

from risorius.controls.fap import faps
from risorius.errors import ParameterError
from risorius.io.motion import read_stream, write_stream
from risorius.playback.clamping import clamped
from risorius.playback.conversion import converted
from risorius.playback.weights import RigWeights
from tests.io.motion.streams import stream_of
from tests.playback.rigs import played_rig


def _weights() -> RigWeights:
    return RigWeights(played_rig())


def test_weights_of_the_wanted_set_pass_unchanged() -> None:
    frames = [{"jawOpen": 0.3, "mouthSmileLeft": 0.2}, {"tongueOut": 1.0}]
    stream, error = converted(stream_of(frames), _weights(), to="arkit")
    for read, wanted in zip(stream, frames, strict=True):
        assert {n: v for n, v in read.values.items() if v} == wanted
    assert len(stream.names) == 52
    assert (error.frame_count, error.largest) == (2, 0.0)


def test_action_units_become_arkit_shapes_that_pose_the_head_alike() -> None:
    frames = [{"au_27": 0.5, "au_12": 0.8, "au_45": 1.0}]
    stream, error = converted(stream_of(frames), _weights(), to="arkit")
    (frame,) = stream
    assert frame.values["jawOpen"] == pytest.approx(0.5, abs=0.05)
    assert frame.values["mouthSmileRight"] == pytest.approx(0.8, abs=0.1)
    assert frame.values["eyeBlinkLeft"] == pytest.approx(1.0, abs=0.05)
    assert 0.0 <= error.mean < 0.3


def test_a_pose_beyond_the_wanted_set_says_how_far_it_is() -> None:
    stream, error = converted(stream_of([{"jawOpen": 1.0}]), _weights(), to="emotions")
    list(stream)
    assert error.mean > 0.5


def test_arkit_becomes_parameters_and_comes_back() -> None:
    weights = _weights()
    frames = [{"jawOpen": 0.4, "mouthSmileLeft": 0.5, "mouthSmileRight": 0.5}]
    faps, _ = converted(stream_of(frames), weights, to="fap")
    (frame,) = faps
    assert frame.values["fap_3"] > 100.0
    back, error = converted(stream_of([dict(frame.values)]), weights, to="arkit")
    (again,) = back
    assert again.values["jawOpen"] == pytest.approx(0.4, abs=0.1)
    assert max(largest for _, largest in error.parameters.values()) < 5.0


def test_turns_of_the_head_are_passed_on_to_parameters() -> None:
    stream, _ = converted(stream_of([{"fap_48": 200.0, "fap_3": 10.0}]), _weights(), to="fap")
    (frame,) = stream
    assert frame.values["fap_48"] == 200.0


def test_turns_of_the_head_are_passed_on_to_other_sets_in_degrees() -> None:
    take = stream_of([{"fap_49": 1e5, "jawOpen": 0.5}])
    stream, _ = converted(take, _weights(), to="arkit")
    assert stream.names[-3:] == ("head_pitch", "head_yaw", "head_roll")
    (frame,) = stream
    assert frame.values["head_yaw"] == pytest.approx(57.29578)
    back, _ = converted(stream, _weights(), to="fap")
    (again,) = back
    assert again.values["fap_49"] == pytest.approx(1e5)


@pytest.mark.real
@pytest.mark.filterwarnings("ignore::risorius.errors.RisoriusWarning")
@pytest.mark.parametrize("name", ["anger", "fear", "joy", "pride"])
def test_what_a_face_can_make_of_a_real_stream_comes_back_within_a_unit(
    real_data: Path, tmp_path: Path, name: str
) -> None:
    weights = _weights()
    read = read_stream(real_data / "xface_fap" / f"{name}.fap")
    made = list(converted(clamped(read), weights, to="fap")[0])
    played, _ = converted(stream_of([frame.values for frame in made]), weights, to="singles")
    write_stream(played, tmp_path / "singles.csv")
    back, _ = converted(read_stream(tmp_path / "singles.csv"), weights, to="fap")
    for first, second in zip(made, back, strict=True):
        for parameter, value in first.values.items():
            number = int(parameter[4:])
            if faps()[number].unit != "AU":
                assert second.values[parameter] == pytest.approx(value, abs=1.0), parameter


def test_the_error_is_that_of_the_latest_passage() -> None:
    stream, error = converted(stream_of([{"au_27": 1.0}] * 3), _weights(), to="arkit")
    list(stream)
    list(stream)
    assert error.frame_count == 3


def test_sets_that_are_unknown_or_absent_are_refused() -> None:
    with pytest.raises(ParameterError, match="to: 'mocap' is not one of"):
        converted(stream_of([]), _weights(), to="mocap")
    with pytest.raises(ParameterError, match="no shapes of the set 'visemes_oculus'"):
        converted(stream_of([]), _weights(), to="visemes_oculus")
