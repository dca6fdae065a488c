"""Bind the muscles of a map to a skin: fibres, pulls and unit fields by control."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from risorius._check import FloatArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import Skin
from risorius.anatomy.skull_fit import MIRROR, FittedSkull
from risorius.layered.muscle import EyeAction, MouthAction, Muscle, SheetAction
from risorius.layered.muscle_map import MuscleMap
from risorius.layered.pulls import (
    REFERENCE_PITCH,
    Pull,
    eye_pull,
    lower_lid_pull,
    mouth_pull,
    near_skin,
    sheet_pull,
    submental_pull,
    upper_lid_pull,
)
from risorius.layered.support import Support
from risorius.layered.unit_fields import FieldSolver

__all__ = ["Binding", "bind_muscles"]

_SIDES = (("l", 1.0, ("3.7", "3.11")), ("r", -1.0, ("3.12", "3.8")))


@dataclass(frozen=True, eq=False)
class Binding:
    """Muscles bound to a skin of n vertices.

    Parameters
    ----------
    fibres : mapping of str to (h, w, 3) float64
        Fibres at rest of every sheet, by muscle and side [mm].
    pulls : mapping of str to Pull
        By control.
    fields : mapping of str to (n, 3) float64
        Displacement at full contraction, by control [mm].
    companions : mapping of str to (n, 3) float64
        What a device takes along where its control is above 0, per unit of the control [mm].
    """

    fibres: dict[str, FloatArray] = field(default_factory=dict[str, FloatArray])
    pulls: dict[str, Pull] = field(default_factory=dict[str, Pull])
    fields: dict[str, FloatArray] = field(default_factory=dict[str, FloatArray])
    companions: dict[str, FloatArray] = field(default_factory=dict[str, FloatArray])

    def put(self, control: str, pull: Pull, motion: FloatArray) -> None:
        """Store a pull and its field (n, 3); halves that share a control add up."""
        if control in self.fields:
            motion = self.fields[control] + motion
            pull = self.pulls[control].joined(pull)
        self.pulls[control], self.fields[control] = pull, motion

    def take(self, muscle: Muscle, other: Binding) -> None:
        """Store what `other` holds of a muscle."""
        for name in (f"{muscle.name}_l", f"{muscle.name}_r") if muscle.mirror else (muscle.name,):
            if name in other.fibres:
                self.fibres[name] = other.fibres[name]
        for control in muscle.control_names:
            if control in other.fields:
                self.pulls[control] = other.pulls[control]
                self.fields[control] = other.fields[control]


def bind_muscles(
    muscle_map: MuscleMap,
    laid: Mapping[str, FloatArray],
    fitted: FittedSkull,
    skin: Skin,
    mechanics: Mechanics,
    *,
    kept: Binding | None = None,
    changed: Collection[str] = (),
) -> Binding:
    """Bind every muscle; on a symmetric skin the right ones are mirror images of the left.

    Parameters
    ----------
    muscle_map : MuscleMap
    laid : mapping of str to (h, w, 3) float64
        Left fibres on the skull, from `risorius.layered.fibres.lay_fibres` [mm].
    fitted : FittedSkull
    skin : Skin
    mechanics : Mechanics
    kept : Binding, optional
        Of the same head before a person `changed` muscles of these names (without side); what it
        holds of all others is taken over.
    """
    binding = Binding()
    solver = FieldSolver(skin, mechanics.lips)
    support = Support.of(skin, mechanics)
    for muscle in muscle_map.muscles:
        if kept is not None and muscle.name not in changed:
            binding.take(muscle, kept)
            continue
        if isinstance(muscle.action, MouthAction):
            pull = mouth_pull(muscle.action, skin)
            binding.put(muscle.name, pull, skin.even_vectors(solver.solve(pull)))
            continue
        for side, sign, corners in _SIDES if muscle.mirror else _SIDES[:1]:
            name = f"{muscle.name}_{side}" if muscle.mirror else muscle.name
            if muscle.name in laid:
                fibres = laid[muscle.name] * (MIRROR if sign < 0.0 else 1.0)
                carried = fitted.carry(fibres.reshape(-1, 3)).reshape(fibres.shape)
                binding.fibres[name] = near_skin(carried, skin)
            if muscle.action is None:
                continue
            control = muscle.name if muscle.together else name
            if sign < 0.0 and skin.partner is not None:
                # Of halves that share a control only the left one is stored by now.
                left = muscle.name if muscle.together else f"{muscle.name}_l"
                mirrored = binding.pulls[left].mirrored(skin)
                binding.put(control, mirrored, skin.mirrored(binding.fields[left]))
                continue
            pull = _pull(muscle, binding.fibres.get(name), skin, mechanics, corners)
            field_ = solver.solve(pull)
            if isinstance(muscle.action, SheetAction):
                field_ = support.settle(field_)
            binding.put(control, pull, field_)
    if kept is not None:
        binding.companions.update(kept.companions)
        return binding
    _bind_lids(binding, solver, skin, mechanics)
    floor = solver.solve(submental_pull(skin, mechanics, fitted))
    binding.companions["jaw_pitch"] = skin.even_vectors(floor) / REFERENCE_PITCH
    return binding


def _bind_lids(binding: Binding, solver: FieldSolver, skin: Skin, mechanics: Mechanics) -> None:
    """Add what closing lids take along."""
    for side, margins in mechanics.margins.items():
        for control, pull in (("lid_lower", lower_lid_pull), ("lid_upper", upper_lid_pull)):
            left = f"{control}_l"
            if side == "r" and skin.partner is not None and left in binding.companions:
                field = skin.mirrored(binding.companions[left])
            else:
                field = solver.solve(pull(skin, margins))
            binding.companions[f"{control}_{side}"] = field


def _pull(
    muscle: Muscle,
    fibres: FloatArray | None,
    skin: Skin,
    mechanics: Mechanics,
    corners: tuple[str, str],
) -> Pull:
    if isinstance(muscle.action, EyeAction):
        places = mechanics.head.landmarks.positions(corners)
        return eye_pull(muscle.action, skin, places, shortening=muscle.shortening)
    assert isinstance(muscle.action, SheetAction) and fibres is not None
    return sheet_pull(muscle, muscle.action, fibres, skin)
