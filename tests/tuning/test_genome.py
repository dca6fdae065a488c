"""Parameters and their code."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ParameterError, ShapeError
from risorius.tuning import Genome, Parameter
from risorius.tuning.gray import from_gray_bits, to_gray_bits

GENOME = Genome((Parameter("stiffness", 0.0, 10.0, 2.0), Parameter("thickness", -1.0, 1.0, 0.0)))


@given(st.integers(1, 12))
def test_gray_neighbours_differ_in_one_bit(bits: int) -> None:
    codes = np.arange(1 << bits, dtype=np.int32)
    gray = to_gray_bits(codes, bits)
    assert (np.abs(np.diff(gray.astype(int), axis=0)).sum(axis=1) == 1).all()
    assert (from_gray_bits(gray) == codes).all()


@given(st.floats(0.0, 10.0), st.floats(-1.0, 1.0), st.integers(1, 16))
def test_a_value_survives_its_code_to_half_a_quantum(a: float, b: float, bits: int) -> None:
    genome = Genome(GENOME.parameters, bits)
    code = genome.encode(np.array([a, b]), low=genome.low, high=genome.high)
    back = genome.decode(code, low=genome.low, high=genome.high)
    quantum = (genome.high - genome.low) / (1 << bits)
    assert (np.abs(back - [a, b]) <= 0.5 * quantum + 1e-12).all()


def test_values_out_of_a_narrowed_range_are_taken_to_its_end() -> None:
    low, high = np.array([4.0, 0.0]), np.array([5.0, 0.5])
    back = GENOME.decode(
        GENOME.encode(np.array([9.0, -1.0]), low=low, high=high), low=low, high=high
    )
    assert ((back > low) & (back < high)).all()
    assert back[0] > 4.99 and back[1] < 0.01


def test_names_and_rows_belong_together() -> None:
    assert GENOME.named(GENOME.start) == {"stiffness": 2.0, "thickness": 0.0}
    assert GENOME.values({"thickness": 0.5}).tolist() == [2.0, 0.5]


def test_senseless_genomes_are_refused() -> None:
    with pytest.raises(ParameterError, match="nothing to tune"):
        Genome(())
    with pytest.raises(ParameterError, match="listed twice"):
        Genome((GENOME.parameters[0],) * 2)
    with pytest.raises(ParameterError, match="must be below"):
        Parameter("wrong", 1.0, 1.0, 1.0)
    with pytest.raises(ParameterError, match="above 1"):
        Parameter("wrong", 0.0, 1.0, 2.0)
    with pytest.raises(ParameterError, match=r"must lie in 1\.\.24"):
        Genome(GENOME.parameters, 0)
    with pytest.raises(ParameterError, match="there is no depth; it has stiffness, thickness"):
        GENOME.values({"depth": 1.0})
    with pytest.raises(ShapeError, match="expected 2 finite numbers"):
        GENOME.named([1.0, np.nan])
