"""The talk about nine faces: numbers, and a few letters."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal

import typer

from risorius.errors import ParameterError
from risorius.tuning.session import Session

__all__ = ["HELP", "Answer", "choose", "parse_answer", "scripted", "typed"]

HELP = (
    "numbers of the faces you like, the best first (1 to 3 of them); Enter or r: other faces; "
    "u: back; l NAME, o NAME: lock or open a parameter; a: take the best; a N: take face N; "
    "q: take the best and end"
)
Verb = Literal["pick", "reroll", "undo", "lock", "open", "accept", "quit"]
_LETTERS: dict[str, Verb] = {
    "r": "reroll",
    "u": "undo",
    "l": "lock",
    "o": "open",
    "a": "accept",
    "q": "quit",
}


@dataclass(frozen=True)
class Answer:
    """What was said: `picks` count from 0, `names` are parameters."""

    verb: Verb
    picks: tuple[int, ...] = ()
    names: tuple[str, ...] = ()


def parse_answer(text: str) -> Answer:
    """Return what a line means.

    Raises
    ------
    ParameterError
        If it means nothing.
    """
    words = [word for word in re.split(r"[,\s]+", text.strip()) if word]
    if not words:
        return Answer("reroll")
    verb = _LETTERS.get(words[0].lower(), "pick")
    rest = words if verb == "pick" else words[1:]
    if verb in ("lock", "open"):
        return Answer(verb, names=tuple(rest))
    if not all(word.isdecimal() for word in rest) or (verb == "accept" and len(rest) > 1):
        raise ParameterError(f"picks: {text.strip()!r} is not understood; {HELP}")
    return Answer(verb, tuple(int(word) - 1 for word in rest))


def choose(
    session: Session,
    lines: Iterator[str],
    show: Callable[[Session], None],
    *,
    forgiving: bool,
) -> tuple[dict[str, float], bool]:
    """Show faces and follow the answers until one is accepted or the lines end.

    Parameters
    ----------
    session : Session
    lines : iterator of str
    show : callable
        Called before each answer.
    forgiving : bool
        Whether a senseless answer is asked for again instead of refused.

    Returns
    -------
    (values, whether to end altogether)

    Raises
    ------
    ParameterError
        If an answer makes no sense and there is nobody to ask.
    """
    while True:
        show(session)
        line = next(lines, None)
        if line is None:
            return session.best, False
        try:
            answer = parse_answer(line)
            if answer.verb in ("accept", "quit"):
                pick = answer.picks[0] if answer.picks else None
                return session.accept(pick), answer.verb == "quit"
            _follow(session, answer)
        except ParameterError as error:
            if not forgiving:
                raise
            typer.echo(str(error), err=True)


def _follow(session: Session, answer: Answer) -> None:
    if answer.verb == "pick":
        session.pick(answer.picks)
    elif answer.verb == "reroll":
        session.reroll()
    elif answer.verb == "undo":
        session.undo()
    elif answer.verb == "lock":
        session.lock(answer.names)
    else:
        session.unlock(answer.names)


def typed() -> Iterator[str]:
    """Return the lines that a person types, each asked for."""
    while True:
        typer.echo("faces you like (? for help): ", nl=False, err=True)
        line = sys.stdin.readline()
        if not line:
            return
        if line.strip() in ("?", "h", "help"):
            typer.echo(HELP, err=True)
            continue
        yield line


def scripted(text: str) -> Iterator[str]:
    """Return the answers written in one text, separated by semicolons."""
    yield from (piece for piece in text.split(";"))
