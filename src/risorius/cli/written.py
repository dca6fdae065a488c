"""Write results and say what was written."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from risorius.cli.outputs import write_rig
from risorius.cli.talk import Talk
from risorius.playback.pairs import CorrectivePair
from risorius.render.png import write_png
from risorius.render.rig_sheet import rig_sheet
from risorius.rig.rig import Rig

__all__ = ["say_left_out", "say_pairs", "size_of", "write_and_say", "write_sheet"]


def write_and_say(
    rig: Rig, path: Path, talk: Talk, *, animation: bool = False, metres: bool = False
) -> None:
    """Write a rig; say where, how large, how many shapes, and what was left out."""
    with talk.stage("normals+write"):
        write_rig(rig, path, animation=animation, metres=metres)
    still = [target.name for target in rig.targets if not len(target.vertices)]
    for name in still:
        talk.note(f"{name} moves nothing on this head")
    talk.put(output=path, shapes=list(rig.names), left_out=dict(rig.left_out), bytes=_bytes(path))
    talk.say(f"wrote {path}: {len(rig.targets)} shapes, {size_of(path)}")
    say_left_out(rig, talk)


def say_left_out(rig: Rig, talk: Talk) -> None:
    """Say which shapes were asked for and are not there, and why."""
    if rig.left_out:
        talk.say(f"left out ({len(rig.left_out)}):")
        for name, reason in rig.left_out.items():
            talk.say(f"  {name}: {reason}")


def say_pairs(pairs: Sequence[CorrectivePair], talk: Talk) -> None:
    """Say what corrective pairs bring."""
    rows = [(pair.first, pair.second, pair.before, pair.after) for pair in pairs]
    talk.put(
        correctives=[
            {"first": a, "second": b, "before": before, "after": after}
            for a, b, before, after in rows
        ]
    )
    talk.say("correctives, and the error of the sum without and with them [mm]:")
    talk.table(
        ("pair", "without", "with"),
        [(f"{a} + {b}", f"{before:.2f}", f"{after:.2f}") for a, b, before, after in rows],
    )


def write_sheet(rig: Rig, path: Path, talk: Talk) -> None:
    """Draw all shapes of a rig on one page."""
    with talk.stage("sheet") as tick:
        write_png(path, rig_sheet(rig, progress=tick))
    talk.put(sheet=path)
    talk.say(f"wrote {path}: all shapes on one page")


def size_of(path: Path) -> str:
    """Return the size of a file or folder in words."""
    size = _bytes(path)
    return f"{size / 1e6:.1f} MB" if size >= 1e5 else f"{size / 1e3:.1f} kB"


def _bytes(path: Path) -> int:
    files = [file for file in path.iterdir() if file.is_file()] if path.is_dir() else [path]
    return sum(file.stat().st_size for file in files)
