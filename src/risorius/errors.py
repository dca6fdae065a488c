"""Error classes of risorius.

Every message says what is wrong, where, which rule it breaks and what to do about it.
"""

from __future__ import annotations

__all__ = [
    "Cancelled",
    "FormatError",
    "LandmarkError",
    "MeshError",
    "ParameterError",
    "RisoriusError",
    "RisoriusWarning",
    "ShapeError",
    "SolverError",
]


class RisoriusError(Exception):
    """Base class of every error that risorius raises on purpose."""


class ShapeError(RisoriusError, ValueError):
    """An array has the wrong shape, type or size."""


class ParameterError(RisoriusError, ValueError):
    """A parameter lies outside its range or names something that does not exist."""


class FormatError(RisoriusError):
    """A file does not follow its format; the message names path, place and expectation."""


class LandmarkError(RisoriusError):
    """Landmarks are missing, swapped or contradictory; the message names them."""


class MeshError(RisoriusError):
    """A mesh cannot be used; the message names the offending elements."""


class SolverError(RisoriusError):
    """A solver failed; the message gives iteration and residual."""


class RisoriusWarning(UserWarning):
    """Something was repaired or left out; the result is still usable."""


class Cancelled(RisoriusError):
    """A person stopped long work."""
