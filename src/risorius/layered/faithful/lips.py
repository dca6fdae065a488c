"""Lips that lie on one another: the contact that the published face lacks (open point O9)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.lip_contact import LipContact
from risorius.solvers.constraints import Contacts

__all__ = ["joined_contacts", "lip_contacts"]

# Skin that must give way by less than this is left alone [mm].
_TOUCHING = 1e-3


def lip_contacts(lips: LipContact, positions: FloatArray) -> Contacts | None:
    """Return contacts for lips that have passed through each other, None if none has.

    Both lines are asked to give way by half the depth, and the lips with them, fading with the
    distance from the lines.

    Parameters
    ----------
    lips : LipContact
    positions : (n, 3) float64
        Skin [mm].
    """
    moved = positions - lips.rest
    lift = lips.part(moved)[:, 1] - moved[:, 1]
    rows = np.flatnonzero(np.abs(lift) > _TOUCHING).astype(np.int32)
    if not len(rows):
        return None
    way = np.zeros((len(rows), 3))
    way[:, 1] = np.sign(lift[rows])
    points = positions[rows] + np.abs(lift[rows, None]) * way
    return Contacts(rows, points, way)


def joined_contacts(contacts: Sequence[Contacts | None]) -> Contacts | None:
    """Return all contacts as one table, None if there are none."""
    found = [one for one in contacts if one is not None]
    if not found:
        return None
    return Contacts(
        np.concatenate([one.particles for one in found]),
        np.concatenate([one.points for one in found]),
        np.concatenate([one.normals for one in found]),
    )
