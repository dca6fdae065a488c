"""Projects: a head and everything made for it, in one text file."""

from risorius.project.assemble import (
    face_of,
    landmarks_of,
    presets_of,
    read_mesh,
    read_presets,
    read_vector_set,
    require_parameters,
    vectors_of,
)
from risorius.project.files import read_project, upgrade_project, write_project
from risorius.project.project import BUILTIN, METHODS, PROFILES, Project

__all__ = [
    "BUILTIN",
    "METHODS",
    "PROFILES",
    "Project",
    "face_of",
    "landmarks_of",
    "presets_of",
    "read_mesh",
    "read_presets",
    "read_project",
    "read_vector_set",
    "require_parameters",
    "upgrade_project",
    "vectors_of",
    "write_project",
]
