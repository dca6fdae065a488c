"""Tuning by choosing: nine faces, a few picks, the next nine."""

from risorius.tuning.candidates import Candidates, FunctionCandidates, Gallery, PoseCandidates
from risorius.tuning.fit import ShapeFit, fit_shape
from risorius.tuning.genome import Genome, Parameter
from risorius.tuning.intensities import IntensityCandidates
from risorius.tuning.map_genes import MapCandidates
from risorius.tuning.muscle_genes import MuscleCandidates, apply_genes, muscle_parameters
from risorius.tuning.objective import ShapeObjective
from risorius.tuning.outline_genes import OutlineCandidates
from risorius.tuning.session import Session, tune
from risorius.tuning.strategy import STRATEGIES, Generation, Strategy
from risorius.tuning.style import Style, parse_style

__all__ = [
    "STRATEGIES",
    "Candidates",
    "FunctionCandidates",
    "Gallery",
    "Generation",
    "Genome",
    "IntensityCandidates",
    "MapCandidates",
    "MuscleCandidates",
    "OutlineCandidates",
    "Parameter",
    "PoseCandidates",
    "Session",
    "ShapeFit",
    "ShapeObjective",
    "Strategy",
    "Style",
    "apply_genes",
    "fit_shape",
    "muscle_parameters",
    "parse_style",
    "tune",
]
