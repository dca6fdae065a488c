"""Inspect a rig."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import numpy as np

from risorius._check import BoolArray, FloatArray
from risorius.controls.standard import device_controls
from risorius.head.head import Head
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.core import TriMesh
from risorius.mesh.welding import weld
from risorius.rig.quality.lid_gap import lid_gaps
from risorius.rig.quality.motion import Motion, cracks, motions
from risorius.rig.quality.penetration import penetrations
from risorius.rig.quality.report import QualityReport, ShapeQuality
from risorius.rig.quality.rigid import rigid_motions
from risorius.rig.quality.seam import SeamTest
from risorius.rig.quality.still import drifts, still_zone
from risorius.rig.quality.subject import Subject, part_deltas, subject_of
from risorius.rig.quality.symmetry import asymmetries, mirror_map, mirror_shape
from risorius.rig.quality.triangles import TriangleFaults, TriangleTest
from risorius.rig.rig import Rig

__all__ = ["inspect_rig"]

Progress = Callable[[int, int, str], None]

_STEPS = ("motion", "triangles", "lips", "lids", "penetration", "symmetry")


def inspect_rig(
    rig: Rig,
    *,
    landmarks: Mapping[str, LandmarkSpec] | None = None,
    progress: Progress | None = None,
) -> QualityReport:
    """Measure every shape of a rig.

    Parameters
    ----------
    rig : Rig
        Of risorius or of anybody else.
    landmarks : mapping of str to LandmarkSpec, optional
        Of the rig's mesh; those that the rig carries if left out. Without any, only what needs
        no anatomy is measured, and lengths are in the file's unit.
    progress : callable, optional
        Called with (done, all, name of the measure) before each.

    Notes
    -----
    What each number means stands where it is computed: `Motion`, `TriangleFaults`, `SeamTest`,
    `lid_gaps`, `penetrations`, `still_zone`, `asymmetries`.
    """

    def step(name: str) -> None:
        if progress is not None:
            progress(_STEPS.index(name), len(_STEPS), name)

    subject = subject_of(rig, landmarks)
    head = subject.head
    step("motion")
    motion = motions(rig, head)
    if head is None:
        step("triangles")
        return _generic(subject, motion)
    count = len(rig.targets)
    notes = list(subject.notes)
    skin = part_deltas(rig, head, head.skin)
    drift = drifts(rig, still_zone(head), head.frame.scale)
    step("triangles")
    faults = _skin_faults(subject, head, skin)
    other = _part_faults(rig, head)
    step("lips")
    seams = SeamTest(head, subject.lips).seams(skin) if subject.lips is not None else None
    step("lids")
    lids = {side: lid_gaps(head, found, side, skin) for side, found in subject.lids.items()}
    step("penetration")
    depths = penetrations(rig, head, skin, subject.visible)
    absent = [kind for kind in ("teeth", "eye") if not any(kind in part for part in depths)]
    notes.extend(f"penetration not measured for {kind}: the head has none" for kind in absent)
    step("symmetry")
    pairing = mirror_map(head.skin.mesh)
    if pairing is None:
        notes.append("symmetry not measured: the neutral skin is not symmetric")
        mirror = [None] * count
    else:
        controls = (*device_controls(), *rig.controls)
        partner_of = {name: mirror_shape(name, controls) for name in rig.names}
        mirror = asymmetries(rig.names, skin, pairing, partner_of=partner_of)
    cracked = cracks(rig, head)
    shapes = tuple(
        ShapeQuality(
            name,
            motion[s],
            cracked[s],
            *faults[s],
            other[s],
            None if seams is None else seams[s],
            {kind: found[s] for kind, found in depths.items()},
            {side: found[s] for side, found in lids.items() if found},
            drift[s],
            mirror[s],
        )
        for s, name in enumerate(rig.names)
    )
    size = _size(rig) * head.frame.scale
    return QualityReport("mm", size, head.vertex_count, shapes, tuple(notes))


def _size(rig: Rig) -> float:
    return rig.mesh.tri_mesh().size


def _generic(subject: Subject, motion: Iterable[Motion]) -> QualityReport:
    """Report what needs no anatomy."""
    rig = subject.rig
    joined = weld(rig.mesh.positions)
    mesh = TriMesh(rig.mesh.positions[joined.first], joined.faces(rig.mesh.triangles))
    test = TriangleTest(mesh)
    everything = [np.ones(mesh.face_count, bool)]
    none = TriangleFaults()
    shapes: list[ShapeQuality] = []
    for target, moved in zip(rig.targets, motion):
        deltas = target.dense(rig.mesh.vertex_count)[joined.first]
        faults = test.faults(deltas, everything)[0]
        shapes.append(
            ShapeQuality(target.name, moved, None, faults, none, none, None, {}, {}, None, None)
        )
    return QualityReport(
        "file unit", _size(rig), rig.mesh.vertex_count, tuple(shapes), subject.notes
    )


def _skin_faults(
    subject: Subject, head: Head, skin: FloatArray
) -> list[tuple[TriangleFaults, TriangleFaults]]:
    """Judge the faces of the skin: (visible, hidden) in every shape."""
    mesh = head.skin.mesh
    inside: BoolArray = np.asarray(np.any(subject.hidden[mesh.faces], axis=1))
    test = TriangleTest(mesh)
    result: list[tuple[TriangleFaults, TriangleFaults]] = []
    for deltas in skin:
        visible, hidden = test.faults(deltas, [~inside, inside])
        result.append((visible, hidden))
    return result


def _part_faults(rig: Rig, head: Head) -> list[TriangleFaults]:
    """Judge the faces of all parts but the skin, together, in every shape."""
    total = np.zeros((len(rig.targets), 3), np.int64)
    for kind, part in head.parts.items():
        if kind == "skin":
            continue
        test = TriangleTest(part.mesh)
        everything = [np.ones(part.mesh.face_count, bool)]
        deltas = part_deltas(rig, head, part)
        # A part that moves as a rigid body, as most do, keeps its triangles.
        bent = np.flatnonzero(~rigid_motions(part.mesh.positions, deltas).fits)
        for shape in bent.tolist():
            found = test.faults(deltas[shape], everything)[0]
            total[shape] += (found.inverted, found.collapsed, found.stretched)
    return [TriangleFaults(*row) for row in total.tolist()]
