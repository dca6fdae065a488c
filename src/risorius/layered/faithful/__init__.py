"""The published layered face: action lines, muscle meshes and skin by position-based dynamics."""

from risorius.layered.faithful.face import FaithfulFace
from risorius.layered.faithful.parameters import FaithfulParameters

__all__ = ["FaithfulFace", "FaithfulParameters"]
