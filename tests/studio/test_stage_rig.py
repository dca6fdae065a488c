"""The stage as a rig: what a page shows from weights alone is what the rig says."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from risorius.controls.shape_sets import list_shapes
from risorius.errors import Cancelled
from risorius.io.motion import read_stream
from risorius.project import Project
from risorius.rig.bake import bake
from risorius.studio.baking import bake_subject
from risorius.studio.jobs import Job
from risorius.studio.scene import GROUPS, Stage, stage_of
from risorius.studio.stage_rig import LARGEST, StageRig
from risorius.studio.subject import build_subject
from risorius.studio.take import open_take
from risorius.studio.work import work_of
from tests.tools import real_data_folder

NEAR = 1.0 / 128.0


@cache
def _baked(method: str = "layered") -> StageRig:
    stage = stage_of(build_subject(work_of(Project(method=method))))
    subject = stage.subject
    shapes = list_shapes(subject.face.controls, subject.presets, sets=("singles", "emotions"))
    rig = bake(subject.face, shapes.poses, upon=shapes.upon)
    return StageRig.build(stage, rig, Job("bake"))


def _weights(**values: float) -> np.ndarray:
    names = _baked().rig.names
    result = np.zeros(len(names))
    for name, value in values.items():
        result[names.index(name)] = value
    return result


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 1000), share=st.floats(0.0, 1.0))
def test_skin_and_parts_are_those_of_the_rig_to_a_hundredth_of_a_millimetre(
    seed: int, share: float
) -> None:
    baked = _baked()
    chance = np.random.default_rng(seed)
    weights = chance.random(len(baked.rig.targets)) * (
        chance.random(len(baked.rig.targets)) < share
    )
    posed = baked.rig.posed(dict(zip(baked.rig.names, weights.tolist())))
    wanted = baked.rig.frame.to_canonical(posed)
    shown = baked.posed(weights, {"skin", "parts"})
    for kind, part in baked.stage.subject.head.parts.items():
        if kind in shown:
            assert np.abs(shown[kind] - wanted[part.first_source()]).max() < NEAR


@pytest.mark.real
@pytest.mark.filterwarnings("ignore::risorius.errors.RisoriusWarning")
def test_real_takes_on_a_real_head_are_those_of_the_rig_and_small_enough_for_a_page() -> None:
    folder = real_data_folder()
    path = folder / "ict_facekit" / "ict_neutral.obj"
    project = Project(head=path, landmarks=path.with_name("landmarks.json"))
    stage = stage_of(build_subject(work_of(project)))
    rig = bake_subject(stage.subject, ("singles",), Job("bake"))
    baked = StageRig.build(stage, rig, Job("bake"))
    assert baked.entry_count < LARGEST / 3, "with emotions and ARKit it is still small enough"
    for name in ("joy", "fear"):
        stream = read_stream(folder / "xface_fap" / f"{name}.fap")
        take = open_take(stream, baked, stage.subject.presets, Job("open"))
        moment = take.shown(2.0)(stage, {"skin", "parts"})
        weights = dict(zip(baked.rig.names, take.weights_at(2.0).tolist()))
        wanted = baked.rig.frame.to_canonical(baked.rig.posed(weights))
        for kind, part in stage.subject.head.parts.items():
            if kind in moment.meshes:
                apart = moment.meshes[kind] - wanted[part.first_source()]
                assert np.abs(apart).max() < NEAR, (name, kind)
        assert np.abs(moment.meshes["skin"] - stage.rest("skin")).max() > 2.0


def test_rest_is_rest_and_meshes_that_never_move_are_not_sent() -> None:
    baked = _baked()
    shown = baked.posed(_weights(), set(GROUPS))
    assert "cranium" not in shown
    for name, points in shown.items():
        assert np.array_equal(points, baked.stage.rest(name))


def test_bones_and_muscles_go_with_the_targets_they_were_baked_from() -> None:
    baked = _baked()
    pose = baked.rig.target("jaw_pitch").pose
    subject = baked.stage.subject
    wanted = baked.stage.posed(pose, subject.face.pose(pose), {"skull", "muscles"})
    shown = baked.posed(_weights(jaw_pitch=1.0), {"skull", "muscles"})
    assert np.abs(shown["mandible"] - baked.stage.rest("mandible")).max() > 10.0
    for name, points in shown.items():
        assert np.abs(points - wanted[name]).max() < NEAR, name


@pytest.mark.parametrize("method", ["springs", "vector"])
def test_faces_of_other_methods_bake_as_well(method: str) -> None:
    baked = _baked(method)
    column = baked.rig.names.index("zygomaticus_major_l")
    weights = np.eye(len(baked.rig.names))[column]
    shown = baked.posed(weights, set(GROUPS))
    assert np.abs(shown["skin"] - baked.stage.rest("skin")).max() > 3.0


def test_baking_the_stage_stops_when_it_is_told_to() -> None:
    job = Job("bake")
    job.cancel()
    with pytest.raises(Cancelled, match="cancelled"):
        StageRig.build(_baked().stage, _baked().rig, job)


def test_muscles_of_the_published_face_are_shown_on_its_bones() -> None:
    before = _baked().stage
    work = work_of(Project(profile="faithful"))
    stage = stage_of(build_subject(work), before)
    names = {each.name for each in stage.meshes if each.group == "muscles"}
    assert {"zygomaticus_major_l", "orbicularis_oris"} <= names
    pose = {"zygomaticus_major_l": 1.0, "jaw_pitch": 8.0}
    moved = stage.posed(pose, stage.subject.head.positions, {"skull", "muscles"})
    short = moved["zygomaticus_major_l"] - stage.rest("zygomaticus_major_l")
    assert np.abs(short).max() > 3.0
    anatomy = stage.subject.face.muscle_positions(pose)  # pyright: ignore[reportAttributeAccessIssue]
    count = len(moved["mandible"])
    first = stage.subject.face.muscles.anatomy.surfaces["mandible"].first  # pyright: ignore
    assert np.allclose(moved["mandible"], anatomy[first : first + count], atol=1e-9)
    assert _stage_keeps_its_meshes(stage)


def _stage_keeps_its_meshes(stage: Stage) -> bool:
    again = stage_of(stage.subject, stage)
    kept = {each.name for each, other in zip(stage.meshes, again.meshes) if each is other}
    return "skin" in kept and len(again.meshes) == len(stage.meshes)
