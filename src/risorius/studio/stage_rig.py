"""The stage as a rig: targets of every mesh that it shows, so that weights alone move it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray
from risorius.rig.rig import MorphTarget, Rig
from risorius.studio.jobs import Job
from risorius.studio.scene import Stage

__all__ = ["LARGEST", "MeshTargets", "StageRig"]

LARGEST = 6_000_000
"""Displacements that a page may be asked to hold, 8 bytes each."""

_MOST = 32767
_STILL = 1e-3  # motion of muscles and bones below this is left out [mm]
_INNER = {"skull", "muscles"}


@dataclass(frozen=True, eq=False)
class MeshTargets:
    """What the targets do to one mesh, vertex by vertex.

    Parameters
    ----------
    starts : (n + 1,) int32
        Where the entries of each vertex begin.
    target : (e,) int16
        Target of each entry.
    steps : (e, 3) int16
        Displacement at weight 1 in steps of the target's `scale`.
    """

    starts: IntArray
    target: npt.NDArray[np.int16]
    steps: npt.NDArray[np.int16]

    def moved(self, weights: FloatArray) -> FloatArray:
        """Return the displacement (n, 3) [mm] for weights (t,) times scales."""
        shares = weights[self.target]
        rows = np.flatnonzero(shares)
        count = len(self.starts) - 1
        vertex = np.searchsorted(self.starts, rows, side="right") - 1
        shifts = shares[rows, None] * self.steps[rows]
        result = np.zeros((count, 3))
        for axis in range(3):
            result[:, axis] = np.bincount(vertex, shifts[:, axis], count)
        return result


@dataclass(frozen=True, eq=False)
class StageRig:
    """All meshes of a stage as neutral and targets of 16 bits.

    Every target has a scale of its own, so that even many of them together stay within 1/128 mm
    of the rig.

    Parameters
    ----------
    stage : Stage
    rig : Rig
        What it was made of; its targets are those of the stage, in order.
    scales : (t,) float64
        Length of one step of each target [mm].
    meshes : mapping of str to MeshTargets
        By name of the mesh; those that never move are absent.
    """

    stage: Stage
    rig: Rig
    scales: FloatArray
    meshes: Mapping[str, MeshTargets]

    @staticmethod
    def build(stage: Stage, rig: Rig, job: Job) -> StageRig:
        """Find what every target of `rig` does to the meshes of `stage`.

        Bones and muscles take the pose that a target was baked from.

        Raises
        ------
        Cancelled
            If a person stopped it.
        """
        job.step("muscles and bones")
        found: dict[str, list[tuple[int, IntArray, FloatArray]]] = {}
        scales = np.ones(len(rig.targets))
        for number, target in enumerate(rig.targets):
            job.tick(number, len(rig.targets), target.name)
            largest = 0.0
            for name, vertices, deltas in _moved(stage, rig, target):
                largest = max(largest, float(np.abs(deltas).max()))
                found.setdefault(name, []).append((number, vertices, deltas))
            scales[number] = max(largest, 1e-9) / _MOST
        counts = {each.name: each.mesh.vertex_count for each in stage.meshes}
        meshes = {name: _sorted(rows, scales, counts[name]) for name, rows in found.items()}
        return StageRig(stage, rig, scales, meshes)

    @property
    def entry_count(self) -> int:
        """Number of displacements of all meshes."""
        return sum(len(each.target) for each in self.meshes.values())

    def posed(self, weights: FloatArray, groups: set[str]) -> dict[str, FloatArray]:
        """Return the vertices (k, 3) of the meshes of some groups, by name [mm].

        Parameters
        ----------
        weights : (t,) float64
        groups : set of str
        """
        scaled = weights * self.scales
        return {
            each.name: each.mesh.positions + self.meshes[each.name].moved(scaled)
            for each in self.stage.meshes
            if each.group in groups and each.name in self.meshes
        }


def _moved(
    stage: Stage, rig: Rig, target: MorphTarget
) -> Iterator[tuple[str, IntArray, FloatArray]]:
    """Yield mesh, moved vertices (k,) and their displacement (k, 3) [mm] at weight 1."""
    dense = rig.frame.vectors_to_canonical(target.dense(rig.mesh.vertex_count))
    head = stage.subject.head
    fields = {kind: dense[part.first_source()] for kind, part in head.parts.items()}
    inner = stage.posed(target.pose, head.positions + dense, _INNER)
    inside = {name: points - stage.rest(name) for name, points in inner.items()}
    for name, deltas in {**fields, **inside}.items():
        least = _STILL if name in inside else 0.0
        vertices = np.flatnonzero(np.abs(deltas).max(axis=1) > least).astype(np.int32)
        if len(vertices):
            yield name, vertices, deltas[vertices]


def _sorted(
    rows: list[tuple[int, IntArray, FloatArray]], scales: FloatArray, count: int
) -> MeshTargets:
    """Return the entries of one mesh in the order of its vertices."""
    vertices = np.concatenate([row[1] for row in rows])
    target = np.concatenate([np.full(len(v), number, np.int16) for number, v, _ in rows])
    deltas = np.concatenate([row[2] for row in rows])
    order = np.argsort(vertices, kind="stable")
    steps = np.rint(deltas[order] / scales[target[order]][:, None])
    starts = np.zeros(count + 1, np.int32)
    np.cumsum(np.bincount(vertices, minlength=count), out=starts[1:])
    return MeshTargets(starts, target[order], np.clip(steps, -_MOST, _MOST).astype(np.int16))
