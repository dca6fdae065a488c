"""How parts of a head look, by their name; how an eyeball is painted."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, as_number, as_points
from risorius.errors import ShapeError
from risorius.render.colours import RGB, linear_rgb

__all__ = ["IRIS", "SKIN", "colour_of_material", "eye_paint", "look_of_material"]


@dataclass(frozen=True)
class _Look:
    stems: tuple[str, ...]
    code: str
    specular: float = 0.4
    gloss: float = 0.3
    opacity: float = 1.0


_FACE = ("skin", "head", "face", "body", "neck", "ear", "nose", "scalp", "bust")
_AROUND_EYE = ("lid", "eyelid", "socket", "eyesocket")
_SKIN = _Look((*_FACE, *_AROUND_EYE), "#d6a68f")
# The first look with a stem that begins a word of the name decides, so the special come first.
# Lashes are drawn thin: most heads have cards there that a texture would cut into hairs.
_LOOKS = (
    _Look(("lash", "eyelash", "cilia", "brow", "eyebrow"), "#2b211d", 0.0, 0.2, 0.07),
    _Look(("lip", "vermilion"), "#b9746a", 0.5, 0.4),
    _Look(("teeth", "tooth", "dent", "incisor", "molar", "canine"), "#e6dcc6", 0.6, 0.6),
    _Look(("gum", "gingiva"), "#b9706a", 0.6, 0.55),
    _Look(("tongue", "lingua"), "#b96864", 0.6, 0.45),
    _Look(("mouth", "bag", "oral", "palate", "throat"), "#8a4642", 0.5, 0.4),
    _Look(("pupil",), "#0b0a0a", 0.7, 0.8),
    _Look(("iris",), "#5d7d8c", 0.7, 0.8),
    _SKIN,
    _Look(("eye", "sclera", "cornea", "lens"), "#eeeae4", 0.7, 0.8),
    _Look(("skull", "cranium", "mandible", "jaw", "bone", "maxilla"), "#ded3bd", 0.25, 0.25),
    _Look(("muscle",), "#a8413a", 0.4, 0.35),
)
_UNKNOWN = _Look((), "#b4aea8")
_WORDS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")

SKIN: RGB = linear_rgb(_SKIN.code)
"""Linear RGB of skin, the default colour of a surface."""
IRIS: RGB = linear_rgb("#5d7d8c")
"""Linear RGB of the iris, unless another is given."""


def _look(name: str) -> _Look:
    words = [word.lower() for word in _WORDS.findall(name)]
    for look in _LOOKS:
        if any(word.startswith(stem) for word in words for stem in look.stems):
            return look
    return _UNKNOWN


def colour_of_material(name: str) -> RGB:
    """Return the linear RGB in 0..1 that a part or material called `name` is drawn in.

    Known are skin, lips or vermilion, mouth or bag, eye or sclera, iris, pupil, teeth, gums,
    tongue, lashes, bones and muscles, within names of any case (``"teeth_upper"``,
    ``"LipLower"``); anything else is grey.
    """
    return linear_rgb(_look(name).code)


def look_of_material(name: str) -> dict[str, Any]:
    """Return colour, specular, gloss and opacity for a part or material called `name`.

    They are parameters of `Surface`: ``Surface.of(mesh, **look_of_material("tongue"))``.
    """
    look = _look(name)
    return {
        "colour": linear_rgb(look.code),
        "specular": look.specular,
        "gloss": look.gloss,
        "opacity": look.opacity,
    }


def eye_paint(
    positions: npt.ArrayLike,
    *,
    forward: npt.ArrayLike = (0.0, 0.0, 1.0),
    iris: npt.ArrayLike = IRIS,
    iris_degrees: float = 29.0,
    pupil_degrees: float = 11.0,
) -> tuple[FloatArray, FloatArray]:
    """Paint pupil, iris and sclera on an eyeball that has no texture.

    The ramp runs along the angle from `forward`, seen from the centre of the sphere that fits
    `positions` best, so that the iris is round however coarse the eyeball is.

    Parameters
    ----------
    positions : (n, 3) array_like
        Eyeball at rest [mm]; reuse the result for the turned eye.
    forward : (3,) array_like
        Direction of the gaze at rest.
    iris : (3,) array_like
        Linear RGB of the iris.
    iris_degrees, pupil_degrees : float
        Radii as angles at the centre [deg].

    Returns
    -------
    colour : (n, 3) float64
    ramp : (k, 3) float64
        For `Surface`.
    """
    points = as_points("positions", positions)
    axis = np.asarray(forward, dtype=np.float64)
    if len(points) < 4 or axis.shape != (3,) or not np.linalg.norm(axis) > 0.0:
        raise ShapeError("eye: expected at least 4 positions and a forward direction (3,)")
    origin = points.mean(axis=0)
    local = points - origin
    system = np.column_stack([2.0 * local, np.ones(len(local))])
    centre = np.linalg.lstsq(system, (local**2).sum(axis=1), rcond=None)[0][:3]
    ray = local - centre
    axis = axis / np.linalg.norm(axis)
    aside = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    aside /= np.linalg.norm(aside)
    colour = ray @ np.stack([aside, np.cross(axis, aside), axis], axis=1)
    colour /= max(float(np.linalg.norm(colour, axis=1).max()), 1e-300)
    return colour, _eye_ramp(iris, iris_degrees, pupil_degrees)


def _eye_ramp(iris: npt.ArrayLike, iris_degrees: float, pupil_degrees: float) -> FloatArray:
    """Return the colours over 0..180 degrees from the middle of the pupil, (721, 3)."""
    iris_degrees = as_number("iris_degrees", iris_degrees, low=1.0, high=80.0)
    pupil_degrees = as_number("pupil_degrees", pupil_degrees, low=0.0, high=iris_degrees)
    tone = as_points("iris", np.atleast_2d(iris))[0]
    black, white, rose = (np.array(linear_rgb(c)) for c in ("#0b0a0a", "#eeeae4", "#d9a79c"))
    soft = 1.2
    middle = 0.5 * (pupil_degrees + iris_degrees)
    pupil_stops = [0.0, pupil_degrees - soft, pupil_degrees + soft]
    iris_stops = [middle, iris_degrees - 3.0 * soft, iris_degrees]
    stops = np.array([*pupil_stops, *iris_stops, iris_degrees + soft, 100.0, 180.0])
    keys = np.stack(
        [black, black, 1.25 * tone, tone, 0.7 * tone, 0.2 * tone, white, rose, rose]
    ).clip(0.0, 1.0)
    # Narrow irises have no room for all stops: those that would go back are passed over.
    stops = np.maximum.accumulate(stops)
    grid = np.linspace(0.0, 180.0, 721)
    return np.stack([np.interp(grid, stops, keys[:, channel]) for channel in range(3)], axis=1)
