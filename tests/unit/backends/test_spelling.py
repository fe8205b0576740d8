"""Names of signals and residuals that would meet in the code."""

from __future__ import annotations

import pytest

from bondgraph.backends.spelling import DOUBLE_INTEGRAL, INTEGRAL, START, Spelling, suffixes
from bondgraph.backends.target import load
from bondgraph.ir.program import Field
from tests.unit.backends import programs
from tests.unit.backends.programs import known, residual


def test_members_of_the_derivatives_are_all_different() -> None:
    """Also where a signal is called as the integral of another would be, or as the time."""
    program = programs.program(
        "M",
        (),
        knowns=(
            known("y", integral=True, lowest=-2, start=True),
            known("y_integral"),
            known("time"),
            known("y_start", integral=True),
        ),
        integrals=(Field("y_double_integral", "", "", ""), Field("time_", "", "", "")),
    )
    found = Spelling(program, load("c")).inputs
    assert found["y", ""] == "y" and found["y_integral", ""] == "y_integral"
    assert "time" not in found.values()
    assert len(set(found.values())) == len(found) == 10
    for key, name in found.items():
        wish = "_".join(filter(None, key))
        assert name.rstrip("_") == wish.rstrip("_"), key


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        ({}, ()),
        ({"lowest": -1}, (INTEGRAL,)),
        ({"integral": True}, (INTEGRAL,)),
        ({"lowest": -2}, (INTEGRAL, DOUBLE_INTEGRAL)),
        ({"start": True}, (START,)),
        ({"lowest": -2, "start": True}, (INTEGRAL, DOUBLE_INTEGRAL, START)),
    ],
)
def test_a_signal_has_the_integrals_that_are_read(
    more: dict[str, object], expected: tuple[str, ...]
) -> None:
    assert suffixes(known("y", **more)) == expected


def test_the_number_of_a_residual_is_no_constant_of_the_code() -> None:
    names = ("ok", "OK_", "alarm", "r1")
    program = programs.program("M", tuple(residual(name) for name in names))
    found = Spelling(program, load("c")).numbers
    assert len(set(found.values())) == len(names)
    assert found["r1"] == "R1" and found["alarm"] == "ALARM_"
    assert not {"OK", "ALARM"} & set(found.values())


def test_an_encoder_has_a_memory_in_each_block_that_reads_it() -> None:
    """Its own name where one block does; else that of the block behind it."""
    increment, more = programs.ref("increment:q"), programs.ref("increment:p")
    each = [programs.put(f"residual:{name}", increment) for name in ("r1", "r2")]
    both = [each[0], programs.put("residual:r2", programs.plus(increment, more))]
    program = programs.program(
        "M",
        (residual("r1"), residual("r2")),
        knowns=(known("q", counts=24.0), known("p", counts=24.0)),
        first=tuple(both),
        step=tuple(both),
    )
    found = Spelling(program, load("c"))
    assert found.encoders == {("r1", "q"): "q_r1", ("r2", "q"): "q_r2", ("r2", "p"): "p"}
    assert [found.counted(block) for block in found.blocks] == [
        [("q_r1", "q")], [("q_r2", "q"), ("p", "p")],
    ]  # fmt: skip
