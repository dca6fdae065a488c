"""Expression presets: named poses that a person can edit.

The book that ships is ``data/presets.json``; its schema is described in docs/file-formats.md.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from typing import Any, cast

from risorius._check import as_number, warn_of_strange_keys
from risorius.controls.arkit import arkit_shapes
from risorius.controls.control import Control, Pose
from risorius.controls.standard import bilateral, sided
from risorius.controls.standard_sets import STANDARD_SETS
from risorius.errors import FormatError

__all__ = ["EMOTIONS", "FittedPose", "PresetBook", "default_presets", "mirrored", "parse_presets"]

EMOTIONS = ("joy", "sadness", "surprise", "anger", "fear", "disgust")
"""The six basic emotions, in MPEG-4's order of importance for readers."""

SCHEMA = "risorius/presets"
VERSION = 1
_KEYS = ("schema", "version", "about", "fallbacks", "emotions", "arkit", *STANDARD_SETS)


@dataclass(frozen=True)
class FittedPose:
    """A preset as one face can make it.

    `missing` names the controls that the face lacks and that no fallback replaces.
    """

    pose: Pose
    replaced: tuple[str, ...]
    missing: tuple[str, ...]


@dataclass(frozen=True)
class PresetBook:
    """All presets of one file.

    Parameters
    ----------
    emotions, arkit : mapping of str to Pose
        Complete, right-hand ARKit shapes included.
    fallbacks : mapping of str to Pose
        What replaces a control that a face lacks; names without side.
    standards : mapping of str to mapping of str to Pose
        Poses of each of `STANDARD_SETS`, by the entry's name without prefix; of entries with a
        side both are there.
    """

    emotions: Mapping[str, Pose]
    arkit: Mapping[str, Pose]
    fallbacks: Mapping[str, Pose]
    standards: Mapping[str, Mapping[str, Pose]] = field(
        default_factory=dict[str, Mapping[str, Pose]]
    )

    def fit(self, pose: Pose, controls: Sequence[Control]) -> FittedPose:
        """Express `pose` in the controls that a face has, by the fallbacks where needed."""
        known = {control.name for control in controls}
        result: dict[str, float] = {}
        replaced: list[str] = []
        missing: list[str] = []
        for name, value in pose.items():
            if name in known:
                result[name] = result.get(name, 0.0) + value
                continue
            substitute = self._substitute(name, known)
            if not substitute:
                missing.append(name)
                continue
            replaced.append(name)
            for other, share in substitute.items():
                result[other] = result.get(other, 0.0) + share * value
        return FittedPose(result, tuple(replaced), tuple(missing))

    def _substitute(self, name: str, known: set[str]) -> dict[str, float]:
        base, side = (name[:-2], name[-2:]) if name.endswith(("_l", "_r")) else (name, "")
        result: dict[str, float] = {}
        for other, share in self.fallbacks.get(base, {}).items():
            names = sided(other) if bilateral(other) and not side else (other + side,)
            for full in names:
                if full not in known:
                    return {}
                result[full] = share
        return result


def mirrored(pose: Pose, controls: Mapping[str, Control] | None = None) -> Pose:
    """Return the pose with left and right exchanged; yaw-like controls change sign."""
    result: dict[str, float] = {}
    for name, value in pose.items():
        if controls and name in controls:
            control = controls[name]
            result[control.mirror] = value * control.mirror_sign
            continue
        sign = -1.0 if "_yaw" in name or name.endswith("_side") else 1.0
        swapped = (
            f"{name[:-2]}_r"
            if name.endswith("_l")
            else f"{name[:-2]}_l"
            if name.endswith("_r")
            else name
        )
        result[swapped] = value * sign
    return result


def _expand(entry: Mapping[str, Any], where: str) -> dict[str, float]:
    pose: dict[str, float] = {}
    for name, value in entry.items():
        number = as_number(f"{where}: {name}", value)
        for full in sided(name) if bilateral(name) else (name,):
            pose[full] = number
    return pose


def _section(data: Mapping[str, Any], key: str, source: str) -> dict[str, Any]:
    section = data.get(key, {})
    if not isinstance(section, dict):
        raise FormatError(f"{source}: {key!r} must be an object of named poses")
    for name, entry in cast(dict[str, Any], section).items():
        if not isinstance(entry, dict):
            raise FormatError(f"{source}: {key}.{name} must be an object of control: value")
    return cast(dict[str, Any], section)


def parse_presets(data: Mapping[str, Any], *, source: str) -> PresetBook:
    """Build the book from the parsed JSON of a presets file.

    Raises
    ------
    FormatError
        If schema, version or a section is wrong; the message names `source` and place.
    ParameterError
        If a value is not a finite number.
    """
    if data.get("schema") != SCHEMA:
        raise FormatError(f'{source}: expected "schema": "{SCHEMA}", got {data.get("schema")!r}')
    if data.get("version") != VERSION:
        raise FormatError(
            f"{source}: presets version {data.get('version')!r} is not {VERSION}; "
            "update risorius to read it"
        )
    warn_of_strange_keys(source, data, _KEYS, kind="presets")
    emotions = {
        name: _expand(entry, f"{source}: emotions.{name}")
        for name, entry in _section(data, "emotions", source).items()
    }
    listed = {
        name: _expand(entry, f"{source}: arkit.{name}")
        for name, entry in _section(data, "arkit", source).items()
    }
    arkit: dict[str, Pose] = {}
    for shape in arkit_shapes():
        if shape.name in listed:
            arkit[shape.name] = listed[shape.name]
        elif shape.mirror in listed:
            arkit[shape.name] = mirrored(listed[shape.mirror])
    unknown = sorted(set(listed) - set(arkit))
    if unknown:
        raise FormatError(f"{source}: not ARKit shapes: {', '.join(unknown)}")
    fallbacks = {
        name: {other: as_number(f"{source}: fallbacks.{name}", share) for other, share in e.items()}
        for name, e in _section(data, "fallbacks", source).items()
    }
    standards = {name: _standard(data, name, source) for name in STANDARD_SETS}
    return PresetBook(emotions, arkit, fallbacks, standards)


def _standard(data: Mapping[str, Any], section: str, source: str) -> dict[str, Pose]:
    """Return the poses of one of `STANDARD_SETS`, the missing side of one-sided ones mirrored."""
    listed = {
        name: _expand(entry, f"{source}: {section}.{name}")
        for name, entry in _section(data, section, source).items()
    }
    known = STANDARD_SETS[section].entries()
    unknown = [name for name in listed if name.removesuffix("_l").removesuffix("_r") not in known]
    if unknown:
        raise FormatError(f"{source}: {section}: not in this standard: {', '.join(unknown)}")
    result: dict[str, Pose] = {}
    for name in known:
        if name in listed:
            result[name] = listed[name]
        for own, other in ((f"{name}_l", f"{name}_r"), (f"{name}_r", f"{name}_l")):
            if own in listed:
                result[own] = listed[own]
            elif other in listed:
                result[own] = mirrored(listed[other])
    return result


@cache
def default_presets() -> PresetBook:
    """Return the presets that ship with risorius."""
    text = files("risorius.controls").joinpath("data/presets.json").read_text("utf-8")
    return parse_presets(json.loads(text), source="presets.json")
