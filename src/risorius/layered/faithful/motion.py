"""Muscles in motion: each layer is one model, solved after the layers that it lies on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.layered.faithful.anatomy import Anatomy, LaidMuscle
from risorius.layered.faithful.contour import harmonic_fill
from risorius.layered.faithful.parameters import FaithfulParameters
from risorius.solvers.constraints import Bends, Constraints, Distances, Holds, Volume
from risorius.solvers.model import Control, Model, State
from risorius.solvers.pbd import Solver

__all__ = ["Layer", "MovingMuscles"]


@dataclass(frozen=True, eq=False)
class Layer:
    """The muscles of one layer.

    Parameters
    ----------
    muscles : tuple of LaidMuscle
    first, last : int
        Their vertices among all of the anatomy.
    model : Model
    fills : tuple of (h*w, k) float64
        Per muscle how its bottom vertices follow the k that have targets.
    """

    muscles: tuple[LaidMuscle, ...]
    first: int
    last: int
    model: Model
    fills: tuple[FloatArray, ...]

    @staticmethod
    def build(anatomy: Anatomy, muscles: list[LaidMuscle], p: FaithfulParameters) -> Layer:
        """Join the constraints of `muscles`, which stand one after the other."""
        first, last = muscles[0].surface.first, muscles[-1].surface.last
        distances: list[Distances] = []
        bends: list[Bends] = []
        volumes: list[Volume] = []
        held: list[IntArray] = []
        stiffness: list[FloatArray] = []
        fills: list[FloatArray] = []
        for laid in muscles:
            start = np.int32(laid.surface.first - first)
            own = anatomy.positions[laid.surface.first : laid.surface.last]
            d, b, v = laid.mesh.constraints(own)
            distances.append(Distances(d.particles + start, d.rest, d.stiffness))
            bends.append(Bends(b.particles + start, b.rest, b.stiffness))
            volumes.append(Volume(v.faces + start, v.rest, v.stiffness))
            origin, fibres = laid.lines.held
            known = np.concatenate([origin, fibres])
            fills.append(
                harmonic_fill(
                    known, np.eye(len(known)), rows=laid.mesh.rows, columns=laid.mesh.columns
                )
            )
            is_ring = laid.muscle.kind == "sphincter"
            k = p.ring.position if is_ring else p.sheet.position
            held += [origin + start, fibres + start]
            stiffness += [np.full(len(origin), p.sheet.origin), np.full(len(fibres), k)]
        constraints = Constraints(
            distances=Distances.joined(distances),
            bends=Bends(
                np.concatenate([b.particles for b in bends]),
                np.concatenate([b.rest for b in bends]),
                np.concatenate([b.stiffness for b in bends]),
            ),
            volumes=tuple(volumes),
            holds=Holds(np.concatenate(held), np.concatenate(stiffness)),
        )
        model = Model(anatomy.positions[first:last], constraints)
        return Layer(tuple(muscles), first, last, model, tuple(fills))

    def targets(
        self, positions: FloatArray, faces: IntArray, contractions: Mapping[str, float]
    ) -> FloatArray:
        """Return the targets (k, 3) of all holds, where the layers beneath are now [mm]."""
        return np.concatenate(
            [
                laid.lines.targets(positions, faces, contractions.get(laid.name, 0.0))
                for laid in self.muscles
            ]
        )

    def carried(self, positions: FloatArray, motion: FloatArray) -> FloatArray:
        """Return the layer's vertices (n, 3) taken along by what lies beneath them [mm].

        Vertices without a target of their own would stay behind, since the published net hardly
        ties them to the others.

        Parameters
        ----------
        positions : (n, 3) float64
            Of the layer's vertices [mm].
        motion : (k, 3) float64
            Of the targets of relaxed muscles [mm].
        """
        result = positions.copy()
        row = 0
        for laid, fill in zip(self.muscles, self.fills):
            count, start = fill.shape[1], laid.surface.first - self.first
            own = fill @ motion[row : row + count]
            result[start : start + 2 * len(own)] += np.concatenate([own, own])
            row += count
        return result


class MovingMuscles:
    """All muscles of an anatomy, with the solver that moves them.

    Parameters
    ----------
    anatomy : Anatomy
    parameters : FaithfulParameters
    solver : Solver, optional
    """

    def __init__(
        self, anatomy: Anatomy, parameters: FaithfulParameters, *, solver: Solver | None = None
    ) -> None:
        self.anatomy = anatomy
        self.parameters = parameters
        self.layers = tuple(Layer.build(anatomy, m, parameters) for m in anatomy.layers)
        self._solver = solver or Solver()

    def contractions(self, values: Mapping[str, float]) -> dict[str, float]:
        """Return the shortening of every muscle: its control times its limit (finding S1)."""
        share = self.parameters.shortening_limit
        return {
            laid.name: values.get(laid.control, 0.0) * share * laid.muscle.shortening
            for laid in self.anatomy.muscles
            if laid.control
        }

    def settle(
        self, bones: FloatArray, contractions: Mapping[str, float], *, steps: int | None = None
    ) -> FloatArray:
        """Return all vertices (n, 3) where every muscle has come to rest, layer by layer [mm].

        Parameters
        ----------
        bones : (n, 3) float64
            The anatomy with its bones in place; where its muscles are does not matter.
        contractions : mapping of str to float
            Shortening c by muscle.
        steps : int, optional
            Stages of the contraction; the published ramp if left out.
        """
        p = self.parameters
        count = p.ramp_steps if steps is None else steps
        rest = self.anatomy.positions
        quick = replace(p.muscle_solver, iteration_limit=p.ramp_sweeps)
        result = rest.copy()
        for stage in range(1, count + 1):
            share = stage / count
            before = result.copy()
            result[: self.bone_count] = rest[: self.bone_count] + share * (
                bones[: self.bone_count] - rest[: self.bone_count]
            )
            wanted = {name: share * c for name, c in contractions.items()}
            chosen = p.muscle_solver if stage == count else quick
            for layer in self.layers:
                places = self._carried(layer, before, result)
                control = Control(layer.targets(result, self.anatomy.faces, wanted))
                state = State(places, np.zeros_like(places))
                settled = self._solver.settle(layer.model, state, control, parameters=chosen)
                result[layer.first : layer.last] = settled.positions
        return result

    def _carried(self, layer: Layer, before: FloatArray, now: FloatArray) -> FloatArray:
        faces = self.anatomy.faces
        motion = layer.targets(now, faces, {}) - layer.targets(before, faces, {})
        return layer.carried(now[layer.first : layer.last], motion)

    def step(self, state: State, bones: FloatArray, contractions: Mapping[str, float]) -> State:
        """Return the state of all vertices after one published step, layer by layer.

        Parameters
        ----------
        state : State
        bones : (n, 3) float64
            The anatomy with its bones in place [mm].
        contractions : mapping of str to float
        """
        positions, velocities = state.positions.copy(), state.velocities.copy()
        positions[: self.bone_count] = bones[: self.bone_count]
        for layer in self.layers:
            part = slice(layer.first, layer.last)
            targets = layer.targets(positions, self.anatomy.faces, contractions)
            moved = self._solver.step(
                layer.model, State(positions[part], velocities[part]), Control(targets),
                parameters=self.parameters.muscle_solver,
            )  # fmt: skip
            positions[part], velocities[part] = moved.positions, moved.velocities
        return State(positions, velocities)

    @property
    def bone_count(self) -> int:
        """Number of vertices of bones, which come first."""
        return self.layers[0].first if self.layers else len(self.anatomy.positions)
