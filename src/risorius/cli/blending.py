"""Write blends of emotions: as a stream, or as a preset."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from risorius.cli.outputs import require_json_output
from risorius.cli.talk import Talk
from risorius.controls.presets import EMOTIONS, parse_presets
from risorius.controls.standard import (
    MUSCLES,
    SINGLE_MUSCLES,
    controls_of_muscles,
    device_controls,
    sided,
)
from risorius.errors import ParameterError
from risorius.io.atomic import write_json
from risorius.io.motion import write_stream
from risorius.playback.emotion_timing import Timing, blended_pose, emotion_stream
from risorius.project.preset_document import presets_document, with_emotions

__all__ = ["write_blend", "write_preset"]


def write_blend(
    intensities: Mapping[str, float], timing: Timing, rate: float, path: Path, talk: Talk
) -> None:
    """Write the stream of emotions that come, stay and go, and say so.

    Raises
    ------
    RisoriusError
        If an emotion is unknown, a number out of range, or the file cannot be written.
    """
    stream = emotion_stream(intensities, timing=timing, rate=rate)
    count = write_stream(stream, path)
    talk.put(output=path, frames=count, rate=rate, duration=timing.duration)
    talk.say(f"wrote {path}: {count} frames, {timing.duration:.2f} s")


def write_preset(
    intensities: Mapping[str, float], name: str, base: Path | None, path: Path, talk: Talk
) -> None:
    """Write the presets of `base` (those that ship if None) with a blend as one more expression.

    Raises
    ------
    RisoriusError
        If an emotion or a number is refused, the name is taken, or a file cannot be read or
        written.
    """
    require_json_output(path)
    if not name.isidentifier():
        raise ParameterError(
            f"preset: {name!r} is no name of a shape; use letters, digits and _, such as delight"
        )
    document = presets_document(base)
    book = parse_presets(document, source=str(base or "presets.json"))
    if name in EMOTIONS or name in book.arkit:
        raise ParameterError(f"preset: {name!r} is the name of a standard shape; choose another")
    muscles = (*SINGLE_MUSCLES, *(full for muscle in MUSCLES for full in sided(muscle)))
    controls = (*controls_of_muscles(muscles), *device_controls())
    document = with_emotions(document, {name: blended_pose(book, intensities, controls)})
    pose = document["emotions"][name]
    write_json(path, document)
    talk.put(output=path, preset=name, pose=pose)
    talk.say(f"wrote {path}: {name} of {len(pose)} controls; risorius rig HEAD --presets {path}")
