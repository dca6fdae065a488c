"""What cloning needs to know of a head: its skin, the contact lines of lips and lids, the sides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse.csgraph import dijkstra

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.errors import LandmarkError, MeshError
from risorius.head.eyes import find_head_lids
from risorius.head.head import Head
from risorius.head.mouth import find_head_lips
from risorius.landmarks.feature_points import feature_points
from risorius.mesh.core import TriMesh
from risorius.mesh.lids import LidMargins
from risorius.mesh.lips import LipSides
from risorius.mesh.slit import edge_graph

__all__ = ["Subject", "turned_head"]

# Vertices nearer to a lip's contact line than this share of the mouth's width have a side.
_LIP_REACH = 0.35
# ... if the other line is farther by this factor.
_CLEAR = 0.6


@dataclass(frozen=True, eq=False)
class Subject:
    """A head seen by cloning.

    Parameters
    ----------
    head : Head
    lips : LipSides or None
        None where the mouth is closed by skin.
    lids : mapping of str to LidMargins
        By side, ``"l"`` and ``"r"``.
    notes : tuple of str
        What could not be found, one sentence each.
    """

    head: Head
    lips: LipSides | None
    lids: Mapping[str, LidMargins]
    notes: tuple[str, ...]

    @staticmethod
    def bare(head: Head) -> Subject:
        """Return a head of which lips and lids are not known yet."""
        return Subject(head, None, {}, ())

    @staticmethod
    def of(head: Head, name: str, *, turn: FloatArray | None = None) -> Subject:
        """Find lips and lids of a head.

        Parameters
        ----------
        head : Head
        name : str
            Used in notes.
        turn : (3, 3) float64, optional
            Rotation of this head against the one it is compared with. The contact line of the
            lips is what turns inwards seen from the front; both heads must be seen alike.
        """
        seen = head if turn is None else turned_head(head, turn.T)
        notes: list[str] = []
        lips = None
        try:
            lips = find_head_lips(seen)
        except (LandmarkError, MeshError) as error:
            notes.append(f"{name}: lips are cloned without sides: {error}")
        said: list[str] = []
        lids = find_head_lids(seen, notes=said)
        notes.extend(f"{name}: {text}" for text in said)
        return Subject(head, lips, lids, tuple(notes))

    @property
    def mesh(self) -> TriMesh:
        """The welded skin [mm]."""
        return self.head.skin.mesh

    @cached_property
    def cavity(self) -> IntArray:
        """(n,) what the skin lines: 0 nothing, 1 the mouth, 2 the left and 3 the right socket."""
        result = np.zeros(self.mesh.vertex_count, np.int32)
        if self.lips is not None:
            result[self.lips.inside] = 1
        for side, margins in self.lids.items():
            result[margins.slit.inside] = {"l": 2, "r": 3}[side]
        return result

    @property
    def inside(self) -> BoolArray:
        """(n,) mask of the skin behind lips and lids, which nobody sees."""
        return self.cavity > 0

    @cached_property
    def side(self) -> IntArray:
        """(n,) 1 on the upper lip, -1 on the lower one, 0 away from the lips and beside corners.

        Judged by the distances along the skin to the two contact lines; near a corner, where the
        skin beside the mouth is as far from one as from the other, it belongs to neither.
        """
        result = np.zeros(self.mesh.vertex_count, np.int32)
        if self.lips is None:
            return result
        to_upper, to_lower = self.to_lines.T
        near = np.minimum(to_upper, to_lower) < _LIP_REACH * self.lips.width
        result[near & (to_upper < _CLEAR * to_lower)] = 1
        result[near & (to_lower < _CLEAR * to_upper)] = -1
        # On coarse meshes a corner may lie nearer to one line's first vertex; it belongs to both.
        result[list(self.lips.slit.corners)] = 0
        return result

    @cached_property
    def to_lines(self) -> FloatArray:
        """(n, 2) distance along the skin to the upper and to the lower lip's line [mm].

        The corners themselves are left out of the lines; infinite far from the mouth.
        """
        n = self.mesh.vertex_count
        if self.lips is None:
            return np.full((n, 2), np.inf)
        graph = edge_graph(self.mesh)
        limit = _LIP_REACH * self.lips.width / _CLEAR
        lines = (self.lips.slit.upper[1:-1], self.lips.slit.lower[1:-1])
        found = [dijkstra(graph, indices=line, min_only=True, limit=limit) for line in lines]
        return np.stack(found, axis=1)

    @cached_property
    def face_side(self) -> IntArray:
        """(m,) side of each face; 0 where its corners disagree or have none."""
        sides = self.side[self.mesh.faces]
        upper = (sides > 0).any(axis=1) & ~(sides < 0).any(axis=1)
        lower = (sides < 0).any(axis=1) & ~(sides > 0).any(axis=1)
        return np.where(upper, 1, np.where(lower, -1, 0)).astype(np.int32)

    @cached_property
    def face_inside(self) -> BoolArray:
        """(m,) mask of faces with a corner behind lips or lids."""
        return self.face_cavity > 0

    @cached_property
    def face_cavity(self) -> IntArray:
        """(m,) largest cavity number among the corners of each face."""
        return self.cavity[self.mesh.faces].max(axis=1)

    def lines(self) -> dict[str, IntArray]:
        """Return the contact lines by name, ordered vertices (k,) of the skin."""
        result: dict[str, IntArray] = {}
        if self.lips is not None:
            result["lip_upper"] = self.lips.slit.upper
            result["lip_lower"] = self.lips.slit.lower
        for side, margins in self.lids.items():
            result[f"lid_upper_{side}"] = margins.slit.upper
            result[f"lid_lower_{side}"] = margins.slit.lower
        return result

    def skin_landmarks(self) -> list[str]:
        """Return the names of landmarks that lie on the skin."""
        table = feature_points()
        return [
            name for name in self.head.landmarks if name not in table or table[name].part == "skin"
        ]


def turned_head(head: Head, rotation: FloatArray) -> Head:
    """Return a head whose parts and landmarks are turned by `rotation` (3, 3)."""

    def turned(mesh: TriMesh) -> TriMesh:
        # Rounded, so that edges that stand upright on one head do so on its turned copy.
        return TriMesh(np.round(mesh.positions @ rotation.T, 7), mesh.faces)

    parts = {kind: replace(part, mesh=turned(part.mesh)) for kind, part in head.parts.items()}
    marks = head.landmarks.at(head.positions @ rotation.T)
    return replace(head, parts=parts, landmarks=marks)
