from __future__ import annotations

import numpy as np
import pytest

from risorius.controls import default_presets
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
    weights.of({"HeadYaw": 0.1, "Smirk": 0.1, "fap_47": 20.0, "fap_29": 0.0, "fap_3": 1.0})
    assert set(weights.unmatched) == {"HeadYaw", "Smirk", "fap_47"}
    assert "name the column head_pitch, head_yaw or head_roll" in weights.unmatched["HeadYaw"]
    assert "no such target" in weights.unmatched["Smirk"]
    assert "no control rolls the tongue" in weights.unmatched["fap_47"]


def test_turns_of_the_head_are_left_to_the_player() -> None:
    weights = RigWeights(played_rig())
    assert not weights.of({"head_yaw": 10.0, "fap_48": 500.0}).any()
    assert weights.unmatched == {}


def test_a_control_that_the_face_lacks_is_replaced_as_the_presets_say() -> None:
    rig = played_rig()
    singles = rig.subset([name for name in rig.names if set_of(name) == "singles"])
    absent = {"frontalis_inner_l", "frontalis_inner_r", "frontalis_outer_l", "frontalis_outer_r"}
    assert absent & {control.name for control in rig.controls}, "the face has these muscles"
    kept = tuple(control for control in rig.controls if control.name not in absent)
    fewer = singles.subset([n for n in singles.names if n not in absent])
    fewer = fewer.with_targets(fewer.targets, controls=kept)
    row = RigWeights(fewer).of({"browInnerUp": 1.0})
    used = {name for name, weight in zip(fewer.names, row) if weight}
    assert used == set(default_presets().fit(default_presets().arkit["browInnerUp"], kept).pose)


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
