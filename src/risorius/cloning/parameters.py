"""How a clone is made: two profiles, every difference a field."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from risorius._check import as_number, one_of

__all__ = ["CloneParameters", "Form", "Profile", "clone_parameters"]

Profile = Literal["improved", "faithful"]
Form = Literal["delta", "absolute"]
_PROFILES = ("improved", "faithful")


@dataclass(frozen=True)
class CloneParameters:
    """Settings of motion cloning.

    Parameters
    ----------
    profile : {"improved", "faithful"}
        Which correspondence: the smooth registration, or the refinement by rays of the thesis.
    form : {"delta", "absolute"}
        Add the source's displacement to the target, or put the target's vertices on the deformed
        source as published (flattens a target finer than the source, erratum E8).
    local_scale : float
        How far displacements take over the local stretch and turn of the warp from source to
        target, 0 to 1; 0 keeps one scale and turn for the whole head.
    curved : bool
        Interpolate displacements between source vertices by a curved patch, not by planes.
    fold_relief : bool
        Smooth motion where the target's skin folds more than the source's.
    lip_contact, lid_contact, parts : bool
        Restore the seam of the lips; close the lids as far as the source's, outside the
        eyeball; move teeth, tongue, eyes and lashes.
    ray_share : float
        Faithful: ray length over ENS0, the height of the eyes over the nose.
    centres_per_pass, passes : int
        Faithful: centres added per pass, most passes.
    smoothing : float
        Faithful: lambda of the warp; 0 is published and breaks on dense meshes (erratum S1).
    centre_gap : float
        Faithful: least distance between centres, share of the face's height.
    still : float
        Motion below it counts as rest [mm].
    """

    profile: Profile = "improved"
    form: Form = "delta"
    local_scale: float = 0.0
    curved: bool = True
    fold_relief: bool = True
    lip_contact: bool = True
    lid_contact: bool = True
    parts: bool = True
    ray_share: float = 0.3125
    centres_per_pass: int = 125
    passes: int = 20
    smoothing: float = 0.02
    centre_gap: float = 0.012
    still: float = 1e-4

    def __post_init__(self) -> None:
        one_of("profile", self.profile, _PROFILES)
        one_of("form", self.form, ("delta", "absolute"))
        as_number("local_scale", self.local_scale, low=0.0, high=1.0)
        as_number("ray_share", self.ray_share, low=0.0)
        as_number("smoothing", self.smoothing, low=0.0)
        as_number("centre_gap", self.centre_gap, low=0.0)
        as_number("still", self.still, low=0.0)
        as_number("centres_per_pass", self.centres_per_pass, low=1)
        as_number("passes", self.passes, low=0)


def clone_parameters(profile: Profile = "improved") -> CloneParameters:
    """Return the settings of a profile."""
    one_of("profile", profile, _PROFILES)
    if profile == "improved":
        return CloneParameters()
    return CloneParameters(
        profile="faithful", curved=False, fold_relief=False, lip_contact=False, lid_contact=False
    )
