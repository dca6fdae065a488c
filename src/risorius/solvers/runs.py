"""Runs: positions on their way through the kernels, one pose or many."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import Protocol

import numpy as np

from risorius._check import BoolArray, FloatArray
from risorius.errors import ShapeError
from risorius.solvers.constraints import Contacts
from risorius.solvers.kernels import lanes, packed, scalar
from risorius.solvers.kernels.simd import LANES
from risorius.solvers.kernels.tables import ContactTables, Multipliers, Table, aligned_zeros
from risorius.solvers.layout import Layout
from risorius.solvers.model import Control, Model
from risorius.solvers.parameters import Parameters

__all__ = ["LaneRun", "Run", "SingleRun"]


class Run(Protocol):
    """Positions in the kernels' arrays, and what is asked of them."""

    def place(self, positions: FloatArray) -> None:
        """Put all particles but the pinned ones at positions [mm]; pushes are forgotten."""
        ...

    def sweep(self, count: int) -> None:
        """Project all constraints `count` times."""
        ...

    def mark(self) -> None:
        """Remember where the particles are."""
        ...

    def moved(self) -> FloatArray:
        """Return how far any particle has moved since `mark` [mm], (s,): of each pose."""
        ...

    def carry_on(self, fresh: BoolArray) -> None:
        """Begin the next step here, with what the constraints push now as their first guess.

        The pushes of the step that began at the mark have moved the particles from there to here;
        they would move them as far again. At rest both vanish, so rest is kept exactly. Poses
        where fresh (s,) is true begin without pushes.
        """
        ...

    def positions(self) -> FloatArray:
        """Return the positions (n, 3) or (s, n, 3) [mm]."""
        ...

    def is_finite(self) -> bool:
        """Tell whether every coordinate is a number."""
        ...

    @property
    def byte_count(self) -> int:
        """Memory of the tables, the positions and what goes with them [bytes]."""
        ...


def _controlled(
    name: str, given: FloatArray | None, rest: FloatArray, pose_count: int | None
) -> FloatArray:
    """Return a control array of the full shape: given, or at rest."""
    value = rest if given is None else np.asarray(given, np.float64)
    shape = rest.shape if pose_count is None else (pose_count, *rest.shape)
    if value.shape not in (rest.shape, shape):
        raise ShapeError(f"control.{name}: expected shape {shape}, got {value.shape}")
    if not np.isfinite(value).all():
        raise ShapeError(f"control.{name}: every entry must be finite")
    return np.broadcast_to(value, shape)


def _rest_volumes(model: Model) -> FloatArray:
    return np.array([volume.rest for volume in model.constraints.volumes], float)


def _contacts(control: Control) -> Contacts:
    return control.contacts or Contacts(np.zeros(0, np.int32), np.zeros((0, 3)), np.zeros((0, 3)))


