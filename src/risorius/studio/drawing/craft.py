"""What the pages know of the muscles of a face, whatever its method; see `CRAFTS` for the three.

A craft is bound to a work and the face made of it. It lists muscles, says what can be changed of
one, and returns the work in which that is changed; it knows nothing of pages.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from risorius._check import FloatArray
from risorius.anatomy.outwards import outwards
from risorius.errors import ParameterError
from risorius.studio.drawing.sketch import Sketch
from risorius.studio.places import Place
from risorius.studio.subject import Subject
from risorius.studio.work import Work

__all__ = ["Choice", "Craft", "Entry", "Handle", "Number", "Tool", "Traits"]

_HANDLE = "#ffd166"
# How solid the groups of the scene are while muscles are drawn.
_INSIDE = {"skin": 0.25, "parts": 0.0, "skull": 1.0, "muscles": 1.0}


@dataclass(frozen=True)
class Tool:
    """A way to draw a muscle: its key, and the text and the icon of its button."""

    key: str
    text: str
    icon: str


@dataclass(frozen=True)
class Entry:
    """A line of the list: the muscle's name, the group it stands in, its bodies in the scene."""

    group: str
    name: str
    bodies: tuple[str, ...]


@dataclass(frozen=True)
class Number:
    """A number that can be set between two others, by `step` if that is not 0."""

    key: str
    low: float
    high: float
    value: float
    step: float = 0.0


@dataclass(frozen=True)
class Choice:
    """A word that can be exchanged for another one of `options`."""

    key: str
    options: tuple[str, ...]
    value: str


@dataclass(frozen=True)
class Traits:
    """What can be changed of a muscle.

    Parameters
    ----------
    name : str
        Without side.
    numbers : tuple of Number
    choices : tuple of Choice
    mirror : bool or None
        Whether it exists on both sides; None where that cannot be changed.
    layer : int or None
    can_rename : bool
    words : str
        What its handles do.
    """

    name: str
    numbers: tuple[Number, ...] = ()
    choices: tuple[Choice, ...] = ()
    mirror: bool | None = None
    layer: int | None = None
    can_rename: bool = False
    words: str = ""


@dataclass(frozen=True, eq=False)
class Handle:
    """A point that can be dragged.

    Parameters
    ----------
    key : str
    place : (3,) float64
        Canonical frame [mm].
    label : str
    on : tuple of str
        Groups that it stays on.
    """

    key: str
    place: FloatArray
    label: str
    on: tuple[str, ...]

    def to_page(self) -> dict[str, Any]:
        """Return what the viewport is told."""
        out = outwards(self.place[None])[0]
        return {
            "id": self.key, "at": (self.place + out).tolist(), "normal": out.tolist(),
            "colour": _HANDLE, "label": self.label, "on": list(self.on),
        }  # fmt: skip


class Craft:
    """Base of the three crafts; what a method cannot do is refused.

    Names are those of bodies and controls: with a side where the muscle has one.

    Parameters
    ----------
    work : Work
    subject : Subject or None
        None while the face is still being built.
    """

    title: ClassVar[str] = ""
    hint: ClassVar[str] = ""
    tools: ClassVar[tuple[Tool, ...]] = ()
    looks: ClassVar[Mapping[str, float]] = _INSIDE
    on_bone: ClassVar[bool] = True

    def __init__(self, work: Work, subject: Subject | None) -> None:
        self.work = work
        self._subject = subject

    @property
    def subject(self) -> Subject:
        """The face at hand.

        Raises
        ------
        ParameterError
            If it is still being built.
        """
        if self._subject is None:
            raise ParameterError("face: still being built; a moment")
        return self._subject

    @property
    def is_ready(self) -> bool:
        """Whether the face is built."""
        return self._subject is not None

    def entries(self) -> list[Entry]:
        """Return the muscles from deep to superficial."""
        return []

    def own_name(self, name: str) -> str:
        """Return what the recipe calls a muscle; empty if it has none of that name."""
        return ""

    def controls(self, name: str) -> tuple[str, ...]:
        """Return the controls that contract a muscle on its sides."""
        stem = name[:-2] if name.endswith(("_l", "_r")) else name
        return (name, f"{stem}_l", f"{stem}_r")

    def traits(self, name: str) -> Traits:
        """Return what can be changed of a muscle."""
        return Traits(name)

    def handles(self, name: str) -> list[Handle]:
        """Return the points of a muscle that can be dragged."""
        return []

    def sketch(self, tool: str, name: str, *, mirror: bool) -> Sketch:
        """Begin to draw a muscle with one of `tools`."""
        raise ParameterError(f"drawing: {self.title} have no tool {tool[:40]!r}")

    def with_number(self, name: str, key: str, value: float) -> Work:
        """Return the work with another number of a muscle."""
        raise ParameterError(f"muscle {name}: has no {key!r} to set")

    def with_choice(self, name: str, key: str, value: str) -> Work:
        """Return the work with another word of a muscle."""
        raise ParameterError(f"muscle {name}: has no {key!r} to choose")

    def renamed(self, name: str, new: str) -> tuple[Work, str]:
        """Return the work with a muscle renamed, and what its body is called then."""
        raise ParameterError(f"muscle {name}: cannot be renamed")

    def mirrored(self, name: str, *, mirror: bool) -> tuple[Work, str]:
        """Return the work with a muscle on both sides or on one, and what its body is called."""
        raise ParameterError(f"muscle {name}: is on both sides always")

    def in_layer(self, name: str, layer: int) -> Work:
        """Return the work with a muscle in another layer."""
        raise ParameterError(f"muscle {name}: has no layer")

    def without(self, name: str) -> Work:
        """Return the work without a muscle."""
        raise ParameterError(f"muscles: there is no {name!r} to delete")

    def moved(self, name: str, key: str, place: Place) -> Work:
        """Return the work with a handle of a muscle at another place."""
        raise ParameterError(f"muscle {name}: has no point {key!r}")

    def with_point(self, name: str, key: str) -> Work:
        """Return the work with a new point of a muscle beside a handle."""
        raise ParameterError(f"muscle {name}: takes no further point")

    def without_point(self, name: str, key: str) -> Work:
        """Return the work without the point of a handle."""
        raise ParameterError(f"muscle {name}: needs this point")
