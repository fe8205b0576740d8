"""The values of expressions at a point: a sample of all signals, with what time does to them.

Evaluation is linear in nodes times orders: one pass from the roots says how many coefficients
each node has to deliver, one pass from the leaves delivers them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Protocol

from bondgraph.exact.implicit_roots import root_value
from bondgraph.exact.outline import demands, integral_depth, plan, static
from bondgraph.exact.signal_algebra import Algebra, Mixed, Taylor, Values, compare
from bondgraph.field.numbers import Number, Numbers, Undefined
from bondgraph.field.series import Series
from bondgraph.ir.expr import Expr, Op, Rational, Root, Symbol, topological


class Assignment(Protocol):
    """What every symbol is at a point, in one of the algebras."""

    @property
    def algebra(self) -> Values[Any]:
        """The algebra that the values belong to."""
        ...

    def value(self, symbol: Expr) -> Any:
        """The value of a SYM node; raises KeyError for one that the sample does not know."""
        ...

    def start(self, initial: Symbol) -> Number:
        """The value with which integrals from this initial value begin."""
        ...


class Sample(Assignment, Protocol):
    """A point with a past, at which expressions can be differentiated."""

    @property
    def algebra(self) -> Algebra[Any, Any]:
        """The algebra that the values belong to."""
        ...

    def earlier(self, steps: int) -> Sample:
        """The same plant with the same constants at an earlier time, all signals different."""
        ...


def terms_needed(roots: Sequence[Expr]) -> int:
    """How many coefficients of the roots say whether they vanish on a plant, faulty or not."""
    return integral_depth(roots) + 1


def evaluate(roots: Sequence[Expr], sample: Assignment, n: int = 1) -> list[Any]:
    """The values of the roots, `n` Taylor coefficients each (one number for exponentials).

    Raises `Undefined` if a value that a root rests on does not exist at this point, `Mixed` if
    an operation leads out of the sample's algebra.
    """
    if n == 1 and isinstance(sample.algebra, Taylor):
        numbers = static_values(tuple(roots), sample)
        if numbers is not None:
            return [[numbers[root]] for root in roots]
    nodes: Sequence[Expr]
    if len(roots) == 1:
        nodes, need = plan(roots[0], n)
    else:
        nodes = topological(roots)
        need = demands(nodes, roots, n)
    values, failures = values_of(nodes, need, sample)
    for root in roots:
        if root in failures:
            raise failures[root]
    return [values[root] for root in roots]


def static_values(roots: tuple[Expr, ...], sample: Assignment) -> dict[Expr, Number] | None:
    """Sums and products at the point itself; None for others, and where a value is missing."""
    nodes = static(roots)
    if nodes is None:
        return None
    numbers, values = sample.algebra.numbers, dict[Expr, Number]()
    powers = Powers(numbers, values)
    try:
        for node in nodes:
            total: Number
            if node.op is Op.ADD:
                total = 0
                for c, a in zip(node.coefficients, node.args, strict=True):
                    total += weighed(numbers, c) * values[a]
            elif node.op is Op.MUL:
                total = 1
                for a, e in zip(node.args, node.exponents, strict=True):
                    total *= values[a] if e == 1 else powers.of(a, e)
            elif node.op is Op.SYM:
                total = sample.value(node)[0]
            else:
                total = numbers.fraction(node.number)
            values[node] = total
    except Undefined:
        return None
    return values


def weighed(numbers: Numbers, coefficient: Rational) -> Number:
    """A rational number as one of these; a whole one stays an int, which multiplies faster."""
    return coefficient if isinstance(coefficient, int) else numbers.fraction(coefficient)


class Powers:
    """Integer powers of values; a pivot is divided by again and again, and inverted once."""

    def __init__(self, numbers: Numbers, values: Mapping[Expr, Number]) -> None:
        self.numbers, self.values = numbers, values
        self.inverses: dict[Expr, Number] = {}

    def of(self, node: Expr, exponent: int) -> Number:
        """The value of a node to a power; raises `Undefined` for a negative one of zero."""
        if exponent > 0:
            base = self.values[node]
        elif node in self.inverses:
            base = self.inverses[node]
        else:
            base = self.inverses[node] = self.numbers.inverse(self.values[node])
        return base if exponent in (1, -1) else base ** abs(exponent)


def values_of(
    nodes: Sequence[Expr], need: dict[Expr, int], sample: Assignment
) -> tuple[dict[Expr, Any], dict[Expr, Exception]]:
    """The values of the nodes (arguments first), and why others have none.

    A branch that is not taken may lack a value; what is built on a missing one is missing.
    """
    values: dict[Expr, Any] = {}
    failures: dict[Expr, Exception] = {}
    _add_values(values, failures, nodes, need, sample)
    return values, failures


def _add_values(
    values: dict[Expr, Any],
    failures: dict[Expr, Exception],
    nodes: Iterable[Expr],
    need: dict[Expr, int],
    sample: Assignment,
) -> None:
    algebra = sample.algebra
    for node in nodes:
        try:
            if failures:
                _check(node, values, failures, algebra)
            values[node] = node_value(node, values, sample, algebra, need[node])
        except (Undefined, Mixed) as failure:
            failures[node] = failure


def values_where(
    expr: Expr, known: Mapping[Expr, Any], algebra: Values[Any], n: int
) -> dict[Expr, Any]:
    """The values of an expression and of all nodes below it where its symbols have known ones.

    Raises the failure of the expression, `Mixed` for one with an integral.
    """
    values, failures = values_of(*plan(expr, n), _Known(algebra, known))
    if expr in failures:
        raise failures[expr]
    return values


class _Known:
    """A point at which symbols have known values."""

    def __init__(self, algebra: Values[Any], values: Mapping[Expr, Any]) -> None:
        self.algebra = algebra
        self._values = values

    def value(self, symbol: Expr) -> Any:
        return self._values[symbol]

    def start(self, initial: Symbol) -> Number:
        raise Mixed("an integral inside a root")


def values_of_equation(
    root: Root, args: Sequence[Any], unknown: Any, algebra: Values[Any], n: int
) -> dict[Expr, Any]:
    """The values of a root's equation, and of what it is made of, for any value of its unknown."""
    known = {**dict(zip(root.places, args, strict=True)), root.unknown: unknown}
    return values_where(root.zero, known, algebra, n)


