"""Bring a relation to the form in which a person would write it: constants out of derivatives,
shared parts named by the variable of the model that they are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from functools import cache

from bondgraph.ir.expr import Expr, Kind, Op, Pool, Symbol, topological
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.nodes import constant, rebuilt
from bondgraph.ir.past import past_of
from bondgraph.ir.residuals import Residual
from bondgraph.notation.formula import Reader
from bondgraph.notation.lettering import Spare
from bondgraph.notation.line import Line
from bondgraph.text.tuples import NamedTuple

_MANY = 60  # a sum of more terms stays nested
_SHORT = 3  # a shared part of fewer nodes than this reads better in full


class ClosedForm(NamedTuple):
    """`text` of a relation, with `where` as (name, text) for its shared parts, outermost first."""

    text: str
    where: tuple[tuple[str, str], ...]

    def __str__(self) -> str:
        lines = [self.text]
        for position, (name, text) in enumerate(self.where):
            lines.append(f"{'where' if position == 0 else '     '} {name} = {text}")
        return "\n".join(lines)


def tidy(pool: Pool, *exprs: Expr) -> list[Expr]:
    """The expressions with constant factors and terms moved out of time derivatives.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); y = p.symbol("y", Kind.SENSOR); C = p.symbol("C", Kind.PARAM)
    >>> tidy(p, p.der(p.mul(C, y)))
    [C*D(y)]
    """
    memo: dict[Expr, bool] = {}

    def moved(node: Expr, args: tuple[Expr, ...]) -> Expr | None:
        return _derivative(pool, args[0], memo) if node.op is Op.DER else None

    return rebuilt(pool, exprs, moved)


def _derivative(pool: Pool, node: Expr, memo: dict[Expr, bool]) -> Expr:
    if constant(node, memo):
        return pool.zero
    if node.op is Op.ADD:
        terms = node.terms
        moving = [(c, a) for c, a in terms if not constant(a, memo)]
        if len(moving) == 1:
            return pool.add((moving[0][0], _derivative(pool, moving[0][1], memo)))
        return pool.der(pool.add(*moving))
    if node.op is Op.MUL:
        factors = list(node.factors)
        still = [pool.power(a, e) for a, e in factors if constant(a, memo)]
        moving_part = pool.mul(*[pool.power(a, e) for a, e in factors if not constant(a, memo)])
        return pool.mul(*still, pool.der(moving_part)) if still else pool.der(node)
    return pool.der(node)


def upright(pool: Pool, expr: Expr) -> Expr:
    """The relation as one sum, with the sign that makes its first source positive.

    A source is what a person starts from: U - R*i - ..., not R*i - (U - ...).

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); U = p.symbol("U", Kind.INPUT); y = p.symbol("y", Kind.SENSOR)
    >>> upright(p, p.sub(p.mul(y, y), p.sub(U, y)))
    U - y - y^2
    """
    uses = Counter(a for n in topological([expr]) for a in n.args)
    terms = [(Fraction(1), expr)]
    while any(_opens(a, uses) for _, a in terms) and len(terms) < _MANY:
        opened: list[tuple[Fraction, Expr]] = []
        for c, a in terms:
            if _opens(a, uses):
                opened += [(c * k, b) for k, b in a.terms]
            else:
                opened.append((c, a))
        terms = opened
    flat = pool.add(*terms)
    if flat.op is not Op.ADD:
        return flat
    kinds = (Kind.INPUT, Kind.SENSOR)
    plain = [
        (kinds.index(a.symbol.kind), a.id, c)
        for c, a in flat.terms
        if a.op is Op.SYM and a.symbol.kind in kinds
    ]
    return pool.neg(flat) if plain and min(plain)[2] < 0 else flat


def _opens(node: Expr, uses: Counter[Expr]) -> bool:
    """Whether a sum may be opened into the one around it: not if it stands elsewhere as well."""
    return node.op is Op.ADD and (uses[node] <= 1 or len(node.args) == 1)


class Parts(NamedTuple):
    """A relation as nodes: `named` are its shared parts, each with the name that stands for it.

    `order` has all nodes, arguments first; `variables` names every node that is the value of a
    variable of the model. `taken` tells the names that no part may be given.
    """

    root: Expr
    order: tuple[Expr, ...]
    named: dict[Expr, str]
    variables: dict[Expr, str]
    taken: Callable[[], frozenset[str]] = frozenset


def parts(graph: BondGraph, residual: Residual) -> Parts:
    """The relation, tidied, with the parts that occur more than once."""
    known = [s for s in residual.steps if s.closed.args]
    both = graph.pool.logged([residual.expr, *[s.closed for s in known]])
    root, *values = tidy(graph.pool, *both)
    names: dict[Expr, str] = {}
    for step, value in zip(known, values, strict=True):
        if value.args:
            names.setdefault(value, step.variable.symbol.name)
    return shared(root, names, lambda: _written(graph, residual))


def _written(graph: BondGraph, residual: Residual) -> frozenset[str]:
    """What its author calls something in a model, and the variables of a relation."""
    own = [*graph.names, *[step.variable.symbol.name for step in residual.steps]]
    kinds = (graph.values, graph.inputs, graph.sensors, graph.lets)
    return frozenset([*own, *[item.name for items in kinds for item in items]])


def _names_in(order: Iterable[Expr]) -> Iterator[str]:
    """All names that an expression is written with: of symbols, starts, roots and tables."""
    for node in order:
        if node.op in (Op.SYM, Op.INT):
            name = node.symbol.name
            while (past := past_of(name)) is not None:  # delay(x1, 0.1) is written with x1
                name = past[0]
            yield name
        elif node.op is Op.ROOT:
            yield node.root.name
        elif node.op is Op.FN:
            yield node.name.rpartition(":")[2]


def shared(
    root: Expr, variables: dict[Expr, str], written: Callable[[], frozenset[str]] = frozenset
) -> Parts:
    """The parts of an expression that occur more than once, named by `variables` or x1, x2, ...

    No part is called like anything that occurs in the expression, or is `written` in its model:
    thousands of names, which are asked for only if a part has none.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); x, y = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR)
    >>> s = p.add((1, p.mul(x, y)), (1, x)); e = p.mul(s, p.fn("sin", s))
    >>> shared(e, {}).named
    {x + x*y: 'x1'}
    """
    order = topological([root])
    uses: dict[Expr, int] = dict.fromkeys(order, 0)
    size: dict[Expr, int] = {}
    for node in order:
        size[node] = 1 + sum(min(size[a], _SHORT) for a in node.args)
        for arg in node.args:
            uses[arg] += 1

    @cache
    def taken() -> frozenset[str]:
        return written().union(_names_in(order), variables.values())

    spare: Spare | None = None
    chosen: dict[Expr, str] = {}
    for node in order:
        if uses[node] > 1 and size[node] > _SHORT and node.op is not Op.NUM:
            name = variables.get(node)
            if name is None:
                spare = spare or Spare(taken())
                name = spare.name(len(chosen) + 1)
            chosen[node] = name
    return Parts(root, tuple(order), chosen, variables, taken)


def closed_form(
    graph: BondGraph, residual: Residual, starts: Mapping[Symbol, Expr] | None = None
) -> ClosedForm:
    """The relation as nested text; what occurs more than once is named and written once.

    `starts` are the graph's initial values, for who asks for many relations of one graph.
    """
    root, order, chosen, *_ = parts(graph, residual)
    reader, line = Reader(chosen, graph.initial_values() if starts is None else starts), Line()
    where = [
        (chosen[node], line.spell(reader.definition(node)).text)
        for node in reversed(order)
        if node in chosen
    ]
    return ClosedForm(line.spell(reader.of(root)).text, tuple(where))
