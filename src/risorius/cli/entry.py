"""The entry point of the console script: imports next to nothing before it can be interrupted."""

from __future__ import annotations

import os
import signal
import sys
from types import FrameType

from risorius.cli.exits import INTERRUPTED

__all__ = ["run"]


def run() -> None:
    """Run the program.

    Reading the libraries takes up to a second, and Ctrl-C in it would surface as whatever error
    the library at hand makes of it; until they are there it ends the process at once.
    """
    previous = signal.signal(signal.SIGINT, _leave)
    from risorius.cli.main import app

    signal.signal(signal.SIGINT, previous)
    try:
        app()
    except KeyboardInterrupt:
        sys.stderr.write("interrupted\n")
        sys.exit(INTERRUPTED)


def _leave(_signal: int, _frame: FrameType | None) -> None:
    # Nothing is open yet, so nothing is lost by leaving without the interpreter's clean-up.
    sys.stderr.write("interrupted\n")
    sys.stderr.flush()
    os._exit(INTERRUPTED)
