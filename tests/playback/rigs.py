"""Rigs that tests of playing share; each is baked once."""

from __future__ import annotations

from functools import cache

from risorius.controls import default_presets, list_shapes
from risorius.rig import Rig, bake
from tests.face_fixtures import builtin_face


@cache
def played_rig() -> Rig:
    """Return the built-in head with singles, emotions, ARKit and FACS by vector muscles."""
    sets = ("singles", "emotions", "arkit", "facs")
    shapes = list_shapes(builtin_face().controls, default_presets(), sets=sets)
    return bake(builtin_face(), shapes.poses)
