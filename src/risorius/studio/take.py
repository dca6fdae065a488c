"""A stream bound to a rig, ready to be scrubbed: any moment at once, in any order."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from risorius._check import FloatArray
from risorius.controls.presets import PresetBook
from risorius.controls.stream import Stream
from risorius.errors import FormatError
from risorius.io.gltf.write import write_glb
from risorius.io.motion import read_stream
from risorius.playback.pictures import Film, write_film
from risorius.playback.player import Player
from risorius.playback.resampling import resampled
from risorius.rig.rig import Rig
from risorius.studio.jobs import Job

__all__ = ["Take", "open_take"]

_LONGEST = 20_000
_STEPS = 240


@dataclass(frozen=True, eq=False)
class Take:
    """All frames of a stream on a rig.

    Parameters
    ----------
    player : Player
    weights : (f, t) float64
        Weights of all targets in every frame.
    """

    player: Player
    weights: FloatArray

    @property
    def rate(self) -> float:
        """Frames per second."""
        return self.player.stream.rate

    @property
    def duration(self) -> float:
        """Length [s]."""
        return (len(self.weights) - 1) / self.rate

    def frame(self, time: float) -> int:
        """Return the frame in force at `time` [s]."""
        return int(np.clip(round(time * self.rate), 0, len(self.weights) - 1))

    def positions(self, time: float) -> FloatArray:
        """Return the vertices (n, 3) at `time` [s], canonical frame [mm]."""
        rig = self.player.rig
        posed = rig.mesh.positions.copy()
        for target, weight in zip(rig.targets, self.weights[self.frame(time)]):
            if weight:
                posed[target.vertices] += weight * target.deltas
        return rig.frame.to_canonical(posed)

    def curve(self) -> FloatArray:
        """Return how much moves over time (k,), from 0 to 1, for the timeline."""
        activity = np.abs(self.weights).sum(axis=1)
        places = np.linspace(0, len(activity) - 1, min(_STEPS, len(activity))).astype(int)
        return activity[places] / max(float(activity.max()), 1e-9)

    def record(self, path: Path, job: Job) -> None:
        """Write the take as a GLB with animation, or as a film.

        Raises
        ------
        FormatError
            If it cannot be written.
        """
        job.step("write")
        if path.suffix.lower() == ".glb":
            rig, track = self.player.animated(name=Path(self.player.stream.source).stem)
            write_glb(rig, path, track=track)
        else:
            film = Film(rate=self.rate)
            write_film(self.player.rig, self.player.positions(), path, film=film)


def open_take(source: Path | Stream, rig: Rig, presets: PresetBook, job: Job) -> Take:
    """Read a stream and bind it to a rig.

    Raises
    ------
    FormatError
        If the stream is malformed, empty or too long to be scrubbed.
    Cancelled
        If a person stopped it.
    """
    found = source if isinstance(source, Stream) else read_stream(source)
    player = Player(rig, resampled(found), presets=presets)
    job.step("read")
    rows: list[FloatArray] = []
    for weights in player:
        rows.append(weights)
        if len(rows) > _LONGEST:
            raise FormatError(
                f"{found.source}: more than {_LONGEST} frames are too long for the timeline; "
                "`risorius play` takes any length"
            )
        if not len(rows) % 50:
            job.tick(len(rows), len(rows) + 50, "frames")
    if not rows:
        raise FormatError(f"{found.source}: holds no frames")
    return Take(player, np.stack(rows))
