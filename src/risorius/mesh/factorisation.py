"""Factor a symmetric positive definite sparse matrix once, solve many times."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from risorius._check import FloatArray
from risorius.errors import SolverError

__all__ = ["factorise"]


def factorise(matrix: csc_matrix) -> Callable[[FloatArray], FloatArray]:
    """Return the function that solves ``matrix @ x = right`` for (n,) or (n, d) right sides.

    Parameters
    ----------
    matrix : (n, n) csc_matrix
        Symmetric and positive definite.

    Raises
    ------
    SolverError
        If the matrix is singular.
    """
    try:
        # Symmetric mode keeps the pivots on the diagonal: a third of the fill of plain LU.
        factors = splu(
            matrix,
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:
        raise SolverError(
            f"factorisation of {matrix.shape[0]} unknowns failed ({error}); a part of the mesh "
            "hangs on nothing"
        ) from None

    def solve(right: FloatArray) -> FloatArray:
        return factors.solve(np.ascontiguousarray(right, dtype=np.float64))

    return solve
