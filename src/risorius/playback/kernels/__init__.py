"""Compiled loops of the player; plain functions on plain arrays, without threads."""

__all__ = []
