"""Build all default assets and write them, or check what is there."""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np

from .bones import bone_parts
from .eyes import eye_parts
from .gums import gums_part
from .labels import skin_groups, skin_materials
from .landmark_places import SKIN_PLACES
from .landmarks import bone_landmarks, head_landmarks, landmark_text
from .lashes import lashes_part
from .obj_writer import material_text, object_text
from .part import Part, mirror_part
from .projection import with_arch_uvs, with_top_uvs
from .skin import build_half_skin, mirror_half
from .table import EYE_CENTRE
from .teeth import teeth_part
from .tongue import tongue_part
from .unwrap import skin_uvs

__all__ = ["ASSETS", "build_head", "build_skull", "main"]

ASSETS = Path(__file__).parents[2] / "src" / "risorius" / "anatomy" / "assets"


def _skin_part(half):
    """Return the skin of both halves and the mirror image of every vertex of the left one."""
    groups = skin_groups(half)
    uvs, uv_polygons = skin_uvs(half, groups)
    positions, polygons, image = mirror_half(half.positions, half.polygons)
    materials = 2 * skin_materials(half, groups)
    groups = groups + [group.replace("left", "right") for group in groups]
    # polygons of one group follow each other, so that the file stays readable
    order = sorted(range(len(polygons)), key=lambda k: (groups[k], materials[k]))
    groups = [groups[k] for k in order]
    part = Part(
        "skin",
        positions,
        [polygons[k] for k in order],
        groups,
        [materials[k] for k in order],
        uvs,
        [uv_polygons[k] for k in order],
    )
    return part, image


def build_head():
    """Return the texts of head.obj, head.mtl and head.landmarks.json."""
    half = build_half_skin(np.array(list(SKIN_PLACES.values()), float))
    skin, image = _skin_part(half)
    parts = [skin, *eye_parts()]
    parts += [with_arch_uvs(teeth_part(which)) for which in ("upper", "lower")]
    parts += [with_arch_uvs(gums_part(which)) for which in ("upper", "lower")]
    parts.append(with_top_uvs(tongue_part()))
    lashes = lashes_part(half, EYE_CENTRE)
    parts += [lashes, mirror_part(lashes, "lashes_right")]
    materials = sorted({name for part in parts for name in part.materials})
    return {
        "head.obj": object_text(parts, library="head.mtl"),
        "head.mtl": material_text(materials),
        "head.landmarks.json": landmark_text(head_landmarks(parts, half, image)),
    }


def build_skull():
    """Return the texts of skull.obj and skull.landmarks.json."""
    parts = bone_parts()
    return {
        "skull.obj": object_text(parts),
        "skull.landmarks.json": landmark_text(bone_landmarks(parts)),
    }


def _write(texts, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        temporary = folder / (name + ".part")
        temporary.write_text(text, encoding="ascii", newline="\n")
        temporary.replace(folder / name)
        print(f"{name}: {len(text)} bytes")


def main(arguments=None):
    """Run the command line; return the exit status."""
    parser = argparse.ArgumentParser(prog="tools.anatomy", description=__doc__)
    parser.add_argument("--out", type=Path, default=ASSETS, help="folder of the assets")
    parser.add_argument("--only", choices=["head", "skull"], help="build one of the two files")
    parser.add_argument("--check", action="store_true", help="check the files instead of building")
    options = parser.parse_args(arguments)
    if options.check:
        from .checks import report

        return report(options.out)
    begin = time.perf_counter()
    for name, build in (("head", build_head), ("skull", build_skull)):
        if options.only in (None, name):
            _write(build(), options.out)
            print(f"{name}: {time.perf_counter() - begin:.1f} s")
    return 0
