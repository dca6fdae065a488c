"""Muscles that act where an expression acts: a smile is more than its strongest muscle."""

from __future__ import annotations

import numpy as np

from risorius.controls.control import Pose
from risorius.rig.face import Face
from risorius.tuning.candidates import paired_controls

__all__ = ["companions_of"]

_LIKE = 0.35
# What is not muscle has a device of its own.
_DEVICES = ("jaw", "lips", "lid", "gaze", "tongue", "cheek")


def companions_of(face: Face, pose: Pose, *, least: float = _LIKE) -> tuple[str, ...]:
    """Return the muscles that rest in a pose and move the skin that the pose moves.

    A muscle counts if the cosine between how far it moves each vertex, whatever the direction,
    and how far the pose does is at least `least`.

    Parameters
    ----------
    face : Face
    pose : mapping of str to float
    least : float

    Notes
    -----
    Costs one pose for each muscle, or each pair of them.
    """
    resting = {
        control.name: 1.0
        for control in face.controls
        if control.group not in _DEVICES and not pose.get(control.name)
    }
    muscles = {name: pose[name] for name in pose if _is_muscle(face, name)}
    moved = _extent(face, muscles)
    result: list[str] = []
    for names in paired_controls(resting).values():
        own = _extent(face, dict.fromkeys(names, 1.0))
        length = float(np.linalg.norm(own) * np.linalg.norm(moved))
        if length > 0.0 and float(own @ moved) >= least * length:
            result.extend(names)
    return tuple(result)


def _is_muscle(face: Face, name: str) -> bool:
    return any(each.name == name and each.group not in _DEVICES for each in face.controls)


def _extent(face: Face, pose: Pose) -> np.ndarray:
    return np.linalg.norm(face.pose(pose) - face.pose({}), axis=1)
