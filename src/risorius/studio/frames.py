"""Messages to the viewport in binary: scenes, frames, candidates.

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
from risorius.studio.scene import SceneMesh

__all__ = ["CANDIDATES", "FRAME", "SCENE", "STEP", "candidates", "frame", "scene"]

SCENE, FRAME, CANDIDATES = 1, 2, 3
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
            }
        )
        colour = each.colour.tobytes()
        blobs += [
            mesh.positions.astype("<f4").tobytes(),
            mesh.faces.astype("<u4").tobytes(),
            colour + b"\0" * (-len(colour) % 4),
        ]
    head = {"meshes": entries, "replaced": list(replaced), **facts}
    return _message(SCENE, epoch, 0, head, b"".join(blobs))


def frame(
    rest: Mapping[str, FloatArray],
    posed: Mapping[str, FloatArray],
    *,
    epoch: int,
    serial: int,
    paint: Mapping[str, npt.NDArray[np.uint8]] | None = None,
) -> bytes:
    """Return the message that moves meshes, and paints some of them.

    Parameters
    ----------
    rest, posed : mapping of str to (k, 3) float64
        Vertices of meshes, by name [mm].
    epoch, serial : int
    paint : mapping of str to (k, 3) uint8, optional
        sRGB of every vertex of some meshes.
    """
    colours = paint or {}
    blobs: list[bytes] = []
    for name, positions in posed.items():
        steps = np.rint((positions - rest[name]) / STEP)
        data = np.clip(steps, -_MOST, _MOST).astype("<i2").tobytes()
        blobs.append(data + b"\0" * (-len(data) % 4))
    for colour in colours.values():
        data = colour.tobytes()
        blobs.append(data + b"\0" * (-len(data) % 4))
    head = {"moved": list(posed), "painted": list(colours)}
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
            steps = np.rint((posed[name] - rest[name]) / STEP)
            data = np.clip(steps, -_MOST, _MOST).astype("<i2").tobytes()
            blobs.append(data + b"\0" * (-len(data) % 4))
    head = {"moved": names, "count": len(shown), "labels": list(labels)}
    return _message(CANDIDATES, epoch, 0, head, b"".join(blobs))


def _message(kind: int, epoch: int, serial: int, head: Mapping[str, Any], blob: bytes) -> bytes:
    text = json.dumps(head, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<IIII", kind, epoch, serial, len(text)) + text + blob
