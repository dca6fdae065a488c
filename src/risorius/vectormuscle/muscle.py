"""What every kind of vector muscle is: a recipe that binds to a face and then displaces it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix

from risorius._check import FloatArray, IntArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.regions import Regions
from risorius.errors import ParameterError
from risorius.mesh.laplacian import averaging
from risorius.vectormuscle.lip_hold import LipHold
from risorius.vectormuscle.profile import AngularProfile

__all__ = [
    "KINDS",
    "BoundMuscle",
    "FaceContext",
    "VectorMuscle",
    "register_kind",
]

Warp = Callable[[npt.ArrayLike], FloatArray]


@dataclass(frozen=True, eq=False)
class FaceContext:
    """What a muscle may look at when it binds.

    Parameters
    ----------
    positions, normals : (n, 3) float64
        Skin at rest, canonical frame [mm].
    mechanics : Mechanics
        Lips and lids of the head.
    regions : Regions
        Region weights of the skin.
    angular : {"smooth", "published"}
    outward : (n, 3) float64
        Outward direction of what supports the skin.
    support : float
        Share of the inward motion that it takes away.
    drag : bool
        Whether skin around an insertion follows a muscle that asks for it.
    """

    positions: FloatArray
    normals: FloatArray
    mechanics: Mechanics
    regions: Regions
    angular: AngularProfile
    outward: FloatArray
    support: float
    drag: bool = True

    @cached_property
    def averaging(self) -> csr_matrix:
        """Matrix (n, n) that averages a field over the neighbours of each vertex."""
        mesh = self.mechanics.head.skin.mesh
        return averaging(mesh.faces, mesh.vertex_count)

    @cached_property
    def lip_hold(self) -> LipHold:
        """Body of the lips and calm of the mouth corners."""
        return LipHold.of(self.mechanics.lips, self.positions, self.averaging)

    @cached_property
    def movable(self) -> IntArray:
        """Vertices (k,) that muscles may move."""
        return np.flatnonzero(self.regions.mobility > 0.0).astype(np.int32)

    def within(self, centre: FloatArray, radius: float) -> tuple[IntArray, FloatArray]:
        """Return the movable vertices (k,) nearer to `centre` (3,) than `radius` [mm], and (k, 3).

        The second are their places relative to the centre [mm].
        """
        offset = self._movable_places - centre
        inside = np.einsum("kd,kd->k", offset, offset) < radius * radius
        return self.movable[inside], offset[inside]

    @cached_property
    def _movable_places(self) -> FloatArray:
        return self.positions[self.movable]


class BoundMuscle(Protocol):
    """A muscle on one face: its zone of influence, computed once."""

    @property
    def vertices(self) -> IntArray:
        """Skin vertices (k,) of the zone."""
        ...

    def displace(self, points: FloatArray, contraction: float) -> FloatArray:
        """Return the displacement (k, 3) [mm] of the zone's vertices standing at `points`."""
        ...


class VectorMuscle(Protocol):
    """A muscle of the recipe."""

    @property
    def name(self) -> str:
        """Control name, with side."""
        ...

    def mirrored(self) -> VectorMuscle:
        """Return the muscle of the other side (mirror plane x = 0 of the recipe's head)."""
        ...

    def fitted(self, warp: Warp) -> VectorMuscle:
        """Return the muscle carried to another head; lengths scale with the local stretch."""
        ...

    def ends(self) -> FloatArray:
        """Return head and tail (2, 3) [mm], the points that an export keeps."""
        ...

    def bind(self, context: FaceContext) -> BoundMuscle:
        """Compute the zone of influence on a face."""
        ...

    def to_json(self) -> dict[str, Any]:
        """Return the recipe entry."""
        ...


Reader = Callable[[Mapping[str, Any], str], VectorMuscle]
KINDS: dict[str, Reader] = {}
"""Muscle kinds by the word that recipes use; each kind's module adds itself."""


def register_kind(kind: str, reader: Reader) -> None:
    """Add a muscle kind."""
    KINDS[kind] = reader


def mirrored_name(name: str) -> str:
    """Return the control name of the other side."""
    if name.endswith("_l"):
        return f"{name[:-2]}_r"
    return f"{name[:-2]}_l" if name.endswith("_r") else name


def read_vector(entry: Mapping[str, Any], key: str, where: str) -> FloatArray:
    """Return ``entry[key]`` as a finite (3,) vector."""
    try:
        vector = np.asarray(entry.get(key), dtype=np.float64)
    except (TypeError, ValueError):
        vector = np.zeros(0)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise ParameterError(f"{where}: {key} must be three finite numbers [mm]")
    return vector


MIRROR = np.array([-1.0, 1.0, 1.0])
