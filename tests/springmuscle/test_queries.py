"""What an editor of muscles asks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from risorius.errors import ParameterError
from risorius.springmuscle.contraction import Contraction
from risorius.springmuscle.muscle import JAW
from risorius.springmuscle.queries import refit, view_muscle
from risorius.springmuscle.recipe import OutlinePoint
from risorius.springmuscle.recipe_file import default_recipe
from tests.springmuscle.skins import builtin_ground, builtin_muscles


def _dragged(name: str, way: float):
    outline = default_recipe().outline(name)
    rows = tuple(
        tuple(
            OutlinePoint(p.anchors, (p.offset[0], p.offset[1] + way, p.offset[2]), p.weights)
            for p in row
        )
        for row in outline.rows
    )
    return replace(outline, rows=rows)


def test_refitting_the_same_outline_changes_nothing() -> None:
    before = builtin_muscles()
    after = refit(before, default_recipe().outline("zygomaticus_major_l"), builtin_ground())
    assert after.points.tobytes() == before.points.tobytes()
    assert after.links.ends.tobytes() == before.links.ends.tobytes()
    assert after.links.hosts.tobytes() == before.links.hosts.tobytes()


def test_refitting_moves_one_muscle_and_merges_anew() -> None:
    before = builtin_muscles()
    name = "frontalis_inner_l"
    after = refit(before, _dragged(name, 0.5), builtin_ground())
    for old, new in zip(before.muscles, after.muscles):
        assert old.name == new.name
        assert (old is new) == (old.name != name)

    def linked(muscles) -> set[str]:
        owners = muscles.fibre_muscle[muscles.links.ends[:, 0]]
        return {muscles.muscles[k].name for k in owners}

    assert name in linked(before)
    assert name not in linked(after)
    assert "frontalis_inner_r" in linked(after)


def test_a_paired_outline_refits_both_sides() -> None:
    outline = next(o for o in default_recipe().muscles if o.name == "risorius")
    wide = replace(outline, settings=replace(outline.settings, radius=20.0))
    after = refit(builtin_muscles(), wide, builtin_ground())
    radii = {m.name: m.action.radius for m in after.muscles if m.base_name == "risorius"}
    assert len(radii) == 2
    assert len(set(radii.values())) == 1
    assert radii["risorius_l"] == pytest.approx(20.0 * builtin_ground().surface.scale)


def test_the_view_has_everything_an_editor_draws() -> None:
    muscles, ground = builtin_muscles(), builtin_ground()
    for name in ("zygomaticus_major_l", "orbicularis_oris", "depressor_anguli_l"):
        view = view_muscle(muscles, name, ground)
        number = [m.name for m in muscles.muscles].index(name)
        muscle = muscles.muscles[number]
        rows, columns = muscle.grid.shape[:2]
        cells = (rows - 1) * (columns - 1)
        assert view.grid_lines.shape == ((rows - 1) * columns + rows * (columns - 1), 2, 3)
        assert view.cells.shape == (cells, 4, 3)
        assert view.near.shape == view.far.shape == view.thickness.shape == (cells,)
        assert view.ellipsoids.shape == ((muscles.segment_muscle == number).sum(), 4, 4)
        assert len(view.influenced) > 50
        assert len(np.unique(view.influenced)) == len(view.influenced)
        own = muscles.point_muscle == number
        assert len(view.jaw_points) == (own & (muscles.bones == JAW)).sum()
        assert len(view.merged) > 0
        assert name not in view.partners
    assert "orbicularis_oris" in view_muscle(muscles, "zygomaticus_major_l", ground).partners
    assert "zygomaticus_major_l" in view_muscle(muscles, "orbicularis_oris", ground).partners


def test_transforms_take_the_unit_sphere_to_the_ellipsoids_also_when_contracted() -> None:
    muscles, ground = builtin_muscles(), builtin_ground()
    number = [m.name for m in muscles.muscles].index("zygomaticus_major_l")
    own = np.flatnonzero(muscles.segment_muscle == number)
    moved = Contraction(muscles)(muscles.contractions({"zygomaticus_major_l": 1.0}))
    for contracted in (None, moved):
        view = view_muscle(muscles, "zygomaticus_major_l", ground, contracted=contracted)
        tip = view.ellipsoids @ [0.0, 0.0, 1.0, 1.0]
        middle = view.ellipsoids @ [0.0, 0.0, 0.0, 1.0]
        centres = muscles.centres if contracted is None else contracted.centres
        heights = 1.0 if contracted is None else contracted.heights[own]
        assert np.abs(middle[:, :3] - centres[own]).max() < 1e-9
        up = np.linalg.norm((tip - middle)[:, :3], axis=1)
        assert np.abs(up - muscles.half_axes[own, 2] * heights).max() < 1e-9


def test_unknown_muscles_are_refused_by_name() -> None:
    muscles, ground = builtin_muscles(), builtin_ground()
    with pytest.raises(ParameterError, match=r"no 'thigh'; there are frontalis_inner_l"):
        view_muscle(muscles, "thigh", ground)
    strange = replace(default_recipe().outline("risorius_l"), name="thigh")
    with pytest.raises(ParameterError, match="no 'thigh' to refit"):
        refit(muscles, strange, ground)
