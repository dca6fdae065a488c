"""Plain functions on plain arrays, compiled."""

__all__ = []
