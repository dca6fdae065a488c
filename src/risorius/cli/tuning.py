"""Tune one expression after the other: a person, a script or a sculpted shape answers."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from risorius._check import FloatArray, one_of
from risorius.cli.asking import choose, scripted, typed
from risorius.cli.talk import Talk
from risorius.cli.tuning_pictures import FacePage
from risorius.controls.presets import PresetBook
from risorius.errors import ParameterError
from risorius.head.head import Head
from risorius.rig.face import Face
from risorius.tuning.candidates import Candidates, FaceCandidates, Gallery
from risorius.tuning.change import Genes
from risorius.tuning.fit import fit_shape
from risorius.tuning.intensities import IntensityCandidates
from risorius.tuning.looks import Looks
from risorius.tuning.objective import ShapeObjective
from risorius.tuning.plausible import Plausible
from risorius.tuning.session import Session, tune
from risorius.tuning.style import Style
from risorius.vectormuscle.export import EXPORT_ORDER

__all__ = ["LEAST_SQUARES", "Tuning", "TuningChoices", "as_genes"]

LEAST_SQUARES = "least-squares"
"""The way to fit a target that is no strategy of choosing."""

_GENES = ("published", "all", "intensities")


@dataclass(frozen=True)
class TuningChoices:
    """What stood on the command line of `risorius tune`.

    Parameters
    ----------
    expressions : tuple of str
    picks : str
        ``"contact-sheet"`` or answers.
    generations : int
    strategy : str or None
        None for what suits: `LEAST_SQUARES` with a target, preferences without.
    seed : int
    mirror : bool
    genes : {"published", "all"} or None
        Which numbers of the muscles are tuned; None for none.
    intensities : bool
        Whether it is tuned how far the controls of an expression go.
    sheet : Path
        Where the nine faces are drawn.
    view : str
    """

    expressions: tuple[str, ...]
    picks: str
    generations: int
    strategy: str | None
    seed: int
    mirror: bool
    genes: Genes | None
    intensities: bool
    sheet: Path
    view: str

    def __post_init__(self) -> None:
        if not self.expressions:
            raise ParameterError(f"expression: give at least one of {', '.join(EXPORT_ORDER)}")

    def strategy_for(self, target: bool) -> str:
        """Return the strategy, with a target or without one."""
        return self.strategy or (LEAST_SQUARES if target else "preference")


def as_genes(text: str) -> tuple[Genes | None, bool]:
    """Return which genes of muscles are tuned, and whether intensities are.

    Raises
    ------
    ParameterError
        If a word is none of published, all and intensities, or two contradict each other.
    """
    words = [word.strip() for word in text.split(",") if word.strip()]
    for word in words:
        one_of("genes", word, _GENES)
    if not words or {"published", "all"} <= set(words):
        raise ParameterError(
            f"genes: {text!r}: give published or all, and intensities alone or behind a comma"
        )
    genes: Genes | None = None
    if "published" in words:
        genes = "published"
    elif "all" in words:
        genes = "all"
    return genes, "intensities" in words


class Tuning:
    """The tuning of one head: its style grows from expression to expression.

    Parameters
    ----------
    head : Head
    presets : PresetBook
    style : Style
        Where tuning begins.
    choices : TuningChoices
    targets : mapping of str to (n, 3) float64
        The head sculpted in each expression [mm]; empty where somebody chooses.
    talk : Talk
    """

    def __init__(
        self,
        head: Head,
        presets: PresetBook,
        style: Style,
        choices: TuningChoices,
        targets: Mapping[str, FloatArray],
        talk: Talk,
    ) -> None:
        self.style = style
        self.presets = presets
        self.choices = choices
        self.ended = False
        self._targets, self._talk = targets, talk
        self._distances: dict[str, dict[str, float]] = {}
        self._page = FacePage(head, choices.view)
        self._lines = typed() if choices.picks == "contact-sheet" else scripted(choices.picks)

    def wants(self, expression: str) -> bool:
        """Return whether an expression is tuned; none is once somebody has ended."""
        return not self.ended and expression in self.choices.expressions

    def pose_of(self, expression: str, face: Face) -> dict[str, float]:
        """Return an expression as it is now, in the controls of a face; nothing that rests."""
        now = self.style.on_presets(self.presets).emotions.get(expression, {})
        fitted = self.presets.fit(now, face.controls).pose
        return {name: value for name, value in fitted.items() if value}

    def run(self, expression: str, face: Face, muscles: FaceCandidates | None) -> None:
        """Tune an expression; what was chosen becomes part of the style.

        Parameters
        ----------
        expression : str
        face : Face
            As it is now.
        muscles : FaceCandidates or None
            Muscles to tune; None where there are none, or none are wanted.
        """
        candidates: Candidates | None = muscles
        if self.choices.intensities:
            mirror = self.choices.mirror
            subject = face if muscles is None else muscles
            candidates = IntensityCandidates(subject, self.presets, expression, mirror)
        if candidates is None:
            self._talk.say(
                f"{expression}: nothing to tune; its muscles belong to expressions before it"
            )
            return
        self.style = self.style.with_parameters(self._values(candidates, expression))

    def _values(self, candidates: Candidates, expression: str) -> Mapping[str, float]:
        choices, genome = self.choices, candidates.genome
        start = self.style.start_of(genome)
        target = self._targets.get(expression)
        strategy = choices.strategy_for(target is not None)
        if target is not None and strategy == LEAST_SQUARES:
            return self._fitted(candidates, genome.values(start), target, expression)
        looks = Looks(candidates)
        judge = Plausible.of(self._page.head, looks.positions(genome.named(genome.values(start))))
        with self._talk.stage("first faces"):
            session = Session(
                genome, strategy=strategy, seed=choices.seed, start=start, looks=looks,
                admit=lambda values: judge(looks.positions(genome.named(values))),
            )  # fmt: skip
        if target is not None:
            return self._approached(looks, session, target, expression)
        return self._chosen(looks, session, expression)

    def _chosen(
        self, candidates: Candidates, session: Session, expression: str
    ) -> Mapping[str, float]:
        gallery, sheet = Gallery(candidates), self.choices.sheet

        def show(now: Session) -> None:
            with self._talk.stage("nine faces"):
                faces = gallery.faces(now.generation.candidates)
                number = now.generation.number + 1
                labels = [str(face + 1) for face in range(len(faces))]
                self._page.write(sheet, faces, labels, title=f"{expression}, generation {number}")
            self._talk.say(f"{expression}, generation {number}: look at {sheet}")
            looking.submit(now.prepare)

        forgiving = self.choices.picks == "contact-sheet"
        with ThreadPoolExecutor(1) as looking:
            values, self.ended = choose(session, self._lines, show, forgiving=forgiving)
        return values

    def _fitted(
        self, candidates: Candidates, start: FloatArray, target: FloatArray, expression: str
    ) -> Mapping[str, float]:
        with self._talk.stage("fit") as tick:
            found = fit_shape(
                candidates, target, start=start, iterations=self.choices.generations, progress=tick
            )
        self._tell(expression, found.before, found.after, target)
        return found.values

    def _approached(
        self, candidates: Candidates, session: Session, target: FloatArray, expression: str
    ) -> Mapping[str, float]:
        objective = ShapeObjective(candidates, target)
        genome = candidates.genome
        before = objective.distance(genome.values(session.best))
        with self._talk.stage("fit"):
            values = tune(session, objective, generations=self.choices.generations)
        self._tell(expression, before, objective.distance(genome.values(values)), target)
        return values

    def _tell(self, expression: str, before: float, after: float, target: FloatArray) -> None:
        rest = self._page.head.positions
        whole = float(np.sqrt(((target - rest) ** 2).sum(axis=1).mean()))
        made = 1.0 - (after / whole) ** 2
        told = {"neutral": whole, "before": before, "after": after, "motion": made}
        self._distances[expression] = told
        self._talk.put(distances=self._distances)
        self._talk.say(
            f"{expression}: {before:.3f} mm from the target before, {after:.3f} after; the neutral "
            f"head is {whole:.3f} mm from it, so {100.0 * made:.0f} % of its motion is made"
        )
