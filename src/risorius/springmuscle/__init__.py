"""The spring-muscle face: muscles fitted under the skin from outlines (Kaehler et al. 2001)."""

__all__ = []
