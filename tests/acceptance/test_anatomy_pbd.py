"""The acceptance list of the published layered face; the number of a test is that of its item.

Items 1-3 stand in tests/solvers, item 20 in benchmarks.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from risorius.anatomy.jaw import JawPose
from risorius.anatomy.skull import builtin_skull
from risorius.anatomy.template import builtin_head
from risorius.controls.presets import EMOTIONS, default_presets
from risorius.layered.faithful import FaithfulFace, FaithfulParameters
from risorius.layered.faithful.anatomy import Anatomy, LaidMuscle, lay_anatomy, rebuilt
from risorius.layered.faithful.motion import MovingMuscles
from risorius.layered.muscle_map import default_muscle_map
from risorius.mesh.connectivity import edge_faces
from risorius.mesh.core import TriMesh
from risorius.mesh.normals import face_normals
from risorius.mesh.surface_point import SurfacePoints
from risorius.rig.bake import bake
from risorius.solvers.gradients import volume_value
from risorius.solvers.pbd import Solver
from risorius.spatial.closest import closest_points
from tests.layered.faithful.ground import PUBLISHED, flat_ground, lay, ring, sheet

HEAD = builtin_head()
MIRROR = np.array([-1.0, 1.0, 1.0])


# Single muscles on flat ground.


def _relaxed(anatomy: Anatomy, parameters: FaithfulParameters, **contractions: float) -> np.ndarray:
    """Return where muscles have come to rest, in double precision."""
    moving = MovingMuscles(anatomy, parameters, solver=Solver(path="scalar"))
    wanted = {laid.name: contractions.get(laid.name, 0.0) for laid in anatomy.muscles}
    return moving.settle(anatomy.positions, wanted, steps=1)


def _of(positions: np.ndarray, laid: LaidMuscle) -> np.ndarray:
    return positions[laid.surface.first : laid.surface.last]


def _length(positions: np.ndarray, laid: LaidMuscle) -> float:
    """Return the mean length of the outer fibres of a sheet's bottom."""
    rows = _of(positions, laid)[: laid.mesh.bottom_count]
    fibres = rows.reshape(laid.mesh.rows, laid.mesh.columns, 3)[:, [0, -1]]
    return float(np.linalg.norm(np.diff(fibres, axis=0), axis=2).sum(axis=0).mean())


def _belly(positions: np.ndarray, laid: LaidMuscle) -> float:
    own, n = _of(positions, laid), laid.mesh.bottom_count
    middle = laid.mesh.rows // 2 * laid.mesh.columns + laid.mesh.columns // 2
    return float(own[middle + n, 2] - own[middle, 2])


def _volume(positions: np.ndarray, laid: LaidMuscle) -> float:
    return float(volume_value(_of(positions, laid), laid.mesh.faces))


@cache
def _plane_sheet(contraction: float, *, volume: float = 1.0) -> tuple[float, float, float, float]:
    """Return length, belly and volume over those at rest, and the largest motion."""
    p = replace(PUBLISHED, sheet=replace(PUBLISHED.sheet, volume=volume))
    anatomy = flat_ground()
    laid = lay(anatomy, sheet("a", [(0, 0), (0, 40)]), p)
    rest, moved = anatomy.positions, _relaxed(anatomy, p, a=contraction)
    return (
        _length(moved, laid) / _length(rest, laid),
        _belly(moved, laid) / _belly(rest, laid),
        _volume(moved, laid) / _volume(rest, laid),
        float(np.abs(moved - rest).max()),
    )


def test_04_a_surface_point_follows_every_affine_motion() -> None:
    generator = np.random.default_rng(4)
    mesh = HEAD.skin.mesh
    bary = generator.dirichlet(np.ones(3), 50)
    points = SurfacePoints(generator.integers(0, mesh.face_count, 50), bary)
    matrix, shift = generator.normal(size=(3, 3)), generator.normal(size=3)
    moved = points.interpolate(mesh.positions @ matrix.T + shift, mesh.faces)
    np.testing.assert_allclose(moved, points.positions(mesh) @ matrix.T + shift, atol=1e-10)


def test_05_a_sheet_shortens_and_bulges_and_rests_without_contraction() -> None:
    assert _plane_sheet(0.0)[3] < 1e-9
    lengths, bellies, _, _ = zip(*(_plane_sheet(c) for c in (0.0, 0.25, 0.5, 0.75)))
    assert np.all(np.diff(lengths) < 0.0)
    assert np.all(np.diff(bellies) > 0.0)
    np.testing.assert_allclose(bellies[1:], (1.45, 2.14, 2.44), rtol=0.15)


