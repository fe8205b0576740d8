"""Expressions of the graph as statements: what is used twice gets a name, the rest is written out.

Constant parts can be taken out of a procedure (`hoist`): they then become coefficients that
configure computes, and a step never divides by a parameter.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction

from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from bondgraph.ir.program import (
    Assign,
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
from bondgraph.passes.lowering.program_names import Names, brief
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

_DEEPEST = 6  # brackets inside brackets, before a part gets a name

ONE = Const(1.0)
ZERO = Const(0.0)


class _Piece(NamedTuple):
    """A node as terms: (number, constant or None, factors with exponents); one term if no sum."""

    terms: tuple[tuple[Fraction, Expr | None, tuple[tuple[Expr, int], ...]], ...]
    total: bool


class Procedure:
    """Writes expressions as statements.

    `leaf` gives the values that are there already (None: look inside); `hoist` takes a constant
    expression and gives the coefficient that holds it; without it constants are computed here.
    """

    def __init__(
        self,
        pool: Pool,
        leaf: Callable[[Expr], Expression | None],
        append: Callable[[Assign], None],
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

    def values(
        self, roots: Iterable[Expr], origin: Span | Mapping[Expr, Span | None] | None
    ) -> list[Expression]:
        """The values of the roots, after the statements that they need were appended.

        `origin` is the place that the statements come from, or the place of each node.
        """
        roots = list(roots)
        outer = self._made, self._users  # a leaf may need values of its own
        self._made, self._users = dict(self._made), {}
        for node in topological(roots):
            for arg in node.args:
                self._users[arg] = self._users.get(arg, 0) + 1
        uses, pieces = self._uses(roots)
        depth: dict[Expr, int] = {}
        for node in sorted(uses, key=lambda n: n.id):
            if node in self._made:
                continue
            value = self._leaf(node)
            if value is None:
                value = self._value(node, pieces.get(node))
                depth[node] = 1 + max((depth.get(a, 0) for a in node.args), default=0)
                if uses[node] > 1 or depth[node] > _DEEPEST:
                    if not isinstance(value, Ref | Const):
                        target = Ref("local", self.names.new(self.prefix))
                        place = origin.get(node) if isinstance(origin, Mapping) else origin
                        self.append(Assign(target, value, brief(node), place))
                        value = target
                    depth[node] = 0
            self._made[node] = value
        found = [self._made[r] for r in roots]
        # what was written out in one place has no name to be called by in another
        named = {n: v for n, v in self._made.items() if isinstance(v, Ref | Const)}
        self._made, self._users = {**outer[0], **named}, outer[1]
        return found

    def value(self, root: Expr, origin: Span | None) -> Expression:
        """The value of one expression."""
        return self.values([root], origin)[0]

    # ------------------------------------------------------------ analysis

    def _leaf(self, node: Expr) -> Expression | None:
        if node.op is Op.NUM:
            return _number(node.number)
        if self.hoist is not None and self.constant(node):
            return self.hoist(node)
        return self.leaf(node)

    def _uses(self, roots: list[Expr]) -> tuple[dict[Expr, int], dict[Expr, _Piece]]:
        uses: dict[Expr, int] = {}
        pieces: dict[Expr, _Piece] = {}
        stack = list(roots)
        while stack:
            node = stack.pop()
            uses[node] = uses.get(node, 0) + 1
            if uses[node] > 1 or node in self._made or self._leaf(node) is not None:
                continue
            if node.op in (Op.ADD, Op.MUL):
                piece = pieces[node] = self._piece(node)
                stack += [
                    a for _, _, fs in piece.terms for a, e in fs for _ in range(min(abs(e), 2))
                ]
            elif node.op in (Op.CMP, Op.LOGIC, Op.IF, Op.FN, Op.ROOT):
                stack += _operands(node)
            else:
                raise ValueError(f"no value for {show(node)}")
        return uses, pieces

    def _piece(self, node: Expr) -> _Piece:
        if node.op is Op.MUL:
            fixed, factors = self._split(node)
            return _Piece(((Fraction(1), fixed, factors),), False)
        terms = []
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
        return _Piece(tuple(terms), True)

    def _split(self, node: Expr) -> tuple[Expr | None, tuple[tuple[Expr, int], ...]]:
        pairs = list(node.factors)
        if self.hoist is None:
            return None, tuple(pairs)
        fixed = [self.pool.power(a, e) for a, e in pairs if self.constant(a)]
        moving = tuple((a, e) for a, e in pairs if not self.constant(a))
        return (self.pool.mul(*fixed) if fixed else None), moving

    # ------------------------------------------------------------ values

    def _value(self, node: Expr, piece: _Piece | None) -> Expression:
        if piece is not None:
            return self._sum(piece)
        if node.op is Op.FN:
            return Function(node.name, tuple(self._made[a] for a in node.args))
        if node.op is Op.ROOT:
            return Function(f"root:{node.root.name}", tuple(self._made[a] for a in node.args))
        if node.op is Op.IF:
            yes, no = (self._made[a] for a in node.args[1:])
            return Choice(self._condition(node.args[0]), yes, no)
        if node.op in (Op.CMP, Op.LOGIC):  # a truth value used as a number
            return Choice(self._condition(node), ONE, ZERO)
        raise ValueError(f"no value for {show(node)}")

    def _condition(self, node: Expr) -> Condition:
        if node.op is Op.CMP:
            left, right = (self._made[a] for a in node.args)
            return Compare(node.name, left, right)
        if node.op is Op.LOGIC:
            return Logic(node.name, tuple(self._condition(a) for a in node.args))
        if node.kind is Kind.MODE:
            value = self._made[node]
            assert isinstance(value, Choice)
            return value.condition
        return Logic("not", (Compare("==", self._made[node], ZERO),))

    def _sum(self, piece: _Piece) -> Expression:
        terms = [self._term(*t) for t in piece.terms]
        if len(terms) == 1 and (terms[0][0] or not piece.total):
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
            above.append(self.hoist(fixed))
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


def _operands(node: Expr) -> list[Expr]:
    """The values that a node needs, looking through conditions."""
    if node.op is Op.IF:
        return [*_inside(node.args[0]), *node.args[1:]]
    return _inside(node) if node.op in (Op.CMP, Op.LOGIC) else list(node.args)


def _inside(condition: Expr) -> list[Expr]:
    if condition.op is Op.LOGIC:
        return [v for a in condition.args for v in _inside(a)]
    return list(condition.args) if condition.op is Op.CMP else [condition]


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
