"""Faces that many tests look at; each is built once."""

from __future__ import annotations

from functools import cache

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.template import builtin_head
from risorius.head import Head
from risorius.vectormuscle import VectorFace
from tests.synthetic import assemble, head_pieces, head_specs


@cache
def builtin_face() -> VectorFace:
    """Return the default face of the built-in head."""
    return VectorFace.build(builtin_head())


@cache
def made_up_head(kind: str = "bag") -> Head:
    """Return the synthetic head: no eye holes, everything else present."""
    return Head.from_mesh(assemble(head_pieces(kind)), head_specs(kind))


@cache
def made_up_mechanics() -> Mechanics:
    """Return the moving parts of the synthetic head."""
    return Mechanics.build(made_up_head())


def mirror_vertices(positions: npt.NDArray[np.float64]) -> npt.NDArray[np.int_]:
    """Return the mirror partner (n,) of every vertex of an exactly symmetric mesh."""
    distance, partner = cKDTree(positions).query(positions * [-1.0, 1.0, 1.0])
    assert distance.max() < 1e-9
    assert (partner[partner] == np.arange(len(positions))).all()
    return partner
