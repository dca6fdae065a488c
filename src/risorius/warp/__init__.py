"""Scattered-data maps of space: similarity, affine, radial basis functions."""

from risorius.warp.network import NetworkWarp
from risorius.warp.rbf import RbfWarp
from risorius.warp.similarity import Affine, Similarity, fit_affine, fit_similarity

__all__ = ["Affine", "NetworkWarp", "RbfWarp", "Similarity", "fit_affine", "fit_similarity"]
