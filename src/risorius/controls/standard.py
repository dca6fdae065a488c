"""The registry of control names: one name, range and unit per thing a face can do.

A face offers a subset of these. Muscles are listed once and exist left and right (`_l`, `_r`)
unless they are single.
"""

from __future__ import annotations

from risorius.controls.control import Control, ControlGroup

__all__ = [
    "MUSCLES",
    "SINGLE_MUSCLES",
    "bilateral",
    "controls_of_muscles",
    "device_controls",
    "muscle_controls",
    "sided",
]

MUSCLES = {
    "frontalis": "raises the whole brow",
    "frontalis_inner": "raises the inner brow",
    "frontalis_outer": "raises the outer brow",
    "corrugator": "draws the brows together and down",
    "orbicularis_oculi": "narrows the eye and raises the cheek below it",
    "orbicularis_oculi_upper": "lowers the brow towards the eye",
    "nasalis": "wrinkles the side of the nose",
    "levator_alae_nasi": "raises the nostril wing and the upper lip beside it",
    "levator_labii_inner": "raises the upper lip beside the nose",
    "levator_labii": "raises the upper lip",
    "zygomaticus_minor": "raises the upper lip outwards",
    "zygomaticus_major": "pulls the mouth corner up and back",
    "risorius": "pulls the mouth corner sideways",
    "buccinator": "presses the mouth corner in and back",
    "depressor_anguli": "pulls the mouth corner down",
    "depressor_labii": "pulls the lower lip down",
    "platysma": "pulls the mouth corner and jaw skin down and back",
    "mentalis": "raises the chin and the lower lip",
}
"""Paired muscles, without side, and what contraction 1 does."""

SINGLE_MUSCLES = {
    "procerus": "draws the skin between the brows down",
    "orbicularis_oris": "closes and purses the lips",
    "orbicularis_oris_funnel": "rounds the lips and turns them outwards",
    "orbicularis_oris_upper": "rolls the upper lip over the teeth",
    "orbicularis_oris_lower": "rolls the lower lip over the teeth",
}
"""Muscles on the midline."""

_DEVICES: tuple[tuple[str, float, float, str, ControlGroup, bool, float], ...] = (
    # name, low, high, unit, group, paired, sign under mirroring
    ("jaw_pitch", -4.0, 18.0, "deg", "jaw", False, 1.0),
    ("jaw_yaw", -5.0, 5.0, "deg", "jaw", False, -1.0),
    ("jaw_protrusion", -2.0, 8.0, "mm", "jaw", False, 1.0),
    ("lips_together", 0.0, 1.0, "1", "lips", False, 1.0),
    ("cheek_puff", 0.0, 1.0, "1", "cheek", True, 1.0),
    ("lid_upper", -1.0, 1.0, "1", "lid", True, 1.0),
    ("lid_lower", -1.0, 1.0, "1", "lid", True, 1.0),
    ("gaze_yaw", -40.0, 40.0, "deg", "gaze", True, -1.0),
    ("gaze_pitch", -35.0, 30.0, "deg", "gaze", True, 1.0),
    ("tongue_out", 0.0, 1.0, "1", "tongue", False, 1.0),
    ("tongue_up", -1.0, 1.0, "1", "tongue", False, 1.0),
    ("tongue_side", -1.0, 1.0, "1", "tongue", False, -1.0),
)


def sided(name: str) -> tuple[str, str]:
    """Return the left and right control names of a paired name."""
    return f"{name}_l", f"{name}_r"


def bilateral(name: str) -> bool:
    """Return whether `name` (without side) is a paired control."""
    return name in MUSCLES or any(row[0] == name and row[5] for row in _DEVICES)


def muscle_controls(name: str) -> tuple[Control, ...]:
    """Return the control of a single muscle, or the left and right ones of a paired muscle."""
    if name in SINGLE_MUSCLES:
        return (Control(name, 0.0, 1.0, 0.0, "1", "muscle", name),)
    left, right = sided(name)
    return (
        Control(left, 0.0, 1.0, 0.0, "1", "muscle", right),
        Control(right, 0.0, 1.0, 0.0, "1", "muscle", left),
    )


def device_controls() -> tuple[Control, ...]:
    """Return the controls of jaw, lips, cheeks, lids, gaze and tongue.

    Signs: `jaw_pitch` opens, yaw turns towards the character's left, gaze pitch looks up, lids
    close at 1 and open wide at -1, the tongue goes out, up and to the left.
    """
    result: list[Control] = []
    for name, low, high, unit, group, paired, sign in _DEVICES:
        if not paired:
            result.append(Control(name, low, high, 0.0, unit, group, name, sign))
            continue
        left, right = sided(name)
        result.append(Control(left, low, high, 0.0, unit, group, right, sign))
        result.append(Control(right, low, high, 0.0, unit, group, left, sign))
    return tuple(result)


def controls_of_muscles(names: tuple[str, ...]) -> tuple[Control, ...]:
    """Return the controls of a face's muscles: registered ones first, in registry order.

    Muscles that a person named freely follow in the order of `names`; a name that ends in ``_l``
    or ``_r`` mirrors the other side where that is among them.
    """
    known = [
        control
        for base in (*MUSCLES, *SINGLE_MUSCLES)
        for control in muscle_controls(base)
        if control.name in names
    ]
    listed = {control.name for control in known}
    own: list[Control] = []
    for name in names:
        if name in listed:
            continue
        other = name[:-2] + {"_l": "_r", "_r": "_l"}.get(name[-2:], name[-2:])
        mirror = other if other in names else name
        own.append(Control(name, 0.0, 1.0, 0.0, "1", "muscle", mirror))
    return tuple(known + own)
