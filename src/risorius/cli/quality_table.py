"""The quality report as a table, and the bar that a rig has to pass."""

from __future__ import annotations

from collections.abc import Mapping

import typer

from risorius.cli.talk import Talk
from risorius.errors import ParameterError
from risorius.rig.quality import QualityReport

__all__ = ["beyond", "limits", "show"]

_DEFAULT = {"lost": 0.0, "invented": 0.0, "cracks": 0.0}
Cell = str | int | float | None


def limits(given: list[str] | None) -> dict[str, float]:
    """Return the default limits with ``COLUMN=LIMIT`` options on top."""
    result = dict(_DEFAULT)
    for text in given or []:
        column, equals, limit = text.partition("=")
        try:
            result[column.strip()] = float(limit)
        except ValueError:
            equals = ""
        if not equals or not column.strip():
            raise typer.BadParameter(f"{text!r} is not COLUMN=LIMIT, such as added=1.5")
    return result


def beyond(report: QualityReport, bars: Mapping[str, float]) -> list[str]:
    """Return a sentence for each value beyond its limit.

    Raises
    ------
    ParameterError
        If a limit names no column of numbers.
    """
    rows = report.rows()
    for column in bars:
        _require_column(rows, column)
    return [
        f"{row['shape']}: {column} {_text(value)} is above {limit:g}"
        for row in rows
        for column, limit in bars.items()
        if isinstance(value := row[column], int | float) and value > limit
    ]


def show(report: QualityReport, talk: Talk, *, sort: str | None = None) -> None:
    """Print the table; columns that say the same for every shape become one line.

    Raises
    ------
    ParameterError
        If `sort` is no column.
    """
    rows = report.rows()
    if not rows:
        talk.say("the file has no shapes")
        return
    if sort is not None:
        key = _require_column(rows, sort)
        rows.sort(key=lambda row: _order(row[key]), reverse=not isinstance(rows[0][key], str))
    columns = [name for name in rows[0] if name == "shape" or not _is_idle(rows, name)]
    unmeasured = [name for name in rows[0] if all(row[name] is None for row in rows)]
    zero = [name for name in rows[0] if name not in columns and name not in unmeasured]
    talk.table(columns, [[_text(row[name]) for name in columns] for row in rows])
    talk.say(f"lengths in {report.unit}; lid and asymmetry in per cent")
    if zero:
        talk.say(f"0 for every shape: {', '.join(zero)}")
    if unmeasured:
        talk.say(f"not measured: {', '.join(unmeasured)}")


def _require_column(rows: list[dict[str, Cell]], column: str) -> str:
    if rows and column not in rows[0]:
        raise ParameterError(f"inspect: no column {column!r}; there are {', '.join(rows[0])}")
    return column


def _is_idle(rows: list[dict[str, Cell]], column: str) -> bool:
    return all(row[column] in (None, 0, "") for row in rows)


def _order(value: Cell) -> tuple[int, float, str]:
    if isinstance(value, str):
        return (1, 0.0, value)
    return (0, 0.0, "") if value is None else (1, float(value), "")


def _text(value: Cell) -> str:
    if value is None:
        return ""
    return f"{value:.2f}" if isinstance(value, float) else str(value)
