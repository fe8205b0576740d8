"""Numbers with the sum of the terms that they came from: by hand, and by mpmath."""

from __future__ import annotations

import math
from decimal import Decimal
from types import SimpleNamespace
from typing import Any

import mpmath as mp
import pytest

from bondgraph.backends.forty_digits import Evaluation, Value, _rows_in_double, value
from bondgraph.ir.program import (
    Assign,
    Const,
    Function,
    NewtonBlock,
    PolynomialTape,
    Product,
    Ref,
    Sum,
    TapeOp,
    TapeOutput,
)


def _sized(number: float, size: float) -> Value:
    return Value(Decimal(number), size)


A, B = _sized(-6.0, 10.0), _sized(2.0, 3.0)


@pytest.mark.parametrize(
    ("found", "number", "size"),
    [
        (-A, 6.0, 10.0),
        (A + B, -4.0, 13.0),
        (A - B, -8.0, 13.0),
        (A * B, -12.0, 30.0),
        # a/b moves by 1/b with a, and as much as b is larger than it looks
        (A / B, -3.0, 10.0 * 3.0 / 4.0),
        (B**3, 8.0, 3 * 4.0 * 3.0),
        (B**0, 1.0, 1.0),
        (B**-2, 0.25, max(0.25, 2 * 2.0**-3 * 3.0)),
        (_sized(5.0, 1.0) ** 2, 25.0, 25.0),  # no less than it is
    ],
)
def test_arithmetic(found: Value, number: float, size: float) -> None:
    assert float(found) == number and found.size == pytest.approx(size)


def test_comparisons_are_of_numbers() -> None:
    same = _sized(2.0, 99.0)
    assert [A < B, B < A, same < B] == [True, False, False]
    assert [A <= B, same <= B, B <= A] == [True, True, False]
    assert same == B and A != B and B != 2.0
    assert value(-2.5).size == 2.5 and value(Decimal("0.1")).number == Decimal("0.1")
    with pytest.raises(ValueError, match="not a number"):
        value(math.nan)


def _program(*roots: NewtonBlock) -> Any:
    return SimpleNamespace(tables=(("bent", ((0.0, 1.0), (2.0, 5.0))),), roots=roots)


OUT, X, Y = Ref("local", "out"), Ref("known", "x"), Ref("known", "y")


def _run(expression: Any, *roots: NewtonBlock, **known: Value) -> Value:
    machine = Evaluation(_program(*roots))
    machine.values |= {Ref("known", name): x for name, x in known.items()}
    machine.run([Assign(OUT, expression, "", None)])
    found = machine.values[OUT]
    assert isinstance(found, Value)
    return found


def test_sums_keep_forty_digits() -> None:
    third = _run(Product((Const(1.0),), (Const(3.0),)))
    assert abs(third.number * 3 - 1) < Decimal("1e-39")
    tiny = _run(Sum(((True, X), (True, Y), (False, X))), x=value(1e20), y=value(1e-15))
    assert tiny.number == Decimal("1e-15") and tiny.size == pytest.approx(2e20)  # of 35 digits


@pytest.mark.parametrize(
    ("name", "at", "size"),
    [("sin", 0.7, 2.0), ("exp", -1.5, 1.5), ("sqrt", 2.25, 9.0), ("log", 3.0, 5.0),
     ("tanh", -0.3, 0.3), ("ssq", -2.0, 4.0)],
)  # fmt: skip
def test_a_function_moves_by_its_slope(name: str, at: float, size: float) -> None:
    law = {"ssq": lambda x: x * abs(x)}.get(name, getattr(mp, name, None))
    assert law is not None
    number, slope = float(law(mp.mpf(at))), abs(float(mp.diff(law, at)))
    found = _run(Function(name, (X,)), x=_sized(at, size))
    assert float(found) == pytest.approx(number, rel=1e-15)
    assert found.size == pytest.approx(abs(number) + slope * size, rel=1e-5)


def test_a_function_moves_with_each_of_its_arguments() -> None:
    """atan2(3, 4) by 4/25 and 3/25; a table by its slope of two."""
    found = _run(Function("atan2", (X, Y)), x=_sized(3.0, 5.0), y=_sized(4.0, 10.0))
    assert float(found) == pytest.approx(math.atan2(3.0, 4.0))
    assert found.size == pytest.approx(math.atan2(3.0, 4.0) + 5 * 0.16 + 10 * 0.12, rel=1e-5)
    table = _run(Function("table:bent", (X,)), x=_sized(0.5, 3.0))
    assert float(table) == 2.0 and table.size == pytest.approx(2.0 + 2 * 3.0, rel=1e-5)


def test_at_the_end_of_a_law_the_other_side_tells_how_it_moves() -> None:
    """The root of nearly nothing has no value on the one side; acos has none beyond one."""
    assert _run(Function("sqrt", (X,)), x=_sized(0.0, 1.0)).size > 0.0
    found = _run(Function("acos", (X,)), x=_sized(1.0, 1.0))
    assert float(found) == 0.0 and found.size > 0.0
    with pytest.raises(ValueError, match="domain"):
        _run(Function("log", (X,)), x=_sized(-1.0, 1.0))


def test_what_is_kept_counts_by_itself_and_by_some_of_its_terms() -> None:
    machine = Evaluation(_program())
    for space, share in (("coef", 1e-3), ("state", 0.05), ("local", None)):
        target = Ref(space, "z")  # type: ignore[arg-type]
        machine.put(target, _sized(-2.0, 100.0))
        expected = 100.0 if share is None else 2.0 + share * 100.0
        assert machine.values[target].size == pytest.approx(expected)


def test_a_root_has_forty_digits_and_moves_as_its_equation_says() -> None:
    """x^3 + x = c at c = 10: 2, which moves by 1/13."""
    x, c = Ref("local", "x"), Ref("local", "c")
    zero = Sum(((True, Product((x, x, x))), (True, x), (False, c)))
    slope = Sum(((True, Product((Const(3.0), x, x))), (True, Const(1.0))))
    block = NewtonBlock("R", ("c",), (), zero, (), slope, True, 0.0, 99, "", None)
    found = _run(Function("root:R", (X,)), block, x=_sized(10.0, 26.0))
    assert float(found) == pytest.approx(2.0, rel=1e-15)
    assert found.size == pytest.approx(2.0 + 26.0 / 13.0, rel=1e-4)


def test_long_tapes_are_the_same_in_doubles() -> None:
    """(2 - 3 p)(1 + 5 p) = 2 + 7 p - 15 p^2, of terms 2, 10 + 3 and 15."""
    ops = (
        TapeOp(1, 0, 0, 0, 1, True), TapeOp(1, 0, 1, 1, 1, False),
        TapeOp(2, 1, 0, 2, 2, True), TapeOp(2, 1, 1, 3, 2, False),
    )  # fmt: skip
    scales = [value(x) for x in (2.0, -3.0, 1.0, 5.0)]
    tape = PolynomialTape("r", 3, 3, (), ops, (TapeOutput("whole", 2, 3),), "", None)
    rows = _rows_in_double(tape, scales)
    assert [float(x) for x in rows[2]] == [2.0, 7.0, -15.0]
    assert [x.size for x in rows[2]] == [2.0, 13.0, 15.0]
    assert rows[0] == [] and rows[1] == []
    exact = Evaluation(_program())._rows(tape, scales)
    assert [(float(x), x.size) for x in exact[2]] == [(float(x), x.size) for x in rows[2]]
