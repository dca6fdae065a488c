"""Faces of both profiles that the acceptance tests look at; each is built once."""

from __future__ import annotations

from functools import cache

import numpy as np

from risorius.anatomy.template import builtin_head
from risorius.controls.presets import EMOTIONS, default_presets
from risorius.layered import LayeredFace
from risorius.layered.faithful import FaithfulFace

HEAD = builtin_head()
MIRROR = np.array([-1.0, 1.0, 1.0])
SMILE = {"zygomaticus_major_l": 1.0, "zygomaticus_major_r": 1.0}

Either = FaithfulFace | LayeredFace


@cache
def published() -> FaithfulFace:
    """Return the faithful face of the built-in head."""
    return FaithfulFace.build(HEAD)


@cache
def improved() -> LayeredFace:
    """Return the default face of the built-in head."""
    return LayeredFace.build(HEAD)


def face_of(profile: str) -> Either:
    """Return the face of a profile."""
    return published() if profile == "faithful" else improved()


@cache
def emotions_of(profile: str) -> dict[str, np.ndarray]:
    """Return the displacement of all input vertices in each emotion."""
    book, chosen = default_presets(), face_of(profile)
    return {
        name: chosen.displace(book.fit(book.emotions[name], chosen.controls).pose)
        for name in EMOTIONS
    }


def at(displacement: np.ndarray, landmark: str) -> np.ndarray:
    """Return how far a landmark moves."""
    return displacement[HEAD.skin.first_source()][HEAD.skin_vertex(landmark)]
