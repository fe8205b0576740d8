"""Unknowns behind a turned frame are had without dividing by the sine of its angle."""

from __future__ import annotations

import math

import pytest
from sympy.core.function import AppliedUndef

import bondgraph
from bondgraph.ir.expr import Kind, Pool
from bondgraph.passes.elimination.linear_block import LinearEquation
from bondgraph.passes.elimination.turned import _Links

#: A vehicle driven over ground, of which the product of its speeds ahead and aside is measured;
#: `k` lengthens one axis.
VEHICLE = """bg 1
model Vehicle {{
    param m = 20 kg
    param b = 3 N.s/m
    input course : rad
    1:east <- Sf:over_e = ve
    1:north <- Sf:over_n = vn
    input ve : m/s
    input vn : m/s
    0:e0 <- east
    0:n0 <- north
    e0 -> MTF:ea {{ f1 = cos(course)*f2 }} -> 1:ahead
    n0 -> MTF:na {{ f1 = sin(course)*f2 }} -> ahead
    e0 -> MTF:es {{ f1 = -{k}*sin(course)*f2 }} -> 1:aside
    n0 -> MTF:ns {{ f1 = cos(course)*f2 }} -> aside
    ahead {{ -> I:m; -> R:b; <- Se:F }}
    aside {{ -> R:slip = 50 N.s/m }}
    sensor s = ahead.f*aside.f
}}
"""


def value(k: int, angle: float, more: float) -> float:
    """The relation at ve = 2, vn = 3, where the product is `more` than it is by hand."""
    (residual,) = bondgraph.compile(text=VEHICLE.format(k=k)).residuals
    sine, cosine = math.sin(angle), math.cos(angle)
    whole = cosine**2 + k * sine**2
    ahead, aside = (2 * cosine + 3 * k * sine) / whole, (3 * cosine - 2 * sine) / whole
    known = {"ve": 2, "vn": 3, "s": ahead * aside + more, "course": angle, "k": k}
    named = {x: x.func.__name__ for x in residual.expr.atoms(AppliedUndef)}
    named |= {x: x.name for x in residual.expr.free_symbols}
    return float(residual.expr.subs({x: known[n] for x, n in named.items() if n in known}))


@pytest.mark.parametrize("angle", [0.0, 0.7, math.pi / 2, 4.0])
def test_a_turned_frame_is_seen_alike_in_every_direction(angle: float) -> None:
    assert abs(value(1, angle, more=0)) < 1e-9
    assert abs(abs(value(1, angle, more=1)) - 1) < 1e-9


def test_axes_of_two_lengths_are_no_turned_frame_and_are_solved_for_all_the_same() -> None:
    assert abs(value(2, 0.7, more=0)) < 1e-9
    assert abs(value(2, 0.7, more=1)) > 1e-3


def test_unknowns_that_stand_for_each_other_all_stand_for_the_last_one() -> None:
    """u = v + 3 and v = 5 - w make 2 u + 3 w of what is left w + 16."""
    p = Pool()
    u, v, w = (p.symbol(name, Kind.UNKNOWN) for name in "uvw")

    def line(number: int, rest: int, **entries: int) -> LinearEquation:
        own = {p.symbol(name, Kind.UNKNOWN): p.num(c) for name, c in entries.items()}
        return LinearEquation(number, own, p.num(rest))

    links = _Links(p, lambda coefficient: coefficient is p.zero)
    left = links.taken([line(0, -3, u=1, v=-1), line(1, -5, v=1, w=1), line(2, 0, u=2, w=3)])
    assert left == [line(2, 16, w=1)]
    assert {own: (found.other, found.slope, found.rest) for own, found in links.found.items()} == {
        u: (w, p.num(-1), p.num(8)), v: (w, p.num(-1), p.num(5)),
    }  # fmt: skip
    # what is twice another one is a law, of an element, and no link
    assert links.taken([line(3, 0, u=1, v=1, w=1)]) != []
    assert not _Links(p, lambda c: False).link(line(4, 0, u=1, v=-2))
    assert not _Links(p, lambda c: True).link(line(5, 0, u=1, v=-1))
