"""What the pages see of the face beside its sliders, as messages of the stream."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius.controls.control import Pose
from risorius.studio import frames
from risorius.studio.drawing.spring_feedback import influence_colours
from risorius.studio.heat import heat_of, paint
from risorius.studio.moment import Moment, Played
from risorius.studio.scene import Stage

__all__ = ["Show", "facts_of", "frame_of"]


@dataclass(frozen=True, eq=False)
class Show:
    """What the face shows now, beside the sliders.

    Parameters
    ----------
    heat : str
        One of `HEATS`.
    selected : str
        Muscle, with or without side; empty for none.
    influenced : str
        Spring muscle, with side, whose skin is painted; empty for none.
    played : callable or None
        Gives what stands in for the pose, while a stream plays for example.
    """

    heat: str = "none"
    selected: str = ""
    influenced: str = ""
    played: Played | None = None


def facts_of(stage: Stage) -> dict[str, Any]:
    """Return where a camera looks: the middle of the head, its height, eyes and mouth [mm]."""
    head = stage.subject.head
    marks = head.landmarks
    low, high = (marks.position(name) if name in marks else None for name in ("2.1", "11.1"))
    if low is None or high is None:
        points = head.skin.mesh.positions
        low, high = points.min(axis=0), points.max(axis=0)
    else:
        top = float(head.skin.mesh.positions[:, 1].max())  # landmarks of the crown are guesses
        high = np.array([high[0], max(top, high[1]), high[2]])
    centre = 0.5 * (low + high)
    eyes = [name for name in ("3.7", "3.11", "3.8", "3.12") if name in marks]
    mouth = [name for name in ("8.3", "8.4") if name in marks]
    spots = {"eyes": eyes, "mouth": mouth}
    return {
        "centre": [0.0, float(centre[1]), float(centre[2]) - 0.2 * head.height],
        "height": float(np.linalg.norm(high - low)),
        "spots": {
            name: marks.positions(found).mean(axis=0).tolist()
            for name, found in spots.items()
            if found
        },
    }


def frame_of(
    stage: Stage, pose: Pose, show: Show, groups: set[str], numbers: tuple[int, int]
) -> bytes:
    """Return the message that shows a pose.

    Parameters
    ----------
    stage : Stage
    pose : mapping of str to float
        Of controls that the face has.
    show : Show
    groups : set of str
        That move.
    numbers : tuple of int
        Epoch and serial.
    """
    face = stage.subject.face
    if show.played is None:
        moment = Moment(stage.posed(pose, face.pose(pose), groups))
    else:
        moment = show.played(stage, groups)
    rest = {each.name: each.mesh.positions for each in stage.meshes}
    colour = _skin_colour(stage, show, moment)
    colours = {} if colour is None else {"skin": colour}
    return frames.frame(rest, moment, epoch=numbers[0], serial=numbers[1], paint=colours)


def _skin_colour(stage: Stage, show: Show, moment: Moment) -> npt.NDArray[np.uint8] | None:
    subject = stage.subject
    if show.heat != "none":
        names = (show.selected,) if show.selected else ()
        heat = heat_of(show.heat, subject, moment.meshes["skin"], muscles=names)
        return None if heat is None else paint(heat[0], heat[1])
    skin = stage.mesh("skin")
    if show.influenced and subject.spring_face is not None and skin is not None:
        return influence_colours(subject.spring_face, show.influenced, skin.colour)
    return None
