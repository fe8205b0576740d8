"""Eliminations of small systems that are written down equation by equation, and followed by hand.

Signals are called s, r, u and so on, unknowns x, y, z and so on, a state p.
"""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.ir.equation_system import Equation, EquationKind, EquationSystem
from bondgraph.ir.expr import Expr, Kind, Op, symbols, variables
from bondgraph.passes.elimination import chaining
from bondgraph.passes.elimination.chaining import Chain, Strategy
from bondgraph.passes.elimination.cost import FREE_START, ITERATION, LOOP, Cost
from bondgraph.text.source import Source, Span
from tests.unit.passes.relations import compiled

_NOWHERE = Span(Source("none.bg", ""), 0, 0)


class Bench:
    """Equations one by one: each method that adds one gives its number."""

    def __init__(self, sensor: str = "j.f") -> None:
        body = f"1:j {{ <- Se:u; -> R:R = 2 }}\nsensor late = {sensor}"
        self.graph = compiled(f"model M {{\n{body}\n}}").graph
        self.pool = self.graph.pool
        self.equations: list[Equation] = []

    def unknown(self, names: str, kind: Kind = Kind.FLOW) -> list[Expr]:
        return [self.pool.symbol(n, kind) for n in names]

    def signals(self, names: str, kind: Kind = Kind.INPUT) -> list[Expr]:
        return [self.pool.symbol(n, kind) for n in names]

    def add(self, *terms: tuple[int, Expr], kind: EquationKind = "law", name: str = "") -> int:
        """The sum of numbers times expressions is zero."""
        return self.zero(self.pool.add(*terms), kind, name)

    def zero(self, zero: Expr, kind: EquationKind = "law", name: str = "") -> int:
        name = name or f"e{len(self.equations)}"
        self.equations.append(Equation(kind, name, zero, tuple(variables(zero)), -1, _NOWHERE))
        return len(self.equations) - 1

    def state(self, state: Expr, rate: Expr, start: Expr | None = None) -> int:
        """state' = rate."""
        zero = self.pool.sub(self.pool.der(state), rate)
        inside = (state, *[v for v in variables(rate) if v is not state])
        own = Equation("state", "p", zero, inside, -1, _NOWHERE, state, rate, start)
        self.equations.append(own)
        return len(self.equations) - 1

    def system(self) -> EquationSystem:
        found = dict.fromkeys(v for e in self.equations for v in e.variables)
        unknowns = tuple(sorted(found, key=lambda v: v.id))
        return EquationSystem(self.graph, tuple(self.equations), unknowns, (), (), {})

    def begun(self, **strategy: int | bool) -> Chain:
        """As far as it goes without a loop, and without what is taken late."""
        chain = Chain(self.system(), Strategy(**strategy))  # type: ignore[arg-type]
        chain.start()
        chain.run()
        return chain

    def whole(self) -> Chain:
        chain = self.begun()
        while chain.stalled():
            chain.run()
        return chain


def _way(chain: Chain, variable: Expr) -> tuple[str, str, Cost]:
    """Of which equation a variable is, how it was had, and what that cost."""
    step = chain.steps[variable]
    assert step.variable is variable and step.closed is chain.closed[variable]
    return step.equation.name, step.how, chain.cost[variable]


# ----------------------------------------------------------------------------------- one step


def test_each_step_says_how_it_was_had_and_what_it_costs() -> None:
    """s = x, 2 x = y, exp z = y, s w = y: hard where a law is turned or a signal divided by."""
    b = Bench()
    (s,), (x, y, z, w) = b.signals("s"), b.unknown("xyzw")
    b.add((1, x), (-1, s), kind="sensor", name="s")
    b.add((2, x), (-1, y), name="double")
    b.add((1, b.pool.fn("exp", z)), (-1, y), name="turned")
    b.add((1, b.pool.mul(s, w)), (-1, y), name="divided")
    chain = b.begun()
    assert _way(chain, x) == ("s", "solved", Cost(0, 0, 0, 1, 0))
    assert _way(chain, y) == ("double", "solved", Cost(0, 0, 0, 2, 0))
    assert _way(chain, z) == ("turned", "inverted", Cost(0, 1, 0, 3, 0))
    assert _way(chain, w) == ("divided", "solved", Cost(0, 1, 0, 3, 0))
    assert chain.steps[y].value is b.pool.add((2, x)) and chain.closed[y] is b.pool.add((2, s))
    assert repr(chain.closed[w]) == "2" and chain.closed[x] is s
    assert all(chain.used) and chain.waiting == [0, 0, 0, 0]
    assert sorted(chain.sequence, key=chain.sequence.__getitem__)[:2] == [x, y]
    assert chain.loops.plain == [] and chain.heap == []


