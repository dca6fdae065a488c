"""Pictures of a pose from all sides: the frames of a turntable.

python examples/turntable.py [FOLDER] [FRAMES]
"""

from __future__ import annotations

import sys
from pathlib import Path

from risorius import VectorFace, bake, builtin_head
from risorius.controls import default_presets
from risorius.render import write_png
from risorius.render.heads import Portrait


def main(arguments: list[str]) -> list[Path]:
    folder = Path(arguments[0]) if arguments else Path()
    count = int(arguments[1]) if len(arguments) > 1 else 12
    face = VectorFace.build(builtin_head())
    pose = default_presets().fit(default_presets().emotions["surprise"], face.controls).pose
    portrait = Portrait.of(bake(face, {"surprise": pose}))
    frames: list[Path] = []
    for number in range(count):
        camera = portrait.camera("front", yaw=360.0 * number / count)
        picture = portrait.picture(camera, size=(320, 320), weights={"surprise": 1.0})
        frames.append(folder / f"surprise_{number:03}.png")
        write_png(frames[-1], picture)
    return frames


if __name__ == "__main__":
    main(sys.argv[1:])
