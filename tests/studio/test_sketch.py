"""What is drawn by clicking becomes a muscle; what a page says is checked."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.anatomy.template import builtin_head
from risorius.errors import FormatError, ParameterError, RisoriusError
from risorius.layered import default_muscle_map
from risorius.layered.muscle import Sheet
from risorius.project import Project
from risorius.spatial.closest import closest_points
from risorius.studio.drawing.layered import RingSketch, SheetSketch
from risorius.studio.jobs import Job
from risorius.studio.places import Place, place_of
from risorius.studio.scene import Stage, stage_of
from risorius.studio.subject import build_subject
from risorius.studio.work import Work, work_of

LINE = np.array([[50.0, -25.0, 68.0], [41.0, -46.0, 77.0], [29.0, -64.0, 85.0]])


@cache
def _work(method: str = "layered") -> Work:
    return work_of(Project(method=method))


@cache
def _stage(method: str = "layered") -> Stage:
    return stage_of(build_subject(_work(method)))


def _places(points: np.ndarray) -> list[Place]:
    bone = _stage().mesh("cranium")
    assert bone is not None
    near = closest_points(bone.mesh, builtin_head().frame.to_canonical(points))
    return [
        place_of({"mesh": "cranium", "face": int(face), "bary": bary.tolist()}, _stage())
        for face, bary in zip(near.face, near.bary)
    ]


def test_three_clicks_make_a_sheet_through_the_clicked_points() -> None:
    sketch = SheetSketch("smiler")
    subject = _stage().subject
    for place in _places(LINE):
        sketch.put(place)
    drawn = sketch.drawn(subject.work, subject)
    assert drawn is not None and drawn.name == "smiler_l"
    muscle = drawn.work.muscle_map.by_name["smiler"]
    assert isinstance(muscle.shape, Sheet)
    assert "cranium" in muscle.on
    back = subject.space.to_head(muscle.shape.line)
    clicked = np.array([place.position for place in sketch.lines[0]])
    # The fitted bone is pushed in below the skin, the line is where it is in its own skull.
    assert np.linalg.norm(back - clicked, axis=1).max() < 6.0
    assert not sketch.close()
    assert sketch.close(), "a second Enter keeps it"


def test_a_ring_needs_two_loops() -> None:
    sketch = RingSketch("closer")
    angle = np.linspace(0.0, 2.0 * np.pi, 7)[:-1]
    for radius in (12.0, 20.0):
        loop = np.array([40.0, 70.0, 70.0]) + radius * np.stack(
            [np.cos(angle), np.sin(angle), 0 * angle], axis=1
        )
        for place in _places(loop):
            sketch.put(place)
        done = sketch.close()
    assert done
    subject = _stage().subject
    drawn = sketch.drawn(subject.work, subject)
    assert drawn is not None
    assert drawn.work.muscle_map.by_name["closer"].kind == "sphincter"


def test_taking_back_goes_point_by_point_into_the_line_before() -> None:
    sketch = SheetSketch("x")
    for place in _places(LINE):
        sketch.put(place)
    sketch.close()
    assert [sketch.back() for _ in range(4)] == [True, True, True, False]


def test_a_line_that_is_too_short_is_refused() -> None:
    sketch = SheetSketch("x")
    sketch.put(_places(LINE)[0])
    with pytest.raises(ParameterError, match="needs 2 points"):
        sketch.close()


@pytest.mark.parametrize(
    "message",
    [
        None, [], {}, {"mesh": 3}, {"mesh": "../../etc/passwd", "face": 0, "bary": [1, 0, 0]},
        {"mesh": "skin", "face": -1, "bary": [1, 0, 0]},
        {"mesh": "skin", "face": 10**9, "bary": [1, 0, 0]},
        {"mesh": "skin", "face": 0, "bary": [1, 1, 1]},
        {"mesh": "skin", "face": 0, "bary": [float("nan"), 0, 1]},
        {"mesh": "skin", "face": 0, "bary": ["1", 0, 0]},
        {"mesh": "skin", "face": 0.5, "bary": [1, 0, 0]},
    ],
)  # fmt: skip
def test_a_wrong_message_of_the_pointer_is_refused(message: object) -> None:
    with pytest.raises(FormatError):
        place_of(message, _stage())


_JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=6), inner),
    max_leaves=8,
)


@given(
    message=_JSON
    | st.fixed_dictionaries(
        {"mesh": st.sampled_from(["skin", "cranium", "x"]) | _JSON, "face": _JSON, "bary": _JSON}
    )
)
def test_no_message_of_the_pointer_fails_otherwise_than_by_refusal(message: object) -> None:
    try:
        place = place_of(message, _stage())
    except FormatError:
        return
    assert np.isfinite(place.position).all()


def test_a_changed_muscle_keeps_everything_else_of_the_subject() -> None:
    before = _stage()
    fewer = default_muscle_map().published
    stage = stage_of(
        build_subject(replace(before.subject.work, muscle_map=fewer), before.subject), before
    )
    assert stage.subject.head is before.subject.head
    assert stage.mesh("skin") is before.mesh("skin")
    assert {m.name for m in stage.meshes} < {m.name for m in before.meshes}


def test_a_cancelled_job_stops_at_its_next_step() -> None:
    job = Job("export")
    job.step("bake")
    job.tick(1, 4, "joy")
    assert job.share == 0.25
    job.cancel()
    with pytest.raises(RisoriusError, match="cancelled"):
        job.tick(2, 4, "anger")


@pytest.mark.parametrize("method", ["layered", "vector", "springs"])
def test_every_method_shows_bodies_that_follow_the_pose(method: str) -> None:
    stage = _stage(method)
    bodies = [each for each in stage.meshes if each.group == "muscles"]
    assert len(bodies) > 20
    pose = {"zygomaticus_major_l": 1.0}
    positions = stage.subject.face.pose(pose)
    posed = stage.posed(pose, positions, {"skin", "muscles"})
    for each in bodies:
        assert np.isfinite(posed.get(each.name, each.mesh.positions)).all()
    if method != "vector":
        name = next(n for n in posed if n.startswith("zygomaticus_major") and not n.endswith("_r"))
        body = stage.mesh(name)
        assert body is not None
        assert np.abs(posed[name] - body.mesh.positions).max() > 1.0
        rest = stage.posed({}, stage.subject.head.positions, {"skin", "muscles"})
        assert np.allclose(rest[name], body.mesh.positions, atol=1e-9)


def test_a_hit_is_found_again_at_its_very_place() -> None:
    for kind in ("cranium", "skin", "zygomaticus_major_l"):
        body = _stage().mesh(kind)
        assert body is not None
        corners = body.mesh.positions[body.mesh.faces[7]]
        place = place_of({"mesh": kind, "face": 7, "bary": [0.7, 0.2, 0.1]}, _stage())
        assert np.allclose(place.position, 0.7 * corners[0] + 0.2 * corners[1] + 0.1 * corners[2])
