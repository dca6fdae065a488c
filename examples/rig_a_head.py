"""From a mesh and a landmark file to a rig, and what there is to know on the way.

    python examples/rig_a_head.py HEAD LANDMARKS OUT

Without arguments it takes the head that ships with risorius and writes ``face.glb``.
"""

from __future__ import annotations

import sys
from pathlib import Path

from risorius import Head, Rig, VectorFace, bake, builtin_head
from risorius.controls import default_presets, list_shapes


def main(arguments: list[str]) -> Rig:
    if arguments:
        head = Head.load(arguments[0], arguments[1])
        out = Path(arguments[2])
    else:
        head, out = builtin_head(), Path("face.glb")
    print(head.frame.describe())
    print("parts:", ", ".join(head.parts))

    face = VectorFace.build(head)
    print(f"{len(face.controls)} controls, e.g.", face.controls[0])

    shapes = list_shapes(face.controls, default_presets(), sets=("emotions", "arkit"))
    for name, reason in shapes.left_out.items():
        print(f"left out: {name}: {reason}")
    rig = bake(face, shapes.poses, left_out=shapes.left_out, upon=shapes.upon)
    rig.save(out)
    print(f"wrote {out} with {len(rig.targets)} shapes")
    return rig


if __name__ == "__main__":
    main(sys.argv[1:])
