"""The vector-muscle face: closed-form muscles on top of the shared mechanics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Literal

from risorius._check import FloatArray, one_of
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.regions import Regions, find_regions
from risorius.anatomy.support import support_directions
from risorius.controls.control import Control, Pose, resolve_pose
from risorius.controls.standard import controls_of_muscles
from risorius.errors import ParameterError
from risorius.head.head import Head
from risorius.mesh.normals import vertex_normals
from risorius.vectormuscle.combine import combine
from risorius.vectormuscle.muscle import BoundMuscle, FaceContext, VectorMuscle
from risorius.vectormuscle.profile import AngularProfile
from risorius.vectormuscle.vector_set import VectorSet, default_vector_set
from risorius.vectormuscle.wrinkle import BoundWrinkles, bind_all_wrinkles, raise_wrinkles

__all__ = ["Profile", "VectorFace", "VectorParameters"]

Profile = Literal["improved", "faithful"]


@dataclass(frozen=True)
class VectorParameters:
    """Every difference between the profiles.

    Parameters
    ----------
    angular : {"smooth", "published"}
        Fall-off across a muscle (erratum E3).
    steps : int
        Small steps in which muscles act together.
    support : float
        Share of the inward motion that bone and teeth take away; 0 is the plain muscle.
    drag : bool
        Whether skin around an insertion follows, where a muscle says so; unpublished.
    """

    angular: AngularProfile = "smooth"
    steps: int = 8
    support: float = 0.75
    drag: bool = True

    @staticmethod
    def of_profile(profile: Profile) -> VectorParameters:
        """Return the parameters of a named profile."""
        one_of("profile", profile, ("improved", "faithful"))
        if profile == "faithful":
            return VectorParameters(angular="published", support=0.0, drag=False)
        return VectorParameters()


@dataclass(frozen=True, eq=False)
class VectorFace:
    """Vector muscles bound to a head (`risorius.rig.Face`).

    Parameters
    ----------
    head : Head
    vectors : VectorSet
        Fitted to the head.
    mechanics : Mechanics
    bound : mapping of str to BoundMuscle
    controls : tuple of Control
    parameters : VectorParameters
    wrinkles : mapping of str to BoundWrinkles
        Of the muscles that make any.
    notes : tuple of str
        What was left out, and why.
    context : FaceContext
        What muscles see of the head when they bind.
    """

    head: Head
    vectors: VectorSet
    mechanics: Mechanics
    bound: Mapping[str, BoundMuscle]
    controls: tuple[Control, ...]
    parameters: VectorParameters
    wrinkles: Mapping[str, BoundWrinkles]
    notes: tuple[str, ...]
    context: FaceContext

    @staticmethod
    def build(
        head: Head,
        vectors: VectorSet | None = None,
        *,
        mechanics: Mechanics | None = None,
        parameters: VectorParameters | None = None,
        regions: Regions | None = None,
    ) -> VectorFace:
        """Fit a vector set to a head and compute every zone of influence.

        Parameters
        ----------
        head : Head
        vectors : VectorSet, optional
            The default set if left out.
        mechanics : Mechanics, optional
            Already built for this head.
        parameters : VectorParameters, optional
        regions : Regions, optional
            Of the skin, where they come from another head; found on this one if left out.

        Raises
        ------
        LandmarkError
            If the head lacks the landmarks of mouth, eyes and chin.
        MeshError
            If the lips are welded.
        """
        chosen = parameters or VectorParameters()
        moving = mechanics or Mechanics.build(head)
        fitted = (vectors or default_vector_set()).fitted(head)
        mesh = head.skin.mesh
        normals = vertex_normals(mesh.positions, mesh.faces)
        known = regions or find_regions(head, moving.lips, dict(moving.margins))
        outward = support_directions(
            mesh.positions, hinge=moving.jaw.hinge, face_height=head.height / 1.9
        )
        context = FaceContext(
            mesh.positions, normals, moving, known,
            chosen.angular, outward, chosen.support, chosen.drag,
        )  # fmt: skip
        bound = {muscle.name: muscle.bind(context) for muscle in fitted.muscles}
        wrinkles, notes = bind_all_wrinkles(fitted.muscles, context, faces=mesh.faces)
        controls = controls_of_muscles(tuple(bound)) + moving.controls
        notes = moving.notes + notes
        return VectorFace(head, fitted, moving, bound, controls, chosen, wrinkles, notes, context)

    def with_muscles(self, muscles: Iterable[VectorMuscle]) -> VectorFace:
        """Return the face with some of its muscles replaced, each by one of the same name.

        Only the zones of these muscles are computed anew.

        Raises
        ------
        ParameterError
            If the face has no muscle of such a name.
        """
        changed = {muscle.name: muscle for muscle in muscles}
        unknown = sorted(set(changed) - set(self.bound))
        if unknown:
            raise ParameterError(f"muscles: this face has no {', '.join(unknown)}")
        bound = {name: muscle.bind(self.context) for name, muscle in changed.items()}
        faces = self.head.skin.mesh.faces
        wrinkles, _ = bind_all_wrinkles(changed.values(), self.context, faces=faces)
        kept = {name: fold for name, fold in self.wrinkles.items() if name not in changed}
        return replace(
            self,
            vectors=self.vectors.replaced(changed.values()),
            bound={**self.bound, **bound},
            wrinkles={**kept, **wrinkles},
        )

    def displace_skin(self, values: Mapping[str, float]) -> FloatArray:
        """Return the displacement (w, 3) [mm] of the welded skin by muscles alone."""
        rest = self.head.skin.mesh.positions
        active = [(muscle, values.get(name, 0.0)) for name, muscle in self.bound.items()]
        moved = combine(active, rest, steps=self.parameters.steps)
        folds = [(wrinkles, values.get(name, 0.0)) for name, wrinkles in self.wrinkles.items()]
        raised = raise_wrinkles(folds, len(rest))
        return moved if raised is None else moved + raised

    def displace(self, pose: Pose) -> FloatArray:
        """Return the displacement (n, 3) [mm, canonical frame] of every input vertex.

        Raises
        ------
        ParameterError
            If a control is unknown or not finite.
        """
        values = resolve_pose(self.controls, pose).values
        return self.mechanics.pose(self.displace_skin(values), values)

    def pose(self, pose: Pose) -> FloatArray:
        """Return the posed positions (n, 3) [mm, canonical frame] of every input vertex."""
        return self.head.positions + self.displace(pose)
