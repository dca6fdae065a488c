"""Types that several panels name."""

from __future__ import annotations

from typing import Any

__all__ = ["Message"]

Message = dict[str, Any]
"""What a page says: JSON that nobody has checked yet."""
