"""What all methods share: the built-in head, jaw, lips, lids, eyes, cheeks, tongue and regions."""

from risorius.anatomy.eyelids import Eyelids, LidParameters, build_eyelids
from risorius.anatomy.eyes import Eyeball, fit_eyeball
from risorius.anatomy.jaw import JawAxes, JawPose, jaw_axes
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.regions import REGIONS, Regions, find_regions
from risorius.anatomy.template import builtin_head, warp_between
from risorius.anatomy.tongue import Tongue, build_tongue

__all__ = [
    "REGIONS",
    "Eyeball",
    "Eyelids",
    "JawAxes",
    "JawPose",
    "LidParameters",
    "Mechanics",
    "Regions",
    "Tongue",
    "build_eyelids",
    "build_tongue",
    "builtin_head",
    "find_regions",
    "fit_eyeball",
    "jaw_axes",
    "warp_between",
]
