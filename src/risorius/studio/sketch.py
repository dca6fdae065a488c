"""A muscle that is being drawn: places so far, what they make, what to show and to say."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.outwards import outwards
from risorius.errors import ParameterError
from risorius.layered.drawing import SkullSpace, drawn_muscle, ring_of_loops, sheet_of_lines
from risorius.layered.muscle import BONES, Muscle
from risorius.layered.muscle_map import MuscleMap
from risorius.studio.places import Place

__all__ = ["Sketch", "SketchKind"]

SketchKind = Literal["sheet", "sphincter", "vector"]

_LINE, _DONE = "#ffd166", "#7fd1c7"
_ABOVE = 1.0
_LOOPS = 2


@dataclass(eq=False)
class Sketch:
    """Lines of places on bone, muscles and skin.

    Parameters
    ----------
    kind : {"sheet", "sphincter", "vector"}
    name : str
        What the muscle shall be called.
    mirror : bool
        Copy it to the other side.
    lines : list of list of Place
        The last one is open.
    """

    kind: SketchKind
    name: str
    mirror: bool = True
    lines: list[list[Place]] = field(default_factory=lambda: [[]])

    @property
    def hint(self) -> str:
        """What to do next."""
        count, done = len(self.lines[-1]), len(self.lines) - 1
        if self.kind == "vector":
            return (
                "Click the <b>head</b> on the bone."
                if not count
                else ("Click the <b>tail</b> where it ends in the skin.")
            )
        if self.kind == "sphincter":
            which = "inner" if not done else "outer"
            more = "then <b>Enter</b>" if count >= 3 else "three points or more"
            return f"Click around the opening: the <b>{which} loop</b>, {more}."
        if not count and not done:
            return "Click the <b>origin</b> on the bone. Turn the view by dragging."
        if count == 1:
            return "Click along the muscle, last where it ends. <b>Backspace</b> takes back."
        if count:
            return "Click on, or <b>Enter</b> to finish the line."
        return "<b>Enter</b> keeps the muscle; or draw another line beside it to make it wider."

    def put(self, place: Place) -> None:
        """Add a place to the open line."""
        self.lines[-1].append(place)

    def back(self) -> bool:
        """Take the last place back; tell whether there was one."""
        if not self.lines[-1] and len(self.lines) > 1:
            self.lines.pop()
        if not self.lines[-1]:
            return False
        self.lines[-1].pop()
        return True

    def close(self) -> bool:
        """Finish the open line; tell whether the muscle is complete.

        Raises
        ------
        ParameterError
            If the line is too short.
        """
        least = 3 if self.kind == "sphincter" else 2
        count = len(self.lines[-1])
        if not count and len(self.lines) > 1 and self.kind == "sheet":
            return True
        if count < least:
            raise ParameterError(f"drawing: a line needs {least} points; click on the bone")
        self.lines.append([])
        return self.kind == "sphincter" and len(self.lines) > _LOOPS

    def muscle(self, space: SkullSpace, muscle_map: MuscleMap) -> Muscle | None:
        """Return what has been drawn so far as a muscle of `muscle_map`; None if too little.

        Raises
        ------
        ParameterError
            If it cannot be one.
        """
        if self.kind == "sheet":
            lines = [line for line in self.lines if len(line) >= 2]
            if not lines:
                return None
            shape = sheet_of_lines([self._in_skull(line, space) for line in lines])
        else:
            loops = [line for line in self.lines if len(line) >= 3]
            if self.kind == "vector" or len(loops) < _LOOPS:
                return None
            shape = ring_of_loops(*(self._in_skull(loop, space) for loop in loops[:_LOOPS]))
        ground = dict.fromkeys(self._support(place, muscle_map) for p in self.lines for place in p)
        on = [name for name in ground if name]
        return drawn_muscle(muscle_map, self.name, shape, on=on, mirror=self.mirror)

    def _in_skull(self, line: list[Place], space: SkullSpace) -> FloatArray:
        return space.from_head(np.array([place.position for place in line]))

    def _support(self, place: Place, muscle_map: MuscleMap) -> str:
        """Return the bone or muscle of the map that a place lies on; empty for the skin."""
        stem = place.mesh.removesuffix("_l").removesuffix("_r")
        for name in (place.mesh, stem):
            if name in BONES or name in muscle_map.by_name:
                return name
        return ""

    def overlay(self) -> dict[str, list[dict[str, Any]]]:
        """Return the handles and lines that show it."""
        handles: list[dict[str, Any]] = []
        lines: list[dict[str, Any]] = []
        for number, line in enumerate(self.lines):
            if not line:
                continue
            points = np.array([place.position for place in line])
            lifted = points + _ABOVE * outwards(points)
            last = number == len(self.lines) - 1
            colour = _LINE if last else _DONE
            for at, normal in zip(lifted, outwards(points)):
                handles.append(
                    {
                        "id": "", "at": at.tolist(), "normal": normal.tolist(), "colour": colour,
                        "label": "", "on": None,
                    }
                )  # fmt: skip
            shown = np.concatenate([lifted, lifted[:1]]) if self._is_loop(line) else lifted
            lines.append({"points": shown.tolist(), "colour": colour})
        return {"handles": handles, "lines": lines}

    def _is_loop(self, line: list[Place]) -> bool:
        return self.kind == "sphincter" and len(line) >= 3
