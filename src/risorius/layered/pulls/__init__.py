"""What each kind of muscle wants of the skin: a place to go and a strength to hold it there."""

from risorius.layered.pulls.eye import eye_pull
from risorius.layered.pulls.lid import lower_lid_pull, upper_lid_pull
from risorius.layered.pulls.mouth import mouth_pull
from risorius.layered.pulls.pull import Pull
from risorius.layered.pulls.sheet import near_skin, sheet_pull
from risorius.layered.pulls.submental import REFERENCE_PITCH, submental_pull

__all__ = [
    "REFERENCE_PITCH",
    "Pull",
    "eye_pull",
    "lower_lid_pull",
    "mouth_pull",
    "near_skin",
    "sheet_pull",
    "submental_pull",
    "upper_lid_pull",
]
