"""The ten feature points that carry muscles to another head, found on any head."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, as_points
from risorius.errors import LandmarkError
from risorius.head.head import Head
from risorius.landmarks.sides import require, sagittal_axis
from risorius.spatial.raycast import Scene

__all__ = ["FEATURE_NAMES", "FeatureSet", "find_features"]

# How far behind the outer eye corners the sides of the head are measured, share of its height.
_TEMPLE = 0.14
_NEEDED = ("2.1", "2.2", "3.7", "3.8", "3.11", "3.12", "9.3")


@dataclass(frozen=True, eq=False)
class FeatureSet:
    """Feature points of one head.

    Parameters
    ----------
    points : mapping of str to (3,) float64
        By the names of `FEATURE_NAMES`, in their order [mm, canonical frame].
    sources : mapping of str to str
        Where each comes from: a landmark's name, ``"found"`` or ``"given"``.
    """

    points: Mapping[str, FloatArray]
    sources: Mapping[str, str]

    @property
    def positions(self) -> FloatArray:
        """All points (10, 3) in the order of `FEATURE_NAMES` [mm]."""
        return np.array([self.points[name] for name in FEATURE_NAMES])

    @property
    def width(self) -> float:
        """Distance of the two sides of the head [mm]."""
        return float(np.linalg.norm(self.points["head_left"] - self.points["head_right"]))

    def edited(self, given: Mapping[str, npt.ArrayLike]) -> FeatureSet:
        """Return the set with some points put elsewhere.

        Parameters
        ----------
        given : mapping of str to (3,) array_like
            Places [mm, canonical frame].

        Raises
        ------
        LandmarkError
            If a name is unknown, or left and right change sides.
        """
        unknown = sorted(set(given) - set(FEATURE_NAMES))
        if unknown:
            raise LandmarkError(
                f"feature points: {', '.join(unknown)} is none of {', '.join(FEATURE_NAMES)}"
            )
        rows = {name: as_points(name, np.atleast_2d(place))[0] for name, place in given.items()}
        edited = FeatureSet(
            {name: rows.get(name, self.points[name]) for name in FEATURE_NAMES},
            {name: "given" if name in rows else self.sources[name] for name in FEATURE_NAMES},
        )
        _require_sides(edited)
        return edited


def find_features(head: Head, *, given: Mapping[str, npt.ArrayLike] | None = None) -> FeatureSet:
    """Return the feature points of `head`.

    Landmarks serve where they mark the point (spec vector-muscles O5: nose tip 9.3, top 11.4,
    eye corners 3.11 and 3.8, nose 9.15, 9.1, 9.2); the rest is found on the skin by rays. The
    sides are measured at the temples: ears differ too much.

    Parameters
    ----------
    head : Head
    given : mapping of str to (3,) array_like, optional
        Points that a person knows better [mm, canonical frame].

    Raises
    ------
    LandmarkError
        If the landmarks of eyes, nose tip, lip or chin are missing, a point cannot be found, a
        name in `given` is unknown, or left and right are exchanged.
    """
    require(head.landmarks, _NEEDED, purpose="the feature points")
    points: dict[str, FloatArray] = {}
    sources: dict[str, str] = {}
    skin = _Skin(head)
    for name, (landmark, rule) in _RULES.items():
        if landmark in head.landmarks:
            points[name], sources[name] = head.landmarks.position(landmark), landmark
        else:
            points[name], sources[name] = rule(skin), "found"
    found = FeatureSet(points, sources)
    _require_sides(found)
    return found.edited(given) if given else found


class _Skin:
    """A head's skin, seen by rays along the axes of its face, so that a tilt does not matter."""

    def __init__(self, head: Head) -> None:
        self.marks = head.landmarks
        self.mesh = head.skin.mesh
        self.height = head.height
        self.scene = Scene([self.mesh])
        self.eyes = self.marks.positions(("3.7", "3.12")).mean(axis=0)
        self.across = sagittal_axis(self.marks)
        up = self.eyes - self.marks.position("2.1")
        up = up - (up @ self.across) * self.across
        self.up: FloatArray = up / np.linalg.norm(up)
        self.forward = np.asarray(np.cross(self.across, self.up), np.float64)

    def front(self, through: FloatArray) -> FloatArray:
        """Return the foremost place (3,) of the skin before or behind a place."""
        return self._first(through + 10.0 * self.height * self.forward, -self.forward)

    def side(self, sign: float) -> FloatArray:
        """Return the temple (3,) at the height of the eyes, +1 for the left one."""
        middle = self.eyes - _TEMPLE * self.height * self.forward
        outwards: FloatArray = sign * self.across
        return self._first(middle + 10.0 * self.height * outwards, -outwards)

    def top(self) -> FloatArray:
        """Return the highest vertex (3,)."""
        used = self.mesh.positions[np.unique(self.mesh.faces)]
        return used[int(np.argmax(used @ self.up))]

    def _first(self, origin: FloatArray, direction: FloatArray) -> FloatArray:
        hits = self.scene.cast(origin[None], direction)
        if not hits.hit[0]:
            raise LandmarkError(
                "feature points: the skin has a hole where one was looked for; add the landmarks "
                "11.4, 9.15, 9.1 and 9.2 or give the point by hand"
            )
        return hits.positions[0]


def _nose_root(skin: _Skin) -> FloatArray:
    return skin.front(skin.marks.positions(("3.11", "3.8")).mean(axis=0))


def _nose_base(skin: _Skin) -> FloatArray:
    tip, lip = skin.marks.position("9.3"), skin.marks.position("2.2")
    return skin.front(tip + 0.45 * (lip - tip))


def _nose_side(corner: str) -> Callable[[_Skin], FloatArray]:
    # The canon of portraits: a nose is as wide as the distance of the inner eye corners.
    def find(skin: _Skin) -> FloatArray:
        tip = skin.marks.position("9.3")
        aside = (skin.marks.position(corner) - tip) @ skin.across
        return skin.front(tip + aside * skin.across)

    return find


def _at(landmark: str) -> Callable[[_Skin], FloatArray]:
    return lambda skin: skin.marks.position(landmark)


_Rule = tuple[str, Callable[[_Skin], FloatArray]]
_RULES: Mapping[str, _Rule] = MappingProxyType(
    {
        "nose_tip": ("9.3", _at("9.3")),
        "head_top": ("11.4", _Skin.top),
        "head_right": ("", lambda skin: skin.side(-1.0)),
        "head_left": ("", lambda skin: skin.side(1.0)),
        "nose_root": ("", _nose_root),
        "socket_left": ("3.11", _at("3.11")),
        "socket_right": ("3.8", _at("3.8")),
        "nose_base": ("9.15", _nose_base),
        "nose_left": ("9.1", _nose_side("3.11")),
        "nose_right": ("9.2", _nose_side("3.8")),
    }
)
FEATURE_NAMES = tuple(_RULES)
"""The ten feature points in the order of the publication (spec vector-muscles 1)."""


def _require_sides(features: FeatureSet) -> None:
    for stem in ("head", "socket", "nose"):
        left, right = f"{stem}_left", f"{stem}_right"
        if features.points[left][0] <= features.points[right][0]:
            raise LandmarkError(
                f"feature points: {left!r} and {right!r} are swapped (left is +X); exchange them "
                "or run with --flip-landmarks"
            )
