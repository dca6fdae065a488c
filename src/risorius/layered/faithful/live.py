"""A face that is moved while it is looked at: one published step after the other."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from risorius._check import FloatArray, as_number
from risorius.controls.control import Pose, resolve_pose
from risorius.solvers.model import State
from risorius.solvers.pbd import Solver

if TYPE_CHECKING:
    from risorius.layered.faithful.face import FaithfulFace

__all__ = ["LiveFace"]

# Steps that one call makes up for at most, or a slow machine would never catch up.
_MOST_STEPS = 8


class LiveFace:
    """The state of a face in motion (thesis section 5, frame loop of spec 2.12).

    Parameters
    ----------
    face : FaithfulFace
    """

    def __init__(self, face: FaithfulFace) -> None:
        self._face = face
        self._solver = Solver()
        self._values: Mapping[str, float] = resolve_pose(face.controls, {}).values
        self._behind = 0.0
        self._moved = np.zeros_like(face.head.skin.mesh.positions)
        anatomy = face.muscles.anatomy.positions
        self._muscles = State(anatomy.copy(), np.zeros_like(anatomy))
        self._skin = State.at_rest(face.skin.model)

    def set(self, pose: Pose) -> None:
        """Ask for a pose, which the face moves to over the next steps.

        Raises
        ------
        ParameterError
            If a control is unknown or not finite.
        """
        self._values = resolve_pose(self._face.controls, pose).values

    def step(self, dt: float = 0.0166) -> FloatArray:
        """Return the positions (n, 3) of every input vertex after `dt` seconds [mm].

        Steps have the published duration, since their number per second decides how stiff the
        face is; time that is left over counts for the next call.
        """
        face = self._face
        one = face.parameters.skin_solver.dt
        self._behind = min(self._behind + as_number("dt", dt, low=0.0), _MOST_STEPS * one)
        while self._behind >= one * (1.0 - 1e-9):
            self._behind -= one
            self._one_step()
        return face.head.positions + face.spread(self._moved, self._values)

    def _one_step(self) -> None:
        face, values = self._face, self._values
        p, n = face.parameters, face.skin.vertex_count
        contractions = face.muscles.contractions(values)
        self._muscles = face.muscles.step(self._muscles, face.bones(values), contractions)
        places = face.anchors.places(self._muscles.positions, face.muscles.anatomy.faces)
        teeth = face.teeth.moved(face.mechanics.jaw, face.jaw_of(values))
        contacts = face.contacts(teeth, self._skin.positions[:n])
        control = face.skin.control(places, face.lids(values), contacts)
        self._skin = self._solver.step(
            face.skin.model, self._skin, control, parameters=p.skin_solver
        )
        self._moved = face.lips.part(face.finished(self._skin.positions[:n], values))
