"""What a rig file carries beside its shapes, as JSON: landmarks, frame, controls, poses."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, cast, get_args

import numpy as np

from risorius._check import IntArray
from risorius.controls.control import Control, ControlGroup
from risorius.controls.pair_names import pair_of
from risorius.errors import FormatError
from risorius.head.frame import Frame
from risorius.io.bounded import check_schema
from risorius.io.json_fields import Fields, whole_number
from risorius.io.landmarks import landmarks_from_json, landmarks_to_json
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.polygon_mesh import Labels
from risorius.rig.rig import Rig

__all__ = ["RigInfo", "labels_from_json", "labels_to_json", "rig_info", "rig_to_json"]

SCHEMA = "risorius/rig"
VERSION = 1


@dataclass(frozen=True)
class RigInfo:
    """Everything of a `Rig` but mesh and displacements."""

    frame: Frame
    landmarks: Mapping[str, LandmarkSpec]
    controls: tuple[Control, ...]
    poses: Mapping[str, Mapping[str, float]]
    left_out: Mapping[str, str]
    part_names: tuple[str, ...]


def rig_to_json(rig: Rig) -> dict[str, Any]:
    """Return what `rig_info` reads.

    Raises
    ------
    FormatError
        If a number is not finite.
    """
    document = {
        "schema": SCHEMA,
        "version": VERSION,
        "frame": {
            "unit": rig.frame.unit,
            "scale": float(rig.frame.scale),
            "origin": rig.frame.origin.tolist(),
            "rotation": rig.frame.rotation.ravel().tolist(),
        },
        "landmarks": landmarks_to_json(rig.landmarks),
        "controls": [asdict(control) for control in rig.controls],
        "poses": {
            target.name: {name: float(value) for name, value in target.pose.items()}
            for target in rig.targets
            if target.pose
        },
        "left_out": dict(rig.left_out),
        "correctives": {name: list(pair) for name in rig.names if (pair := _pair(rig, name))},
        "parts": list(rig.part_names),
    }
    try:
        json.dumps(document, allow_nan=False)
    except ValueError:
        raise FormatError(
            "rig: frame, landmarks, controls or poses hold a number that is not finite"
        ) from None
    return document


def _pair(rig: Rig, name: str) -> tuple[str, str] | None:
    """Return the targets whose product drives a corrective; reading needs only its name."""
    pair = pair_of(name)
    return pair if pair and set(pair) <= set(rig.names) else None


def rig_info(value: object, where: str) -> RigInfo:
    """Read what `rig_to_json` wrote; `where` opens every message.

    Raises
    ------
    FormatError
        If a field has the wrong type, or the version is newer than this code.
    """
    fields = Fields(value, where)
    check_schema(fields.value, where, schema=SCHEMA, version=VERSION)
    landmarks = fields.fields("landmarks")
    poses = fields.fields("poses")
    left_out = fields.fields("left_out")
    return RigInfo(
        _frame(fields.fields("frame")),
        landmarks_from_json(landmarks.value, where) if landmarks.value else {},
        tuple(_control(Fields(c, f"{where}: controls")) for c in fields.items("controls")),
        {name: _pose(poses.fields(name)) for name in poses},
        {name: left_out.text(name) for name in left_out},
        tuple(fields.texts("parts")),
    )


def _frame(fields: Fields) -> Frame:
    rotation = np.array(fields.numbers("rotation", 9)).reshape(3, 3)
    scale = fields.number("scale")
    origin = np.array(fields.numbers("origin", 3))
    orthogonal = np.abs(rotation).max() < 2 and np.allclose(rotation @ rotation.T, np.eye(3))
    if not orthogonal or np.linalg.det(rotation) < 0:
        raise FormatError(f"{fields.where}: rotation: expected a rotation matrix, row by row")
    if not 1e-9 < scale < 1e9:
        raise FormatError(f"{fields.where}: scale: {scale:g} mm is no length of a unit")
    return Frame(rotation, scale, origin, fields.text("unit"))


def _control(fields: Fields) -> Control:
    group = fields.text("group")
    if group not in get_args(ControlGroup):
        raise FormatError(
            f"{fields.where}: group: expected one of {', '.join(get_args(ControlGroup))}"
        )
    return Control(
        fields.text("name"),
        fields.number("low"),
        fields.number("high"),
        fields.number("default"),
        fields.text("unit"),
        cast(ControlGroup, group),
        fields.text("mirror"),
        fields.number("mirror_sign", default=1.0),
    )


def _pose(fields: Fields) -> dict[str, float]:
    return {name: fields.number(name) for name in fields}


def labels_to_json(labels: Labels) -> dict[str, Any]:
    """Return names and run lengths ``[[label, polygons], ...]``."""
    return {"names": list(labels.names), "runs": runs_to_json(labels.of_polygon)}


def labels_from_json(fields: Fields, count: int) -> Labels:
    """Read what `labels_to_json` wrote for a mesh of `count` polygons (or none)."""
    names = tuple(fields.texts("names"))
    of_polygon = runs_from_json(fields, "runs", count=count, high=len(names) - 1)
    return Labels(names, of_polygon)


def runs_to_json(values: IntArray) -> list[list[int]]:
    """Return ``[[value, how often in a row], ...]``."""
    if not len(values):
        return []
    starts = np.concatenate([[0], np.flatnonzero(np.diff(values)) + 1])
    lengths = np.diff(np.concatenate([starts, [len(values)]]))
    return np.stack([values[starts], lengths], axis=1).tolist()


def runs_from_json(fields: Fields, key: str, *, count: int, high: int) -> IntArray:
    """Read what `runs_to_json` wrote; there are `count` values in -1..high, or none at all."""
    where = fields.place(key)
    runs: list[tuple[int, int]] = []
    for run in fields.items(key):
        pair = cast("list[Any]", run) if isinstance(run, list) else []
        if len(pair) != 2:
            raise FormatError(f"{where}: expected pairs of value and length")
        runs.append((whole_number(pair[0], where, low=-1), whole_number(pair[1], where, low=1)))
    if runs and (sum(length for _, length in runs) != count or max(runs)[0] > high):
        raise FormatError(f"{where}: expected {count} values up to {high}")
    table = np.array(runs, np.int32).reshape(-1, 2)
    return np.repeat(table[:, 0], table[:, 1])
