"""What is inspected: a rig, its head rebuilt from it, and its motion on the welded skin."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from risorius._check import BoolArray, FloatArray
from risorius.errors import LandmarkError, MeshError
from risorius.head.eyes import find_head_lids
from risorius.head.head import Head
from risorius.head.mouth import find_head_lips
from risorius.head.part import PART_KINDS, Part
from risorius.head.weld_parts import build_parts
from risorius.landmarks.landmark_set import LandmarkSpec, resolve
from risorius.mesh.lids import LidMargins
from risorius.mesh.lips import LipSides
from risorius.rig.rig import Rig

__all__ = ["Subject", "part_deltas", "subject_of"]

# How far behind their contact lines the lips still show when the mouth opens [mm].
_SHOWN = 3.0


@dataclass(frozen=True, eq=False)
class Subject:
    """A rig bound to its head.

    Parameters
    ----------
    rig : Rig
    head : Head or None
        None without landmarks: then only measures that need no anatomy exist.
    lips : LipSides or None
        On the head's skin.
    lids : mapping of str to LidMargins
        By side, ``"l"`` and ``"r"``.
    notes : tuple of str
        What cannot be measured, and why.
    """

    rig: Rig
    head: Head | None
    lips: LipSides | None
    lids: Mapping[str, LidMargins]
    notes: tuple[str, ...]

    @cached_property
    def hidden(self) -> BoolArray:
        """(w,) mask of the skin that lies inside: mouth bag, inner lips, eye sockets."""
        count = 0 if self.head is None else self.head.skin.vertex_count
        mask = np.zeros(count, bool)
        if self.lips is not None:
            mask |= self.lips.inside
        for margins in self.lids.values():
            mask |= margins.slit.inside
        return mask

    @property
    def visible(self) -> BoolArray:
        """(w,) mask of the skin that shows, with the first 3 mm of the inner lips."""
        mask = ~self.hidden
        if self.lips is not None:
            mask |= self.lips.inside & (self.lips.distance < _SHOWN)
        return mask


def part_deltas(rig: Rig, head: Head, part: Part) -> FloatArray:
    """Return the displacements (s, w, 3) [mm] of one part's welded vertices in all shapes."""
    result = np.zeros((len(rig.targets), part.vertex_count, 3))
    first = part.first_source()
    row_of = np.full(head.vertex_count, -1, np.int32)
    row_of[first] = np.arange(len(first))
    for shape, target in enumerate(rig.targets):
        rows = row_of[target.vertices]
        kept = rows >= 0
        result[shape, rows[kept]] = target.deltas[kept]
    return head.frame.vectors_to_canonical(result)


def subject_of(rig: Rig, landmarks: Mapping[str, LandmarkSpec] | None) -> Subject:
    """Rebuild the head of a rig and find its lips and lids, as far as its landmarks allow.

    Parameters
    ----------
    rig : Rig
    landmarks : mapping of str to LandmarkSpec or None
        Of the rig's mesh; None for those that the rig carries.
    """
    specs = rig.landmarks if landmarks is None else landmarks
    notes: list[str] = []
    if not specs:
        notes.append(
            "no landmarks: lip seam, lids, penetration, still zones and symmetry not measured; "
            "lengths are in the file's unit"
        )
        return Subject(rig, None, None, {}, tuple(notes))
    try:
        head = _carried_head(rig) if landmarks is None and rig.part_names else None
        head = head or Head.from_mesh(rig.mesh, specs)
    except (LandmarkError, MeshError) as error:
        notes.append(
            f"{error}: lip seam, lids, penetration, still zones and symmetry not measured; "
            "lengths are in the file's unit"
        )
        return Subject(rig, None, None, {}, tuple(notes))
    lips = None
    try:
        lips = find_head_lips(head)
    except (LandmarkError, MeshError) as error:
        notes.append(f"lip seam not measured: {error}")
    lid_notes: list[str] = []
    lids = find_head_lids(head, notes=lid_notes)
    notes.extend(f"lid gap not measured: {note}" for note in lid_notes)
    return Subject(rig, head, lips, lids, tuple(notes))


def _carried_head(rig: Rig) -> Head | None:
    """Return the head from the parts, landmarks and frame that a rig of our own carries."""
    if "skin" not in rig.part_names or len(rig.part_of_vertex) != rig.mesh.vertex_count:
        return None
    if not set(rig.part_names) <= set(PART_KINDS):
        return None
    mesh = rig.mesh
    positions = rig.frame.to_canonical(mesh.positions)
    marks = resolve(rig.landmarks, mesh).at(positions)
    number = np.array([PART_KINDS.index(name) for name in rig.part_names] + [-1], np.int32)
    kinds = np.full(mesh.polygon_count, -1, np.int32)
    owning = np.diff(mesh.offsets) > 0
    kinds[owning] = number[rig.part_of_vertex[mesh.corners[mesh.offsets[:-1][owning]]]]
    parts = build_parts(mesh, positions, kinds, marks)
    return Head(mesh, rig.frame, parts, marks) if "skin" in parts else None
