"""How fast a rig is posed on one core, and how much memory a long stream takes."""

from __future__ import annotations

import resource
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from risorius.controls.fap import fap_number
from risorius.controls.stream import Stream, StreamFrame
from risorius.playback.player import Player
from risorius.rig import Rig

__all__ = ["player_report"]

_RATE = 60.0
_MOST = 84  # targets, as many as the thesis has


def player_report(path: Path, frame_count: int) -> str:
    """Return frames per second of player and dense NumPy, and memory over a long stream."""
    rig = Rig.load(path)
    # Weights by name: parameters of MPEG-4 would be fitted, which is another thing to measure.
    rig = rig.subset([name for name in rig.names if fap_number(name) is None][-_MOST:])
    stream = _take(rig, frame_count)
    player = Player(rig, stream)
    first = next(iter(player.positions()))  # kernels, tables
    begun, memory = time.process_time(), []
    last = first
    for count, last in enumerate(player.positions()):  # noqa: B007 (the last one is checked)
        if count % max(frame_count // 10, 1) == 0:
            memory.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
    fast = frame_count / (time.process_time() - begun)
    slow = _dense(rig, player)
    assert np.isfinite(last).all()
    assert last.shape == first.shape
    return (
        f"{path.name}: {len(rig.targets)} targets, {rig.mesh.vertex_count} vertices, "
        f"{frame_count} frames\n"
        f"player, from values to positions: {fast:.0f} frames per second of one core\n"
        f"dense NumPy (targets x 3n, float64): {slow:.0f}; ratio {fast / slow:.1f}\n"
        f"largest memory after each tenth [MB]: {', '.join(f'{m:.0f}' for m in memory)}\n"
    )


def _take(rig: Rig, frame_count: int) -> Stream:
    names = rig.names

    def frames() -> Iterator[StreamFrame]:
        phase = np.linspace(0.0, 40.0, len(names))
        for number in range(frame_count):
            weights = np.clip(np.sin(0.05 * number + phase) - 0.6, 0.0, None) * 2.5
            yield StreamFrame(number / _RATE, dict(zip(names, weights.tolist())))

    return Stream("made up", _RATE, names, frames)


def _dense(rig: Rig, player: Player) -> float:
    """Return frames per second of neutral + weights @ targets."""
    table = np.stack([t.dense(rig.mesh.vertex_count).ravel() for t in rig.targets])
    rest = rig.mesh.positions.ravel()
    rows = [row for row, _ in zip(player, range(60))]
    begun = time.process_time()
    for row in rows:
        posed = rest + row @ table
    assert np.isfinite(posed).all()
    return len(rows) / (time.process_time() - begun)
