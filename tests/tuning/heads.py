"""Copies of the built-in head that an export has to reach."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import numpy.typing as npt

from risorius.anatomy.template import builtin_head
from risorius.head import Head
from risorius.landmarks import LandmarkSpec
from risorius.rig.bake import empty_rig
from risorius.vectormuscle import VectorFace
from risorius.vectormuscle.export import Export, ExportParameters

Matrix = tuple[tuple[float, float, float], ...]


def moved_head(positions: npt.NDArray[np.float64]) -> Head:
    """Return the built-in head with its vertices elsewhere."""
    source = builtin_head()
    specs: dict[str, LandmarkSpec] = {
        name: LandmarkSpec(vertex=spec.vertex)
        for name, spec in empty_rig(source).landmarks.items()
        if spec.vertex is not None
    }
    return Head.from_mesh(replace(source.source, positions=positions), specs)


@cache
def similar_head(scale: float = 1.15, turn: float = 0.0) -> Head:
    """Return the built-in head scaled, nodding by `turn` [rad] and shifted."""
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    return moved_head(scale * builtin_head().source.positions @ rotation.T + [30.0, -20.0, 150.0])


@cache
def broad_head() -> Head:
    """Return the built-in head made broader, shorter below and more receding."""
    x, y, z = builtin_head().source.positions.T
    low = np.clip((-y - 20.0) / 80.0, 0.0, 1.5)
    return moved_head(np.stack([x * (1.15 - 0.08 * low), y * 0.92, z - 6.0 * low**2], axis=1))


@cache
def broad_export(profile: str = "improved") -> Export:
    """Return the export from the built-in head to the broad one, before its first group."""
    parameters = ExportParameters.of_profile(profile)
    return Export.begin(builtin_head(), broad_head(), parameters=parameters)


@cache
def broad_face() -> VectorFace:
    """Return the broad head with the muscles carried and not tuned."""
    return VectorFace.build(broad_head(), broad_export().vector_set())
