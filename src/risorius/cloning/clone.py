"""Clone: a rig becomes a rig on another head."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from risorius._check import FloatArray
from risorius.cloning.cloning import Cloning, Progress
from risorius.cloning.parameters import CloneParameters
from risorius.cloning.report import CloneReport, ShapeReport
from risorius.errors import LandmarkError, ParameterError
from risorius.head.head import Head
from risorius.mesh.normals import face_normals
from risorius.rig.bake import empty_rig
from risorius.rig.rig import MorphTarget, Rig

__all__ = ["Clone", "clone", "clone_with_report"]

# Landmarks that move less than this say nothing about direction [mm].
_MOVES = 0.5


class Clone(NamedTuple):
    """A cloned rig and its report."""

    rig: Rig
    report: CloneReport


def clone(
    rig: Rig,
    onto: Head,
    *,
    source: Head | None = None,
    parameters: CloneParameters | None = None,
    progress: Progress | None = None,
) -> Rig:
    """Return the rig of `onto` with all shapes of `rig`; see `clone_with_report`."""
    return clone_with_report(rig, onto, source=source, parameters=parameters, progress=progress).rig


def clone_with_report(
    rig: Rig,
    onto: Head,
    *,
    source: Head | None = None,
    parameters: CloneParameters | None = None,
    progress: Progress | None = None,
) -> Clone:
    """Carry every shape of a rig to another head.

    Parameters
    ----------
    rig : Rig
        Any names, any number of shapes.
    onto : Head
        The target.
    source : Head, optional
        The rig's own head; made from the landmarks that the rig carries if left out.
    parameters : CloneParameters, optional
    progress : callable, optional
        Called with (done, all, name) before each stage.

    Returns
    -------
    Clone
        The rig in the frame, unit and vertex order of `onto`, whose neutral is kept bit by bit.

    Raises
    ------
    LandmarkError
        If the rig carries no landmarks, or those of the two heads do not fit.
    ParameterError
        If the rig has no shapes.
    MeshError
        If the heads cannot be laid over each other.
    """
    if not rig.targets:
        raise ParameterError("clone: the source has no shapes; give a rig with morph targets")
    head = source or _own_head(rig)
    n = rig.mesh.vertex_count
    deltas = np.stack([target.dense(n) for target in rig.targets])
    moving = np.asarray(deltas.any(axis=(0, 2)))
    bound = Cloning.build(head, onto, moving=moving, parameters=parameters, progress=progress)
    made = bound.carry(deltas, progress=progress)
    targets = [
        MorphTarget.from_dense(target.name, moved, pose=target.pose)
        for target, moved in zip(rig.targets, made)
    ]
    result = empty_rig(onto).with_targets(
        targets, controls=rig.controls, left_out=dict(rig.left_out)
    )
    return Clone(result, _report(bound, rig.names, deltas, made))


def _own_head(rig: Rig) -> Head:
    if not rig.landmarks:
        raise LandmarkError(
            "landmarks: the source rig carries none; give its landmark file (--source-landmarks)"
        )
    return Head.from_mesh(rig.mesh, rig.landmarks)


def _report(
    bound: Cloning, names: tuple[str, ...], deltas: FloatArray, made: FloatArray
) -> CloneReport:
    skin = bound.skin
    residual = skin.residual[np.isfinite(skin.residual)]
    before = face_normals(bound.source.mesh.positions, bound.source.mesh.faces)
    turn = skin.pairs.similarity.rotation
    after = face_normals(skin.fitted.positions, skin.fitted.faces)
    seen = ~bound.source.face_inside
    folded = (np.einsum("ij,ij->i", before @ turn.T, after) < 0.0) & seen
    shapes = tuple(
        _shape(bound, name, given, moved) for name, given, moved in zip(names, deltas, made)
    )
    return CloneReport(
        landmark_count=len(skin.pairs.names),
        landmark_miss=skin.pairs.miss,
        scale=float(skin.pairs.similarity.scale),
        residual_mean=float(residual.mean()) if len(residual) else 0.0,
        residual_largest=float(residual.max(initial=0.0)),
        unmapped=int(skin.mapping.unmapped.sum()),
        folded=float(folded.mean()),
        shapes=shapes,
        notes=bound.notes,
        seconds={name: round(value, 4) for name, value in bound.seconds.items()},
    )


def _shape(bound: Cloning, name: str, given: FloatArray, moved: FloatArray) -> ShapeReport:
    source, target = bound.source.head, bound.target.head
    ours = source.frame.vectors_to_canonical(given)
    theirs = target.frame.vectors_to_canonical(moved)
    marks = bound.skin.pairs.names
    a = np.stack([source.landmarks[mark].at(ours) for mark in marks])
    a = a @ bound.skin.pairs.similarity.linear.T
    b = np.stack([target.landmarks[mark].at(theirs) for mark in marks])
    length, made = np.linalg.norm(a, axis=1), np.linalg.norm(b, axis=1)
    moves = length > _MOVES
    kept = size = None
    if moves.any():
        cosine = (a * b).sum(axis=1)[moves] / np.maximum(length * made, 1e-12)[moves]
        kept = float((cosine * length[moves]).sum() / length[moves].sum())
        size = float(made[moves].sum() / length[moves].sum())
    size_of = np.linalg.norm(theirs, axis=1)
    return ShapeReport(
        name, int((size_of > 0.0).sum()), float(size_of.max(initial=0.0)), kept, size
    )
