from __future__ import annotations

import pytest

from risorius.errors import ParameterError
from risorius.layered.faithful import FaithfulParameters


def test_the_defaults_are_the_printed_ones() -> None:
    p = FaithfulParameters()
    sheet, ring, skin = p.sheet, p.ring, p.skin
    assert (sheet.across_upper, sheet.along_upper, sheet.connection) == (1.0, 0.1, 1.0)
    assert (sheet.bend, sheet.volume, sheet.position) == (0.4, 1.0, 0.2)
    assert (ring.across_upper, ring.connection, ring.shear_upper, ring.shear_lower) == (
        0.2, 1.0, 0.3, 0.3,
    )  # fmt: skip
    assert (ring.bend, ring.volume, ring.position) == (1.0, 1.0, 0.2)
    assert (skin.stretch, skin.bend, skin.area, skin.volume) == (0.15, 0.95, 0.95, 1.0)
    assert (p.anchor, p.bone_anchor) == (0.2, 0.2)
    for solver in (p.muscle_solver, p.skin_solver):
        assert (solver.dt, solver.damping) == (0.0166, 0.2)
        assert solver.stiffness_rule == "each_iteration"
    assert p.muscle_solver.iterations == 1


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("anchor", 1.5, "anchor: 1.5 is above 1"),
        ("lid_hold", -0.1, "lid_hold: -0.1 is below 0"),
        ("ramp_steps", 0, "ramp_steps: 0 is below 1"),
        ("jaw_reach", 0.0, "jaw_reach: 0 is below"),
    ],
)
def test_numbers_out_of_range_are_refused(name: str, value: float, sentence: str) -> None:
    with pytest.raises(ParameterError, match=sentence):
        FaithfulParameters(**{name: value})