@pytest.mark.parametrize("free", [0, 1, 2])
def test_a_law_that_differentiates_costs_a_derivative_beyond_those_that_are_free(
    free: int,
) -> None:
    """y = x', p' = z with p = y, and a balance that only passes on what was differentiated."""
    b = Bench()
    (s,), (x, y, z, w), (p,) = b.signals("s"), b.unknown("xyzw"), b.unknown("p", Kind.STATE)
    b.add((1, x), (-1, s), kind="sensor", name="s")
    b.add((1, b.pool.der(x)), (-1, y), name="rate")
    b.add((1, p), (-1, y), name="momentum")
    b.state(p, z)
    b.add((1, z), (1, b.pool.der(x)), (1, w), kind="balance", name="sum")
    chain = b.begun(free=free)
    assert _way(chain, y) == ("rate", "solved", Cost(0, 0, max(1 - free, 0), 2, 1))
    assert _way(chain, p) == ("momentum", "solved", Cost(0, 0, max(1 - free, 0), 3, 1))
    assert _way(chain, z) == ("p", "differentiated", Cost(0, 0, max(2 - free, 0), 4, 2))
    assert _way(chain, w) == ("sum", "solved", Cost(0, 0, max(2 - free, 0), 5, 2))
    assert chain.closed[z] is b.pool.der(b.pool.der(s))


def test_what_a_sensor_tells_late_is_taken_after_what_is_told_at_once() -> None:
    b = Bench("delay(j.f, 1 s)")
    (s, r), (x,) = b.signals("sr"), b.unknown("x")
    b.add((1, x), (-1, s), kind="sensor", name="late")
    b.add((1, x), (-1, r), kind="sensor", name="prompt")
    chain = b.begun()
    assert _way(chain, x) == ("prompt", "solved", Cost(0, 0, 0, 1, 0))
    assert [row.rows for row in chain.loops.plain] == [(0,)]
    b.equations[1:] = [b.equations[0]._replace(kind="law")]  # of the same name, but no sensor
    assert _way(b.begun(), x)[2] == Cost(0, 0, 0, 1, 0)
    b.equations[1:] = []
    assert _way(b.begun(), x)[2] == Cost(0, 0, 0, 2, 0)


def test_an_equation_that_cannot_be_solved_offers_nothing() -> None:
    """x + sin 3 x is the same at several x."""
    b = Bench()
    (s,), (x,) = b.signals("s"), b.unknown("x")
    b.add((1, x), (1, b.pool.fn("sin", b.pool.add((3, x)))), (-1, s))
    chain = b.begun()
    assert chain.heap == chain.later == [] and not chain.steps and chain.waiting == [1]


def test_an_equation_whose_last_unknown_is_multiplied_by_zero_is_a_relation() -> None:
    """(x - y) z = s - r, where x and y turn out to be the same signal."""
    b = Bench()
    (s, r, u), (x, y, z) = b.signals("sru"), b.unknown("xyz")
    b.add((1, x), (-1, u))
    b.add((1, y), (-1, u))
    row = b.add((1, b.pool.mul(b.pool.sub(x, y), z)), (-1, s), (1, r))
    chain = b.begun()
    assert z not in chain.steps and chain.used[row]
    assert [(own.rows, own.expr) for own in chain.loops.plain] == [((row,), b.pool.sub(r, s))]


# ------------------------------------------------------------------------------- which is cheaper


