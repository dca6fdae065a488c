"""The head: parts, landmarks, frame and unit."""

from risorius.head.frame import MILLIMETRES, Frame, detect_frame
from risorius.head.head import Head, HeadOptions
from risorius.head.part import PART_KINDS, Part

__all__ = ["MILLIMETRES", "PART_KINDS", "Frame", "Head", "HeadOptions", "Part", "detect_frame"]
