from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import ParameterError, ShapeError
from risorius.playback.inner_products import inner_products
from risorius.playback.small_basis import small_basis
from risorius.rig import Rig
from tests.playback.rigs import played_rig

NAMES = (
    "jawOpen",
    "mouthSmileLeft",
    "mouthSmileRight",
    "browInnerUp",
    "eyeBlinkLeft",
    "mouthPucker",
)


def _rig() -> Rig:
    return played_rig().subset(NAMES)


def _poses(count: int = 40) -> np.ndarray:
    return np.random.default_rng(4).uniform(0.0, 1.0, (count, len(NAMES)))


def _distance(rig: Rig, weights: np.ndarray, small, poses: np.ndarray) -> float:
    """Return the error of `weights` of the small rig, by posing both."""
    moving = inner_products(rig)[1]
    squares = 0.0
    for row, pose in zip(weights, poses):
        large = rig.posed(dict(zip(rig.names, pose)))
        squares += ((small.rig.posed(dict(zip(small.rig.names, row))) - large) ** 2).sum()
    return float(np.sqrt(squares / len(poses) / moving)) * rig.frame.scale


def test_as_many_components_as_shapes_lose_nothing() -> None:
    rig, poses = _rig(), _poses()
    small = small_basis(rig, poses, count=len(NAMES))
    assert small.error_curve[0] > 0.1
    assert small.error_curve[-1] < 1e-6 * small.error_curve[0]
    assert _distance(rig, small.weights(poses), small, poses) < 1e-6


def test_the_stated_error_is_that_of_the_posed_rigs() -> None:
    rig, poses = _rig(), _poses()
    small = small_basis(rig, poses, count=2)
    assert len(small.rig.targets) == 2
    assert _distance(rig, small.weights(poses), small, poses) == pytest.approx(small.error_curve[2])


def test_the_error_falls_with_every_component() -> None:
    curve = small_basis(_rig(), _poses(), count=6).error_curve
    assert (np.diff(curve) < 0.0).all()


def test_no_other_basis_of_one_shape_is_better() -> None:
    rig, poses = _rig(), _poses()
    best = small_basis(rig, poses, count=1).error_curve[1]
    gram, moving = inner_products(rig)
    for column in np.random.default_rng(1).normal(size=(20, len(NAMES))):
        share = poses @ gram @ column / (column @ gram @ column)
        apart = poses - np.outer(share, column)
        other = np.sqrt(np.einsum("pi,ij,pj->p", apart, gram, apart).mean() / moving)
        assert best <= other + 1e-9


def test_poses_on_a_line_need_one_component() -> None:
    poses = np.outer(np.linspace(0.0, 1.0, 5), [1.0, 0.5, 0.5, 0.0, 0.0, 0.0])
    small = small_basis(_rig(), poses, count=6)
    assert len(small.rig.targets) == 1
    assert small.error_curve[-1] < 1e-6 * small.error_curve[0]


def test_what_cannot_be_compressed_is_refused() -> None:
    with pytest.raises(ParameterError, match="no pose moves anything"):
        small_basis(_rig(), np.zeros((3, len(NAMES))), count=2)
    with pytest.raises(ParameterError, match="count: 0 is below 1"):
        small_basis(_rig(), _poses(), count=0)
    with pytest.raises(ShapeError, match=r"weights: expected shape \(n, 6\)"):
        small_basis(_rig(), np.zeros((3, 2)), count=1)
