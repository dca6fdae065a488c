"""What a solver works on: what holds (model), where things are (state), what is asked (control)."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from risorius._check import FloatArray, IntArray, as_points
from risorius.errors import MeshError, ParameterError, RisoriusWarning, ShapeError
from risorius.solvers.constraints import Constraints, Contacts
from risorius.solvers.order import Order, order_of, require_mirror

__all__ = ["Control", "Model", "State"]

# A triangle whose height is below this share of its longest side is a sliver.
_SLIVER = 0.1
_STIFF = 0.5


@dataclass(frozen=True, eq=False)
class Model:
    """Particles at rest and the constraints between them.

    Parameters
    ----------
    rest_positions : (n, 3) float64
    constraints : Constraints
    inv_mass : (n,) float64, optional
        Inverse mass w of each particle [1/kg], 0 for those that only the control moves; by
        default the published 1.
    mirror : (n,) int32, optional
        The particle opposite to each; mirrored constraints are then projected at the same time.

    Raises
    ------
    MeshError
        If a constraint names a particle that does not exist, or `mirror` does not lead back.
    """

    rest_positions: FloatArray
    constraints: Constraints
    inv_mass: FloatArray | None = None
    mirror: IntArray | None = None

    def __post_init__(self) -> None:
        rest = as_points("rest_positions", self.rest_positions)
        object.__setattr__(self, "rest_positions", rest)
        given = np.ones(len(rest)) if self.inv_mass is None else self.inv_mass
        inv_mass = np.ascontiguousarray(given, np.float64)
        if inv_mass.shape != (len(rest),):
            raise ShapeError(f"inv_mass: expected shape ({len(rest)},), got {inv_mass.shape}")
        if not (np.isfinite(inv_mass) & (inv_mass >= 0.0)).all():
            raise ParameterError("inv_mass: every entry must be finite and not below 0")
        object.__setattr__(self, "inv_mass", inv_mass)
        if self.mirror is not None:
            mirror = np.ascontiguousarray(self.mirror, np.int32)
            require_mirror(mirror, len(rest))
            object.__setattr__(self, "mirror", mirror)
        self._require_particles()
        self._warn_of_slivers()

    @property
    def particle_count(self) -> int:
        """Number of particles."""
        return len(self.rest_positions)

    @property
    def weights(self) -> FloatArray:
        """Inverse masses (n,), also where none were given [1/kg]."""
        assert self.inv_mass is not None
        return self.inv_mass

    @cached_property
    def pinned(self) -> IntArray:
        """Particles (k,) that only the control moves, in ascending order."""
        return np.flatnonzero(self.weights == 0.0).astype(np.int32)

    @cached_property
    def size(self) -> float:
        """Diagonal of the box around the rest positions [mm]."""
        if not self.particle_count:
            return 0.0
        return float(np.linalg.norm(np.ptp(self.rest_positions, axis=0)))

    @cached_property
    def order(self) -> Order:
        """The order in which constraints are projected."""
        return order_of(self.constraints, self.particle_count, mirror=self.mirror)

    def _require_particles(self) -> None:
        c = self.constraints
        named = {
            "distances": c.distances.particles,
            "areas": c.areas.particles,
            "bends": c.bends.particles,
            "holds": c.holds.particles,
        }
        for number, volume in enumerate(c.volumes):
            named[f"volumes[{number}]"] = volume.faces
            for rim in volume.holes:
                named[f"volumes[{number}].holes"] = rim
        for name, table in named.items():
            if table.size and (table.min() < 0 or table.max() >= self.particle_count):
                raise MeshError(
                    f"constraints.{name}: names particle {int(table.max())} or "
                    f"{int(table.min())}, there are only 0..{self.particle_count - 1}"
                )

    def _warn_of_slivers(self) -> None:
        """Warn of thin triangles with a stiff area, which can keep a solution from settling."""
        table = self.constraints.areas
        corners = self.rest_positions[table.particles]
        sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
        longest = sides.max(axis=1, initial=0.0)
        thin = 2.0 * table.rest < _SLIVER * longest**2
        risky = np.flatnonzero(thin & (table.stiffness > _STIFF))
        if len(risky):
            first = table.particles[risky[0]].tolist()
            warnings.warn(
                f"{len(risky)} sliver triangles, first {first}, keep their area with stiffness "
                f"{table.stiffness[risky].max():g}: the solution may tremble instead of settling; "
                f"use an area stiffness of at most {_STIFF:g} for them, or a better mesh",
                RisoriusWarning,
                stacklevel=4,
            )


@dataclass(frozen=True, eq=False)
class State:
    """Where the particles are; one pose, or `s` poses of the same model at once.

    Parameters
    ----------
    positions : (n, 3) float64
        Or (s, n, 3) [mm].
    velocities : (n, 3) float64
        Or (s, n, 3) [mm/s].
    previous : (n, 3) float64, optional
        Or (s, n, 3): positions before the last step [mm]; by default the positions.
    """

    positions: FloatArray
    velocities: FloatArray
    previous: FloatArray | None = None

    def __post_init__(self) -> None:
        shape = self.positions.shape
        if len(shape) not in (2, 3) or shape[-1] != 3:
            raise ShapeError(f"positions: expected shape (n, 3) or (s, n, 3), got {shape}")
        if self.velocities.shape != shape:
            raise ShapeError(f"velocities: expected shape {shape}, got {self.velocities.shape}")
        if self.previous is None:
            object.__setattr__(self, "previous", self.positions)

    @staticmethod
    def at_rest(model: Model, *, pose_count: int | None = None) -> State:
        """Return the rest positions without velocity, once or `pose_count` times."""
        shape = model.rest_positions.shape
        full = shape if pose_count is None else (pose_count, *shape)
        return State(np.array(np.broadcast_to(model.rest_positions, full)), np.zeros(full))


@dataclass(frozen=True, eq=False)
class Control:
    """What is asked of one step, or of a pose to settle in; what is None stays at rest.

    With several poses an array may have a leading axis (s, ...) of its own, or serve all.

    Parameters
    ----------
    targets : (k, 3) float64, optional
        Where the holds of the model draw their particles [mm].
    pinned : (k, 3) float64, optional
        Positions of the model's pinned particles [mm].
    rest_volumes : (v,) float64, optional
        Instead of the volumes of the model [mm^3].
    acceleration : (3,) float64, optional
        Of all particles, or (n, 3) of each [mm/s^2].
    contacts : Contacts, optional
        Planes that particles must stay in front of.
    """

    targets: FloatArray | None = None
    pinned: FloatArray | None = None
    rest_volumes: FloatArray | None = None
    acceleration: FloatArray | None = None
    contacts: Contacts | None = field(default=None)