def _detour(b: Bench, x: Expr, length: int, names: str = "abcdefg") -> Expr:
    """A variable that is x, so many laws further."""
    for name in names[:length]:
        (nearer,) = b.unknown(name)
        b.add((1, x), (-1, nearer))
        x = nearer
    return x


def test_a_division_by_a_signal_costs_more_than_any_detour() -> None:
    b = Bench()
    (s, u), (x, y) = b.signals("su"), b.unknown("xy")
    b.add((1, x), (-1, s), kind="sensor")
    b.add((1, b.pool.mul(u, y)), (-1, x), name="divided")
    b.add((1, y), (-1, _detour(b, x, 5)), name="far")
    assert _way(b.begun(), y)[0] == "far"


@pytest.mark.parametrize(("free", "taken"), [(0, "far"), (1, "rate")])
def test_a_derivative_costs_more_than_a_detour_unless_it_is_free(free: int, taken: str) -> None:
    b = Bench()
    (s,), (x, y) = b.signals("s"), b.unknown("xy")
    b.add((1, x), (-1, s), kind="sensor")
    b.add((1, b.pool.der(x)), (-1, y), name="rate")
    b.add((1, y), (-1, _detour(b, x, 3)), name="far")
    assert _way(b.begun(free=free), y)[0] == taken


@pytest.mark.parametrize("turned", [False, True])
def test_of_two_ways_the_shorter_one_is_taken_whatever_their_order(turned: bool) -> None:
    b = Bench()
    (s, r), (x, y) = b.signals("sr"), b.unknown("xy")
    b.add((1, x), (-1, s), kind="sensor")
    laws = [("near", 1, "a"), ("far", 3, "bcd")]
    for name, length, names in reversed(laws) if turned else laws:
        b.add((1, y), (-1, _detour(b, x, length, names)), (-1, r), name=name)
    chain = b.begun()
    assert _way(chain, y)[0] == "near" and len(chain.loops.plain) == 1


# ------------------------------------------------------------------- what is only taken late


@pytest.mark.parametrize(
    ("start", "starts", "late"),
    [(True, True, 1), (True, False, 1), (False, True, FREE_START), (False, False, None)],
)
def test_an_integral_is_offered_late_and_not_at_all_where_its_start_is_refused(
    start: bool, starts: bool, late: int | None
) -> None:
    """p' = x, with p(0) declared or not."""
    b = Bench()
    (s,), (x,), (p,) = b.signals("s"), b.unknown("x"), b.unknown("p", Kind.STATE)
    (begin,) = b.unknown("i", Kind.INITIAL)
    b.add((1, x), (-1, s), kind="sensor")
    b.state(p, x, begin if start else None)
    chain = b.begun(starts=starts)
    assert p not in chain.steps
    assert [offer.cost.late for offer in chain.later] == ([] if late is None else [late])
    if late is None:
        assert not chain.postponed()
        return
    assert not chain.postponed(late)  # which is no less
    assert chain.postponed(late + 1) and not chain.postponed()
    assert _way(chain, p) == ("p", "integrated", Cost(late, 0, 0, 2, 0))
    begins = begin if start else b.pool.symbol("p.0", Kind.FREE)
    assert chain.closed[p] is b.pool.integral(s, begins)


@pytest.mark.parametrize(
    ("kind", "of", "late"),
    [
        (Kind.INTEGRAL, Kind.INPUT, False),
        (Kind.INTEGRAL, Kind.MODE, False),
        (Kind.INTEGRAL, Kind.PARAM, False),
        (Kind.INTEGRAL, Kind.SENSOR, True),
        (Kind.STATE, Kind.INPUT, True),
    ],
)
def test_what_adds_up_commands_alone_is_taken_at_once(kind: Kind, of: Kind, late: bool) -> None:
    b = Bench()
    (s,), (p,), (begin,) = b.signals("s", of), b.unknown("p", kind), b.unknown("i", Kind.INITIAL)
    b.state(p, b.pool.add((2, s)), begin)
    assert (p in b.begun().steps) is not late


