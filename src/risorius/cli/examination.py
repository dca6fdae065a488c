"""Examine a head step by step, as far as it goes."""

from __future__ import annotations

from collections.abc import Mapping
from textwrap import shorten
from typing import Any

from risorius.anatomy.mechanics import Mechanics
from risorius.cli.features import FEATURES, PARTS
from risorius.cli.sources import read_head
from risorius.cli.talk import Talk
from risorius.controls.shape_sets import list_shapes
from risorius.errors import RisoriusError
from risorius.head.eyes import find_head_lids
from risorius.head.head import Head
from risorius.landmarks import LandmarkSpec, feature_points
from risorius.mesh.core import TriMesh
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.mesh.topology import report
from risorius.project import Project, face_of, landmarks_of, presets_of, read_mesh

__all__ = ["examine"]


def examine(project: Project, talk: Talk) -> str | None:
    """Say everything about the head of a project that can be found out.

    Returns
    -------
    str or None
        Why the head cannot be rigged; None if it can.

    Raises
    ------
    FormatError
        If a file is missing or malformed.
    """
    mesh, carried = read_mesh(project)
    _names(mesh, talk)
    try:
        specs = landmarks_of(project, carried)
        _landmarks(specs, talk)
        head = read_head(project, talk)
    except RisoriusError as error:
        _topology(mesh.tri_mesh(), "whole mesh", talk)
        return str(error)
    _parts(head, talk)
    _topology(head.skin.mesh, "skin, seams welded", talk)
    try:
        _shapes(project, head, talk)
    except RisoriusError as error:
        return str(error)
    return None


def _names(mesh: PolygonMesh, talk: Talk) -> None:
    for kind, labels in (
        ("objects", mesh.objects),
        ("groups", mesh.groups),
        ("materials", mesh.materials),
    ):
        talk.put(**{kind: list(labels.names)})
        if labels.names:
            shown = ", ".join(labels.names[:12])
            more = f" and {len(labels.names) - 12} more" if len(labels.names) > 12 else ""
            talk.say(f"{kind}: {shown}{more}")


def _landmarks(specs: Mapping[str, LandmarkSpec], talk: Talk) -> None:
    described = feature_points()
    talk.say(f"landmarks: {len(specs)} given")
    rows: list[dict[str, Any]] = []
    for feature in FEATURES:
        missing = [name for name in feature.names if name not in specs]
        rows.append(
            {
                "feature": feature.name,
                "required": feature.required,
                "missing": missing,
                "without": feature.without,
            }
        )
        if not missing:
            talk.say(f"  {feature.name}: all {len(feature.names)}")
            continue
        lacking = f"{len(missing)} of {len(feature.names)} missing"
        talk.say(f"  {feature.name}: {lacking}; without them {feature.without}")
        for name in missing:
            talk.say(f"    {name}  {described[name].description}")
    talk.put(landmarks=sorted(specs), features=rows)


def _parts(head: Head, talk: Talk) -> None:
    missing = {kind: without for kind, without in PARTS.items() if kind not in head.parts}
    talk.put(missing_parts=missing)
    for kind, without in missing.items():
        talk.say(f"  no {kind}: {without}")


def _topology(mesh: TriMesh, what: str, talk: Talk) -> None:
    found = report(mesh)
    talk.put(
        topology={
            "of": what,
            "vertices": found.vertex_count,
            "edges": found.edge_count,
            "triangles": found.face_count,
            "pieces": found.component_count,
            "boundary_loops": [len(loop) for loop in found.boundary_loops],
            "euler": found.euler,
            "genus": found.genus,
            "non_manifold_edges": len(found.non_manifold_edges),
            "non_manifold_vertices": len(found.non_manifold_vertices),
            "inconsistent_edges": len(found.inconsistent_edges),
            "degenerate_faces": len(found.degenerate_faces),
            "duplicate_faces": len(found.duplicate_faces),
            "unused_vertices": len(found.unused_vertices),
        }
    )
    talk.say(f"topology ({what}):")
    for sentence in found.sentences():
        talk.say(f"  {shorten(sentence, 120, placeholder=' ...')}")


def _shapes(project: Project, head: Head, talk: Talk) -> None:
    notes: list[str] = []
    with talk.stage("parts+lips+lids"):
        find_head_lids(head, notes=notes)
    for note in notes:
        talk.note(note)
    with talk.stage("parts+lips+lids"):
        mechanics = Mechanics.build(head)
    for note in mechanics.notes:
        talk.note(note)
    with talk.stage("muscles"):
        face = face_of(project, head, mechanics=mechanics)
    shapes = list_shapes(face.controls, presets_of(project), sets=project.shapes)
    talk.put(
        lids=sorted(mechanics.lids),
        controls=[control.name for control in face.controls],
        shapes=list(shapes.poses),
        left_out=dict(shapes.left_out),
    )
    talk.say(f"shapes: {len(shapes.poses)} can be made, {len(shapes.left_out)} left out")
    for name, reason in shapes.left_out.items():
        talk.say(f"  {name}: {reason}")
