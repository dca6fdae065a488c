from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from risorius.errors import ShapeError
from risorius.playback.poser import Poser
from tests.playback.rigs import played_rig


def _rows(count: int) -> np.ndarray:
    rng = np.random.default_rng(2)
    rows = rng.uniform(0.0, 1.0, (count, len(played_rig().targets)))
    return rows * (rng.random(rows.shape) < 0.2)


def test_blocks_equal_the_rig_posed_frame_by_frame() -> None:
    rig, rows = played_rig(), _rows(70)
    size = np.ptp(rig.mesh.positions, axis=0).max()
    for row, positions in zip(rows, Poser(rig).frames(rows), strict=True):
        wanted = rig.posed(dict(zip(rig.names, row)))
        assert np.abs(positions - wanted).max() < 1e-5 * size


def test_rest_is_the_neutral_head() -> None:
    rig = played_rig()
    (positions,) = Poser(rig).frames([np.zeros(len(rig.targets))])
    assert np.array_equal(positions, rig.mesh.positions.astype(np.float32))


def test_the_memory_for_a_long_stream_is_that_of_a_block() -> None:
    poser, rows = Poser(played_rig()), _rows(32)
    peaks = []
    for repeats in (2, 8):
        tracemalloc.start()
        for _ in poser.frames(row for _ in range(repeats) for row in rows):
            pass
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < 1.1 * peaks[0]


def test_a_wrong_number_of_weights_is_refused() -> None:
    with pytest.raises(ShapeError, match="weights: expected shape"):
        Poser(played_rig()).block(np.zeros((1, 3)))
