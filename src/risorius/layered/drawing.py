"""From lines drawn on a skull to muscles: sheets from action lines, sphincters from two loops.

References
----------
Fratarcangeli 2008, section 4.2 and appendix (the muscle designer).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.anatomy.skull import Skull
from risorius.anatomy.skull_fit import FittedSkull
from risorius.anatomy.template import builtin_head
from risorius.errors import ParameterError
from risorius.layered.editing import free_name
from risorius.layered.muscle import EyeAction, MouthAction, Muscle, Ring, Sheet, SheetAction
from risorius.layered.muscle_map import MuscleMap
from risorius.mesh.core import TriMesh
from risorius.spatial.closest import closest_points

__all__ = ["SkullSpace", "drawn_muscle", "ring_of_loops", "sheet_of_lines"]

# Half width of a muscle drawn as a single line, and the least of any [mm].
_HALF_WIDTH, _LEAST_WIDTH = 4.0, 0.5
_ROUNDS, _CLOSE = 30, 1e-6
# A muscle that ends this near to the mouth corner works on the modiolus [mm].
_MODIOLUS = 14.0
# Skin beside a new muscle follows up to this distance beyond its edge, at least so far [mm].
_BEYOND, _LEAST_REACH = 9.0, 12.0
# A new sphincter this near to one of the map does what that does [mm].
_NEAR_RING = 25.0
# What is drawn nearer to the midline than this belongs to both sides [mm].
_MIDLINE = 3.0


@dataclass(frozen=True, eq=False)
class SkullSpace:
    """The way between a head and the space of the skull that muscle maps are drawn in.

    Parameters
    ----------
    skull : Skull
        As drawn on.
    fitted : FittedSkull
        The same inside the head.
    """

    skull: Skull
    fitted: FittedSkull

    def to_head(self, points: npt.ArrayLike) -> FloatArray:
        """Return points (q, 3) of skull space in the head's canonical frame [mm]."""
        places = builtin_head().frame.to_canonical(np.asarray(points, np.float64))
        if self.skull.carry is not None:
            places = self.skull.carry(places)
        return self.fitted.carry(places)

    def from_head(self, points: npt.ArrayLike) -> FloatArray:
        """Return points (q, 3) of the head in skull space [mm].

        On the bones it is exact: the place on the triangle counts. Elsewhere the warp is undone
        by fixed-point steps ``x += (p - warp(x)) / scale``, which converge because the warp is
        near a similarity.
        """
        wanted = np.asarray(points, np.float64).reshape(-1, 3)
        found = wanted / self.fitted.scale
        for _ in range(_ROUNDS):
            miss = wanted - self.fitted.carry(found)
            found = found + miss / self.fitted.scale
            if np.abs(miss).max(initial=0.0) < _CLOSE:
                break
        for fitted, drawn in (
            (self.fitted.cranium, self.skull.cranium),
            (self.fitted.mandible, self.skull.mandible),
        ):
            self._snap(wanted, found, fitted, drawn)
        return self._to_map(found)

    def _snap(self, wanted: FloatArray, found: FloatArray, fitted: TriMesh, drawn: TriMesh) -> None:
        near = closest_points(fitted, wanted)
        rows = np.flatnonzero(near.distance < 1e-3)
        if len(rows):
            found[rows] = near.surface_points().take(rows).positions(drawn)

    def _to_map(self, places: FloatArray) -> FloatArray:
        carry = self.skull.carry
        if carry is not None:
            wanted, found = places, places.copy()
            for _ in range(_ROUNDS):
                found = found + (wanted - carry(found))
            places = found
        return builtin_head().frame.to_input(places)


def sheet_of_lines(lines: Sequence[FloatArray]) -> Sheet:
    """Return the sheet that action lines span, one to many of them.

    All lines are turned to run as the first one and divided alike; at every station the sheet
    reaches from the outermost line on one side to that on the other. A single line gets a width.

    Parameters
    ----------
    lines : sequence of (k, 3) float64
        From origin to insertion, at least two points each [mm, skull space].

    Raises
    ------
    ParameterError
        If there is no line, or one is a single point.
    """
    if not len(lines):
        raise ParameterError("sheet: draw at least one action line")
    drawn = [_line(line) for line in lines]
    count = max(*(len(line) for line in drawn), 3 if len(drawn) > 1 else 2)
    if len(drawn) == 1:
        return Sheet(drawn[0], np.full(len(drawn[0]), _HALF_WIDTH))
    first = drawn[0]
    turned = [
        line[::-1]
        if np.linalg.norm(line[-1] - first[0]) + np.linalg.norm(line[0] - first[-1])
        < np.linalg.norm(line[0] - first[0]) + np.linalg.norm(line[-1] - first[-1])
        else line
        for line in drawn
    ]
    stations = np.stack([_divided(line, count) for line in turned])
    middle = stations.mean(axis=0)
    offset = stations - middle
    across = np.linalg.svd(offset.transpose(1, 0, 2))[2][:, 0]
    along = np.einsum("skd,kd->sk", offset, across)
    low, high = along.min(axis=0), along.max(axis=0)
    line = middle + (0.5 * (low + high))[:, None] * across
    return Sheet(line, np.maximum(0.5 * (high - low), _LEAST_WIDTH))


