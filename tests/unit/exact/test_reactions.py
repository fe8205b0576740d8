"""What moves a relation: where it branches, faults of either sign, any seed."""

from __future__ import annotations

from collections.abc import Sequence, Set
from fractions import Fraction
from typing import Any

import pytest

import bondgraph
from bondgraph.algebra.implicit import invert
from bondgraph.exact.plant import Plant
from bondgraph.exact.plant_draws import ATTEMPTS, Draws
from bondgraph.exact.reactions import Reactions, _singly, branches
from bondgraph.exact.trajectory import ExactUnavailable, Trajectory
from bondgraph.field.numbers import DividedByZero
from bondgraph.field.sparse import Contradiction
from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols
from bondgraph.passes.relation.form import relations
from tests.bench import families
from tests.unit.passes.relations import compiled


def _forms(pool: Pool) -> dict[str, tuple[Expr, bool]]:
    """Expressions, and whether one point may show of them what another one does not."""
    x, y = pool.symbol("x", Kind.SENSOR), pool.symbol("y", Kind.SENSOR)
    below = pool.compare("<", x, y)
    return {
        "a rational function": (pool.div(pool.mul(x, y), pool.add((1, x), (1, y))), False),
        "a power": (pool.fn("pow", x, pool.num(Fraction(7, 5))), False),
        "a derivative": (pool.der(pool.mul(x, y)), False),
        "a comparison": (pool.choose(below, x, pool.zero), True),
        "a limit": (pool.fn("min", x, pool.one), True),
        "an absolute value": (pool.mul(y, pool.fn("abs", x)), True),
    }


@pytest.mark.parametrize("name", list(_forms(Pool())))
def test_where_one_point_is_not_enough(name: str) -> None:
    expr, expected = _forms(Pool())[name]
    assert branches([expr]) == expected


@pytest.mark.parametrize(("law", "expected"), [("cubic", False), ("broken", True), ("dry", True)])
def test_an_iteration_branches_where_its_equation_does(law: str, expected: bool) -> None:
    pool = Pool()
    x, y = pool.symbol("x", Kind.TEAR), pool.symbol("y", Kind.SENSOR)
    rises = {
        "cubic": pool.add((1, x), (1, pool.power(x, 3))),
        "broken": pool.choose(pool.compare("<", x, pool.zero), x, pool.scale(2, x)),
        "dry": pool.add((1, x), (1, pool.fn("sign", x))),
    }
    root = invert(pool, pool.sub(y, rises[law]), x, lambda _: None)
    assert root is not None and root.op is Op.ROOT
    assert branches([root]) == expected


def test_a_known_switch_is_a_branch_until_it_is_told() -> None:
    pool = Pool()
    x, on = pool.symbol("x", Kind.SENSOR), pool.symbol("on", Kind.MODE)
    switched = pool.choose(pool.logic("not", on), x, pool.one)
    assert branches([switched])
    assert not branches([switched], {on: 1})


@pytest.mark.parametrize(
    ("declared", "drag"),
    [
        (1, "max(b - 1.5, 0)"),  # shows as soon as b is above 1.5: with its own sign only
        (-1, "max(b, 0)"),  # shows as soon as b is positive: with the other sign only
        (2, "min(b - 0.5, 0)"),  # below 0.5: with either
    ],
)
def test_a_fault_that_shows_on_one_side_only(declared: int, drag: str) -> None:
    c = compiled(
        f"model M {{ param b = {declared}\n"
        f"1:i {{ <- Se:u; -> R:r {{ e = f + {drag} }}; -> Df:y }} }}"
    )
    assert set(c.signatures.signature("r1")) == {"b", "u", "y"}


@pytest.mark.parametrize("seed", [0, 1, 7])
def test_any_seed_finds_what_a_relation_depends_on(seed: int) -> None:
    # u + 3 i' + R (u + i) - R i - R u, in which R cancels
    c = compiled("model M { param R = 2\n 1:s { <- Se:u; -> R:R; -> Df:i; -> C:c = 1 } }")
    pool = c.graph.pool
    u, i = (pool.symbol(n, k) for n, k in (("u", Kind.INPUT), ("i", Kind.SENSOR)))
    R = next(v.symbol for v in c.graph.values if v.name == "R")
    ways = pool.mul(R, pool.add((1, u), (1, i))), pool.mul(R, i), pool.mul(R, u)
    expr = pool.add((1, u), (3, pool.der(i)), (1, ways[0]), (-1, ways[1]), (-1, ways[2]))
    found = Reactions(Plant(c.graph), seed).at_free_signals(expr)
    assert {s.symbol.name for s, hit in found.depends.items() if hit} == {"u", "i"}
    assert {s.symbol.name: n for s, n in found.orders.items()} == {"u": 0, "i": 1}


