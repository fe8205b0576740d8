"""What is said of loops and sums that elimination could not take apart, for equations by hand."""

from __future__ import annotations

import pytest

from bondgraph.ir.equation_system import Equation
from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.ir.residuals import Missing
from bondgraph.passes.elimination.shortfall import loop_unsolvable
from bondgraph.text.source import Source, Span

p = Pool()
x, y = p.symbol("x", Kind.FLOW), p.symbol("y", Kind.FLOW)
a = p.symbol("a", Kind.PARAM)
s = p.symbol("s", Kind.SENSOR)
on = p.symbol("on", Kind.MODE)
_TEXT = Source("m.bg", "abcdefghij")


def law(name: str, zero: Expr, kind: str = "law", rate: Expr | None = None) -> Equation:
    at = "abcdefghij".index(name)
    return Equation(
        kind, name, zero, (x, y), 0, Span(_TEXT, at, at + 1), rate=rate,  # type: ignore[arg-type]
    )  # fmt: skip


def told(*equations: Equation) -> Missing:
    """What is said of a loop of these equations, the last of which closes it."""
    (found,) = loop_unsolvable(p, [equations[0]], [], equations, [])
    return found


FIXED = p.add((1, p.mul(a, x)), (1, y))
MOVING = p.add((1, p.mul(s, x)), (1, y))


@pytest.mark.parametrize(
    ("zero", "code"),
    [
        (MOVING, "loop-too-large"),
        (p.add((1, p.mul(s, s, x)), (3, y), (1, s)), "loop-too-large"),
        # linear with constant coefficients: then it is not what moves that makes it hard
        (FIXED, "loop-unsolvable"),
        # not linear: in one variable, in the product of both, and where it may jump
        (p.add((1, MOVING), (1, p.power(x, 2))), "loop-unsolvable"),
        (p.add((1, MOVING), (1, p.fn("sin", y))), "loop-unsolvable"),
        (p.mul(s, x, y), "loop-unsolvable"),
        (p.add((1, MOVING), (1, p.choose(on, x, y))), "loop-unsolvable"),
    ],
)
def test_a_linear_loop_with_what_moves_before_its_variables_is_too_large(
    zero: Expr, code: str
) -> None:
    for equations in ([law("a", FIXED), law("b", zero)], [law("a", zero), law("b", FIXED)]):
        assert told(*equations).finding.code == code


def test_of_a_storage_its_rate_counts() -> None:
    rate = p.sub(p.der(x), MOVING)
    assert told(law("a", rate, "state", rate=MOVING)).finding.code == "loop-too-large"
    other = p.add((1, MOVING), (1, p.power(x, 2)))
    assert told(law("a", MOVING, "state", rate=other)).finding.code == "loop-unsolvable"


@pytest.mark.parametrize(
    ("names", "spoken"),
    [
        ("a", "`a` could"),
        ("aba", "`a`, `b` could"),
        ("abc", "`a`, `b`, `c` could"),
        ("abcd", "`a`, `b`, `c` and 1 more could"),
        ("abcdeab", "`a`, `b`, `c` and 2 more could"),
    ],
)
def test_three_elements_of_a_large_loop_are_named_and_shown(names: str, spoken: str) -> None:
    found = told(*[law(name, MOVING) for name in names])
    assert f"The linear loop through {spoken} not be taken apart" in found.finding.message
    places = [label.span.text for label in found.finding.labels]
    assert places == sorted(set(names))[:3]
    assert found.elements == tuple(sorted(set(names)))


def test_junctions_are_not_named_where_there_are_elements() -> None:
    other = p.power(x, 2)
    found = told(law("j", other, "balance"), law("b", other), law("c", other, "sensor"))
    assert found.elements == ("b", "c") and "through `b`, `c` cannot" in found.finding.message
    assert [label.span.text for label in found.finding.labels] == ["b", "c"]
    assert told(law("j", other, "balance"), law("i", other, "state")).elements == ("j", "i")


def test_each_relation_that_a_loop_costs_is_told_with_what_it_rests_on() -> None:
    loop = [law("a", p.power(x, 2)), law("b", p.power(y, 2))]
    about = [law("c", FIXED), law("d", FIXED)]
    found = loop_unsolvable(p, about, [], loop, [])
    assert [m.about.name for m in found] == ["c", "d"]
    assert all(m.equations == tuple(loop) and m.elements == ("a", "b") for m in found)
