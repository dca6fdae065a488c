"""Check the written assets and print a table of what was measured."""

from __future__ import annotations

import json

import numpy as np

from .closest import closest_on_mesh
from .landmark_places import MIRROR_NAMES
from .measures import quality_rows, topology_rows
from .mouth_bag import BAG_CENTRE, bag_radius
from .obj_reader import read_object, triangles
from .skin_field import skin_field

__all__ = ["report"]

_GROUPS = {
    "face", "neck", "scalp", "mouth_bag", "vermilion_upper", "vermilion_lower", "ear_left",
    "ear_right", "lid_upper_left", "lid_lower_left", "lid_upper_right", "lid_lower_right",
}  # fmt: skip
_IN_BAG = ("teeth_upper", "teeth_lower", "gums_upper", "gums_lower", "tongue")
_TEETH_PER_ARCH = 14


def _bone_depth(skin, bone):
    """Return checks of how deep the bone lies under the skin."""
    outer = triangles(skin, without=("mouth_bag",))
    _, _, distance = closest_on_mesh(skin.positions, outer, bone.positions)
    outside = int((skin_field(bone.positions) > 0).sum())
    span = np.round(np.percentile(distance, [0, 5, 50]), 2).tolist()
    return [
        (f"{bone.name}: vertices outside the skin", outside, outside == 0),
        (f"{bone.name}: depth least, 5 %, 50 % [mm]", span, span[0] > 1.5 and span[1] > 3.5),
    ]


def _inside_bag(skin, part):
    """Return the check that a part lies in the mouth bag."""
    offset = part.positions - BAG_CENTRE
    reach = np.linalg.norm(offset, axis=1)
    room = (bag_radius(offset / reach[:, None]) - reach).min()
    bag = triangles(skin, groups=("mouth_bag",))
    _, _, distance = closest_on_mesh(skin.positions, bag, part.positions)
    least = round(float(distance.min()), 2)
    return (f"{part.name}: least distance to the bag [mm]", least, room > 0.3 and least > 0.3)


def _lips(skin):
    """Return checks that the lips touch at the corners only."""
    upper = triangles(skin, groups=("vermilion_upper",))
    lower = triangles(skin, groups=("vermilion_lower",))
    shared = skin.positions[np.intersect1d(upper, lower)]
    spread = round(float(np.ptp(np.abs(shared[:, 0]))), 2)
    own = skin.positions[np.setdiff1d(lower, upper)]
    gap = closest_on_mesh(skin.positions, upper, own)[2].min()
    return [
        ("lips: shared vertices, spread in x [mm]", (len(shared), spread), spread < 3),
        ("lips: least gap [mm]", round(float(gap), 4), gap > 0.01),
    ]


def _groups(skin):
    missing = sorted(_GROUPS - set(skin.groups))
    ears = len(np.unique(triangles(skin, groups=("ear_left", "ear_right"))))
    return [
        ("skin: groups missing", missing, not missing),
        ("skin: vertices of both ears", ears, ears <= 900),
    ]


def _landmarks(folder, parts):
    marks = json.loads((folder / "head.landmarks.json").read_text("ascii"))["landmarks"]
    positions = np.vstack([p.positions for p in parts.values()])
    x = {name: positions[mark["vertex"], 0] for name, mark in marks.items()}
    wrong = [n for n, m in MIRROR_NAMES.items() if not x[n] > 0 > x[m]]
    return [
        ("landmarks: number", len(marks), len(marks) >= 85),
        ("landmarks: on the wrong side", wrong, not wrong),
    ]


def report(folder):
    """Print the table of checks for the assets in `folder`; return 0 if all hold."""
    parts = read_object(folder / "head.obj")
    bones = read_object(folder / "skull.obj")
    skin = parts["skin"]
    rows = topology_rows(skin, euler=2 - 3, loops=3) + quality_rows(skin)
    rows += _groups(skin) + _lips(skin)
    for name in _IN_BAG:
        pieces = _TEETH_PER_ARCH if name.startswith("teeth") else 1
        rows += topology_rows(parts[name], euler=2 * pieces, loops=0)
        rows.append(_inside_bag(skin, parts[name]))
    # orbits, nose and arches give the cranium its handles
    for name, euler in (("cranium", -10), ("mandible", 2)):
        rows += topology_rows(bones[name], euler=euler, loops=0) + quality_rows(bones[name])
        rows += _bone_depth(skin, bones[name])
    rows += _landmarks(folder, parts)
    for label, value, holds in rows:
        print(f"{'ok  ' if holds else 'FAIL'} {label:45s} {value}")
    return 0 if all(holds for _, _, holds in rows) else 1
