"""Motion of a rig as time samples of a UsdSkel animation."""

from __future__ import annotations

from typing import Any

import numpy as np

from risorius.io.track import TurnTrack, WeightTrack

__all__ = ["JOINT", "add_track"]

JOINT = "head"
"""The one joint of the skeleton: it carries the whole head."""

_SLOWEST = 12.0  # moments per second below which they get no time codes of their own
_CODES_PER_SECOND = 24.0
_DIGITS = 6


def add_track(pxr: Any, stage: Any, animator: Any, track: WeightTrack) -> None:
    """Set weights and turns at every moment, and the time of the stage.

    Parameters
    ----------
    pxr : module
    stage : Usd.Stage
    animator : UsdSkel.Animation
        Has its blend shapes, weights and, where the head turns, no joints yet.
    track : WeightTrack
    """
    codes = _time(stage, track)
    weights = animator.GetBlendShapeWeightsAttr()
    rows = np.ascontiguousarray(track.weights, np.float32)
    if rows.shape[1]:
        for code, row in zip(codes, rows):
            weights.Set(pxr.Vt.FloatArray.FromNumpy(row), code)
    if track.turns is not None:
        _turn(pxr, animator, track.turns, codes)


def _time(stage: Any, track: WeightTrack) -> list[float]:
    """Say how long the stage runs and return the time code of each moment."""
    steps = np.diff(track.times)
    rate = 1.0 / float(np.median(steps)) if len(steps) else 0.0
    rate = round(rate, _DIGITS) if rate >= _SLOWEST else _CODES_PER_SECOND
    codes = np.round(track.times * rate, _DIGITS).tolist()
    stage.SetTimeCodesPerSecond(rate)
    stage.SetFramesPerSecond(rate)
    stage.SetStartTimeCode(codes[0])
    stage.SetEndTimeCode(codes[-1])
    return codes


def _turn(pxr: Any, animator: Any, turns: TurnTrack, codes: list[float]) -> None:
    animator.CreateJointsAttr([JOINT])
    animator.CreateTranslationsAttr(pxr.Vt.Vec3fArray(1, pxr.Gf.Vec3f(*turns.pivot.tolist())))
    animator.CreateScalesAttr(pxr.Vt.Vec3hArray(1, pxr.Gf.Vec3h(1.0, 1.0, 1.0)))
    rotations = animator.CreateRotationsAttr()
    for code, (x, y, z, w) in zip(codes, turns.rotations.tolist()):
        rotations.Set(pxr.Vt.QuatfArray(1, pxr.Gf.Quatf(w, x, y, z)), code)
