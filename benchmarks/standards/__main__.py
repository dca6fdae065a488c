"""What faces make of the standards: residuals of MPEG-4 parameters, gains of corrective pairs.

python -m benchmarks.standards residuals [METHOD ...] [--data FOLDER] [--write PAGE]
python -m benchmarks.standards pairs [METHOD ...] [--data FOLDER]
python -m benchmarks.standards player RIG [--frames N]
"""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path

from benchmarks.standards.pairs import pair_tables
from benchmarks.standards.player import player_report
from benchmarks.standards.residuals import residual_page

METHODS = ("layered", "vector", "springs")


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="benchmarks.standards", description=__doc__)
    parser.add_argument("what", choices=("residuals", "pairs", "player"))
    parser.add_argument("names", nargs="*", help="methods, or the rig of the player")
    parser.add_argument("--data", type=Path, default=Path("../shared/data"))
    parser.add_argument("--write", type=Path, help="page to replace")
    parser.add_argument("--frames", type=int, default=100_000)
    given = parser.parse_args(arguments)
    warnings.simplefilter("ignore")
    if given.what == "player":
        print(player_report(Path(given.names[0]), given.frames))
        return
    methods = tuple(given.names) or METHODS
    make = residual_page if given.what == "residuals" else pair_tables
    page = make(methods, given.data)
    if given.write:
        given.write.write_text(page, encoding="utf-8")
    print(page)


main(sys.argv[1:])
