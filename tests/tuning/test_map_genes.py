"""Genes of layered muscles."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from risorius.errors import ParameterError
from risorius.layered import LayeredFace
from risorius.layered.muscle import MouthAction, Sheet
from risorius.layered.muscle_map import MuscleMap, default_muscle_map, parse_muscle_map
from risorius.tuning import Session
from risorius.tuning.candidates import sensitivity_of
from risorius.tuning.map_genes import MapCandidates, apply_map_genes, map_muscles, map_parameters
from tests.tuning.faces import builtin_bench, expression, values_at

MAP = default_muscle_map()
ACTIVE = tuple(muscle.name for muscle in MAP.muscles if muscle.action is not None)
ALL = map_parameters(MAP, ACTIVE, genes="all")


def _genes(name: str, *, genes: str = "published") -> set[str]:
    found = map_parameters(MAP, [name], genes="all" if genes == "all" else "published")
    return {each.name.partition(".")[2] for each in found}


def test_a_sheet_has_its_ends_width_contraction_reach_and_hold() -> None:
    ends = {f"{end}_{axis}" for end in ("origin", "insertion") for axis in "xyz"}
    plain = {"shortening", "half_width", "reach", "stiffness", "fixed_point"}
    assert _genes("zygomaticus_major") == ends | plain
    ours = {"tangential", "arch", "corner", "push", "bulge"}
    assert _genes("zygomaticus_major", genes="all") == ends | plain | ours


def test_thickness_is_a_gene_where_another_sheet_lies_on_the_muscle() -> None:
    assert "thickness" in _genes("frontalis_inner")
    assert "thickness" not in _genes("mentalis")


def test_sphincters_have_what_their_kind_has() -> None:
    assert _genes("orbicularis_oris") == {
        "narrow", "forward", "squeeze", "turn", "stiffness", "window",
    }  # fmt: skip
    assert _genes("orbicularis_oculi") == {"shortening", "pull_x", "pull_y", "stiffness", "window"}
    # What a ring does not do cannot be scaled.
    oris = MAP.by_name["orbicularis_oris"]
    assert isinstance(oris.action, MouthAction)
    plain = replace(oris, on=(), action=replace(oris.action, narrow=0.0, squeeze=0.0))
    found = map_parameters(MuscleMap((plain,), MAP.landmarks), ["orbicularis_oris"])
    assert [each.name.partition(".")[2] for each in found] == [
        "forward", "turn", "stiffness", "window",
    ]  # fmt: skip


def test_neutral_genes_leave_the_same_muscles() -> None:
    start = {each.name: each.start for each in ALL}
    assert all(a is b for a, b in zip(apply_map_genes(MAP, start).muscles, MAP.muscles))
    assert all(a is b for a, b in zip(apply_map_genes(MAP, {"vomer.x": 1.0}).muscles, MAP.muscles))


@pytest.mark.parametrize("share", [0.0, 0.35, 1.0])
def test_every_value_in_bounds_is_a_map_that_its_file_keeps(share: float) -> None:
    tuned = apply_map_genes(MAP, values_at(ALL, share))
    again = parse_muscle_map(tuned.to_json(), source="tuned")
    assert again.to_json() == tuned.to_json()
    changed = [a.name for a, b in zip(tuned.muscles, MAP.muscles) if a is not b]
    assert set(changed) == set(ACTIVE)


def test_ends_shift_by_shares_of_the_skull_and_the_line_follows() -> None:
    width = 2.0 * MAP.landmarks["zygion_l"][0]
    values = {"risorius.origin_y": 0.03, "risorius.insertion_x": -0.02}
    before = MAP.by_name["risorius"].shape
    after = apply_map_genes(MAP, values).by_name["risorius"].shape
    assert isinstance(before, Sheet) and isinstance(after, Sheet)
    shift = after.line - before.line
    assert np.allclose(shift[0], [0.0, 0.03 * width, 0.0])
    assert np.allclose(shift[-1], [-0.02 * width, 0.0, 0.0])
    inner = shift[1:-1]
    assert ((inner[:, 1] > 0.0) & (inner[:, 1] < shift[0, 1])).all()


def test_genes_mean_the_same_on_a_skull_of_another_size() -> None:
    muscles = tuple(
        replace(muscle, shape=replace(muscle.shape, line=2.0 * muscle.shape.line))
        if isinstance(muscle.shape, Sheet)
        else muscle
        for muscle in MAP.muscles
    )
    marks = {name: 2.0 * place for name, place in MAP.landmarks.items()}
    double = MuscleMap(muscles, marks)
    values = {"risorius.origin_y": 0.03, "risorius.insertion_z": 0.04}
    small, large = (apply_map_genes(each, values).by_name["risorius"] for each in (MAP, double))
    assert isinstance(small.shape, Sheet) and isinstance(large.shape, Sheet)
    assert np.allclose(large.shape.line, 2.0 * small.shape.line)


def test_a_window_keeps_its_full_effect_and_ends_farther_out() -> None:
    after = apply_map_genes(MAP, {"orbicularis_oris.window": 1.25}).by_name["orbicularis_oris"]
    before = MAP.by_name["orbicularis_oris"].action
    assert isinstance(before, MouthAction) and isinstance(after.action, MouthAction)
    assert after.action.window[0] == before.window[0]
    width = [action.window[1] - action.window[0] for action in (before, after.action)]
    assert width[1] == pytest.approx(1.25 * width[0])


def test_an_expression_names_its_muscles() -> None:
    pose = {"zygomaticus_major_r": 0.5, "procerus": 0.2, "risorius_l": 0.0, "jaw_pitch": 3.0}
    assert map_muscles(MAP, pose) == ("procerus", "zygomaticus_major")


def test_a_muscle_that_is_not_there_is_refused() -> None:
    with pytest.raises(ParameterError, match="there is no 'vomer'; it has"):
        map_parameters(MAP, ["vomer"])


def test_a_skull_without_width_is_refused() -> None:
    bare = MuscleMap(MAP.muscles, {})
    with pytest.raises(ParameterError, match="add the landmarks zygion_l and zygion_r"):
        apply_map_genes(bare, {"risorius.origin_y": 0.03})


def test_candidates_are_the_faces_of_their_maps_to_the_last_bit() -> None:
    bench = builtin_bench()
    pose = expression(bench.face, "sadness")
    candidates = MapCandidates.of_bench(bench, map_muscles(MAP, pose), pose)
    values = values_at(candidates.genome.parameters, 0.7)
    slow = LayeredFace.build(bench.face.head, apply_map_genes(MAP, values))
    assert (candidates.positions(values) == slow.pose(pose)).all()
    assert np.abs(candidates.positions(values) - bench.face.pose(pose)).max() > 0.3


def test_a_face_does_not_depend_on_the_faces_made_before() -> None:
    bench = builtin_bench()
    pose = expression(bench.face, "anger")
    names = ("corrugator", "procerus", "depressor_anguli")
    used, fresh = (MapCandidates.of_bench(bench, names, pose) for _ in range(2))
    values = values_at(used.genome.parameters, 0.7)
    used.positions(values)
    used.positions({**values, "corrugator.reach": 0.9})
    wanted = {**values, "procerus.shortening": 0.8}
    assert (used.positions(wanted) == fresh.positions(wanted)).all()
    assert (used.positions({}) == bench.face.pose(pose)).all()


def test_a_picked_face_survives_and_genes_that_matter_are_felt() -> None:
    bench = builtin_bench()
    pose = expression(bench.face, "anger")
    candidates = MapCandidates.of_bench(bench, ("corrugator",), pose)
    effect = np.abs(sensitivity_of(candidates)).max(axis=0)
    assert (effect > 0.05).all()
    session = Session(candidates.genome, strategy="genetic", seed=1)
    liked = session.generation.candidates[4].copy()
    assert (session.pick([4]).candidates[0] == liked).all()
