"""Open streams and rigs for `play` and `convert`, write what they give, and say so."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from risorius.cli.outputs import is_folder_output, require_rig_output
from risorius.cli.pictures import subject_of
from risorius.cli.sources import Given, is_rig, read_head, resolve
from risorius.cli.talk import Talk
from risorius.cli.written import size_of
from risorius.controls.presets import default_presets
from risorius.controls.stream import Stream
from risorius.errors import FormatError, ParameterError
from risorius.io.gltf.write import write_glb
from risorius.io.motion import read_stream
from risorius.io.usd import write_usd
from risorius.playback.conversion import ConversionError
from risorius.playback.live import LivePlayer, rig_of_singles
from risorius.playback.pictures import NO_FFMPEG, Film, has_ffmpeg, write_film, write_pictures
from risorius.playback.player import Player
from risorius.project import face_of, presets_of, read_presets

__all__ = ["open_player", "say_error", "say_unmatched", "write_motion"]

_FILM = ".mp4"
_USD = (".usd", ".usda", ".usdc", ".usdz")
_FIGURES = 8


def open_player(
    rig: str,
    stream: Path,
    output: Path | None,
    given: Given,
    talk: Talk,
    *,
    sampling: Callable[[Stream], Stream],
    live: bool = False,
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
    live : bool
        Let the face itself move, not a rig of it.

    Raises
    ------
    RisoriusError
        If something of it is refused.
    """
    if output is not None:
        _require_output(output)
    found = sampling(read_stream(stream))
    if live:
        player = _live_player(rig, found, given, talk)
    else:
        presets = default_presets() if given.presets is None else read_presets(given.presets)
        subject = subject_of(rig, given, talk, needs=None)
        player = Player(subject, found, presets=presets)
    talk.say(f"{stream}: {found.rate:g} frames per second")
    return player


def _live_player(name: str, stream: Stream, given: Given, talk: Talk) -> LivePlayer:
    if is_rig(name):
        raise ParameterError(
            f"{name}: a rig is baked and has no muscles any more; --live needs a head, a project "
            "or 'builtin'"
        )
    project = resolve(name, given)
    presets = presets_of(project)
    head = read_head(project, talk)
    with talk.stage("muscles"):
        face = face_of(project, head)
    with talk.stage("singles") as tick:
        rig = rig_of_singles(face, presets, progress=tick)
    player = LivePlayer(face, rig, stream, presets=presets)
    talk.put(physics=player.has_physics)
    if not player.has_physics:
        talk.note("this method has no physics of its own: every frame is a pose of the face")
    return player


def _require_output(path: Path) -> None:
    ending = path.suffix.lower()
    if is_folder_output(str(path)):
        if not path.parent.is_dir():
            raise FormatError(f"{path}: the folder {path.parent} does not exist; create it first")
    elif ending == _FILM:
        if not has_ffmpeg():
            raise FormatError(
                f"{path}: {NO_FFMPEG}, or give a folder for PNG frames, such as "
                f"{path.with_suffix('')}"
            )
        if not path.parent.is_dir():
            raise FormatError(f"{path}: the folder {path.parent} does not exist; create it first")
    elif ending in (".glb", *_USD):
        require_rig_output(str(path))
    else:
        raise FormatError(
            f"{path}: {ending!r} is no ending of motion; known: .glb {' '.join(_USD)} .mp4, or a "
            "folder for PNG frames (`risorius convert` writes streams)"
        )


def write_motion(player: Player, path: Path, film: Film, talk: Talk, *, metres: bool) -> None:
    """Write a GLB or USD with the motion, a film, or pictures, and say what was written."""
    ending = path.suffix.lower()
    if ending == ".glb" or ending in _USD:
        with talk.stage("weights"):
            rig, track = player.animated(name=Path(player.stream.source).stem)
        count = len(track.times)
        talk.put(shapes=len(rig.targets), turns_head=track.turns is not None)
        with talk.stage("normals+write"):
            if ending == ".glb":
                write_glb(rig, path, track=track, metres=metres)
            else:
                write_usd(rig, path, track=track)
    else:
        write = write_film if ending == _FILM else write_pictures
        with talk.stage("draw"):
            count = write(player.rig, player.positions(), path, film=film)
    seconds = count / player.stream.rate
    talk.put(output=path, frames=count, rate=player.stream.rate, duration=seconds)
    talk.say(f"wrote {path}: {count} frames, {seconds:.2f} s, {size_of(path)}")
    say_unmatched(player, talk)


def say_unmatched(player: Player, talk: Talk) -> None:
    """Say which names of the stream moved nothing, and why."""
    unmatched = player.unmatched
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
