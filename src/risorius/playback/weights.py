"""From frames of any standard to weights of the targets that a rig has."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from risorius._check import FloatArray
from risorius.controls.control import Pose
from risorius.controls.fap import fap_number, faps
from risorius.controls.head_turn import HEAD_TURNS
from risorius.controls.pair_names import pair_of
from risorius.controls.presets import PresetBook, default_presets
from risorius.controls.standard import device_controls
from risorius.controls.standard_sets import STANDARD_SETS
from risorius.playback.fap_fit import FapFit
from risorius.rig.rig import Rig

__all__ = ["RigWeights"]

# Columns of Live Link Face that are angles.
_ANGLES = ("Head", "LeftEye", "RightEye")
_TURNS = ("Yaw", "Pitch", "Roll")


class RigWeights:
    """Turns values of any standard into weights of a rig.

    A name that is a target is its weight. ``fap_*`` counts units of the face and is fitted at the
    feature points. A shape that the rig lacks and the presets know is made of the rig's singles,
    muscle by muscle. Correctives of pairs get the product of their shapes' weights. Turns of the
    head are no weights and are left to the player. What remains is remembered in `unmatched`.

    Parameters
    ----------
    rig : Rig
    presets : PresetBook, optional
        Poses of shapes that the rig lacks; those that ship if left out.
    """

    def __init__(self, rig: Rig, *, presets: PresetBook | None = None) -> None:
        self.rig = rig
        self.unmatched: dict[str, str] = {}
        self._column = {name: index for index, name in enumerate(rig.names)}
        self._presets = presets or default_presets()
        self._made: dict[str, FloatArray | None] = {}

    @cached_property
    def fit(self) -> FapFit:
        """The rig as MPEG-4 parameters see it.

        Raises
        ------
        LandmarkError
            If the rig carries too few landmarks.
        """
        return FapFit.of_rig(self.rig)

    @cached_property
    def _pairs(self) -> tuple[tuple[int, int, int], ...]:
        """Columns of each corrective and of the two shapes whose product drives it."""
        found: list[tuple[int, int, int]] = []
        for name, row in self._column.items():
            first, second = pair_of(name) or ("", "")
            if first in self._column and second in self._column:
                found.append((row, self._column[first], self._column[second]))
        return tuple(found)

    def of(self, values: Mapping[str, float]) -> FloatArray:
        """Return the weights (t,) of all targets for the values of a frame.

        Raises
        ------
        LandmarkError
            If there are ``fap_*`` and the rig carries too few landmarks.
        """
        parameters = {name: value for name, value in values.items() if fap_number(name)}
        result = np.zeros(len(self.rig.targets))
        if parameters:
            result = self.fit.weights(parameters)
            self._remember(parameters)
        made = np.zeros_like(result)
        for name, value in values.items():
            if name in parameters or name in HEAD_TURNS:
                continue
            if name in self._column:
                result[self._column[name]] += value
                continue
            if name not in self._made:
                self._made[name] = self._from_singles(name)
            column = self._made[name]
            if column is not None:
                made += value * column
            elif value:
                self.unmatched.setdefault(name, _reason(name))
        if made.any():
            result += np.clip(made, 0.0, 1.0)
        for row, first, second in self._pairs:
            result[row] = float(
                np.clip(result[first], 0.0, 1.0) * np.clip(result[second], 0.0, 1.0)
            )
        return result

    def _remember(self, parameters: Mapping[str, float]) -> None:
        for name, value in parameters.items():
            number = fap_number(name)
            if not value or number is None or faps()[number].turns_head:
                continue
            if number in self.fit.reading.left_out:
                reason = self.fit.reading.left_out[number]
                self.unmatched.setdefault(name, f"{faps()[number].name}: {reason}")

    def _from_singles(self, name: str) -> FloatArray | None:
        """Return the weights (t,) of the singles that make a preset, or None."""
        pose = self._preset(name)
        if pose is None:
            return None
        if self.rig.controls:
            pose = self._presets.fit(pose, self.rig.controls).pose
        column = np.zeros(len(self.rig.targets))
        ranges = {control.name: control for control in (*device_controls(), *self.rig.controls)}
        for control, value in pose.items():
            limits = ranges.get(control)
            high, low = (limits.high, limits.low) if limits else (1.0, 0.0)
            single = control if value >= 0.0 else f"{control}_neg"
            end = high if value >= 0.0 else low
            if single in self._column and end:
                column[self._column[single]] += value / end
        return column if column.any() or not pose else None

    def _preset(self, name: str) -> Pose | None:
        for poses in (self._presets.emotions, self._presets.arkit):
            if name in poses:
                return poses[name]
        for section, standard in STANDARD_SETS.items():
            entry = name.removeprefix(standard.prefix)
            if entry != name and entry in self._presets.standards.get(section, {}):
                return self._presets.standards[section][entry]
        return None


def _reason(name: str) -> str:
    if name.startswith(_ANGLES) and name.endswith(_TURNS):
        return (
            "an angle whose unit and sign differ between versions of Live Link Face; name the "
            "column head_pitch, head_yaw or head_roll [deg; up, left, left] to turn the head"
        )
    return "the rig has no such target and no muscles for it"
