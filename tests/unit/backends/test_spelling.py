"""Names of signals and residuals that would meet in the code."""

from __future__ import annotations

import pytest

from bondgraph.backends.spelling import DOUBLE_INTEGRAL, INTEGRAL, START, Spelling, suffixes
from bondgraph.backends.target import load
from bondgraph.ir.program import Choice, Const, Expression, Field, Function, Mode
from tests.unit.backends import programs
from tests.unit.backends.programs import known, plus, put, ref, residual


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


@pytest.mark.parametrize(
    ("value", "unheard"),
    [
        (plus(ref("known:y"), ref("known:z")), []),
        (Choice(Mode("on"), ref("known:y"), ref("known:z")), ["y", "z"]),
        (plus(ref("known:y"), Choice(Mode("on"), ref("known:z"), Const(0.0))), ["z"]),
        (plus(ref("known:y"), Function("tanh", (ref("known:z"),))), ["z"]),
        (plus(ref("known:y"), ref("increment:q")), []),  # counts are never NaN
    ],
)
def test_a_signal_is_unheard_that_may_be_no_number_while_the_residual_is_one(
    value: Expression, unheard: list[str]
) -> None:
    """What a residual is a sum of makes it NaN; a mode or counts are always numbers."""
    statement = put("residual:r1", value)
    program = programs.program(
        "M", (residual("r1"),), first=(statement,), step=(statement,),
        knowns=(known("y"), known("z"), known("on", kind="mode"), known("q", counts=24.0)),
    )  # fmt: skip
    found = Spelling(program, load("c"))
    (block,) = found.blocks
    assert found.unheard(block) == unheard
