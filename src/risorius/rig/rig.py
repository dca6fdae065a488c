"""The rig: a neutral head and named morph targets."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from risorius import _formats
from risorius._check import FloatArray, IntArray, as_points
from risorius.controls.control import Control, Pose
from risorius.errors import ParameterError, ShapeError
from risorius.head.frame import Frame
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.polygon_mesh import PolygonMesh

__all__ = ["MorphTarget", "Rig"]


@dataclass(frozen=True, eq=False)
class MorphTarget:
    """A named, sparse displacement field.

    Parameters
    ----------
    name : str
    vertices : (k,) int32
        Vertices that move, ascending.
    deltas : (k, 3) float64
        Their displacement [file frame and unit].
    pose : mapping
        Controls that make it, where known.
    """

    name: str
    vertices: IntArray
    deltas: FloatArray
    pose: Pose = field(default_factory=dict[str, float])

    def __post_init__(self) -> None:
        if self.deltas.shape != (len(self.vertices), 3):
            raise ShapeError(
                f"target {self.name!r}: expected deltas of shape ({len(self.vertices)}, 3), "
                f"got {self.deltas.shape}"
            )
        if len(self.vertices) and (self.vertices[0] < 0 or (np.diff(self.vertices) <= 0).any()):
            raise ShapeError(f"target {self.name!r}: vertices must ascend from 0 or above")

    @staticmethod
    def from_dense(
        name: str, deltas: npt.ArrayLike, *, pose: Pose | None = None, still: float = 0.0
    ) -> MorphTarget:
        """Keep the rows of `deltas` (n, 3) that are longer than `still`."""
        dense = as_points(f"target {name!r}: deltas", deltas)
        vertices = np.flatnonzero((dense * dense).sum(axis=1) > still * still).astype(np.int32)
        return MorphTarget(name, vertices, dense[vertices], dict(pose or {}))

    def dense(self, vertex_count: int) -> FloatArray:
        """Return the displacement (n, 3) of all vertices."""
        result = np.zeros((vertex_count, 3))
        result[self.vertices] = self.deltas
        return result


@dataclass(frozen=True, eq=False)
class Rig:
    """Neutral + morph targets, in the input's frame, unit and vertex order.

    Parameters
    ----------
    mesh : PolygonMesh
        The neutral head, bit for bit the input.
    targets : tuple of MorphTarget
        Names are unique.
    part_of_vertex : (n,) int32
        Index into `part_names`, -1 for unused vertices; may be empty.
    landmarks : mapping of str to LandmarkSpec
        So that the rig can be inspected, played and cloned alone.
    frame : Frame
        Way to the canonical frame.
    controls : tuple of Control
        Controls of the face it was baked from.
    left_out : mapping of str to str
        Shapes that were asked for and not made, with the reason.
    """

    mesh: PolygonMesh
    targets: tuple[MorphTarget, ...]
    part_names: tuple[str, ...] = ()
    part_of_vertex: IntArray = field(default_factory=lambda: np.zeros(0, np.int32))
    landmarks: Mapping[str, LandmarkSpec] = field(default_factory=dict[str, LandmarkSpec])
    frame: Frame = field(default_factory=Frame.canonical)
    controls: tuple[Control, ...] = ()
    left_out: Mapping[str, str] = field(default_factory=dict[str, str])

    def __post_init__(self) -> None:
        seen: set[str] = set()
        for target in self.targets:
            if target.name in seen:
                raise ParameterError(f"rig: two targets are named {target.name!r}")
            seen.add(target.name)
            if len(target.vertices) and target.vertices[-1] >= self.mesh.vertex_count:
                raise ShapeError(f"rig: target {target.name!r} moves a vertex that does not exist")

    @cached_property
    def by_name(self) -> Mapping[str, MorphTarget]:
        """Targets by name."""
        return {target.name: target for target in self.targets}

    @property
    def names(self) -> tuple[str, ...]:
        """Target names in order."""
        return tuple(target.name for target in self.targets)

    def target(self, name: str) -> MorphTarget:
        """Return the target called `name`.

        Raises
        ------
        ParameterError
            If there is none.
        """
        found = self.by_name.get(name)
        if found is None:
            raise ParameterError(f"rig: no target {name!r}; it has {', '.join(self.names)}")
        return found

    def posed(self, weights: Mapping[str, float]) -> FloatArray:
        """Return neutral + weighted targets (n, 3) [file frame and unit].

        Raises
        ------
        ParameterError
            If a name is unknown.
        """
        positions = self.mesh.positions.copy()
        for name, weight in weights.items():
            target = self.target(name)
            positions[target.vertices] += weight * target.deltas
        return positions

    def with_targets(
        self,
        targets: Iterable[MorphTarget],
        *,
        controls: tuple[Control, ...] | None = None,
        left_out: Mapping[str, str] | None = None,
    ) -> Rig:
        """Return the rig with other targets."""
        return replace(
            self,
            targets=tuple(targets),
            controls=self.controls if controls is None else controls,
            left_out=self.left_out if left_out is None else left_out,
        )

    def subset(self, names: Iterable[str]) -> Rig:
        """Return a rig with only the targets `names`, in that order."""
        return self.with_targets(self.target(name) for name in names)

    def save(self, path: str | Path) -> None:
        """Write the rig; the ending of `path` chooses the format.

        Raises
        ------
        FormatError
            If the format is unknown or the file cannot be written.
        """
        _formats.write_rig(self, Path(path))

    @staticmethod
    def load(path: str | Path) -> Rig:
        """Read a rig from a GLB, NPZ or folder of OBJ files."""
        return _formats.read_rig(Path(path))
