"""The derivatives of known signals that the steps of an elimination take."""

from __future__ import annotations

import pytest

from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.ir.residuals import Missing, ReducedSystem
from bondgraph.notation.dump_reduced import derivative_orders, dump_reduced
from bondgraph.text.diagnostic import Diagnostic
from tests.unit.passes.circuits import RC, compiled

p = Pool()
y = p.symbol("y", Kind.SENSOR)
u = p.symbol("u", Kind.INPUT)
k = p.symbol("k", Kind.PARAM)
start = p.symbol("x0", Kind.INITIAL)


@pytest.mark.parametrize(
    ("expr", "order"),
    [
        (y, 0),
        (p.add((1, y), (1, k)), 0),
        (p.mul(k, p.der(y)), 1),
        (p.add((1, p.der(u, 2)), (1, p.mul(k, p.der(y)))), 2),
        (p.der(p.mul(k, p.der(y))), 2),
        (p.integral(y, start), -1),
        (p.integral(p.mul(k, p.integral(u, start)), start), -2),
        (p.add((1, p.integral(y, start)), (1, u)), 0),
        (k, None),
        (p.der(k), None),  # of a parameter that moves: no known signal
        (p.fn("sin", p.add((1, k), (1, p.der(k)))), None),
        (p.integral(k, start), None),
        (p.one, None),
        (p.add((1, p.der(k, 3)), (1, y)), 0),
    ],
)
def test_the_highest_derivative_of_a_known_signal(expr: Expr, order: int | None) -> None:
    assert derivative_orders([p.one, expr])[expr] == order


def _dumped(reduced: ReducedSystem) -> list[str]:
    return [" ".join(line.split()) for line in dump_reduced(reduced).splitlines() if line]


def test_how_each_unknown_follows_is_told_with_the_derivative_that_it_takes() -> None:
    """u - y - R i at s, and i - 3 y' at n, each behind the four that it rests on."""
    head, *lines = _dumped(compiled(RC).reduced)
    assert head == "6 of 6 unknowns follow, 2 relations"
    assert set(lines[:6]) == {
        "u.e = u D 0 # solved: law of u, line 4",
        "n.e = y D 0 # solved: sensor y, line 5",
        "s.f = i D 0 # solved: sensor i, line 4",
        "R.e = s.f*R D 0 # solved: law of R, line 4",
        "C.q = 3*n.e D 0 # solved: law of C, line 5",
        "C.f = D(C.q) D 1 # differentiated: storage C, line 5",
    }
    assert lines[6:] == [
        "left over: balance of s, line 4, 4 steps", "0 = u - y - R*i",
        "left over: balance of n, line 4, 4 steps", "0 = i - 3*D(y)",
    ]  # fmt: skip


def test_what_does_not_follow_and_what_nobody_watches_is_listed() -> None:
    reduced = compiled(RC).reduced
    equations = reduced.system.equations
    missing = Missing(equations[0], (), equations[1:3], Diagnostic("no-form", "it is too long"))
    other = reduced._replace(
        closings=reduced.closings[:1], missing=(missing,), unsolved=reduced.system.unknowns[:2],
        unmonitored=(equations[1], equations[1]),
    )  # fmt: skip
    lines = _dumped(other)
    assert lines[0] == "6 of 6 unknowns follow, 1 relation"
    names = [v.symbol.name for v in reduced.system.unknowns[:2]]
    assert lines[lines.index("0 = u - y - R*i") + 1 :] == [
        "missing: balance of s, line 4", "no-form: it is too long",
        "rests on: law of u, line 4; law of R, line 4",
        f"no sensor reaches: {', '.join(names)}",
        "not monitored", "law of u, line 4",
    ]  # fmt: skip
