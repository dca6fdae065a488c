"""How far each control of an expression goes, as changes that any face can make."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from risorius._check import FloatArray
from risorius.controls.control import Control, Pose
from risorius.controls.presets import PresetBook
from risorius.rig.face import Face
from risorius.tuning.candidates import FaceCandidates, paired_controls
from risorius.tuning.genome import Genome, Parameter

__all__ = ["IntensityCandidates", "apply_intensities", "intensity_parameters"]

# A control goes at most so much of its full effect further, or less far; more closes eyes.
_SHARE = 0.3


def intensity_parameters(
    pose: Pose, expression: str, controls: Sequence[Control], *, mirror: bool = True
) -> tuple[Parameter, ...]:
    """Return the changes of a preset, named expression, dot, control; in the control's unit.

    Parameters
    ----------
    pose : mapping of str to float
        The preset.
    expression : str
    controls : sequence of Control
        Of the face, for their ranges; controls that it lacks and replaces go from 0 to 1.
    mirror : bool
        Controls of both sides that are equal stay equal; one parameter, named without side,
        drives both.
    """
    ranges = {control.name: (control.low, control.high) for control in controls}
    result: list[Parameter] = []
    for stem, group in paired_controls(pose, mirror=mirror).items():
        low, high = ranges.get(group[0], (0.0, 1.0))
        value, reach = pose[group[0]], _SHARE * max(abs(low), abs(high))
        least, most = max(low - value, -reach), min(high - value, reach)
        if least <= 0.0 <= most and least < most:
            result.append(Parameter(f"{expression}.{stem}", least, most, 0.0))
    return tuple(result)


def apply_intensities(presets: PresetBook, values: Mapping[str, float]) -> PresetBook:
    """Return the book with its emotions changed; strange names do not matter.

    Parameters
    ----------
    presets : PresetBook
    values : mapping of str to float
        By the names of `intensity_parameters`; a side of its own goes before both.
    """
    emotions = {name: _changed(pose, name, values) for name, pose in presets.emotions.items()}
    return replace(presets, emotions=emotions)


@dataclass(frozen=True, eq=False)
class IntensityCandidates:
    """One expression of a face, alone or together with the muscles that make it.

    Parameters
    ----------
    subject : Face or FaceCandidates
        A face as it is, or muscles that are tuned as well.
    presets : PresetBook
    expression : str
        One of its emotions.
    mirror : bool
    """

    subject: Face | FaceCandidates
    presets: PresetBook
    expression: str
    mirror: bool = True

    @property
    def genome(self) -> Genome:
        """What may be tuned: muscles first, then how far controls go."""
        return self._genome

    @cached_property
    def _genome(self) -> Genome:
        pose = self.presets.emotions[self.expression]
        own = intensity_parameters(pose, self.expression, self._rest.controls, mirror=self.mirror)
        muscles = () if isinstance(self.subject, Face) else self.subject.genome.parameters
        return Genome((*muscles, *own))

    @cached_property
    def _rest(self) -> Face:
        return self.subject if isinstance(self.subject, Face) else self.subject.face_of({})

    def pose_of(self, values: Mapping[str, float], face: Face) -> Pose:
        """Return the expression with these values, in the controls of a face."""
        changed = _changed(self.presets.emotions[self.expression], self.expression, values)
        return self.presets.fit(changed, face.controls).pose

    def positions(self, values: Mapping[str, float]) -> FloatArray:
        """Return the vertices (n, 3) of the candidate with these values [mm]."""
        face = self.subject
        if not isinstance(face, Face):
            face = face.face_of(values)
        return face.pose(self.pose_of(values, face))


def _changed(pose: Pose, expression: str, values: Mapping[str, float]) -> Pose:
    result: dict[str, float] = {}
    for control, value in pose.items():
        stem = control[:-2] if control.endswith(("_l", "_r")) else control
        change = values.get(f"{expression}.{control}", values.get(f"{expression}.{stem}", 0.0))
        result[control] = value + change
    return result