def ring_of_loops(first: FloatArray, second: FloatArray) -> Ring:
    """Return the sphincter between two loops, drawn in any order.

    Parameters
    ----------
    first, second : (k, 3) float64
        At least three points around an opening [mm, skull space].

    Raises
    ------
    ParameterError
        If a loop has fewer points, or one does not lie inside the other.
    """
    loops = [np.asarray(loop, np.float64).reshape(-1, 3) for loop in (first, second)]
    if min(len(loop) for loop in loops) < 3:
        raise ParameterError("sphincter: each loop needs three points or more")
    boxes = [(loop.min(axis=0), loop.max(axis=0)) for loop in loops]
    half = [0.5 * (high - low)[:2] for low, high in boxes]
    inner, outer = sorted(range(2), key=lambda k: float(half[k].prod()))
    if (half[inner] <= 0.0).any() or (half[outer] <= half[inner]).any():
        raise ParameterError(
            "sphincter: one loop must lie inside the other, seen from the front; draw them again"
        )
    low, high = boxes[inner]
    centre = 0.5 * (low + high)
    centre[2] = np.concatenate(loops)[:, 2].mean()
    return Ring(centre, half[inner], half[outer])


def drawn_muscle(
    muscle_map: MuscleMap,
    name: str,
    shape: Sheet | Ring,
    *,
    on: Sequence[str] = (),
    mirror: bool = True,
) -> Muscle:
    """Return a new muscle of a shape, with what such a muscle usually does.

    What was drawn on the right is stored on the left; a shape on the midline has no mirror image.
    A sheet that ends at the mouth corner holds it as the zygomaticus does; a sphincter near one
    of the map closes the same opening, any other one is passive.

    Parameters
    ----------
    muscle_map : MuscleMap
        Where it will belong.
    name : str
        A number is added where it is taken.
    shape : Sheet or Ring
        Skull space [mm].
    on : sequence of str
        What it was drawn on: bones and muscles.
    mirror : bool
        Copy it to the other side.

    Raises
    ------
    ParameterError
        If `name` is no name or `on` names something unknown.
    """
    unknown = [each for each in on if each not in (*muscle_map.by_name, "cranium", "mandible")]
    if unknown:
        raise ParameterError(f"muscle {name}: the map has no {unknown[0]!r} to lie on")
    below = [muscle_map.by_name[each] for each in on if each in muscle_map.by_name]
    layer = 1 + max((muscle.layer for muscle in below), default=2)
    ground = dict.fromkeys(on)
    for muscle in below:
        ground.update(dict.fromkeys(muscle.on))
    middle = shape.line[:, 0] if isinstance(shape, Sheet) else shape.centre[:1]
    if np.abs(middle).max() < _MIDLINE:
        mirror = False
    muscle = Muscle(
        name=free_name(muscle_map, name), layer=layer, shape=shape, action=None,
        on=tuple(ground) or ("cranium", "mandible"), thickness=3.0, sections=(5, 8), mirror=mirror,
    )  # fmt: skip
    if mirror and float(middle.mean()) < 0.0:
        muscle = muscle.mirrored()
    return _with_action(muscle, muscle_map)


def _with_action(muscle: Muscle, muscle_map: MuscleMap) -> Muscle:
    shape = muscle.shape
    if isinstance(shape, Sheet):
        return replace(muscle, action=_sheet_action(shape), shortening=0.33)
    near = [
        (float(np.linalg.norm(each.shape.centre - shape.centre)), each)
        for each in muscle_map.muscles
        if isinstance(each.shape, Ring) and isinstance(each.action, MouthAction | EyeAction)
    ]
    distance, twin = min(near, key=lambda pair: pair[0], default=(np.inf, None))
    if twin is None or distance > _NEAR_RING:
        return replace(muscle, active=False)
    action = (
        MouthAction(("upper", "lower"), narrow=0.3, forward=0.4, squeeze=0.1, stiffness=2.0)
        if isinstance(twin.action, MouthAction)
        else EyeAction(axes=(1.0, 0.8), pull=(0.35, 1.0))
    )
    mirror = isinstance(action, EyeAction)
    return replace(muscle, action=action, shortening=0.3, mirror=mirror)


def _sheet_action(sheet: Sheet) -> SheetAction:
    reach = max(float(sheet.half_width.mean()) + _BEYOND, _LEAST_REACH)
    head = builtin_head()
    corner = head.frame.to_input(head.landmarks.position("8.3")[None])[0]
    if float(np.linalg.norm(sheet.line[-1] - corner)) > _MODIOLUS:
        return SheetAction(stiffness=2.0, reach=reach, tangential=0.5)
    return SheetAction(
        stiffness=4.0, reach=max(reach, 18.0), arch=0.8, corner=0.97, bulge=3.0, seal=True
    )


def _line(points: FloatArray) -> FloatArray:
    line = np.asarray(points, np.float64).reshape(-1, 3)
    if len(line):
        steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
        line = line[np.concatenate([[True], steps > 1e-6])]
    if len(line) < 2:
        raise ParameterError("sheet: an action line needs two points, origin and insertion")
    return line


def _divided(line: FloatArray, count: int) -> FloatArray:
    steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
    length = np.concatenate([[0.0], np.cumsum(steps)])
    wanted = np.linspace(0.0, length[-1], count)
    return np.stack([np.interp(wanted, length, line[:, axis]) for axis in range(3)], axis=1)
