"""Share a picture's rows among threads."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

__all__ = ["in_bands"]

_FEWEST_ROWS = 32
_BANDS_PER_WORKER = 4


def in_bands(kernel: Callable[..., Any], rows: range, *arguments: Any) -> None:
    """Call ``kernel(row_from, row_to, *arguments)`` on bands that cover `rows`.

    Each band writes only its own rows and visits the triangles in order, so the result does
    not depend on the number of threads. Threads live only during the call: a process may fork
    afterwards, and several threads may draw at once.
    """
    workers = min(_cpu_count(), 8)
    bands = min(workers * _BANDS_PER_WORKER, len(rows) // _FEWEST_ROWS)
    if workers == 1 or bands < 2:
        kernel(rows.start, rows.stop, *arguments)
        return
    edges = [rows.start + len(rows) * band // bands for band in range(bands + 1)]
    with ThreadPoolExecutor(workers) as pool:
        running = [
            pool.submit(kernel, edges[band], edges[band + 1], *arguments) for band in range(bands)
        ]
        for band in running:
            band.result()


def _cpu_count() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