def test_a_relation_is_moved_by_what_is_in_its_own_loop() -> None:
    """u - R i holds on a healthy plant, not with another R; the other loop has nothing in it."""
    c = compiled(
        "model M { param R = 2; param S = 3\n 1:a { <- Se:u; -> R:ra = R; -> Df:i }\n"
        "1:b { <- Se:w; -> R:rb = S; -> Df:j } }"
    )
    pool = c.graph.pool
    u, i = (pool.symbol(n, k) for n, k in (("u", Kind.INPUT), ("i", Kind.SENSOR)))
    R, S = (next(v.symbol for v in c.graph.values if v.name == n) for n in "RS")
    relation = pool.sub(u, pool.mul(R, i))
    reactions = Reactions(Plant(c.graph), 1)
    assert [reactions.moves(relation, *f) for f in ((R,), (S,), (R, S))] == [True, False, True]


#: A cylinder with a valve to a supply and to the air: the pressure of the air matters only while
#: air goes out and does not choke, between one and 1.9 times that pressure.
_VALVE = """bg 1
model Cylinder {
  param ps = 6e5 Pa
  param p0 = 1e5 Pa
  param k = 2e-9
  param V = 2.4e-9
  input u
  0:p { -> C:v = V; -> De:m }
  MSf:valve {
    f = k*u*if(u > 0, if(p.e < 0.528*ps, ps, 2*sqrt(p.e*(ps - p.e))),
               if(p0 < 0.528*p.e, p.e, 2*sqrt(p0*(p.e - p0))))
  } -> p
}
"""


@pytest.mark.parametrize("seed", range(6))
def test_a_fault_that_shows_in_a_narrow_range_of_large_numbers_is_seen(seed: int) -> None:
    c = bondgraph.compile(text=_VALVE, seed=seed)
    assert set(c.signatures.signature("r1")) == {"ps", "p0", "k", "V", "u", "m"}


#: A flow that begins where a signal passes a limit; the limit is all that its size matters for.
_SPILL = """bg 1
model M {{ param R = 2; param k = 3; param kw = 0.5; param lim = 0.001; input u
  Sf:s = {flow}
  s -> 0:n {{ -> C:h(q0 = 0) {{ e = k*q }}; -> R:out = R; -> R:weir {{ f = {weir} }} }}
  1:m {{ <- Se:u; -> R:own = R; -> Df:i }}
  sensor y = m.f + n.e }}
"""


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("flow", ["if(u > 40 or u < -50, 1, 0)", "if(u > 1e6, 1, 0)"])
def test_an_input_that_is_only_compared_is_seen_at_any_limit(flow: str, seed: int) -> None:
    """y - i depends on u in no other way than by whether it is beyond."""
    c = bondgraph.compile(text=_SPILL.format(flow=flow, weir="kw*e"), seed=seed)
    flows = [r for r in c.signatures.residuals if "k" in c.signatures.signature(r)]
    assert len(flows) == 1
    assert {"k", "kw", "u", "y", "i"} <= set(c.signatures.signature(flows[0]))


@pytest.mark.parametrize("seed", [2, 3, 10])
def test_a_limit_far_below_the_signals_is_seen(seed: int) -> None:
    """Any limit above 0.001 closes the weir at some e that is above 0.001 and below that limit."""
    weir = "if(e > lim or e < -lim, kw*e, 0)"
    c = bondgraph.compile(text=_SPILL.format(flow="u", weir=weir), seed=seed)
    assert any("lim" in c.signatures.signature(r) for r in c.signatures.residuals)


def test_machines_that_are_alike_begin_differently(monkeypatch: pytest.MonkeyPatch) -> None:
    """Wires of one resistance feed equal motors, of which most relations compare two.

    Moved by the supply alone these would draw the same current, and no relation between two of
    them would see the wire; but each begins as it likes, however large the plant is.
    """
    monkeypatch.setattr("bondgraph.exact.plant._LARGE", 1)
    found = compiled(families.tree(32).removeprefix("bg 1\n"))
    plant = Plant(found.graph)
    exprs = [r.expr for r in relations(found.reduced, plant, 0).residuals]
    seen = Reactions(plant, 0).sensed(exprs)
    told = [{s.symbol.name for s in symbols(expr)} for expr in exprs]
    names = [{s.symbol.name for s in own} for own in seen]
    assert [k for k, own in enumerate(told) if "Rw" in own and "Rw" not in names[k]] == []
    assert sum("Rw" in own for own in told) == 32


