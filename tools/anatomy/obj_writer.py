"""Write parts as a Wavefront OBJ file, byte for byte the same for the same parts."""

from __future__ import annotations

import numpy as np

__all__ = ["COLOURS", "material_text", "object_text"]

COLOURS = {
    "skin": (0.80, 0.60, 0.49),
    "lips": (0.70, 0.40, 0.36),
    "brow": (0.38, 0.26, 0.19),
    "caruncle": (0.80, 0.48, 0.43),
    "lashes": (0.10, 0.07, 0.06),
    "mouth": (0.36, 0.12, 0.12),
    "sclera": (0.93, 0.92, 0.90),
    "iris": (0.30, 0.20, 0.12),
    "pupil": (0.02, 0.02, 0.02),
    "teeth": (0.93, 0.91, 0.84),
    "gums": (0.70, 0.36, 0.36),
    "tongue": (0.74, 0.38, 0.38),
    "bone": (0.87, 0.82, 0.70),
}


def _number(value, digits):
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _corner(vertex, uv):
    return f"{vertex + 1}" if uv is None else f"{vertex + 1}/{uv + 1}"


def object_text(parts, *, library=""):
    """Return the text of an OBJ file; vertices of the parts follow each other [mm]."""
    lines = ["# risorius default anatomy, mm, +X left, +Y up, +Z forward"]
    lines += [f"mtllib {library}"] if library else []
    vertex_base = uv_base = 0
    for part in parts:
        lines.append(f"o {part.name}")
        lines += ["v " + " ".join(_number(x, 5) for x in p) for p in part.positions]
        lines += ["vt " + " ".join(_number(x, 5) for x in p) for p in part.uvs]
        group = material = None
        for index, polygon in enumerate(part.polygons):
            if part.groups[index] != group:
                group = part.groups[index]
                lines.append(f"g {group}")
            if part.materials[index] != material:
                material = part.materials[index]
                lines.append(f"usemtl {material}")
            uvs = part.uv_polygons[index] if part.uv_polygons else [None] * len(polygon)
            corners = [
                _corner(v + vertex_base, None if t is None else t + uv_base)
                for v, t in zip(polygon, uvs)
            ]
            lines.append("f " + " ".join(corners))
        vertex_base += len(part.positions)
        uv_base += len(part.uvs)
    return "\n".join(lines) + "\n"


def material_text(names):
    """Return the text of an MTL file with one plain colour per material."""
    lines = []
    for name in names:
        colour = " ".join(f"{np.float64(c):.2f}" for c in COLOURS[name])
        lines += [f"newmtl {name}", f"Kd {colour}", ""]
    return "\n".join(lines)
