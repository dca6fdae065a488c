"""Sums of shapes."""

from __future__ import annotations

import numpy as np

from risorius.rig import MorphTarget, Rig
from risorius.rig.quality import played_sums, with_sums
from risorius.rig.quality.sums import PLAYED
from tests.synthetic import quad_mesh

NAMES = ("jawOpen", "mouthClose", "other")


def small_rig() -> Rig:
    mesh = quad_mesh()
    moves = np.random.default_rng(3).normal(size=(3, mesh.vertex_count, 3))
    return Rig(mesh, tuple(MorphTarget.from_dense(n, m) for n, m in zip(NAMES, moves)))


def test_a_sum_moves_as_its_weighted_shapes_do() -> None:
    rig = small_rig()
    count = rig.mesh.vertex_count
    summed = with_sums(rig, ["jawOpen=0.5+other", "jawOpen=0.5+other"])
    assert summed.names == (*NAMES, "jawOpen=0.5+other")
    expected = 0.5 * rig.target("jawOpen").dense(count) + rig.target("other").dense(count)
    np.testing.assert_allclose(summed.targets[-1].dense(count), expected, atol=1e-12)


def test_only_sums_of_shapes_that_are_there_are_played() -> None:
    assert played_sums(small_rig()) == ("jawOpen+mouthClose",)
    assert len(set(PLAYED)) == len(PLAYED)
