"""Print the figures: ``python -m benchmarks.springs [--real] [--json FILE]``.

Times are of the processor and of the fastest round; ratios are of one run.
"""

from __future__ import annotations

import argparse
import json
import time
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.template import builtin_head
from risorius.controls.control import resolve_pose
from risorius.controls.presets import default_presets
from risorius.controls.shape_sets import list_shapes
from risorius.errors import RisoriusWarning
from risorius.head.head import Head
from risorius.solvers.kernels.springs import leapfrog
from risorius.solvers.leapfrog import PackedRun, advance, scalar_tables, settle
from risorius.solvers.springs import SpringState
from risorius.springmuscle.bones import builtin_bones
from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.fit import Ground, fit_muscle
from risorius.springmuscle.recipe_file import default_recipe
from tests.springmuscle.coarse import decimated
from tests.tools import real_data_folder

# Triangles of the head in the paper, which ran at 5 and 16 frames per second in 2001.
PUBLISHED = 3246
LARGE = 20000
ROUNDS, STEPS, FRAMES = 7, 40, 60


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--real", action="store_true", help="also ICT-FaceKit, whole and cut down")
    parser.add_argument("--json", type=Path, default=None, help="write the figures")
    given = parser.parse_args()
    warnings.simplefilter("ignore", RisoriusWarning)
    builtin = builtin_head()
    heads = {"built-in, small": _sized(builtin, PUBLISHED), "built-in": builtin}
    if given.real:
        folder = real_data_folder() / "ict_facekit"
        ict = Head.load(folder / "ict_neutral.obj", folder / "landmarks.json")
        heads |= {"ICT, 20k": _sized(ict, LARGE), "ICT": ict}
    table = {name: measure(name, head) for name, head in heads.items()}
    if given.json:
        given.json.write_text(json.dumps(table, indent=1), "utf-8")


def measure(name: str, head: Head) -> dict[str, float]:
    """Measure one head and check that what was measured is right."""
    mechanics = Mechanics.build(head)
    built, face = _timed(lambda: SpringFace.build(head, mechanics=mechanics), rounds=2)
    network = face.springs.network
    poses = list_shapes(face.controls, default_presets(), sets=("emotions",)).poses
    values = [resolve_pose(face.controls, pose).values for pose in poses.values()]
    result = {
        "triangles": head.skin.mesh.face_count,
        "edges": len(network.edges),
        "anchor springs": len(network.anchored),
        "build [s]": built,
        **_steps(face, values[0]),
        **_poses(face, values),
        **_live(face, list(poses.values())),
        "refit of a muscle, worst [ms]": _refit(mechanics),
    }
    print(f"{name}:")
    for key, value in result.items():
        print(f"  {key:32} {value:10.2f}")
    return result


def _steps(face: SpringFace, values: dict[str, float]) -> dict[str, float]:
    """Return milliseconds per step by both kernels, which must agree."""
    network, motion = face.springs.network, replace(face.parameters.motion, tolerance=0.0)
    control = face.driver.drive(values).control
    start = SpringState.still(network.rest_positions)
    fast, exact = (
        advance(network, start, control, steps=STEPS, parameters=motion, path=path).state.positions
        for path in ("packed", "scalar")
    )
    moved = np.abs(exact - network.rest_positions).max()
    assert np.abs(fast - exact).max() < 1e-3 * moved, "the kernels differ"
    packed = PackedRun(network, start, control, motion)
    tables = scalar_tables(network, control)
    x, v, f = (np.array(start.positions), *np.zeros((2, *start.positions.shape)))
    step = motion.step_share * network.stable_step
    times = {
        "packed": _timed(lambda: packed.advance(STEPS))[0] / STEPS,
        "scalar": _timed(lambda: leapfrog(x, v, tables, f, step, 0.1, True, 0.0, STEPS))[0] / STEPS,
    }
    return {
        "step, packed [ms]": 1e3 * times["packed"],
        "step, scalar [ms]": 1e3 * times["scalar"],
        "times faster than scalar": times["scalar"] / times["packed"],
    }


def _poses(face: SpringFace, poses: list[dict[str, float]]) -> dict[str, float]:
    """Return what a converged pose costs, from rest and from the over-relaxation."""
    network = face.springs.network
    steps = {"guess": 0, "rest": 0}
    for values in poses:
        drive, moved = face.settled(values)
        steps["guess"] += moved.steps
        plain = settle(network, SpringState.still(drive.reference), drive.control,
                       parameters=face.parameters.motion)  # fmt: skip
        way = np.linalg.norm(moved.state.positions - drive.reference)
        apart = np.linalg.norm(plain.state.positions - moved.state.positions)
        assert apart < 0.05 * way, "the start matters"
        steps["rest"] += plain.steps
    seconds, _ = _timed(lambda: [face.displace(dict(values)) for values in poses])
    return {
        "converged pose [ms]": 1e3 * seconds / len(poses),
        "steps from the guess": steps["guess"] / len(poses),
        "steps from rest": steps["rest"] / len(poses),
    }


def _live(face: SpringFace, poses: list[dict[str, float]]) -> dict[str, float]:
    """Return frames per second of a face whose every frame asks for another pose."""
    session = face.live()
    for pose in poses:
        session.set(pose)
        session.step(steps=10)

    def run() -> None:
        for frame in range(FRAMES):
            share = 0.5 + 0.5 * np.sin(0.2 * frame)
            pose = poses[frame // 10 % len(poses)]
            session.set({name: share * value for name, value in pose.items()})
            session.step(steps=10)

    seconds, _ = _timed(run, rounds=3)
    return {"live, 10 steps a frame [1/s]": FRAMES / seconds}


def _refit(mechanics: Mechanics) -> float:
    ground = Ground.build(mechanics, builtin_bones(mechanics))
    outlines = default_recipe().sided()
    fit_muscle(outlines[0], ground)
    return max(1e3 * _timed(lambda o=o: fit_muscle(o, ground), rounds=3)[0] for o in outlines)


def _timed(call: Callable[[], Any], *, rounds: int = ROUNDS) -> tuple[float, Any]:
    """Return the processor time of the fastest of some rounds and the result."""
    result = call()
    best = np.inf
    for _ in range(rounds):
        began = time.process_time()
        result = call()
        best = min(best, time.process_time() - began)
    return float(best), result


def _sized(head: Head, triangles: int) -> Head:
    return decimated(head, triangles / head.skin.mesh.face_count)


if __name__ == "__main__":
    main()
