"""Long work with progress that a person may cancel."""

from __future__ import annotations

import threading

from risorius.errors import Cancelled

__all__ = ["Job"]


class Job:
    """Progress of one piece of long work, from its thread to the page.

    Parameters
    ----------
    title : str
    """

    def __init__(self, title: str) -> None:
        self.title = title
        self.stage = ""
        self.share = 0.0
        self._stop = threading.Event()

    def cancel(self) -> None:
        """Stop at the next step."""
        self._stop.set()

    @property
    def cancelled(self) -> bool:
        """Whether a person stopped it."""
        return self._stop.is_set()

    def step(self, stage: str) -> None:
        """Begin a stage.

        Raises
        ------
        Cancelled
            If a person stopped the work.
        """
        self.stage, self.share = stage, 0.0
        self._check()

    def tick(self, done: int, count: int, name: str) -> None:
        """Report progress inside a stage; the signature is that of `risorius.rig.bake`.

        Raises
        ------
        Cancelled
            If a person stopped the work.
        """
        self.share = done / max(count, 1)
        self.stage = f"{self.stage.split(':')[0]}: {name}"
        self._check()

    def _check(self) -> None:
        if self.cancelled:
            raise Cancelled(f"{self.title}: cancelled")
