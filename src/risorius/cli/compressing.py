"""From the arguments of `compress` to a small rig and its weights."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from risorius.cli.motion import say_unmatched
from risorius.cli.outputs import require_rig_output, write_rig
from risorius.cli.pictures import subject_of
from risorius.cli.sources import Given
from risorius.cli.talk import Talk
from risorius.cli.written import size_of
from risorius.controls.pair_names import pair_of
from risorius.controls.presets import default_presets
from risorius.errors import FormatError, ParameterError
from risorius.io.gltf.write import write_glb
from risorius.io.motion import read_stream, stream_endings, write_stream
from risorius.io.usd import write_usd
from risorius.playback.player import Player
from risorius.playback.small_basis import SmallBasis, small_basis
from risorius.project import read_presets
from risorius.rig.rig import Rig

__all__ = ["Wish", "compress_rig"]

_ROWS = 12  # of the error curve, for people


@dataclass(frozen=True)
class Wish:
    """What is wanted of a small rig; see the options of `compress`."""

    output: str
    stream: Path | None
    count: int | None
    error: float | None
    weights: Path | None


def compress_rig(name: str, given: Given, wish: Wish, talk: Talk) -> None:
    """Write the small rig and what else was wanted, and say how good it is.

    Raises
    ------
    RisoriusError
        If something of it is refused.
    """
    path = require_rig_output(wish.output)
    _require_weights_output(wish.weights)
    stream = None if wish.stream is None else read_stream(wish.stream)
    presets = default_presets() if given.presets is None else read_presets(given.presets)
    rig = subject_of(name, given, talk, needs=None)
    if not rig.targets:
        raise ParameterError(f"{name}: has no shapes, there is nothing to compress")
    player = None if stream is None else Player(rig, stream, presets=presets)
    with talk.stage("components"):
        rows: Iterable[npt.ArrayLike] = _alone(rig) if player is None else player
        small = small_basis(rig, rows, count=wish.count, error=wish.error)
    _write(small, player, path, wish, talk)
    _say(small, rig, path, talk)
    if player is not None:
        say_unmatched(player, talk)


def _require_weights_output(path: Path | None) -> None:
    known = [ending for ending in stream_endings() if ending != ".fap"]
    if path is not None and path.suffix.lower() not in known:
        raise FormatError(f"{path}: {path.suffix!r} holds no weights; known: {' '.join(known)}")
    if path is not None and not path.parent.is_dir():
        raise FormatError(f"{path}: the folder {path.parent} does not exist; create it first")


def _alone(rig: Rig) -> npt.NDArray[np.float64]:
    """Return every shape by itself as a row; a corrective comes with both of its shapes."""
    column = {name: index for index, name in enumerate(rig.names)}
    rows = np.eye(len(rig.names))
    for row, name in enumerate(rig.names):
        for other in pair_of(name) or ():
            if other in column:
                rows[row, column[other]] = 1.0
    return rows


def _write(small: SmallBasis, player: Player | None, path: Path, wish: Wish, talk: Talk) -> None:
    ending = path.suffix.lower()
    with talk.stage("normals+write"):
        if player is None or not (ending == ".glb" or ending.startswith(".usd")):
            write_rig(small.rig, path)
        else:
            reduced = small.reduced(player.stream, player)
            track = Player(small.rig, reduced).track(name=Path(player.stream.source).stem)
            if ending == ".glb":
                write_glb(small.rig, path, track=track)
            else:
                write_usd(small.rig, path, track=track)
    if player is not None and wish.weights is not None:
        with talk.stage("weights"):
            count = write_stream(small.reduced(player.stream, player), wish.weights)
        talk.put(weights=wish.weights, frames=count)
        talk.say(f"wrote {wish.weights}: {count} frames")


def _say(small: SmallBasis, rig: Rig, path: Path, talk: Talk) -> None:
    curve = small.error_curve
    talk.put(
        output=path,
        shapes=list(small.rig.names),
        shapes_before=len(rig.targets),
        error_curve=curve.tolist(),
    )
    talk.say(
        f"wrote {path}: {len(small.rig.targets)} shapes for {len(rig.targets)}, "
        f"{curve[-1]:.3f} mm of {curve[0]:.3f} mm are missing, {size_of(path)}"
    )
    shown = sorted({*np.linspace(0, len(curve) - 1, min(_ROWS, len(curve))).astype(int).tolist()})
    talk.table(("shapes", "error mm"), [(f"{k}", f"{curve[k]:.3f}") for k in shown])
