"""Turn a model into the tables of the kernels.

Inside, lengths are in units of a power of two near the mean distance between neighbours, counted
from the centre of the model: float32 is then equally exact for every head, and a scaled model
gives the scaled result.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray
from risorius.solvers.constraints import Areas, Bends, Distances
from risorius.solvers.gradients import volume_gradient
from risorius.solvers.kernels.simd import PACK
from risorius.solvers.kernels.tables import RingTables, Table, Tables, VolumeTables
from risorius.solvers.model import Model
from risorius.solvers.order import sequence
from risorius.solvers.parameters import Parameters
from risorius.solvers.residuals import rest_weights
from risorius.solvers.shells import Shell, ring_tables, shells_of, volume_tables

__all__ = ["Form", "Frame", "Layout", "layout_of"]

Form = Literal["sequence", "packed"]
# The published duration of a step: compliance reproduces one projection of stiffness k there.
_PUBLISHED_DT = 0.0166
# Corners of the spare particles, so that whatever fills up a group is well shaped.
_SPARE = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0)], float)


@dataclass(frozen=True, eq=False)
class Frame:
    """Where the kernels' coordinates lie.

    Parameters
    ----------
    centre : (3,) float64
        Their origin [mm].
    scale : float
        Their unit [mm], a power of two.
    rank : (n,) int64
        Row of each particle.
    """

    centre: FloatArray
    scale: float
    rank: npt.NDArray[np.int64]

    @staticmethod
    def of(model: Model) -> Frame:
        """Return the frame of `model`."""
        rest = model.rest_positions
        lengths = model.constraints.distances.rest
        length = float(lengths.mean()) if len(lengths) else 0.0
        if length <= 0.0:
            length = model.size / max(model.particle_count, 1) ** 0.5
        scale = float(2.0 ** np.round(np.log2(length))) if length > 0.0 else 1.0
        centre = rest.mean(axis=0) if len(rest) else np.zeros(3)
        rank = np.empty(len(rest), np.int64)
        rank[model.order.particles] = np.arange(len(rest))
        return Frame(centre, scale, rank)

    def inside(self, places: FloatArray) -> FloatArray:
        """Return places (..., 3) [mm] in the kernels' coordinates."""
        return (places - self.centre) / self.scale

    def outside(self, places: FloatArray) -> FloatArray:
        """Return places (..., 3) of the kernels in millimetres."""
        return places * self.scale + self.centre


@dataclass(frozen=True, eq=False)
class Layout:
    """The tables of one model, one set of parameters and one form.

    Parameters
    ----------
    frame : Frame
    form : {"sequence", "packed"}
    tables : Tables
    volumes : VolumeTables
    rings : RingTables
    cap_count : int
        Rows behind the particles, one per capped hole.
    spare : (k, 4) float64
        Rows behind those.
    """

    frame: Frame
    form: Form
    tables: Tables
    volumes: VolumeTables
    rings: RingTables
    cap_count: int
    spare: FloatArray


def layout_of(model: Model, parameters: Parameters, form: Form, dtype: npt.DTypeLike) -> Layout:
    """Return the layout of `model`; costs a pass over all constraints."""
    frame = Frame.of(model)
    heaviest = float(model.weights.max(initial=0.0))
    cap_count = sum(len(volume.holes) for volume in model.constraints.volumes)
    builder = _Builder(model, parameters, frame, form, cap_count)
    c, order = model.constraints, model.order
    areas = c.areas.rest[sequence(order.areas)] / frame.scale**2
    area_limit = _limit(parameters.area_step_limit, heaviest) / areas
    bend_rest = c.bends.rest[sequence(order.bends)]
    holds = c.holds.particles[order.holds]
    gain, compliance = builder.gains(sequence(order.distances))
    tables = Tables(
        hold_particles=frame.rank[holds].astype(np.uint32),
        hold_stiffness=builder.holding(c.holds.stiffness[order.holds], model.weights[holds]),
        pairs=builder.indices(order.distances, c.distances.particles),
        distance_rest=builder.filled(
            order.distances, c.distances.rest[sequence(order.distances)] / frame.scale
        ),
        distance_gain=builder.filled(order.distances, gain),
        distance_compliance=builder.filled(order.distances, compliance),
        corners=builder.indices(order.areas, c.areas.particles),
        area_rest=builder.filled(order.areas, areas),
        area_limit=builder.filled(order.areas, area_limit),
        area_stiffness=builder.strengths(order.areas, c.areas, 2),
        flaps=builder.indices(order.bends, c.bends.particles),
        bend_sine=builder.filled(order.bends, np.sin(bend_rest)),
        bend_cosine=builder.filled(order.bends, np.cos(bend_rest)),
        bend_stiffness=builder.strengths(order.bends, c.bends, -2),
        bend_limit=np.array([_limit(parameters.bend_step_limit, heaviest)]),
    )
    tables = Tables(*(_cast(entry, dtype) for entry in tables))
    shells = shells_of(model, frame.rank)
    volumes = volume_tables(shells, builder.volume_strength(shells))
    volumes = VolumeTables(*(_cast(entry, dtype) for entry in volumes))
    zero_row = model.particle_count + cap_count
    rings = ring_tables(shells, zero_row, width=PACK if form == "packed" else 1)
    if form == "packed":
        rings = rings._replace(rows=4 * rings.rows, rings=4 * rings.rings, caps=4 * rings.caps)
    spare = np.zeros((4 * PACK, 4))
    spare[:, :3] = np.tile(_SPARE, (PACK, 1))
    return Layout(frame, form, tables, volumes, rings, cap_count, spare)


