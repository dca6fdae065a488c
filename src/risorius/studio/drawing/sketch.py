"""A muscle that is being drawn: places so far, what they make, what to show and to say."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from risorius.anatomy.outwards import outwards
from risorius.errors import ParameterError
from risorius.studio.places import Place
from risorius.studio.subject import Subject
from risorius.studio.work import Work

__all__ = ["Drawn", "Sketch"]

_LINE, _DONE = "#ffd166", "#7fd1c7"
_ABOVE = 1.0


@dataclass(frozen=True, eq=False)
class Drawn:
    """What a sketch makes: the work with the new muscle, and what its body is called."""

    work: Work
    name: str


class Sketch(ABC):
    """Lines of places; the last one is open. Each method has sketches of its own.

    Parameters
    ----------
    name : str
        What the muscle shall be called.
    mirror : bool
        Copy it to the other side.
    """

    least: ClassVar[int] = 2
    """Fewest places of a line."""

    def __init__(self, name: str, *, mirror: bool = True) -> None:
        self.name = name
        self.mirror = mirror
        self.lines: list[list[Place]] = [[]]

    @property
    @abstractmethod
    def hint(self) -> str:
        """What to do next."""

    @property
    def is_complete(self) -> bool:
        """Whether the muscle is finished without being told so."""
        return False

    def grounds(self, *, skin: bool) -> list[str]:
        """Return the groups that the next place may lie on.

        Parameters
        ----------
        skin : bool
            Whether a person wants to draw on the skin as well as on the bones.
        """
        return ["skull", "muscles", "skin"] if skin else ["skull", "muscles"]

    @abstractmethod
    def drawn(self, work: Work, subject: Subject) -> Drawn | None:
        """Return what has been drawn so far; None if that is no muscle yet.

        Raises
        ------
        ParameterError
            If it cannot become one.
        """

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
        """Finish the open line; tell whether the muscle is to be kept.

        Raises
        ------
        ParameterError
            If the line is too short.
        """
        count = len(self.lines[-1])
        if not count and len(self.lines) > 1:
            return True
        if count < self.least:
            raise ParameterError(f"drawing: a line needs {self.least} points; click on")
        self.lines.append([])
        return False

    def overlay(self) -> dict[str, list[dict[str, Any]]]:
        """Return the handles and lines that show it."""
        handles: list[dict[str, Any]] = []
        lines: list[dict[str, Any]] = []
        for number, line in enumerate(self.lines):
            if not line:
                continue
            points = np.array([place.position for place in line])
            out = outwards(points)
            lifted = points + _ABOVE * out
            colour = _LINE if number == len(self.lines) - 1 else _DONE
            for at, normal in zip(lifted, out):
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
        return False
