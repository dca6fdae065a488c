"""The layered anatomical face: muscles in layers on a skull move the skin."""

from risorius.layered.face import LayeredFace
from risorius.layered.muscle_map import (
    MuscleMap,
    default_muscle_map,
    parse_muscle_map,
    read_muscle_map,
)
from risorius.layered.solve import Solved, landmark_target, solve_pose

__all__ = [
    "LayeredFace",
    "MuscleMap",
    "Solved",
    "default_muscle_map",
    "landmark_target",
    "parse_muscle_map",
    "read_muscle_map",
    "solve_pose",
]
