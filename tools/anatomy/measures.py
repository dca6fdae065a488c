"""What can be measured on one part."""

from __future__ import annotations

import numpy as np

from .intersections import intersecting_pairs
from .obj_reader import triangles
from .topology import border_loops, half_edges

__all__ = ["Row", "mirror_permutation", "quality_rows", "topology_rows"]

# label, measured value, whether the rule holds
Row = tuple[str, object, bool]


def mirror_permutation(positions):
    """Return the index of the exact mirror image of every vertex, -1 where there is none."""
    place = {tuple(p): k for k, p in enumerate((positions + 0.0).tolist())}
    return np.array([place.get((-x + 0.0, y, z), -1) for x, y, z in (positions + 0.0).tolist()])


def _unpaired(part, image):
    """Return the number of polygons whose mirror image is not a polygon of the part."""
    present = {frozenset(p) for p in part.polygons}
    return sum(frozenset(int(image[v]) for v in p) not in present for p in part.polygons)


def topology_rows(part, *, euler, loops):
    """Return checks of counts, Euler number, borders, manifold edges, orientation, symmetry."""
    name, positions, faces = part.name, part.positions, triangles(part)
    edges = half_edges(faces)
    doubled = len(edges) - len(np.unique(edges, axis=0))
    undirected, uses = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    used = len(np.unique(faces))
    number = used - len(undirected) + len(faces)
    borders = sorted(len(loop) for loop in border_loops(faces))
    corner = positions[faces]
    volume = np.einsum("ij,ij->", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])) / 6000
    image = mirror_permutation(positions)
    unpaired = _unpaired(part, image)
    return [
        (f"{name}: vertices, triangles", (used, len(faces)), used == len(positions)),
        (f"{name}: Euler number", number, number == euler),
        (f"{name}: boundary loops", borders, len(borders) == loops),
        (f"{name}: edges of three or more faces", int((uses > 2).sum()), uses.max() <= 2),
        (f"{name}: doubled half-edges", doubled, doubled == 0),
        (f"{name}: volume [cm3]", round(float(volume), 1), volume > 0),
        (f"{name}: mirror images missing", int((image < 0).sum()), bool((image >= 0).all())),
        (f"{name}: polygons without image", unpaired, unpaired == 0),
    ]


def quality_rows(part):
    """Return checks of the shape of the triangles and of crossings."""
    positions, faces = part.positions, triangles(part)
    corner = positions[faces]
    sides = corner - np.roll(corner, 1, axis=1)
    area = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    quality = 4 * np.sqrt(3) * area / (sides**2).sum(axis=(1, 2))
    span = round(float(quality.mean()), 3), round(float(quality.min()), 3)
    pairs = intersecting_pairs(positions, faces)
    where = np.round(corner[pairs[:6, 0]].mean(axis=1)).tolist()
    return [
        (f"{part.name}: quality of triangles, mean, least", span, span[1] > 0.005),
        (f"{part.name}: crossing triangles", (len(pairs), where), len(pairs) == 0),
    ]
