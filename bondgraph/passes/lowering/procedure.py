"""Expressions of the graph as statements: what is used twice gets a name, the rest is written out.

What is needed whatever a condition says is computed before it, anything else on its own side only:
on the other one it need not have a value.

Constant parts can be taken out of a procedure (`hoist`): they then become coefficients that
configure computes, and a step never divides by a parameter.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from functools import partial
from typing import TypeVar

from bondgraph.ir.expr import CONDITIONS, RATIONAL, Expr, Kind, Op, Pool, topological
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
from bondgraph.notation.line import show
from bondgraph.passes.lowering.program_names import Names, brief, spoken
from bondgraph.text.source import Span

_DEEPEST = 6  # brackets inside brackets, before a part gets a name
_BRANCHES = 50  # branches inside of one; beyond, both sides are computed before: text has to end

ONE = Const(1.0)
ZERO = Const(0.0)

_T = TypeVar("_T")
_Under = tuple[tuple[Expr, bool], ...]
#: A sum or product as terms: (number, constant or None, factors with exponents).
_Terms = list[tuple[Fraction, Expr | None, tuple[tuple[Expr, int], ...]]]


class Procedure:
    """Writes expressions as statements.

    `leaf` gives the values that are there already (None: look inside); `hoist` takes a constant
    expression and gives the coefficient that holds it; without it constants are computed here.
    """

    def __init__(
        self,
        pool: Pool,
        leaf: Callable[[Expr], Expression | None],
        append: Callable[[Assignment], None],
        names: Names,
        prefix: str,
        hoist: Callable[[Expr], Expression] | None = None,
        constant: Callable[[Expr], bool] = lambda _: False,
    ) -> None:
        self.pool = pool
        self.leaf = leaf
        self.append = append
        self.names = names
        self.prefix = prefix
        self.hoist = hoist
        self.constant = constant
        self._made: dict[Expr, Expression] = {}
        self._users: dict[Expr, int] = {}
        self._needs: dict[Expr, list[Expr]] = {}  # of each node, whatever conditions say
        self._depth: dict[Expr, int] = {}
        self._under: _Under = ()  # constant conditions that hold, or not, where values are used
        self._origin: Span | Mapping[Expr, Span | None] | None = None

    def values(
        self, roots: Iterable[Expr], origin: Span | Mapping[Expr, Span | None] | None
    ) -> list[Expression]:
        """The values of the roots, after the statements that they need were appended.

        `origin` is the place that the statements come from, or the place of each node.
        """
        roots = list(roots)
        # a leaf may need values of its own
        outer = self._made, self._users, self._needs, self._depth, self._under, self._origin
        self._made, self._users, self._depth = dict(self._made), {}, {}
        self._under, self._origin = (), origin
        for node in topological(roots):
            for arg in node.args:
                self._users[arg] = self._users.get(arg, 0) + 1
        *_, self._needs = self._uses(roots)  # all leaves write here what they are made of
        self._defer()
        self._write(roots)
        found = [self._made[r] for r in roots]
        # what was written out in one place has no name to be called by in another
        named = {n: v for n, v in self._made.items() if isinstance(v, Ref | Const)}
        self._made, self._users, self._needs, self._depth, self._under, self._origin = outer
        self._made = {**self._made, **named}
        return found

    def value(self, root: Expr, origin: Span | None) -> Expression:
        """The value of one expression."""
        return self.values([root], origin)[0]

    def _write(self, roots: list[Expr]) -> None:
        """Make the values of the roots, after the statements that they need in any case."""
        uses, written, operands = self._uses(roots)
        needed = self._needed(roots)
        for node in sorted(uses, key=lambda n: n.id):
            if node in self._made or node not in needed:
                continue
            value = self._leaf(node)
            if value is None:
                value = self._value(node, written.get(node))
                # a product that a sum writes out has no depth of its own, what it holds has one
                depth = 1 + max((self._depth.get(a, 0) for a in operands[node]), default=0)
                if uses[node] > 1 or depth > _DEEPEST:
                    if not isinstance(value, Ref | Const):
                        value = self._named(node, value)
                    depth = 0
                self._depth[node] = depth
            self._made[node] = value

    def _named(
        self,
        node: Expr,
        value: Expression,
        yes: tuple[Assignment, ...] = (),
        no: tuple[Assignment, ...] = (),
    ) -> Ref:
        """A value as a statement; `yes` and `no` are what the sides of a choice need."""
        target = Ref("local", self.names.new(f"{self.prefix}{spoken(node)}"))
        place = self._origin.get(node) if isinstance(self._origin, Mapping) else self._origin
        if isinstance(value, Choice) and (yes or no):
            self.append(Branch(target, value, yes, no, brief(node), place))
        else:
            self.append(Assign(target, value, brief(node), place))
        return target

    def _side(
        self, roots: list[Expr], finish: Callable[[], _T], under: _Under
    ) -> tuple[tuple[Assignment, ...], _T]:
        """What is made of the roots where they are needed, and the statements for that."""
        statements: list[Assignment] = []
        outer, size = (self.append, self._under), len(self._made)
        self.append, self._under = statements.append, self._also(under)
        self._write(roots)
        found = finish()
        while len(self._made) > size:
            self._made.popitem()
        self.append, self._under = outer
        return tuple(statements), found

    def named(self, node: Expr) -> Expression | None:
        """The name that a value has since an earlier call."""
        return self._made.get(node)

    # ------------------------------------------------------------ analysis

    def _also(self, under: _Under) -> _Under:
        """The constant conditions here, with those of a side."""
        return (*self._under, *((c, holds) for c, holds in under if self.constant(c)))

    def _leaf(self, node: Expr) -> Expression | None:
        if node.op is Op.NUM:
            return _number(node.number)
        if self.hoist is not None and self.constant(node):
            return self._hoisted(node)
        return self.leaf(node)

    def _hoisted(self, value: Expr) -> Expression:
        """The coefficient of a constant; where it may have no value, only if it is needed."""
        assert self.hoist is not None
        if not _polynomial(value):
            pool = self.pool
            for condition, holds in self._under:
                sides = (value, pool.zero) if holds else (pool.zero, value)
                value = pool.choose(condition, *sides)
        return self.hoist(value)

    def _uses(
        self, roots: list[Expr]
    ) -> tuple[dict[Expr, int], dict[Expr, _Terms], dict[Expr, list[Expr]]]:
        """How often each node is used, sums and products as they are written, all operands."""
        uses: dict[Expr, int] = {}
        written: dict[Expr, _Terms] = {}
        operands: dict[Expr, list[Expr]] = {}
        here = self._under
        stack = [(root, here) for root in roots]
        while stack:
            node, self._under = stack.pop()
            uses[node] = uses.get(node, 0) + 1
            if uses[node] > 1 or node in self._made or self._leaf(node) is not None:
                continue
            if node.op in (Op.ADD, Op.MUL):
                written[node] = self._terms(node)
                own = [
                    (a, self._under)
                    for _, _, fs in written[node] for a, e in fs for _ in range(min(abs(e), 2))
                ]  # fmt: skip
            elif node.op in RATIONAL or node.order:
                raise ValueError(f"no value for {show(node)}")
            else:
                own = [(a, self._also(under)) for a, under in _operands(node)]
            operands[node] = [a for a, _ in own]
            stack += own
        self._under = here
        return uses, written, operands

    def _defer(self) -> None:
        """Leave to each node only what it needs whatever conditions say."""
        branches: dict[Expr, int] = {}
        for node in sorted(self._needs, key=lambda n: n.id):
            if node.op not in (Op.IF, Op.LOGIC):
                continue
            operands = _operands(node)
            apart = [self._needed([a]) for a, under in operands if under]
            both = apart[-2] & apart[-1] if node.op is Op.IF else set()
            inside = set[Expr]().union(*apart) - both
            count = 1 + sum(branches.get(n, 0) for n in inside)
            if count <= _BRANCHES:
                branches[node] = count
                self._needs[node] = [*(a for a, under in operands if not under), *both]

    def _needed(self, roots: list[Expr]) -> set[Expr]:
        """All that the roots need whatever conditions say."""
        found: set[Expr] = set()
        stack = list(roots)
        while stack:
            node = stack.pop()
            if node not in found:
                found.add(node)
                stack += self._needs.get(node, ())
        return found

    def _terms(self, node: Expr) -> _Terms:
        if node.op is Op.MUL:
            fixed, factors = self._split(node)
            return [(Fraction(1), fixed, factors)]
        terms: _Terms = []
        still: list[tuple[Fraction, Expr]] = []
        for c, arg in node.terms:
            if self.hoist is not None and self.constant(arg):
                still.append((c, arg))
            else:
                fixed, factors = None, ((arg, 1),)
                if arg.op is Op.MUL and arg not in self._made:
                    own = self._split(arg)
                    if self._users[arg] == 1 or (own[0] is not None and len(own[1]) == 1):
                        fixed, factors = own
                terms.append((c, fixed, factors))
        if still:
            terms.append((Fraction(1), self.pool.add(*still), ()))
        return terms

    def _split(self, node: Expr) -> tuple[Expr | None, tuple[tuple[Expr, int], ...]]:
        pairs = list(node.factors)
        if self.hoist is None:
            return None, tuple(pairs)
        fixed = [self.pool.power(a, e) for a, e in pairs if self.constant(a)]
        moving = tuple((a, e) for a, e in pairs if not self.constant(a))
        return (self.pool.mul(*fixed) if fixed else None), moving

    # ------------------------------------------------------------ values

    def _value(self, node: Expr, written: _Terms | None) -> Expression:
        if written is not None:
            return self._sum(written)
        if node.op is Op.FN:
            return Function(node.name, tuple(self._made[a] for a in node.args))
        if node.op is Op.ROOT:
            return Function(f"root:{node.root.name}", tuple(self._made[a] for a in node.args))
        if node.op is Op.IF:
            return self._choice(node, *node.args)
        if node.op in CONDITIONS:  # a truth value used as a number
            return Choice(self._condition(node), ONE, ZERO)
        raise ValueError(f"no value for {show(node)}")

    def _choice(self, node: Expr, condition: Expr, yes: Expr, no: Expr) -> Expression:
        holds = self._condition(condition)
        before, x = self._side([yes], lambda: self._made[yes], ((condition, True),))
        else_before, y = self._side([no], lambda: self._made[no], ((condition, False),))
        value = Choice(holds, x, y)
        return self._named(node, value, before, else_before) if before or else_before else value

    def _condition(self, node: Expr) -> Condition:
        if node.op is Op.CMP:
            left, right = (self._made[a] for a in node.args)
            return Compare(node.name, left, right)
        if node.op is Op.LOGIC:
            return self._logic(node)
        if node.kind is Kind.MODE:
            value = self._made[node]
            assert isinstance(value, Choice)
            return value.condition
        return Logic("not", (Compare("==", self._made[node], ZERO),))

    def _logic(self, node: Expr) -> Condition:
        """A condition of which a part may need statements where it is looked at."""
        first, *rest = node.args
        found: list[Condition] = [self._condition(first)]
        under: _Under = ((first, node.name == "and"),)
        for arg in rest:
            always = [v for v, later in _looks(arg) if not later]
            before, last = self._side(always, partial(self._condition, arg), under)
            under = (*under, (arg, node.name == "and"))
            found.append(last)
            if before:
                so_far = found[0] if len(found) == 2 else Logic(node.name, tuple(found[:-1]))
                truth = Choice(last, ONE, ZERO)
                if node.name == "and":
                    value = self._named(node, Choice(so_far, truth, ZERO), yes=before)
                else:
                    value = self._named(node, Choice(so_far, ONE, truth), no=before)
                found = [Logic("not", (Compare("==", value, ZERO),))]
        return found[0] if rest and len(found) == 1 else Logic(node.name, tuple(found))

    def _sum(self, written: _Terms) -> Expression:
        terms = [self._term(*t) for t in written]
        if len(terms) == 1 and terms[0][0]:
            return terms[0][1]
        terms.sort(key=lambda t: not t[0])  # a person writes the positive terms first
        return Sum(tuple(terms))

    def _term(
        self, c: Fraction, fixed: Expr | None, factors: tuple[tuple[Expr, int], ...]
    ) -> tuple[bool, Expression]:
        positive = c > 0
        above: list[Expression] = []
        below: list[Expression] = []
        if fixed is not None and self.hoist is not None:
            sign, fixed = positive_part(self.pool, self.pool.scale(abs(c), fixed))
            positive ^= not sign
            above.append(self._hoisted(fixed))
        else:
            _times(abs(c), above, below)
        for node, exponent in factors:
            (above if exponent > 0 else below).extend([self._made[node]] * abs(exponent))
        above = [a for a in above if a != ONE]
        if not below and len(above) == 1:
            return positive, above[0]
        return positive, Product(tuple(above) or (ONE,), tuple(below)) if above or below else ONE


def positive_part(pool: Pool, node: Expr) -> tuple[bool, Expr]:
    """A sign and the expression without it, where all terms of a sum are negative."""
    if node.op is Op.NUM:
        return node.number >= 0, pool.num(abs(node.number))
    if node.op is Op.ADD and all(c < 0 for c in node.coefficients):
        return False, pool.neg(node)
    return True, node


def _operands(node: Expr) -> list[tuple[Expr, _Under]]:
    """The values that a node needs, looking through conditions, each with when it needs them."""
    if node.op is Op.IF:
        condition, yes, no = node.args
        return [*_looks(condition), (yes, ((condition, True),)), (no, ((condition, False),))]
    return _looks(node) if node.op in CONDITIONS else [(a, ()) for a in node.args]


def _looks(condition: Expr, under: _Under = ()) -> list[tuple[Expr, _Under]]:
    """What a condition looks at; `and` and `or` go on only where that decides."""
    if condition.op is not Op.LOGIC:
        values = condition.args if condition.op is Op.CMP else [condition]
        return [(v, under) for v in values]
    found: list[tuple[Expr, _Under]] = []
    for arg in condition.args:
        found += _looks(arg, under)
        under = (*under, (arg, condition.name == "and"))
    return found


def _polynomial(value: Expr) -> bool:
    """Whether a value is made by sums and products alone, and so is there for all numbers."""
    return all(
        n.op in RATIONAL and all(exponent > 0 for _, exponent in n.factors)
        for n in topological([value])
    )


def _number(value: Fraction) -> Expression:
    above: list[Expression] = []
    below: list[Expression] = []
    _times(abs(value), above, below)
    if not below and len(above) <= 1:
        size = above[0] if above else ONE
        assert isinstance(size, Const)
        return Const(-size.value if value < 0 else size.value)
    size_ = Product(tuple(above) or (ONE,), tuple(below))
    return Sum(((False, size_),)) if value < 0 else size_


def _times(size: Fraction, above: list[Expression], below: list[Expression]) -> None:
    """A positive number as factor or, where a factor would not be exact, factor and divisor."""
    if size == 1:
        return
    try:
        near = float(size)
    except OverflowError:
        near = float("inf")
    if not size:
        above.append(ZERO)
        return
    top, bottom = size.numerator, size.denominator
    exact = Fraction(near) == size if near not in (0.0, float("inf")) else False
    if exact or top >= 2**53 or bottom >= 2**53:
        above.append(Const(near))
        return
    if top != 1:
        above.append(Const(float(top)))
    below.append(Const(float(bottom)))
