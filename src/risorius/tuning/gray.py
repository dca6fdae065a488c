"""Gray code: neighbouring numbers differ in one bit, so a mutation may be a small step."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from risorius._check import IntArray

__all__ = ["from_gray_bits", "to_gray_bits"]

BitArray = npt.NDArray[np.uint8]


def to_gray_bits(codes: IntArray, bits: int) -> BitArray:
    """Return the Gray code (k, n) of `codes` (k,) in 0..2^bits - 1, highest bit first."""
    gray = codes ^ (codes >> 1)
    shifts = np.arange(bits - 1, -1, -1)
    return ((gray[:, None] >> shifts) & 1).astype(np.uint8)


def from_gray_bits(gray: BitArray) -> IntArray:
    """Return the codes (k,) of Gray code (k, n), highest bit first."""
    plain = np.bitwise_xor.accumulate(gray, axis=1)
    shifts = np.arange(gray.shape[1] - 1, -1, -1)
    return (plain.astype(np.int32) << shifts).sum(axis=1).astype(np.int32)
