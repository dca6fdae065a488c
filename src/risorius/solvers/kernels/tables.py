"""How the arrays of the kernels lie.

Particles are rows of four numbers x, y, z, inverse mass, in one flat array; behind the particles
proper come one row per capped hole (its centroid) and spare rows that fill up groups. `lanes` keeps
three vectors x, y, z per particle instead, and the inverse masses apart.

Constraints are in the order in which they are projected. In sequence form (scalar, lanes) entry c
of a table belongs to constraint c and its particles follow each other. In packed form a group of
`PACK` constraints lies together: first all their first particles, then all their second ones, and
each is named by the place of its x.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

__all__ = ["ContactTables", "Multipliers", "RingTables", "Tables", "VolumeTables", "aligned_zeros"]

Table = npt.NDArray[Any]


class Tables(NamedTuple):
    """All constraints but volumes and contacts, flat.

    `*_stiffness` holds k, or in a compliant run the compliance a; the weight W of a distance never
    changes, so its gain is k / W, or 1 / (W + a), once and for all.
    """

    hold_particles: Table
    hold_stiffness: Table
    pairs: Table
    distance_rest: Table
    distance_gain: Table
    distance_compliance: Table
    corners: Table
    area_rest: Table
    area_limit: Table
    area_stiffness: Table
    flaps: Table
    bend_sine: Table
    bend_cosine: Table
    bend_stiffness: Table
    bend_limit: Table


class VolumeTables(NamedTuple):
    """Volumes: `*_start` give the first entry of each volume (or hole), and the end.

    `faces` flat, three each; `particles` every row that a volume touches, its caps' centroids
    included; `rims` the holes' rims; `cap_rows` the rows of their centroids.
    """

    faces: Table
    face_start: Table
    particles: Table
    particle_start: Table
    rims: Table
    rim_start: Table
    cap_start: Table
    cap_rows: Table
    stiffness: Table


class RingTables(NamedTuple):
    """Rings around the particles of volumes; see `rings`.

    Groups of `PACK` particles in packed form, of one in sequence form. `group_start` gives the
    first group of each volume; `rows` the particles; `rings` their neighbours turn by turn,
    closed, from `ring_start` of each group on; `caps` the rows of the holes whose rims they are on
    (a row of zeros for others), where `has_rim`; `gradients` is scratch of the packed form. Empty
    where a surface has no simple rings.
    """

    group_start: Table
    rows: Table
    ring_start: Table
    rings: Table
    caps: Table
    has_rim: Table
    gradients: Table


class ContactTables(NamedTuple):
    """Contacts: flat points and normals, three numbers (lanes: three vectors) each."""

    particles: Table
    points: Table
    normals: Table
    stiffness: Table


class Multipliers(NamedTuple):
    """What each constraint has pushed so far in this step (compliant runs), as the tables lie."""

    holds: Table
    distances: Table
    areas: Table
    bends: Table
    volumes: Table


def aligned_zeros(count: int, dtype: npt.DTypeLike) -> Table:
    """Return a flat array (count,) of zeros that starts on a cache line."""
    size = count * np.dtype(dtype).itemsize
    raw = np.zeros(size + 64, np.uint8)
    start = -raw.ctypes.data % 64
    return raw[start : start + size].view(dtype)
