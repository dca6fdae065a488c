"""Motion of the standards on any head: FAP shapes, streams to weights, players and converters."""

from risorius.playback.face_units import face_units
from risorius.playback.fap_shapes import FapShape, FapShapes, solve_fap_shapes
from risorius.playback.reading import FapReading

__all__ = ["FapReading", "FapShape", "FapShapes", "face_units", "solve_fap_shapes"]
