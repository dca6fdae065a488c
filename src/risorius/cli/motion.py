"""Open streams and rigs for `play` and `convert`, write what they give, and say so."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from risorius.cli.outputs import is_folder_output, require_rig_output
from risorius.cli.pictures import subject_of
from risorius.cli.sources import Given
from risorius.cli.talk import Talk
from risorius.cli.written import size_of
from risorius.controls.presets import default_presets
from risorius.controls.stream import Stream
from risorius.errors import FormatError
from risorius.io.gltf.write import write_glb
from risorius.io.motion import read_stream
from risorius.playback.conversion import ConversionError
from risorius.playback.pictures import Film, has_ffmpeg, write_film, write_pictures
from risorius.playback.player import Player
from risorius.project import read_presets

__all__ = ["open_player", "say_error", "say_unmatched", "write_motion"]

_FILM = ".mp4"
_FIGURES = 8


def open_player(
    rig: str,
    stream: Path,
    output: Path | None,
    given: Given,
    talk: Talk,
    *,
    sampling: Callable[[Stream], Stream],
) -> Player:
    """Return a stream bound to a rig; refuses before the long work what cannot end well.

    Parameters
    ----------
    rig : str
        Rig, head, project or ``"builtin"``.
    stream : Path
    output : Path or None
        Where motion shall go; checked first.
    given : Given
    talk : Talk
    sampling : callable
        Resamples the stream.

    Raises
    ------
    RisoriusError
        If something of it is refused.
    """
    if output is not None:
        _require_output(output)
    found = sampling(read_stream(stream))
    presets = default_presets() if given.presets is None else read_presets(given.presets)
    subject = subject_of(rig, given, talk, needs=None)
    talk.say(f"{stream}: {found.rate:g} frames per second")
    return Player(subject, found, presets=presets)


def _require_output(path: Path) -> None:
    ending = path.suffix.lower()
    if is_folder_output(str(path)):
        if not path.parent.is_dir():
            raise FormatError(f"{path}: the folder {path.parent} does not exist; create it first")
    elif ending == _FILM:
        if not has_ffmpeg():
            raise FormatError(
                f"{path}: a film needs the program ffmpeg, which is not installed; install it, or "
                f"give a folder for PNG frames, such as {path.with_suffix('')}"
            )
    elif ending == ".glb":
        require_rig_output(str(path))
    else:
        raise FormatError(
            f"{path}: {ending!r} is no ending of motion; known: .glb .mp4, or a folder for PNG "
            "frames (`risorius convert` writes streams)"
        )


def write_motion(player: Player, path: Path, film: Film, talk: Talk, *, metres: bool) -> None:
    """Write a GLB with the motion, a film, or pictures, and say what was written."""
    rig = player.rig
    if path.suffix.lower() == ".glb":
        with talk.stage("weights"):
            track = player.track(name=Path(player.stream.source).stem)
        count = len(track.times)
        with talk.stage("normals+write"):
            write_glb(rig, path, track=track, metres=metres)
    else:
        write = write_film if path.suffix.lower() == _FILM else write_pictures
        with talk.stage("draw"):
            count = write(rig, player, path, film=film)
    seconds = count / player.stream.rate
    talk.put(output=path, frames=count, rate=player.stream.rate, duration=seconds)
    talk.say(f"wrote {path}: {count} frames, {seconds:.2f} s, {size_of(path)}")
    say_unmatched(player, talk)


def say_unmatched(player: Player, talk: Talk) -> None:
    """Say which names of the stream moved nothing, and why."""
    unmatched = player.weights.unmatched
    talk.put(unmatched=dict(unmatched))
    if unmatched:
        talk.say(f"not played ({len(unmatched)}):")
        for name, reason in unmatched.items():
            talk.say(f"  {name}: {reason}")


def say_error(error: ConversionError, talk: Talk) -> None:
    """Say how far a converted stream is from its source."""
    talk.put(
        error={
            "millimetres": {"mean": error.mean, "largest": error.largest},
            "parameters": {
                name: {"mean": mean, "largest": largest}
                for name, (mean, largest) in error.parameters.items()
            },
        }
    )
    if error.largest > 0.0:
        talk.say(
            f"error of the pose: {error.mean:.3f} mm, {error.largest:.3f} mm in the worst frame"
        )
    worst = sorted(error.parameters.items(), key=lambda item: -item[1][0])[:_FIGURES]
    if worst:
        talk.say("parameters that the rig meets worst [units of the face]:")
        rows = [[name, f"{mean:.1f}", f"{largest:.1f}"] for name, (mean, largest) in worst]
        talk.table(("parameter", "mean", "largest"), rows)
