from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from risorius.controls import arkit_shapes, default_presets
from risorius.controls.pair_names import pair_name, pair_of
from risorius.errors import ParameterError
from risorius.playback.pairs import CorrectivePair, find_pairs, with_pairs
from risorius.playback.weights import RigWeights
from risorius.rig import Rig, bake
from risorius.rig.bake import displacement
from tests.face_fixtures import builtin_face
from tests.io.glb import unpack

NAMES = ("jawOpen", "mouthClose", "mouthSmileLeft", "mouthFunnel", "eyeBlinkRight")


@pytest.fixture(scope="module")
def pairs() -> tuple[CorrectivePair, ...]:
    poses = {name: default_presets().arkit[name] for name in NAMES}
    return find_pairs(builtin_face(), poses, budget=4)


def test_lips_that_round_on_an_open_jaw_need_a_corrective(pairs) -> None:
    assert ("jawOpen", "mouthFunnel") in {(pair.first, pair.second) for pair in pairs}
    assert all(pair.largest > 0.5 for pair in pairs)


def test_the_worst_pairs_come_first_and_correctives_bring_all_nearer(pairs) -> None:
    whole = [np.sqrt((pair.deltas**2).sum(axis=1).mean()) for pair in pairs]
    assert len(pairs) >= 3
    assert whole == sorted(whole, reverse=True)
    assert all(pair.after < 0.7 * pair.before for pair in pairs)


def test_shapes_that_move_nothing_in_common_are_no_pair(pairs) -> None:
    assert not any("eyeBlinkRight" in (pair.first, pair.second) for pair in pairs)


def _rig(pairs) -> Rig:
    arkit = default_presets().arkit
    return with_pairs(bake(builtin_face(), {name: arkit[name] for name in NAMES}), pairs)


def test_a_rig_with_correctives_meets_the_simulation(pairs) -> None:
    rig, face, arkit = _rig(pairs), builtin_face(), default_presets().arkit
    assert rig.names[len(NAMES) :] == tuple(pair.name for pair in pairs)
    for pair in pairs:
        weights = RigWeights(rig).of({pair.first: 1.0, pair.second: 1.0})
        posed = rig.frame.to_canonical(rig.posed(dict(zip(rig.names, weights))))
        wanted = face.displace({**arkit[pair.first], **arkit[pair.second]})
        # A shape of one side has its share of what both sides make together.
        for name in (pair.first, pair.second):
            wanted = wanted + displacement(face, arkit[name]) - face.displace(arkit[name])
        assert np.abs(posed - face.head.positions - wanted).max() < 0.01


def test_a_corrective_is_driven_by_the_product_of_both_weights(pairs) -> None:
    rig, pair = _rig(pairs), pairs[0]
    row = rig.names.index(pair.name)
    weights = RigWeights(rig)
    assert weights.of({pair.first: 0.5, pair.second: 0.4})[row] == pytest.approx(0.2)
    assert weights.of({pair.first: 0.5})[row] == 0.0
    assert weights.of({pair.first: 3.0, pair.second: -1.0})[row] == 0.0


def test_names_of_correctives_name_their_shapes() -> None:
    assert pair_of(pair_name("jawOpen", "brow_l")) == ("jawOpen", "brow_l")
    assert [pair_of(name) for name in ("pair_x", "a__b", "pair___b", "jawOpen")] == [None] * 4


def test_a_budget_of_nothing_is_refused() -> None:
    with pytest.raises(ParameterError, match="budget: 0 is below 1"):
        find_pairs(builtin_face(), {}, budget=0)


def test_a_pair_and_its_mirror_image_are_taken_both_or_not_at_all() -> None:
    names = ("mouthSmileLeft", "mouthSmileRight", "mouthUpperUpLeft", "mouthUpperUpRight",
             "jawOpen", "mouthFunnel")  # fmt: skip
    poses = {name: default_presets().arkit[name] for name in names}
    for budget in (1, 2, 3):
        found = find_pairs(builtin_face(), poses, budget=budget)
        sides = [tuple(sorted((pair.first, pair.second))) for pair in found]
        swapped = [tuple(sorted(map(_other_side, names))) for names in sides]
        assert 1 <= len(found) <= budget
        assert set(sides) == set(swapped)


def _other_side(name: str) -> str:
    return next((shape.mirror for shape in arkit_shapes() if shape.name == name), name)


def test_the_sides_of_one_shape_are_no_pair_since_they_add_up() -> None:
    names = ("mouthSmileLeft", "mouthSmileRight")
    poses = {name: default_presets().arkit[name] for name in names}
    assert find_pairs(builtin_face(), poses, budget=10) == ()


def test_contrary_shapes_are_no_pair() -> None:
    names = ("eyeLookInLeft", "eyeLookOutLeft", "jawLeft", "jawRight")
    poses = {name: default_presets().arkit[name] for name in names}
    assert find_pairs(builtin_face(), poses, budget=10) == ()


def test_the_short_search_finds_what_trying_all_pairs_finds() -> None:
    names = (*NAMES, "mouthPucker", "mouthLeft", "cheekPuff", "mouthRollLower", "tongueOut")
    poses = {name: default_presets().arkit[name] for name in names}
    face = builtin_face()
    distances = {}
    alone = {name: face.displace(pose) for name, pose in poses.items()}
    for a, b in combinations(names, 2):
        both = {n: poses[a].get(n, 0.0) + poses[b].get(n, 0.0) for n in {**poses[a], **poses[b]}}
        distances[a, b] = float(((face.displace(both) - alone[a] - alone[b]) ** 2).sum())
    best = sorted(distances, key=lambda pair: -distances[pair])[:4]
    told: list[tuple[int, int, str]] = []
    found = find_pairs(face, poses, budget=4, progress=lambda *one: told.append(one))
    assert len(told) < told[0][1]
    assert {frozenset((pair.first, pair.second)) for pair in found} == set(map(frozenset, best))


def test_a_file_says_which_shapes_drive_a_corrective(pairs, tmp_path) -> None:
    rig = _rig(pairs)
    rig.save(tmp_path / "x.glb")
    json, _ = unpack((tmp_path / "x.glb").read_bytes())
    told = json["asset"]["extras"]["risorius"]["correctives"]
    assert told == {pair.name: [pair.first, pair.second] for pair in pairs}
    assert Rig.load(tmp_path / "x.glb").names == rig.names


def test_a_shape_made_upon_another_forms_no_pairs() -> None:
    poses = {name: default_presets().arkit[name] for name in NAMES}
    upon = {"mouthClose": poses["jawOpen"]}
    found = find_pairs(builtin_face(), poses, budget=10, upon=upon)
    assert found
    assert not any("mouthClose" in (pair.first, pair.second) for pair in found)
