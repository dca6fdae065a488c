"""Spring muscles, drawn as outline grids on the skin, row by row.

References
----------
Kaehler, Haber and Seidel 2001, section 5.1 (the muscle editor).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

import numpy as np

from risorius.errors import FormatError, ParameterError
from risorius.springmuscle.drawing import free_name, outline_point
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
from risorius.springmuscle.fit import Ground
from risorius.springmuscle.fit_parameters import FitParameters
from risorius.springmuscle.grid import lay_out
from risorius.springmuscle.recipe import MuscleOutline, OutlinePoint, OutlineSettings
from risorius.studio.drawing.craft import Choice, Craft, Entry, Handle, Number, Tool, Traits
from risorius.studio.drawing.sketch import Sketch
from risorius.studio.drawing.spring_sketch import SpringSketch, bodies_of, ground_of
from risorius.studio.places import Place
from risorius.studio.work import Work

__all__ = ["SpringCraft"]

_CENTRE = "centre"
# Outlines are drawn on the skin; the muscles show through it.
_OUTSIDE = {"skin": 0.55, "parts": 1.0, "skull": 0.0, "muscles": 1.0}
_KINDS = ("linear", "sheet", "curved")
_LIPS = ("free", "kept together")
# Lengths in millimetres at the reference width.
_NUMBERS = {
    "skin": (0.5, 8.0), "least thickness": (0.3, 6.0), "most thickness": (0.5, 12.0),
    "radius": (3.0, 40.0), "shortening": (0.05, 1.0), "stiffness": (0.1, 6.0),
    "fixed point": (0.0, 1.0), "bulge": (0.0, 6.0),
}  # fmt: skip
_FIELDS = {"shortening": "max_contraction", "fixed point": "fixed_point"}


class SpringCraft(Craft):
    """Muscles of the outline recipe."""

    title = "springs"
    hint = "Click a muscle to change it, or <b>Draw a grid</b> to make a new one."
    tools = (Tool("grid", "Draw a grid", "grid_on"), Tool("ring", "Draw a ring", "circle"))
    looks: ClassVar[Mapping[str, float]] = _OUTSIDE
    on_bone: ClassVar[bool] = False

    def entries(self) -> list[Entry]:
        """Return the muscles of the recipe, both sides in one line."""
        return [
            Entry("spring muscles", each.name, bodies_of(each)) for each in self.work.recipe.muscles
        ]

    def own_name(self, name: str) -> str:
        """Return the name in the recipe."""
        owners = [each.name for each in self.work.recipe.muscles if name in bodies_of(each)]
        return owners[0] if owners else name if self._named(name) else ""

    def controls(self, name: str) -> tuple[str, ...]:
        """Return the controls of both sides."""
        own = self._named(self.own_name(name))
        if own is None:
            return ()
        sides = (own.sided(1), own.sided(-1)) if own.mirror else (own,)
        return tuple(dict.fromkeys(each.control or each.name for each in sides))

    def traits(self, name: str) -> Traits:
        """Return what can be changed."""
        outline = self._outline(name)
        numbers = [
            Number(key, *_NUMBERS[key], value) for key, value in self._numbers(outline).items()
        ]
        choices = [Choice("lips", _LIPS, _LIPS[outline.settings.seal])]
        if outline.ring is None:
            choices.insert(0, Choice("type", _KINDS, outline.kind))
        words = (
            "Drag a point on the skin. Shift + click deletes it, Alt + click inserts one. The grid "
            "is divided by itself, as finely as the skin asks for."
        )
        return Traits(
            outline.name.removesuffix("_l").removesuffix("_r"), tuple(numbers), tuple(choices),
            mirror=outline.mirror, can_rename=True, words=words,
        )  # fmt: skip

    def handles(self, name: str) -> list[Handle]:
        """Return the points as drawn, on the skin, and the centre of a ring."""
        if not self.own_name(name):
            return []
        sided, surface = self._sided(name), self._ground.surface
        keys = [(r, c) for r, row in enumerate(sided.rows) for c in range(len(row))]
        places = np.array([sided.rows[r][c].place(surface.measure) for r, c in keys])
        on, result = ("skin",), list[Handle]()
        for (r, c), place in zip(keys, surface.project(places)[0]):
            result.append(Handle(f"{r}.{c}", place, f"row {r + 1}, point {c + 1}", on))
        if sided.ring is not None:
            centre = sided.ring.centre.place(surface.measure)
            result.append(Handle(_CENTRE, centre, "what it closes towards", on))
        return result

    def sketch(self, tool: str, name: str, *, mirror: bool) -> Sketch:
        """Begin a grid or a ring."""
        if tool not in ("grid", "ring"):
            return super().sketch(tool, name, mirror=mirror)
        free_name(self.work.recipe, name)
        ground_of(self.subject)
        return SpringSketch(name, mirror=mirror, ring=tool == "ring")

    def with_number(self, name: str, key: str, value: float) -> Work:
        """Set a number; least and most thickness stay in order."""
        outline = self._outline(name)
        if key not in self._numbers(outline):
            return super().with_number(name, key, value)
        settings = outline.settings
        if key in ("least thickness", "most thickness"):
            numbers = self._numbers(outline)
            least, most = numbers["least thickness"], numbers["most thickness"]
            pair = (value, max(most, value)) if key.startswith("least") else (
                min(least, value), value,
            )  # fmt: skip
            settings = replace(settings, thickness=pair)
        else:
            settings = replace(settings, **{_FIELDS.get(key, key): value})  # pyright: ignore
        return self._with(replace(outline, settings=settings))

    def with_choice(self, name: str, key: str, value: str) -> Work:
        """Set its type, or whether the lips stay together while it pulls."""
        outline = self._outline(name)
        if key == "lips" and value in _LIPS:
            settings = replace(outline.settings, seal=value == _LIPS[True])
            return self._with(replace(outline, settings=settings))
        if key == "type" and value in _KINDS:
            return self._with(replace(outline, kind=value))
        return super().with_choice(name, key, value)

    def renamed(self, name: str, new: str) -> tuple[Work, str]:
        """Rename it in the recipe."""
        outline = self._outline(name)
        stem = outline.name.removesuffix("_l").removesuffix("_r")
        side = name[-2:] if name.endswith(("_l", "_r")) else ""
        changed = renamed(self.work.recipe, outline.name, new)
        return replace(self.work, recipe=changed), (new if new != stem else stem) + side

    def mirrored(self, name: str, *, mirror: bool) -> tuple[Work, str]:
        """Put it on both sides or on the left alone."""
        old, recipe = self._outline(name), self.work.recipe
        measure = self._ground.surface.measure
        new = on_two_sides(old, measure) if mirror else on_one_side(old)
        kept = tuple(new if each is old else each for each in recipe.muscles)
        changed = replace(self.work, recipe=replace(recipe, muscles=kept))
        return changed, bodies_of(new)[0]

    def without(self, name: str) -> Work:
        """Delete it."""
        changed = without_outline(self.work.recipe, self._outline(name).name)
        return replace(self.work, recipe=changed)

    def moved(self, name: str, key: str, place: Place) -> Work:
        """Move a point of a row, or the centre."""
        outline = self._outline(name)
        point = self._flipped(name, outline_point(place.position, self._ground.surface.measure))
        if key == _CENTRE and outline.ring is not None:
            return self._with(replace(outline, ring=replace(outline.ring, centre=point)))
        return self._with(moved_point(outline, *_indices(key), point))

    def with_point(self, name: str, key: str) -> Work:
        """Insert a point half way to the next one of its row."""
        outline, places = self._outline(name), {h.key: h.place for h in self.handles(name)}
        row, column = _indices(key)
        beside = f"{row}.{column + 1}"
        if beside not in places:
            column -= 1
            beside = f"{row}.{column}"
        if key not in places or beside not in places:
            return super().with_point(name, key)
        middle = 0.5 * (places[key] + places[beside])[None]
        there = self._ground.surface.project(middle)[0][0]
        point = self._flipped(name, outline_point(there, self._ground.surface.measure))
        return self._with(with_point(outline, row, column, point))

    def without_point(self, name: str, key: str) -> Work:
        """Delete a point; a row of two goes as a whole."""
        return self._with(without_point(self._outline(name), *_indices(key)))

    @property
    def _ground(self) -> Ground:
        return ground_of(self.subject)

    def _named(self, name: str) -> MuscleOutline | None:
        return next((each for each in self.work.recipe.muscles if each.name == name), None)

    def _outline(self, name: str) -> MuscleOutline:
        outline = self._named(self.own_name(name))
        if outline is None:
            raise ParameterError("muscles: choose one first")
        return outline

    def _sided(self, name: str) -> MuscleOutline:
        """Return the outline as it lies on the side of a body."""
        outline = self._outline(name)
        return outline.sided(-1 if name.endswith("_r") else 1) if outline.mirror else outline

    def _flipped(self, name: str, point: OutlinePoint) -> OutlinePoint:
        """Return a point of the side of a body as the recipe keeps it: left."""
        right = self._outline(name).mirror and name.endswith("_r")
        return point.mirrored() if right else point

    def _numbers(self, outline: MuscleOutline) -> dict[str, float]:
        """Return the numbers that are in force; a thickness given as a map is left alone."""
        settings: OutlineSettings = outline.settings
        usual = FitParameters.of_profile(self.work.project.profile)
        least, most = settings.thickness or (usual.least, usual.most)
        skin = usual.skin if settings.skin is None else settings.skin
        numbers = {
            "least thickness": least, "most thickness": most,
            "radius": settings.radius or usual.radius, "shortening": settings.max_contraction,
            "stiffness": settings.stiffness, "bulge": settings.bulge,
        }  # fmt: skip
        if outline.ring is None:
            numbers["fixed point"] = settings.fixed_point
        return numbers if isinstance(skin, Mapping) else {"skin": skin, **numbers}

    def _with(self, outline: MuscleOutline) -> Work:
        """Return the work with an outline that can be laid on this head."""
        lay_out(outline.sided(1) if outline.mirror else outline, self._ground.surface)
        return replace(self.work, recipe=with_outline(self.work.recipe, outline))


def _indices(key: str) -> tuple[int, int]:
    row, _, column = key.partition(".")
    if not all(part.isascii() and part.isdigit() and len(part) < 4 for part in (row, column)):
        raise FormatError("page: this handle has gone")
    return int(row), int(column)
