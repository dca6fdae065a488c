"""A layered face whose muscles are being drawn: a change costs the muscles that it touches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skull import Skull, builtin_skull
from risorius.controls.standard import controls_of_muscles
from risorius.head.head import Head
from risorius.layered.binding import Binding, bind_muscles
from risorius.layered.face import LayeredFace
from risorius.layered.fibres import lay_fibres
from risorius.layered.muscle import Muscle
from risorius.layered.muscle_map import MuscleMap, default_muscle_map, muscle_entry

__all__ = ["Workbench"]


@dataclass(frozen=True, eq=False)
class Workbench:
    """A face, the skull that it was drawn on, and the fibres laid on that.

    Parameters
    ----------
    skull : Skull
    laid : mapping of str to (s, f, 3) float64
        Left fibres on the skull, from `lay_fibres` [mm].
    face : LayeredFace
    """

    skull: Skull
    laid: Mapping[str, FloatArray]
    face: LayeredFace

    @staticmethod
    def build(
        head: Head,
        muscle_map: MuscleMap | None = None,
        *,
        skull: Skull | None = None,
        mechanics: Mechanics | None = None,
    ) -> Workbench:
        """Build the face as `LayeredFace.build` does.

        Raises
        ------
        LandmarkError, MeshError
            As `LayeredFace.build`.
        """
        bones = skull or builtin_skull()
        drawn = muscle_map or default_muscle_map()
        face = LayeredFace.build(head, drawn, skull=bones, mechanics=mechanics)
        return Workbench(bones, lay_fibres(drawn, bones), face)

    def redrawn(self, muscle_map: MuscleMap) -> Workbench:
        """Return the bench with another map; only muscles that differ are laid and bound anew.

        The face is the one that `LayeredFace.build` makes of the map, bit for bit.
        """
        face = self.face
        before = face.muscle_map.by_name
        edited: set[str] = set()
        stale: set[str] = set()
        for muscle in muscle_map.muscles:
            if not _same(muscle, before.get(muscle.name)):
                edited.add(muscle.name)
            if muscle.name in edited or _lost_support(muscle, before, muscle_map, stale):
                stale.add(muscle.name)
        kept = {name: self.laid[name] for name in self.laid if name not in stale}
        laid = lay_fibres(muscle_map, self.skull, kept=kept)
        moved = {
            name
            for name in stale
            if name in laid and not np.array_equal(laid[name], self.laid.get(name, np.zeros(0)))
        }
        binding = bind_muscles(
            muscle_map,
            laid,
            face.skull,
            face.skin,
            face.mechanics,
            kept=Binding(
                dict(face.fibres), dict(face.pulls), dict(face.fields), dict(face.companions)
            ),
            changed=edited | moved,
        )
        changed = replace(
            face,
            muscle_map=muscle_map,
            fibres=binding.fibres,
            pulls=binding.pulls,
            fields=binding.fields,
            controls=controls_of_muscles(tuple(binding.fields)) + face.mechanics.controls,
        )
        return Workbench(self.skull, laid, changed)


def _same(muscle: Muscle, other: Muscle | None) -> bool:
    if other is None or muscle is other:
        return other is not None
    return muscle_entry(muscle) == muscle_entry(other)


def _lost_support(
    muscle: Muscle, before: Mapping[str, Muscle], muscle_map: MuscleMap, stale: set[str]
) -> bool:
    """Tell whether something that a muscle lies on has changed, come or gone."""
    now = muscle_map.by_name
    return any(name in stale or (name in before) != (name in now) for name in muscle.on)
