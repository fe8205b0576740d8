"""Statements give the value of the expression, compute nothing twice and nothing in vain.

The reference walks the expression itself in fractions. An evaluator of statements beside it fails
at a division by zero, as C does not, so that what is computed where it has no value is seen.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import prod

import pytest

from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols
from bondgraph.ir.program import (
    Assign,
    Assignment,
    Branch,
    Choice,
    Compare,
    Condition,
    Const,
    Expression,
    Function,
    Logic,
    Product,
    Ref,
    Sum,
)
from bondgraph.passes.lowering.procedure import ONE, Procedure, positive_part
from bondgraph.passes.lowering.program_names import Names

Given = dict[str, Fraction]


class Desk:
    """A procedure, what it wrote, and what both come to for given numbers."""

    def __init__(self, *constants: str) -> None:
        self.pool = Pool()
        self.statements: list[Assignment] = []
        self.constants: dict[str, Expr] = {}
        self._fixed = set(constants)
        hoist = self.hoist if constants else None
        self.procedure = Procedure(
            self.pool, self.leaf, self.statements.append, Names(), "", hoist, self.constant
        )

    def __getitem__(self, name: str) -> Expr:
        kind = Kind.PARAM if name in self._fixed else Kind.SENSOR
        return self.pool.symbol(name, kind)

    def leaf(self, node: Expr) -> Expression | None:
        return Ref("known", node.symbol.name) if node.op is Op.SYM else None

    def constant(self, node: Expr) -> bool:
        return {s.symbol.name for s in symbols(node)} <= self._fixed

    def hoist(self, node: Expr) -> Expression:
        self.constants.setdefault(name := f"c{node.id}", node)
        return Ref("coef", name)

    def run(self, value: Expression, given: Given) -> Fraction:
        """The value after all statements."""
        return Machine(self, given).after(self.statements, value)


class Machine:
    """Runs statements in fractions; reading what was not assigned fails, assigning twice does."""

    def __init__(self, desk: Desk, given: Given) -> None:
        self.desk, self.given = desk, given
        self.locals: dict[str, Fraction] = {}

    def after(self, statements: Sequence[Assignment], value: Expression) -> Fraction:
        for statement in statements:
            assert statement.target.name not in self.locals
            if isinstance(statement, Branch):
                holds = self.holds(statement.value.condition)
                side = statement.yes if holds else statement.no
                found = self.after(side, statement.value.yes if holds else statement.value.no)
            else:
                found = self.number(statement.value)
            self.locals[statement.target.name] = found
        return self.number(value)

    def number(self, value: Expression) -> Fraction:
        match value:
            case Const(number):
                return Fraction(number)
            case Ref("known", name):
                return self.given[name]
            case Ref("coef", name):
                return true(self.desk.constants[name], self.given)
            case Ref("local", name):
                return self.locals[name]
            case Sum(terms):
                return sum((self.number(t) * (1 if s else -1) for s, t in terms), Fraction())
            case Product(factors, divisors):
                found = prod(map(self.number, factors), start=Fraction(1))
                for divisor in divisors:
                    found /= self.number(divisor)
                return found
            case Choice(condition, yes, no):
                return self.number(yes if self.holds(condition) else no)
        raise AssertionError(value)

    def holds(self, condition: Condition) -> bool:
        match condition:
            case Compare(op, left, right):
                return _compared(op, self.number(left), self.number(right))
            case Logic("not", (inner,)):
                return not self.holds(inner)
            case Logic("and", args):
                return all(self.holds(a) for a in args)
            case Logic("or", args):
                return any(self.holds(a) for a in args)
        raise AssertionError(condition)


def _compared(op: str, left: Fraction, right: Fraction) -> bool:
    return {"<": left < right, "<=": left <= right, "==": left == right}[op]


def true(root: Expr, given: Given) -> Fraction:
    """The value of an expression by its meaning: a condition looks no further than it has to."""
    known: dict[Expr, Fraction] = {}

    def at(node: Expr) -> Fraction:
        if node not in known:
            known[node] = meant(node)
        return known[node]

    def meant(node: Expr) -> Fraction:
        match node.op:
            case Op.NUM:
                return node.number
            case Op.SYM:
                return given[node.symbol.name]
            case Op.ADD:
                return sum((c * at(a) for c, a in node.terms), Fraction())
            case Op.MUL:
                return prod((at(a) ** e for a, e in node.factors), start=Fraction(1))
            case Op.CMP:
                return Fraction(_compared(node.name, at(node.args[0]), at(node.args[1])))
            case Op.LOGIC:
                if node.name == "not":
                    return Fraction(not at(node.args[0]))
                return Fraction((all if node.name == "and" else any)(map(at, node.args)))
            case Op.IF:
                condition, yes, no = node.args
                return at(yes if at(condition) else no)
        raise AssertionError(node.op)

    return at(root)


def texts(statements: Sequence[Assignment], *values: Expression) -> Iterator[Expression]:
    """All that is written out, with the parts of it."""
    stack: list[object] = [*statements, *values]
    while stack:
        at = stack.pop()
        if isinstance(at, Assign | Branch):
            stack += [at.value, *((*at.yes, *at.no) if isinstance(at, Branch) else ())]
        elif isinstance(at, tuple) and not isinstance(at, Ref | Const):
            if isinstance(at, Sum | Product | Choice | Function):
                yield at
            stack += at


def depth(value: object) -> int:
    inner = max(map(depth, value), default=0) if isinstance(value, tuple) else 0
    return inner + isinstance(value, Sum | Product | Choice)


# --------------------------------------------------------------- any expression


class Drawn:
    """Expressions by chance over x, y, z, parts shared, with 1/p only where p is not 0."""

    def __init__(self, desk: Desk, seed: int, names: str) -> None:
        self.desk, self.pool, self.rng = desk, desk.pool, random.Random(seed)
        self.parts = [desk[n] for n in names]

    def expression(self, size: int) -> Expr:
        for _ in range(size):
            self.parts.append(self.step())
        return self.pool.add(*((self.number(), p) for p in self.parts[-4:]))

    def part(self) -> Expr:
        return self.rng.choice(self.parts[-6:])

    def number(self) -> Fraction:
        return Fraction(self.rng.choice((-3, -2, -1, -1, 1, 1, 2, 5)), self.rng.choice((1, 1, 2)))

    def step(self) -> Expr:
        pool = self.pool
        match self.rng.randrange(6):
            case 0:
                return pool.mul(self.part(), self.part())
            case 1:
                return pool.choose(self.condition(2), self.part(), self.part())
            case 2:
                below = self.part()
                over = pool.add((1, pool.div(self.part(), below)), (self.number(), self.part()))
                return pool.choose(pool.compare("==", below, pool.zero), self.part(), over)
            case _:
                return pool.add((self.number(), self.part()), (self.number(), self.part()))

    def condition(self, deep: int) -> Expr:
        pool = self.pool
        if deep and self.rng.random() < 0.5:
            below = self.part()
            zero = pool.compare("==", below, pool.zero)
            test = pool.compare(
                self.rng.choice(("<", "<=")), self.part(), pool.div(pool.one, below)
            )
            if self.rng.random() < 0.5:
                return pool.logic("or", zero, test, self.condition(deep - 1))
            return pool.logic("and", pool.logic("not", zero), test, self.condition(deep - 1))
        return pool.compare(self.rng.choice(("<", "<=", "==")), self.part(), self.part())


@pytest.mark.parametrize("constants", ["", "z", "yz"])
@pytest.mark.parametrize("seed", range(25))
def test_statements_give_the_value_of_any_expression(seed: int, constants: str) -> None:
    """In points with many zeros and ties; what has no value on a side stays on that side."""
    desk = Desk(*constants)
    drawn = Drawn(desk, seed, "xyz")
    roots = [drawn.expression(6), drawn.expression(6)]
    values = desk.procedure.values(roots, None)
    for _ in range(20):
        given = {n: Fraction(drawn.rng.choice((-2, -1, 0, 0, 1, 1, 3))) for n in "xyz"}
        for root, value in zip(roots, values, strict=True):
            assert desk.run(value, given) == true(root, given)


@pytest.mark.parametrize("seed", range(25))
def test_nothing_is_computed_twice_without_conditions(seed: int) -> None:
    desk = Desk()
    pool, rng = desk.pool, random.Random(seed)
    parts = [desk[n] for n in "xyz"]
    for _ in range(12):
        a, b = rng.sample(parts[-5:], 2)
        parts.append(pool.add((1, a), (1, b)) if rng.random() < 0.5 else pool.mul(a, b))
    value = desk.procedure.value(pool.fn("max", *parts[-2:]), None)
    written = Counter(texts(desk.statements, value))
    assert written and set(written.values()) == {1}
    # what has a name is read more than once, or would be too deep in brackets
    reads = Counter(v for text in written for v in _operands(text) if isinstance(v, Ref))
    for statement in desk.statements:
        assert reads[statement.target] > 1 or depth(statement.value) > 5


def _operands(value: Expression) -> list[Expression]:
    match value:
        case Sum(terms):
            return [t for _, t in terms]
        case Product(factors, divisors):
            return [*factors, *divisors]
        case Function(_, args):
            return list(args)
    return []


def test_a_continued_fraction_is_cut_before_brackets_get_too_deep() -> None:
    """As the impedance of a ladder is one; C promises 63 brackets inside of each other."""
    desk = Desk()
    pool, x = desk.pool, desk["x"]
    chain = x
    for _ in range(30):
        chain = pool.div(pool.one, pool.add((1, chain), (1, desk["y"])))
    value = desk.procedure.value(chain, None)
    assert (
        max(map(depth, [value, *(s.value for s in desk.statements)])) <= 14
    )  # a sum in each product
    given = {"x": Fraction(1), "y": Fraction(1)}
    assert desk.run(value, given) == true(chain, given)


# ------------------------------------------------------------------- conditions


def test_what_both_sides_need_is_computed_before_and_once() -> None:
    desk = Desk()
    pool, x, y = desk.pool, desk["x"], desk["y"]
    shared = pool.power(pool.add((1, x), (1, y)), 3)
    sides = pool.add((2, shared), (1, x)), pool.mul(y, pool.power(shared, 2))
    value = desk.procedure.value(pool.choose(pool.compare("<", x, y), *sides), None)
    assert all(isinstance(s, Assign) for s in desk.statements)
    assert (
        Counter(texts(desk.statements, value))[Sum(((True, _known("x")), (True, _known("y"))))] == 1
    )


def test_a_side_keeps_what_it_alone_needs() -> None:
    """1/x has a name where it is used twice, and none is given where x is zero."""
    desk = Desk()
    pool, x, y = desk.pool, desk["x"], desk["y"]
    over = pool.add((1, pool.div(y, x)), (1, y))
    twice = pool.mul(over, pool.add((1, over), (1, x)))
    zero = pool.compare("==", x, pool.zero)
    first = desk.procedure.value(pool.choose(zero, y, twice), None)
    second = desk.procedure.value(pool.add((1, over), (7, twice)), None)  # what a side had is gone
    assert isinstance(desk.statements[0], Branch) and not desk.statements[0].yes
    nothing = {"x": Fraction(0), "y": Fraction(5)}
    assert Machine(desk, nothing).after(desk.statements[:1], first) == 5
    given = {"x": Fraction(2), "y": Fraction(6)}  # over = 9, twice = 99
    assert desk.run(first, given) == 99 and desk.run(second, given) == 9 + 7 * 99


def test_a_truth_value_is_one_or_zero() -> None:
    desk = Desk()
    pool, x, y = desk.pool, desk["x"], desk["y"]
    less = pool.compare("<", x, y)
    value = desk.procedure.value(pool.add((3, less), (1, x)), None)
    assert desk.run(value, {"x": Fraction(1), "y": Fraction(2)}) == 4
    assert desk.run(value, {"x": Fraction(2), "y": Fraction(1)}) == 2


def test_a_number_is_a_condition_that_holds_unless_it_is_zero() -> None:
    desk = Desk()
    pool, x, y = desk.pool, desk["x"], desk["y"]
    value = desk.procedure.value(pool.choose(x, y, pool.one), None)
    found = [desk.run(value, {"x": Fraction(n), "y": Fraction(9)}) for n in (-1, 0, 2)]
    assert found == [9, 1, 9]


# -------------------------------------------------------------------- constants


def test_a_step_never_divides_by_a_constant() -> None:
    desk = Desk("a", "b")
    pool, x, y, a, b = desk.pool, *(desk[n] for n in "xyab")
    root = pool.add(
        (Fraction(-1, 3), pool.div(x, a)), (2, pool.mul(y, x, pool.div(b, a))), (5, a), (-1, b)
    )
    value = desk.procedure.value(root, None)
    assert all(not t.divisors for t in texts(desk.statements, value) if isinstance(t, Product))
    given = dict(zip("xyab", map(Fraction, (6, 5, 4, 3)), strict=True))
    assert desk.run(value, given) == Fraction(-1, 2) + Fraction(45) + 20 - 3
    # what configure computes holds no signal, and all that is constant in the sum is one of them
    assert all(desk.constant(c) for c in desk.constants.values())
    assert sum(isinstance(t, Ref) for t in _operands(value)) == 1


@pytest.mark.parametrize("a", [0, 4])
def test_a_constant_that_may_have_no_value_is_asked_for_on_its_side_only(a: int) -> None:
    """The coefficient is 0 where the condition of the model says that it is not used."""
    desk = Desk("a")
    pool, x, a_ = desk.pool, desk["x"], desk["a"]
    zero = pool.compare("==", a_, pool.zero)
    over = pool.mul(x, pool.div(pool.one, pool.mul(a_, pool.add((1, a_), (1, pool.one)))))
    for root, expected in (
        (pool.choose(zero, x, over), Fraction(7) if a == 0 else Fraction(7, 20)),
        (pool.choose(pool.logic("not", zero), over, x), Fraction(7) if a == 0 else Fraction(7, 20)),
    ):
        value = desk.procedure.value(root, None)
        given = {"x": Fraction(7), "a": Fraction(a)}
        assert [true(c, given) for c in desk.constants.values()]  # each of them has a value
        assert desk.run(value, given) == expected


# ---------------------------------------------------------------------- numbers


@pytest.mark.parametrize(
    ("number", "written"),
    [
        (Fraction(1), ONE),
        (Fraction(0), Const(0.0)),
        (Fraction(-5, 4), Const(-1.25)),
        (Fraction(1, 3), Product((ONE,), (Const(3.0),))),
        (Fraction(-2, 3), Sum(((False, Product((Const(2.0),), (Const(3.0),))),))),
        (Fraction(2**53 + 1, 3), Const(float(Fraction(2**53 + 1, 3)))),  # no double is its top
        (Fraction(1, 2**53 + 1), Const(1 / (2**53 + 1))),
        (Fraction(2**53 - 1, 3), Product((Const(2.0**53 - 1),), (Const(3.0),))),
        (Fraction(2) ** -1000, Const(2.0**-1000)),
    ],
)
def test_a_number_is_written_so_that_it_is_exact_where_it_can_be(
    number: Fraction, written: Expression
) -> None:
    desk = Desk()
    assert desk.procedure.value(desk.pool.num(number), None) == written


def test_positive_terms_are_written_first() -> None:
    desk = Desk()
    pool, x, y = desk.pool, desk["x"], desk["y"]
    value = desk.procedure.value(pool.add((-1, x), (1, pool.mul(x, y)), (-3, y)), None)
    assert isinstance(value, Sum)
    assert [sign for sign, _ in value.terms] == [True, False, False]


def test_the_sign_of_a_sum_is_taken_out_where_all_its_terms_have_it() -> None:
    desk = Desk()
    pool, x, y = desk.pool, desk["x"], desk["y"]
    both, mixed = pool.add((-1, x), (-2, y)), pool.add((-1, x), (2, y))
    assert positive_part(pool, both) == (False, pool.add((1, x), (2, y)))
    assert positive_part(pool, mixed) == (True, mixed)
    assert positive_part(pool, pool.num(-3)) == (False, pool.num(3))
    assert positive_part(pool, pool.zero) == (True, pool.zero)


def _known(name: str) -> Ref:
    return Ref("known", name)
