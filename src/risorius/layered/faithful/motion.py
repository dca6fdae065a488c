"""Muscles in motion: each layer is one model, solved after the layers that it lies on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.layered.faithful.anatomy import Anatomy, LaidMuscle
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
    """

    muscles: tuple[LaidMuscle, ...]
    first: int
    last: int
    model: Model

    @staticmethod
    def build(anatomy: Anatomy, muscles: list[LaidMuscle], p: FaithfulParameters) -> Layer:
        """Join the constraints of `muscles`, which stand one after the other."""
        first, last = muscles[0].surface.first, muscles[-1].surface.last
        distances: list[Distances] = []
        bends: list[Bends] = []
        volumes: list[Volume] = []
        held: list[IntArray] = []
        stiffness: list[FloatArray] = []
        for laid in muscles:
            start = np.int32(laid.surface.first - first)
            own = anatomy.positions[laid.surface.first : laid.surface.last]
            d, b, v = laid.mesh.constraints(own)
            distances.append(Distances(d.particles + start, d.rest, d.stiffness))
            bends.append(Bends(b.particles + start, b.rest, b.stiffness))
            volumes.append(Volume(v.faces + start, v.rest, v.stiffness))
            origin, fibres = laid.lines.held
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
        return Layer(tuple(muscles), first, last, Model(anatomy.positions[first:last], constraints))

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
            chosen = p.muscle_solver if stage == count else quick
            result[: self.bone_count] = rest[: self.bone_count] + share * (
                bones[: self.bone_count] - rest[: self.bone_count]
            )
            wanted = {name: share * c for name, c in contractions.items()}
            for layer in self.layers:
                targets = layer.targets(result, self.anatomy.faces, wanted)
                places = result[layer.first : layer.last]
                state = State(places, np.zeros_like(places))
                settled = self._solver.settle(
                    layer.model, state, Control(targets), parameters=chosen
                )
                result[layer.first : layer.last] = settled.positions
        return result

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
