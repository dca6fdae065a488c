"""Everything that can be set about a solver run."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from risorius._check import as_number, one_of
from risorius.errors import ParameterError

__all__ = ["PROFILES", "Parameters", "Profile", "StiffnessRule", "Sweeps"]

Profile = Literal["improved", "faithful"]
StiffnessRule = Literal["each_iteration", "each_step", "compliance"]
Sweeps = Literal["forward", "alternating"]


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """How a step is taken; the defaults are those of the faithful profile (spec section 3.1).

    Parameters
    ----------
    dt : float
        Duration of a step [s].
    substeps : int
        Equal parts of a step, each with its own prediction and iterations.
    iterations : int
        Sweeps over all constraints per substep (`settle` ends by `tolerance` instead).
    damping : float
        Share of the velocity lost per step (open point O1).
    stiffness_rule : {"each_iteration", "each_step", "compliance"}
        What stiffness k means: the share of its error that a constraint loses per iteration, as
        published, so that the result stiffens with their number; the same per step,
        k' = 1 - (1 - k)^(1/n) over the n iterations of all substeps; or a compliance
        a = dt^2 W (1 - k) / k at the published dt (extended position-based dynamics), with W at
        rest, so that a single iteration is the published projection and more of them converge to
        one equilibrium that does not depend on their order.
    sweeps : {"forward", "alternating"}
        Whether every other sweep runs backwards (open point O3).
    bend_step_limit : float or None
        Largest motion by one bending projection, in edge lengths. Not published, but without it
        real heads explode at the published stiffness: bending has configurations without lever.
    area_step_limit : float or None
        Largest motion by one area projection, in square roots of the rest area.
    tolerance : float
        `settle` ends when no particle moves more than this share of the model's size in two
        sweeps (finding S6).
    iteration_limit : int
        `settle` ends after this many sweeps at the latest.
    """

    dt: float = 0.0166
    substeps: int = 1
    iterations: int = 1
    damping: float = 0.2
    stiffness_rule: StiffnessRule = "each_iteration"
    sweeps: Sweeps = "forward"
    bend_step_limit: float | None = 0.2
    area_step_limit: float | None = 0.2
    tolerance: float = 1e-4
    iteration_limit: int = 240

    def __post_init__(self) -> None:
        as_number("dt", self.dt, low=1e-6)
        as_number("damping", self.damping, low=0.0, high=1.0)
        as_number("tolerance", self.tolerance, low=0.0)
        for name in ("substeps", "iterations", "iteration_limit"):
            value = getattr(self, name)
            if int(value) != value or value < 1:
                raise ParameterError(f"{name}: {value} must be a whole number from 1 on")
        for name in ("bend_step_limit", "area_step_limit"):
            value = getattr(self, name)
            if value is not None and as_number(name, value) <= 0.0:
                raise ParameterError(f"{name}: {value:g} must be above 0, or None for no limit")
        one_of("stiffness_rule", self.stiffness_rule, _RULES)
        one_of("sweeps", self.sweeps, _SWEEPS)

    @staticmethod
    def of_profile(profile: Profile) -> Parameters:
        """Return the parameters of a profile: "improved" or "faithful"."""
        return PROFILES[one_of("profile", profile, PROFILES)]


_RULES = ("each_iteration", "each_step", "compliance")
_SWEEPS = ("forward", "alternating")
_FAITHFUL = Parameters()

PROFILES: dict[str, Parameters] = {
    "faithful": _FAITHFUL,
    "improved": replace(
        _FAITHFUL,
        iterations=4,
        stiffness_rule="compliance",
        sweeps="alternating",
        tolerance=2e-5,
    ),
}
