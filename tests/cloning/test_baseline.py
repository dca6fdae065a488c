"""The baseline of the benchmark is sound: a quick version of it on the built-in head."""

from __future__ import annotations

import numpy as np

from benchmarks.cloning.baselines import deformation_transfer
from risorius.anatomy.template import builtin_head
from risorius.cloning import motion_error
from tests.cloning.rigs import dense, other_cloning, other_head, source_rig


def shapes() -> np.ndarray:
    rows = [source_rig().names.index(name) for name in ("jawOpen", "smile")]
    return dense(source_rig())[rows]


def test_transfer_onto_itself_gives_the_shapes_back() -> None:
    skin = builtin_head().skin.first_source()
    made = deformation_transfer(builtin_head(), builtin_head(), shapes())
    for truth, moved in zip(shapes(), made):
        assert motion_error(truth[skin], moved[skin]) < 0.1


def test_cloning_is_nearer_to_the_truth_than_transfer() -> None:
    skin = other_head().skin.first_source()
    other = deformation_transfer(builtin_head(), other_head(), shapes())
    for truth, moved, ours in zip(shapes(), other, other_cloning().carry(shapes())):
        theirs = motion_error(truth[skin], moved[skin])
        assert motion_error(truth[skin], ours[skin]) < theirs < 30.0
