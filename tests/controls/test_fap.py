from __future__ import annotations

from risorius.controls.fap import (
    FAP_COUNT,
    THESIS_LEAVES_OUT,
    fap_name,
    fap_number,
    faps,
)
from risorius.landmarks import feature_points


def test_the_table_has_all_66_low_level_parameters_in_order() -> None:
    assert list(faps()) == list(range(3, FAP_COUNT + 1))


def test_every_parameter_moves_a_known_feature_point_within_sane_bounds() -> None:
    for fap in faps().values():
        assert fap.point in feature_points()
        assert fap.low < fap.high
        assert fap.one_way == (fap.low == 0.0)
        assert (fap.unit == "AU") == (fap.way.startswith("t") or fap.way == "curl")


def test_left_and_right_parameters_move_mirrored_points_with_the_same_bounds() -> None:
    by_name = {fap.name: fap for fap in faps().values()}
    pairs = 0
    for fap in faps().values():
        other = by_name.get(fap.name.replace("_l_", "_r_").replace("_lm", "_rm"))
        if other is None or other is fap:
            continue
        pairs += 1
        assert feature_points()[fap.point].mirror == other.point
        assert feature_points()[fap.point].side == "left"
        assert (fap.low, fap.high, fap.unit) == (other.low, other.high, other.unit)
    assert pairs == 23


def test_the_set_of_the_thesis_leaves_out_the_pupils() -> None:
    assert {faps()[number].way for number in THESIS_LEAVES_OUT} == {"grow"}
    assert len(faps()) - len(THESIS_LEAVES_OUT) == 64


def test_names_and_numbers_are_inverse_and_other_names_have_no_number() -> None:
    assert all(fap_number(fap_name(number)) == number for number in faps())
    strangers = ("fap_1", "fap_2", "fap_69", "fap_03", "fap_3_neg", "fap_", "jawOpen", "fap_3 ")
    assert [fap_number(name) for name in strangers] == [None] * len(strangers)
