"""Rows of the tables that ship as CSV files beside this module."""

from __future__ import annotations

import csv
from importlib.resources import files

__all__ = ["table_rows"]


def table_rows(name: str) -> list[dict[str, str]]:
    """Return the rows of ``data/<name>.csv``, column name -> text."""
    text = files("risorius.controls").joinpath(f"data/{name}.csv").read_text("utf-8")
    return list(csv.DictReader(text.splitlines()))
