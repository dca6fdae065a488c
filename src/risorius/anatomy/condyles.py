"""Where the condyles of a head are: the hinge of its jaw."""

from __future__ import annotations

import warnings
from functools import cache
from importlib.resources import as_file, files

import numpy as np

from risorius import _formats
from risorius._check import FloatArray
from risorius.anatomy.template import builtin_head, warp_between
from risorius.errors import RisoriusWarning
from risorius.head.head import Head
from risorius.landmarks.landmark_set import LandmarkSet, resolve

__all__ = ["builtin_condyles", "condyles"]

# The skin point over a condyle lies this far outside the joint's middle [mm].
_TISSUE = 14.0
_CONDYLES = ("condyle_l", "condyle_r")


@cache
def _builtin_skull_landmarks() -> LandmarkSet:
    folder = files("risorius.anatomy").joinpath("assets")
    with as_file(folder) as path, warnings.catch_warnings():
        # Bone landmarks are no feature points of a face, which the reader would warn of.
        warnings.simplefilter("ignore", RisoriusWarning)
        mesh, _ = _formats.read_head(path / "skull.obj")
        specs = _formats.read_landmarks(path / "skull.landmarks.json")
        return resolve({name: specs[name] for name in _CONDYLES}, mesh)


def builtin_condyles() -> tuple[FloatArray, FloatArray]:
    """Return the left and right condyle (3,) of the built-in skull, in the built-in head's
    canonical frame [mm].
    """
    marks = _builtin_skull_landmarks()
    # Skull and head are modelled in one space; the head's frame moves it to the eyes.
    left, right = builtin_head().frame.to_canonical(marks.positions(_CONDYLES))
    return left, right


def condyles(head: Head) -> tuple[FloatArray, FloatArray]:
    """Return the left and right condyle (3,) of a head [mm].

    The head's own landmarks ``condyle_l`` and ``condyle_r`` (on the skin) if it has them, else
    those of the built-in skull carried over by the landmarks that both heads have.
    """
    if "condyle_l" in head.landmarks and "condyle_r" in head.landmarks:
        left, right = head.landmarks.positions(_CONDYLES)
        inwards = np.array([_TISSUE, 0.0, 0.0])
        return left - inwards, right + inwards
    warp = warp_between(builtin_head().landmarks, head.landmarks)
    left, right = warp(np.stack(builtin_condyles()))
    return left, right
