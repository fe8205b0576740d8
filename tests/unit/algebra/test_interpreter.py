"""The walk through a program, with fractions: every statement and expression by hand."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from bondgraph.algebra.interpreter import DOUBLE, Interpreter, Number, newton, or_nan
from bondgraph.ir.program import (
    Assign,
    Branch,
    Choice,
    Compare,
    Condition,
    Const,
    Dot,
    DotTerm,
    Expression,
    Field,
    First,
    Function,
    Logic,
    Mode,
    NewtonBlock,
    PolynomialTape,
    Product,
    Program,
    Ref,
    Sum,
    TapeOp,
    TapeOutput,
)

EXACT = Number(Fraction, {"abs": abs})
OUT = Ref("local", "out")


def program(**fields: Any) -> Program:
    """One without any statements but those that are given."""
    nothing: dict[str, Any] = dict.fromkeys(Program._fields, ())
    rates = {"rate": 4.0, "bandwidth": 3.0, "warmup": 0.0, "time_unit": 2.0}
    names = dict.fromkeys(("name", "title", "source", "digest", "bounds"), "")
    return Program(**{**nothing, **rates, **names, **fields})


def value(
    expression: Expression, number: Number = EXACT, modes: Any = (), **known: Any
) -> Any:
    """What an expression is, of signals that are `known`, where these `modes` are on."""
    machine = Interpreter(program(), number)
    machine.modes = {name: name in modes for name in ("on", "off")}
    machine.values |= {Ref("known", name): x for name, x in known.items()}
    machine.run([Assign(OUT, expression, "", None)])
    return machine.values[OUT]


A, B, C = (Ref("known", name) for name in "abc")
NUMBERS = {"a": Fraction(2), "b": Fraction(3), "c": Fraction(7)}


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (Product((A, B, C)), 42),
        (Product((C,), (A, B)), Fraction(7, 6)),
        (Product((C, C), (A,)), Fraction(49, 2)),
        (Sum(((True, A), (False, B), (True, C))), 6),
        (Sum(((False, A), (True, B), (False, C))), -6),
        (Sum(((False, A), (False, B))), -5),
        (Sum(()), 0),
        (Const(0.25), Fraction(1, 4)),
        (Function("abs", (Sum(((False, C),)),)), 7),
        (Function("pow", (B, Const(4.0))), 81),
        (Function("pow", (B, Const(-2.0))), Fraction(1, 9)),
    ],
)
def test_expressions(expression: Expression, expected: Fraction | int) -> None:
    found = value(expression, **NUMBERS)
    assert isinstance(found, int | Fraction) and found == expected


def test_a_power_that_is_no_whole_number_is_a_function_like_others() -> None:
    assert value(Function("pow", (C, Const(0.5))), DOUBLE, c=9.0) == pytest.approx(3.0, rel=1e-15)
    assert value(Function("near_tanh", (C,)), DOUBLE, c=0.5) == pytest.approx(0.46211716, abs=1e-7)
    assert value(Function("near_tanh", (C,)), c=Fraction(-50)) == Fraction(-1)  # of this kind, too


def test_zeros_keep_their_signs() -> None:
    """0.0 == -0.0, so that one must not stand for the other once it has been made."""
    both = Sum(((True, Const(5.0)), (True, Const(5.0))))
    assert value(both, DOUBLE) == 10.0
    for first, second in ((0.0, -0.0), (-0.0, 0.0)):
        machine = Interpreter(program())
        machine.run(
            Assign(Ref("local", name), Const(x), "", None)
            for name, x in (("first", first), ("second", second))
        )
        found = [machine.values[Ref("local", name)] for name in ("first", "second")]
        assert [str(x) for x in found] == [str(first), str(second)]


def test_a_constant_is_made_once() -> None:
    made: list[float] = []

    def real(x: float) -> Fraction:
        made.append(x)
        return Fraction(x)

    machine = Interpreter(program(), EXACT._replace(real=real))
    made.clear()
    machine.run([Assign(OUT, Product((Const(1.5), Const(1.5), Const(2.0))), "", None)] * 3)
    assert machine.values[OUT] == Fraction(9, 2) and sorted(made) == [1.5, 2.0]


ON, OFF = Mode("on"), Mode("off")


@pytest.mark.parametrize(
    ("condition", "expected"),
    [
        (ON, True),
        (OFF, False),
        (Compare("<", A, B), True),
        (Compare("<", A, A), False),
        (Compare("<", B, A), False),
        (Compare("<=", A, A), True),
        (Compare("<=", B, A), False),
        (Compare("==", A, A), True),
        (Compare("==", A, B), False),
        (Logic("not", (ON,)), False),
        (Logic("not", (OFF,)), True),
        (Logic("and", (ON, ON, ON)), True),
        (Logic("and", (ON, ON, OFF)), False),
        (Logic("and", (OFF, ON, ON)), False),
        (Logic("or", (OFF, OFF, ON)), True),
        (Logic("or", (ON, OFF, OFF)), True),
        (Logic("or", (OFF, OFF, OFF)), False),
    ],
)
def test_conditions(condition: Condition, expected: bool) -> None:
    found = value(Choice(condition, B, C), modes=("on",), **NUMBERS)
    assert found == (3 if expected else 7)


def test_what_is_not_asked_for_need_have_no_value() -> None:
    """1/0 on the side that is not taken, and after what has decided an `and` or an `or`."""
    nowhere = Product((A,), (Sum(()),))
    wrong = Compare("<", nowhere, A)
    modes = ("on",)
    assert value(Choice(ON, B, nowhere), modes=modes, **NUMBERS) == 3
    assert value(Choice(OFF, nowhere, C), modes=modes, **NUMBERS) == 7
    assert value(Choice(Logic("or", (ON, wrong)), B, C), modes=modes, **NUMBERS) == 3
    assert value(Choice(Logic("and", (OFF, wrong)), B, C), modes=modes, **NUMBERS) == 7
    with pytest.raises(ZeroDivisionError):
        value(Choice(OFF, B, nowhere), modes=modes, **NUMBERS)


def test_the_first_sample_is_no_condition_of_a_program() -> None:
    with pytest.raises(ValueError, match="of its own"):
        value(Choice(First(), A, B), **NUMBERS)


@pytest.mark.parametrize(("modes", "expected"), [(("on",), 12), ((), 33)])
def test_only_the_side_of_a_branch_that_is_taken_is_run(
    modes: tuple[str, ...], expected: int
) -> None:
    def side(factor: float, name: str) -> tuple[Assign, ...]:
        first = Assign(Ref("local", name), Product((A, Const(factor))), "", None)
        second = Assign(Ref("local", name), Product((first.target, Const(factor))), "", None)
        return first, second

    u, v = Ref("local", "u"), Ref("local", "v")
    branch = Branch(
        OUT, Choice(ON, Sum(((True, u), (True, v))), u), side(2.0, "u"), side(4.0, "u"), "", None
    )
    machine = Interpreter(program(), EXACT)
    machine.modes = {"on": "on" in modes}
    machine.values |= {A: Fraction(2), v: Fraction(4)}
    after = Sum(((True, OUT), (True, Const(float(not modes)))))
    machine.run([branch, Assign(OUT, after, "", None)])
    assert machine.values[OUT] == expected  # 2*2*2 + 4; 2*4*4 + 1


def test_a_dot_is_a_sum_over_derivatives_and_terms() -> None:
    machine = Interpreter(program(), EXACT)
    for k, (coef, known) in enumerate([(2, 3), (5, 7), (11, 13)]):
        machine.values[Ref("coef", "p", k)] = Fraction(coef)
        machine.values[Ref("known", "y", k)] = Fraction(known)
    machine.values[Ref("coef", "q", 0)] = Fraction(100)
    machine.values[Ref("known", "u", 0)] = Fraction(17)
    terms = (DotTerm("p", "y", 2), DotTerm("q", "u", 1))  # the third of p is not asked for
    machine.run([Dot(OUT, terms, "", None), Dot(Ref("local", "none"), (), "", None)])
    assert machine.values[OUT] == 2 * 3 + 5 * 7 + 1700
    assert machine.values[Ref("local", "none")] == 0


def test_a_tape_multiplies_polynomials() -> None:
    """(a + b p)(1 + c p): row 1 is the first factor, row 2 all; then row 1 is used again."""
    ops = (
        TapeOp(1, 0, 0, 0, 1, True),  # a
        TapeOp(1, 0, 1, 1, 1, False),  # + b p
        TapeOp(2, 1, 0, 2, 2, True),
        TapeOp(2, 1, 1, 3, 2, False),
        TapeOp(1, 0, 2, 3, 1, True),  # c p^2, and nothing of what was there
    )
    outputs = (TapeOutput("whole", 2, 3), TapeOutput("again", 1, 3), TapeOutput("part", 2, 1))
    tape = PolynomialTape("r", 3, 3, (A, B, Const(1.0), C), ops, outputs, "", None)
    machine = Interpreter(program(), EXACT)
    machine.values |= {Ref("known", name): x for name, x in NUMBERS.items()}
    machine.run([tape])
    found = {ref: x for ref, x in machine.values.items() if ref.space == "coef"}
    expected = {"whole": [2, 3 + 2 * 7, 3 * 7], "again": [0, 0, 7], "part": [2]}
    assert found == {
        Ref("coef", name, k): x for name, row in expected.items() for k, x in enumerate(row)
    }


def test_what_configure_reads() -> None:
    """Nominal values where no others are given, the options of the program where none are."""
    fields = (Field("R", "R", "", "", 3.0), Field("L", "L", "", "", 5.0), Field("k", "k", "", ""))
    options = "sample_time", "bandwidth", "time_unit"
    given = [Ref("param", name) for name in "RLk"] + [Ref("option", name) for name in options]
    statements = tuple(
        Assign(Ref("coef", ref.name), Product((ref, Const(2.0))), "", None) for ref in given
    )
    own = program(params=fields, configure=statements)

    def told(params: dict[str, Any], **options: Any) -> list[Fraction]:
        machine = Interpreter(own, EXACT)
        machine.configure(params, options)
        return [machine.values[Ref("coef", ref.name)] for ref in given]

    assert told({"k": 7}) == [6, 10, 14, Fraction(1, 2), 6, 4]
    assert told({"k": 7, "L": 9}, bandwidth=8, time_unit=1) == [6, 18, 14, Fraction(1, 2), 16, 2]
    with pytest.raises(KeyError):
        Interpreter(own).configure()


def test_tables_are_read_forwards_and_backwards() -> None:
    """At y = 15 the map goes from 6 by way of 12 on: at x = 2 it is 9."""
    rows = (0.0, 10.0, 20.0), (1.0, 5.0, 7.0), (3.0, 9.0, 15.0)
    tables = (("bent", ((0.0, 1.0), (2.0, 5.0))), ("map", rows), ("map'", rows))
    machine = Interpreter(program(tables=tables))
    machine.values |= {A: 0.5, B: 15.0, C: 9.0}
    for name, args, expected in (("bent", (A,), 2.0), ("map'", (C, B), 2.0), ("map", (C, B), 12.0)):
        machine.run([Assign(OUT, Function(f"table:{name}", args), "", None)])
        assert machine.values[OUT] == expected


def cube(further: tuple[Assign, ...] = (), **fields: Any) -> NewtonBlock:
    """x^3 + x - c, which grows; its slope is 3 x^2 + 1."""
    x, c = Ref("local", "x"), Ref("local", "c")
    cubed = Assign(Ref("local", "y"), Product((x, x, x)), "", None)
    value = Sum(((True, cubed.target), (True, x), (False, c)))
    slope = Sum(((True, Product((Const(3.0), x, x))), (True, Const(1.0))))
    block = NewtonBlock("R", ("c",), (cubed,), value, further, slope, True, 0.0, 60, "", None)
    return block._replace(**fields)


def root(block: NewtonBlock, c: float, number: Number = DOUBLE) -> Any:
    machine = Interpreter(program(roots=(block,)), number)
    machine.values[A] = number.real(c)
    machine.run([Assign(OUT, Function("root:R", (A,)), "", None)])
    assert set(machine.values) == {A, OUT}  # what is inside of the search stays there
    return machine.values[OUT]


def test_a_root_is_searched_with_the_values_of_its_arguments() -> None:
    assert root(cube(), 10.0) == pytest.approx(2.0, rel=1e-14)
    assert root(cube(), -30.0) == pytest.approx(-3.0, rel=1e-14)
    found = root(cube(), 10.0, EXACT)
    assert isinstance(found, Fraction) and abs(found - 2) < Fraction(1, 10**14)


def test_a_root_without_a_slope_is_bisected() -> None:
    """Its further statements divide by zero, which is to be told from a value that there is not."""
    nowhere = Assign(Ref("local", "z"), Product((Const(1.0),), (Const(0.0),)), "", None)
    assert root(cube((nowhere,), most=200), 10.0) == pytest.approx(2.0, rel=1e-12)
    assert str(root(cube((nowhere,)), 10.0)) != "nan"
    assert str(root(cube(body=(nowhere,)), 10.0)) == "nan"
    assert str(root(cube(most=2), 10.0)) == "nan"


# ----------------------------------------------------------------------------------- newton


Look = Callable[[float], tuple[float, float]]


def visited(look: Look, rising: bool, guess: float, most: int) -> tuple[list[float], float]:
    """Where the search looks, and what it finds."""
    places: list[float] = []

    def noted(x: float) -> tuple[float, float]:
        places.append(x)
        return look(x)

    return places, newton(noted, rising, guess, most)


def test_a_line_takes_one_step_and_a_hit_none() -> None:
    line: Look = lambda x: (2.0 * x - 6.0, 2.0)  # noqa: E731
    assert visited(line, True, 0.0, 9) == ([0.0, 3.0], 3.0)
    assert visited(line, True, 3.0, 1) == ([3.0], 3.0)


def test_while_one_side_is_open_steps_are_twice_as_wide_each_time() -> None:
    """No slope: 1, 2, 4 and 8 to the right of 0, then into the middle of the last two."""
    for sign in (1.0, -1.0):
        for falls in (1.0, -1.0):

            def step(x: float, sign: float = sign, falls: float = falls) -> tuple[float, float]:
                return falls * (x - sign * 11.0), 0.0

            places, found = visited(step, falls > 0, 0.0, 7)
            assert places == [sign * x for x in (0.0, 1.0, 3.0, 7.0, 15.0, 11.0)]
            assert found == sign * 11.0


def test_steps_that_do_not_halve_the_value_are_replaced_by_bisections() -> None:
    """Once the slope is told four times as steep as it is, three quarters of the value are left."""

    def lazy(x: float) -> tuple[float, float]:
        return (x - 5.0, 4.0) if x > -4.0 else (-8.0, 0.8)

    # -4 + 10 = 6, then 6 - 1/4; another such step would be too short: the middle of -4 and 5.75
    assert visited(lazy, True, -4.0, 4)[0] == [-4.0, 6.0, 5.75, 0.875]

    def halving(x: float) -> tuple[float, float]:
        return (x - 5.0, 2.0) if x > 1.0 else (-8.0, 1.0)

    assert visited(halving, True, 1.0, 5)[0] == [1.0, 9.0, 7.0, 6.0, 5.5]


def test_a_step_to_where_the_search_has_been_is_replaced_by_a_bisection() -> None:
    values = {0.0: (-10.0, 1.25), 8.0: (2.0, 0.25), 4.0: (-1.0, 0.25), 6.0: (0.0, 1.0)}
    assert visited(values.__getitem__, True, 0.0, 9) == ([0.0, 8.0, 4.0, 6.0], 6.0)


def test_no_value_sends_the_search_back_towards_the_guess() -> None:
    def halfline(x: float) -> tuple[float, float]:
        return (x - 2.0, 0.1) if 0.0 < x < 50.0 else (float("nan"), float("nan"))

    places, found = visited(halfline, True, 9.0, 60)
    assert places[1] == 9.0 - 70.0  # as the slope has it: too far
    assert places[2] == (9.0 - 61.0) / 2  # back by a bisection
    assert found == pytest.approx(2.0)
    turned: Look = lambda x: (halfline(-x)[0], -halfline(-x)[1])  # noqa: E731
    places, found = visited(turned, False, -9.0, 60)
    assert places[1] == 61.0 and found == pytest.approx(-2.0)


def test_what_has_no_value_is_no_number() -> None:
    def nowhere() -> float:
        return 1.0 / 0.0

    def wrong() -> float:
        raise KeyError

    assert or_nan(lambda: 2.5) == 2.5
    assert str(or_nan(nowhere)) == "nan"
    assert str(or_nan(lambda: float("x"))) == "nan"  # a ValueError
    with pytest.raises(KeyError):
        or_nan(wrong)
