"""Tune the groups of an export, by a person, a script or a sculpted shape."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from risorius import _formats
from risorius._check import one_of
from risorius.anatomy.mechanics import Mechanics
from risorius.cli.asking import choose, scripted, typed
from risorius.cli.talk import Talk
from risorius.cli.tuning_pictures import FacePage
from risorius.controls.presets import PresetBook
from risorius.errors import ParameterError
from risorius.tuning.candidates import sensitivity_of
from risorius.tuning.muscle_genes import Genes, MuscleCandidates
from risorius.tuning.objective import ShapeObjective
from risorius.tuning.session import Session, tune
from risorius.tuning.style import Style
from risorius.vectormuscle.export import EXPORT_ORDER, Export, export_muscles
from risorius.vectormuscle.face import VectorFace
from risorius.vectormuscle.muscle import VectorMuscle
from risorius.vectormuscle.vector_set import VectorSet

__all__ = ["TuningChoices", "tune_export"]


@dataclass(frozen=True)
class TuningChoices:
    """What stood on the command line of `risorius tune`.

    Parameters
    ----------
    expressions : tuple of str
    picks : str
        ``"contact-sheet"`` or answers.
    target : Path or None
        Sculpted head.
    generations : int
    strategy : str
    seed : int
    mirror : bool
    genes : {"published", "all"}
    sheet : Path
        Where the nine faces are drawn.
    view : str
    """

    expressions: tuple[str, ...]
    picks: str
    target: Path | None
    generations: int
    strategy: str
    seed: int
    mirror: bool
    genes: Genes
    sheet: Path
    view: str

    def __post_init__(self) -> None:
        if not self.expressions:
            raise ParameterError(f"expression: give at least one of {', '.join(EXPORT_ORDER)}")
        for name in self.expressions:
            one_of("expression", name, EXPORT_ORDER)
        if self.target is not None and len(self.expressions) > 1:
            raise ParameterError("target: a sculpted head shows one expression; give one")


def tune_export(
    export: Export, presets: PresetBook, style: Style, choices: TuningChoices, talk: Talk
) -> tuple[VectorSet, Style]:
    """Go through the groups of an export; return the set and all that was tuned.

    Parameters
    ----------
    export : Export
        Before its first group.
    presets : PresetBook
    style : Style
        Where tuning begins.
    choices : TuningChoices
    talk : Talk

    Raises
    ------
    RisoriusError
        If something is refused.
    """
    work = _Work(export, presets, style, choices, talk)
    vectors = export_muscles(export, tune=work.tune_group)
    grouped = {name for group in export.groups for name in group.muscles}
    rest = [muscle for muscle in vectors.muscles if muscle.name not in grouped]
    width = export.features[1].width
    return vectors.replaced(work.style.applied(rest, width=width)), work.style


class _Work:
    """The tuning of one head: its style grows from group to group."""

    def __init__(
        self, export: Export, presets: PresetBook, style: Style, choices: TuningChoices, talk: Talk
    ) -> None:
        self.style = style
        self._presets, self._choices, self._talk = presets, choices, talk
        self._page = FacePage(export.target, choices.view)
        self._mechanics = Mechanics.build(export.target)
        self._lines = typed() if choices.picks == "contact-sheet" else scripted(choices.picks)
        self._ended = False

    def tune_group(self, export: Export) -> Iterable[VectorMuscle]:
        """Return the muscles of the current group as chosen, or in the style as it is."""
        group = export.group
        assert group is not None
        width = export.features[1].width
        proposal = export.proposal(group.muscles)
        if self._ended or group.expression not in self._choices.expressions:
            return self.style.applied(proposal, width=width)
        with self._talk.stage("muscles"):
            face = VectorFace.build(export.target, export.vector_set(), mechanics=self._mechanics)
            emotion = self._presets.emotions[group.expression]
            pose = self._presets.fit(emotion, face.controls).pose
        choices = self._choices
        candidates = MuscleCandidates(
            face, group.muscles, pose, width, mirror=choices.mirror, genes=choices.genes
        )
        values = self._values(candidates, group.expression)
        self.style = self.style.with_parameters(values)
        return self.style.applied(proposal, width=width)

    def _values(self, candidates: MuscleCandidates, expression: str) -> dict[str, float]:
        choices, genome = self._choices, candidates.genome
        start = {
            name: value for name, value in self.style.parameters.items() if name in genome.names
        }
        sensitivity = None
        if choices.strategy == "preference":
            with self._talk.stage("sensitivity"):
                sensitivity = sensitivity_of(candidates)
        session = Session(
            genome,
            strategy=choices.strategy,
            seed=choices.seed,
            start=start,
            sensitivity=sensitivity,
        )
        if choices.target is not None:
            return self._fitted(candidates, session, choices.target, expression)

        def show(now: Session) -> None:
            with self._talk.stage("nine faces"):
                made = now.generation.candidates
                faces = [candidates.positions(genome.named(values)) for values in made]
                number = now.generation.number + 1
                labels = [str(face + 1) for face in range(len(faces))]
                self._page.write(
                    choices.sheet, faces, labels, title=f"{expression}, generation {number}"
                )
            self._talk.say(f"{expression}, generation {number}: look at {choices.sheet}")

        forgiving = choices.picks == "contact-sheet"
        values, self._ended = choose(session, self._lines, show, forgiving=forgiving)
        return values

    def _fitted(
        self, candidates: MuscleCandidates, session: Session, target: Path, expression: str
    ) -> dict[str, float]:
        frame = candidates.face.head.frame
        mesh, _ = _formats.read_head(target)
        objective = ShapeObjective(candidates, frame.to_canonical(mesh.positions))
        genome = candidates.genome
        before = objective.distance(genome.values(session.best))
        with self._talk.stage("fit"):
            values = tune(session, objective, generations=self._choices.generations)
        after = objective.distance(genome.values(values))
        self._talk.put(distance={"before": before, "after": after, "unit": "mm"})
        self._talk.say(f"{expression}: {before:.3f} mm from the target before, {after:.3f} after")
        return values
