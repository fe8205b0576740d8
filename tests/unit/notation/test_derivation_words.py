"""What the steps of a derivation say: who is put where, what drops out, and what it comes to."""

from __future__ import annotations

import pytest

from bondgraph.ir.derivation import Derivation, DerivationStep, Move
from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.notation.derivation_words import (
    LatexLines,
    Line,
    ending,
    headline,
    lines,
    remark,
    title,
)
from bondgraph.notation.line import show
from bondgraph.text.source import Source

p = Pool()
f = p.symbol("a.f", Kind.FLOW)
u, y = p.symbol("u", Kind.INPUT), p.symbol("y", Kind.SENSOR)
R = p.symbol("R", Kind.PARAM)
zero = p.sub(u, p.mul(R, f))
value, closed = p.div(u, R), p.div(y, R)


def step(move: Move, uses: tuple[int, ...] = (1, 2), **given: object) -> DerivationStep:
    made = DerivationStep(3, move, None, zero, f, value, closed, uses)
    return made._replace(**given)


def derivation(factor: Expr, **given: object) -> Derivation:
    made = Derivation("r1", p, (step("close"),), p.sub(u, y), factor, {})
    return made._replace(**given)


@pytest.mark.parametrize(
    ("switches", "where"),
    [
        ((), ""),
        ((("on", True),), ", while on on"),
        ((("a", True), ("b", False)), ", while a on and b off"),
    ],
)
def test_a_title_names_the_positions(switches: tuple[tuple[str, bool], ...], where: str) -> None:
    found = title(derivation(p.one, switches=switches), "Motor")
    assert found == f"Derivation of r1 of Motor{where}"


@pytest.mark.parametrize(
    ("factor", "stopped", "last"),
    [
        (p.one, "", "SymPy agrees: what it derived is the compiler's r1."),
        (R, "", "SymPy agrees: what it derived is the compiler's r1 times R."),
        (p.zero, "it is too long", "Here the replay of r1 stops: it is too long."),
    ],
)
def test_the_last_sentence_says_what_was_shown(factor: Expr, stopped: str, last: str) -> None:
    assert ending(derivation(factor, stopped=stopped)) == last


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (step("rise", (2,)), "differentiate 2, so that no integral holds a torn unknown"),
        (step("untear", (4,)), "the loop closes: solve 4 for a.f"),
        (step("put", (2,), row=5), "put a.f from 5 into 2"),
        (step("lower", (2,), row=5), "5 takes the highest derivative of a.f out of 2"),
        (step("lower", (2,), row=5, times=1),
         "5, differentiated once, takes the highest derivative of a.f out of 2"),
        (step("lower", (2,), row=5, times=3),
         "5, differentiated 3 times, takes the highest derivative of a.f out of 2"),
        (step("free"), "differentiate: an initial value that nobody declared drops out"),
        (step("free", factor=R),
         "divide by R and differentiate: an initial value that nobody declared drops out"),
        (step("cancel"), "multiply out"),
        (step("scale"), "as the compiler writes it, this is r1"),
        (step("scale", factor=p.one), "as the compiler writes it, this is r1"),
        (step("scale", factor=R), "divided by R, this is r1"),
    ],
)  # fmt: skip
def test_a_headline_says_what_is_done_with_which_steps(given: DerivationStep, words: str) -> None:
    assert headline(derivation(p.one), given, Source("m.bg", ""), show) == words


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (step("solve"), ""),
        (step("cancel", gone=("q0",)), "q0 cancels"),
        (step("cancel", gone=("a", "b", "c")), "a, b and c cancel"),
        (step("solve", divisors=(y,)), "right while y is not zero"),
        (step("solve", divisors=(y, u)), "right while y and u are not zero"),
        (step("cancel", gone=("q0",), divisors=(y,)), "q0 cancels; right while y is not zero"),
    ],
)
def test_a_remark_says_what_goes_and_while_what_it_holds(given: DerivationStep, words: str) -> None:
    assert remark(given, show) == words


def test_the_equations_of_a_step_stand_below_each_other() -> None:
    """From the law to the unknown, and to known signals where these are not there already."""
    nothing = p.zero
    whole = [Line(nothing, zero), Line(f, value), Line(None, closed, "with 1, 2")]
    assert lines(step("solve"), nothing) == whole
    assert lines(step("solve", ()), nothing)[-1] == Line(None, closed)
    assert lines(step("solve", closed=value), nothing) == whole[:2]
    assert lines(step("tear"), nothing) == whole[:1]
    left = [Line(nothing, zero), Line(nothing, closed, "with 1, 2")]
    assert lines(step("row"), nothing) == lines(step("close"), nothing) == left
    assert lines(step("close", closed=value), nothing) == left[:1]
    assert lines(step("iterate"), nothing) == [Line(nothing, zero), Line(f, closed)]
    assert lines(step("untear"), nothing) == [Line(f, value)]
    assert lines(step("cancel"), nothing) == [Line(nothing, closed)]


def test_lines_of_latex_stand_at_the_equals_sign_with_their_notes() -> None:
    work = LatexLines(derivation(p.one))
    found = work.aligned([Line(p.zero, y), Line(None, u, "with 1")])
    assert found == (
        "\\begin{aligned}\n0 &= y \\\\\n &= u && \\text{with 1}\n\\end{aligned}"
    )
    assert work.inline(y) == "$y$"
    # between dollars it is LaTeX already
    assert work.plain("5 % of $a_{1}$ & b_2") == r"5 \% of $a_{1}$ \& b\_2"
