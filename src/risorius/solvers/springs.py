"""Springs between particles, and from particles to anchors that a caller moves."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray, as_number, as_points
from risorius.errors import MeshError, ParameterError, ShapeError
from risorius.solvers.spring_layout import PackLayout, pack_layout

__all__ = ["SpringControl", "SpringNetwork", "SpringState"]

# Stands for "never" in the kernels, where an infinity would make not-a-number.
_NEVER = 1e20


def _unset() -> FloatArray:
    return np.zeros(0)


def _no_particles() -> IntArray:
    return np.zeros(0, np.int32)


def _nobody() -> BoolArray:
    return np.zeros(0, bool)


@dataclass(frozen=True, eq=False)
class SpringNetwork:
    """Particles, biphasic springs between them, linear springs to anchors, and holds.

    An edge pulls with ``k (L - L0)`` up to its knee length L1 and with ``(1 + s) k`` beyond, s
    being `stiffening` (Kaehler et al. 2001, section 4; beta = 1 + s). An anchor spring pulls its
    particle towards distance L0 from a point that the control moves; a hold pulls it to a point.

    What is left out, or empty, has its default.

    Parameters
    ----------
    rest_positions : (n, 3) float64
    edges : (e, 2) int32
    rest_lengths : (e,) float64
        L0 [mm].
    stiffness : (e,) float64
        k [force / mm]; only ratios matter where things come to rest.
    knee_lengths : (e,) float64, optional
        L1 [mm]; without them an edge is linear.
    stiffening : float
        By how much of k an edge is stiffer beyond its knee.
    anchored : (a,) int32
        Particle of each anchor spring.
    anchor_lengths, anchor_stiffness : (a,) float64
        Their L0 [mm] and k.
    hold_stiffness : (n,) float64, optional
        0 where a particle is not held.
    load : (n, 3) float64, optional
        Constant force on each particle.
    fixed : (n,) bool, optional
        Particles that never move.
    mass : (n,) float64, optional
        By default the sum of the stiffness at each particle, which makes the stable step the
        same on every mesh.

    Raises
    ------
    ShapeError
        If arrays do not agree.
    MeshError
        If an edge or an anchor names a particle that does not exist.
    ParameterError
        If a stiffness or length is negative or not finite, or a mass not above 0.
    """

    rest_positions: FloatArray
    edges: IntArray
    rest_lengths: FloatArray
    stiffness: FloatArray
    knee_lengths: FloatArray = field(default_factory=_unset)
    stiffening: float = 0.0
    anchored: IntArray = field(default_factory=_no_particles)
    anchor_lengths: FloatArray = field(default_factory=_unset)
    anchor_stiffness: FloatArray = field(default_factory=_unset)
    hold_stiffness: FloatArray = field(default_factory=_unset)
    load: FloatArray = field(default_factory=_unset)
    fixed: BoolArray = field(default_factory=_nobody)
    mass: FloatArray = field(default_factory=_unset)

    def __post_init__(self) -> None:
        rest = as_points("rest_positions", self.rest_positions)
        n, e = len(rest), len(self.edges)
        anchored = self.anchored
        for name, table in (("edges", self.edges), ("anchored", anchored)):
            if table.size and (table.min() < 0 or table.max() >= n):
                raise MeshError(
                    f"{name}: names particle {int(table.max())} or {int(table.min())}, there are "
                    f"only 0..{n - 1}"
                )
        if self.edges.ndim != 2 or self.edges.shape[1] != 2:
            raise ShapeError(f"edges: expected shape (e, 2), got {self.edges.shape}")
        a = len(anchored)
        put = {"rest_positions": rest, "anchored": np.ascontiguousarray(anchored, np.int32)}
        put["edges"] = np.ascontiguousarray(self.edges, np.int32)
        for name, count, default in (
            ("rest_lengths", e, 0.0),
            ("stiffness", e, 0.0),
            ("knee_lengths", e, _NEVER),
            ("anchor_lengths", a, 0.0),
            ("anchor_stiffness", a, 0.0),
            ("hold_stiffness", n, 0.0),
        ):
            put[name] = _lengths(name, getattr(self, name), count, default)
        load = as_points("load", self.load) if self.load.size else np.zeros((n, 3))
        if load.shape != (n, 3):
            raise ShapeError(f"load: expected shape {(n, 3)}, got {load.shape}")
        fixed = np.ascontiguousarray(self.fixed, bool) if self.fixed.size else np.zeros(n, bool)
        if fixed.shape != (n,):
            raise ShapeError(f"fixed: expected shape ({n},), got {fixed.shape}")
        for name, value in (*put.items(), ("load", load), ("fixed", fixed)):
            object.__setattr__(self, name, value)
        as_number("stiffening", self.stiffening, low=0.0)
        total = self.stiffness_sums
        mass = self.mass if self.mass.size else np.where(total > 0.0, total, 1.0)
        mass = np.ascontiguousarray(mass, np.float64)
        if mass.shape != (n,):
            raise ShapeError(f"mass: expected shape ({n},), got {mass.shape}")
        if not (np.isfinite(mass) & (mass > 0.0)).all():
            raise ParameterError("mass: every entry must be finite and above 0; use `fixed` to pin")
        object.__setattr__(self, "mass", mass)

    @property
    def particle_count(self) -> int:
        """Number of particles."""
        return len(self.rest_positions)

    @cached_property
    def stiffness_sums(self) -> FloatArray:
        """Largest possible sum (n,) of the stiffness of all that pulls at each particle."""
        n = self.particle_count
        stiff = (1.0 + self.stiffening) * self.stiffness
        total = np.zeros(n)
        total += np.bincount(self.edges.ravel(), np.repeat(stiff, 2), n)
        total += np.bincount(self.anchored, self.anchor_stiffness, n)
        return total + self.hold_stiffness

    @cached_property
    def inv_mass(self) -> FloatArray:
        """Inverse masses (n,), 0 for fixed particles."""
        return np.where(self.fixed, 0.0, 1.0 / self.mass)

    @cached_property
    def stable_step(self) -> float:
        """The longest step of a leapfrog that stays bounded.

        ``dt < 2 / omega_max``; every eigenvalue of the system is at most twice the largest sum of
        stiffness over mass at a particle (Gershgorin). Biphasic edges count with their stiffer
        half, or the step is too long by the root of beta (finding S2).
        """
        rate = float((self.stiffness_sums * self.inv_mass).max(initial=0.0))
        return 2.0 / float(np.sqrt(2.0 * rate)) if rate > 0.0 else 1.0

    @cached_property
    def layout(self) -> PackLayout:
        """Where everything lies in the packed kernel."""
        return pack_layout(self.edges, self.fixed)


@dataclass(frozen=True, eq=False)
class SpringControl:
    """What is asked of a network; what is None is as in the network.

    Parameters
    ----------
    anchors : (a, 3) float64, optional
        Places of the anchors [mm]; needed where the network has any.
    anchor_stiffness : (a,) float64, optional
        Never above that of the network.
    hold_targets : (n, 3) float64, optional
        Where the holds draw to [mm]; the rest positions by default.
    hold_stiffness : (n,) float64, optional
        Never above that of the network.
    rest_lengths, knee_lengths : (e,) float64, optional
        Of a network whose rest shape is moved as a whole [mm].
    load : (n, 3) float64, optional
    """

    anchors: FloatArray | None = None
    anchor_stiffness: FloatArray | None = None
    hold_targets: FloatArray | None = None
    hold_stiffness: FloatArray | None = None
    rest_lengths: FloatArray | None = None
    knee_lengths: FloatArray | None = None
    load: FloatArray | None = None

    def resolved(self, network: SpringNetwork) -> dict[str, FloatArray]:
        """Return every array by name, such as ``"load"`` (n, 3), checked against a network.

        Raises
        ------
        ShapeError
            If a shape is wrong, an entry is not finite, or anchors are missing.
        ParameterError
            If a spring would be stiffer than the stable step allows for.
        """
        anchors = self.anchors
        if anchors is None and len(network.anchored):
            raise ShapeError(f"control.anchors: missing; expected ({len(network.anchored)}, 3)")
        defaults = {
            "anchors": np.zeros((0, 3)),
            "anchor_stiffness": network.anchor_stiffness,
            "hold_targets": network.rest_positions,
            "hold_stiffness": network.hold_stiffness,
            "rest_lengths": network.rest_lengths,
            "knee_lengths": network.knee_lengths,
            "load": network.load,
        }
        shapes = {name: np.shape(value) for name, value in defaults.items()}
        shapes["anchors"] = (len(network.anchored), 3)
        result: dict[str, FloatArray] = {}
        for name, default in defaults.items():
            given = getattr(self, name)
            value = np.ascontiguousarray(default if given is None else given, np.float64)
            if value.shape != shapes[name]:
                raise ShapeError(
                    f"control.{name}: expected shape {shapes[name]}, got {value.shape}"
                )
            if not np.isfinite(value).all():
                raise ShapeError(f"control.{name}: every entry must be finite")
            result[name] = value
        for name in ("anchor_stiffness", "hold_stiffness"):
            if (result[name] > getattr(network, name) * (1.0 + 1e-9)).any():
                raise ParameterError(
                    f"control.{name}: above that of the network, for which the stable step is "
                    "computed; build the network with the largest stiffness"
                )
        return result


@dataclass(frozen=True, eq=False)
class SpringState:
    """Where the particles are and how fast.

    Parameters
    ----------
    positions : (n, 3) float64
        Places [mm].
    velocities : (n, 3) float64
        [mm per unit of time].
    """

    positions: FloatArray
    velocities: FloatArray

    @staticmethod
    def still(positions: FloatArray) -> SpringState:
        """Return the state at `positions` (n, 3) [mm] without velocity."""
        return SpringState(positions, np.zeros_like(positions))


def _lengths(name: str, given: FloatArray, count: int, default: float) -> FloatArray:
    value = np.ascontiguousarray(given, np.float64) if given.size else np.full(count, default)
    if value.shape != (count,):
        raise ShapeError(f"{name}: expected shape ({count},), got {value.shape}")
    value = np.minimum(value, _NEVER) if name == "knee_lengths" else value
    if not (np.isfinite(value) & (value >= 0.0)).all():
        raise ParameterError(f"{name}: every entry must be finite and not below 0")
    return value
