"""The genes of layered muscles: changes of a muscle map, in terms of its own skull."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from threading import Lock
from types import MappingProxyType
from typing import Any

import numpy as np

from risorius._check import FloatArray, one_of
from risorius.controls.control import Pose
from risorius.errors import ParameterError
from risorius.layered.muscle import EyeAction, MouthAction, Muscle, Sheet, SheetAction
from risorius.layered.muscle_map import MuscleMap, muscle_entry
from risorius.layered.workbench import Workbench
from risorius.rig.face import Face
from risorius.tuning.change import Change, Gene, Genes, parameters_of
from risorius.tuning.genome import Genome, Parameter

__all__ = ["MapCandidates", "apply_map_genes", "map_muscles", "map_parameters"]

# Wider ranges show folded skin: muscles of the map already pull as far as lips slide over teeth.
_SHIFT = Change("shift", -0.04, 0.04)
_AMOUNT = Change("factor", 0.5, 1.5)
_HOLD = Change("factor", 0.5, 2.0)
_SIZE = Change("factor", 0.75, 1.25)
_SHARE = Change("share", 0.0, 1.0)
_SHORTENING = Change("factor", 0.6, 1.3, most=0.95)
# Outwards at full contraction [mm].
_OUT = Change("add", -2.0, 2.0)
# Faces that are kept to draw new maps on.
_KEPT = 12
_ENDS = tuple(f"{end}_{axis}" for end in ("origin", "insertion") for axis in "xyz")
_SHEET: Mapping[str, Change] = MappingProxyType(
    {
        "reach": _SIZE, "stiffness": _HOLD, "fixed_point": Change("share", 0.0, 0.4),
        "tangential": _SHARE, "arch": _SHARE, "corner": _SHARE, "push": _OUT, "bulge": _OUT,
    }
)  # fmt: skip
_MOUTH: Mapping[str, Change] = MappingProxyType(
    dict.fromkeys(("narrow", "forward", "squeeze", "turn"), _AMOUNT) | {"stiffness": _HOLD}
)
_FURTHER = frozenset(("tangential", "arch", "corner", "push", "bulge"))


def map_muscles(muscle_map: MuscleMap, pose: Pose) -> tuple[str, ...]:
    """Return the muscles (without side) that a pose contracts."""
    return tuple(
        muscle.name
        for muscle in muscle_map.muscles
        if muscle.action is not None and any(pose.get(name) for name in muscle.control_names)
    )


def map_parameters(
    muscle_map: MuscleMap, names: Iterable[str], *, genes: Genes = "published"
) -> tuple[Parameter, ...]:
    """Return the genes of some muscles of a map; both sides share them.

    Ends shift by shares of the skull's width, and the line between them follows; what lies on the
    midline stays there. Lengths, contraction and hold are multiplied, shares added to.

    Parameters
    ----------
    muscle_map : MuscleMap
    names : iterable of str
        Without side.
    genes : {"published", "all"}
        Ends, width, thickness, contraction, fixed point, reach and hold, or also what is ours:
        how skin slides, follows the dental arch, spares the lips and bulges.

    Raises
    ------
    ParameterError
        If the map has no such muscle.
    """
    one_of("genes", genes, ("published", "all"))
    beneath = _beneath(muscle_map)
    listed = (gene for name in names for gene in _genes(_muscle(muscle_map, name), beneath))
    return parameters_of(listed, _FURTHER, which=genes)


def apply_map_genes(muscle_map: MuscleMap, values: Mapping[str, float]) -> MuscleMap:
    """Return the map with its muscles changed by genes; strange names do not matter.

    Muscles without a gene in `values` stay the same objects.

    Parameters
    ----------
    muscle_map : MuscleMap
    values : mapping of str to float
        By the names of `map_parameters`.
    """
    width = _width(muscle_map)
    beneath = _beneath(muscle_map)
    return MuscleMap(
        tuple(_changed(muscle, values, width, beneath) for muscle in muscle_map.muscles),
        muscle_map.landmarks,
    )


@dataclass(frozen=True, eq=False)
class MapCandidates:
    """Muscles of a layered face in one expression; make one with `of_bench`.

    Parameters
    ----------
    muscle_map : MuscleMap
        Before tuning.
    make : callable
        From a map to the face on it.
    names : tuple of str
        Muscles to tune, without side.
    pose : mapping of str to float
        Expression that is looked at.
    genes : {"published", "all"}
        See `map_parameters`.
    """

    muscle_map: MuscleMap
    make: Callable[[MuscleMap], Face]
    names: Sequence[str]
    pose: Pose
    genes: Genes = "published"

    @staticmethod
    def of_bench(
        bench: Workbench, names: Sequence[str], pose: Pose, *, genes: Genes = "published"
    ) -> MapCandidates:
        """Return candidates that lay and bind only muscles which no face before had like that."""
        return MapCandidates(bench.face.muscle_map, _Benches(bench).face, names, pose, genes)

    @property
    def genome(self) -> Genome:
        """What may be tuned."""
        return self._genome

    @cached_property
    def _genome(self) -> Genome:
        return Genome(map_parameters(self.muscle_map, self.names, genes=self.genes))

    def face_of(self, values: Mapping[str, float]) -> Face:
        """Return the face on the tuned map."""
        return self.make(apply_map_genes(self.muscle_map, values))

    def positions(self, values: Mapping[str, float]) -> FloatArray:
        """Return the vertices (n, 3) of the candidate with these values [mm]."""
        return self.face_of(values).pose(self.pose)


class _Benches:
    """Faces of the last maps; a new map is drawn on the one with which it shares most muscles.

    The face is the same to the last bit whichever that is (`Workbench.redrawn`).
    """

    def __init__(self, first: Workbench) -> None:
        self._first = first
        self._recent: list[Workbench] = []
        self._lock = Lock()

    def face(self, drawn: MuscleMap) -> Face:
        """Return the face on a map; may be called by several threads at once."""
        with self._lock:
            known = [self._first, *self._recent]
        base = max(known, key=lambda bench: _shared(bench.face.muscle_map, drawn))
        made = base.redrawn(drawn)
        with self._lock:
            others = [each for each in self._recent if each is not base]
            used = [] if base is self._first else [base]
            self._recent = [*used, made, *others][:_KEPT]
        return made.face


def _shared(one: MuscleMap, other: MuscleMap) -> int:
    """Return how many muscles two maps of the same muscles have in common."""
    return sum(
        a is b or muscle_entry(a) == muscle_entry(b) for a, b in zip(one.muscles, other.muscles)
    )


def _genes(muscle: Muscle, beneath: Collection[str]) -> Iterator[Gene]:
    """Return all genes of a muscle; its thickness counts where another sheet lies on it."""

    def gene(name: str, change: Change, value: float = 0.0) -> Gene:
        return Gene(muscle.name, name, change, value)

    action = muscle.action
    if action is None:
        return
    if not isinstance(action, MouthAction):
        yield gene("shortening", _SHORTENING, muscle.shortening)
    if isinstance(action, SheetAction):
        for end in _ENDS:
            if muscle.mirror or not end.endswith("_x"):
                yield gene(end, _SHIFT)
        yield gene("half_width", _SIZE, 1.0)
        if muscle.name in beneath:
            yield gene("thickness", _AMOUNT, muscle.thickness)
        for name, change in _SHEET.items():
            yield gene(name, change, getattr(action, name))
    elif isinstance(action, MouthAction):
        for name, change in _MOUTH.items():
            yield gene(name, change, getattr(action, name))
        yield gene("window", _SIZE, 1.0)
    else:
        yield gene("pull_x", _AMOUNT, action.pull[0])
        yield gene("pull_y", _AMOUNT, action.pull[1])
        yield gene("stiffness", _HOLD, action.stiffness)
        yield gene("window", _SIZE, 1.0)


def _changed(
    muscle: Muscle, values: Mapping[str, float], width: float, beneath: Collection[str]
) -> Muscle:
    new: dict[str, float] = {}
    for gene in _genes(muscle, beneath):
        change = values.get(f"{muscle.name}.{gene.name}", gene.change.neutral)
        if change != gene.change.neutral:
            new[gene.name] = gene.change.applied(gene.value, change, size=width)
    if not new:
        return muscle
    shape = muscle.shape
    if isinstance(shape, Sheet):
        shape = replace(
            shape,
            line=_bent(shape.line, new),
            half_width=shape.half_width * new.get("half_width", 1.0),
        )
    return replace(
        muscle,
        shape=shape,
        action=_acting(muscle.action, new),
        thickness=new.get("thickness", muscle.thickness),
        shortening=new.get("shortening", muscle.shortening),
    )


def _acting(
    action: SheetAction | MouthAction | EyeAction | None, new: Mapping[str, float]
) -> SheetAction | MouthAction | EyeAction:
    assert action is not None
    rules = _SHEET if isinstance(action, SheetAction) else _MOUTH
    changed: dict[str, Any] = {
        name: value for name, value in new.items() if name in rules and hasattr(action, name)
    }
    if not isinstance(action, SheetAction) and "window" in new:
        # What lies nearest to the eye stays: the lids have a window of their own.
        first = action.window[0]
        changed["window"] = tuple(first + (end - first) * new["window"] for end in action.window)
    if isinstance(action, EyeAction):
        changed["pull"] = (new.get("pull_x", action.pull[0]), new.get("pull_y", action.pull[1]))
    return replace(action, **changed)


def _bent(line: FloatArray, shifts: Mapping[str, float]) -> FloatArray:
    """Return the line (k, 3) with its ends shifted [mm] and all between them taken along."""
    steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
    along = (np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum())[:, None]
    origin, insertion = (
        np.array([shifts.get(f"{end}_{axis}", 0.0) for axis in "xyz"])
        for end in ("origin", "insertion")
    )
    return line + (1.0 - along) * origin + along * insertion


def _beneath(muscle_map: MuscleMap) -> frozenset[str]:
    sheets = [muscle for muscle in muscle_map.muscles if isinstance(muscle.shape, Sheet)]
    return frozenset(name for muscle in sheets for name in muscle.on)


def _width(muscle_map: MuscleMap) -> float:
    """Return the width of the skull that a map was drawn on [mm]."""
    marks = muscle_map.landmarks
    for left, right in (("zygion_l", "zygion_r"), ("porion_l", "porion_r")):
        if left in marks and right in marks:
            return float(np.linalg.norm(marks[left] - marks[right]))
    raise ParameterError(
        "muscle map: its skull has no width; add the landmarks zygion_l and zygion_r"
    )


def _muscle(muscle_map: MuscleMap, name: str) -> Muscle:
    found = muscle_map.by_name.get(name)
    if found is None:
        raise ParameterError(
            f"muscle map: there is no {name!r}; it has {', '.join(muscle_map.by_name)}"
        )
    return found
