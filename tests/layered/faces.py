"""Layered faces that many tests look at; each is built once."""

from __future__ import annotations

from functools import cache

from risorius.anatomy.template import builtin_head
from risorius.layered import LayeredFace
from tests.face_fixtures import made_up_head, made_up_mechanics


@cache
def builtin_layered() -> LayeredFace:
    """Return the default face of the built-in head."""
    return LayeredFace.build(builtin_head())


@cache
def made_up_layered() -> LayeredFace:
    """Return the face of the synthetic head, which has no eye holes."""
    return LayeredFace.build(made_up_head(), mechanics=made_up_mechanics())
