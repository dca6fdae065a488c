"""Muscles in layers on the skull, drawn as action lines or loops."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from risorius._check import FloatArray
from risorius.errors import FormatError, ParameterError
from risorius.layered.drawing import SkullSpace, drawn_muscle, ring_of_loops, sheet_of_lines
from risorius.layered.editing import (
    free_name,
    in_layer,
    moved_point,
    renamed,
    with_muscle,
    with_point,
    without_muscle,
    without_point,
)
from risorius.layered.muscle import BONES, Muscle, Sheet
from risorius.layered.muscle_map import MuscleMap
from risorius.studio.drawing.craft import Craft, Entry, Handle, Number, Tool, Traits
from risorius.studio.drawing.sketch import Drawn, Sketch
from risorius.studio.places import Place
from risorius.studio.subject import Subject
from risorius.studio.work import Work

__all__ = ["LayeredCraft", "RingSketch", "SheetSketch"]

Get = Callable[[Muscle], float]
Put = Callable[[Muscle, float], Muscle]

_LOOPS = 2


def _action(field: str) -> tuple[Get, Put]:
    def get(muscle: Muscle) -> float:
        return float(getattr(muscle.action, field))

    def put(muscle: Muscle, value: float) -> Muscle:
        assert muscle.action is not None
        return replace(muscle, action=replace(muscle.action, **{field: value}))  # pyright: ignore

    return get, put


def _widen(muscle: Muscle, value: float) -> Muscle:
    assert isinstance(muscle.shape, Sheet)
    factor = value / max(float(muscle.shape.half_width.mean()), 1e-6)
    return replace(muscle, shape=replace(muscle.shape, half_width=muscle.shape.half_width * factor))


_NUMBERS: dict[str, tuple[float, float, Get, Put]] = {
    "thickness": (
        0.5, 10.0, lambda m: m.thickness, lambda m, v: replace(m, thickness=v),
    ),
    "fibres": (
        2, 15, lambda m: m.sections[0],
        lambda m, v: replace(m, sections=(round(v), m.sections[1])),
    ),
    "half width": (
        0.5, 25.0, lambda m: float(getattr(m.shape, "half_width", np.zeros(1)).mean()), _widen,
    ),
    "shortening": (
        0.05, 0.6, lambda m: m.shortening, lambda m, v: replace(m, shortening=v),
    ),
    "stiffness": (0.2, 8.0, *_action("stiffness")),
    "reach": (6.0, 40.0, *_action("reach")),
    "slide": (0.0, 1.0, *_action("tangential")),
}  # fmt: skip
_OF_ACTIONS = ("stiffness", "reach", "slide", "shortening")
_OF_SHEETS = ("half width", "reach", "slide")


class LayeredCraft(Craft):
    """Muscles of the map, by the names of their bodies."""

    title = "layers"
    hint = "Click a muscle to change it, or <b>Draw a sheet</b> to make a new one."
    tools = (Tool("sheet", "Draw a sheet", "draw"), Tool("ring", "Draw a ring", "circle"))

    def entries(self) -> list[Entry]:
        """Return the muscles, layer by layer."""
        return [
            Entry(f"layer {each.layer}", each.name, _bodies(each))
            for each in self.work.muscle_map.muscles
        ]

    def own_name(self, name: str) -> str:
        """Return the name in the map."""
        names = self.work.muscle_map.by_name
        stem = name.removesuffix("_l").removesuffix("_r")
        return name if name in names else stem if stem in names else ""

    def controls(self, name: str) -> tuple[str, ...]:
        """Return the controls of both sides."""
        return self._muscle(name).control_names if self.own_name(name) else ()

    def traits(self, name: str) -> Traits:
        """Return what can be changed."""
        muscle = self._muscle(name)
        sheet = isinstance(muscle.shape, Sheet)
        numbers = [
            Number(key, low, high, get(muscle), 1.0 if key == "fibres" else 0.0)
            for key, (low, high, get, _) in _NUMBERS.items()
            if (muscle.action is not None or key not in _OF_ACTIONS)
            and (sheet or key not in _OF_SHEETS)
        ]
        words = "Drag a point to move it. Shift + click deletes it, Alt + click inserts one."
        return Traits(
            muscle.name, tuple(numbers), mirror=muscle.mirror, layer=muscle.layer,
            can_rename=True, words=words if sheet else "",
        )  # fmt: skip

    def handles(self, name: str) -> list[Handle]:
        """Return the points of a sheet's line."""
        muscle = self._muscle(name) if self.own_name(name) else None
        if muscle is None or not isinstance(muscle.shape, Sheet):
            return []
        places = self.subject.space.to_head(muscle.shape.line)
        on = ("skull", "muscles")
        return [Handle(str(k), place, f"point {k + 1}", on) for k, place in enumerate(places)]

    def sketch(self, tool: str, name: str, *, mirror: bool) -> Sketch:
        """Begin a sheet or a ring."""
        if self.subject.bench is None:
            raise ParameterError(
                "drawing: this profile shows no muscles while they are drawn; choose improved"
            )
        free_name(self.work.muscle_map, name)
        kinds = {"sheet": SheetSketch, "ring": RingSketch}
        if tool not in kinds:
            return super().sketch(tool, name, mirror=mirror)
        return kinds[tool](name, mirror=mirror)

    def with_number(self, name: str, key: str, value: float) -> Work:
        """Set thickness, width or a number of its action."""
        if key not in _NUMBERS:
            return super().with_number(name, key, value)
        return self._with(_NUMBERS[key][3](self._muscle(name), value))

    def renamed(self, name: str, new: str) -> tuple[Work, str]:
        """Rename it in the map."""
        changed = renamed(self.work.muscle_map, self._muscle(name).name, new)
        return replace(self.work, muscle_map=changed), changed.by_name[new].control_names[0]

    def mirrored(self, name: str, *, mirror: bool) -> tuple[Work, str]:
        """Put it on both sides or on the left alone."""
        muscle = replace(self._muscle(name), mirror=mirror)
        return self._with(muscle), muscle.control_names[0]

    def in_layer(self, name: str, layer: int) -> Work:
        """Move it deeper or nearer to the skin."""
        changed = in_layer(self.work.muscle_map, self._muscle(name).name, layer)
        return replace(self.work, muscle_map=changed)

    def without(self, name: str) -> Work:
        """Delete it; what lay on it lies on what it lay on."""
        changed = without_muscle(self.work.muscle_map, self._muscle(name).name)
        return replace(self.work, muscle_map=changed)

    def moved(self, name: str, key: str, place: Place) -> Work:
        """Move a point of its line."""
        there = self.subject.space.from_head(place.position[None])[0]
        return self._with(moved_point(self._muscle(name), _index(key), there))

    def with_point(self, name: str, key: str) -> Work:
        """Insert a point half way to the next one."""
        muscle, index = self._muscle(name), _index(key)
        if not isinstance(muscle.shape, Sheet) or index >= len(muscle.shape.line):
            return super().with_point(name, key)
        line = muscle.shape.line
        other = index + 1 if index + 1 < len(line) else index - 1
        middle = 0.5 * (line[index] + line[other])
        return self._with(with_point(muscle, max(index, other), middle))

    def without_point(self, name: str, key: str) -> Work:
        """Delete a point of its line."""
        return self._with(without_point(self._muscle(name), _index(key)))

    def _muscle(self, name: str) -> Muscle:
        own = self.own_name(name)
        if not own:
            raise ParameterError("muscles: choose one first")
        return self.work.muscle_map.by_name[own]

    def _with(self, muscle: Muscle) -> Work:
        return replace(self.work, muscle_map=with_muscle(self.work.muscle_map, muscle))


