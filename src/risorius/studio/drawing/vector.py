"""Vector muscles, drawn by head and tail."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any, cast

from risorius.errors import ParameterError
from risorius.studio.drawing.craft import Craft, Entry, Handle, Number, Tool, Traits
from risorius.studio.drawing.sketch import Drawn, Sketch
from risorius.studio.places import Place
from risorius.studio.subject import Subject
from risorius.studio.work import Work
from risorius.vectormuscle.editing import added, moved_end, removed, with_numbers
from risorius.vectormuscle.muscle import VectorMuscle
from risorius.vectormuscle.vector_set import VectorSet

__all__ = ["VectorCraft", "VectorSketch"]

_NUMBERS = {
    "strength": (0.1, 1.2), "half_angle": (5.0, 85.0), "start_radius": (5.0, 80.0),
    "finish_radius": (10.0, 140.0), "pull": (0.5, 25.0), "half_width": (3.0, 60.0),
}  # fmt: skip
_GROUNDS = {"origin": ("skull",), "insertion": ("skin",)}


class VectorCraft(Craft):
    """Muscles of the vector set."""

    title = "vectors"
    hint = "Click a muscle to change it, or <b>Head and tail</b> to make a new one."
    tools = (Tool("vector", "Head and tail", "trending_up"),)

    def entries(self) -> list[Entry]:
        """Return the muscles, both sides in one line."""
        names = [muscle.name for muscle in self.work.vectors.muscles]
        result: list[Entry] = []
        for name in names:
            if not name.endswith("_r"):
                stem = name.removesuffix("_l")
                pair = tuple(n for n in (name, f"{stem}_r") if n in names)
                result.append(Entry("vector muscles", stem, pair))
        return result

    def own_name(self, name: str) -> str:
        """Return the name without side, by which it is locked."""
        known = any(muscle.name == name for muscle in self.work.vectors.muscles)
        return name.removesuffix("_l").removesuffix("_r") if known else ""

    def traits(self, name: str) -> Traits:
        """Return what can be changed."""
        muscle = _found(self.work.vectors, name)
        own = {entry.name for entry in fields(cast(Any, muscle))} if muscle is not None else ()
        numbers = [
            Number(key, low, high, float(getattr(muscle, key)))
            for key, (low, high) in _NUMBERS.items()
            if key in own
        ]
        words = "Drag head and tail; 'influence' below paints the zone."
        return Traits(name, tuple(numbers), words=words if muscle is not None else "")

    def handles(self, name: str) -> list[Handle]:
        """Return head and tail."""
        face = self.subject.vector_face
        muscle = _found(face.vectors, name) if face is not None else None
        return [
            Handle(key, getattr(muscle, key), key, on)
            for key, on in _GROUNDS.items()
            if hasattr(muscle, key)
        ]

    def sketch(self, tool: str, name: str, *, mirror: bool) -> Sketch:
        """Begin a muscle."""
        return VectorSketch(name, mirror=mirror)

    def with_number(self, name: str, key: str, value: float) -> Work:
        """Set a number on both sides."""
        return replace(self.work, vectors=with_numbers(self.work.vectors, name, {key: value}))

    def without(self, name: str) -> Work:
        """Delete it on both sides."""
        return replace(self.work, vectors=removed(_fitted(self.subject), name))

    def moved(self, name: str, key: str, place: Place) -> Work:
        """Move head or tail."""
        return replace(
            self.work, vectors=moved_end(_fitted(self.subject), name, key, place.position)
        )


class VectorSketch(Sketch):
    """The head on the bone, then the tail on the skin."""

    @property
    def hint(self) -> str:
        """What to do next."""
        if not self.lines[-1]:
            return "Click the <b>head</b> on the bone."
        return "Click the <b>tail</b> where it ends in the skin."

    @property
    def is_complete(self) -> bool:
        """Whether both ends are there."""
        return len(self.lines[-1]) == 2

    def grounds(self, *, skin: bool) -> list[str]:
        """Return bone for the head, skin for the tail."""
        return ["skin"] if self.lines[-1] else super().grounds(skin=skin)

    def drawn(self, work: Work, subject: Subject) -> Drawn | None:
        """Return the set with the muscle on both sides."""
        if not self.is_complete:
            return None
        head, tail = (place.position for place in self.lines[-1])
        vectors = added(_fitted(subject), self.name, head, tail)
        return Drawn(replace(work, vectors=vectors), vectors.muscles[-2].name)


def _fitted(subject: Subject) -> VectorSet:
    if subject.vector_face is None:
        raise ParameterError("muscles: this face has no vector muscles")
    return subject.vector_face.vectors


def _found(vectors: VectorSet, name: str) -> VectorMuscle | None:
    return next((muscle for muscle in vectors.muscles if muscle.name == name), None)
