"""Turns of the whole head: names in streams, and what MPEG-4 says of them.

A turn is rigid, so it is no morph target: players turn the head as a whole about the top of the
spine (`risorius.playback.head_turn`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from risorius.controls.fap import fap_name

__all__ = ["HEAD_TURNS", "HEAD_TURN_FAPS", "head_turn_of", "parameters_of_turn"]

HEAD_TURNS = ("head_pitch", "head_yaw", "head_roll")
"""Names in streams [deg]: the head looks up, turns to its left, tilts to its left."""

HEAD_TURN_FAPS: Mapping[str, tuple[str, float]] = MappingProxyType(
    {
        "head_pitch": (fap_name(48), -1.0),
        "head_yaw": (fap_name(49), 1.0),
        "head_roll": (fap_name(50), -1.0),
    }
)
"""The MPEG-4 parameter of each turn, and its sign: the standard nods down and tilts right."""

_DEGREES = math.degrees(1e-5)  # of one AU


def head_turn_of(values: Mapping[str, float]) -> tuple[float, float, float]:
    """Return pitch, yaw and roll [deg] of a frame; names and parameters add up."""
    pitch, yaw, roll = (
        values.get(name, 0.0) + sign * _DEGREES * values.get(parameter, 0.0)
        for name, (parameter, sign) in HEAD_TURN_FAPS.items()
    )
    return pitch, yaw, roll


def parameters_of_turn(turn: tuple[float, float, float]) -> dict[str, float]:
    """Return ``fap_48`` .. ``fap_50`` [AU] of pitch, yaw and roll [deg]."""
    return {
        parameter: sign * angle / _DEGREES
        for angle, (parameter, sign) in zip(turn, HEAD_TURN_FAPS.values(), strict=True)
    }
