"""Whatever is asked of the face, it answers with a face."""

from __future__ import annotations

import numpy as np

from benchmarks.robustness import FARTHEST, sequences
from tests.layered.faces import builtin_layered


def test_random_sequences_stay_finite_bounded_and_come_back_to_rest() -> None:
    trial = sequences(builtin_layered(), count=40, length=5, seed=5)
    assert trial.finite
    assert trial.farthest < FARTHEST
    assert trial.history_free
    assert trial.back_at_rest


def test_the_trial_notices_a_face_that_remembers() -> None:
    face = builtin_layered()

    class Remembering:
        controls = face.controls
        head = face.head

        def __init__(self) -> None:
            self.last = np.zeros_like(face.head.positions)

        def pose(self, pose: dict[str, float]) -> np.ndarray:
            posed = face.pose(pose) + 1e-6 * self.last
            self.last = posed - face.head.positions
            return posed

    trial = sequences(Remembering(), count=2, length=3, seed=1)
    assert not trial.history_free
    assert not trial.back_at_rest
