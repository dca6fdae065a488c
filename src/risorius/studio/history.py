"""The steps of a document: undo and redo, also of steps that an earlier studio took."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from risorius.errors import ParameterError
from risorius.studio.work import Work

__all__ = ["LONGEST", "History", "Record", "Step"]

LONGEST = 500
"""Steps that are kept; older ones are forgotten."""


@dataclass(frozen=True, eq=False)
class Record:
    """A state as it stands in files.

    Parameters
    ----------
    document : mapping
        JSON of the project, without the recipes that stand in it.
    parts : mapping of str to str
        Digests of those recipes, by name; the journal holds each once.
    digest : str
        Of the project file as it was written in this state.
    """

    document: Mapping[str, Any]
    parts: Mapping[str, str]
    digest: str


@dataclass(frozen=True, eq=False)
class Step:
    """One entry of the history: what was done, and what it led to.

    Parameters
    ----------
    label : str
    gesture : str
        Steps of one gesture, such as one slider, that follow one another are one.
    work : Work or None
        None for a step of an earlier studio that nobody has gone back to yet.
    record : Record or None
        None until it has been written.
    """

    label: str
    gesture: str = ""
    work: Work | None = None
    record: Record | None = None


class History:
    """Steps in order, and which of them is the present one.

    Parameters
    ----------
    steps : list of Step
        At least one.
    place : int
        The present one.
    """

    def __init__(self, steps: list[Step], place: int = 0) -> None:
        self.steps = steps
        self.place = place

    @property
    def present(self) -> Step:
        """The present step."""
        return self.steps[self.place]

    @property
    def undo_label(self) -> str:
        """What would be undone; empty at the start."""
        return self.present.label if self.place else ""

    @property
    def redo_label(self) -> str:
        """What would be done again; empty at the end."""
        return self.steps[self.place + 1].label if self.place + 1 < len(self.steps) else ""

    def add(self, step: Step) -> int:
        """Add a step behind the present one; what was undone is forgotten.

        Returns
        -------
        int
            How many of the steps before are still there, in front of it.
        """
        kept = self.place + 1
        if step.gesture and self.present.gesture == step.gesture:
            kept -= 1
        self.put(kept, step)
        return kept

    def put(self, kept: int, step: Step) -> None:
        """Make `step` the one behind the first `kept`, and the present and last one."""
        del self.steps[kept:]
        self.steps.append(step)
        if len(self.steps) > LONGEST:
            del self.steps[0]
        self.place = len(self.steps) - 1

    def beside(self, way: int) -> int:
        """Return the place of the step before (-1) or behind (1) the present one.

        Raises
        ------
        ParameterError
            If there is none.
        """
        if way < 0 and not self.place:
            raise ParameterError("undo: this is where you started")
        if way > 0 and not self.redo_label:
            raise ParameterError("redo: nothing was undone")
        return self.place + way
