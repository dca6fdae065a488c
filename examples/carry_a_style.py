"""Choose a smile on one head and carry the choice to the next: the wider, the better.

python examples/carry_a_style.py [FOLDER [NEXT_HEAD]]
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from risorius import Head, bake, builtin_head
from risorius.controls.presets import default_presets
from risorius.layered.workbench import Workbench
from risorius.render import write_png
from risorius.render.rig_sheet import view_sheet
from risorius.tuning import Gallery, MapCandidates, Session, Style
from risorius.tuning.style import write_style


def main(arguments: list[str]) -> Style:
    folder = Path(arguments[0]) if arguments else Path()
    head = builtin_head()
    following = Head.load(arguments[1]) if len(arguments) > 1 else head
    bench = Workbench.build(head)
    joy = default_presets().emotions["joy"]
    pose = default_presets().fit(joy, bench.face.controls).pose

    candidates = MapCandidates.of_bench(bench, ["zygomaticus_major"], pose)
    session, gallery = Session(candidates.genome, seed=1), Gallery(candidates)
    corners = head.skin.first_source()[[head.skin_vertex(name) for name in ("8.3", "8.4")]]
    for _ in range(3):
        faces = gallery.faces(session.generation.candidates)
        widths = [np.ptp(face[corners, 0]) for face in faces]
        session.pick(np.argsort(widths)[:-4:-1].tolist())

    style = Style(method="layered").with_parameters(session.best)
    write_style(style, folder / "wide.style.json")
    plain = Workbench.build(following)
    wide = plain.redrawn(style.on_map(plain.face.muscle_map))
    for name, each in {"before": plain, "after": wide}.items():
        page = view_sheet(bake(each.face, {"joy": pose}), {name: {"joy": 1.0}}, ["front", "mouth"])
        write_png(folder / f"smile_{name}.png", page)
    return style


if __name__ == "__main__":
    main(sys.argv[1:])
