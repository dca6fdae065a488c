"""The built-in head and the warp from it to any other head."""

from __future__ import annotations

from functools import cache
from importlib.resources import as_file, files

from risorius._check import FloatArray
from risorius.errors import LandmarkError
from risorius.head.head import Head
from risorius.landmarks.landmark_set import LandmarkSet
from risorius.warp.rbf import RbfWarp

__all__ = ["SURE_LANDMARKS", "builtin_head", "warp_between"]

SURE_LANDMARKS = (
    "2.1", "2.2", "2.3", "2.4", "2.5", "2.10", "2.13", "2.14",
    "3.1", "3.2", "3.3", "3.4", "3.7", "3.8", "3.11", "3.12",
    "4.1", "4.2", "4.3", "4.4", "4.5", "4.6",
    "8.1", "8.2", "8.3", "8.4", "9.1", "9.2", "9.3", "9.15",
)  # fmt: skip
"""Landmarks that are found alike on every head; guessed ones (cheeks, ears) spoil a warp."""


@cache
def builtin_head() -> Head:
    """Return the head that ships with risorius."""
    folder = files("risorius.anatomy").joinpath("assets")
    with as_file(folder) as path:
        return Head.load(path / "head.obj", path / "head.landmarks.json")


def warp_between(
    source: LandmarkSet | dict[str, FloatArray], target: LandmarkSet, *, minimum: int = 8
) -> RbfWarp:
    """Return the warp that carries the sure landmarks of `source` onto those of `target`.

    Parameters
    ----------
    source : LandmarkSet or mapping of str to (3,) float64
        Landmarks where points come from [mm].
    target : LandmarkSet
        Landmarks where they go, canonical frame [mm].
    minimum : int
        Fewest common landmarks.

    Raises
    ------
    LandmarkError
        If fewer are common.
    """
    names = [name for name in SURE_LANDMARKS if name in source and name in target]
    if len(names) < minimum:
        missing = [name for name in SURE_LANDMARKS if name in source and name not in target]
        raise LandmarkError(
            f"landmarks: {len(names)} in common with the built-in head, {minimum} are needed; "
            f"add some of {', '.join(missing[:12])}"
        )
    points = [
        source.position(name) if isinstance(source, LandmarkSet) else source[name] for name in names
    ]
    return RbfWarp.fit(points, target.positions(names))
