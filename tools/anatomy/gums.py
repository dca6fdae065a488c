"""Gums: a closed band over the necks and roots of each row of teeth."""

from __future__ import annotations

import numpy as np

from .arches import ARCHES, arch_curve, crowns, point_at
from .part import Part

__all__ = ["gums_part"]

_AROUND = 10
_HALF_HEIGHT, _ROUNDNESS = 2.8, 0.75
_PAPILLA = 1.3  # how far the gum reaches between two teeth [mm]


def _stations(arch):
    """Return arc length, height of the rim and half depth (s,) from the midline to the end."""
    ends = np.cumsum([0.0, *arch.widths])
    middles = 0.5 * (ends[1:] + ends[:-1])
    inner = np.column_stack([middles, ends[1:]]).ravel()
    at = np.concatenate([[0.0], inner, ends[-1:] + 2.0])
    rim = np.array([c.edge + c.sign * c.size[1] * 0.86 for c in crowns(arch)])
    height = np.interp(at, middles, rim) - arch.sign * _PAPILLA * np.isin(at, ends)
    half_depth = np.interp(at, middles, 0.5 * np.asarray(arch.depths) + 0.2)
    half_depth[-1] *= 0.35
    return at, height, half_depth


def _rounded(values):
    return np.sign(values) * np.abs(values) ** _ROUNDNESS


def _rows(arch):
    """Return the sections (s, c, 3) of the left half of the band, the first one on x = 0."""
    curve, arc = arch_curve(arch)
    around = np.linspace(0.0, 2 * np.pi, _AROUND, endpoint=False) + 0.1 * np.pi
    side, up = _rounded(np.cos(around)), _rounded(np.sin(around))
    rows = []
    for at, height, half_depth in zip(*_stations(arch)):
        along = point_at(curve, arc, at + 0.5) - point_at(curve, arc, max(at - 0.5, 0.0))
        if at == 0.0:
            along = np.array([1.0, 0.0, 0.0])
        outward = np.array([-along[2], 0.0, along[0]]) / np.linalg.norm(along)
        middle = np.array([0.0, height + arch.sign * _HALF_HEIGHT, 0.0]) - 0.3 * outward
        rows.append(
            point_at(curve, arc, at)
            + middle
            + side[:, None] * half_depth * outward
            + up[:, None] * np.array([0.0, _HALF_HEIGHT, 0.0])
        )
    rows = np.array(rows)
    rows[0, :, 0] = 0.0
    return rows


def gums_part(which):
    """Return the gums of the "upper" or "lower" arch."""
    half = _rows(ARCHES[which])
    rows = np.vstack([half[:0:-1] * [-1, 1, 1], half])
    sections, count = rows.shape[:2]
    index = np.arange(sections * count).reshape(sections, count)
    beside = np.roll(index, -1, axis=1)
    band = np.stack([index[:-1], index[1:], beside[1:], beside[:-1]], axis=-1).reshape(-1, 4)
    polygons = [tuple(quad) for quad in band.tolist()]
    polygons.append(tuple(index[0].tolist()))
    polygons.append(tuple(index[-1, ::-1].tolist()))
    name = f"gums_{which}"
    labels = [name] * len(polygons), ["gums"] * len(polygons)
    return Part(name, rows.reshape(-1, 3), polygons, *labels)
