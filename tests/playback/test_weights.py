from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import RisoriusWarning
from risorius.playback.clamping import clamped
from risorius.playback.shape_names import TARGET_SETS, set_of
from risorius.playback.weights import RigWeights
from tests.io.motion.streams import stream_of
from tests.playback.rigs import played_rig


def test_names_of_targets_are_their_weights() -> None:
    rig = played_rig()
    row = RigWeights(rig).of({"jawOpen": 0.4, "joy": 0.2})
    assert row[rig.names.index("jawOpen")] == 0.4
    assert row.sum() == pytest.approx(0.6)


def test_a_shape_that_the_rig_lacks_is_made_of_its_muscles() -> None:
    rig = played_rig()
    singles = rig.subset([name for name in rig.names if set_of(name) == "singles"])
    weights = RigWeights(singles)
    row = weights.of({"eyeLookInLeft": 0.5, "jawOpen": 1.0})
    made = dict(zip(singles.names, row))
    assert made["jaw_pitch"] == 1.0
    assert made["gaze_yaw_l_neg"] == pytest.approx(0.5 * 32 / 40)
    assert weights.unmatched == {}


def test_one_muscle_is_never_asked_for_more_than_it_has() -> None:
    rig = played_rig()
    singles = rig.subset([name for name in rig.names if set_of(name) == "singles"])
    row = RigWeights(singles).of({"jawOpen": 1.0, "surprise": 1.0, "aah": 0.0})
    assert row.max() == 1.0


def test_what_the_rig_cannot_play_is_remembered_with_the_reason() -> None:
    weights = RigWeights(played_rig())
    weights.of({"HeadYaw": 0.1, "fap_48": 20.0, "fap_29": 0.0, "fap_3": 1.0})
    assert set(weights.unmatched) == {"HeadYaw", "fap_48"}
    assert "no such target" in weights.unmatched["HeadYaw"]
    assert "turns the whole head" in weights.unmatched["fap_48"]


def test_every_target_belongs_to_a_known_set() -> None:
    found = {set_of(name) for name in played_rig().names}
    assert found == {"singles", "emotions", "arkit", "facs"}
    assert {set_of(n) for n in ("fap_3", "fap_3_neg", "viseme_oculus_sil", "Mouth")} <= set(
        TARGET_SETS
    )


def test_insane_values_are_clamped_with_one_warning_each() -> None:
    stream = clamped(stream_of([{"fap_3": 9999.0, "fap_12": -9999.0, "x": 9999.0}] * 3))
    with pytest.warns(RisoriusWarning) as caught:
        frames = list(stream)
    assert [str(w.message).split(": ")[1].split()[0] for w in caught] == ["fap_3", "fap_12"]
    assert frames[2].values == {"fap_3": 1080.0, "fap_12": -600.0, "x": 9999.0}


def test_parameters_of_one_direction_do_not_point_backwards() -> None:
    with pytest.warns(RisoriusWarning, match=r"fap_3 \(open_jaw\) is -5 in frame 0"):
        (frame,) = clamped(stream_of([{"fap_3": -5.0}]))
    assert frame.values == {"fap_3": 0.0}


def test_values_within_bounds_pass_in_silence() -> None:
    frames = [{"fap_3": 100.0, "fap_12": -100.0}]
    assert [f.values for f in clamped(stream_of(frames))] == frames


def test_weights_are_finite_for_every_mix() -> None:
    row = RigWeights(played_rig()).of({"fap_3": 500.0, "joy": 0.5, "viseme_mpeg4_aa": 0.5})
    assert np.isfinite(row).all()
