"""Motion of a rig as the animation of a GLB, and the nodes that turn its head."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from risorius.io.gltf.binary import BinaryBuilder
from risorius.io.track import TurnTrack, WeightTrack

__all__ = ["HEAD_NODE", "add_turning_nodes", "track_to_json"]

HEAD_NODE = "head_turn"
"""Name of the node that turns the head; it stands at the pivot."""


def add_turning_nodes(turns: TurnTrack, nodes: list[dict[str, Any]], children: list[int]) -> int:
    """Add a node that turns `children` about the pivot, and return its index.

    It stands at the pivot and carries a node that goes back by as much, so that at rest all stays
    where it was.
    """
    pivot = [float(x) for x in turns.pivot]
    nodes.append({"name": "head_rest", "translation": [-x for x in pivot], "children": children})
    nodes.append({"name": HEAD_NODE, "translation": pivot, "children": [len(nodes) - 1]})
    return len(nodes) - 1


def track_to_json(
    track: WeightTrack,
    nodes: Sequence[int],
    binary: BinaryBuilder,
    *,
    turning: int | None = None,
) -> dict[str, Any]:
    """Add a track to `binary` and return the animation that plays it.

    Parameters
    ----------
    track : WeightTrack
    nodes : sequence of int
        Nodes whose weights move.
    binary : BinaryBuilder
    turning : int, optional
        Node that turns the head.
    """
    times = binary.accessor(track.times.astype("<f4"), target=None, bounds=True)
    outputs: list[tuple[int, Sequence[int], str]] = []
    if nodes:
        weights = binary.accessor(track.weights.astype("<f4").ravel(), target=None)
        outputs.append((weights, nodes, "weights"))
    if track.turns is not None and turning is not None:
        rotations = binary.accessor(track.turns.rotations.astype("<f4"), target=None)
        outputs.append((rotations, [turning], "rotation"))
    return {
        "name": track.name,
        "samplers": [
            {"input": times, "output": output, "interpolation": "LINEAR"}
            for output, _, _ in outputs
        ],
        "channels": [
            {"sampler": sampler, "target": {"node": node, "path": path}}
            for sampler, (_, moved, path) in enumerate(outputs)
            for node in moved
        ],
    }
