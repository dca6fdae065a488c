"""The whole report, on the built-in head and without any knowledge of a head."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from risorius import VectorFace, bake, builtin_head
from risorius.errors import ParameterError
from risorius.landmarks import LandmarkSpec
from risorius.rig import MorphTarget, Rig
from risorius.rig.quality import QualityReport, inspect_rig, shortcomings, still_zone
from risorius.rig.quality.still import Drift, drifts
from risorius.rig.quality.subject import subject_of
from tests.rig.quality.made_heads import grid, head_of
from tests.synthetic import quad_mesh

POSES = {
    "jawOpen": {"jaw_pitch": 18.0},
    "eyeBlinkLeft": {"lid_upper_l": 1.0, "lid_lower_l": 1.0},
    "eyeBlinkRight": {"lid_upper_r": 1.0, "lid_lower_r": 1.0},
    "jaw_yaw": {"jaw_yaw": 5.0},
    "jaw_yaw_neg": {"jaw_yaw": -5.0},
    "rest": {},
}


@pytest.fixture(scope="module")
def rig() -> Rig:
    return bake(VectorFace.build(builtin_head()), POSES)


@pytest.fixture(scope="module")
def report(rig: Rig) -> QualityReport:
    return inspect_rig(rig)


def test_the_built_in_head_reaches_the_bar(report: QualityReport) -> None:
    assert report.notes == ()
    assert shortcomings(report) == ()


def test_everything_is_measured_on_the_built_in_head(report: QualityReport) -> None:
    assert report.unit == "mm"
    opened = report.shape("jawOpen")
    assert opened.seam is not None
    assert opened.seam.opening is not None
    assert opened.seam.opening > 0.6
    assert opened.motion.largest > 25.0
    assert opened.drift is not None
    assert opened.asymmetry is not None
    assert opened.asymmetry.largest < 1.0
    assert set(opened.penetration) == {"teeth_upper", "teeth_lower", "eye_left", "eye_right"}
    yaw = report.shape("jaw_yaw").asymmetry
    assert yaw is not None
    assert yaw.partner == "jaw_yaw_neg"
    assert yaw.largest < 1.0
    blink = report.shape("eyeBlinkLeft")
    assert blink.lids["l"].left < 5.0
    assert blink.lids["r"].left == pytest.approx(100.0, rel=1e-9)
    assert blink.asymmetry is not None
    assert blink.asymmetry.partner == "eyeBlinkRight"


def test_a_shape_that_moves_nothing_is_all_zeros(report: QualityReport) -> None:
    rest = report.shape("rest")
    assert (rest.motion.moved, rest.motion.largest, rest.motion.vertex) == (0, 0.0, -1)
    assert not (rest.skin_faults.any or rest.hidden_faults.any or rest.part_faults.any)
    assert rest.seam is not None
    assert (rest.seam.gap, rest.seam.opening) == (0.0, None)
    assert all(found.added == 0.0 for found in rest.penetration.values())
    assert rest.cracks == 0


def test_the_report_is_json_and_a_table_with_one_row_per_shape(report: QualityReport) -> None:
    content = json.loads(json.dumps(report.to_json(), allow_nan=False))
    assert [shape["name"] for shape in content["shapes"]] == list(POSES)
    rows = report.rows()
    assert [row["shape"] for row in rows] == list(POSES)
    assert len({tuple(row) for row in rows}) == 1


def broken(rig: Rig, name: str, change: dict[int, np.ndarray]) -> Rig:
    dense = rig.target(name).dense(rig.mesh.vertex_count)
    for vertex, delta in change.items():
        dense[vertex] = delta
    target = MorphTarget.from_dense(name, dense)
    return rig.with_targets(target if each.name == name else each for each in rig.targets)


def test_a_lip_vertex_that_stays_behind_is_named(rig: Rig) -> None:
    vertex = rig.landmarks["2.3"].vertex
    assert vertex is not None
    found = inspect_rig(broken(rig, "jawOpen", {vertex: np.zeros(3)}))
    seam = found.shape("jawOpen").seam
    assert seam is not None
    assert seam.lost == (vertex,)
    assert any(f"(vertex {vertex})" in sentence for sentence in shortcomings(found))


def test_what_moves_in_a_still_zone_is_told_with_its_zone(rig: Rig) -> None:
    vertex = rig.landmarks["11.4"].vertex
    assert vertex is not None
    found = inspect_rig(broken(rig, "jawOpen", {vertex: np.array([0.0, 3.0, 0.0])}))
    drift = found.shape("jawOpen").drift
    assert drift is not None
    assert drift.zone == "skull_top"
    assert drift.largest == pytest.approx(3.0 * rig.frame.scale)
    assert "jawOpen: skull_top moves" in " ".join(shortcomings(found))


def test_drift_is_told_in_millimetres(rig: Rig) -> None:
    zones = {"front": np.arange(rig.mesh.vertex_count) < 5}
    deltas = np.zeros((rig.mesh.vertex_count, 3))
    deltas[[3, 9]] = ((0.0, 0.3, 0.4), (0.0, 7.0, 0.0))
    moving = rig.with_targets([MorphTarget.from_dense("shape", deltas)])
    assert drifts(moving, zones, 10.0) == [Drift(pytest.approx(5.0), "front")]


def test_faults_of_the_mouth_bag_are_told_apart_from_those_that_show(rig: Rig) -> None:
    subject = subject_of(rig, None)
    head, lips = subject.head, subject.lips
    assert head is not None
    assert lips is not None
    bag = np.flatnonzero(lips.inside & (lips.distance > 8.0))
    show = head.skin_vertex("8.2")
    for vertex, hidden in ((int(bag[0]), True), (show, False)):
        change = {int(v): np.full(3, 30.0) for v in head.skin.source[head.skin.welded == vertex]}
        shape = inspect_rig(broken(rig, "rest", change)).shape("rest")
        assert (shape.hidden_faults.stretched > 0) == hidden
        assert (shape.skin_faults.stretched > 0) != hidden
        assert not shape.part_faults.any


def test_sockets_and_the_mouth_bag_are_hidden_but_the_rim_of_the_lips_shows(rig: Rig) -> None:
    subject = subject_of(rig, None)
    lips = subject.lips
    assert lips is not None
    for margins in subject.lids.values():
        assert margins.slit.inside.any()
        assert subject.hidden[margins.slit.inside].all()
        assert not subject.visible[margins.slit.inside].any()
    rim = lips.inside & (lips.distance < 2.0)
    assert rim.any()
    assert subject.visible[rim].all()
    assert not subject.visible[lips.inside & (lips.distance > 4.0)].any()


def test_a_mouth_that_does_not_open_and_a_lid_that_does_not_close_fail(rig: Rig) -> None:
    nothing = np.zeros((0, 3))
    half = rig.target("eyeBlinkLeft")
    chin = rig.landmarks["2.1"].vertex
    assert chin is not None
    jaw = MorphTarget("jawOpen", np.array([chin], np.int32), np.array([[0.0, -20.0, 0.0]]))
    shapes = (
        jaw,
        MorphTarget("eyeBlinkLeft", half.vertices, 0.5 * half.deltas),
        MorphTarget("eyeBlinkRight", np.zeros(0, np.int32), nothing),
    )
    sentences = shortcomings(inspect_rig(rig.with_targets(shapes)))
    assert len(sentences) == 3
    assert "the lips open by 0.0 mm" in sentences[0]
    assert "of the left eye stay open" in sentences[1]
    assert sentences[2] == "eyeBlinkRight: 100 % of the right eye stay open"


def test_the_unit_of_the_file_changes_no_number(rig: Rig, report: QualityReport) -> None:
    scale = 0.001
    mesh = replace(rig.mesh, positions=scale * rig.mesh.positions)
    targets = (MorphTarget(t.name, t.vertices, scale * t.deltas) for t in rig.targets)
    landmarks = {name: LandmarkSpec(vertex=spec.vertex) for name, spec in rig.landmarks.items()}
    foreign = Rig(mesh, tuple(targets))
    # Names of objects survive, so the parts are found again; nothing else is known of the rig.
    found = inspect_rig(foreign, landmarks=landmarks)
    assert found.unit == "mm"
    for ours, theirs in zip(report.rows(), found.rows()):
        for column, value in ours.items():
            number = isinstance(value, float)
            expected = pytest.approx(value, rel=1e-6, abs=1e-6) if number else value
            assert theirs[column] == expected, column


def test_without_landmarks_only_what_needs_no_anatomy_is_reported() -> None:
    mesh = quad_mesh()
    lift = np.zeros((8, 3))
    lift[[1, 4]] = ((0.0, 0.3, 0.0), (0.0, -2.5, 0.0))
    found = inspect_rig(Rig(mesh, (MorphTarget.from_dense("lift", lift),)))
    assert found.unit == "file unit"
    assert "no landmarks: lip seam, lids" in found.notes[0]
    shape = found.shape("lift")
    assert (shape.motion.moved, shape.motion.vertex) == (2, 4)
    assert shape.motion.largest == pytest.approx(2.5)
    assert shape.motion.mean == pytest.approx(1.4)
    assert found.rows()[0]["percent"] == pytest.approx(250.0 / found.size)
    assert shape.skin_faults.inverted == 1
    assert (shape.seam, shape.drift, shape.asymmetry, shape.cracks) == (None, None, None, None)
    assert json.dumps(found.to_json(), allow_nan=False)


def test_landmarks_that_do_not_make_a_head_are_said_to_be_useless() -> None:
    rig = Rig(quad_mesh(), (MorphTarget.from_dense("lift", np.ones((8, 3))),))
    found = inspect_rig(rig, landmarks={"2.1": LandmarkSpec(vertex=0)})
    assert "the frame of the head needs 3.7" in found.notes[0]
    assert found.unit == "file unit"
    assert found.shape("lift").motion.moved == 8


def test_a_head_without_lip_landmarks_says_so_and_measures_the_rest(rig: Rig) -> None:
    landmarks = {name: spec for name, spec in rig.landmarks.items() if name != "2.2"}
    found = inspect_rig(replace(rig, landmarks=landmarks))
    assert any(note.startswith("lip seam not measured: landmarks:") for note in found.notes)
    assert found.shape("jawOpen").seam is None
    assert found.shape("eyeBlinkLeft").lids["l"].left < 5.0


def test_a_rig_without_shapes_has_an_empty_report(rig: Rig) -> None:
    found = inspect_rig(rig.with_targets([]))
    assert found.shapes == ()
    assert found.rows() == []
    assert found.vertex_count == rig.mesh.vertex_count


@pytest.mark.parametrize("factor", [-1.0, 1e6])
def test_a_senseless_shape_is_still_measured(rig: Rig, factor: float) -> None:
    target = MorphTarget.from_dense("nonsense", factor * rig.mesh.positions)
    found = inspect_rig(rig.with_targets([target]))
    assert json.dumps(found.to_json(), allow_nan=False)
    faults = found.shape("nonsense").skin_faults
    assert faults.collapsed > 1000 if factor < 0.0 else faults.stretched > 1000


def test_an_unknown_shape_is_refused(report: QualityReport) -> None:
    with pytest.raises(ParameterError, match="report: no shape 'smile'"):
        report.shape("smile")


def test_progress_names_every_measure_once(rig: Rig) -> None:
    steps: list[tuple[int, int, str]] = []
    inspect_rig(rig.subset(["rest"]), progress=lambda *step: steps.append(step))
    assert [step[0] for step in steps] == list(range(len(steps)))
    assert {step[1] for step in steps} == {len(steps)}
    assert steps[0][2] == "motion"


def test_still_zones_hold_the_back_of_the_head_and_not_the_face() -> None:
    head = builtin_head()
    zones = still_zone(head)
    marks = head.landmarks
    for zone, names in {"back": ["11.6"], "skull_top": ["11.4"], "ears": ["10.1", "10.4"]}.items():
        assert zones[zone][[marks.vertex(name) for name in names]].all()
    face = ["2.1", "2.13", "3.1", "3.7", "4.1", "4.3", "5.1", "5.4", "8.1", "8.4", "9.3", "11.1"]
    for zone, mask in zones.items():
        assert mask.shape == (head.vertex_count,)
        assert not mask[[marks.vertex(name) for name in face]].any(), zone
    assert zones["teeth_upper"].sum() == len(head.parts["teeth_upper"].source)


def test_a_head_of_skin_alone_without_landmarks_has_no_still_zone() -> None:
    assert still_zone(head_of({"skin": grid()})) == {}
