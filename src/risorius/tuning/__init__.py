"""Tuning by choosing: nine faces, a few picks, the next nine."""

from risorius.tuning.candidates import Candidates, FunctionCandidates, PoseCandidates
from risorius.tuning.genome import Genome, Parameter
from risorius.tuning.muscle_genes import MuscleCandidates, apply_genes, muscle_parameters
from risorius.tuning.objective import ShapeObjective
from risorius.tuning.session import Session, tune
from risorius.tuning.strategy import STRATEGIES, Generation, Strategy
from risorius.tuning.style import Style, parse_style

__all__ = [
    "STRATEGIES",
    "Candidates",
    "FunctionCandidates",
    "Generation",
    "Genome",
    "MuscleCandidates",
    "Parameter",
    "PoseCandidates",
    "Session",
    "ShapeObjective",
    "Strategy",
    "Style",
    "apply_genes",
    "muscle_parameters",
    "parse_style",
    "tune",
]
