"""Compiled projections: one set of formulas, three ways to run it.

`formulas` holds the arithmetic, written once for numbers and for vectors of floats (`simd`,
`memory`). `scalar` runs it on one pose in float64, constraint after constraint: the reference.
`packed` runs it on one pose in float32, `simd.PACK` constraints that share no particle at a time.
`lanes` runs it on `simd.LANES` poses in float32, one constraint at a time, each pose in its lane.
All three follow the same order of constraints, so they agree to rounding. `tables` says how the
arrays lie; `rings`, `lane_volumes` and `single` do volumes, and what is done particle by particle.

No kernel uses threads, and none leaves the order of a sum to chance: same input, same bytes. Numba
checks a cached kernel only against its own source file: who edits one of these files deletes the
caches of the others (`*.nbi`, `*.nbc`).
"""

__all__ = []
