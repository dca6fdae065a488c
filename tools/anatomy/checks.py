"""Check the written assets and print a table of what was measured."""

from __future__ import annotations

import json

import numpy as np

from .closest import closest_on_mesh
from .intersections import intersecting_pairs
from .landmark_places import MIRROR_NAMES
from .mouth_bag import BAG_CENTRE, bag_radius
from .obj_reader import read_object, triangles
from .skin_field import skin_field
from .topology import border_loops, half_edges

__all__ = ["report"]

_GROUPS = {
    "face", "neck", "scalp", "mouth_bag", "vermilion_upper", "vermilion_lower", "ear_left",
    "ear_right", "lid_upper_left", "lid_lower_left", "lid_upper_right", "lid_lower_right",
}  # fmt: skip


def mirror_permutation(positions):
    """Return the index of the exact mirror image of every vertex, -1 where there is none."""
    place = {tuple(p): k for k, p in enumerate((positions + 0.0).tolist())}
    return np.array([place.get((-x + 0.0, y, z), -1) for x, y, z in (positions + 0.0).tolist()])


def _unpaired(part):
    """Number of polygons whose mirror image is not a polygon of the part."""
    image = mirror_permutation(part.positions)
    present = {frozenset(p) for p in part.polygons}
    return sum(frozenset(int(image[v]) for v in p) not in present for p in part.polygons)


def _topology(part, *, euler, loops):
    name, positions, faces = part.name, part.positions, triangles(part)
    edges = half_edges(faces)
    doubled = len(edges) - len(np.unique(edges, axis=0))
    undirected, uses = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    used = len(np.unique(faces))
    found = sorted(len(loop) for loop in border_loops(faces))
    corner = positions[faces]
    volume = np.einsum("ij,ij->", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])) / 6000
    image = mirror_permutation(positions)
    unpaired = _unpaired(part)
    return [
        (f"{name}: vertices, triangles", (used, len(faces)), used == len(positions)),
        (f"{name}: Euler number", used - len(undirected) + len(faces), used - len(undirected) + len(faces) == euler),
        (f"{name}: boundary loops", found, len(found) == loops),
        (f"{name}: edges of three or more faces", int((uses > 2).sum()), uses.max() <= 2),
        (f"{name}: doubled half-edges", doubled, doubled == 0),
        (f"{name}: volume [cm3]", round(float(volume), 1), volume > 0),
        (f"{name}: mirror images missing", int((image < 0).sum()), (image >= 0).all()),
        (f"{name}: polygons without image", unpaired, unpaired == 0),
    ]


def _quality(name, positions, faces):
    corner = positions[faces]
    edge = np.stack([np.linalg.norm(corner[:, k] - corner[:, k - 1], axis=1) for k in range(3)])
    area = 0.5 * np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
    quality = 4 * np.sqrt(3) * area / (edge**2).sum(axis=0)
    pairs = intersecting_pairs(positions, faces)
    where = np.round(corner[pairs[:6, 0]].mean(axis=1)).tolist() if len(pairs) else ""
    return [
        (f"{name}: quality mean, min", (round(float(quality.mean()), 3), round(float(quality.min()), 3)), quality.min() > 0.005),
        (f"{name}: crossing triangles", (len(pairs), where), len(pairs) == 0),
    ]


def _inside(parts, bones):
    """Bones inside the skin; teeth, gums and tongue inside the bag."""
    skin = parts["skin"]
    outer = triangles(skin, without=("mouth_bag",))
    rows = []
    for name, bone in bones.items():
        _, _, distance = closest_on_mesh(skin.positions, outer, bone.positions)
        outside = int((skin_field(bone.positions) > 0).sum())
        span = np.round(np.percentile(distance, [0, 5, 50]), 2).tolist()
        rows.append((f"{name}: vertices outside the skin", outside, outside == 0))
        rows.append((f"{name}: depth min, 5 %, 50 % [mm]", span, span[0] > 1.5 and span[1] > 3.5))
    bag = triangles(skin, groups=("mouth_bag",))
    for name in ("teeth_upper", "teeth_lower", "gums_upper", "gums_lower", "tongue"):
        place = parts[name].positions
        offset = place - BAG_CENTRE
        reach = np.linalg.norm(offset, axis=1)
        room = (bag_radius(offset / reach[:, None]) - reach).min()
        _, _, distance = closest_on_mesh(skin.positions, bag, place)
        rows.append((f"{name}: least distance to the bag [mm]", round(float(distance.min()), 2), room > 0.3))
    return rows


def _landmarks(folder, parts):
    marks = json.loads((folder / "head.landmarks.json").read_text())["landmarks"]
    positions = np.vstack([p.positions for p in parts.values()])
    x = {name: positions[mark["vertex"], 0] for name, mark in marks.items()}
    wrong = [n for n, m in MIRROR_NAMES.items() if not (x[n] > 0 > x[m])]
    return [
        ("landmarks: number", len(marks), len(marks) >= 85),
        ("landmarks: on the wrong side", wrong, not wrong),
    ]


def _lips(skin):
    upper = triangles(skin, groups=("vermilion_upper",))
    lower = triangles(skin, groups=("vermilion_lower",))
    shared = np.intersect1d(upper, lower)
    corners = np.isin(shared, np.unique(triangles(skin, groups=("mouth_bag",))), invert=True)
    _, _, gap = closest_on_mesh(skin.positions, upper, skin.positions[np.setdiff1d(lower, upper)])
    return [
        ("lips: vertices shared by upper and lower", len(shared), corners.sum() <= 20),
        ("lips: least gap [mm]", round(float(gap.min()), 4), gap.min() > 0.01),
    ]


def report(folder):
    """Print the table of checks for the assets in `folder`; return 0 if all hold."""
    parts = read_object(folder / "head.obj")
    bones = read_object(folder / "skull.obj")
    skin = parts["skin"]
    faces = triangles(skin)
    rows = _topology(skin, euler=-1, loops=3)
    rows += _quality("skin", skin.positions, faces)
    missing = sorted(_GROUPS - set(skin.groups))
    rows.append(("skin: groups missing", missing, not missing))
    ears = len(np.unique(triangles(skin, groups=("ear_left", "ear_right"))))
    rows.append(("skin: vertices of both ears", ears, ears <= 900))
    rows += _lips(skin)
    for name, part in parts.items():
        if name.startswith(("teeth", "gums", "tongue")):
            pieces = 14 if name.startswith("teeth") else 1
            rows += _topology(part, euler=2 * pieces, loops=0)
    for name, euler in (("cranium", None), ("mandible", 2)):
        part = bones[name]
        all_faces = triangles(part)
        edges = len(np.unique(np.sort(half_edges(all_faces), axis=1), axis=0))
        own = len(part.positions) - edges + len(all_faces)
        rows += _topology(part, euler=own if euler is None else euler, loops=0)
        rows += _quality(name, part.positions, all_faces)
    rows += _inside(parts, bones)
    rows += _landmarks(folder, parts)
    for label, value, holds in rows:
        print(f"{'ok  ' if holds else 'FAIL'} {label:45s} {value}")
    return 0 if all(holds for _, _, holds in rows) else 1
