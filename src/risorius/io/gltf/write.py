"""Write a rig as GLB: one mesh per part, sparse named morph targets, everything to read it back."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.errors import FormatError
from risorius.head.frame import Frame
from risorius.io.atomic import write_bytes
from risorius.io.finite import require_finite
from risorius.io.gltf.binary import ELEMENT_ARRAY_BUFFER, BinaryBuilder
from risorius.io.gltf.nodes import METRES_MARK
from risorius.io.gltf.primitives import SOURCE_ATTRIBUTE
from risorius.io.gltf.split import Primitive, Split, split
from risorius.io.gltf.targets import add_targets
from risorius.io.gltf.topology import CORNERS, SIZES, topology_to_json
from risorius.io.gltf.track import add_turning_nodes, track_to_json
from risorius.io.looks import look_of
from risorius.io.rig_json import rig_to_json
from risorius.io.track import WeightTrack, show_of_shapes
from risorius.rig.rig import Rig

__all__ = ["glb_bytes", "write_glb"]

_MILLIMETRES_PER_METRE = 1000.0
_LARGEST_EXACT = 2**24  # whole numbers up to this survive float32


def write_glb(
    rig: Rig,
    path: str | Path,
    *,
    animation: bool = False,
    track: WeightTrack | None = None,
    metres: bool = False,
) -> None:
    """Write a rig as GLB 2.0.

    Parameters
    ----------
    rig : Rig
    path : path
    animation : bool
        Add an animation that shows one shape after the other.
    track : WeightTrack, optional
        Add an animation that plays this instead; where it turns the head, a node ``head_turn``
        carries all parts and turns about the track's pivot.
    metres : bool
        Add a root node that turns the head to metres, +Y up and +Z forward, as glTF prescribes;
        without it the numbers are those of the input.

    Raises
    ------
    FormatError
        If the rig has no polygons, numbers beyond float32, or the file cannot be written.

    Notes
    -----
    Every part that moves in any target carries all of them in the same order, so that one weight
    moves all parts. Same rig, same bytes.
    """
    data = glb_bytes(rig, str(path), animation=animation, track=track, metres=metres)
    write_bytes(path, data)


def glb_bytes(
    rig: Rig,
    where: str,
    *,
    animation: bool = False,
    track: WeightTrack | None = None,
    metres: bool = False,
) -> bytes:
    """Return the bytes that `write_glb` writes; `where` opens every message."""
    _require_writable(rig, where)
    if track is not None:
        track.require_fits(len(rig.targets))
    parts = split(rig)
    writer = _Writer(rig, parts)
    meshes = [
        writer.mesh(name, list(primitives))
        for name, primitives in groupby(parts.primitives, key=lambda p: p.part)
    ]
    nodes: list[dict[str, Any]] = [
        {"name": mesh["name"], "mesh": index} for index, mesh in enumerate(meshes)
    ]
    moving = add_targets(meshes, rig, parts, writer.binary)
    content: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "risorius", "extras": writer.extras()},
        "scene": 0,
        "scenes": [{"name": "head", "nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": writer.materials,
    }
    top, turning = list(range(len(nodes))), None
    if track is not None and track.turns is not None:
        turning = add_turning_nodes(track.turns, nodes, top)
        top = [turning]
    if metres:
        nodes.append(_to_metres(rig.frame, top))
        top = [len(nodes) - 1]
    content["scenes"][0]["nodes"] = top
    if track is None and animation:
        track = show_of_shapes(len(rig.targets))
    if track is not None and (moving or turning is not None):
        content["animations"] = [track_to_json(track, moving, writer.binary, turning=turning)]
    return writer.binary.glb(content)


class _Writer:
    """Accessors and materials of the file so far."""

    def __init__(self, rig: Rig, parts: Split) -> None:
        self.binary = BinaryBuilder()
        self.materials: list[dict[str, Any]] = []
        self._material_index: dict[str, int] = {}
        self._rig = rig
        self._parts = parts
        self._positions = rig.mesh.positions.astype("<f4")
        self._normals = parts.normals.rest.astype("<f4")
        # A vertex without a surface around it has no normal, and glTF wants unit vectors.
        self._normals[~parts.normals.rest.any(axis=1)] = (0.0, 0.0, 1.0)

    def mesh(self, name: str, primitives: Sequence[Primitive]) -> dict[str, Any]:
        """Add the primitives of one part."""
        return {"name": name, "primitives": [self._primitive(one) for one in primitives]}

    def _primitive(self, primitive: Primitive) -> dict[str, Any]:
        add = self.binary.accessor
        attributes = {
            "POSITION": add(self._positions[primitive.source], bounds=True),
            "NORMAL": add(self._normals[primitive.normal]),
        }
        if primitive.uvs is not None:
            attributes["TEXCOORD_0"] = add(_downwards(primitive.uvs))
        attributes[SOURCE_ATTRIBUTE] = add(primitive.source.astype("<f4"))
        indices = primitive.triangles.ravel()
        # The largest number of a type is reserved.
        indices = indices.astype("<u2" if len(primitive.source) <= 65535 else "<u4")
        return {
            "attributes": attributes,
            "indices": add(indices, target=ELEMENT_ARRAY_BUFFER),
            "material": self._material(primitive.material or primitive.part, primitive.part),
        }

    def _material(self, name: str, part: str) -> int:
        if name not in self._material_index:
            self._material_index[name] = len(self.materials)
            self.materials.append(_material_to_json(name, part))
        return self._material_index[name]

    def extras(self) -> dict[str, Any]:
        """Add what gives the input back, and return it."""
        corners = self._parts.corners.astype("<u4")
        sizes = np.diff(self._rig.mesh.offsets).astype("<u4")
        topology = topology_to_json(
            self._rig,
            corners_view=self.binary.view(corners, name=CORNERS),
            sizes_view=self.binary.view(sizes, name=SIZES),
        )
        return {"risorius": {**rig_to_json(self._rig), "topology": topology}}


def _material_to_json(name: str, part: str) -> dict[str, Any]:
    look = look_of(name, part)
    material: dict[str, Any] = {
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [*look.colour, 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": look.roughness,
        },
    }
    if look.both_sides:
        material["doubleSided"] = True
    return material


def _downwards(uvs: FloatArray) -> npt.NDArray[np.float32]:
    return np.stack([uvs[:, 0], 1.0 - uvs[:, 1]], axis=1).astype("<f4")


def _to_metres(frame: Frame, children: list[int]) -> dict[str, Any]:
    """Return a node that carries `children` from the input's frame to metres."""
    scale = frame.scale / _MILLIMETRES_PER_METRE
    matrix = np.eye(4)
    matrix[:3, :3] = scale * frame.rotation
    matrix[:3, 3] = -scale * frame.rotation @ frame.origin
    return {
        "name": "to_metres",
        "matrix": matrix.T.ravel().tolist(),
        "children": children,
        "extras": {"risorius": METRES_MARK},
    }


def _require_writable(rig: Rig, where: str) -> None:
    if not len(rig.mesh.corners):
        raise FormatError(f"{where}: a GLB needs polygons, the rig has only vertices")
    if rig.mesh.vertex_count > _LARGEST_EXACT:
        raise FormatError(f"{where}: more than {_LARGEST_EXACT} vertices cannot be numbered")
    arrays = {"the neutral": rig.mesh.positions, "texture coordinates": rig.mesh.uvs}
    arrays.update((f"target {target.name!r}", target.deltas) for target in rig.targets)
    for name, values in arrays.items():
        require_finite(values, f"{where}: {name}")
