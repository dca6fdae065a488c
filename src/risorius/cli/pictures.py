"""Load what is to be drawn, and draw it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from risorius._check import one_of
from risorius.cli.sources import (
    Given,
    bake_head,
    is_rig,
    load_rig,
    read_head,
    require_shapes,
    resolve,
)
from risorius.cli.talk import Talk, Tick
from risorius.errors import ParameterError
from risorius.render.heads import Portrait
from risorius.render.png import write_png
from risorius.render.rig_sheet import view_sheet
from risorius.render.views import VIEWS
from risorius.rig.bake import empty_rig
from risorius.rig.rig import Rig

__all__ = ["Shot", "draw", "subject_of"]


@dataclass(frozen=True)
class Shot:
    """What a picture shows.

    Parameters
    ----------
    views : tuple of str
    weights : mapping of str to float
        Pose: target name -> weight.
    size : (width, height)
        In pixels.
    yaw, pitch : float or None
        Turn of the camera instead of the view's own [deg].
    """

    views: tuple[str, ...]
    weights: Mapping[str, float]
    size: tuple[int, int]
    yaw: float | None = None
    pitch: float | None = None

    def __post_init__(self) -> None:
        if not self.views:
            raise ParameterError(f"view: give at least one of {', '.join(VIEWS)}")
        for view in self.views:
            one_of("view", view, tuple(VIEWS))


def subject_of(name: str, given: Given, talk: Talk, *, needs: Sequence[str] | None) -> Rig:
    """Return the rig called `name`, or make one of the head called so.

    Parameters
    ----------
    name : str
        File, folder or ``"builtin"``.
    given : Given
    talk : Talk
    needs : sequence of str or None
        Targets that will be shown; None for all.

    Raises
    ------
    RisoriusError
        If it cannot be read or made.
    """
    if is_rig(name):
        with talk.stage("read"):
            rig = load_rig(name, given.landmarks, flip_landmarks=given.flip_landmarks)
        if rig.targets or needs == ():
            require_shapes(needs or (), rig.by_name, rig.left_out)
            return rig
    project = resolve(name, given)
    if needs == ():
        return empty_rig(read_head(project, talk))
    return bake_head(project, talk, only=needs).rig


def draw(rig: Rig, shot: Shot, path: Path, tick: Tick) -> None:
    """Write the picture of a rig."""
    first, *others = shot.views
    if others:
        poses = {", ".join(shot.weights) or "neutral": shot.weights}
        page = view_sheet(rig, poses, shot.views, cell=min(shot.size), progress=tick)
        write_png(path, page)
        return
    portrait = Portrait.of(rig)
    width, height = shot.size
    camera = portrait.camera(first, yaw=shot.yaw, pitch=shot.pitch, aspect=width / height)
    picture = portrait.picture(camera, size=shot.size, weights=shot.weights, supersample=3)
    write_png(path, picture)