def test_an_iteration_is_later_than_an_integral_and_a_division_only_where_starts_are_refused() -> (
    None
):
    """y + exp y = x rises everywhere; u z = x."""
    b = Bench()
    (s, u), (x, y, z) = b.signals("su"), b.unknown("xyz")
    b.add((1, x), (-1, s), kind="sensor")
    b.add((1, y), (1, b.pool.power(y, 5)), (-1, x), name="bent")
    b.add((1, b.pool.mul(u, z)), (-1, x), name="divided")
    chain = b.begun()
    assert set(chain.steps) == {x, z}
    assert [offer.cost.late for offer in chain.later] == [ITERATION]
    assert not chain.postponed(ITERATION) and chain.postponed(ITERATION + 1)
    assert _way(chain, y)[:2] == ("bent", "inverted")
    chain = b.begun(starts=False)
    assert set(chain.steps) == {x}
    assert [offer.cost.late for offer in chain.later] == [ITERATION, ITERATION]


def test_of_what_is_late_the_least_late_is_taken_and_what_is_known_by_then_is_not() -> None:
    """Two integrals of p, declared and free: the free one is a relation then."""
    b = Bench()
    (s,), (x,), (p,) = b.signals("s"), b.unknown("x"), b.unknown("p", Kind.STATE)
    (begin,) = b.unknown("i", Kind.INITIAL)
    b.add((1, x), (-1, s), kind="sensor")
    b.state(p, x)
    declared = b.state(p, b.pool.add((2, x)), begin)
    chain = b.begun()
    assert chain.postponed()
    assert chain.steps[p].equation is b.equations[declared]
    chain.run()
    assert not chain.postponed() and all(chain.used)
    assert [row.rows for row in chain.loops.plain] == [(1,)]


# ---------------------------------------------------------------------------- relations


def _contradicted(kind: EquationKind = "law", held: int = 2, hard: bool = False) -> Chain:
    """A balance y = s - x gives y, and a law of three steps holds it: y = 2 w with w = 3 x."""
    b = Bench()
    (s, r), (x, w, y) = b.signals("sr"), b.unknown("xwy")
    b.add((1, x), (-1, r), kind="sensor", name="r")
    b.add((3, x), (-1, w), name="three")
    b.add((1, x), (1, y), (-1, s), kind="balance", name="balance")
    own = b.pool.mul(r, y) if hard else y
    b.add((1, own), (-2, w), kind=kind, name="law")
    if held > 2:
        (z,) = b.unknown("z")
        b.add((1, z), (-1, y), name="more")
    return b.begun()


def test_a_relation_stands_at_the_balance_that_a_law_contradicts() -> None:
    chain = _contradicted()
    x, w, y = chain.system.unknowns
    assert chain.steps[y].equation.name == "law" and chain.steps[y].how == "solved"
    assert chain.closed[y] is chain.steps[y].closed
    assert chain.steps[y].value is chain.pool.add((2, w))
    assert chain.steps[y].closed is chain.pool.add((6, chain.closed[x]))
    (closing,) = chain.result().closings
    assert closing.equation.name == "balance"
    assert [step.variable for step in closing.steps] == [x, w, y]
    assert all(chain.used)


@pytest.mark.parametrize(
    ("kind", "held", "hard"), [("balance", 2, False), ("law", 3, False), ("law", 2, True)]
)
def test_a_relation_stays_where_it_is_if_the_law_cannot_take_the_place_of_the_balance(
    kind: EquationKind, held: int, hard: bool
) -> None:
    """No law, y in a third equation, or a division by a signal."""
    chain = _contradicted(kind, held, hard)
    y = chain.system.unknowns[2]
    assert chain.steps[y].equation.name == "balance"
    (closing,) = chain.result().closings
    assert closing.equation.name == "law"


def test_a_storage_that_contradicts_a_balance_gives_the_rate_by_differentiating() -> None:
    """p' = y with p known, and y = s - x."""
    b = Bench()
    (s, r, u), (x, y), (p,) = b.signals("sru"), b.unknown("xy"), b.unknown("p", Kind.STATE)
    b.add((1, x), (-1, r), kind="sensor")
    b.add((1, p), (-1, u), kind="sensor")
    b.add((1, x), (1, y), (-1, s), kind="balance", name="balance")
    b.state(p, y)
    chain = b.begun()
    assert _way(chain, y)[:2] == ("p", "differentiated")
    assert chain.closed[y] is b.pool.der(u)
    assert [c.equation.name for c in chain.result().closings] == ["balance"]


