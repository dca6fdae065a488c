"""Inner products of a rig's targets: how far apart two poses are, without posing them."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_matrix

from risorius._check import FloatArray
from risorius.rig.rig import Rig

__all__ = ["inner_products"]


def inner_products(rig: Rig) -> tuple[FloatArray, int]:
    """Return the inner products (t, t) of all targets [mm^2], and how many vertices ever move."""
    if not rig.targets:
        return np.zeros((0, 0)), 0
    columns = [rig.frame.vectors_to_canonical(target.deltas).ravel() for target in rig.targets]
    rows = [
        (3 * target.vertices[:, None].astype(np.int64) + np.arange(3)).ravel()
        for target in rig.targets
    ]
    starts = np.concatenate([[0], np.cumsum([len(column) for column in columns])])
    table = csc_matrix(
        (np.concatenate(columns), np.concatenate(rows), starts),
        shape=(3 * rig.mesh.vertex_count, len(columns)),
    )
    moving = len(np.unique(np.concatenate([target.vertices for target in rig.targets])))
    return np.asarray((table.T @ table).todense()), moving