class SingleRun:
    """One pose: by the scalar kernel (sequence form) or the packed one (packed form)."""

    def __init__(
        self, model: Model, control: Control, parameters: Parameters, layout: Layout
    ) -> None:
        self._model, self._layout = model, layout
        frame, order = layout.frame, model.order
        self._dtype = layout.tables.distance_rest.dtype
        self._kernel = scalar.iterate if layout.form == "sequence" else packed.iterate
        self._alternating = parameters.sweeps == "alternating"
        self._compliant = parameters.stiffness_rule == "compliance"
        rest = model.rest_positions
        targets = _controlled(
            "targets", control.targets, rest[model.constraints.holds.particles], None
        )
        self._targets = self._held(frame.inside(targets[order.holds]))
        self._pinned = frame.inside(_controlled("pinned", control.pinned, rest[model.pinned], None))
        volumes = _controlled("rest_volumes", control.rest_volumes, _rest_volumes(model), None)
        self._rest = (volumes / frame.scale**3).astype(self._dtype)
        touched = _contacts(control)
        if touched.points.ndim != 2:
            raise ShapeError("control.contacts: one pose needs points of shape (k, 3)")
        self._contacts = ContactTables(
            frame.rank[touched.particles].astype(np.uint32),
            self._flat(frame.inside(touched.points)),
            self._flat(touched.normals),
            np.array([touched.stiffness], self._dtype),
        )
        row_count = model.particle_count + layout.cap_count + len(layout.spare)
        self._p = aligned_zeros(4 * row_count, self._dtype)
        self._g = aligned_zeros(4 * row_count, self._dtype)
        rows = self._p.reshape(-1, 4)
        rows[: model.particle_count, 3] = model.weights[order.particles]
        rows[row_count - len(layout.spare) :] = layout.spare
        # Gradients are scratch: each run has its own.
        scratch = aligned_zeros(layout.rings.gradients.size, self._dtype)
        self._rings = layout.rings._replace(gradients=scratch)
        self._mark = np.zeros(0, self._dtype)
        self._done = 0
        self._pushed = self._multipliers()

    def _flat(self, values: FloatArray) -> Table:
        return values.astype(self._dtype).ravel()

    def _held(self, targets: FloatArray) -> Table:
        """Return targets (k, 3) as rows of four, with the inverse mass of the held particle."""
        model = self._model
        particles = model.constraints.holds.particles[model.order.holds]
        return self._flat(np.column_stack([targets, model.weights[particles]]))

    def _multipliers(self) -> Multipliers:
        t, size = self._layout.tables, int(self._compliant)
        counts = (
            3 * t.hold_stiffness.size,
            t.distance_rest.size,
            t.area_rest.size,
            t.bend_sine.size,
            self._rest.size,
        )
        return Multipliers(*(aligned_zeros(size * count, self._dtype) for count in counts))

    @property
    def _rows(self) -> Table:
        return self._p.reshape(-1, 4)[: self._model.particle_count, :3]

    def place(self, positions: FloatArray) -> None:
        """Put all particles but the pinned ones at positions (n, 3) [mm]; forget pushes."""
        frame, model = self._layout.frame, self._model
        self._rows[:] = frame.inside(positions)[model.order.particles]
        self._rows[frame.rank[model.pinned]] = self._pinned
        self._forget()

    def sweep(self, count: int) -> None:
        """Project all constraints `count` times."""
        layout = self._layout
        self._kernel(
            self._p,
            self._g,
            layout.tables,
            layout.volumes,
            self._rings,
            self._contacts,
            self._targets,
            self._rest,
            self._pushed,
            count,
            self._done,
            self._alternating,
            self._compliant,
        )
        self._done += count

    def mark(self) -> None:
        """Remember where the particles are."""
        self._mark = self._rows.copy()

    def moved(self) -> FloatArray:
        """Return how far any particle has moved since `mark` [mm], as (1,)."""
        squares = ((self._rows - self._mark).astype(float) ** 2).sum(axis=1)
        return np.sqrt(squares.max(initial=0.0, keepdims=True)) * self._layout.frame.scale

    def carry_on(self, fresh: BoolArray) -> None:
        """Begin the next step here, the pushes kept unless fresh (1,): see `Run.carry_on`."""
        here = self._rows.copy()
        if fresh[0]:
            self._forget()
        else:
            self._rows[:] += here - self._mark
        self._mark = here

    def _forget(self) -> None:
        for table in self._pushed:
            table[:] = 0

    def positions(self) -> FloatArray:
        """Return the positions (n, 3) [mm]."""
        frame = self._layout.frame
        return frame.outside(self._rows[frame.rank].astype(np.float64))

    def is_finite(self) -> bool:
        """Tell whether every coordinate is a number."""
        return bool(np.isfinite(self._rows).all())

    @property
    def byte_count(self) -> int:
        """Memory of the tables, the positions and their gradients [bytes]."""
        own = (self._p, self._g, self._targets, *self._rings, *self._pushed)
        return sum(
            np.asarray(t).nbytes for t in (*own, *self._layout.tables, *self._layout.volumes)
        )


