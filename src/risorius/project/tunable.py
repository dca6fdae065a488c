"""The muscles of a project as something to tune: which take part, and what they become."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Protocol

from risorius.anatomy.mechanics import Mechanics
from risorius.controls.control import Pose
from risorius.head.head import Head
from risorius.io.atomic import write_json
from risorius.layered.faithful import FaithfulFace
from risorius.layered.muscle_map import MuscleMap
from risorius.layered.workbench import Workbench
from risorius.project.layered import muscle_map_of, require_no_parameters, skull_of
from risorius.project.project import Project
from risorius.project.springs import recipe_of, spring_face
from risorius.rig.face import Face
from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.recipe_file import write_recipe
from risorius.springmuscle.redrawing import redrawn
from risorius.tuning.candidates import FaceCandidates
from risorius.tuning.change import Genes
from risorius.tuning.map_genes import MapCandidates, map_muscles
from risorius.tuning.outline_genes import OutlineCandidates, outline_muscles
from risorius.tuning.style import Style

__all__ = ["Tunable", "TunableMap", "TunableRecipe", "tunable_of"]


class Tunable(Protocol):
    """Muscles of one method bound to one head."""

    @property
    def face(self) -> Face:
        """The face before tuning."""
        ...

    def muscles(self, pose: Pose) -> tuple[str, ...]:
        """Return the muscles (without side) that a pose contracts."""
        ...

    def candidates(
        self, names: Sequence[str], pose: Pose, *, style: Style, genes: Genes
    ) -> FaceCandidates:
        """Return candidates for some muscles; all others wear a style."""
        ...

    def face_in(self, style: Style) -> Face:
        """Return the face in a style."""
        ...

    def write(self, style: Style, path: Path) -> int:
        """Write the recipe in a style; return the number of its muscles."""
        ...


def tunable_of(project: Project, head: Head, *, mechanics: Mechanics) -> Tunable:
    """Return what can be tuned of a project with layered or spring muscles.

    Raises
    ------
    RisoriusError
        If something of the project is refused.
    """
    made = {"layered": TunableMap, "springs": TunableRecipe}[project.method]
    return made(project, head, mechanics)


class TunableMap:
    """A muscle map on a head."""

    def __init__(self, project: Project, head: Head, mechanics: Mechanics) -> None:
        require_no_parameters(project)
        self.muscle_map = muscle_map_of(project)
        skull = skull_of(project, self.muscle_map)
        self._bench: Workbench | None = None
        self._build: Callable[[MuscleMap], Face]
        self.face: Face
        if project.profile == "faithful":
            self._build = lambda drawn: FaithfulFace.build(
                head, drawn, skull=skull, mechanics=mechanics
            )
            self.face = self._build(self.muscle_map)
        else:
            self._bench = Workbench.build(head, self.muscle_map, skull=skull, mechanics=mechanics)
            self._build = lambda drawn: self._redrawn(drawn).face
            self.face = self._bench.face

    def muscles(self, pose: Pose) -> tuple[str, ...]:
        """Return the muscles (without side) that a pose contracts."""
        return map_muscles(self.muscle_map, pose)

    def candidates(
        self, names: Sequence[str], pose: Pose, *, style: Style, genes: Genes
    ) -> FaceCandidates:
        """Return candidates for some muscles; all others wear a style."""
        base = style.without_muscles(names).on_map(self.muscle_map)
        if self._bench is None:
            return MapCandidates(base, self._build, names, pose, genes)
        return MapCandidates.of_bench(self._redrawn(base), names, pose, genes=genes)

    def face_in(self, style: Style) -> Face:
        """Return the face in a style."""
        return self._build(style.on_map(self.muscle_map))

    def write(self, style: Style, path: Path) -> int:
        """Write the map in a style; return the number of its muscles."""
        drawn = style.on_map(self.muscle_map)
        write_json(path, drawn.to_json())
        return len(drawn.muscles)

    def _redrawn(self, drawn: MuscleMap) -> Workbench:
        assert self._bench is not None
        return self._bench.redrawn(drawn)


class TunableRecipe:
    """An outline recipe on a head."""

    def __init__(self, project: Project, head: Head, mechanics: Mechanics) -> None:
        self.recipe = recipe_of(project)
        made = spring_face(project, head, mechanics)
        assert isinstance(made, SpringFace) and made.ground is not None
        self.face: SpringFace = made
        self._fit = made.ground.parameters

    def muscles(self, pose: Pose) -> tuple[str, ...]:
        """Return the muscles (without side) that a pose contracts."""
        return outline_muscles(self.recipe, pose)

    def candidates(
        self, names: Sequence[str], pose: Pose, *, style: Style, genes: Genes
    ) -> FaceCandidates:
        """Return candidates for some muscles; all others wear a style."""
        base = style.without_muscles(names).on_recipe(self.recipe, fit=self._fit)
        face = redrawn(self.face, self.recipe, base)
        return OutlineCandidates(face, base, names, pose, genes)

    def face_in(self, style: Style) -> Face:
        """Return the face in a style."""
        drawn = style.on_recipe(self.recipe, fit=self._fit)
        return redrawn(self.face, self.recipe, drawn)

    def write(self, style: Style, path: Path) -> int:
        """Write the recipe in a style; return the number of its muscles."""
        drawn = style.on_recipe(self.recipe, fit=self._fit)
        write_recipe(drawn, path)
        return len(drawn.muscles)