def _cast(table: Table, dtype: npt.DTypeLike) -> Table:
    return table.astype(dtype) if table.dtype == np.float64 else np.ascontiguousarray(table)


def _limit(share: float | None, heaviest: float) -> float:
    """Return the factor of (k C)^2 below which W must not fall (see `formulas`)."""
    return 0.0 if share is None else heaviest / share**2


@dataclass(frozen=True, eq=False)
class _Builder:
    model: Model
    parameters: Parameters
    frame: Frame
    form: Form
    cap_count: int

    def strength(self, stiffness: FloatArray, weight: FloatArray) -> FloatArray:
        """Return what the kernels take for stiffness k (k,) where W at rest is weight (k,)."""
        p = self.parameters
        if p.stiffness_rule == "each_iteration":
            return stiffness
        if p.stiffness_rule == "each_step":
            return 1.0 - (1.0 - stiffness) ** (1.0 / (p.iterations * p.substeps))
        longer = p.dt / p.substeps / _PUBLISHED_DT
        return weight * (1.0 - stiffness) / stiffness / longer**2

    def holding(self, stiffness: FloatArray, weight: FloatArray) -> FloatArray:
        """Return the entries of holds of stiffness k (k,); pinned particles are not drawn."""
        return np.where(weight > 0.0, self.strength(stiffness, weight), 0.0)

    def gains(self, rows: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return k / W and 0, or 1 / (W + a) and a, of the distances in `rows` (k,)."""
        table = self.model.constraints.distances
        weight = self.model.weights[table.particles[rows]].sum(axis=1)
        strength = self.strength(table.stiffness[rows], weight)
        is_compliant = self.parameters.stiffness_rule == "compliance"
        compliance = strength if is_compliant else np.zeros_like(strength)
        whole = np.ones_like(strength) if is_compliant else strength
        gain = np.zeros_like(strength)
        np.divide(whole, weight + compliance, out=gain, where=weight > 0.0)
        return gain, compliance

    def strengths(
        self, groups: IntArray, table: Distances | Areas | Bends, power: int
    ) -> FloatArray:
        """Return the entries of a whole table; W at rest has the unit mm^power."""
        rows = sequence(groups)
        weight = rest_weights(self.model, table)[rows] / self.frame.scale**power
        return self.filled(groups, self.strength(table.stiffness[rows], weight))

    def volume_strength(self, shells: list[Shell]) -> FloatArray:
        """Return the stiffness or compliance (v,) of each volume, of six times its error."""
        inside = self.frame.inside(self.model.rest_positions)
        given = np.array([shell.volume.stiffness for shell in shells])
        weights = np.array([36.0 * self._volume_weight(shell, inside) for shell in shells])
        loose = given == 0.0
        strength = self.strength(np.where(loose, 1.0, given), weights)
        # So compliant that it does nothing, and still a number of float32.
        idle = 1e30 if self.parameters.stiffness_rule == "compliance" else 0.0
        return np.where(loose, idle, strength)

    def _volume_weight(self, shell: Shell, inside: FloatArray) -> float:
        volume = shell.volume
        gradient = volume_gradient(inside, volume.faces, holes=volume.holes)
        return float((self.model.weights[:, None] * gradient**2).sum())

    def filled(self, groups: IntArray, values: FloatArray) -> FloatArray:
        """Return values (k,) as they lie in the tables; empty places hold 1."""
        if self.form == "sequence":
            return values
        result = np.ones(groups.size)
        result[groups.ravel() >= 0] = values
        return result

    def indices(self, groups: IntArray, particles: IntArray) -> npt.NDArray[np.uint32]:
        """Return the rows of the particles (k, c) of each constraint as they lie in the tables."""
        if self.form == "sequence":
            return self.frame.rank[particles[sequence(groups)]].ravel().astype(np.uint32)
        corner = np.arange(particles.shape[1])
        first_spare = len(self.frame.rank) + self.cap_count
        spare = first_spare + 4 * np.arange(PACK)[:, None] + corner
        rows = np.where((groups >= 0)[..., None], self.frame.rank[particles[groups]], spare)
        return 4 * np.ascontiguousarray(rows.transpose(0, 2, 1)).ravel().astype(np.uint32)
