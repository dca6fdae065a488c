"""Facial animation parameter units (FAPU): lengths of the neutral face that parameters count in."""

from __future__ import annotations

from collections.abc import Mapping

from risorius.controls.fap import FapUnit
from risorius.errors import LandmarkError
from risorius.landmarks.landmark_set import LandmarkSet

__all__ = ["face_units"]

_PARTS = 1024.0
_ANGLE = 1e-5  # AU [rad]
_PUPILS = ("3.5", "3.6")
_LIDS = ("3.1", "3.2", "3.3", "3.4")


def face_units(landmarks: LandmarkSet) -> Mapping[FapUnit, float]:
    """Measure the units of a face: lengths / 1024 [mm], AU = 1e-5 [rad].

    IRISD = 3.1.y - 3.3.y (both eyes' mean), ES = 3.5.x - 3.6.x, ENS = 3.5.y - 9.15.y,
    MNS = 9.15.y - 2.2.y, MW = 8.3.x - 8.4.x. Without pupils the lids stand for them.

    Parameters
    ----------
    landmarks : LandmarkSet
        Of the neutral face, canonical frame.

    Raises
    ------
    LandmarkError
        If landmarks are missing, or a length is not positive; it is named.

    References
    ----------
    ISO/IEC 14496-2, annex C.
    """
    missing = landmarks.missing((*_LIDS, "9.15", "2.2", "8.3", "8.4"))
    if missing:
        raise LandmarkError(
            f"landmarks: {', '.join(missing)} missing; the units of MPEG-4 parameters need them"
        )
    at = landmarks.position
    lids = landmarks.positions(_LIDS)
    has_pupils = not landmarks.missing(_PUPILS)
    eyes = landmarks.positions(_PUPILS) if has_pupils else 0.5 * (lids[:2] + lids[2:])
    lengths: dict[FapUnit, float] = {
        "IRISD": float((lids[:2, 1] - lids[2:, 1]).mean()),
        "ES": float(eyes[0, 0] - eyes[1, 0]),
        "ENS": float(eyes[:, 1].mean() - at("9.15")[1]),
        "MNS": float(at("9.15")[1] - at("2.2")[1]),
        "MW": float(at("8.3")[0] - at("8.4")[0]),
    }
    for name, length in lengths.items():
        if not length > 0.0:
            raise LandmarkError(
                f"landmarks: the unit {name} measures {length:.3g} mm, it must be positive; check "
                "lids, nose, lips and mouth corners"
            )
    units: dict[FapUnit, float] = {name: length / _PARTS for name, length in lengths.items()}
    return {**units, "AU": _ANGLE}