def test_what_no_sensor_reaches_is_told_and_equations_that_hold_whatever_happens_are_not() -> None:
    b = Bench()
    (s,), (x, y, z) = b.signals("s"), b.unknown("xyz")
    b.add((1, x), (-1, s), kind="sensor")
    b.add((2, x), (-2, s), name="again")  # says the same once more
    far = b.add((1, y), (-1, z), name="far")
    result = b.whole().result()
    assert result.unsolved == (y, z) and result.unmonitored == (b.equations[far],)
    assert result.closings == () and [step.variable for step in result.steps] == [x]


def test_a_relation_rests_on_the_steps_that_lead_to_it_and_on_no_others() -> None:
    b = Bench()
    (s, r, u), (x, y, z, w) = b.signals("sru"), b.unknown("xyzw")
    rows = [
        b.add((1, x), (-1, s), kind="sensor"),
        b.add((2, x), (-1, y)),
        b.add((1, z), (-1, r), kind="sensor"),
        b.add((1, w), (-1, z)),
        b.add((1, b.pool.mul(s, y)), (-1, u)),  # by which y is not had, as it is divided by s
    ]
    chain = b.begun()
    assert chain.resting_on((rows[4],)) == [x, y]
    assert chain.resting_on((rows[3], rows[4])) == sorted([x, y, z, w], key=chain.sequence.get)
    (closing,) = chain.result().closings
    assert [step.variable for step in closing.steps] == [x, y] and closing.loop == ()


@pytest.mark.parametrize(("relations", "tangled"), [(13, False), (14, True)])
def test_relations_are_tangled_that_rest_on_every_step_again_and_again(
    relations: int, tangled: bool
) -> None:
    """A path of 101 steps, and relations at its end: 14 * 101 > 4 * 101 + 1000 > 13 * 101."""
    b = Bench()
    (s,), (x,) = b.signals("s"), b.unknown("x")
    b.add((1, x), (-1, s), kind="sensor")
    for at in range(100):
        (further,) = [b.pool.symbol(f"x{at}", Kind.FLOW)]
        b.add((1, x), (-1, further))
        x = further
    for at in range(relations):
        b.add((1, b.pool.mul(s, x)), (-1, b.pool.symbol(f"r{at}", Kind.INPUT)))
    assert b.begun().tangled() is tangled


# ------------------------------------------------------------------------------------- loops


def _exact(expr: Expr, values: dict[Expr, Fraction]) -> Fraction:
    """The value of a sum of products."""
    match expr.op:
        case Op.NUM:
            return Fraction(expr.number)
        case Op.SYM:
            return values[expr]
        case Op.ADD:
            return sum((c * _exact(a, values) for c, a in expr.terms), Fraction())
        case Op.MUL:
            found = Fraction(1)
            for base, exponent in expr.factors:
                found *= _exact(base, values) ** exponent
            return found
    raise AssertionError(expr.op)


class Measured(Bench):
    """Equations of numbers that are chosen first: each has a signal that makes it hold."""

    def __init__(self, **values: int) -> None:
        super().__init__()
        names = self.unknown("".join(values))
        self.values = {v: Fraction(x) for v, x in zip(names, values.values(), strict=True)}

    def told(self, *terms: tuple[int, Expr]) -> int:
        at = len(self.equations)
        signal = self.pool.symbol(f"s{at}", Kind.INPUT)
        self.values[signal] = sum((c * _exact(a, self.values) for c, a in terms), Fraction())
        return self.add(*terms, (-1, signal))

    def checked(self, chain: Chain) -> None:
        """Each step has the value that was chosen, and each relation is zero and says something."""
        final = chain.loops.solutions()
        for variable, closed in chain.closed.items():
            (expr,) = self.pool.substitute([closed], final)
            assert _exact(expr, self.values) == self.values[variable]
        for closing in chain.result().closings:
            assert _exact(closing.expr, self.values) == 0
            assert not variables(closing.expr) and symbols(closing.expr)