class _MapSketch(Sketch):
    """What sheets and rings have in common: they lie on bones and muscles of the map."""

    @abstractmethod
    def _made(self, work: Work, subject: Subject) -> Muscle | None:
        """Return the muscle drawn so far; None if it is none yet."""

    def drawn(self, work: Work, subject: Subject) -> Drawn | None:
        """Return the map with the muscle."""
        muscle = self._made(work, subject)
        if muscle is None:
            return None
        changed = replace(work, muscle_map=with_muscle(work.muscle_map, muscle))
        return Drawn(changed, muscle.control_names[0])

    def _on(self, muscle_map: MuscleMap) -> list[str]:
        """Return the bones and muscles of the map that it was drawn on."""
        found: dict[str, None] = {}
        for place in (place for line in self.lines for place in line):
            stem = place.mesh.removesuffix("_l").removesuffix("_r")
            known = [n for n in (place.mesh, stem) if n in BONES or n in muscle_map.by_name]
            found.update(dict.fromkeys(known[:1]))
        return list(found)


class SheetSketch(_MapSketch):
    """Action lines, side by side."""

    @property
    def hint(self) -> str:
        """What to do next."""
        count, done = len(self.lines[-1]), len(self.lines) - 1
        if not count and not done:
            return "Click the <b>origin</b> on the bone. Turn the view by dragging."
        if count == 1:
            return "Click along the muscle, last where it ends. <b>Backspace</b> takes back."
        if count:
            return "Click on, or <b>Enter</b> to finish the line."
        return "<b>Enter</b> keeps the muscle; or draw another line beside it to make it wider."

    def _made(self, work: Work, subject: Subject) -> Muscle | None:
        lines = [line for line in self.lines if len(line) >= self.least]
        if not lines:
            return None
        shape = sheet_of_lines([_in_skull(line, subject.space) for line in lines])
        on = self._on(work.muscle_map)
        return drawn_muscle(work.muscle_map, self.name, shape, on=on, mirror=self.mirror)


class RingSketch(_MapSketch):
    """Two loops around an opening."""

    least = 3

    @property
    def hint(self) -> str:
        """What to do next."""
        which = "inner" if len(self.lines) == 1 else "outer"
        more = "then <b>Enter</b>" if len(self.lines[-1]) >= 3 else "three points or more"
        return f"Click around the opening: the <b>{which} loop</b>, {more}."

    def close(self) -> bool:
        """Finish a loop; the second one finishes the muscle."""
        if not self.lines[-1]:
            raise ParameterError("drawing: a loop needs 3 points; click on")
        super().close()
        return len(self.lines) > _LOOPS

    def _made(self, work: Work, subject: Subject) -> Muscle | None:
        loops = [line for line in self.lines if len(line) >= self.least]
        if len(loops) < _LOOPS:
            return None
        shape = ring_of_loops(*(_in_skull(loop, subject.space) for loop in loops[:_LOOPS]))
        on = self._on(work.muscle_map)
        return drawn_muscle(work.muscle_map, self.name, shape, on=on, mirror=self.mirror)

    def _is_loop(self, line: list[Place]) -> bool:
        return len(line) >= self.least


def _in_skull(line: list[Place], space: SkullSpace) -> FloatArray:
    return space.from_head(np.array([place.position for place in line]))


def _bodies(muscle: Muscle) -> tuple[str, ...]:
    return (f"{muscle.name}_l", f"{muscle.name}_r") if muscle.mirror else (muscle.name,)


def _index(key: str) -> int:
    if not (key.isascii() and key.isdigit()) or len(key) > 4:
        raise FormatError("page: this handle has gone")
    return int(key)
