"""What all methods share: the built-in head, jaw, lips, lids, eyes, cheeks, tongue and regions."""

from risorius.anatomy.eyelids import Eyelids, LidParameters, build_eyelids
from risorius.anatomy.eyes import Eyeball, fit_eyeball
from risorius.anatomy.jaw import JawAxes, JawPose, jaw_axes
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.regions import REGIONS, Regions, find_regions
from risorius.anatomy.skull import Skull, builtin_skull, load_skull
from risorius.anatomy.skull_fit import FittedSkull, fit_skull
from risorius.anatomy.template import builtin_head, warp_between
from risorius.anatomy.tongue import Tongue, build_tongue

__all__ = [
    "REGIONS",
    "Eyeball",
    "Eyelids",
    "FittedSkull",
    "JawAxes",
    "JawPose",
    "LidParameters",
    "Mechanics",
    "Regions",
    "Skull",
    "Tongue",
    "build_eyelids",
    "build_tongue",
    "builtin_head",
    "builtin_skull",
    "find_regions",
    "fit_eyeball",
    "fit_skull",
    "jaw_axes",
    "load_skull",
    "warp_between",
]
