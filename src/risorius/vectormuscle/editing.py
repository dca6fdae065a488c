"""Changes of a vector set as a person makes them; every function returns a new set."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any, cast

import numpy as np

from risorius._check import FloatArray, require_muscle_name
from risorius.errors import ParameterError
from risorius.vectormuscle.kinds.linear import LinearMuscle
from risorius.vectormuscle.muscle import VectorMuscle, mirrored_name
from risorius.vectormuscle.vector_set import VectorSet, parse_vector_set

__all__ = ["added", "moved_end", "removed", "with_numbers"]

_ENDS = ("origin", "insertion")


def moved_end(vectors: VectorSet, name: str, end: str, place: FloatArray) -> VectorSet:
    """Return the set with head or tail of a muscle at `place` (3,), mirrored to its partner [mm].

    Parameters
    ----------
    vectors : VectorSet
        Fitted to the head that `place` belongs to.
    name : str
    end : {"origin", "insertion"}
    place : (3,) float64

    Raises
    ------
    ParameterError
        If there is no such muscle or end.
    """
    muscle = _muscle(vectors, name)
    known = [entry.name for entry in fields(cast(Any, muscle))]
    if end not in _ENDS or end not in known:
        raise ParameterError(f"muscle {name}: has no {end!r} to move")
    point = np.asarray(place, np.float64)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise ParameterError(f"muscle {name}: {end} needs three finite numbers")
    return _with(vectors, replace(cast(Any, muscle), **{end: point}))


def with_numbers(vectors: VectorSet, name: str, numbers: Mapping[str, float]) -> VectorSet:
    """Return the set with other numbers of a muscle and of its partner.

    Raises
    ------
    ParameterError
        If there is no such muscle, it has no such number, or one is out of range.
    """
    muscle = _muscle(vectors, name)
    known = [entry.name for entry in fields(cast(Any, muscle))]
    for key in numbers:
        if key not in known:
            raise ParameterError(f"muscle {name}: has no {key!r}")
    return _with(vectors, replace(cast(Any, muscle), **numbers))


def added(vectors: VectorSet, stem: str, head: FloatArray, tail: FloatArray) -> VectorSet:
    """Return the set with a new linear muscle from `head` (3,) to `tail` (3,) on both sides [mm].

    Raises
    ------
    ParameterError
        If `stem` is no name or is taken.
    """
    require_muscle_name(stem)
    names = {muscle.name for muscle in vectors.muscles}
    if names & {stem, f"{stem}_l", f"{stem}_r"}:
        raise ParameterError(f"muscle {stem}: the name is taken; choose another")
    length = float(np.linalg.norm(tail - head))
    side = "_l" if head[0] + tail[0] >= 0.0 else "_r"
    muscle = LinearMuscle(
        f"{stem}{side}", np.asarray(head), np.asarray(tail), 0.75 * length, 1.3 * length, 35.0
    )
    pair = sorted((muscle, muscle.mirrored()), key=lambda each: each.name)
    return _normal(VectorSet((*vectors.muscles, *pair), vectors.landmarks))


def removed(vectors: VectorSet, name: str) -> VectorSet:
    """Return the set without a muscle and its partner.

    Raises
    ------
    ParameterError
        If there is no such muscle.
    """
    gone = {_muscle(vectors, name).name, mirrored_name(name)}
    kept = tuple(muscle for muscle in vectors.muscles if muscle.name not in gone)
    return VectorSet(kept, vectors.landmarks)


def _muscle(vectors: VectorSet, name: str) -> VectorMuscle:
    for muscle in vectors.muscles:
        if muscle.name == name:
            return muscle
    raise ParameterError(f"vector set: there is no muscle {name!r}")


def _with(vectors: VectorSet, muscle: VectorMuscle) -> VectorSet:
    changed = [muscle]
    if any(each.name == mirrored_name(muscle.name) != muscle.name for each in vectors.muscles):
        changed.append(muscle.mirrored())
    return _normal(vectors.replaced(changed))


def _normal(vectors: VectorSet) -> VectorSet:
    """Return the set as its file gives it back, so that what is seen is what is kept."""
    return parse_vector_set(vectors.to_json(), source="vector set")
