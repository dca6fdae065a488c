"""Compiled loops of the layered face; plain arrays in and out."""

__all__: list[str] = []
