"""Cheeks that fill with air."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.smooth_step import smooth_step
from risorius.head.head import Head
from risorius.mesh.lips import LipSides
from risorius.mesh.normals import vertex_normals

__all__ = ["cheek_fields"]


def cheek_fields(head: Head, lips: LipSides) -> dict[str, FloatArray]:
    """Return the displacement (n, 3) [mm] of the skin for a full left and right cheek.

    The air pushes outwards where the cheek is only muscle and mucosa: round a point between
    mouth corner and jaw angle, up to the cheek bone and down to the jaw.
    """
    mesh = head.skin.mesh
    normals = vertex_normals(mesh.positions, mesh.faces)
    result: dict[str, FloatArray] = {}
    for side, corner, angle in (("l", "2.4", "2.13"), ("r", "2.5", "2.14")):
        start = head.landmarks.position(corner)
        end = (
            head.landmarks.position(angle)
            if angle in head.landmarks
            else start + [0.6 * np.sign(start[0]) * lips.width, 0.0, -1.4 * lips.width]
        )
        centre = start + 0.3 * (end - start)
        offset = mesh.positions - centre
        size = lips.width * np.array([0.55, 0.62, 0.8])
        distance = np.linalg.norm(offset / size, axis=1)
        outwards = (mesh.positions[:, 0] - lips_middle(mesh.positions, lips)) * np.sign(start[0])
        weight = smooth_step(1.0 - distance) * ~lips.inside * (outwards > 0.0)
        weight = weight * smooth_step(lips.distance / (0.2 * lips.width))
        push = normals + [0.35 * np.sign(start[0]), 0.0, 0.0]
        push /= np.maximum(np.linalg.norm(push, axis=1, keepdims=True), 1e-9)
        result[side] = 0.26 * lips.width * weight[:, None] * push
    return result


def lips_middle(positions: FloatArray, lips: LipSides) -> float:
    """Return x of the middle of the mouth [mm]."""
    return float(positions[list(lips.slit.corners), 0].mean())