def test_a_loop_is_opened_at_the_variable_that_most_of_its_equations_hold() -> None:
    b = Measured(y=3, x=5, z=7)
    y, x, z = b.values
    first = b.told((1, y), (1, x))
    b.told((2, x), (1, z))
    b.told((1, x), (1, y), (-4, z))
    chain = b.begun()
    assert not chain.steps and chain.tear(states=False)
    assert _way(chain, x) == ("e0", "loop", LOOP) and chain.steps[x].equation is b.equations[first]
    chain.run()
    while chain.stalled():
        chain.run()
    assert [step.how for step in chain.steps.values()].count("loop") == 1
    b.checked(chain)
    assert chain.result().closings == () and not chain.result().unsolved


@pytest.mark.parametrize("more", [0, 1, 2])
def test_a_loop_gives_as_many_relations_as_it_has_equations_too_many(more: int) -> None:
    b = Measured(x=5, y=3)
    x, y = b.values
    for at in range(2 + more):
        b.told((1, x), (at + 2, y))
    result = (chain := b.whole()).result()
    b.checked(chain)
    assert len(result.closings) == more and not result.missing
    for closing in result.closings:  # one of the two is torn, and an equation gives it back
        (back,) = closing.loop
        assert {step.variable for step in closing.steps} == {x, y}
        used = [*(step.equation for step in closing.steps if step.how != "loop"), back]
        assert len({e.name for e in (*used, closing.equation)}) == 3


def test_an_underdetermined_part_is_not_opened() -> None:
    """Two equations about three variables, and beside them a loop of two."""
    b = Measured(x=5, y=3, z=2, v=4, w=6)
    x, y, z, v, w = b.values
    b.told((1, x), (1, y), (1, z))
    b.told((1, x), (-1, y), (2, z))
    b.told((1, v), (1, w))
    b.told((1, v), (-1, w))
    result = (chain := b.whole()).result()
    assert result.unsolved == (x, y, z) and set(chain.steps) == {v, w}
    assert len(result.unmonitored) == 2
    assert not chain.stalled()


def test_loops_of_their_own_are_opened_at_once() -> None:
    b = Measured(x=5, y=3, v=4, w=6)
    x, y, v, w = b.values
    for one, other in ((x, y), (v, w)):
        b.told((1, one), (1, other))
        b.told((1, one), (-1, other))
    chain = b.begun()
    assert chain.tear(states=False)
    assert sum(own in chain.steps for own in (x, y)) == sum(own in chain.steps for own in (v, w))
    chain.run()
    assert len(chain.steps) == 4  # the other one of each follows
    b.checked(b.whole())


def test_states_are_part_of_a_loop_only_where_they_have_to_be() -> None:
    """p' = x, y = p, x + 2 y = u: the loop is a differential equation of p."""
    b = Bench()
    (u,), (x, y), (p,) = b.signals("u"), b.unknown("xy"), b.unknown("p", Kind.STATE)
    b.state(p, x)
    b.add((1, y), (-1, p))
    b.add((1, x), (2, y), (-1, u))
    chain = b.begun()
    assert not chain.tear(states=False) and not chain.steps
    assert chain.tear(states=True) and chain.steps


def test_equations_that_cannot_be_solved_open_a_part_that_has_too_many_of_them() -> None:
    """x + sin 3 x is measured, once or twice: twice, there is a relation that nobody can have."""
    for count in (1, 2):
        b = Bench()
        (x,) = b.unknown("x")
        for signal in b.signals("sr"[:count]):
            b.add((1, x), (1, b.pool.fn("sin", b.pool.add((3, x)))), (-1, signal))
        chain = b.begun()
        assert not chain.tear(states=True)
        assert chain.tear(states=True, stubborn=True) is (count == 2)
        result = b.whole().result()
        # the difference of both is s - r, in which the torn variable cancels
        assert len(result.closings) + len(result.missing) == count - 1


