"""Vector muscles: closed-form pulls on the skin (Waters 1987; Bui et al. 2003)."""

from risorius.vectormuscle.export import Export, ExportParameters, export_muscles
from risorius.vectormuscle.export_points import FeatureSet, find_features
from risorius.vectormuscle.face import VectorFace, VectorParameters
from risorius.vectormuscle.muscle import VectorMuscle, register_kind
from risorius.vectormuscle.vector_set import VectorSet, default_vector_set, parse_vector_set

__all__ = [
    "Export",
    "ExportParameters",
    "FeatureSet",
    "VectorFace",
    "VectorMuscle",
    "VectorParameters",
    "VectorSet",
    "default_vector_set",
    "export_muscles",
    "find_features",
    "parse_vector_set",
    "register_kind",
]
