"""Read back the OBJ files that the generator writes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .part import Part, triangles_of

__all__ = ["read_object", "triangles"]


@dataclass
class _Open:
    """An object while its lines are read."""

    name: str
    vertex_base: int
    uv_base: int
    positions: list = field(default_factory=list)
    uvs: list = field(default_factory=list)
    polygons: list = field(default_factory=list)
    uv_polygons: list = field(default_factory=list)
    groups: list = field(default_factory=list)
    materials: list = field(default_factory=list)

    def close(self):
        """Return the object as a part with indices of its own."""
        polygons = [tuple(v - self.vertex_base for v in p) for p in self.polygons]
        return Part(
            self.name,
            np.array(self.positions),
            polygons,
            self.groups,
            self.materials,
            np.array(self.uvs).reshape(-1, 2),
            [tuple(t - self.uv_base for t in p) for p in self.uv_polygons],
        )


def read_object(path):
    """Return name -> Part of an OBJ file in file order."""
    parts, part, group, material = {}, _Open("", 0, 0), "", ""
    for line in path.read_text(encoding="ascii").splitlines():
        word, _, rest = line.partition(" ")
        if word == "o":
            parts[part.name] = part
            vertex_base = part.vertex_base + len(part.positions)
            part = _Open(rest, vertex_base, part.uv_base + len(part.uvs))
        elif word in ("v", "vt"):
            (part.positions if word == "v" else part.uvs).append([float(x) for x in rest.split()])
        elif word == "g":
            group = rest
        elif word == "usemtl":
            material = rest
        elif word == "f":
            corners = [corner.split("/") for corner in rest.split()]
            part.polygons.append(tuple(int(c[0]) - 1 for c in corners))
            if len(corners[0]) > 1:
                part.uv_polygons.append(tuple(int(c[1]) - 1 for c in corners))
            part.groups.append(group)
            part.materials.append(material)
    parts[part.name] = part
    return {name: p.close() for name, p in parts.items() if name}


def triangles(part, *, groups=None, without=()):
    """Return the fan triangles (t, 3) of the polygons in `groups` and not in `without`."""
    chosen = [
        polygon
        for polygon, group in zip(part.polygons, part.groups)
        if (groups is None or group in groups) and group not in without
    ]
    return triangles_of(chosen)
