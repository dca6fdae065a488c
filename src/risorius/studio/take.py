"""A stream bound to a face, ready to be scrubbed: any moment at once, in any order."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.controls.control import Pose
from risorius.controls.fap import fap_number
from risorius.controls.presets import PresetBook
from risorius.controls.shape_sets import list_shapes
from risorius.controls.stream import Stream
from risorius.errors import FormatError
from risorius.head.frame import Frame
from risorius.io.gltf.write import write_glb
from risorius.io.track import TurnTrack
from risorius.playback.live import LivePlayer
from risorius.playback.pictures import Film, write_film
from risorius.playback.player import Player
from risorius.playback.resampling import resampled
from risorius.rig.bake import empty_rig
from risorius.rig.face import Face
from risorius.rig.rig import MorphTarget
from risorius.studio.jobs import Job
from risorius.studio.moment import Moment, Played, Turn
from risorius.studio.scene import Stage
from risorius.studio.stage_rig import StageRig

__all__ = ["Rehearsal", "Take", "Timed", "open_take", "rehearse"]

_LONGEST = 20_000
_STEPS = 240


class Timed(Protocol):
    """What a timeline can show."""

    @property
    def player(self) -> Player:
        """The stream on a rig."""
        ...

    @property
    def rate(self) -> float:
        """Frames per second."""
        ...

    @property
    def frame_count(self) -> int:
        """Number of frames."""
        ...

    def curve(self) -> FloatArray:
        """Return how much moves over time (k,), from 0 to 1."""
        ...

    def shown(self, time: float) -> Played:
        """Return what gives the moment at `time` [s]."""
        ...


@dataclass(frozen=True, eq=False)
class Take:
    """All frames of a stream as weights of a baked rig; straight between frames.

    Parameters
    ----------
    player : Player
    rig : StageRig
    weights : (f, t) float64
        Weights of all targets in every frame.
    turns : TurnTrack or None
        How the whole head turns; canonical frame.
    """

    player: Player
    rig: StageRig
    weights: FloatArray
    turns: TurnTrack | None

    @property
    def rate(self) -> float:
        """Frames per second."""
        return self.player.stream.rate

    @property
    def frame_count(self) -> int:
        """Number of frames."""
        return len(self.weights)

    def curve(self) -> FloatArray:
        """Return how much moves over time (k,), from 0 to 1, for the timeline."""
        return _curve(np.abs(self.weights).sum(axis=1))

    def weights_at(self, time: float) -> FloatArray:
        """Return the weights (t,) at `time` [s]."""
        first, second, share = _place(time * self.rate, len(self.weights))
        return (1.0 - share) * self.weights[first] + share * self.weights[second]

    def shown(self, time: float) -> Played:
        """Return what gives the moment at `time` [s].

        On a stage that was changed since, only meshes that are still the same are moved.
        """

        def moment(stage: Stage, groups: set[str]) -> Moment:
            meshes = self.rig.posed(self.weights_at(time), groups)
            baked = self.rig.stage
            kept = {
                name: places
                for name, places in meshes.items()
                if stage.mesh(name) is baked.mesh(name)
            }
            kept.setdefault("skin", stage.rest("skin"))
            return Moment(kept, _turn(self.turns, time * self.rate))

        return moment

    def record(self, path: Path, job: Job) -> int:
        """Write the take as a GLB with animation, or as a film; return the number of frames.

        Raises
        ------
        FormatError
            If it cannot be written.
        Cancelled
            If a person stopped it; nothing is left behind.
        """
        job.step("record")
        if path.suffix.lower() == ".glb":
            rig, track = self.player.animated(name=Path(self.player.stream.source).stem)
            write_glb(rig, path, track=track)
            return len(track.times)
        return write_film(self.player.rig, self._told(job), path, film=Film(rate=self.rate))

    def _told(self, job: Job) -> Iterator[npt.NDArray[np.floating]]:
        for number, positions in enumerate(self.player.positions()):
            job.tick(number, self.frame_count, f"frame {number + 1} of {self.frame_count}")
            yield positions


@dataclass(frozen=True, eq=False)
class Rehearsal:
    """All frames of a stream as poses of the face itself, until it is baked.

    Parameters
    ----------
    player : LivePlayer
    poses : tuple of Pose
        Of every frame.
    turns : TurnTrack or None
        How the whole head turns; canonical frame.
    """

    player: LivePlayer
    poses: tuple[Pose, ...]
    turns: TurnTrack | None

    @property
    def rate(self) -> float:
        """Frames per second."""
        return self.player.stream.rate

    @property
    def frame_count(self) -> int:
        """Number of frames."""
        return len(self.poses)

    def curve(self) -> FloatArray:
        """Return how much moves over time (k,), from 0 to 1, for the timeline."""
        ranges = {each.name: each.high - each.low for each in self.player.face.controls}
        amounts = [sum(abs(v) / ranges[n] for n, v in pose.items()) for pose in self.poses]
        return _curve(np.array(amounts))

    def shown(self, time: float) -> Played:
        """Return what gives the moment at `time` [s]."""
        first, second, share = _place(time * self.rate, len(self.poses))
        before, after = self.poses[first], self.poses[second]
        pose = {
            name: (1.0 - share) * before.get(name, 0.0) + share * after.get(name, 0.0)
            for name in {**before, **after}
        }

        def moment(stage: Stage, groups: set[str]) -> Moment:
            positions = stage.subject.face.pose(pose)
            return Moment(stage.posed(pose, positions, groups), _turn(self.turns, first + share))

        return moment


def open_take(stream: Stream, rig: StageRig, presets: PresetBook, job: Job) -> Take:
    """Bind a stream to a baked face.

    Raises
    ------
    FormatError
        If the stream is malformed, empty or too long to be scrubbed.
    Cancelled
        If a person stopped it.
    """
    player = Player(rig.rig, resampled(stream), presets=presets)
    rows: list[FloatArray] = []

    def take(values: dict[str, float]) -> None:
        rows.append(player.weights.of(values))

    turns = _gone_through(player, take, job)
    return Take(player, rig, np.stack(rows), turns)


def rehearse(stream: Stream, face: Face, presets: PresetBook, job: Job) -> Rehearsal | None:
    """Bind a stream to a face that is not baked yet; None where that takes a rig.

    MPEG-4 parameters are solved on the targets of a rig and have to wait for it.

    Raises
    ------
    FormatError
        If the stream is malformed, empty or too long to be scrubbed.
    Cancelled
        If a person stopped it.
    """
    if any(fap_number(name) for name in stream.names):
        return None
    singles = list_shapes(face.controls, presets, sets=("singles",)).poses
    still = np.zeros(0, np.int32), np.zeros((0, 3))
    names = empty_rig(face.head).with_targets(
        [MorphTarget(name, *still, pose) for name, pose in singles.items()], controls=face.controls
    )
    player = LivePlayer(face, names, resampled(stream), presets=presets)
    poses: list[Pose] = []

    def take(values: dict[str, float]) -> None:
        poses.append(player.pose_of(values))

    turns = _gone_through(player, take, job)
    return Rehearsal(player, tuple(poses), turns)


class _Taking(Protocol):
    def __call__(self, values: dict[str, float], /) -> None: ...


def _gone_through(player: Player, take: _Taking, job: Job) -> TurnTrack | None:
    """Hand all frames to `take`; return how the head turns meanwhile."""
    job.step("read")
    turns: list[dict[str, float]] = []
    for frame in player.stream:
        take(dict(frame.values))
        turns.append(dict(player.turn_of(frame.values)))
        if len(turns) > _LONGEST:
            raise FormatError(
                f"{player.stream.source}: more than {_LONGEST} frames are too long for the "
                "timeline; `risorius play` takes any length"
            )
        if not len(turns) % 50:
            job.tick(len(turns), len(turns) + 50, "frames")
    if not turns:
        raise FormatError(f"{player.stream.source}: holds no frames")
    if player.joint is None or not any(turns):
        return None
    return replace(player.joint, frame=Frame.canonical()).track(turns)


def _place(place: float, count: int) -> tuple[int, int, float]:
    """Return the frames before and after `place` [frames], and the share of the second."""
    place = min(max(place, 0.0), count - 1.0)
    first = min(int(place), max(count - 2, 0))
    return first, min(first + 1, count - 1), place - first


def _turn(turns: TurnTrack | None, place: float) -> Turn | None:
    if turns is None:
        return None
    first, second, share = _place(place, len(turns.rotations))
    mean = (1.0 - share) * turns.rotations[first] + share * turns.rotations[second]
    x, y, z, w = (mean / np.linalg.norm(mean)).tolist()
    a, b, c = turns.pivot.tolist()
    return (a, b, c, x, y, z, w)


def _curve(activity: FloatArray | Sequence[float]) -> FloatArray:
    amounts = np.asarray(activity, np.float64)
    places = np.linspace(0, len(amounts) - 1, min(_STEPS, len(amounts))).astype(int)
    return amounts[places] / max(float(amounts.max()), 1e-9)
