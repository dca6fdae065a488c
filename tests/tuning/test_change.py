"""Rules of change: neutral ones change nothing, bounds and limits hold."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.tuning.change import Change, Gene, parameters_of

RULES = {
    "shift": Change("shift", -0.1, 0.1),
    "factor": Change("factor", 0.5, 2.0, most=3.0),
    "add": Change("add", -5.0, 5.0, least=1.0, most=9.0),
    "share": Change("share", 0.0, 0.9),
}


@pytest.mark.parametrize("way", RULES)
@given(value=st.floats(0.0, 0.9))
def test_the_neutral_change_changes_nothing(way: str, value: float) -> None:
    rule = RULES[way]
    assert rule.applied(value, rule.neutral, size=130.0) == value


def test_each_way_changes_as_it_says() -> None:
    assert RULES["shift"].applied(2.0, 0.05, size=130.0) == pytest.approx(8.5)
    assert RULES["factor"].applied(2.0, 0.5) == 1.0
    assert RULES["add"].applied(2.0, 4.0) == 6.0
    assert RULES["share"].applied(0.5, -0.2) == pytest.approx(0.3)


@given(value=st.floats(1.0, 9.0), change=st.floats(-100.0, 100.0))
def test_a_number_never_leaves_its_limits(value: float, change: float) -> None:
    assert 1.0 <= RULES["add"].applied(value, change) <= 9.0
    assert RULES["factor"].applied(value / 3.0, abs(change)) <= 3.0
    assert 0.0 <= RULES["share"].applied(value / 10.0, change) <= 0.9


@given(value=st.floats(0.0, 1.0), place=st.floats(0.0, 1.0))
def test_a_share_stays_between_its_limits_at_every_value_of_its_parameter(
    value: float, place: float
) -> None:
    rule = RULES["share"]
    parameter = rule.parameter("reach", value)
    assert parameter is not None and parameter.start == 0.0
    change = parameter.low + place * (parameter.high - parameter.low)
    assert -1e-12 <= rule.applied(value, change) <= max(value, 0.9) + 1e-12


def test_a_factor_of_nothing_is_no_gene_and_further_genes_are_asked_for() -> None:
    genes = (
        Gene("smile", "pull", RULES["factor"], 0.0),
        Gene("smile", "length", RULES["factor"], 2.0),
        Gene("smile", "bulge", RULES["add"], 0.0),
    )
    few = parameters_of(genes, ("bulge",), which="published")
    assert [each.name for each in few] == ["smile.length"]
    everything = parameters_of(genes, ("bulge",), which="all")
    assert [each.name for each in everything] == ["smile.length", "smile.bulge"]
