"""An expression of your own: a pose of muscles and joints, alone and mixed with others.

python examples/own_expression.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

from risorius import Rig, VectorFace, bake, builtin_head
from risorius.render import write_png
from risorius.render.rig_sheet import view_sheet

WRY = {
    "zygomaticus_major_l": 0.8,
    "orbicularis_oculi_l": 0.4,
    "corrugator_r": 0.5,
    "jaw_yaw": 2.0,
    "gaze_yaw_l": 12.0,
    "gaze_yaw_r": 12.0,
}


def main(arguments: list[str]) -> Rig:
    folder = Path(arguments[0]) if arguments else Path()
    face = VectorFace.build(builtin_head())
    rig = bake(face, {"wry": WRY, "jawOpen": {"jaw_pitch": 18.0}})
    rig.save(folder / "wry.glb")
    poses = {
        "neutral": {},
        "wry": {"wry": 1.0},
        "half wry, speaking": {"wry": 0.5, "jawOpen": 0.3},
    }
    write_png(folder / "wry.png", view_sheet(rig, poses, ["front", "three-quarter"], cell=240))
    return rig


if __name__ == "__main__":
    main(sys.argv[1:])
