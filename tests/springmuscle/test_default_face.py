"""The default muscles on the built-in head, at three resolutions and through wild poses."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import cast

import numpy as np
import pytest
from scipy.spatial import cKDTree

from risorius._check import FloatArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.template import builtin_head
from risorius.controls.presets import default_presets
from risorius.controls.shape_sets import list_shapes
from risorius.errors import ParameterError
from risorius.rig.bake import bake
from risorius.rig.quality.inspection import inspect_rig
from risorius.springmuscle.bones import BoneWay
from risorius.springmuscle.contraction import Contraction
from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.measure import FaceMeasure
from risorius.springmuscle.queries import refit
from risorius.springmuscle.recipe_file import default_recipe
from risorius.springmuscle.surface import label_lips
from tests.springmuscle.coarse import coarse_mechanics
from tests.springmuscle.faces import builtin_mechanics


@cache
def default_face(share: float = 1.0) -> SpringFace:
    """Return the built-in head at a share of its triangles, on the default muscles."""
    mechanics = builtin_mechanics() if share == 1.0 else coarse_mechanics(share)
    return SpringFace.build(mechanics.head, mechanics=mechanics)


@cache
def published_face() -> SpringFace:
    return SpringFace.build(builtin_head(), mechanics=builtin_mechanics(), profile="faithful")


def _emotions(face: SpringFace) -> dict[str, dict[str, float]]:
    poses = list_shapes(face.controls, default_presets(), sets=("emotions",)).poses
    return {name: dict(pose) for name, pose in poses.items()}


def _singles(face: SpringFace) -> dict[str, dict[str, float]]:
    names = [control.name for control in face.controls if control.group == "muscle"]
    return {name: {name: 1.0} for name in names}


def _at(face: SpringFace, landmark: str, pose: dict[str, float]) -> FloatArray:
    """Return how a landmark moves (3,) [mm]."""
    moved = face.displace(pose)[face.head.skin.first_source()]
    return moved[face.head.skin_vertex(landmark)]


def test_at_least_eleven_muscles_a_side_and_three_rings_of_the_mouth_and_eyes() -> None:
    face = default_face()
    left = {muscle.name for muscle in face.muscles.muscles if muscle.name.endswith("_l")}
    assert len(left) >= 11
    names = {muscle.name for muscle in face.muscles.muscles if muscle.kind == "sphincter"}
    assert {"orbicularis_oris", "orbicularis_oculi_l", "orbicularis_oculi_r"} <= names


@pytest.mark.parametrize(
    ("control", "landmark", "direction", "least"),
    [
        ("zygomaticus_major_l", "2.4", (0.5, 0.8, -0.3), 5.0),
        ("depressor_anguli_l", "2.4", (0.1, -1.0, 0.0), 4.0),
        ("risorius_l", "2.4", (1.0, 0.0, -0.5), 4.0),
        ("frontalis_inner_l", "4.1", (0.0, 1.0, 0.0), 4.0),
        ("frontalis_outer_l", "4.5", (0.0, 1.0, 0.0), 2.0),
        ("corrugator_l", "4.1", (-1.0, -0.4, 0.0), 2.0),
        ("levator_labii_l", "8.1", (0.0, 1.0, 0.0), 1.0),
        ("depressor_labii_l", "8.2", (0.0, -1.0, 0.0), 1.5),
        ("mentalis_l", "2.1", (0.0, 1.0, 0.0), 1.0),
        ("orbicularis_oris", "2.4", (-1.0, 0.0, 0.8), 4.0),
        ("orbicularis_oris", "8.1", (0.0, 0.0, 1.0), 2.0),
    ],
)
def test_muscles_pull_where_anatomy_says(
    control: str, landmark: str, direction: tuple[float, ...], least: float
) -> None:
    way = np.array(direction) / np.linalg.norm(direction)
    moved = _at(default_face(), landmark, {control: 1.0})
    assert moved @ way > least
    assert moved @ way > 0.6 * np.linalg.norm(moved)


def test_a_muscle_of_one_lip_never_takes_the_other() -> None:
    # Issue: mouth muscles never couple to the wrong lip.
    face = default_face()
    lips, _ = label_lips(face.mechanics.lips, FaceMeasure.of(face.head.landmarks))
    springs, segments = face.springs, face.muscles.lips
    bound = lips[springs.vertices].astype(int) * segments[springs.segments]
    assert (bound >= 0).all()
    assert (bound > 0).sum() > 100


def test_an_open_jaw_takes_the_lip_and_the_ring_still_narrows_it() -> None:
    # Acceptance 15 (figure 15).
    face = default_face()
    opened, both = {"jaw_pitch": 15.0}, {"jaw_pitch": 15.0, "orbicularis_oris": 1.0}
    assert _at(face, "2.3", opened)[1] < -10.0
    width = [
        np.diff([_at(face, name, pose)[0] for name in ("2.5", "2.4")])[0] for pose in (opened, both)
    ]
    assert width[1] < width[0] - 8.0
    for lip in ("8.1", "8.2"):
        assert _at(face, lip, both)[2] > _at(face, lip, opened)[2] + 2.0


def test_muscles_that_hang_on_a_contracting_ring_get_thinner() -> None:
    # Acceptance 15, last part: what the host pulls longer is flatter.
    muscles = default_face().muscles
    contracted = Contraction(muscles)(muscles.contractions({"orbicularis_oris": 1.0}))
    hung = {
        int(muscles.fibre_muscle[fibre])
        for (fibre, _), (_, segment) in zip(muscles.links.ends, muscles.links.hosts, strict=True)
        if muscles.muscles[muscles.segment_muscle[segment]].name == "orbicularis_oris"
    }
    assert len(hung) >= 6
    own = np.isin(muscles.segment_muscle, sorted(hung))
    assert contracted.heights[own].min() < 0.97
    assert (contracted.heights[own] >= 0.2).all()


def test_the_start_of_a_pose_halves_the_steps() -> None:
    # Acceptance 13, over the six emotions; the start knows what each muscle does alone.
    from risorius.controls.control import resolve_pose
    from risorius.solvers.leapfrog import settle
    from risorius.solvers.springs import SpringState

    face = default_face()
    steps = np.zeros(2)
    for pose in _emotions(face).values():
        values = resolve_pose(face.controls, pose).values
        drive, moved = face.settled(values)
        final = moved.state.positions
        way = np.linalg.norm(final - drive.reference)
        assert np.linalg.norm(drive.guess - final) < 0.25 * way
        plain = settle(
            face.springs.network, SpringState.still(drive.reference), drive.control,
            parameters=face.parameters.motion,
        )  # fmt: skip
        steps += (moved.steps, plain.steps)
    assert steps[0] < 0.75 * steps[1]


def test_forces_of_several_muscles_add() -> None:
    # Finding S3: without riding, muscles on one skin hold it against each other.
    face = default_face()
    names = ("zygomaticus_major_l", "levator_labii_l", "depressor_labii_l")
    together = face.displace_skin(dict.fromkeys(names, 0.6))
    alone = sum(face.displace_skin({name: 0.6}) for name in names)
    assert np.linalg.norm(together - alone) < 0.1 * np.linalg.norm(alone)


@pytest.mark.parametrize("share", [0.5, 0.2])
def test_the_same_outlines_make_the_same_face_on_coarser_skins(share: float) -> None:
    # Issue and acceptance 16: levels of detail.
    fine, coarse = default_face(), default_face(share)
    seen = np.flatnonzero(~coarse.springs.skin.hidden)
    here = coarse.head.skin.mesh.positions[seen]
    own = np.flatnonzero(~fine.springs.skin.hidden)
    _, near = cKDTree(fine.head.skin.mesh.positions[own]).query(here)
    area = coarse.springs.skin.mass[seen][:, None]
    off = {}
    for name, pose in _emotions(fine).items():
        wanted = fine.displace(pose)[fine.head.skin.first_source()][own][near]
        found = coarse.displace(pose)[coarse.head.skin.first_source()][seen]
        off[name] = np.sqrt((area * (found - wanted) ** 2).sum() / (area * wanted**2).sum())
        assert 0.5 < np.abs(found).max() / np.abs(wanted).max() < 2.0
    assert np.mean(list(off.values())) < {0.5: 0.25, 0.2: 0.65}[share]


def test_wild_poses_stay_bounded_and_end_in_the_input_bit_for_bit() -> None:
    face = default_face(0.2)
    generator = np.random.default_rng(11)
    controls = [c for c in face.controls if c.group in ("muscle", "jaw", "lid", "lips")]
    largest = 0.0
    for number in range(60):
        chosen = generator.permutation(len(controls))[: 1 + number % 12]
        pose = {controls[i].name: generator.choice([controls[i].low, controls[i].high])
                for i in chosen}  # fmt: skip
        moved = face.displace(pose)
        assert np.isfinite(moved).all()
        largest = max(largest, float(np.abs(moved).max()))
    assert largest < 90.0
    assert (face.pose({}) == face.head.positions).all()


def test_no_shape_of_the_default_set_is_torn_or_runs_into_teeth_and_eyes() -> None:
    face = default_face()
    rig = bake(face, {**_emotions(face), **_singles(face)})
    for shape in inspect_rig(rig).shapes:
        assert shape.seam is not None
        assert not shape.seam.lost, shape.name
        assert not shape.seam.invented, shape.name
        assert max(p.added for p in shape.penetration.values()) < 0.1, shape.name
        assert shape.drift.largest == 0.0
        assert shape.skin_faults.inverted <= 12, shape.name
        assert shape.skin_faults.collapsed == 0


def test_bones_cut_from_the_head_make_nearly_the_same_face() -> None:
    # Finding S9.
    cut = SpringFace.build(builtin_head(), mechanics=builtin_mechanics(), bones="cut")
    for pose in _emotions(default_face()).values():
        wanted = default_face().displace(pose)
        apart = np.linalg.norm(cut.displace(pose) - wanted)
        assert 0.001 * np.linalg.norm(wanted) < apart < 0.15 * np.linalg.norm(wanted)


@pytest.mark.parametrize("name", ["joy", "surprise", "anger"])
def test_the_published_face_settles_and_goes_the_same_way(name: str) -> None:
    from risorius.controls.control import resolve_pose

    face = published_face()
    pose = _emotions(face)[name]
    _, moved = face.settled(resolve_pose(face.controls, pose).values)
    assert moved.residual <= face.parameters.motion.tolerance
    ours = default_face().displace(_emotions(default_face())[name])
    theirs = face.displace(pose)
    agreement = (ours * theirs).sum() / np.linalg.norm(ours) / np.linalg.norm(theirs)
    assert agreement > 0.35
    assert np.abs(theirs).max() < 40.0


def test_ways_to_bones_that_do_not_exist_are_refused() -> None:
    with pytest.raises(ParameterError, match="bones"):
        SpringFace.build(builtin_head(), mechanics=builtin_mechanics(), bones=cast(BoneWay, "own"))


def test_mechanics_are_used_as_given() -> None:
    assert isinstance(builtin_mechanics(), Mechanics)
    assert default_face().mechanics is builtin_mechanics()


def test_the_lining_of_lips_and_lids_goes_with_the_skin_in_front_of_it() -> None:
    face = default_face()
    lining, seen = face.springs.network.edges[-face.springs.across_count :].T
    assert len(lining) > 300
    slack = SpringFace.of_muscles(
        face.head, face.muscles, mechanics=face.mechanics,
        parameters=replace(face.parameters, across=0.0),
    )  # fmt: skip
    for name, pose in _emotions(face).items():
        apart = [
            np.linalg.norm(moved[lining] - moved[seen])
            for moved in (one.displace_skin(pose) for one in (face, slack))
        ]
        assert apart[0] < 0.7 * apart[1], name


def _gap(face: SpringFace, pose: dict[str, float]) -> float:
    """Return how far touching lips part at the most [mm]."""
    moved = face.displace_skin(pose)
    upper, lower = face.springs.seals.T
    return float(np.linalg.norm(moved[upper] - moved[lower], axis=1).max())


def test_muscles_of_the_corner_keep_the_lips_together_and_those_of_a_lip_part_them() -> None:
    face = default_face()
    assert len(face.springs.seals) > 10
    for name in ("zygomaticus_major", "risorius", "depressor_anguli"):
        pose = {f"{name}_l": 1.0, f"{name}_r": 1.0}
        assert _gap(face, pose) < 1.5, name
        unsealed = replace(face, driver=replace(face.driver, fields={}, seals={}))
        assert _gap(face, pose) < 0.6 * _gap(unsealed, pose)
    for name in ("levator_labii", "depressor_labii"):
        assert _gap(face, {f"{name}_l": 1.0, f"{name}_r": 1.0}) > 3.0


def test_what_holds_the_lips_together_adds_no_force_to_the_head() -> None:
    face = default_face()
    forces = face.springs.seal_forces(face.driver.fields["zygomaticus_major_l"])
    assert np.abs(forces).max() > 0.0
    assert np.abs(forces.sum(axis=0)).max() < 1e-9 * np.abs(forces).sum()


def test_a_muscle_that_is_drawn_anew_changes_what_it_does_and_nothing_else() -> None:
    face = default_face()
    assert face.ground is not None
    outline = default_recipe().outline("zygomaticus_major_l")
    stronger = replace(outline, settings=replace(outline.settings, max_contraction=0.3))
    changed = face.with_muscles(refit(face.muscles, stronger, face.ground))
    own, other = {"zygomaticus_major_l": 1.0}, {"depressor_anguli_l": 1.0, "mentalis_r": 0.5}
    assert np.abs(changed.displace(own) - face.displace(own)).max() > 1.0
    # Without mirror symmetry of the muscles sides are no longer averaged.
    assert np.abs(changed.displace(other) - face.displace(other)).max() < 0.3
    fresh = SpringFace.of_muscles(
        face.head, changed.muscles, bones=face.ground.bones, mechanics=face.mechanics
    )
    assert np.abs(fresh.displace(own) - changed.displace(own)).max() < 1e-9
    assert face.muscles.symmetric
    assert not changed.muscles.symmetric
    assert not changed.muscles.twins("zygomaticus_major_l", "zygomaticus_major_r")
    opposite = {"zygomaticus_major_r": 1.0}
    assert np.abs(changed.displace(opposite) - face.displace(opposite)).max() < 0.5
