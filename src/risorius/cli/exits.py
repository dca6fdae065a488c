"""Exit codes of every verb."""

from __future__ import annotations

__all__ = ["INTERRUPTED", "REFUSED", "USAGE"]

REFUSED = 1
"""The input is refused or not fit."""
USAGE = 2
"""The command was written wrongly."""
INTERRUPTED = 130
"""Stopped by Ctrl-C."""