def test_06_the_volume_constraint_keeps_the_volume_and_makes_the_belly() -> None:
    kept, free = _plane_sheet(0.3), _plane_sheet(0.3, volume=0.0)
    assert kept[2] == pytest.approx(1.0, abs=0.01)
    assert kept[1] == pytest.approx(1.57, rel=0.15)
    assert free[2] == pytest.approx(0.75, abs=0.05)
    assert free[1] == pytest.approx(1.01, abs=0.05)


def test_07_a_sphincter_closes_and_swells() -> None:
    anatomy = flat_ground()
    laid = lay(anatomy, ring())
    openings: list[tuple[float, float, float]] = []
    for contraction in (0.0, 0.25, 0.5, 0.75):
        own = _of(_relaxed(anatomy, PUBLISHED, ring=contraction), laid)
        w = laid.mesh.columns
        inner, outer = own[:w], own[w : 2 * w]
        if not contraction:
            np.testing.assert_allclose(own, _of(anatomy.positions, laid), atol=1e-9)
        steps = np.linalg.norm(inner - np.roll(inner, -1, axis=0), axis=1)
        x, y = inner[:, 0], inner[:, 1]
        area = 0.5 * abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
        height = float((own[2 * w :] - own[: 2 * w])[:, 2].mean())
        openings.append((float(steps.sum()), area, -height))
        assert (np.linalg.norm(outer[:, :2], axis=1) > np.linalg.norm(inner[:, :2], axis=1)).all()
    assert np.all(np.diff(openings, axis=0) < 0.0)


def test_08_muscles_at_rest_follow_what_they_lie_on() -> None:
    anatomy = flat_ground()
    lay(anatomy, sheet("base", [(0, 0), (0, 40)]))
    # Half on the base, wholly on it, and from one contracting muscle to an opposite one.
    lay(anatomy, sheet("left", [(-40, -40), (-40, -10)]))
    lay(anatomy, sheet("right", [(-40, 50), (-40, 20)]))
    half = lay(
        anatomy, sheet("half", [(0, 70), (0, 25)], on=("base", "cranium"), layer=2, half_width=5)
    )
    whole = lay(anatomy, sheet("whole", [(0, 5), (0, 35)], on=("base",), layer=2, half_width=5))
    between = lay(
        anatomy,
        sheet("between", [(-40, -15), (-40, 25)], on=("left", "right", "cranium"), layer=2,
              half_width=5),
    )  # fmt: skip
    rest = anatomy.positions
    moved = _relaxed(anatomy, PUBLISHED, base=0.5, left=0.5, right=0.5)
    assert _length(moved, half) > 1.05 * _length(rest, half)
    assert _length(moved, whole) < 0.95 * _length(rest, whole)
    assert _length(moved, between) > 1.05 * _length(rest, between)


# The face.


@pytest.fixture(scope="module")
def face() -> FaithfulFace:
    return FaithfulFace.build(HEAD)


@pytest.fixture(scope="module")
def emotions(face: FaithfulFace) -> dict[str, np.ndarray]:
    book = default_presets()
    return {
        name: face.displace(book.fit(book.emotions[name], face.controls).pose) for name in EMOTIONS
    }


@pytest.fixture(scope="module")
def smile(face: FaithfulFace) -> np.ndarray:
    return face.displace({"zygomaticus_major_l": 1.0, "zygomaticus_major_r": 1.0})


def _at(displacement: np.ndarray, landmark: str) -> np.ndarray:
    return displacement[HEAD.skin.first_source()][HEAD.skin_vertex(landmark)]


