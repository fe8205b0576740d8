"""Expressions as a hash-consed graph: equal expressions are one object, and nothing is expanded.

A sum keeps its terms with rational coefficients, a product its factors with integer exponents;
sums inside sums stay as they are, so that a chain of n cells costs n nodes and not 3.7**n.
`der` is the time derivative, `int` the integral from an initial value; both are kept as nodes.
The arguments of a node are always older than the node: ascending `id` is a topological order.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from operator import attrgetter
from typing import TYPE_CHECKING, ClassVar, TypeAlias

from bondgraph.ir.functions import FUNCTIONS, SIGNED_SQUARE
from bondgraph.ir.tables import Rows, backwards, is_map, opened
from bondgraph.text.enumeration import Enum
from bondgraph.text.tuples import NamedTuple

Rational: TypeAlias = int | Fraction


class Op(Enum):
    """What a node does with its arguments."""

    NUM = "num"  # data: Fraction
    SYM = "sym"  # data: Symbol
    ADD = "add"  # data: coefficients, one per argument
    MUL = "mul"  # data: integer exponents, one per argument
    FN = "fn"  # data: name, one of FUNCTIONS
    DER = "der"  # time derivative of the argument
    INT = "int"  # integral of the argument; data: Symbol of the initial value
    IF = "if"  # condition, value if true, value if false
    CMP = "cmp"  # data: "<", "<=" or "=="
    LOGIC = "logic"  # data: "and", "or" or "not"
    ROOT = "root"  # data: Root; args: what stands in its places


RATIONAL = frozenset({Op.NUM, Op.SYM, Op.ADD, Op.MUL})  # what rational functions are made of
CONDITIONS = frozenset({Op.CMP, Op.LOGIC})  # true or false


class Kind(Enum):
    """What a symbol stands for."""

    PARAM = "param"  # physics that may fail
    CONST = "const"  # cannot fail
    INPUT = "input"  # known input
    UNKNOWN = "unknown"  # unknown input
    MODE = "mode"  # known boolean input
    SENSOR = "sensor"  # a measured signal: what a sensor says of the quantity that it measures
    READING = "reading"  # the same number as a law or another sensor received it: never wrong
    EFFORT = "effort"  # effort of a port or of a 0-junction
    FLOW = "flow"  # flow of a port or of a 1-junction
    STATE = "state"  # q of a C, p of an I
    INTEGRAL = "integral"  # the value of an `int(...)` written in the model
    INITIAL = "initial"  # a declared initial value
    FREE = "free"  # an initial value that nobody declared
    TEAR = "tear"  # a variable taken as known while a loop is solved


KNOWN_SIGNALS = frozenset({Kind.INPUT, Kind.SENSOR, Kind.READING, Kind.MODE})
ZERO_START = "0"  # the initial value of an integral that starts at zero
CONSTANTS = frozenset({Kind.PARAM, Kind.CONST, Kind.INITIAL, Kind.FREE})
VARIABLES = frozenset({Kind.UNKNOWN, Kind.EFFORT, Kind.FLOW, Kind.STATE, Kind.INTEGRAL, Kind.TEAR})


class Symbol(NamedTuple):
    """A name with its kind; unique by name within a pool."""

    name: str
    kind: Kind


class Root(NamedTuple):
    """The only number at which `zero` vanishes, where no closed form is known.

    `zero` holds the symbols `unknown` and `places`; it grows with the unknown if `rising`, else
    it falls. `name` is what a person calls the unknown, `variable` the variable of the model that
    it stands for, `guess` a number at which `zero` is defined.
    """

    name: str
    zero: Expr
    unknown: Expr
    places: tuple[Expr, ...]
    variable: Expr
    rising: bool
    guess: Fraction


class Expr:
    """A node of the graph; made by a `Pool`, compared by identity."""

    __slots__ = ("args", "data", "id", "op")

    def __init__(self, op: Op, args: tuple[Expr, ...], data: object, id: int) -> None:
        self.op = op
        self.args = args
        self.data = data
        self.id = id

    if TYPE_CHECKING:  # names of `data`, see below

        @property
        def symbol(self) -> Symbol:
            """The symbol of a SYM node, or the initial value of an INT node."""

        @property
        def number(self) -> Fraction:
            """The value of a NUM node."""

        @property
        def coefficients(self) -> tuple[Fraction, ...]:
            """The rational coefficients of an ADD node.

            Whole ones are stored as ints, which add up faster and have the interface of a
            Fraction but for division: write `Fraction(1) / c`.
            """

        @property
        def exponents(self) -> tuple[int, ...]:
            """The integer exponents of a MUL node."""

        @property
        def root(self) -> Root:
            """What a ROOT node solves."""

        @property
        def name(self) -> str:
            """The function of an FN node, the operator of a CMP or LOGIC node."""

    @property
    def terms(self) -> Iterable[tuple[Fraction, Expr]]:
        """The terms of an ADD node: coefficient and argument; any other is its only term."""
        if self.op is Op.ADD:
            return zip(self.coefficients, self.args, strict=True)
        return ((_ONE, self),)

    @property
    def factors(self) -> Iterable[tuple[Expr, int]]:
        """The factors of a MUL node: argument and exponent; any other is its only factor."""
        if self.op is Op.MUL:
            return zip(self.args, self.exponents, strict=True)
        return ((self, 1),)

    @property
    def scaled(self) -> tuple[Fraction, Expr]:
        """The number that a node is multiplied by, and the node without it."""
        if self.op is Op.ADD and len(self.args) == 1:
            return self.coefficients[0], self.args[0]
        return _ONE, self

    @property
    def order(self) -> int:
        """How often a node differentiates its argument: 1 for DER, -1 for INT, 0 for others."""
        return 1 if self.op is Op.DER else -1 if self.op is Op.INT else 0

    @property
    def kind(self) -> Kind | None:
        """What a SYM node stands for; None for any other node."""
        return self.symbol.kind if self.op is Op.SYM else None

    #: How a node is written for a person: `bondgraph.notation.line` says so once it is there.
    written: ClassVar[Callable[[Expr], str]] = lambda node: f"<node {node.id}: {node.op.value}>"

    def __repr__(self) -> str:
        return type(self).written(self)


for _name in ("symbol", "number", "coefficients", "exponents", "root", "name"):
    setattr(Expr, _name, vars(Expr)["data"])


def whole(value: Rational) -> Rational:
    """The same number as an int where it is whole."""
    return value.numerator if value.denominator == 1 else value


def raised(base: Rational, exponent: int) -> Rational:
    """An integer power of a number; of a whole one an int where that is whole.

    >>> raised(-1, -3), raised(2, 3), raised(2, -1)
    (-1, 8, Fraction(1, 2))
    """
    if base.denominator != 1 or (exponent < 0 and abs(base) != 1):
        return Fraction(base) ** exponent
    return int(base.numerator ** abs(exponent))


_ID = attrgetter("id")
_NUM, _ADD, _MUL, _FN = Op.NUM, Op.ADD, Op.MUL, Op.FN  # asked for at every node that is made
_ZERO, _ONE = Fraction(0), Fraction(1)


class Pool:
    """Makes expressions and keeps one of each.

    >>> p = Pool(); x = p.symbol("x", Kind.SENSOR); a = p.symbol("a", Kind.PARAM)
    >>> p.add((1, p.mul(a, x)), (-1, p.mul(x, a))) is p.zero
    True
    """

    def __init__(self) -> None:
        self._table: dict[object, Expr] = {}
        self.zero = self._make(Op.NUM, (), _ZERO)
        self.one = self._make(Op.NUM, (), _ONE)
        #: piecewise linear tables by id, see `bondgraph.ir.tables`
        self.tables: dict[str, Rows] = {}
        #: what each `Root` of the pool solves, by name
        self.roots: dict[str, Expr] = {}

    def __len__(self) -> int:
        return len(self._table)

    def rows(self, name: str) -> tuple[tuple[float, ...], ...]:
        """The rows of a table in floating point; see `opened` for one that is read backwards."""
        rows = tuple([tuple(map(float, row)) for row in self.tables[name]])
        open_ended = backwards(name) and not is_map(rows)
        return opened([(x, z) for x, z in rows]) if open_ended else rows

    def _make(self, op: Op, args: tuple[Expr, ...], data: object) -> Expr:
        made = Expr(op, args, data, len(self._table))
        return self._table.setdefault((op, data, args), made)  # which hashes the numbers once

    def num(self, value: Rational) -> Expr:
        """An exact number."""
        if type(value) is not int and value.denominator == 1:
            value = value.numerator  # equal and of equal hash, which an int has at once
        found = self._table.get((Op.NUM, value, ()))
        return found or self._make(Op.NUM, (), Fraction(value))

    def symbol(self, name: str, kind: Kind) -> Expr:
        """The symbol `name`; only a sensor and its reading share a name."""
        found = self._table.get((Op.SYM, (name, kind), ()))
        return found or self._make(Op.SYM, (), Symbol(name, kind))

    def logged(self, roots: Iterable[Expr]) -> list[Expr]:
        """The roots with each reading as the signal of its sensor: both are one logged number.

        >>> p = Pool(); y, got = p.symbol("y", Kind.SENSOR), p.symbol("y", Kind.READING)
        >>> p.logged([p.add((1, y), (-1, got))])
        [0]
        """
        found = list(roots)
        own = [n for n in topological(found) if n.op is Op.SYM and n.symbol.kind is Kind.READING]
        if not own:
            return found
        return self.substitute(found, {n: self.symbol(n.symbol.name, Kind.SENSOR) for n in own})

    # --------------------------------------------------------- arithmetic

    def add(self, *terms: tuple[Rational, Expr]) -> Expr:
        """The sum of coefficient times node; equal nodes are collected, sums are not flattened."""
        collected: dict[Expr, Rational] = {}
        constant: Rational = 0
        for factor, node in terms:
            if node.op is _ADD and len(node.args) == 1:
                factor = factor * node.coefficients[0]
                node = node.args[0]
            if node.op is _NUM:
                constant += factor * whole(node.number)
            elif node in collected:
                collected[node] += factor
            else:
                collected[node] = factor
        kept = [n for n, c in collected.items() if c]
        if not kept:
            return self.num(constant)
        if len(kept) == 1 and not constant:
            if collected[kept[0]] == 1:
                return kept[0]
        else:
            kept.sort(key=_ID)
            if constant:
                kept.append(self.one)
                collected[self.one] = constant
        found = [collected[n] for n in kept]
        whole_ones = tuple([c if type(c) is int else whole(c) for c in found])
        return self._make(Op.ADD, tuple(kept), whole_ones)

    def scale(self, factor: Rational, node: Expr) -> Expr:
        """A number times a node."""
        return self.add((factor, node))

    def neg(self, node: Expr) -> Expr:
        """Minus the node; of a sum, the sum with all signs changed."""
        if node.op is Op.ADD:
            return self.add(*[(-c, a) for c, a in node.terms])
        return self.add((-1, node))

    def sub(self, left: Expr, right: Expr) -> Expr:
        """The difference of two nodes."""
        return self.add((1, left), (-1, right))

    def dot(self, left: Iterable[Expr], right: Iterable[Expr]) -> Expr:
        """The sum of the products, pair by pair."""
        return self.add(*[(1, self.mul(a, b)) for a, b in zip(left, right, strict=True)])

    def power(self, base: Expr, exponent: int) -> Expr:
        """An integer power; raises ZeroDivisionError for a negative power of the number zero."""
        return self._product([(base, exponent)])

    def mul(self, *factors: Expr) -> Expr:
        """The product; numbers go to the front as a coefficient."""
        return self._product([(f, 1) for f in factors])

    def div(self, left: Expr, right: Expr) -> Expr:
        """The quotient; raises ZeroDivisionError when the divisor is the number zero."""
        return self._product([(left, 1), (right, -1)])

    def _product(self, factors: Iterable[tuple[Expr, int]]) -> Expr:
        coefficient: Rational = 1
        collected: dict[Expr, int] = {}
        for base, exponent in factors:
            if exponent == 0:
                continue
            if base.op is _ADD and len(base.args) == 1:
                coefficient *= raised(base.coefficients[0], exponent)
                base = base.args[0]
            if base.op is _NUM:
                coefficient *= raised(base.number, exponent)
            elif base.op is _MUL:
                for b, e in zip(base.args, base.exponents, strict=True):
                    collected[b] = collected.get(b, 0) + e * exponent
            else:
                collected[base] = collected.get(base, 0) + exponent
        if not coefficient:
            return self.zero
        for base in [b for b in collected if b.op is _FN and b.data == "abs"]:
            # x |x| is one odd monotone function: keep it recognisable, it has an inverse
            inner = base.args[0]
            if collected.get(inner, 0) >= 1 and collected[base] >= 1:
                collected[inner] -= 1
                collected[base] -= 1
                signed = self.fn(SIGNED_SQUARE, inner)
                collected[signed] = collected.get(signed, 0) + 1
        if any(e < 0 for e in collected.values()):
            for total in [b for b, e in collected.items() if e == 1 and b.op is _ADD]:
                coefficient *= self._cancel(total, collected)
        kept = [n for n, e in collected.items() if e]
        if not kept:
            return self.num(coefficient)
        if len(kept) == 1 and collected[kept[0]] == 1:
            node = kept[0]
        else:
            kept.sort(key=_ID)
            node = self._make(Op.MUL, tuple(kept), tuple([collected[n] for n in kept]))
        return node if coefficient == 1 else self.add((coefficient, node))

    def _cancel(self, total: Expr, collected: dict[Expr, int]) -> Rational:
        """Take out of a sum what stands in each of its terms and below it; a number is left.

        (x a + x b)/x is a + b: where x is zero a machine goes on, and the quotient did not.
        """
        common: dict[Expr, int] | None = None
        for term in total.args:
            own = {b: min(e, -collected.get(b, 0)) for b, e in term.factors}
            common = {b: min(e, own.get(b, 0)) for b, e in (common or own).items()}
            common = {b: e for b, e in common.items() if e > 0}
            if not common:
                return 1
        assert common is not None
        for base, exponent in common.items():
            collected[base] += exponent
        less = [(b, -e) for b, e in common.items()]
        left = self.add(*[(c, self._product([*t.factors, *less])) for c, t in total.terms])
        collected[total] -= 1
        factor, node = left.scaled
        if node.op is _NUM:
            return factor * whole(node.number)
        for base, exponent in node.factors:
            collected[base] = collected.get(base, 0) + exponent
        return factor

    # ---------------------------------------------------------- functions

    def fn(self, name: str, *args: Expr) -> Expr:
        """A function of `FUNCTIONS`, or `table:<id>`; of what it undoes it leaves the argument."""
        inner = args[0]
        if inner.op is Op.FN and inner.name in FUNCTIONS and FUNCTIONS[inner.name].inverse == name:
            return inner.args[0]
        if len(args) == 1 and args[0] is self.zero and name in FUNCTIONS:
            value = FUNCTIONS[name].zero  # where some have no slope to differentiate
            if value is not None:
                return self.num(value)
        if name == "pow" and args[1].op is Op.NUM and args[1].number.denominator == 1:
            return self.power(args[0], int(args[1].number))
        if name == "pow" and args[1].op is Op.NUM and args[1].number == Fraction(1, 2):
            name, args = "sqrt", args[:1]
        return self._make(Op.FN, args, name)

    def der(self, node: Expr, order: int = 1) -> Expr:
        """The time derivative, kept as a node unless it is plainly zero or undoes an integral."""
        for _ in range(order):
            node = self._derivative(node)
        return node

    def _derivative(self, node: Expr) -> Expr:
        if node.op is Op.NUM or node.kind in (Kind.CONST, Kind.INITIAL, Kind.FREE):
            return self.zero
        if node.op is Op.INT:
            return node.args[0]
        factor, inner = node.scaled
        if inner is not node:
            return self.add((factor, self.der(inner)))
        return self._make(Op.DER, (node,), None)

    def integral(self, node: Expr, initial: Expr) -> Expr:
        """The integral of `node` from the start, plus the symbol of its initial value.

        The integral of nothing stays where it starts: it is the initial value, if one is declared.
        """
        if node is self.zero and initial.symbol.kind is Kind.INITIAL:
            return self.zero if initial.symbol.name == ZERO_START else initial
        return self._make(Op.INT, (node,), initial.symbol)

    def root(self, root: Root, *args: Expr) -> Expr:
        """The number that `root` is, with `args` in its places."""
        return self._make(Op.ROOT, args, root)

    def choose(self, condition: Expr, yes: Expr, no: Expr) -> Expr:
        """`if(condition, yes, no)`."""
        return yes if yes is no else self._make(Op.IF, (condition, yes, no), None)

    def compare(self, op: str, left: Expr, right: Expr) -> Expr:
        """A comparison; op is one of < <= > >= == !=."""
        if op in (">", ">="):
            return self.compare("<" + op[1:], right, left)
        if op == "!=":
            return self.logic("not", self.compare("==", left, right))
        return self._make(Op.CMP, (left, right), op)

    def logic(self, op: str, *args: Expr) -> Expr:
        """`and`, `or`, `not` of conditions."""
        return self._make(Op.LOGIC, args, op)

    def rebuild(self, node: Expr, args: tuple[Expr, ...]) -> Expr:
        """The node with other arguments, simplified as if it were made anew."""
        if args == node.args:
            return node
        match node.op:
            case Op.ADD:
                return self.add(*zip(node.coefficients, args, strict=True))
            case Op.MUL:
                return self._product(zip(args, node.exponents, strict=True))
            case Op.FN:
                return self.fn(node.name, *args)
            case Op.DER:
                return self.der(args[0])
            case Op.IF:
                return self.choose(*args)
            case Op.CMP:
                return self.compare(node.name, *args)
            case Op.LOGIC:
                return self.logic(node.name, *args)
            case Op.INT:
                return self.integral(args[0], self.symbol(node.symbol.name, node.symbol.kind))
            case Op.ROOT:
                return self._make(node.op, args, node.data)
            case _:
                return node

    def substitute(self, roots: Iterable[Expr], mapping: Mapping[Expr, Expr]) -> list[Expr]:
        """The roots with every occurrence of a key replaced by its value (once, not repeatedly)."""
        roots = list(roots)
        if not mapping:
            return roots
        try:
            return [self._shallow(r, mapping, _SHALLOW) for r in roots]
        except _DeepError:
            pass
        new: dict[Expr, Expr] = {}
        for node in topological(roots, stop=mapping.__contains__):
            known = mapping.get(node)
            new[node] = (
                known if known is not None else self.rebuild(node, tuple(new[a] for a in node.args))
            )
        return [new[r] for r in roots]

    def _shallow(self, node: Expr, mapping: Mapping[Expr, Expr], depth: int) -> Expr:
        """`substitute` for an expression of a few levels, as most laws and balances are."""
        known = mapping.get(node)
        if known is not None:
            return known
        if not node.args:
            return node
        if not depth:
            raise _DeepError
        args = tuple([self._shallow(a, mapping, depth - 1) for a in node.args])
        return self.rebuild(node, args)


class _DeepError(Exception):
    """An expression has more levels than `_shallow` goes down."""


_SHALLOW = 3


def topological(roots: Iterable[Expr], stop: Callable[[Expr], bool] | None = None) -> list[Expr]:
    """All nodes that the roots are made of, arguments first; below a `stop` node it ends."""
    found = below(roots, stop)
    found.sort(key=_ID)
    return found


def below(roots: Iterable[Expr], stop: Callable[[Expr], bool] | None = None) -> list[Expr]:
    """The roots and all that they are made of, in no order; below a `stop` node it ends."""
    seen = set(roots)
    found = list(seen)
    for node in found:  # it grows as we go
        if node.args and (stop is None or not stop(node)):
            for arg in node.args:
                if arg not in seen:
                    seen.add(arg)
                    found.append(arg)
    return found


def symbols(*roots: Expr) -> list[Expr]:
    """The SYM nodes that occur, oldest first."""
    return sorted([n for n in below(roots) if n.op is Op.SYM], key=_ID)


def variables(*roots: Expr) -> list[Expr]:
    """The unknown variables that occur, oldest first."""
    return [n for n in symbols(*roots) if n.symbol.kind in VARIABLES]
