"""The default recipe on the built-in head and on coarse versions of it."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

from risorius.anatomy.jaw import JawPose
from risorius.errors import ParameterError, RisoriusWarning
from risorius.springmuscle.bones import builtin_bones
from risorius.springmuscle.contraction import Contraction
from risorius.springmuscle.ellipsoid import Ellipsoids
from risorius.springmuscle.fit import Ground, fit_muscle, fit_muscles
from risorius.springmuscle.fit_parameters import FitParameters
from risorius.springmuscle.muscle import JAW, SKULL
from risorius.springmuscle.muscle_set import MuscleSet
from risorius.springmuscle.recipe import OutlinePoint, OutlineRecipe
from risorius.springmuscle.recipe_file import default_recipe
from tests.face_fixtures import made_up_mechanics
from tests.springmuscle.coarse import coarse_mechanics
from tests.springmuscle.faces import builtin_mechanics
from tests.springmuscle.skins import builtin_ground, builtin_muscles

MIRROR = np.array([-1.0, 1.0, 1.0])


def _muscle(name: str, profile: str = "improved"):
    return next(m for m in builtin_muscles(profile).muscles if m.name == name)


def _points(muscle) -> np.ndarray:
    return np.concatenate([fibre.points for fibre in muscle.fibres])


def test_at_least_95_percent_of_every_muscle_lies_in_its_layer() -> None:
    for muscle in builtin_muscles().muscles:
        assert muscle.report.inside >= 0.95, muscle.name
        assert muscle.report.missed <= 0.2 * muscle.grid.shape[0] * muscle.grid.shape[1]


def test_left_and_right_are_mirror_images_and_the_middle_is_its_own() -> None:
    by_name = {muscle.name: muscle for muscle in builtin_muscles().muscles}
    for name, muscle in by_name.items():
        if name.endswith("_l"):
            right = by_name[f"{name[:-2]}_r"]
            assert (_points(right) == _points(muscle) * MIRROR).all()
            for a, b in zip(muscle.fibres, right.fibres):
                assert np.abs(np.linalg.det(b.frames) - 1.0).max() < 1e-9
                spread = a.frames * a.half_axes[:, None] ** 2 @ a.frames.transpose(0, 2, 1)
                other = b.frames * b.half_axes[:, None] ** 2 @ b.frames.transpose(0, 2, 1)
                assert np.abs(spread * np.outer(MIRROR, MIRROR) - other).max() < 1e-9
        elif muscle.side == 0:
            points = _points(muscle)
            apart = np.linalg.norm(points[:, None] - points[None] * MIRROR, axis=2)
            assert apart.min(axis=1).max() < 0.01
            opposite = apart.argmin(axis=1)
            bones = np.concatenate([fibre.bones for fibre in muscle.fibres])
            assert (bones == bones[opposite]).all()


def test_the_same_head_and_recipe_give_the_same_bytes() -> None:
    again = fit_muscles(default_recipe(), builtin_ground())
    first = builtin_muscles()
    assert again.points.tobytes() == first.points.tobytes()
    assert again.half_axes.tobytes() == first.half_axes.tobytes()
    assert again.links.ends.tobytes() == first.links.ends.tobytes()


def test_ellipsoids_fill_their_cells_below_the_skin() -> None:
    muscles = builtin_muscles()
    assert (muscles.half_axes > 0.0).all()
    gram = muscles.frames.transpose(0, 2, 1) @ muscles.frames
    assert np.abs(gram - np.eye(3)).max() < 1e-9
    assert np.abs(np.linalg.det(muscles.frames) - 1.0).max() < 1e-9
    for muscle in muscles.muscles:
        for fibre in muscle.fibres:
            ratio = 2.0 * fibre.half_axes[:, 0] / fibre.lengths
            inner = ratio if muscle.closed else ratio[1:-1]
            assert np.abs(inner - 1.1).max(initial=0.0) < 1e-9
            if not muscle.closed:
                assert np.abs(ratio[[0, -1]] - 1.0).max() < 1e-9
    # The upper side of the muscle lies below the skin's thickness, within half a millimetre.
    surface = builtin_ground().surface
    top = muscles.centres + muscles.frames[:, :, 2] * muscles.half_axes[:, 2:]
    hits = surface.scene.cast(top, muscles.frames[:, :, 2], max_distance=12.0)
    assert (hits.distance[hits.hit] > 1.0).mean() > 0.97
    assert hits.hit.mean() > 0.97


def test_rows_hang_on_the_bones_that_anatomy_wants() -> None:
    for name in ("frontalis_inner_l", "corrugator_l", "zygomaticus_major_l", "levator_labii_l"):
        assert (_muscle(name).fibres[0].bones == SKULL).all(), name
    for name in ("depressor_labii_l", "mentalis_l", "depressor_anguli_l"):
        assert (_muscle(name).fibres[0].bones[:3] == JAW).all(), name
    ring = _muscle("orbicularis_oris").fibres[0]
    upper, lower = ring.lips > 0, ring.lips < 0
    assert upper.sum() >= 4
    assert lower.sum() >= 4
    assert (ring.bones[:-1][upper] == SKULL).all()
    assert (ring.bones[:-1][lower] == JAW).all()
    assert ring.bones[0] == ring.bones[-1]


def test_muscles_around_the_mouth_merge_with_its_ring() -> None:
    muscles = builtin_muscles()
    hosts: dict[str, set[str]] = {}
    for (fibre, _), (host, _) in zip(muscles.links.ends, muscles.links.hosts):
        guest = muscles.muscles[muscles.fibre_muscle[fibre]]
        hosts.setdefault(guest.name, set()).add(muscles.muscles[muscles.fibre_muscle[host]].name)
    for name in ("zygomaticus_major_l", "levator_labii_l", "depressor_anguli_l", "risorius_l"):
        assert "orbicularis_oris" in hosts[name], name
    # A second action on the same ring takes no ends.
    assert not any("orbicularis_oris_funnel" in names for names in hosts.values())
    sides = {muscle.name: muscle.side for muscle in muscles.muscles}
    assert all(sides[a] * sides[b] >= 0 for a, names in hosts.items() for b in names)


def test_the_lower_ring_follows_the_jaw_and_its_aim_stays_between_the_bones() -> None:
    muscles, jaw = builtin_muscles(), builtin_mechanics().jaw
    pose = JawPose(15.0)
    points, aims = muscles.moved_with_jaw(jaw, pose)
    on_jaw = muscles.bones == JAW
    assert np.abs(points[on_jaw] - jaw.move(muscles.points[on_jaw], pose)).max() < 1e-12
    assert (points[~on_jaw] == muscles.points[~on_jaw]).all()
    number = [m.name for m in muscles.muscles].index("orbicularis_oris")
    own = muscles.point_muscle == number
    half = 0.5 * (muscles.aims[own] + jaw.move(muscles.aims[own], pose))
    assert np.abs(aims[own] - half).max() < 1e-9
    still, unmoved = muscles.moved_with_jaw(jaw, JawPose())
    assert (still == muscles.points).all()
    assert (unmoved == muscles.aims)[own].all()


def test_a_puckered_mouth_gets_narrower_goes_forward_and_thins_what_hangs_on_it() -> None:
    muscles, jaw = builtin_muscles(), builtin_mechanics().jaw
    points, aims = muscles.moved_with_jaw(jaw, JawPose(15.0))
    contract = Contraction(muscles)
    opened = contract(muscles.contractions({}), points=points, aims=aims)
    pursed = contract(muscles.contractions({"orbicularis_oris": 1.0}), points=points, aims=aims)
    number = [m.name for m in muscles.muscles].index("orbicularis_oris")
    own = muscles.point_muscle == number
    assert np.ptp(pursed.points[own, 0]) < 0.75 * np.ptp(opened.points[own, 0])
    assert pursed.points[own, 2].mean() > opened.points[own, 2].mean() + 3.0
    on_ring = muscles.fibre_muscle[muscles.links.hosts[:, 0]] == number
    hung = np.unique(muscles.fibre_muscle[muscles.links.ends[on_ring, 0]])
    assert len(hung) > 10
    thinner = [
        pursed.heights[muscles.segment_muscle == k].mean()
        < opened.heights[muscles.segment_muscle == k].mean()
        for k in hung
    ]
    assert np.mean(thinner) >= 0.85


def test_the_faithful_profile_keeps_published_numbers_and_builds() -> None:
    muscles = builtin_muscles("faithful")
    assert len(muscles.muscles) == len(builtin_muscles().muscles)
    for muscle in muscles.muscles:
        assert muscle.action.fixed_point == 0.0
        assert muscle.pivot is None
    ring = _muscle("orbicularis_oris", "faithful").fibres[0]
    # Without an aim ahead of the lips the centre lies in their plane.
    assert abs(ring.aims[0, 2] - ring.points[:, 2].max()) < 12.0
    assert _muscle("orbicularis_oris").fibres[0].aims[0, 2] > ring.aims[0, 2] + 10.0
    eye = _muscle("orbicularis_oculi_l", "faithful").fibres[0]
    assert np.abs(np.diff(eye.aims, axis=0)).max() == 0.0


@pytest.mark.parametrize("share", [0.5, 0.2])
def test_the_recipe_builds_on_coarse_versions_of_the_head(share: float) -> None:
    mechanics = coarse_mechanics(share)
    ground = Ground.build(mechanics, builtin_bones(builtin_mechanics()))
    muscles = fit_muscles(default_recipe(), ground)
    whole = builtin_muscles()
    assert [m.name for m in muscles.muscles] == [m.name for m in whole.muscles]
    assert len(muscles.centres) < len(whole.centres)
    assert np.mean([m.report.inside >= 0.95 for m in muscles.muscles]) >= 0.9
    assert len(muscles.links.ends) > 20
    for coarse, fine in zip(muscles.muscles, whole.muscles):
        # Landmarks of the coarse head are its nearest vertices.
        apart = np.linalg.norm(_points(coarse).mean(axis=0) - _points(fine).mean(axis=0))
        assert apart < 0.15 * ground.surface.measure.width, coarse.name


def test_a_thicker_skin_sinks_one_muscle_and_no_other() -> None:
    recipe = default_recipe()
    outline = next(o for o in recipe.muscles if o.name == "zygomaticus_major")
    thick = replace(outline, settings=replace(outline.settings, skin=5.0))
    ground = builtin_ground()
    before = fit_muscle(outline.sided(1), ground)
    after = fit_muscle(thick.sided(1), ground)
    start, end = (m.grid.reshape(-1, 3) for m in (before, after))
    depth = ground.surface.scene.cast(end, after.grid_normals.reshape(-1, 3)).distance.mean()
    shallow = ground.surface.scene.cast(start, before.grid_normals.reshape(-1, 3)).distance.mean()
    assert abs(depth - shallow - 3.0 * ground.surface.scale) < 0.3


def test_without_merging_nothing_is_linked() -> None:
    parameters = replace(FitParameters(), merge=False)
    ground = replace(builtin_ground(), parameters=parameters)
    one = type(default_recipe())(default_recipe().muscles[:2])
    muscles = fit_muscles(one, ground)
    assert isinstance(muscles, MuscleSet)
    assert len(muscles.links.ends) == 0


def test_contracted_muscles_stay_finite_at_every_limit() -> None:
    muscles = builtin_muscles()
    contract = Contraction(muscles)
    for values in (np.ones(len(muscles.muscles)), np.arange(len(muscles.muscles)) % 2):
        moved = contract(values)
        assert np.isfinite(moved.axes).all()
        assert np.isfinite(moved.centres).all()
        solids = Ellipsoids.of(muscles, moved)
        assert (solids.half_axes > 0.0).all()
        assert np.linalg.norm(moved.points - muscles.points, axis=1).max() < 80.0


def test_a_rolled_lip_goes_over_the_teeth_and_its_skin_follows_it() -> None:
    muscles = builtin_muscles()
    for name, down in (("orbicularis_oris_upper", -1.0), ("orbicularis_oris_lower", 1.0)):
        number = [m.name for m in muscles.muscles].index(name)
        own = muscles.point_muscle == number
        moved = Contraction(muscles)(muscles.contractions({name: 1.0})).points[own]
        way = moved - muscles.points[own]
        middle = np.abs(muscles.points[own][:, 0]) < 8.0
        assert (down * way[middle, 1]).mean() > 2.0
        # The margin goes in, farther from it less.
        near = np.abs(muscles.points[own][:, 1] + 69.0)
        assert np.corrcoef(near[middle], way[middle, 2])[0, 1] > 0.9


def test_a_turning_ring_needs_a_line() -> None:
    outline = next(o for o in default_recipe().muscles if o.name == "orbicularis_oris_upper")
    assert outline.ring is not None
    with pytest.raises(ParameterError, match="turns about a line, but has none"):
        replace(outline, ring=replace(outline.ring, line=()))


def test_landmarks_that_a_head_lacks_are_guessed_with_a_warning() -> None:
    mechanics = made_up_mechanics()
    assert "4.1" not in mechanics.head.landmarks
    with pytest.warns(RisoriusWarning, match=r"4\.1.* are guessed from the others"):
        ground = Ground.build(mechanics, builtin_bones(mechanics))
    with warnings.catch_warnings():
        # Its cheeks are open at the back, where the buccinator begins.
        warnings.simplefilter("ignore", RisoriusWarning)
        muscles = fit_muscles(default_recipe(), ground)
    assert len(muscles.muscles) == len(builtin_muscles().muscles)
    assert np.median([m.report.inside for m in muscles.muscles]) >= 0.95
    guessed, eye = (ground.surface.measure.landmarks[name] for name in ("4.1", "3.11"))
    assert guessed[1] > eye[1]
    assert guessed[0] > 0.0


def test_rings_are_closed_and_lids_are_drawn_to_a_line() -> None:
    for muscle in builtin_muscles().muscles:
        for fibre in muscle.fibres:
            assert (fibre.points[0] == fibre.points[-1]).all() == muscle.closed
    eye = _muscle("orbicularis_oculi_l").fibres[0]
    marks = builtin_ground().surface.measure.landmarks
    inner, outer = marks["3.11"][0], marks["3.7"][0]
    between = (eye.points[:, 0] > inner) & (eye.points[:, 0] < outer)
    assert between.sum() > 5
    assert np.abs(eye.aims - eye.points)[between, 0].max() < 2.0
    assert (eye.aims[:, 0] > inner - 1.0).all()
    assert (eye.aims[:, 0] < outer + 1.0).all()


def test_sides_that_were_drawn_apart_stay_apart() -> None:
    outline = next(o for o in default_recipe().muscles if o.name == "risorius")
    left, right = outline.sided(1), outline.sided(-1)
    assert right.mirrors(left)
    wide = replace(right, settings=replace(right.settings, radius=20.0))
    assert not wide.mirrors(left)
    muscles = fit_muscles(OutlineRecipe((left, wide)), builtin_ground()).muscles
    assert [m.name for m in muscles] == ["risorius_l", "risorius_r"]
    assert muscles[1].action.radius > muscles[0].action.radius


def test_an_outline_beside_the_skin_is_told_of_and_does_not_crash() -> None:
    outline = default_recipe().outline("risorius_l")
    rows = tuple(
        tuple(OutlinePoint(p.anchors, (p.offset[0], p.offset[1], p.offset[2] - 4.0)) for p in row)
        for row in outline.rows
    )
    with pytest.warns(RisoriusWarning, match=r"outline risorius_l: 100% of its points lie beside"):
        muscle = fit_muscle(replace(outline, rows=rows), builtin_ground())
    assert np.isfinite(_points(muscle)).all()
