"""Print the table: ``python -m benchmarks.expressive [--method M] [--json FILE] [--seeds 1 2]``."""

from __future__ import annotations

import argparse
import json
import time
import warnings
from pathlib import Path

import numpy as np

from benchmarks.expressive.truths import FURTHER, JUDGED, Truths, face_weights
from risorius.errors import RisoriusWarning
from risorius.layered import solve_pose
from risorius.project import PROFILES, Project, face_of
from risorius.project.assemble import BUILDERS
from tests.tools import real_data_folder


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=None, help="folder of the real heads")
    parser.add_argument("--seeds", type=int, nargs="*", default=[1, 2], help="random identities")
    parser.add_argument("--method", choices=sorted(BUILDERS), default="layered")
    parser.add_argument("--profile", choices=PROFILES, default="improved")
    parser.add_argument("--json", type=Path, default=None, help="write the figures and poses")
    given = parser.parse_args()
    warnings.simplefilter("ignore", RisoriusWarning)
    truths = Truths.load((given.data or real_data_folder()) / "ict_facekit")
    table: dict[str, dict[str, object]] = {}
    for seed in (None, *given.seeds):
        name = "neutral" if seed is None else f"identity {seed}"
        table[name] = measure(
            truths, seed, name, Project(method=given.method, profile=given.profile)
        )
    if given.json:
        given.json.write_text(json.dumps(table, indent=1), "utf-8")


def measure(truths: Truths, seed: int | None, title: str, project: Project) -> dict[str, object]:
    """Solve every true shape on one head and print what the posed face explains of it."""
    start = time.perf_counter()
    face = face_of(project, truths.head(seed))
    vertices, weights = face_weights(face.head)
    built = time.perf_counter() - start
    shapes: dict[str, object] = {}
    posed: dict[str, float] = {}
    linear: dict[str, float] = {}
    count = face.head.skin.mesh.vertex_count
    print(f"{title}: {project.method}, {count} skin vertices, built in {built:.1f} s")
    for name in (*JUDGED, *FURTHER):
        if name not in truths.expressions:
            continue
        wanted = truths.expressions[name][vertices]
        found = solve_pose(face, wanted, vertices, weights=weights, together=True)
        posed[name], linear[name] = found.explained, found.linear
        shapes[name] = {"posed": found.explained, "linear": found.linear, "pose": found.pose}
        print(f"  {name:16} posed {found.explained:.3f}  linear {found.linear:.3f}")
    mean = float(np.mean([posed[name] for name in JUDGED]))
    flat = float(np.mean([linear[name] for name in JUDGED]))
    worst = min(JUDGED, key=lambda name: posed[name])
    print(
        f"  mean of twelve   posed {mean:.3f}  linear {flat:.3f}  worst {worst} {posed[worst]:.3f}"
    )
    return {"mean": mean, "linear": flat, "shapes": shapes}


if __name__ == "__main__":
    main()
