"""From the face at hand to a rig, as `risorius rig` makes it, with progress that can be stopped."""

from __future__ import annotations

from collections.abc import Sequence

from risorius.controls.shape_sets import SOLVED_SETS, list_shapes
from risorius.playback.solved_sets import with_solved_sets
from risorius.rig.bake import bake
from risorius.rig.rig import Rig
from risorius.studio.jobs import Job
from risorius.studio.subject import Subject

__all__ = ["bake_subject"]


def bake_subject(subject: Subject, sets: Sequence[str], job: Job) -> Rig:
    """Bake sets of shapes, and every pose that a person keeps under its name.

    Raises
    ------
    RisoriusError
        If a set is unknown.
    Cancelled
        If a person stopped it.
    """
    face = subject.face
    shapes = list_shapes(face.controls, subject.presets, sets=sets)
    if set(sets) & set(SOLVED_SETS):
        job.step("solve")
        shapes = with_solved_sets(shapes, face, sets, progress=job.tick)
    poses = dict(shapes.poses)
    for name, pose in subject.work.poses.items():
        fitted = subject.presets.fit(pose, face.controls).pose
        poses[name if name not in poses else f"my {name}"] = fitted
    job.step("bake")
    return bake(face, poses, left_out=shapes.left_out, upon=shapes.upon, progress=job.tick)
