"""Share a picture's rows, or many pictures, among threads."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextvars import ContextVar
from typing import Any, TypeVar

__all__ = ["in_bands", "in_parallel"]

Item = TypeVar("Item")
Made = TypeVar("Made")
# Whether the thread is one of several that draw a picture each.
_alone: ContextVar[bool] = ContextVar("alone", default=False)

_FEWEST_ROWS = 32
_BANDS_PER_WORKER = 4


def in_bands(kernel: Callable[..., Any], rows: range, *arguments: Any) -> None:
    """Call ``kernel(row_from, row_to, *arguments)`` on bands that cover `rows`.

    Each band writes only its own rows and visits the triangles in order, so the result does
    not depend on the number of threads. Threads live only during the call: a process may fork
    afterwards, and several threads may draw at once.
    """
    workers = 1 if _alone.get() else _worker_count()
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


def in_parallel(make: Callable[[Item], Made], items: Sequence[Item]) -> list[Made]:
    """Return ``make(item)`` of each, in order; every thread draws whole pictures.

    That costs less than to share each picture's rows, which are few in small pictures.
    """
    workers = min(_worker_count(), len(items))
    if workers < 2:
        return [make(item) for item in items]

    def made_alone(item: Item) -> Made:
        _alone.set(True)
        return make(item)

    with ThreadPoolExecutor(workers) as pool:
        return list(pool.map(made_alone, items))


def _worker_count() -> int:
    return min(_cpu_count(), 8)


def _cpu_count() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