def test_where_a_law_is_left_out_nothing_is_proved(monkeypatch: pytest.MonkeyPatch) -> None:
    law = "{ e = k*exp(f) }"
    graph = compiled(f"model M {{ param k = 2\n 1:j {{ <- Se:u; -> R:r {law}; -> Df:y }} }}").graph
    plant, draw = Plant(graph), Draws.trajectory
    node = next(n for n, node in enumerate(graph.nodes) if node.path == "r")
    tried: list[bool] = []

    def only_without_the_law(self: Draws, *args: Any, **options: Any) -> Trajectory:
        tried.append(options["still"])
        if any(own == node for own, _ in args[5].laws):
            raise Contradiction(0, node)
        return draw(self, *args, **options)

    monkeypatch.setattr(Draws, "trajectory", only_without_the_law)
    first = plant.trajectory(1, 2)
    assert len(first.part.laws) == len(plant.structure.assembly.laws) - 1
    moving = tried.count(False)
    assert moving == ATTEMPTS
    second = plant.trajectory(2, 2)  # what failed for the first one is not tried again
    assert second.part.laws == first.part.laws and tried.count(False) == moving
    y = next(s.symbol for s in graph.sensors)
    with pytest.raises(ExactUnavailable):
        Reactions(plant, 1).at_trajectory([y], None, 1)


def test_where_a_relation_divides_by_zero_each_fault_is_tried_at_few_points(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    c = compiled(
        """model M { param a = 2; param d = 4; param g = 7; input on : bool
        1:j { <- Se:u; -> R:brake { 0 = if(on, f, e) }; -> R:r { e = a*f*abs(f) }; -> Df:y }
        j { -> R:s { e = d*f }; -> R:t { e = g*f } }
        1:k { <- Se:v; -> R:q = 3; -> Df:w }
        sensor z = j.f*k.f }"""
    )
    pool, graph = c.graph.pool, c.graph
    y, z, w = (pool.symbol(name, Kind.SENSOR) for name in "yzw")
    quotient = pool.sub(pool.div(z, y), w)  # none while the brake is on, unless y errs
    drawn: list[tuple[str, ...]] = []
    whole = Plant.sample

    def counted(plant: Plant, *args: Any, **options: Any) -> object:
        drawn.append(tuple(options.get("faults", ())))
        return whole(plant, *args, **options)

    monkeypatch.setattr(Plant, "sample", counted)
    reactions = Reactions(Plant(graph), 1)
    symbols = graph.fault_symbols()
    moved = {name for name in "adguvwyz" if reactions.moves(quotient, symbols[name])}
    assert moved == {"w", "y", "z"}
    # at one point with the brake off, and with it on where all of forty have failed for `a`
    assert [drawn.count((name,)) for name in "adguv"] == [41, 5, 5, 5, 5]


@pytest.mark.parametrize(("well", "later"), [(False, 4), (True, 40)])
def test_what_a_fault_brings_to_zero_is_tried_as_often_for_the_next_one(
    well: bool, later: int
) -> None:
    """Where the healthy machine has a value no fault takes tries from another, in any order."""
    graph = compiled("model M { 1:j { <- Se:u; -> R:r = 2; -> Df:y } }").graph
    reactions, tried = Reactions(Plant(graph), 1), list[int]()

    def never(number: int) -> None:
        tried.append(number)
        raise DividedByZero

    def healthy(number: int) -> int:
        return number if well else never(number) or 0

    counts = []
    for _ in range(2):
        tried.clear()
        with pytest.raises(ExactUnavailable):
            reactions.draw(never, 1, "relation", healthy)
        counts.append(len(tried))
    assert counts == [40 if well else 80, later]


@pytest.mark.parametrize("far", [False, True])
def test_constants_that_alone_let_a_fault_be_seen_are_found_by_halves(far: bool) -> None:
    """Two of sixteen do, each for faults of its own, and two others together only; where a machine
    has no trajectory at so many other numbers they are asked for one by one."""
    pool = Pool()
    constants = [pool.symbol(f"c{k}", Kind.PARAM) for k in range(16)]
    a, b, c = (pool.symbol(name, Kind.PARAM) for name in "abc")
    asked: list[int] = []

    def seen_with(others: Sequence[Expr], wanted: Set[Expr]) -> Set[Expr]:
        asked.append(len(others))
        if far and len(others) > 2:
            raise ExactUnavailable("no point")
        shown = {a} if constants[3] in others else set()
        shown |= {a, b} if constants[11] in others else set()
        shown |= {c} if {constants[4], constants[9]} <= set(others) else set()
        return wanted & shown

    found = dict(_singly(seen_with, constants, {a, b, c}))
    assert {k: shown for k, shown in found.items() if shown} == {
        constants[3]: {a}, constants[11]: {a, b},
    }  # fmt: skip
    assert list(found) == sorted(found, key=constants.index)
    assert len(asked) < (31 if far else 16)