def test_a_variable_of_two_values_is_taken_as_known() -> None:
    """x^2 = s and y = 2 x: no sign of the root is chosen."""
    b = Bench()
    (s,), (x, y) = b.signals("s"), b.unknown("xy")
    b.add((1, b.pool.power(x, 2)), (-1, s))
    b.add((2, x), (-1, y))
    chain = b.begun()
    assert not chain.steps and chain.tear_two_valued()
    assert _way(chain, x) == ("e0", "loop", LOOP)
    chain.run()
    assert y in chain.steps and not chain.tear_two_valued()


def _ring(length: int) -> Bench:
    """Each variable and twice the next one are a signal, all the way round."""
    b = Bench()
    ring = [b.pool.symbol(f"x{at}", Kind.FLOW) for at in range(length)]
    for at, (x, y) in enumerate(zip(ring, ring[1:] + ring[:1], strict=True)):
        b.add((1, x), (2, y), (-1, b.pool.symbol(f"s{at}", Kind.INPUT)))
    return b


@pytest.mark.parametrize(("length", "torn"), [(29, 1), (30, 0)])
def test_a_large_linear_loop_is_solved_as_a_whole_and_a_smaller_one_is_torn(
    length: int, torn: int
) -> None:
    chain = _ring(length).whole()
    assert [step.how for step in chain.steps.values()].count("loop") == torn
    assert len(chain.steps) == length and all(chain.used)
    signals = [chain.pool.symbol(f"s{at}", Kind.INPUT) for at in range(length)]
    values = {s: Fraction(at + 1) for at, s in enumerate(signals)}
    closed = [chain.closed[chain.pool.symbol(f"x{at}", Kind.FLOW)] for at in range(length)]
    known = [_exact(x, values) for x in chain.pool.substitute(closed, chain.loops.solutions())]
    for at, x in enumerate(known):
        assert x + 2 * known[(at + 1) % length] == at + 1


def test_a_large_loop_with_too_long_a_solution_is_put_aside(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(chaining, "LARGEST", 5)
    chain = _ring(30).whole()
    assert [len(own) for own in chain.oversized] == [30]
    assert not chain.steps and all(chain.used)


def test_a_large_loop_with_a_law_that_is_not_linear_is_torn() -> None:
    b = _ring(30)
    x, y = b.equations[0].variables
    (s,) = b.signals("s")
    bent = b.pool.add((1, x), (2, b.pool.fn("exp", y)), (-1, s))
    b.equations[0] = b.equations[0]._replace(zero=bent)
    chain = b.begun()
    assert not chain.block(list(range(30))) and not any(chain.used)
    assert chain.tear(states=False)
    assert [step.how for step in chain.steps.values()].count("loop") == 1


def test_what_is_around_an_equation_hangs_together_by_equations_of_two_unknowns() -> None:
    """x-y-z tie; the row of z, v, w is near but leads no further to v and w."""
    b = Bench()
    (s,), (x, y, z, v, w, a) = b.signals("s"), b.unknown("xyzvwa")
    (p,) = b.unknown("p", Kind.STATE)
    rows = [
        b.add((1, a), (-1, s), kind="sensor"),
        b.add((1, v), (-1, w)),
        b.add((1, z), (1, v), (1, w)),
        b.add((1, y), (-1, z)),
        b.add((1, x), (-1, y), (1, a)),  # of a nothing is open
        b.state(p, x),
    ]
    chain = b.begun()
    assert chain.around([rows[4]]) == [2, 3, 4]
    assert chain.around([rows[1]]) == [1, 2]
    assert chain.free_in(rows[4]) == [x, y]


@pytest.mark.parametrize("law", ["w/(a.f - b.f)", "int(w/(a.f - b.f))"])
def test_what_divides_by_what_a_bond_makes_zero_is_a_relation_that_cannot_be_had(law: str) -> None:
    """A transformer of one joins a and b, so that their flows are the same."""
    c = compiled(f"""model M {{
    input w
    let q = {law}
    1:a {{ <- Se:u; -> TF:t {{ f1 = f2 }} -> b; -> Df:fa }}
    1:b {{ -> R:R = 2; <- Se:v = q }}
}}""")
    assert not list(c.residuals)
    warnings = [d.code for d in c.report.diagnostics if d.severity == "warning"]
    assert warnings == ["relations-missing"]
