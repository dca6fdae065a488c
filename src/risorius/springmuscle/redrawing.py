"""A face on another recipe: only what was drawn anew is fitted anew."""

from __future__ import annotations

from risorius.errors import ParameterError
from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.fit import fit_muscles
from risorius.springmuscle.recipe import OutlineRecipe

__all__ = ["redrawn"]


def redrawn(face: SpringFace, before: OutlineRecipe, after: OutlineRecipe) -> SpringFace:
    """Return the face on recipe `after`; muscles whose outline is that of `before` are kept.

    Equal to a face built on `after` from the start as far as the springs converge (0.02 mm), since
    what the kept muscles do alone is not settled again.

    Parameters
    ----------
    face : SpringFace
        Built by `SpringFace.build` on `before`.
    before, after : OutlineRecipe

    Raises
    ------
    LandmarkError, ParameterError
        If an outline cannot be laid on this head, or the face was not built on a recipe.
    """
    if face.ground is None:
        raise ParameterError("face: was built on fitted muscles; build it on a recipe to redraw")
    old = {outline.name: outline for outline in before.sided()}
    new = {outline.name: outline for outline in after.sided()}
    known = {
        muscle.name: muscle
        for muscle in face.muscles.muscles
        if muscle.name in new and old.get(muscle.name) == new[muscle.name]
    }
    return face.with_muscles(fit_muscles(after, face.ground, known=known))
