"""Solvers that know particles and sparse systems only, no faces."""

__all__ = []
