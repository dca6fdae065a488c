"""Changes of a muscle map as a person makes them: every function returns a new map or muscle."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from risorius._check import FloatArray, as_number, require_muscle_name
from risorius.errors import ParameterError
from risorius.layered.muscle import BONES, Muscle, Sheet
from risorius.layered.muscle_map import MuscleMap

__all__ = [
    "free_name",
    "in_layer",
    "moved_point",
    "renamed",
    "with_muscle",
    "with_point",
    "without_muscle",
    "without_point",
]

_FEWEST_POINTS = 2
_HIGHEST_LAYER = 20


def with_muscle(muscle_map: MuscleMap, muscle: Muscle) -> MuscleMap:
    """Return the map with a muscle added, or put in the place of the one of its name.

    Raises
    ------
    ParameterError
        If it does not lie on deeper layers.
    """
    if muscle.name not in muscle_map.by_name:
        return MuscleMap((*muscle_map.muscles, muscle), muscle_map.landmarks)
    kept = tuple(muscle if each.name == muscle.name else each for each in muscle_map.muscles)
    return MuscleMap(kept, muscle_map.landmarks)


def without_muscle(muscle_map: MuscleMap, name: str) -> MuscleMap:
    """Return the map without a muscle; what lay on it lies on what it lay on.

    Raises
    ------
    ParameterError
        If there is no such muscle.
    """
    gone = _muscle(muscle_map, name)
    kept = tuple(
        replace(each, on=_exchanged(each.on, name, gone.on)) if name in each.on else each
        for each in muscle_map.muscles
        if each.name != name
    )
    return MuscleMap(kept, muscle_map.landmarks)


def renamed(muscle_map: MuscleMap, name: str, new: str) -> MuscleMap:
    """Return the map with a muscle renamed, everywhere it is named.

    Raises
    ------
    ParameterError
        If there is no such muscle, the new name is taken, or it is no name.
    """
    muscle = _muscle(muscle_map, name)
    if new == name:
        return muscle_map
    require_muscle_name(new)
    if new in muscle_map.by_name or new in BONES:
        raise ParameterError(f"muscle {name}: the name {new!r} is taken; choose another")
    kept = tuple(
        replace(muscle, name=new)
        if each is muscle
        else replace(each, on=_exchanged(each.on, name, (new,)))
        for each in muscle_map.muscles
    )
    return MuscleMap(kept, muscle_map.landmarks)


def in_layer(muscle_map: MuscleMap, name: str, layer: int) -> MuscleMap:
    """Return the map with a muscle in another layer, 1 on the bone.

    Raises
    ------
    ParameterError
        If there is no such muscle, or it would not lie on deeper layers.
    """
    muscle = _muscle(muscle_map, name)
    as_number(f"muscle {name}: layer", layer, low=1, high=_HIGHEST_LAYER)
    return with_muscle(muscle_map, replace(muscle, layer=layer))


def free_name(muscle_map: MuscleMap, stem: str) -> str:
    """Return `stem`, with the first number behind it that makes it a new name.

    Raises
    ------
    ParameterError
        If it is no name.
    """
    require_muscle_name(stem)
    name, count = stem, 1
    while name in muscle_map.by_name or name in BONES:
        count += 1
        name = f"{stem}_{count}"
    return name


def moved_point(muscle: Muscle, index: int, place: FloatArray) -> Muscle:
    """Return a sheet with point `index` of its line at `place` (3,) [mm, skull space].

    Raises
    ------
    ParameterError
        If the muscle is no sheet or has no such point.
    """
    sheet = _sheet(muscle)
    _require_index(muscle, index, len(sheet.line))
    line = sheet.line.copy()
    line[index] = _placed(muscle, place)
    return replace(muscle, shape=replace(sheet, line=line))


def with_point(muscle: Muscle, index: int, place: FloatArray) -> Muscle:
    """Return a sheet with a new point at `place` (3,) [mm, skull space] before point `index`.

    Its half width lies between those of its neighbours.

    Raises
    ------
    ParameterError
        If the muscle is no sheet or has no such place.
    """
    sheet = _sheet(muscle)
    count = len(sheet.line)
    if not 0 <= index <= count:
        raise ParameterError(f"muscle {muscle.name}: no place {index} among {count} points")
    width = sheet.half_width[[max(index - 1, 0), min(index, count - 1)]].mean()
    line = np.insert(sheet.line, index, _placed(muscle, place), axis=0)
    return replace(
        muscle,
        shape=replace(sheet, line=line, half_width=np.insert(sheet.half_width, index, width)),
    )


def without_point(muscle: Muscle, index: int) -> Muscle:
    """Return a sheet without point `index` of its line.

    Raises
    ------
    ParameterError
        If the muscle is no sheet, has no such point, or only two.
    """
    sheet = _sheet(muscle)
    _require_index(muscle, index, len(sheet.line))
    if len(sheet.line) <= _FEWEST_POINTS:
        raise ParameterError(
            f"muscle {muscle.name}: a line needs {_FEWEST_POINTS} points; delete the muscle instead"
        )
    return replace(
        muscle,
        shape=replace(
            sheet,
            line=np.delete(sheet.line, index, axis=0),
            half_width=np.delete(sheet.half_width, index),
        ),
    )


def _muscle(muscle_map: MuscleMap, name: str) -> Muscle:
    found = muscle_map.by_name.get(name)
    if found is None:
        raise ParameterError(
            f"muscle map: there is no {name!r}; it has {', '.join(muscle_map.by_name)}"
        )
    return found


def _sheet(muscle: Muscle) -> Sheet:
    if not isinstance(muscle.shape, Sheet):
        raise ParameterError(f"muscle {muscle.name}: a sphincter has no line of points")
    return muscle.shape


def _require_index(muscle: Muscle, index: int, count: int) -> None:
    if not 0 <= index < count:
        raise ParameterError(f"muscle {muscle.name}: no point {index} among {count}")


def _placed(muscle: Muscle, place: FloatArray) -> FloatArray:
    point = np.asarray(place, np.float64)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise ParameterError(f"muscle {muscle.name}: a point needs three finite numbers")
    return point


def _exchanged(names: tuple[str, ...], old: str, new: tuple[str, ...]) -> tuple[str, ...]:
    result: dict[str, None] = {}
    for name in names:
        result.update(dict.fromkeys(new if name == old else (name,)))
    return tuple(result)
