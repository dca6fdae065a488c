"""``python -m risorius`` is the program `risorius`."""

from risorius.cli.entry import run

run()
