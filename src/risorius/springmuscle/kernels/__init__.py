"""Compiled arithmetic of ellipsoids, contraction and binding."""

__all__ = []
