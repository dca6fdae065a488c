"""The solver on a real head's skin, slivers included."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from risorius.errors import RisoriusWarning
from risorius.mesh.core import TriMesh
from risorius.solvers.constraints import Holds
from risorius.solvers.model import Control, Model, State
from risorius.solvers.parameters import PROFILES
from risorius.solvers.pbd import Solver
from risorius.solvers.surface import surface_constraints

SKIN_POLYGONS = 11144


@pytest.mark.real
@pytest.mark.parametrize("profile", sorted(PROFILES))
def test_a_true_smile_held_at_every_fourth_vertex_settles_near_itself(
    real_data: Path, profile: str
) -> None:
    data = np.load(real_data / "ict_facekit" / "ict_facekit.npz")
    quads = data["polygons"][:SKIN_POLYGONS]
    quads = quads[quads.min(axis=1) >= 0]
    faces = np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])
    used, faces = np.unique(faces, return_inverse=True)
    mesh = TriMesh(10.0 * data["vertices"][used], faces.reshape(-1, 3).astype(np.int32))
    names = [str(name) for name in data["expression_names"]]
    smile = 10.0 * data["expression_deltas"][names.index("mouthSmile_L")][used]
    held = np.arange(0, mesh.vertex_count, 4)
    constraints = replace(surface_constraints(mesh), holds=Holds(held, 0.2))
    with pytest.warns(RisoriusWarning, match="sliver triangles"):
        model = Model(mesh.positions, constraints)
    control = Control(targets=mesh.positions[held] + smile[held])
    found = Solver().settle(model, State.at_rest(model), control, parameters=PROFILES[profile])
    assert found.has_settled
    missed = found.positions - mesh.positions - smile
    assert 1.0 - (missed**2).sum() / (smile**2).sum() > 0.95
