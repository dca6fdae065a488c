"""Streams of motion: MPEG-4 parameters, Live Link Face, tables and JSON of weights."""

from risorius.io.motion.registry import read_stream, stream_endings, write_stream

__all__ = ["read_stream", "stream_endings", "write_stream"]
