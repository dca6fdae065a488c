"""Cloning: everything that two heads need before shapes can be carried from one to the other."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np

from risorius._check import BoolArray, FloatArray
from risorius.cloning.correspondence import Correspondence, correspond
from risorius.cloning.folds import FoldRelief
from risorius.cloning.landmark_pairs import pair_landmarks
from risorius.cloning.lid_contact import EyeClearance, LidContact
from risorius.cloning.lip_contact import LipContact
from risorius.cloning.lip_seal import LipSeal
from risorius.cloning.parameters import CloneParameters
from risorius.cloning.parts import PartCarrier, PartMotion, carriers
from risorius.cloning.subject import Subject
from risorius.errors import MeshError, ShapeError
from risorius.head.head import Head

__all__ = ["Cloning", "Progress"]

Progress = Callable[[int, int, str], None]

# A registration that leaves the skins farther apart than this share of the face's height has
# failed.
_BAD_FIT = 0.04


@dataclass(frozen=True, eq=False)
class Cloning:
    """Two heads bound to each other; `carry` takes any number of shapes across.

    Parameters
    ----------
    source, target : Subject
    parameters : CloneParameters
    skin : Correspondence
    parts : mapping of str to PartCarrier
        By kind, for every part of the target but the skin.
    notes : tuple of str
        What was left out or found odd.
    seconds : mapping of str to float
        How long each stage took.
    """

    source: Subject
    target: Subject
    parameters: CloneParameters
    skin: Correspondence
    parts: dict[str, PartCarrier]
    notes: tuple[str, ...]
    seconds: dict[str, float]

    @staticmethod
    def build(
        source: Head,
        target: Head,
        *,
        moving: BoolArray | None = None,
        parameters: CloneParameters | None = None,
        progress: Progress | None = None,
    ) -> Cloning:
        """Find out how two heads correspond.

        Parameters
        ----------
        source, target : Head
        moving : (n,) bool, optional
            Source file vertices that move in any shape; all if left out. Only the faithful
            profile asks.
        parameters : CloneParameters, optional
        progress : callable, optional
            Called with (done, all, name) before each stage.

        Raises
        ------
        LandmarkError
            If the landmarks of the heads do not fit each other.
        MeshError
            If the skins cannot be laid over each other.
        """
        parameters = parameters or CloneParameters()
        clock = _Clock(progress)
        with clock.stage("lips+lids"):
            pairs = pair_landmarks(Subject.bare(source), Subject.bare(target))
            turn = pairs.similarity.rotation
            ours = Subject.of(source, "source")
            theirs = Subject.of(target, "target", turn=turn)
        with clock.stage("correspondence"):
            moves = np.ones(ours.mesh.vertex_count, bool)
            if moving is not None:
                moves = np.asarray(moving, bool)[source.skin.first_source()]
            skin = correspond(ours, theirs, pairs, moves, parameters)
            _require_fit(skin, theirs)
        parts: dict[str, PartCarrier] = {}
        said: list[str] = []
        with clock.stage("parts"):
            if parameters.parts:
                traced = replace(theirs, lids={s: pair.target for s, pair in skin.lids.items()})
                parts, said = carriers(ours, traced, pairs.similarity, skin.warp)
        notes = (*ours.notes, *theirs.notes, *skin.notes, *said)
        return Cloning(ours, theirs, parameters, skin, parts, notes, clock.seconds)

    def carry(self, deltas: FloatArray, *, progress: Progress | None = None) -> FloatArray:
        """Return displacements (s, n, 3) of the target's vertices [target's file unit].

        Parameters
        ----------
        deltas : (s, v, 3) float64
            Displacements of the source's vertices, in its file's order and unit.
        progress : callable, optional
            Called with (done, all, name of the stage) before each.

        Raises
        ------
        ShapeError
            If the shapes have another number of vertices than the source.
        """
        source, target = self.source.head, self.target.head
        if deltas.ndim != 3 or deltas.shape[1:] != (source.vertex_count, 3):
            raise ShapeError(
                f"deltas: expected shape (s, {source.vertex_count}, 3), got {deltas.shape}"
            )
        clock = _Clock(progress)
        given = source.frame.vectors_to_canonical(deltas)
        ours = given[:, source.skin.first_source()]
        with clock.stage("skin"):
            made = np.zeros((len(ours), self.target.mesh.vertex_count, 3))
            for shape, moved in enumerate(ours):
                made[shape] = self.skin.carry(moved)
            if self.parameters.fold_relief:
                relief = FoldRelief(self.source, self.target, self.skin.mapping)
                for moved, clone in zip(ours, made):
                    clone[:] = relief.relieve(moved, clone)
        with clock.stage("contact"):
            still = ~made.any(axis=2)
            self._restore_lips(ours, made)
            self._restore_lids(ours, made)
            made[still] = 0.0
            made[np.linalg.norm(made, axis=2) <= self.parameters.still] = 0.0
        result = np.zeros((len(ours), target.vertex_count, 3))
        with clock.stage("parts"):
            for shape in range(len(ours)):
                target.skin.spread(made[shape], result[shape])
                self._carry_parts(given[shape], ours[shape], made[shape], result[shape])
        self.seconds.update(clock.seconds)
        return target.frame.vectors_to_input(result)

    def _restore_lips(self, ours: FloatArray, made: FloatArray) -> None:
        if not self.parameters.lip_contact:
            return
        if self.source.lips is None or self.target.lips is None:
            return
        similarity = self.skin.pairs.similarity
        contact = LipContact(self.source, self.target)
        made += contact.correct(ours @ similarity.linear.T, made)
        turn, scale = similarity.rotation, float(similarity.scale)
        seal = LipSeal(self.source, self.target, turn=turn, scale=scale)
        for moved, clone in zip(ours, made):
            step = seal.correct(moved, clone)
            if step is not None:
                clone += step

    def _restore_lids(self, ours: FloatArray, made: FloatArray) -> None:
        if not self.parameters.lid_contact:
            return
        pairs = self.skin.lids
        source = replace(self.source, lids={side: pair.source for side, pair in pairs.items()})
        target = replace(self.target, lids={side: pair.target for side, pair in pairs.items()})
        for side in pairs:
            turn = self.skin.pairs.similarity.rotation
            contact = LidContact(source, target, side, turn=turn)
            clear = None
            if EyeClearance.possible(target, side):
                clear = EyeClearance(target, side)
            allowed = None
            if EyeClearance.possible(source, side):
                allowed = EyeClearance(source, side)
            for moved, clone in zip(ours, made):
                step = contact.correct(moved, clone)
                if step is not None:
                    clone += step
                if clear is not None:
                    self._lift(clear, allowed, moved, clone)

    def _lift(
        self,
        clear: EyeClearance,
        allowed: EyeClearance | None,
        moved: FloatArray,
        clone: FloatArray,
    ) -> None:
        """Lift lids off the eyeball, but not farther than the source's keep off their own."""
        depth = clear.depth(clone)[clear.vertices]
        if not depth.any():
            return
        if allowed is not None:
            theirs = allowed.depth(moved) * self.skin.pairs.similarity.scale
            mapping = self.skin.mapping
            taken = np.einsum("nc,nc->n", mapping.bary, theirs[mapping.faces])
            depth = np.maximum(depth - taken[clear.vertices], 0.0)
        clone[clear.vertices] += depth[:, None] * clear.outwards(clone)

    def _carry_parts(
        self, given: FloatArray, ours: FloatArray, skin: FloatArray, result: FloatArray
    ) -> None:
        rest = self.target.mesh.positions
        for carrier in self.parts.values():
            origin = carrier.origin
            deltas = None if origin is None else given[origin.first_source()]
            motion = PartMotion(deltas, ours, skin, rest)
            moved = carrier.carry(self.skin.pairs.similarity, motion)
            moved[np.linalg.norm(moved, axis=1) <= self.parameters.still] = 0.0
            carrier.part.spread(moved, result)


def _require_fit(skin: Correspondence, target: Subject) -> None:
    residual = skin.residual[np.isfinite(skin.residual)]
    mean = float(residual.mean()) if len(residual) else np.inf
    if not mean < _BAD_FIT * target.head.height:
        raise MeshError(
            f"clone: the source's skin stays {mean:.3g} mm away from the target's (the face is "
            f"{target.head.height:.3g} mm high); check that the landmarks of both heads lie on "
            "the same places, and the unit of the target"
        )
    if skin.mapping.unmapped.all():
        raise MeshError("clone: no vertex of the target lies near the source's skin")


class _Clock:
    """Measures stages and tells them to a progress callback."""

    _STAGES = ("lips+lids", "correspondence", "skin", "contact", "parts")

    def __init__(self, progress: Progress | None) -> None:
        self._progress = progress
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str) -> Generator[None]:
        if self._progress is not None:
            self._progress(self._STAGES.index(name), len(self._STAGES), name)
        start = time.perf_counter()
        yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start
