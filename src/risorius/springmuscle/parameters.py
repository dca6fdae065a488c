"""Everything that the profiles of the spring-muscle face differ in, as far as the skin goes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from risorius._check import as_number, one_of
from risorius.errors import ParameterError
from risorius.solvers.leapfrog import LeapfrogParameters

__all__ = ["PROFILES", "Profile", "SpringParameters"]

Profile = Literal["improved", "faithful"]
Masses = Literal["stiffness", "unit"]
Holding = Literal["tissue", "bone"]

# Drag, as published; slow modes make a finer tolerance dear.
_PUBLISHED_MOTION = LeapfrogParameters(kinetic=False, drag=0.1, tolerance=5e-3, step_limit=3000)


@dataclass(frozen=True, kw_only=True)
class SpringParameters:
    """The skin, its springs and how they are moved; defaults are the faithful profile.

    Kaehler, Haber and Seidel publish the structure and no numbers; spec section 3 lists those of
    the faithful profile. Lengths are millimetres of a face whose eyes are 91 mm apart at their
    outer corners; stiffness is in units of the median edge.

    Parameters
    ----------
    pretension : float
        Share of their length by which edges are too short at rest; a constant load balances
        them, so that the input stays at rest to the last bit. A sheet of springs without it has
        nothing to hold its shape when it is pressed together and crumples (finding S1).
    knee_strain, stiffening : float
        Strain beyond which an edge is stiffer by this share of its stiffness (section 4: biphasic).
    least_length, least_stiffness : float
        Floors of edges in terms of their medians (finding S2).
    lid_softness : float
        Stiffness of the edges in the lids over that of others.
    across : float
        Stiffness of springs from the lining of mouth and sockets to the skin in front of it.
    seal : float
        Stiffness of springs between touching lips while a muscle that seals them pulls.
    muscle_stiffness : float
        Of a spring from skin to muscle.
    mirrors : bool
        Whether each spring to muscle or bone has a partner that pushes from the other side
        (section 4).
    grip : float
        Stiffness of a position spring that takes skin along with its muscle, over that of the
        muscle spring. A pair of mirrored springs has no hold along the skin before it has slid by
        its own length (finding S4).
    resting : float
        What a muscle at rest keeps of its stiffness: at 1 relaxed muscles hold the skin against
        those that act (finding S3).
    waking : float
        Control at which a muscle holds the skin with its full stiffness.
    riding : bool
        Whether a muscle is taken along as far as others move its skin. Without it muscles that
        act on the same skin hold it against each other and average instead of adding.
    linked : bool
        Whether ends that lie in other muscles are held there while muscles contract (section 4).
        Riding does the same for all that hang on one skin.
    fall_off : bool
        Whether muscle springs fade towards the radius of influence.
    by_area : bool
        Whether springs to muscles, bones and home count by the skin that their vertex stands for,
        so that a finer mesh is not held more strongly.
    holding : {"tissue", "bone"}
        What resists: tissue, more where it is thin, or springs to the bones beneath.
    bone_stiffness, jaw_stiffness : float
        Of springs to skull and jaw.
    home : float
        Of position springs that draw skin home where it hangs on nothing else.
    tissue : float
        Of the resistance of tissue 8 mm thick is this times its passive share
        (`anatomy.skin.Skin.passive`).
    carried : bool
        Whether the shape that springs are at rest in is carried along by the jaw as skin is
        known to be; else only bones and muscles move and drag the skin.
    masses : {"stiffness", "unit"}
        Mass of a particle: the sum of the stiffness around it, or 1.
    even : bool
        Average with the mirrored pose on a symmetric head.
    support : float
        Share of the inward motion that bone and teeth take away.
    volume : float
        How much of its volume tissue keeps where it is pushed together.
    contact : bool
        Keep the skin off teeth and eyeballs and the lips off each other.
    relaxation : int
        Passes that spread the over-relaxation start over skin that hangs on nothing; 0 starts at
        rest (section 4).
    motion : LeapfrogParameters
        Leapfrog.
    """

    pretension: float = 0.0
    knee_strain: float = 0.2
    stiffening: float = 3.0
    least_length: float = 0.3
    least_stiffness: float = 0.1
    lid_softness: float = 1.0
    across: float = 0.0
    seal: float = 0.0
    muscle_stiffness: float = 0.1
    mirrors: bool = True
    grip: float = 0.0
    resting: float = 1.0
    waking: float = 1.0
    riding: bool = False
    linked: bool = True
    fall_off: bool = False
    by_area: bool = False
    holding: Holding = "bone"
    bone_stiffness: float = 0.1
    jaw_stiffness: float = 0.1
    home: float = 0.02
    tissue: float = 0.0
    carried: bool = False
    masses: Masses = "unit"
    even: bool = False
    support: float = 0.0
    volume: float = 0.0
    contact: bool = False
    relaxation: int = 10
    motion: LeapfrogParameters = _PUBLISHED_MOTION

    def __post_init__(self) -> None:
        pretension = as_number("pretension", self.pretension, low=0.0)
        if pretension >= 1.0:
            raise ParameterError(f"pretension: {pretension:g} must be below 1, edges keep a length")
        for name in (
            "knee_strain", "stiffening", "least_length", "least_stiffness", "lid_softness",
            "across", "seal", "muscle_stiffness", "grip", "waking", "bone_stiffness",
            "jaw_stiffness", "home", "tissue",
        ):  # fmt: skip
            as_number(name, getattr(self, name), low=0.0)
        as_number("resting", self.resting, low=0.0, high=1.0)
        as_number("volume", self.volume, low=0.0, high=1.0)
        as_number("support", self.support, low=0.0, high=1.0)
        if self.relaxation < 0:
            raise ParameterError(f"relaxation: {self.relaxation} must be 0 or more")
        one_of("masses", self.masses, ("stiffness", "unit"))
        one_of("holding", self.holding, ("tissue", "bone"))

    @staticmethod
    def of_profile(profile: Profile) -> SpringParameters:
        """Return the parameters of a profile."""
        return PROFILES[one_of("profile", profile, PROFILES)]


_FAITHFUL = SpringParameters()

PROFILES: dict[str, SpringParameters] = {
    "faithful": _FAITHFUL,
    "improved": replace(
        _FAITHFUL,
        pretension=0.7,
        stiffening=0.0,
        lid_softness=0.3,
        across=0.5,
        seal=1.0,
        muscle_stiffness=0.1,
        grip=0.3,
        resting=0.0,
        waking=0.0,
        riding=True,
        linked=False,
        fall_off=True,
        by_area=True,
        holding="tissue",
        bone_stiffness=0.0,
        jaw_stiffness=0.0,
        home=0.0,
        tissue=0.2,
        carried=True,
        masses="stiffness",
        even=True,
        support=0.4,
        volume=0.6,
        contact=True,
        motion=LeapfrogParameters(),
    ),
}
