"""Small scenes for the tests of the renderer."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from risorius.render import Camera, Lights, Surface

Array = npt.NDArray[np.float64]
WHITE = (1.0, 1.0, 1.0)
BLACK = (0.0, 0.0, 0.0)
AHEAD = Camera(np.array([0.0, 0.0, 100.0]), np.zeros(3), np.array([0.0, 1.0, 0.0]), 20.0)
PLAIN = Lights(occlusion=0.0)


def square(half: float = 10.0, z: float = 0.0, **look: Any) -> Surface:
    """Return a square that faces +Z."""
    corners = [[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]]
    return Surface(np.array(corners), np.array([[0, 1, 2], [0, 2, 3]]), **look)


def ball(count: int = 24, radius: float = 10.0, **look: Any) -> Surface:
    """Return a closed sphere with its poles on the y axis."""
    polar = np.linspace(0.0, np.pi, count + 1)[1:-1, None]
    around = np.linspace(0.0, 2.0 * np.pi, 2 * count, endpoint=False)[None]
    rings = np.stack(
        [
            np.sin(polar) * np.sin(around),
            np.cos(polar) + 0.0 * around,
            np.sin(polar) * np.cos(around),
        ],
        axis=2,
    ).reshape(-1, 3)
    positions = radius * np.concatenate([rings, [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]]])
    grid = np.arange(len(rings)).reshape(count - 1, 2 * count)
    right = np.roll(grid, -1, axis=1)
    a, b, c, d = grid[:-1].ravel(), grid[1:].ravel(), right[1:].ravel(), right[:-1].ravel()
    north, south = np.full(2 * count, len(rings)), np.full(2 * count, len(rings) + 1)
    faces = np.concatenate(
        [
            np.stack([a, b, c], axis=1),
            np.stack([a, c, d], axis=1),
            np.stack([north, grid[0], right[0]], axis=1),
            np.stack([south, right[-1], grid[-1]], axis=1),
        ]
    )
    return Surface(positions, faces, **look)


def linear(image: npt.NDArray[np.uint8]) -> Array:
    """Return 8-bit sRGB as linear values."""
    encoded = image / 255.0
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
