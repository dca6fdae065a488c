"""Outline grids that are being drawn on the skin, row by row.

References
----------
Kaehler, Haber and Seidel 2001, section 5.1 (the muscle editor).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from risorius.errors import ParameterError
from risorius.springmuscle.drawing import drawn_outline
from risorius.springmuscle.editing import with_outline
from risorius.springmuscle.fit import Ground
from risorius.springmuscle.recipe import MuscleOutline
from risorius.studio.drawing.sketch import Drawn, Sketch
from risorius.studio.subject import Subject
from risorius.studio.work import Work

__all__ = ["SpringSketch", "bodies_of", "ground_of"]


class SpringSketch(Sketch):
    """Rows of a grid, the fixed end first; of a ring around it, each from inside to outside."""

    def __init__(self, name: str, *, mirror: bool = True, ring: bool = False) -> None:
        super().__init__(name, mirror=mirror)
        self._ring = ring
        self._made: tuple[object, Drawn | None] = (None, None)

    @property
    def hint(self) -> str:
        """What to do next."""
        count, done = len(self.lines[-1]), len(self.lines) - 1
        if count >= self.least:
            return "Click on across the muscle, or <b>Enter</b> ends the row."
        if count:
            return "Click the other side of this row. <b>Backspace</b> takes back."
        if self._ring:
            if not done:
                return "Click the <b>first row</b> of the ring: from inside to outside."
            if done < 3:
                return "Now the <b>next row</b>, a little farther around, from inside to outside."
            return "Contract it; go on around the opening, or <b>Enter</b> closes the ring."
        if not done:
            return "Click the <b>first row</b> across the muscle, where it is fixed."
        if done < 2:
            return "Now the <b>next row</b>, farther along the muscle, from the same side."
        return "Contract it; draw another row, or <b>Enter</b> keeps the muscle."

    def grounds(self, *, skin: bool) -> list[str]:
        """Return the skin, which outlines lie on always."""
        return ["skin"]

    def close(self) -> bool:
        """Finish a row; an empty one finishes the muscle."""
        rows, least = len(self.lines) - 1, 3 if self._ring else 2
        if not self.lines[-1] and 0 < rows < least:
            raise ParameterError(f"drawing: a muscle needs {least} rows; click the next one")
        return super().close()

    def drawn(self, work: Work, subject: Subject) -> Drawn | None:
        """Return the recipe with the muscle of the rows that are finished.

        As long as these stay the same so does the work, and its face need not be built anew.
        """
        key = (work, self.mirror, tuple(tuple(line) for line in self.lines[:-1]))
        if self._made[0] != key:
            self._made = (key, self._draw(work, subject))
        return self._made[1]

    def _draw(self, work: Work, subject: Subject) -> Drawn | None:
        rows = [np.array([place.position for place in line]) for line in self.lines[:-1]]
        if len(rows) < (3 if self._ring else 2):
            return None
        measure = ground_of(subject).surface.measure
        outline = drawn_outline(
            work.recipe, self.name, rows, measure, ring=self._ring, mirror=self.mirror
        )
        bodies = bodies_of(outline)
        right = float(np.concatenate(rows)[:, 0].mean()) < 0.0
        changed = replace(work, recipe=with_outline(work.recipe, outline))
        return Drawn(changed, bodies[-1 if right else 0])


def ground_of(subject: Subject) -> Ground:
    """Return what muscles of a subject are fitted to.

    Raises
    ------
    ParameterError
        If its face has no spring muscles.
    """
    face = subject.spring_face
    if face is None or face.ground is None:
        raise ParameterError("muscles: this face has no spring muscles yet; a moment")
    return face.ground


def bodies_of(outline: MuscleOutline) -> tuple[str, ...]:
    """Return what the bodies of a muscle are called, left before right."""
    return (f"{outline.name}_l", f"{outline.name}_r") if outline.mirror else (outline.name,)
