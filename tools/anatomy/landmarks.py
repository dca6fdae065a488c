"""Landmarks bound to the generated meshes."""

from __future__ import annotations

import json

import numpy as np

from .arches import ARCHES, crowns
from .closest import closest_on_mesh
from .eye_loops import CREASE_ROW
from .landmark_places import BONE_PLACES, EAR_PLACES, MIRROR_NAMES, SKIN_PLACES
from .mouth_loops import BORDER_ROW, COLUMNS_PER_LIP
from .part import triangles_of
from .tongue import TONGUE_COLUMNS, TONGUE_ROWS

__all__ = ["bone_landmarks", "head_landmarks", "landmark_text"]

# rows outside of the lower lid margin where the lid ends
_LOWER_LID_ROW = 2
# rows behind the tip of the tongue where its body is widest
_BEHIND_TIP = 6


def _nearest(positions, place, candidates=None):
    candidates = np.arange(len(positions)) if candidates is None else candidates
    return int(candidates[np.linalg.norm(positions[candidates] - place, axis=1).argmin()])


def _mouth(half):
    """Return lip landmarks of the left half by row and column."""
    slit = half.mouth_rows[half.mouth_margin]
    border = half.mouth_rows[half.mouth_margin - BORDER_ROW]
    corner, last = COLUMNS_PER_LIP, 2 * COLUMNS_PER_LIP
    place = half.positions[border]
    half_way = 0.5 * place[corner, 0]
    upper = int(np.abs(place[:corner, 0] - half_way).argmin())
    lower = corner + int(np.abs(place[corner:, 0] - half_way).argmin())
    bow = 1 + int(place[1 : corner // 2 + 1, 1].argmax())
    inner_x = half.positions[slit[: corner + 1], 0]
    inner = int(np.abs(inner_x[:-1] - 0.5 * inner_x[-1]).argmin())
    return {
        "2.2": slit[0], "2.3": slit[last], "2.4": slit[corner], "2.6": slit[inner],
        "2.8": slit[last - inner], "8.1": border[0], "8.2": border[last], "8.3": border[corner],
        "8.5": border[upper], "8.7": border[lower], "8.10": border[bow],
    }  # fmt: skip


def _lids(half):
    """Return eyelid landmarks of the left eye by row and column."""
    margin = half.eye_rows[half.eye_margin]
    place = half.positions[margin]
    top, bottom = int(place[:, 1].argmax()), int(place[:, 1].argmin())
    return {
        "3.1": margin[top],
        "3.3": margin[bottom],
        "3.7": margin[int(place[:, 0].argmax())],
        "3.11": margin[int(place[:, 0].argmin())],
        "3.13": half.eye_rows[half.eye_margin - CREASE_ROW][top],
        "3.9": half.eye_rows[half.eye_margin - _LOWER_LID_ROW][bottom],
    }


def _brow(half):
    """Return eyebrow landmarks of the left half."""
    start, eyebrow = half.brow_start, half.brow
    return {
        "4.1": start + eyebrow.inner_end,
        "4.3": start + eyebrow.top,
        "4.5": start + eyebrow.outer_end,
    }


def _tongue():
    """Return vertex numbers inside the tongue."""
    row, quarter = TONGUE_ROWS - _BEHIND_TIP, TONGUE_COLUMNS // 4
    first = row * TONGUE_COLUMNS
    return {
        "6.1": TONGUE_ROWS * TONGUE_COLUMNS + 1,
        "6.2": first + quarter,
        "6.3": first,
        "6.4": first + 2 * quarter,
    }


def _incisors(part, which):
    """Return the vertices of the left central incisor at the gum and at the edge, near x = 0."""
    crown = crowns(ARCHES[which])[0]
    count = len(part.positions) // (2 * len(ARCHES[which].widths))
    block = np.arange(count)
    depth = 0.5 * crown.size[2]
    gum = crown.centre + [-4.0, crown.edge + crown.sign * crown.size[1], depth]
    edge = crown.centre + [-3.0, crown.edge, 0.0]
    return _nearest(part.positions, gum, block), _nearest(part.positions, edge, block)


def head_landmarks(parts, half, image):
    """Return name -> vertex in the file's order.

    Parameters
    ----------
    parts : list of Part
        In the order of the file, the skin first.
    half : HalfSkin
    image : (h,) int ndarray
        Mirror image of every vertex of the left half.
    """
    begin = dict(zip([p.name for p in parts], np.cumsum([0] + [len(p.positions) for p in parts])))
    by_name = {p.name: p for p in parts}
    ears = np.unique(
        np.concatenate([p for p, k in zip(half.polygons, half.labels.kind) if k == "ear"])
    )
    left = {**_mouth(half), **_lids(half), **_brow(half)}
    midline = np.flatnonzero(half.positions[:, 0] == 0.0)
    for name, place in SKIN_PLACES.items():
        left[name] = _nearest(half.positions, place, midline if place[0] == 0 else None)
    for name, place in EAR_PLACES.items():
        left[name] = _nearest(half.positions, place, ears)
    marks = {name: int(vertex) for name, vertex in left.items()}
    for name, mirror in MIRROR_NAMES.items():
        if name in left:
            marks[mirror] = int(image[left[name]])
    marks["3.5"], marks["3.6"] = int(begin["eye_left"]), int(begin["eye_right"])
    for name, vertex in _tongue().items():
        marks[name] = int(begin["tongue"] + vertex)
    for which, gum_name, edge_name in (("upper", "9.8", "9.10"), ("lower", "9.9", "9.11")):
        gum, edge = _incisors(by_name[f"teeth_{which}"], which)
        marks[gum_name] = int(begin[f"teeth_{which}"] + gum)
        marks[edge_name] = int(begin[f"teeth_{which}"] + edge)
    return {name: {"vertex": vertex} for name, vertex in marks.items()}


def _on_midline(positions, faces, target):
    """Return face and weights (3,) of the point of the midline edges closest to `target`."""
    middle = positions[faces][:, :, 0] == 0.0
    rows = np.flatnonzero(middle.sum(axis=1) == 2)
    ends = np.sort(np.argsort(~middle[rows], axis=1, kind="stable")[:, :2], axis=1)
    a, b = (positions[faces[rows, ends[:, k]]] for k in (0, 1))
    along = ((target - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1)
    along = np.clip(along, 0.0, 1.0)
    best = int(np.linalg.norm(a + along[:, None] * (b - a) - target, axis=1).argmin())
    weights = np.zeros(3)
    weights[ends[best]] = 1.0 - along[best], along[best]
    return int(rows[best]), weights


def bone_landmarks(parts):
    """Return name -> surface point of cranium and mandible, faces in the file's order.

    The faces of the right half follow those of the left in the same order, corners reversed.
    """
    marks, begin = {}, 0
    for part in parts:
        faces = triangles_of(part.polygons)
        left = faces[: len(faces) // 2]
        for name, place in BONE_PLACES[part.name].items():
            target = np.array(place, float)
            if target[0] == 0.0:
                face, weights = _on_midline(part.positions, left, target)
            else:
                found, found_weights, _ = closest_on_mesh(part.positions, left, target[None])
                face, weights = int(found[0]), found_weights[0]
            weights = np.round(weights, 6)
            weights[weights.argmax()] += 1.0 - weights.sum()
            marks[name] = {"face": begin + face, "bary": np.round(weights, 6).tolist()}
            if name.endswith("_l"):
                mirrored = {"face": begin + face + len(left), "bary": marks[name]["bary"][::-1]}
                marks[name[:-1] + "r"] = mirrored
        begin += len(faces)
    return marks


def _order(name):
    numbers = name.split(".")
    return (0, *map(int, numbers)) if numbers[0].isdigit() else (1, name)


def landmark_text(marks):
    """Return the text of a landmark file, names in order."""
    rows = [f"  {json.dumps(n)}: {json.dumps(marks[n])}" for n in sorted(marks, key=_order)]
    head = '{\n "schema": "risorius/landmarks",\n "version": 1,\n "landmarks": {\n'
    return head + ",\n".join(rows) + "\n }\n}\n"