class Incremental:
    """A relation at a point, evaluated again and again with little that is different.

    What does not rest on what has changed is computed once.
    """

    def __init__(self, root: Expr, sample: Assignment, n: int) -> None:
        self._root = root
        self._nodes, self._need = plan(root, n)
        self._values, self._failures = values_of(self._nodes, self._need, sample)
        self._users: dict[Expr, list[Expr]] = {}
        for node in self._nodes:
            for a in node.args:
                self._users.setdefault(a, []).append(node)

    def anew(self, changed: Iterable[Expr], sample: Assignment) -> Any:
        """The value of the root at a point that differs in these nodes; raises as `evaluate`."""
        above = set(changed)
        stack = list(above)
        while stack:
            for user in self._users.get(stack.pop(), ()):
                if user not in above:
                    above.add(user)
                    stack.append(user)
        values, failures = dict(self._values), dict(self._failures)
        for node in above:
            values.pop(node, None)
            failures.pop(node, None)
        ordered = sorted(above.intersection(self._need), key=lambda node: node.id)
        _add_values(values, failures, ordered, self._need, sample)
        if self._root in failures:
            raise failures[self._root]
        return values[self._root]


def _check(
    node: Expr, values: dict[Expr, Any], failures: dict[Expr, Exception], algebra: Any
) -> None:
    """Raise the failure of an argument that the node needs."""
    needed: tuple[Expr, ...] = node.args
    if node.op is Op.IF:
        needed = node.args[:1]
        if needed[0] not in failures:
            needed = (chosen(node, values, algebra),)
    for a in needed:
        if a in failures:
            raise failures[a]


def node_value(
    node: Expr, values: dict[Expr, Any], sample: Assignment, algebra: Values[Any], n: int
) -> Any:
    """The value of one node from those of its arguments."""
    op = node.op
    if op is Op.ADD:
        numbers = algebra.numbers
        return algebra.combine([(weighed(numbers, c), values[a]) for c, a in node.terms], n)
    if op is Op.MUL:
        return algebra.product([(values[a], e) for a, e in node.factors], n)
    if op is Op.SYM:
        return sample.value(node)
    if op is Op.NUM:
        return algebra.number(algebra.numbers.fraction(node.number))
    if op is Op.DER:
        return algebra.der(values[node.args[0]])
    if op is Op.INT:
        return algebra.integral(values[node.args[0]], sample.start(node.symbol))
    if op is Op.FN:
        if node.name == "pow" and node.args[1].op is Op.NUM:
            return algebra.rational(values[node.args[0]], node.args[1].number, n)
        return algebra.function(node.name, [values[a] for a in node.args], n)
    if op is Op.ROOT:
        return _root(node.root, [values[a] for a in node.args], sample, n)
    if op is Op.IF:
        return values[chosen(node, values, algebra)]
    return algebra.number(int(holds(node, values, algebra)))


def _root(root: Root, args: Sequence[Any], sample: Assignment, n: int) -> Any:
    """The value of a root from those of what stands in its places."""

    def zero(args: Sequence[Series], unknown: Series, size: int) -> Series:
        value: Series = values_of_equation(root, args, unknown, sample.algebra, size)[root.zero]
        return value

    return root_value(root, args, sample, n, zero)


def chosen(node: Expr, values: dict[Expr, Any], algebra: Values[Any]) -> Expr:
    """The branch that an IF node takes."""
    condition, yes, no = node.args
    (truth,) = algebra.leads(values[condition])
    return yes if algebra.numbers.nonzero(truth) else no


def holds(node: Expr, values: dict[Expr, Any], algebra: Values[Any]) -> bool:
    """Whether a comparison or a logical node is true."""
    if node.op is Op.CMP:
        left, right = algebra.leads(*[values[a] for a in node.args])
        return compare(algebra.numbers, node.name, left, right)
    truths = [algebra.numbers.nonzero(x) for x in algebra.leads(*[values[a] for a in node.args])]
    if node.name == "not":
        return not truths[0]
    return all(truths) if node.name == "and" else any(truths)
