"""The spring-muscle face: muscles fitted under the skin from outlines (Kaehler et al. 2001)."""

from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.fit_parameters import FitParameters
from risorius.springmuscle.live import LiveFace
from risorius.springmuscle.parameters import SpringParameters
from risorius.springmuscle.recipe import MuscleOutline, OutlineRecipe
from risorius.springmuscle.recipe_file import (
    default_recipe,
    parse_recipe,
    read_recipe,
    recipe_text,
    write_recipe,
)

__all__ = [
    "FitParameters",
    "LiveFace",
    "MuscleOutline",
    "OutlineRecipe",
    "SpringFace",
    "SpringParameters",
    "default_recipe",
    "parse_recipe",
    "read_recipe",
    "recipe_text",
    "write_recipe",
]
