"""Messages to the viewport in binary: scenes, frames, candidates, targets, takes.

Every message is ``u32 kind, u32 epoch, u32 serial, u32 length`` of a JSON text, the text padded
with blanks to a multiple of four bytes, and the arrays that the text describes, one behind the
other, little-endian. Frames hold displacements from rest as 16-bit numbers in steps of `STEP`.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.studio.moment import Moment
from risorius.studio.scene import SceneMesh
from risorius.studio.stage_rig import StageRig

__all__ = [
    "CANDIDATES",
    "FRAME",
    "SCENE",
    "STEP",
    "TAKE",
    "TARGETS",
    "candidates",
    "frame",
    "scene",
    "take",
    "targets",
]

SCENE, FRAME, CANDIDATES, TARGETS, TAKE = 1, 2, 3, 4, 5
STEP = 1.0 / 256.0
"""Resolution of a frame [mm]; its range is 128 mm either way."""

_MOST = 32767


def scene(
    meshes: Sequence[SceneMesh], *, epoch: int, replaced: Sequence[str], facts: Mapping[str, Any]
) -> bytes:
    """Return the message that brings meshes.

    Parameters
    ----------
    meshes : sequence of SceneMesh
    epoch : int
        Counts scenes; frames of other epochs are void.
    replaced : sequence of str
        Groups whose meshes go first.
    facts : mapping
        About the whole: size, centre.
    """
    entries: list[dict[str, Any]] = []
    blobs: list[bytes] = []
    for each in meshes:
        mesh = each.mesh
        entries.append(
            {
                "name": each.name,
                "group": each.group,
                "vertices": mesh.vertex_count,
                "faces": mesh.face_count,
                "solid": each.solid,
            }
        )
        blobs += [
            mesh.positions.astype("<f4").tobytes(),
            mesh.faces.astype("<u4").tobytes(),
            _padded(each.colour.tobytes()),
        ]
    head = {"meshes": entries, "replaced": list(replaced), **facts}
    return _message(SCENE, epoch, 0, head, b"".join(blobs))


def frame(
    rest: Mapping[str, FloatArray],
    moment: Moment,
    *,
    epoch: int,
    serial: int,
    paint: Mapping[str, npt.NDArray[np.uint8]] | None = None,
) -> bytes:
    """Return the message that moves meshes, and paints some of them.

    Parameters
    ----------
    rest : mapping of str to (k, 3) float64
        Vertices of meshes at rest, by name [mm].
    moment : Moment
        Where they are.
    epoch, serial : int
    paint : mapping of str to (k, 3) uint8, optional
        sRGB of every vertex of some meshes.
    """
    colours = paint or {}
    blobs: list[bytes] = []
    for name, positions in moment.meshes.items():
        blobs.append(_steps(positions - rest[name]))
    for colour in colours.values():
        blobs.append(_padded(colour.tobytes()))
    head: dict[str, Any] = {"moved": list(moment.meshes), "painted": list(colours)}
    if moment.turn is not None:
        head["turn"] = list(moment.turn)
    return _message(FRAME, epoch, serial, head, b"".join(blobs))


def candidates(
    rest: Mapping[str, FloatArray],
    shown: Sequence[Mapping[str, FloatArray]],
    *,
    epoch: int,
    labels: Sequence[str],
) -> bytes:
    """Return the message that brings faces to choose from.

    Parameters
    ----------
    rest : mapping of str to (k, 3) float64
    shown : sequence of mapping of str to (k, 3) float64
        Vertices of the meshes of each face [mm].
    epoch : int
    labels : sequence of str
    """
    blobs: list[bytes] = []
    names = list(shown[0]) if shown else []
    for posed in shown:
        for name in names:
            blobs.append(_steps(posed[name] - rest[name]))
    head = {"moved": names, "count": len(shown), "labels": list(labels)}
    return _message(CANDIDATES, epoch, 0, head, b"".join(blobs))


def targets(rig: StageRig, *, epoch: int, number: int) -> bytes:
    """Return the message that brings the targets of all meshes, for a page to play alone.

    For each mesh: where the entries of its vertices begin (n + 1 of 32 bits), then its entries of
    four times 16 bits: target, and the displacement in steps of the target's scale.

    Parameters
    ----------
    rig : StageRig
    epoch : int
        Of the scene that it belongs to.
    number : int
        By which takes name it.
    """
    entries: list[dict[str, Any]] = []
    blobs: list[bytes] = []
    for name, mesh in rig.meshes.items():
        entries.append({"name": name, "entries": len(mesh.target)})
        table = np.concatenate([mesh.target[:, None], mesh.steps], axis=1)
        blobs += [mesh.starts.astype("<u4").tobytes(), table.astype("<i2").tobytes()]
    head = {"number": number, "scales": rig.scales.tolist(), "meshes": entries}
    return _message(TARGETS, epoch, 0, head, b"".join(blobs))


def take(
    weights: FloatArray,
    turns: FloatArray | None,
    *,
    epoch: int,
    facts: Mapping[str, Any],
) -> bytes:
    """Return the message that brings a take as weights of targets.

    Parameters
    ----------
    weights : (f, t) float64
        In every frame; only targets that move are sent.
    turns : (f, 4) float64, optional
        Unit quaternions (x, y, z, w) by which the whole head is turned.
    epoch : int
    facts : mapping
        Its number, the number of its targets, frames per second, the pivot of the turns [mm].
    """
    columns = np.flatnonzero(weights.any(axis=0))
    blobs = [weights[:, columns].astype("<f4").tobytes()]
    if turns is not None:
        blobs.append(turns.astype("<f4").tobytes())
    head = {
        "frames": len(weights),
        "columns": columns.tolist(),
        "turns": turns is not None,
        **facts,
    }
    return _message(TAKE, epoch, 0, head, b"".join(blobs))


def _steps(displacement: FloatArray) -> bytes:
    steps = np.clip(np.rint(displacement / STEP), -_MOST, _MOST)
    return _padded(steps.astype("<i2").tobytes())


def _padded(data: bytes) -> bytes:
    return data + b"\0" * (-len(data) % 4)


def _message(kind: int, epoch: int, serial: int, head: Mapping[str, Any], blob: bytes) -> bytes:
    text = json.dumps(head, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<IIII", kind, epoch, serial, len(text)) + text + blob
