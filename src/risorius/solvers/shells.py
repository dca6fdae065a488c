"""Closed surfaces of volume constraints in the rows of the kernels, and rings around their rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.solvers.constraints import Volume
from risorius.solvers.kernels.tables import RingTables, VolumeTables
from risorius.solvers.model import Model

__all__ = ["Shell", "ring_tables", "shells_of", "volume_tables"]

_Rows = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Shell:
    """The surface of one volume, its holes capped.

    Parameters
    ----------
    volume : Volume
    faces : (m, 3) int64
        Rows of the kernels, caps included.
    rims : list of (k,) int64
        Rows of each hole's rim.
    cap_rows : list of int
        Rows of the holes' centroids.
    """

    volume: Volume
    faces: _Rows
    rims: list[_Rows]
    cap_rows: list[int]


def shells_of(model: Model, rank: _Rows) -> list[Shell]:
    """Return the shell of every volume of `model`; rank (n,) is the row of each particle."""
    shells: list[Shell] = []
    row = model.particle_count
    for volume in model.constraints.volumes:
        tables, rims, cap_rows = [rank[volume.faces]], [], []
        for hole in volume.holes:
            rim = rank[hole]
            tables.append(np.stack([np.roll(rim, -1), rim, np.full(len(rim), row)], axis=1))
            rims.append(rim)
            cap_rows.append(row)
            row += 1
        faces = np.concatenate(tables)
        # In the order of their particles in memory.
        faces = faces[np.argsort(faces.min(axis=1), kind="stable")]
        shells.append(Shell(volume, faces, rims, cap_rows))
    return shells


def _starts(tables: list[_Rows]) -> _Rows:
    return np.cumsum([0, *(len(table) for table in tables)]).astype(np.int64)


def _joined(tables: list[_Rows]) -> npt.NDArray[np.uint32]:
    return np.concatenate([np.zeros(0, np.int64), *tables]).astype(np.uint32)


def volume_tables(shells: list[Shell], strength: FloatArray) -> VolumeTables:
    """Return the tables of all shells; strength (v,) is their stiffness or compliance."""
    touched = [np.unique(shell.faces) for shell in shells]
    rims = [rim for shell in shells for rim in shell.rims]
    caps = [np.asarray(shell.cap_rows, np.int64) for shell in shells]
    face_tables = [shell.faces for shell in shells]
    return VolumeTables(
        faces=_joined([table.ravel() for table in face_tables]),
        face_start=_starts(face_tables),
        particles=_joined(touched),
        particle_start=_starts(touched),
        rims=_joined(rims),
        rim_start=_starts(rims),
        cap_start=_starts(caps),
        cap_rows=_joined(caps),
        stiffness=strength,
    )


def ring_tables(shells: list[Shell], zero_row: int, *, width: int) -> RingTables:
    """Return the rings of all shells, or empty tables if one has a row without a simple ring.

    Groups hold `width` particles. Rows from `zero_row` on belong to no particle and hold no
    gradient; they fill up groups.
    """
    rows: list[_Rows] = []
    rings: list[_Rows] = []
    caps: list[_Rows] = []
    group_start = [0]
    for shell in shells:
        found = _rings(shell)
        if found is None:
            return _packed([], [], [], [0] * (len(shells) + 1), zero_row, width=width)
        centres, lengths, around = found
        cap_of = dict.fromkeys(centres.tolist(), zero_row)
        for rim, row in zip(shell.rims, shell.cap_rows):
            cap_of.update(dict.fromkeys(rim.tolist(), row))
        cap = np.array([cap_of[row] for row in centres.tolist()], np.int64)
        order = np.lexsort((centres, lengths, cap != zero_row))
        for first in range(0, len(order), width):
            chosen = order[first : first + width]
            rows.append(centres[chosen])
            rings.append(around[chosen, : lengths[chosen].max() + 1])
            caps.append(cap[chosen])
        group_start.append(len(rows))
    return _packed(rows, rings, caps, group_start, zero_row, width=width)


def _packed(
    rows: list[_Rows],
    rings: list[_Rows],
    caps: list[_Rows],
    group_start: list[int],
    zero_row: int,
    *,
    width: int,
) -> RingTables:
    """Fill up each group to `width` rows and lay the rings out turn by turn."""
    spare = zero_row + np.arange(width)
    full_rows, full_rings, full_caps = [], [], []
    for row, ring, cap in zip(rows, rings, caps):
        missing = spare[: width - len(row)]
        full_rows.append(np.concatenate([row, missing]))
        full_caps.append(np.concatenate([cap, np.full(len(missing), zero_row)]))
        stay = np.broadcast_to(missing[:, None], (len(missing), ring.shape[1]))
        full_rings.append(np.concatenate([ring, stay]).T.ravel())
    has_rim = np.array([bool((cap != zero_row).any()) for cap in caps], np.bool_)
    return RingTables(
        group_start=np.asarray(group_start, np.int64),
        rows=_joined(full_rows),
        ring_start=_starts(full_rings),
        rings=_joined(full_rings),
        caps=_joined(full_caps),
        has_rim=has_rim,
        gradients=np.zeros(3 * width * len(rows), np.float32),
    )


def _rings(shell: Shell) -> tuple[_Rows, _Rows, _Rows] | None:
    """Return the particles (k,) of a shell, ring lengths (k,), rings (k, longest + 1), or None.

    Each ring is closed: its first neighbour comes again after its last one, and from there on.
    """
    # Each corner a of a face (a, b, c) leads from neighbour b to neighbour c.
    around = np.concatenate([np.roll(shell.faces, -turn, axis=1) for turn in range(3)])
    around = around[~np.isin(around[:, 0], shell.cap_rows)]
    span = int(around.max(initial=0)) + 1
    keys = around[:, 0] * span + around[:, 1]
    order = np.argsort(keys)
    keys, following = keys[order], around[order, 2]
    if not len(keys) or (keys[1:] == keys[:-1]).any():
        return None
    centres, first, lengths = np.unique(keys // span, return_index=True, return_counts=True)
    here = keys[first] % span
    rings = np.empty((len(centres), int(lengths.max()) + 1), np.int64)
    rings[:, 0] = here
    for turn in range(1, rings.shape[1]):
        wanted = centres * span + here
        place = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        if (keys[place] != wanted).any():
            return None
        # A ring that has closed stays where it is; one that closes too early is not simple.
        after = np.where(turn <= lengths, following[place], here)
        if ((after == rings[:, 0]) & (turn < lengths)).any():
            return None
        rings[:, turn] = here = after
    closed = rings[np.arange(len(centres)), lengths] == rings[:, 0]
    return (centres, lengths, rings) if closed.all() else None
