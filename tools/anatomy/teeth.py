"""Teeth: one closed crown per tooth, set along the two dental arches, and the gums."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .fields import rotation, smooth_curve
from .part import Part
from .table import BITE_Y

__all__ = ["ARCHES", "Arch", "Crown", "crowns", "gums_part", "teeth_part"]


@dataclass(frozen=True)
class Arch:
    """One dental arch of the left half.

    Parameters
    ----------
    line : (k, 2) tuple
        x, z through the middle of the crowns, front to back [mm].
    widths, heights, depths : (7,) tuple
        Size of the crowns from the central incisor to the second molar [mm].
    sign : float
        +1 if the crowns grow down from above the bite (upper), -1 otherwise.
    """

    line: tuple
    widths: tuple
    heights: tuple
    depths: tuple
    sign: float


ARCHES = {
    "upper": Arch(
        ((0, 85.0), (9, 83.3), (17, 77.0), (22, 68), (26, 57), (28.5, 45)),
        (8.4, 6.6, 7.6, 7.0, 6.8, 10.0, 9.6),
        (10.5, 9.2, 10.2, 8.6, 8.0, 7.4, 7.0),
        (6.8, 6.8, 7.8, 9, 9, 10.5, 10.5),
        1.0,
    ),
    "lower": Arch(
        ((0, 82.3), (7, 81.3), (15, 76.0), (21, 66.0), (25.5, 55), (28.5, 43)),
        (5.3, 5.8, 6.8, 7.0, 7.1, 10.8, 10.2),
        (8.8, 9.2, 10.2, 8.8, 8.2, 7.6, 7.2),
        (5.8, 6.2, 7.4, 7.8, 8.2, 10, 10),
        -1.0,
    ),
}
_ANTERIOR = 3  # incisors and canine have an edge, the others a chewing surface


@dataclass(frozen=True)
class Crown:
    """One crown: middle (x, z), turn about y, size, and height of its free edge [mm]."""

    centre: np.ndarray
    turn: np.ndarray
    size: np.ndarray
    edge: float
    sign: float
    anterior: bool


def _arch_curve(arch):
    """Return the half arch as a dense curve (n, 3) at y = 0 with its arc length (n,).

    It runs on straight behind the last molar.
    """
    line = np.asarray(arch.line, float)
    curve = smooth_curve(np.column_stack([line[:, 0], np.zeros(len(line)), line[:, 1]]), 400)
    onward = curve[-1] - curve[-2]
    curve = np.vstack([curve, curve[-1] + 10.0 * onward / np.linalg.norm(onward)])
    step = np.linalg.norm(np.diff(curve, axis=0), axis=1)
    return curve, np.concatenate([[0.0], np.cumsum(step)])


def _at(curve, arc, where):
    return np.stack([np.interp(where, arc, curve[:, k]) for k in range(3)], axis=-1)


def _edge_height(arch, index):
    """Return the y of the free edge: the upper front teeth overlap the lower ones."""
    if arch.sign > 0:
        return BITE_Y - (1.4, 1.4, 0.8, 0.0, 0.0, 0.0, 0.0)[index]
    return BITE_Y - (0.3 if index < _ANTERIOR else 0.6)


def crowns(arch):
    """Return the crowns of the left half of `arch`, front to back."""
    curve, arc = _arch_curve(arch)
    out, begin = [], 0.0
    for index, size in enumerate(zip(arch.widths, arch.heights, arch.depths)):
        middle = begin + 0.5 * size[0]
        begin += size[0]
        along = _at(curve, arc, middle + 1.0) - _at(curve, arc, middle - 1.0)
        turn = rotation(0, np.degrees(np.arctan2(-along[2], along[0])), 0)
        out.append(
            Crown(
                _at(curve, arc, middle), turn, np.array(size), _edge_height(arch, index),
                arch.sign, index < _ANTERIOR,
            )
        )  # fmt: skip
    return out


def _crown_field(crown, points):
    """Field (n,) of a crown at `points` (n, 3): a superellipsoid that tapers along its height."""
    width, height, depth = crown.size
    local = (points - crown.centre) @ crown.turn
    rise = (points[:, 1] - crown.edge) * crown.sign / height  # 0 at the edge, 1 at the gum
    if crown.anterior:
        half_depth = 0.5 * depth * np.clip(0.30 + 0.75 * rise, 0.3, 1.0)
    else:
        half_depth = 0.5 * depth * np.clip(0.8 + 0.25 * rise, 0.7, 1.0)
    half_width = 0.485 * width * (1 - 0.10 * np.clip(rise, 0.0, 1.0))
    reach = (
        np.abs(local[:, 0] / half_width) ** 4
        + np.abs(local[:, 2] / half_depth) ** (3 if crown.anterior else 4)
        + np.abs((rise - 0.55) / 0.60) ** 6
    )
    return np.sqrt(reach + 1e-9) - 1.0


def _cube_sphere(cells):
    """Return unit directions and quads of a cube with `cells` (3,) cells per edge."""
    cells = np.asarray(cells)
    grid = np.stack(np.meshgrid(*(np.arange(c + 1) for c in cells), indexing="ij"), -1)
    grid = grid.reshape(-1, 3)
    on_shell = ((grid == 0) | (grid == cells)).any(axis=1)
    number = np.full(len(grid), -1)
    number[on_shell] = np.arange(on_shell.sum())
    number = number.reshape(cells + 1)
    quads = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side, flip in ((0, True), (cells[axis], False)):
            for i in range(cells[u]):
                for j in range(cells[v]):
                    corners = []
                    for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        at = [0, 0, 0]
                        at[axis], at[u], at[v] = side, i + du, j + dv
                        corners.append(int(number[tuple(at)]))
                    quads.append(tuple(corners[::-1] if flip else corners))
    shell = 2.0 * grid[on_shell] / cells - 1.0
    # keep the cells of the rounded cube about equal
    shell = np.tan(shell * np.pi / 4)
    return shell / np.linalg.norm(shell, axis=1)[:, None], quads


def _crown_surface(crown, directions):
    """Return the points (n, 3) where rays from the middle of the crown leave its field."""
    start = crown.centre + [0.0, crown.edge + 0.5 * crown.sign * crown.size[1], 0.0]
    ray = directions * crown.size[[0, 1, 2]] @ crown.turn.T
    ray /= np.linalg.norm(ray, axis=1)[:, None]
    near, far = np.zeros(len(ray)), np.full(len(ray), 12.0)
    for _ in range(40):
        middle = 0.5 * (near + far)
        inside = _crown_field(crown, start + ray * middle[:, None]) < 0
        near, far = np.where(inside, middle, near), np.where(inside, far, middle)
    return start + ray * near[:, None]


def _two_sides(blocks, name, material):
    """Join blocks of (positions, polygons) of the left half and their mirror images."""
    positions, polygons, count = [], [], 0
    for place, faces in blocks:
        for sign in (1, -1):
            positions.append(place * [sign, 1, 1])
            turned = faces if sign > 0 else [(p[0], *p[:0:-1]) for p in faces]
            polygons += [tuple(v + count for v in p) for p in turned]
            count += len(place)
    labels = [name] * len(polygons), [material] * len(polygons)
    return Part(name, np.vstack(positions), polygons, *labels)


def teeth_part(which):
    """Return the teeth of the "upper" or "lower" arch."""
    directions, quads = _cube_sphere((4, 4, 3))
    blocks = [(_crown_surface(crown, directions), quads) for crown in crowns(ARCHES[which])]
    return _two_sides(blocks, f"teeth_{which}", "teeth")


def gums_part(which):
    """Return the gum band of an arch: a closed tube over the necks and roots of the teeth."""
    arch = ARCHES[which]
    curve, arc = _arch_curve(arch)
    teeth = crowns(arch)
    ends = np.cumsum([0.0, *arch.widths])
    middles = 0.5 * (ends[1:] + ends[:-1])
    stations = np.concatenate([[0.0], np.column_stack([middles, ends[1:]]).ravel(), ends[-1:] + 2.0])
    rim = np.array([c.edge + c.sign * c.size[1] * 0.86 for c in teeth])
    lip = np.interp(stations, middles, rim)
    between = np.isin(stations, ends)
    lip = lip - arch.sign * 1.3 * between
    depth = np.interp(stations, middles, 0.5 * np.asarray(arch.depths) + 0.2)
    depth[-1] *= 0.35
    around = np.linspace(0.0, 2 * np.pi, 10, endpoint=False) + 0.1 * np.pi
    rows = []
    for at, height, half in zip(stations, lip, depth):
        along = _at(curve, arc, at + 0.5) - _at(curve, arc, max(at - 0.5, 0.0))
        if at == 0.0:
            along = np.array([1.0, 0.0, 0.0])
        outward = np.array([-along[2], 0.0, along[0]]) / np.linalg.norm(along)
        centre = _at(curve, arc, at) + [0.0, height + arch.sign * 2.8, 0.0] - 0.3 * outward
        side, up = np.cos(around), np.sin(around)
        power = 0.75
        rows.append(
            centre
            + (np.sign(side) * np.abs(side) ** power * half)[:, None] * outward
            + (np.sign(up) * np.abs(up) ** power * 2.8)[:, None] * [0.0, 1.0, 0.0]
        )
    return _closed_band(np.array(rows), f"gums_{which}")


def _closed_band(rows, name):
    """Return a tube whose rows (s, c, 3) start on the midline, mirrored and capped at the ends."""
    rows = rows.copy()
    rows[0, :, 0] = 0.0
    both = np.vstack([rows[:0:-1] * [-1, 1, 1], rows])
    sections, count = both.shape[:2]
    polygons = []
    for s in range(sections - 1):
        for c in range(count):
            d = (c + 1) % count
            polygons.append((s * count + c, (s + 1) * count + c, (s + 1) * count + d, s * count + d))
    last = (sections - 1) * count
    polygons.append(tuple(range(count)))
    polygons.append(tuple(last + k for k in range(count - 1, -1, -1)))
    return Part(name, both.reshape(-1, 3), polygons, [name] * len(polygons), ["gums"] * len(polygons))
