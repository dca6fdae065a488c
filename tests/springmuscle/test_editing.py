"""What is drawn on the skin becomes a muscle that fits other heads, too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.template import builtin_head
from risorius.errors import ParameterError
from risorius.springmuscle.bones import builtin_bones
from risorius.springmuscle.drawing import drawn_outline, outline_point
from risorius.springmuscle.editing import (
    moved_point,
    on_one_side,
    on_two_sides,
    renamed,
    with_outline,
    with_point,
    without_outline,
    without_point,
)
from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.fit import Ground, fit_muscle
from risorius.springmuscle.measure import FaceMeasure
from risorius.springmuscle.recipe import OutlineRecipe
from risorius.springmuscle.recipe_file import default_recipe, parse_recipe, recipe_to_json
from risorius.springmuscle.redrawing import redrawn
from tests.real.heads import REAL_HEADS, real_head
from tests.springmuscle.faces import builtin_mechanics
from tests.springmuscle.skins import builtin_ground

# From the cheek bone to beside the mouth corner, on the left of the built-in head.
CHEEK = np.array([[50.0, -26.0, 78.0], [42.0, -22.0, 82.0]])
CORNER = np.array([[33.0, -62.0, 85.0], [29.0, -56.0, 88.0]])
MIRROR = np.array([-1.0, 1.0, 1.0])


def measure() -> FaceMeasure:
    return builtin_ground().surface.measure


def _rows(*places: np.ndarray) -> list[np.ndarray]:
    """Rows as the pointer would give them: on the skin, canonical frame."""
    frame, surface = builtin_head().frame, builtin_ground().surface
    return [surface.project(frame.to_canonical(row))[0] for row in places]


def smiler(recipe: OutlineRecipe | None = None, **options):
    return drawn_outline(
        recipe or default_recipe(), "smiler", _rows(CHEEK, CORNER), measure(), **options
    )


def _ring(centre: np.ndarray, radii: tuple[float, float], turn: float = 1.0) -> list[np.ndarray]:
    rows = []
    for angle in turn * np.linspace(0.0, 2.0 * np.pi, 9)[:-1]:
        way = np.array([np.cos(angle), np.sin(angle), 0.0])
        places = centre + np.array(radii)[:, None] * way
        rows.append(builtin_ground().surface.project(places)[0])
    return rows


@pytest.fixture(scope="module")
def face() -> SpringFace:
    return SpringFace.build(builtin_head(), mechanics=builtin_mechanics())


@given(
    x=st.floats(-60, 60), y=st.floats(-110, 60), z=st.floats(40, 110)
)  # fmt: skip
def test_a_place_is_found_again_to_the_accuracy_of_files(x: float, y: float, z: float) -> None:
    place = builtin_head().frame.to_canonical(np.array([[x, y, z]]))[0]
    point = outline_point(place, measure())
    assert np.abs(point.place(measure()) - place).max() <= 0.51e-4 * measure().unit.max()
    flipped = outline_point(place * MIRROR, measure()).place(measure())
    assert np.abs(flipped * MIRROR - place).max() < 2e-4 * measure().width


def test_a_point_on_the_midline_hangs_on_both_sides_alike() -> None:
    place = builtin_head().landmarks.position("2.1") + [0.0, 4.0, 0.0]
    point = outline_point(place, measure())
    assert point.mirrored().place(measure()) == pytest.approx(point.place(measure()), abs=0.02)
    assert sorted(point.anchors) == sorted(point.mirrored().anchors)


def test_places_follow_a_head_that_is_scaled_and_stretched() -> None:
    place = _rows(CORNER)[0][0]
    factor = np.array([1.3, 0.8, 1.3])
    marks = {name: at * factor for name, at in measure().landmarks.items()}
    other = FaceMeasure(marks, measure().width * 1.3, measure().height * 0.8)
    point = outline_point(place, measure())
    assert point.place(other) == pytest.approx(place * factor, abs=0.02)


def test_what_is_drawn_right_is_the_mirror_image_of_what_is_drawn_left() -> None:
    right = drawn_outline(
        default_recipe(), "smiler", [r * MIRROR for r in _rows(CHEEK, CORNER)], measure()
    )
    assert right.mirror and right.name == "smiler"
    for one, two in zip(right.rows, smiler().rows):
        for p, q in zip(one, two):
            assert p.place(measure()) == pytest.approx(q.place(measure()), abs=0.03)


def test_drawn_muscles_survive_their_file_unchanged() -> None:
    recipe = with_outline(default_recipe(), smiler())
    ring = drawn_outline(
        recipe, "closer", _ring(measure().landmarks["8.1"] - [0, 9, 0], (25.0, 38.0)), measure(),
        ring=True,
    )  # fmt: skip
    recipe = with_outline(recipe, ring)
    assert parse_recipe(recipe_to_json(recipe), source="test") == recipe


@pytest.mark.parametrize("turn", [1.0, -1.0])
def test_a_ring_around_the_mouth_closes_it_and_one_on_the_cheek_is_drawn_together(
    face: SpringFace, turn: float
) -> None:
    marks = measure().landmarks
    mouth = 0.5 * (marks["2.2"] + marks["2.3"])
    recipe = default_recipe()
    ring = drawn_outline(
        recipe, "closer", _ring(mouth, (30.0, 40.0), turn), measure(), ring=True
    )  # fmt: skip
    assert not ring.mirror and ring.ring is not None and ring.ring.ahead > 0.0
    cheek = _rows(np.array([[45.0, -50.0, 80.0]]))[0][0]
    patch = drawn_outline(recipe, "patch", _ring(cheek, (3.0, 10.0), turn), measure(), ring=True)
    assert patch.mirror and patch.ring is not None and patch.ring.ahead == 0.0
    after = redrawn(face, recipe, with_outline(with_outline(recipe, ring), patch))
    rest = after.head.landmarks
    moved = after.pose({"closer": 1.0}) - after.head.positions
    skin = after.head.skin

    def way(name: str) -> np.ndarray:
        return moved[skin.first_source()][after.head.skin_vertex(name)]

    assert way("8.3")[0] < -1.0 and way("8.4")[0] > 1.0, "the corners come together"
    assert rest.position("8.3")[0] > 0.0
    pulled = after.pose({"patch_l": 1.0}) - after.head.positions
    near = np.linalg.norm(after.head.positions - cheek, axis=1) < 12.0
    assert np.linalg.norm(pulled[near], axis=1).max() > 0.5


def test_a_redrawn_face_is_the_one_that_is_built_from_the_start(face: SpringFace) -> None:
    before = default_recipe()
    after = without_outline(with_outline(before, smiler()), "risorius")
    quick = redrawn(face, before, after)
    slow = SpringFace.build(builtin_head(), after, mechanics=builtin_mechanics())
    assert quick.controls == slow.controls
    for pose in ({"smiler_l": 1.0}, {"smiler_r": 0.7, "zygomaticus_major_l": 0.5}):
        assert np.abs(quick.pose(pose) - slow.pose(pose)).max() < 2e-4 * builtin_head().height
    kept = {m.name: m for m in face.muscles.muscles}
    same = [m for m in quick.muscles.muscles if kept.get(m.name) is m]
    assert len(same) == len(quick.muscles.muscles) - 2


def test_a_drawn_muscle_lifts_the_mouth_corner_of_its_side(face: SpringFace) -> None:
    after = redrawn(face, default_recipe(), with_outline(default_recipe(), smiler()))
    moved = after.pose({"smiler_l": 1.0}) - after.head.positions
    skin = after.head.skin.first_source()
    left, right = (moved[skin][after.head.skin_vertex(name)] for name in ("8.3", "8.4"))
    assert left[1] > 1.5
    assert np.linalg.norm(right) < 0.2 * np.linalg.norm(left)


@pytest.mark.real
@pytest.mark.parametrize("name", REAL_HEADS)
def test_what_was_drawn_on_the_built_in_head_fits_real_heads(name: str) -> None:
    mechanics = Mechanics.build(real_head(name))
    ground = Ground.build(mechanics, builtin_bones(mechanics))
    muscle = fit_muscle(smiler().sided(1), ground)
    assert muscle.report.inside >= 0.95 and muscle.report.covered == 1.0
    marks, size = ground.surface.measure.landmarks, ground.surface.measure.width
    start, end = muscle.grid[0].mean(axis=0), muscle.grid[-1].mean(axis=0)
    assert np.linalg.norm(end - marks["8.3"]) < 0.2 * size, "it ends at the mouth corner"
    assert np.linalg.norm(start - marks["3.7"]) < 0.6 * size, "and begins below the eye"


def test_a_muscle_of_one_side_moves_that_side_only(face: SpringFace) -> None:
    one = smiler(mirror=False)
    assert (one.name, one.mirror) == ("smiler_l", False)
    after = redrawn(face, default_recipe(), with_outline(default_recipe(), one))
    assert not after.muscles.symmetric and face.muscles.symmetric
    names = {control.name for control in after.controls}
    assert "smiler_l" in names and "smiler_r" not in names
    moved = np.linalg.norm(after.pose({"smiler_l": 1.0}) - after.head.positions, axis=1)
    right = after.head.positions[:, 0] < -20.0
    assert moved[right].max() < 0.1 * moved.max()


def test_mirroring_is_switched_off_and_on_again() -> None:
    paired = smiler()
    one = on_one_side(paired)
    assert one.name == "smiler_l"
    assert on_two_sides(one, measure()) == paired
    right = replace(paired.sided(-1), control="")
    assert right.name == "smiler_r"
    assert on_two_sides(right, measure()) == paired
    middle = next(o for o in default_recipe().muscles if o.name == "orbicularis_oris")
    with pytest.raises(ParameterError, match="lies on the midline"):
        on_two_sides(middle, measure())


def test_points_are_moved_inserted_and_taken_away() -> None:
    muscle = smiler()
    other = outline_point(_rows(CORNER + [0.0, -5.0, 0.0])[0][0], measure())
    assert moved_point(muscle, 1, 0, other).rows[1] == (other, muscle.rows[1][1])
    longer = with_point(muscle, 1, 0, other)
    assert longer.rows[1] == (muscle.rows[1][0], other, muscle.rows[1][1])
    assert without_point(longer, 1, 1) == muscle
    three = replace(muscle, rows=(*muscle.rows, muscle.rows[0]))
    assert without_point(three, 1, 0).rows == (muscle.rows[0], muscle.rows[0])
    with pytest.raises(ParameterError, match="delete the muscle instead"):
        without_point(muscle, 0, 0)
    with pytest.raises(ParameterError, match="no point 7 in row 0"):
        moved_point(muscle, 0, 7, other)


def test_a_renamed_muscle_keeps_a_control_that_it_shares() -> None:
    recipe = with_outline(default_recipe(), smiler())
    after = renamed(recipe, "smiler", "grinner")
    assert after.outline("grinner_l").rows == recipe.outline("smiler_l").rows
    assert after.outline("grinner_l").control == "grinner_l"
    shared = renamed(recipe, "procerus", "root")
    assert shared.outline("root_l").control == "procerus"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda r: renamed(r, "risorius", "Smile!"), "use small letters"),
        (lambda r: renamed(r, "risorius", "smile_l"), "leave out the side"),
        (lambda r: renamed(r, "risorius", "mentalis"), "is taken"),
        (lambda r: renamed(r, "thigh", "leg"), "there is no 'thigh'"),
        (lambda r: without_outline(r, "thigh"), "there is no 'thigh'"),
        (lambda r: without_outline(OutlineRecipe(r.muscles[:1]), r.muscles[0].name), "the last"),
        (lambda r: drawn_outline(r, "x", _rows(CHEEK), measure()), "1 rows, 2 are needed"),
        (lambda r: drawn_outline(r, "x", [CHEEK * np.nan, CHEEK], measure()), "three finite"),
        (lambda r: outline_point([1.0, 2.0], measure()), "three finite"),
    ],
)
def test_what_cannot_be_is_refused(change, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        change(default_recipe())


def test_a_taken_name_gets_a_number() -> None:
    recipe = with_outline(default_recipe(), smiler())
    assert smiler(recipe).name == "smiler_2"
