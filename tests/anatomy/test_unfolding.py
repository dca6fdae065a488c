"""Skin that is pushed together gives way around instead of turning its back."""

from __future__ import annotations

import numpy as np
import pytest

from tests.layered.faces import builtin_layered

SKIN = builtin_layered().skin
FOLDS = builtin_layered().contact.folds


def _pushed(amount: float, *, place: str = "5.3") -> np.ndarray:
    """Return the cheek carried upwards onto skin that stays where it is (n, 3) [mm]."""
    centre = builtin_layered().head.landmarks.position(place)
    offset = (SKIN.positions - centre) @ [0.0, 1.0, 0.0]
    near = np.linalg.norm(SKIN.positions - centre, axis=1) < 30.0
    moved = np.zeros_like(SKIN.positions)
    moved[:, 1] = amount * near / (1.0 + np.exp(offset / 1.5))
    return moved


def _least_share(moved: np.ndarray) -> float:
    """Return the smallest share of its area that a face still shows to its surroundings."""
    cross = FOLDS._crosses(FOLDS.rest + moved[FOLDS.vertices])
    seen = np.einsum("fd,fd->f", cross, FOLDS._surroundings(cross)) / FOLDS.size
    return float(seen[FOLDS.counts].min())


def test_skin_that_does_not_fold_is_not_touched() -> None:
    rest = np.zeros_like(SKIN.positions)
    assert FOLDS.relieve(rest) is rest
    slight = _pushed(0.5)
    assert FOLDS.relieve(slight) is slight


@pytest.mark.parametrize("amount", [9.0, 14.0])
def test_a_fold_opens(amount: float) -> None:
    folded = _pushed(amount)
    assert _least_share(folded) < 0.0
    opened = FOLDS.relieve(folded)
    assert _least_share(opened) > 0.05
    kept = np.linalg.norm(opened, axis=1).max() / np.linalg.norm(folded, axis=1).max()
    assert kept > 0.8


def test_it_acts_only_beside_the_fold() -> None:
    folded = _pushed(14.0)
    changed = np.abs(FOLDS.relieve(folded) - folded).max(axis=1) > 1e-9
    far = np.linalg.norm(SKIN.positions - builtin_layered().head.landmarks.position("5.3"), axis=1)
    assert changed.sum() > 0
    assert far[changed].max() < 60.0


def test_it_is_mirror_symmetric() -> None:
    left, right = FOLDS.relieve(_pushed(12.0)), FOLDS.relieve(_pushed(12.0, place="5.4"))
    np.testing.assert_allclose(SKIN.mirrored(left), right, atol=1e-6)
