"""Edge flips, collapses and relaxation of a triangle mesh that lies on the skin."""

from __future__ import annotations

import numpy as np

from .topology import half_edges

__all__ = ["collapse_short", "collapsed", "flip_edges", "thin_border", "vertex_faces"]


def _normal(positions, a, b, c):
    return np.cross(positions[b] - positions[a], positions[c] - positions[a])


def _angle(positions, at, p, q):
    u, v = positions[p] - positions[at], positions[q] - positions[at]
    return np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(axis=1))


def _inner_edges(faces, vertex_count):
    """Return edge keys, the two faces and a, b, c, d of every edge a-b with corners c and d."""
    corners = np.vstack([faces, faces[:, [1, 2, 0]], faces[:, [2, 0, 1]]])
    owner = np.tile(np.arange(len(faces)), 3)
    low, high = corners[:, :2].min(axis=1), corners[:, :2].max(axis=1)
    key = low * vertex_count + high
    order = np.argsort(key, kind="stable")
    pair = np.flatnonzero(key[order][1:] == key[order][:-1])
    i, j = order[pair], order[pair + 1]
    a, b, c, d = corners[i, 0], corners[i, 1], corners[i, 2], corners[j, 2]
    return key[order], key[i], owner[i], owner[j], a, b, c, d


def flip_edges(faces, positions, locked, passes=6):
    """Flip edges whose opposite angles sum to more than 180 degrees; never a locked edge.

    Parameters
    ----------
    faces : (m, 3) int ndarray
    positions : (n, 3) ndarray
    locked : (k, 2) int ndarray
        Edges that stay, in any direction.
    """
    faces = faces.copy()
    n = len(positions)
    locked_keys = locked.min(axis=1) * n + locked.max(axis=1)
    for _ in range(passes):
        keys, key, f, g, a, b, c, d = _inner_edges(faces, n)
        opposite = _angle(positions, c, a, b) + _angle(positions, d, a, b)
        normal = _normal(positions, a, b, c) + _normal(positions, b, a, d)
        size = np.linalg.norm(normal, axis=1)
        wanted = (opposite > np.pi + 1e-3) & ~np.isin(key, locked_keys)
        for turned in (_normal(positions, c, d, a), _normal(positions, d, c, b)):
            turned_size = np.linalg.norm(turned, axis=1)
            wanted &= (turned * normal).sum(axis=1) > 0.1 * size * turned_size
        existing, touched, count = set(keys.tolist()), set(), 0
        for k in np.flatnonzero(wanted)[np.argsort(-opposite[wanted], kind="stable")]:
            new = min(c[k], d[k]) * n + max(c[k], d[k])
            if f[k] in touched or g[k] in touched or new in existing:
                continue
            faces[f[k]] = (c[k], a[k], d[k])
            faces[g[k]] = (d[k], b[k], c[k])
            touched |= {f[k], g[k]}
            existing.add(new)
            count += 1
        if count == 0:
            break
    return faces


def vertex_faces(faces, vertex):
    """Return a mask (m,) of the faces that use `vertex`."""
    return (faces == vertex).any(axis=1)


def collapsed(faces, vertex, into):
    """Return `faces` with `vertex` merged into `into` and the degenerate faces dropped."""
    merged = np.where(faces == vertex, into, faces)
    edges = half_edges(merged)
    return merged[(edges[:, 0] != edges[:, 1]).reshape(3, -1).all(axis=0)]


def _turns_over(positions, before, after, least_cosine):
    a = _normal(positions, *before.T)
    b = _normal(positions, *after.T)
    size = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
    return ((a * b).sum(axis=1) < least_cosine * size).any()


def _may_collapse(positions, faces, vertex, into, *, shared, least_cosine):
    of_vertex, of_target = vertex_faces(faces, vertex), vertex_faces(faces, into)
    common = set(faces[of_vertex].ravel()) & set(faces[of_target].ravel())
    if len(common - {vertex, into}) != shared:
        return False
    moving = faces[of_vertex & ~of_target]
    moved = np.where(moving == vertex, into, moving)
    return not _turns_over(positions, moving, moved, least_cosine)


def collapse_short(positions, faces, fixed, shortest):
    """Collapse edges shorter than `shortest` [mm] without moving any vertex.

    Parameters
    ----------
    fixed : (n,) bool ndarray
        Vertices that must survive.
    """
    for _ in range(400):
        edges = np.unique(np.sort(half_edges(faces), axis=1), axis=0)
        length = np.linalg.norm(positions[edges[:, 0]] - positions[edges[:, 1]], axis=1)
        done = False
        short = np.flatnonzero(length < shortest)
        for k in short[np.argsort(length[short], kind="stable")]:
            for vertex, into in (edges[k], edges[k][::-1]):
                if not fixed[vertex] and _may_collapse(
                    positions, faces, vertex, into, shared=2, least_cosine=0.3
                ):
                    faces, done = collapsed(faces, vertex, into), True
                    break
            if done:
                break
        if not done:
            break
    return faces


def thin_border(positions, faces, loops, longest):
    """Collapse vertices along the border `loops` while its edges stay below `longest` [mm]."""
    count = 0
    for loop in loops:
        k = 1
        while k < len(loop) - 1:
            before, vertex, after = loop[k - 1], loop[k], loop[k + 1]
            k += 1
            if np.linalg.norm(positions[before] - positions[after]) > longest:
                continue
            if _may_collapse(positions, faces, vertex, before, shared=1, least_cosine=0.2):
                faces = collapsed(faces, vertex, before)
                count += 1
                k += 1
    return faces, count
