"""What a verb says and how it ends: text or JSON, notes, progress, seconds, exit codes."""

from __future__ import annotations

import json as json_text
import os
import signal
import sys
import threading
import time
import traceback
import warnings
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

import typer

from risorius.cli.exits import INTERRUPTED, REFUSED
from risorius.errors import RisoriusError, RisoriusWarning

__all__ = ["Talk", "Tick", "talking"]

Tick = Callable[[int, int, str], None]
"""Called with (done, all, name) while a stage runs."""


class Talk:
    """What one run of a verb has to say.

    Parameters
    ----------
    json : bool
        Print one JSON object on standard output and nothing else there.
    quiet : bool
        Print errors only.
    debug : bool
        Show where an error comes from.
    """

    def __init__(self, *, json: bool, quiet: bool, debug: bool) -> None:
        self.json = json
        self.quiet = quiet
        self.debug = debug
        self.answer: dict[str, Any] = {}
        self.notes: list[str] = []
        self.seconds: dict[str, float] = {}
        self.interrupted = False

    def say(self, text: str = "") -> None:
        """Print a line for people."""
        if not (self.json or self.quiet):
            typer.echo(text)

    def put(self, **fields: Any) -> None:
        """Add fields to the JSON answer."""
        self.answer.update(fields)

    def note(self, text: str) -> None:
        """Remember something that was repaired or left out; it is said once."""
        if text not in self.notes:
            self.notes.append(text)

    def table(self, header: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """Print a table for people; columns of numbers behind the first are set flush right."""
        if self.json or self.quiet:
            return
        numeric = [
            column > 0 and bool(rows) and all(_is_number(row[column]) for row in rows)
            for column in range(len(header))
        ]
        widths = [max(len(row[i]) for row in (header, *rows)) for i in range(len(header))]
        for row in (header, ["-" * width for width in widths], *rows):
            cells = (
                cell.rjust(width) if right else cell.ljust(width)
                for cell, width, right in zip(row, widths, numeric, strict=True)
            )
            typer.echo("  ".join(cells).rstrip())

    @contextmanager
    def stage(self, name: str) -> Generator[Tick]:
        """Measure a stage, and show its progress on a terminal."""
        start = time.perf_counter()
        self._stop_if_interrupted()
        try:
            if self.quiet or not sys.stderr.isatty():
                yield _no_progress
            else:
                with _bar(name) as tick:
                    yield tick
        finally:
            passed = time.perf_counter() - start
            self.seconds[name] = self.seconds.get(name, 0.0) + passed
        self._stop_if_interrupted()

    def _stop_if_interrupted(self) -> None:
        # Python drops an interruption that falls into a finaliser or a callback of a library.
        if self.interrupted:
            raise KeyboardInterrupt

    def say_seconds(self) -> None:
        """Print how long each stage took."""
        listed = ", ".join(f"{name} {seconds:.1f}" for name, seconds in self.seconds.items())
        self.say(f"seconds: {listed}; all {sum(self.seconds.values()):.1f}")

    def finish(self, *, ok: bool, error: str | None = None) -> None:
        """Print the notes, the error and the JSON answer."""
        if not (self.quiet or self.json):
            for text in self.notes:
                typer.echo(f"note: {text}", err=True)
        if error is not None:
            typer.echo(f"risorius: {error}", err=True)
        if self.json:
            answer = {"ok": ok, **self.answer, "notes": self.notes}
            if self.seconds:
                answer["seconds"] = {name: round(value, 3) for name, value in self.seconds.items()}
            if error is not None:
                answer["error"] = error
            typer.echo(json_text.dumps(answer, indent=1, ensure_ascii=False, default=_plain))


@contextmanager
def talking(*, json: bool, quiet: bool, debug: bool) -> Generator[Talk]:
    """Run a verb: turn errors into one sentence and an exit code, collect warnings.

    Raises
    ------
    typer.Exit
        With the exit code, unless all went well.
    """
    talk = Talk(json=json, quiet=quiet, debug=debug)
    with _noticing_ctrl_c(talk), warnings.catch_warnings():
        if not debug:
            warnings.simplefilter("ignore")
        warnings.simplefilter("always", RisoriusWarning)
        shown = warnings.showwarning

        def collect(message: Warning | str, category: type[Warning], *rest: Any) -> None:
            if issubclass(category, RisoriusWarning):
                talk.note(str(message))
            else:
                shown(message, category, *rest)

        warnings.showwarning = collect
        try:
            yield talk
        except typer.Exit as leaving:
            talk.finish(ok=leaving.exit_code == 0)
            raise
        except KeyboardInterrupt:
            _fail(talk, "interrupted; no incomplete file is left", INTERRUPTED)
        except (RisoriusError, ImportError) as error:
            _fail(talk, str(error), REFUSED)
        except MemoryError:
            _fail(talk, "not enough memory for this head", REFUSED)
        except BrokenPipeError:
            # The reader of our output has gone (`risorius landmarks | head`): no fault of ours.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(0) from None
        except OSError as error:
            _fail(talk, _system_error(error), REFUSED)
        else:
            talk.finish(ok=True)


@contextmanager
def _noticing_ctrl_c(talk: Talk) -> Generator[None]:
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def interrupt(_signal: int, _frame: FrameType | None) -> None:
        talk.interrupted = True
        raise KeyboardInterrupt

    previous = signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous)


def _fail(talk: Talk, text: str, code: int) -> None:
    if talk.debug:
        typer.echo(traceback.format_exc(), err=True)
    talk.finish(ok=False, error=text)
    raise typer.Exit(code) from None


def _system_error(error: OSError) -> str:
    place = f"{error.filename}: " if error.filename else ""
    return f"{place}{error.strerror or error}"


def _no_progress(done: int, count: int, name: str) -> None:
    """Ignore the progress."""


@contextmanager
def _bar(stage: str) -> Generator[Tick]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn

    columns = (
        SpinnerColumn(),
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.fields[shape]}"),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(stage, total=None, shape="")

        def tick(done: int, count: int, name: str) -> None:
            progress.update(task, completed=done, total=count, shape=name)

        yield tick


def _is_number(text: str) -> bool:
    return not text or text.lstrip("-").replace(".", "", 1).rstrip("%").isdigit()


def _plain(value: object) -> Any:
    """Turn what JSON does not know (paths, NumPy numbers) into what it knows."""
    if isinstance(value, Path):
        return str(value)
    for method in ("tolist", "to_json"):
        if hasattr(value, method):
            return getattr(value, method)()
    return str(value)