def test_09_the_jaw_turns_about_its_axis_and_is_clamped(face: FaithfulFace) -> None:
    jaw = face.mechanics.jaw
    chin = HEAD.landmarks.position("2.10")[None]

    def arm(point: np.ndarray) -> np.ndarray:
        apart = point[0] - jaw.hinge
        return apart - (apart @ jaw.pitch_axis) * jaw.pitch_axis

    before, after = arm(chin), arm(jaw.move(chin, JawPose(18.0)))
    cosine = before @ after / (np.linalg.norm(before) * np.linalg.norm(after))
    assert np.degrees(np.arccos(cosine)) == pytest.approx(18.0, abs=1e-6)
    ranges = {c.name: (c.low, c.high) for c in face.controls}
    assert ranges["jaw_pitch"] == (-4.0, 18.0)
    assert ranges["jaw_yaw"] == (-5.0, 5.0)
    frame = jaw.move(np.vstack([np.eye(3), np.zeros(3)]), JawPose(18.0, 5.0))
    turn = frame[:3] - frame[3]
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
    left, right = (jaw.move(chin, JawPose(0.0, yaw)) for yaw in (5.0, -5.0))
    np.testing.assert_allclose(left, right * MIRROR, atol=1e-6)
    cranium = face.muscles.anatomy.surfaces["cranium"]
    opened = face.bones({"jaw_pitch": 18.0})
    rest = face.muscles.anatomy.positions
    part = slice(cranium.first, cranium.last)
    np.testing.assert_array_equal(opened[part], rest[part])


def test_10_the_jaw_moves_exactly_the_muscles_that_depend_on_it(face: FaithfulFace) -> None:
    anatomy = face.muscles.anatomy
    moved = face.muscle_positions({"jaw_pitch": 15.0}) - anatomy.positions
    supports = anatomy.supports()
    depends = {name for name, beneath in supports.items() if "mandible" in beneath}
    assert {"masseter_l", "depressor_labii_r", "risorius_l", "orbicularis_oris"} <= depends
    assert {"frontalis_l", "corrugator_r", "levator_labii_l"}.isdisjoint(depends)
    for laid in anatomy.muscles:
        largest = np.abs(_of(moved, laid)).max()
        assert (largest > 0.5) == (laid.name in depends), laid.name
        assert largest > 0.5 or largest < 1e-3, laid.name


def test_11_muscles_scale_with_the_head_and_lie_under_its_skin(face: FaithfulFace) -> None:
    anatomy = face.muscles.anatomy
    bones = {}
    for name in ("cranium", "mandible"):
        surface = anatomy.surfaces[name]
        bones[name] = 10.0 * anatomy.positions[surface.first : surface.last]
    scale = 1.3
    small, large = (
        rebuilt(anatomy, {name: share * places for name, places in bones.items()}, scale=thick)
        for share, thick in ((0.1, scale), (1.0, 10.0 * scale))
    )
    np.testing.assert_allclose(large.positions, 10.0 * small.positions, rtol=1e-6, atol=1e-5)
    # The published lift of landmarks onto muscles, which brings this to 95 %, is not built.
    hidden = face.mechanics.lips.inside.copy()
    for margins in face.mechanics.margins.values():
        hidden |= margins.slit.inside
    mesh = HEAD.skin.mesh
    outer = TriMesh(mesh.positions, mesh.faces[~hidden[mesh.faces].any(axis=1)])
    tops = np.concatenate(
        [_of(anatomy.positions, m)[m.mesh.bottom_count :] for m in anatomy.muscles]
    )
    near = closest_points(outer, tops)
    normals = face_normals(outer.positions, outer.faces)[near.surface_points().faces]
    depth = np.einsum("nd,nd->n", near.positions - tops, normals)
    assert (depth > 0.0).mean() > 0.9


def test_12_the_constraints_are_as_many_as_the_formula_says(face: FaithfulFace) -> None:
    mesh = HEAD.skin.mesh
    table = edge_faces(mesh.faces)
    inner = int((table.counts >= 2).sum())
    anchors = len(face.anchors.vertices)
    wanted = len(table.edges) + 2 * inner + mesh.face_count + 1 + anchors
    assert face.constraint_count == wanted
    front = mesh.positions[:, 2] > face.mechanics.jaw.hinge[2]
    hung = np.isin(np.flatnonzero(front), face.anchors.vertices).mean()
    assert 0.5 < hung < 0.9


def test_13_the_lids_close_and_their_corners_stay(face: FaithfulFace) -> None:
    closed = face.displace({"lid_upper_l": 1.0, "lid_lower_l": 1.0})
    margins = face.mechanics.margins["l"]
    upper = HEAD.landmarks.position("3.1") + _at(closed, "3.1")
    lower = HEAD.landmarks.position("3.3") + _at(closed, "3.3")
    assert abs(upper[1] - lower[1]) < 0.05 * margins.height
    for corner in ("3.7", "3.11"):
        assert np.linalg.norm(_at(closed, corner)) < 0.02 * margins.height