class LaneRun:
    """Many poses of one model, `LANES` at a time."""

    def __init__(
        self,
        model: Model,
        control: Control,
        parameters: Parameters,
        layout: Layout,
        *,
        pose_count: int,
        threads: int,
    ) -> None:
        self._model, self._layout = model, layout
        self._pose_count, self._threads = pose_count, threads
        self._block_count = -(-pose_count // LANES)
        self._alternating = parameters.sweeps == "alternating"
        self._compliant = parameters.stiffness_rule == "compliance"
        frame, order = layout.frame, model.order
        rest = model.rest_positions
        held = rest[model.constraints.holds.particles]
        targets = _controlled("targets", control.targets, held, pose_count)
        self._targets = self._laned(frame.inside(targets[:, order.holds]))
        pinned = _controlled("pinned", control.pinned, rest[model.pinned], pose_count)
        self._pinned = frame.inside(pinned)
        volumes = _controlled(
            "rest_volumes", control.rest_volumes, _rest_volumes(model), pose_count
        )
        self._rest = self._laned(volumes[..., None] / frame.scale**3)
        self._contacts = self._contact_tables(_contacts(control))
        self._row_count = model.particle_count + layout.cap_count
        self._w = np.zeros(self._row_count, np.float32)
        self._w[: model.particle_count] = model.weights[order.particles]
        shape = (self._block_count, 3 * LANES * self._row_count)
        self._x = aligned_zeros(shape[0] * shape[1], np.float32).reshape(shape)
        self._g = aligned_zeros(self._threads * shape[1], np.float32).reshape(-1, shape[1])
        self._mark = np.zeros(0, np.float32)
        self._done = 0
        self._pushed = [self._multipliers() for _ in range(self._block_count)]

    def _laned(self, values: FloatArray) -> Table:
        """Return values (s, k, d) as (blocks, k * d * LANES); the last pose fills the rest."""
        chosen = np.minimum(np.arange(self._block_count * LANES), self._pose_count - 1)
        blocks = values[chosen].astype(np.float32)
        blocks = blocks.reshape(self._block_count, LANES, -1)
        result = aligned_zeros(blocks.size, np.float32).reshape(self._block_count, -1)
        result[:] = blocks.transpose(0, 2, 1).reshape(self._block_count, -1)
        return result

    def _contact_tables(self, contacts: Contacts) -> list[ContactTables]:
        frame, shape = self._layout.frame, (self._pose_count, len(contacts.particles), 3)
        particles = frame.rank[contacts.particles].astype(np.uint32)
        if contacts.points.ndim == 3 and contacts.points.shape != shape:
            raise ShapeError(
                f"control.contacts: expected points of shape {shape}, got {contacts.points.shape}"
            )
        points = self._laned(np.broadcast_to(frame.inside(contacts.points), shape))
        normals = self._laned(np.broadcast_to(contacts.normals, shape))
        stiffness = np.array([contacts.stiffness], np.float32)
        return [
            ContactTables(particles, points[block], normals[block], stiffness)
            for block in range(self._block_count)
        ]

    def _multipliers(self) -> Multipliers:
        t, size = self._layout.tables, LANES * int(self._compliant)
        counts = (
            3 * t.hold_stiffness.size,
            t.distance_rest.size,
            t.area_rest.size,
            t.bend_sine.size,
            self._layout.volumes.stiffness.size,
        )
        return Multipliers(*(aligned_zeros(size * count, np.float32) for count in counts))

    @property
    def _rows(self) -> Table:
        """All particles as (blocks, n, 3, LANES)."""
        rows = self._x.reshape(self._block_count, self._row_count, 3, LANES)
        return rows[:, : self._model.particle_count]

    def place(self, positions: FloatArray) -> None:
        """Put all particles but the pinned ones at positions (s, n, 3) [mm]; forget pushes."""
        frame, model = self._layout.frame, self._model
        inside = frame.inside(positions[:, model.order.particles])
        inside[:, frame.rank[model.pinned]] = self._pinned
        shape = (self._block_count, model.particle_count, 3, LANES)
        self._rows[:] = self._laned(inside).reshape(shape)
        for pushed in self._pushed:
            for table in pushed:
                table[:] = 0

    def sweep(self, count: int) -> None:
        """Project all constraints `count` times."""
        if self._threads == 1:
            self._sweep_blocks(0, count)
        else:
            with ThreadPoolExecutor(self._threads) as pool:
                list(pool.map(lambda thread: self._sweep_blocks(thread, count), self._ways))
        self._done += count

    @property
    def _ways(self) -> range:
        return range(self._threads)

    def _sweep_blocks(self, thread: int, count: int) -> None:
        layout = self._layout
        for block in range(thread, self._block_count, self._threads):
            lanes.iterate(
                self._x[block],
                self._w,
                self._g[thread],
                layout.tables,
                layout.volumes,
                layout.rings,
                self._contacts[block],
                self._targets[block],
                self._rest[block],
                self._pushed[block],
                count,
                self._done,
                self._alternating,
                self._compliant,
            )

    def mark(self) -> None:
        """Remember where the particles are."""
        self._mark = self._x.copy()

    def moved(self) -> FloatArray:
        """Return how far any particle of each pose (s,) has moved since `mark` [mm]."""
        squares = np.zeros((self._block_count, LANES), np.float32)
        for block in range(self._block_count):
            count = self._model.particle_count
            lanes.largest_moves(self._x[block], self._mark[block], count, squares[block])
        moves = np.sqrt(squares.ravel()[: self._pose_count].astype(np.float64))
        return moves * self._layout.frame.scale

    def carry_on(self, fresh: BoolArray) -> None:
        """Begin the next step here, the pushes kept unless fresh (s,): see `Run.carry_on`."""
        here = self._x.copy()
        ahead = here - self._mark
        if fresh.any():
            kept = np.ones(self._block_count * LANES, np.float32)
            kept[: self._pose_count] = ~fresh
            kept = kept.reshape(self._block_count, 1, LANES)
            ahead *= np.tile(kept, (1, 3 * self._row_count, 1)).reshape(ahead.shape)
            for block, pushed in enumerate(self._pushed):
                for table in pushed:
                    table.reshape(-1, LANES)[:] *= kept[block]
        self._x += ahead
        self._mark = here

    def positions(self) -> FloatArray:
        """Return the positions (s, n, 3) [mm]."""
        frame = self._layout.frame
        rows = self._rows.transpose(0, 3, 1, 2).reshape(-1, self._model.particle_count, 3)
        return frame.outside(rows[: self._pose_count, frame.rank].astype(np.float64))

    def is_finite(self) -> bool:
        """Tell whether every coordinate is a number."""
        return bool(np.isfinite(self._rows).all())

    @property
    def byte_count(self) -> int:
        """Memory of the tables, the positions of all poses and their gradients [bytes]."""
        layout = self._layout
        own = (self._x, self._g, self._w, self._targets, *layout.rings)
        pushed = [table for block in self._pushed for table in block]
        return sum(np.asarray(t).nbytes for t in (*own, *pushed, *layout.tables, *layout.volumes))
