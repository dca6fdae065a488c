"""Compiled loops of the anatomy; plain arrays in and out."""

__all__: list[str] = []