def test_14_the_skin_stays_in_front_of_the_teeth(face: FaithfulFace) -> None:
    pose = {"jaw_pitch": 18.0, "zygomaticus_major_l": 1.0, "zygomaticus_major_r": 1.0}
    pressed = pose | {"orbicularis_oris": 1.0}
    placed = face.teeth.moved(face.mechanics.jaw, JawPose(18.0))
    positions = HEAD.skin.mesh.positions + face.displace(pressed)[HEAD.skin.first_source()]
    assert len(placed.arches) == 2
    for arch in placed.arches:
        assert arch.depth(positions).max() < 0.1


def test_15_the_back_of_the_head_stays(face: FaithfulFace, emotions: dict[str, np.ndarray]) -> None:
    source = HEAD.skin.first_source()
    back = HEAD.skin.mesh.positions[:, 2] < face.mechanics.jaw.hinge[2] - 60.0
    assert back.sum() > 100
    for displacement in emotions.values():
        assert np.abs(displacement[source][back]).max() < 1e-6
    sources = face.anchors.vertices[~face.anchors.on("cranium")]
    np.testing.assert_array_equal(face.influence[sources], 1.0)


def test_16_a_pose_depends_on_itself_only(face: FaithfulFace, smile: np.ndarray) -> None:
    again = face.displace({"zygomaticus_major_l": 1.0, "zygomaticus_major_r": 1.0})
    np.testing.assert_array_equal(again, smile)
    assert np.abs(face.displace({})).max() == 0.0


def test_17_emotions_move_the_landmarks_as_they_should(emotions: dict[str, np.ndarray]) -> None:
    for left, right, sign in (("2.4", "2.5", 1.0), ("2.5", "2.4", -1.0)):
        joy = _at(emotions["joy"], left)
        assert joy[1] > 0.0, "joy raises the mouth corners"
        assert sign * joy[0] > 0.0, "joy widens the mouth"
        assert _at(emotions["sadness"], right)[1] < 0.0, "sadness lowers the mouth corners"
    for brow in ("4.1", "4.2"):
        assert _at(emotions["sadness"], brow)[1] > 1.0, "sadness raises the inner brows"
        assert _at(emotions["fear"], brow)[1] > 1.0, "fear raises the inner brows"
        assert _at(emotions["surprise"], brow)[1] > 1.0, "surprise raises the brows"
    assert _at(emotions["surprise"], "2.3")[1] < -5.0, "surprise opens the mouth"
    assert _at(emotions["disgust"], "2.2")[1] > 0.0, "disgust raises the upper lip"
    assert _at(emotions["anger"], "4.1")[0] < 0.0, "anger draws the brows together"


def test_18_a_thicker_cheek_comes_farther_forward() -> None:
    book = default_muscle_map()
    thick = tuple(
        replace(m, thickness=2.0 * m.thickness) if m.name == "fatty_tissue" else m
        for m in book.muscles
    )
    heights: list[float] = []
    for muscle_map in (book, replace(book, muscles=thick)):
        p = FaithfulParameters()
        moving = MovingMuscles(lay_anatomy(muscle_map.published, builtin_skull(), p), p)
        posed = moving.settle(
            moving.anatomy.positions, moving.contractions({"zygomaticus_major_l": 1.0})
        )
        laid = next(m for m in moving.anatomy.muscles if m.name == "zygomaticus_major_l")
        heights.append(float((posed - moving.anatomy.positions)[laid.surface.first :][
            : laid.mesh.bottom_count, 2].max()))  # fmt: skip
    assert heights[1] > heights[0]


def test_19_a_mirrored_pose_gives_the_mirrored_face(face: FaithfulFace) -> None:
    partner = face.partner
    assert partner is not None
    source = HEAD.skin.first_source()
    left, right = (
        face.displace({f"zygomaticus_major_{side}": 1.0, "jaw_pitch": 6.0, "jaw_yaw": yaw})[source]
        for side, yaw in (("l", 3.0), ("r", -3.0))
    )
    off = np.abs(left[partner] * MIRROR - right).max()
    assert off < 0.01 * np.abs(left).max()


def test_21_a_shape_is_the_pose_it_was_made_from(face: FaithfulFace, smile: np.ndarray) -> None:
    pose = {"zygomaticus_major_l": 1.0, "zygomaticus_major_r": 1.0}
    rig = bake(face, {"smile": pose})
    dense = rig.target("smile").dense(HEAD.vertex_count)
    wanted = HEAD.frame.vectors_to_input(smile)
    assert np.abs(dense - wanted).max() < 2e-4
