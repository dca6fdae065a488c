"""The acceptance list of motion cloning; the number of a test is that of its item.

Item 2 is asked with the lips' sides kept apart only (erratum S2). Item 13 is a matter of
benchmarks; here it is only that many shapes take no new correspondence.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from benchmarks.cloning.pairs import decimated
from risorius import Head, bake
from risorius.anatomy.template import builtin_head
from risorius.cloning import (
    Cloning,
    absolute_error,
    clone_parameters,
    clone_with_report,
    motion_error,
    roughness,
)
from risorius.cloning.landmark_pairs import pair_landmarks
from risorius.cloning.refinement import ray_length, refine
from risorius.cloning.subject import Subject
from risorius.controls.presets import default_presets
from risorius.mesh.connectivity import edges
from risorius.mesh.normals import vertex_normals
from risorius.spatial.closest import closest_points
from risorius.warp.rbf import RbfWarp
from tests.cloning.rigs import (
    copy_of,
    dense,
    other_cloning,
    other_head,
    self_cloning,
    source_rig,
    specs_of,
)
from tests.cloning.test_other_heads import finer
from tests.face_fixtures import builtin_face

HEAD = builtin_head()
ODD_UNITS = pytest.mark.filterwarnings("ignore:frame. the head", "ignore:unit. ")


@cache
def clones() -> np.ndarray:
    return other_cloning().carry(dense(source_rig()))


def shape(name: str) -> int:
    return source_rig().names.index(name)


def test_1_the_warp_meets_its_centres_and_reproduces_affine_maps() -> None:
    subjects = Subject.bare(HEAD), Subject.bare(other_head())
    pairs = pair_landmarks(*subjects)
    size = float(np.ptp(pairs.target, axis=0).max())
    warp = RbfWarp.fit(pairs.source, pairs.target)
    assert np.abs(warp(pairs.source) - pairs.target).max() < 1e-8 * size
    affine = np.array([[1.1, 0.2, 0.0], [-0.1, 0.9, 0.3], [0.0, 0.1, 1.2]])
    straight = RbfWarp.fit(pairs.source, pairs.source @ affine.T + [3.0, -5.0, 7.0])
    points = HEAD.positions
    assert np.abs(straight(points) - points @ affine.T - [3.0, -5.0, 7.0]).max() < 1e-9 * size


@pytest.mark.parametrize("profile", ["improved", "faithful"])
def test_2_cloned_onto_itself_a_head_keeps_its_shapes(profile) -> None:
    bound = self_cloning()
    if profile == "faithful":
        bound = Cloning.build(HEAD, HEAD, parameters=clone_parameters("faithful"))
    for truth, made in zip(dense(source_rig()), bound.carry(dense(source_rig()))):
        assert absolute_error(source_rig().mesh.positions, truth, made) < 1e-3
        assert motion_error(truth, made) < 0.1


def test_3_no_motion_is_exactly_the_neutral_target() -> None:
    assert not other_cloning().carry(np.zeros((1, HEAD.vertex_count, 3))).any()


@ODD_UNITS
def test_4_a_turned_enlarged_and_shifted_copy() -> None:
    turn = Rotation.from_euler("y", 20.0, degrees=True).as_matrix()
    target = copy_of(HEAD, 10.0 * HEAD.source.positions @ turn.T + [50.0, -300.0, 80.0])
    made = dense(clone_with_report(source_rig(), target, source=HEAD).rig)
    for truth, moved in zip(dense(source_rig()), made):
        assert motion_error(10.0 * truth @ turn.T, moved) < 0.5


@pytest.mark.real
@pytest.mark.filterwarnings("ignore::risorius.errors.RisoriusWarning")
def test_5_a_copy_decimated_to_half() -> None:
    pair = decimated(None)
    names = ["jawOpen", "mouthSmile_L", "mouthPucker", "browInnerUp_L", "eyeBlink_L"]
    made = dense(clone_with_report(pair.source.subset(names), pair.target).rig)
    assert pair.truth is not None
    for name, moved in zip(names, made):
        truth = pair.truth[pair.source.names.index(name)]
        # The decimated margins of the lids leave another gap, which the contact restores.
        assert motion_error(truth, moved) < (12.0 if "Blink" in name else 5.0), name


def test_6_refining_brings_the_skins_together_and_stops() -> None:
    source, target = Subject.of(HEAD, "source"), Subject.of(other_head(), "target")
    moving = dense(source_rig())[:, HEAD.skin.first_source()].any(axis=(0, 2))
    pairs = pair_landmarks(source, target)
    found = refine(source, target, pairs, moving, clone_parameters("faithful"))
    assert found.pass_count <= 10
    # The smoothing of the warp lets a pass be worse by a little.
    assert all(b < 1.1 * a for a, b in zip(found.misses, found.misses[1:]))
    fitted = found.warp(found.rest.positions)[moving & ~source.inside]
    off = closest_points(target.mesh, fitted).distance
    assert np.mean(off < 0.005 * target.head.height) >= 0.9


def test_7_places_among_resting_vertices_do_not_move() -> None:
    bound = other_cloning()
    ours = dense(source_rig())[:, HEAD.skin.first_source()]
    mapping = bound.skin.mapping
    for truth, made in zip(ours, clones()[:, other_head().skin.first_source()]):
        still = ~mapping.moved(np.linalg.norm(truth, axis=1) > 1e-4)
        assert still.sum() > 0.2 * len(still)
        assert not made[still].any()


def test_8_lips_keep_their_sides_and_the_mouth_opens() -> None:
    bound = other_cloning()
    source, target, mapping = bound.source, bound.target, bound.skin.mapping
    for side in (1, -1):
        taken = source.side[mapping.faces[target.side == side]] * mapping.bary[target.side == side]
        assert len(taken) > 20
        assert (taken * side >= -1e-12).all()
    moved = clones()[shape("jawOpen")][other_head().skin.first_source()]
    assert target.lips is not None
    pairs = target.lips.pairs(target.mesh.positions)
    upper, lower = (np.linalg.norm(moved[pairs[:, k]], axis=1).mean() for k in (0, 1))
    assert lower > 5.0
    assert upper < 0.05 * lower


@ODD_UNITS
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_9_contours_meet_in_their_corners_at_every_scale(scale) -> None:
    head = HEAD if scale == 1.0 else copy_of(HEAD, scale * HEAD.source.positions)
    found, whole = Subject.of(head, "head"), Subject.of(HEAD, "head")
    lines = found.lines()
    assert set(lines) == {f"lid_{v}_{s}" for v in ("upper", "lower") for s in "lr"} | {
        "lip_upper", "lip_lower",
    }  # fmt: skip
    for upper in (name for name in lines if "upper" in name):
        a, b = lines[upper], lines[upper.replace("upper", "lower")]
        assert set(a.tolist()) & set(b.tolist()) == {int(a[0]), int(a[-1])}
        assert (a[0], a[-1]) == (b[0], b[-1])
    eye = set(lines["lid_upper_l"].tolist()) | set(lines["lid_lower_l"].tolist())
    assert {head.skin_vertex(name) for name in ("3.1", "3.3", "3.7", "3.11")} <= eye
    for name, line in whole.lines().items():
        assert (line == lines[name]).all()


@ODD_UNITS
def test_10_rays_are_a_share_of_the_target_s_eyes_over_its_nose() -> None:
    target = Subject.bare(other_head())
    marks = target.head.landmarks
    eyes = marks.positions(("3.7", "3.8", "3.11", "3.12"))[:, 1].mean()
    expected = 0.3125 * abs(eyes - marks.position("9.15")[1])
    assert ray_length(target, 0.3125) == pytest.approx(expected, rel=1e-12)
    half = copy_of(HEAD, 0.5 * HEAD.source.positions)
    whole = ray_length(Subject.bare(HEAD), 0.3125) / HEAD.frame.scale
    assert ray_length(Subject.bare(half), 0.3125) / half.frame.scale == pytest.approx(0.5 * whole)


def test_11_expressions_keep_the_way_and_the_size_of_landmarks_motion() -> None:
    face, book = builtin_face(), default_presets()
    names = ("joy", "anger", "surprise", "sadness")
    rig = bake(face, {name: book.fit(book.emotions[name], face.controls).pose for name in names})
    report = clone_with_report(rig, other_head(), source=HEAD).report
    assert [told.name for told in report.shapes] == list(names)
    for told in report.shapes:
        assert told.kept is not None
        assert told.size is not None
        assert told.kept > 0.95
        assert abs(told.size - 1.0) < 0.25


def test_12_detail_of_a_finer_target_neither_moves_nor_roughens_the_motion() -> None:
    mesh, _ = finer(HEAD)
    target = Head.from_mesh(mesh, specs_of(HEAD))
    skin = target.skin.mesh
    waves = np.sin(skin.positions @ np.array([1.7, 2.3, 1.9]))[:, None]
    detail = 0.1 * waves * vertex_normals(skin.positions, skin.faces)
    moved = np.zeros((target.vertex_count, 3))
    target.skin.spread(detail, moved)
    rough = copy_of(target, target.source.positions + target.frame.vectors_to_input(moved))
    given = np.concatenate(
        [dense(source_rig())[[shape("smile")]], np.zeros((1, HEAD.vertex_count, 3))]
    )
    plain = Cloning.build(HEAD, target).carry(given)
    made = Cloning.build(HEAD, rough).carry(given)
    assert not made[1].any()
    first = target.skin.first_source()
    assert roughness(skin, made[0][first]) < 1.1 * roughness(skin, plain[0][first])


def test_13_many_shapes_take_no_new_correspondence_and_stages_are_told() -> None:
    bound = other_cloning()
    many = bound.carry(np.repeat(dense(source_rig())[:1], 6, axis=0))
    assert all((each == many[0]).all() for each in many)
    assert {"lips+lids", "correspondence", "skin", "contact", "parts"} <= set(bound.seconds)


def test_14_shapes_come_back_from_a_round_trip() -> None:
    back = Cloning.build(other_head(), HEAD).carry(clones())
    for name, truth, made in zip(source_rig().names, dense(source_rig()), back):
        assert motion_error(truth, made) < 10.0, name


def test_edges_of_an_opened_mouth_do_not_tear() -> None:
    """Beside the list: the corners of the mouth on a finer head (erratum S4)."""
    mesh, pairs = finer(HEAD)
    target = Head.from_mesh(mesh, specs_of(HEAD))
    jaw = dense(source_rig())[[shape("jawOpen")]]
    made = Cloning.build(HEAD, target).carry(jaw)[0]
    truth = np.concatenate([jaw[0], jaw[0][pairs].mean(axis=1)])
    ends = edges(mesh.triangles)

    def length(moved: np.ndarray) -> np.ndarray:
        points = target.frame.scale * (mesh.positions + moved)
        return np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1)

    allowed = np.maximum(length(0.0 * truth), length(truth))
    torn = (length(made) > 2.5 * allowed) & (length(made) > allowed + 0.005 * target.height)
    assert not torn.any()
