"""`risorius bench`: the ways to run the solver, side by side."""

from __future__ import annotations

from tests.cli.running import answer, run


def test_every_way_is_measured_against_the_scalar_reference() -> None:
    said = answer(run("bench", "--sizes", "700", "--rounds", "1", "--json"))
    size = said["sizes"]["700"]
    assert {"scalar", "packed", "lanes"} <= set(size["ways"])
    assert size["ways"]["scalar"]["times_faster_than_scalar"] == 1.0
    assert all(way["milliseconds"] > 0.0 for way in size["ways"].values())
    assert max(size["difference_from_scalar"].values()) < 1e-3
    assert 0.0 < size["megabytes"]["packed"] < size["megabytes"]["lanes"] < 20.0
    assert said["settled"]["pose_count"] == 84
    assert said["settled"]["has_settled"]


def test_the_table_states_memory_and_the_time_of_settling() -> None:
    said = run("bench", "--sizes", "400", "--rounds", "1").stdout
    assert said.splitlines()[0].split()[-1] == "MB"
    assert "84 poses of" in said


def test_sizes_that_are_no_numbers_are_refused() -> None:
    result = run("bench", "--sizes", "many")
    assert result.exit_code == 1
    assert "sizes: 'many' must be whole numbers with commas" in result.stderr
