"""Equations of a bond graph in SymPy and back: every signal and every unknown a function of time.

What SymPy has no inverse or no piecewise slope of (`x |x|`, the smaller of two, a table) is here a
function of its own, with both from its record.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any

import sympy as sp

from bondgraph.algebra.symbolic import WRITTEN_OUT, applied, called, from_sympy, t, to_sympy
from bondgraph.ir.expr import (
    VARIABLES,
    ZERO_START,
    Expr,
    Kind,
    Op,
    Pool,
    Symbol,
    symbols,
    topological,
)
from bondgraph.ir.functions import FUNCTIONS
from bondgraph.ir.tables import reading

_TABLE, _ROOT = "table:", "root:"


class Signals:
    """Expressions of one model, of `pool`, as SymPy has them.

    `starts` are the values from which integrals begin. `own` is a pool for what SymPy answers, so
    that looking at a derivation changes nothing of a model; it begins with the nodes of `like`,
    which have their order from there.
    """

    def __init__(self, pool: Pool, starts: Mapping[Symbol, Expr], like: Iterable[Expr]) -> None:
        self.pool = pool
        self.starts = starts
        self.own = Pool()
        self.own.tables = pool.tables
        self.names: dict[Any, Expr] = {}  # what stands for each of SymPy's symbols and signals
        self._roots: dict[str, Expr] = {}
        self._copies: dict[Expr, Expr] = {}
        self.copies(like)
        for node in symbols(*starts.values()):
            self._symbol(node)

    def copies(self, exprs: Iterable[Expr]) -> list[Expr]:
        """The same expressions in the pool of answers; a reading is there what its sensor says."""
        asked = list(exprs)
        done, own = self._copies, self.own
        for node in topological(asked, stop=done.__contains__):
            if node in done:
                continue
            if node.op is Op.SYM:
                kind = Kind.SENSOR if node.symbol.kind is Kind.READING else node.symbol.kind
                done[node] = own.symbol(node.symbol.name, kind)
            elif node.op is Op.NUM:
                done[node] = own.num(node.number)
            elif node.op is Op.ROOT:
                done[node] = own.root(node.root, *[done[a] for a in node.args])
            else:
                done[node] = own.rebuild(node, tuple([done[a] for a in node.args]))
        return [done[e] for e in asked]

    def sympy(self, expr: Expr) -> Any:
        """An expression, with its derivatives taken."""
        leaves: dict[Expr, Any] = {}
        for node in topological([expr]):
            if node.op is Op.SYM:
                leaves[node] = self._symbol(node)
            elif node.op is Op.INT and node.symbol not in self.starts:  # declared nowhere
                self._symbol(self.pool.symbol(node.symbol.name, node.symbol.kind))
            elif node.op is Op.ROOT:
                self._roots[node.root.name] = node
        return taken(_applied(expr, leaves, self.starts))

    def _symbol(self, node: Expr) -> Any:
        symbol = node.symbol
        if symbol.name == ZERO_START:
            return sp.Integer(0)
        moving = symbol.kind in VARIABLES
        found = sp.Function(symbol.name, real=True)(t) if moving else to_sympy(node)
        self.names[found] = self.copies([node])[0]
        return found

    def expr(self, value: Any) -> Expr:
        """What SymPy says, as an expression of the pool of answers."""
        found = from_sympy(self.own, value, self.names, self._other)
        assert found is not None, f"no expression of a model: {value}"
        return found

    def _other(self, value: Any) -> Expr | None:
        """What a bond graph may hold beside arithmetic: derivatives, integrals, choices, tables."""
        own = self.own
        if isinstance(value, sp.Derivative):
            return own.der(self.expr(value.expr), int(value.derivative_count))
        if isinstance(value, sp.Integral):
            return own.integral(self.expr(value.function), own.symbol(ZERO_START, Kind.INITIAL))
        if isinstance(value, OwnFunction):
            args = tuple([self.expr(a) for a in value.args])
            root = self._roots.get(value.called.removeprefix(_ROOT))
            if root is not None and value.called.startswith(_ROOT):
                return own.root(root.root, *args)
            return own.fn(value.called, *args)
        if isinstance(value, sp.Piecewise):
            *first, (last, _) = value.args
            found = self.expr(last)
            for branch, condition in reversed(first):
                found = own.choose(self._condition(condition), self.expr(branch), found)
            return found
        if value.is_Pow and not value.exp.is_Rational and value.base != sp.E:
            return own.fn("pow", *[self.expr(a) for a in value.args])
        name = called(value)
        return own.fn(name, *[self.expr(a) for a in value.args]) if name else None

    def _condition(self, value: Any) -> Expr:
        own = self.own
        if isinstance(value, sp.Not):
            return own.logic("not", self._condition(value.args[0]))
        if isinstance(value, (sp.And, sp.Or)):
            name = "and" if isinstance(value, sp.And) else "or"
            return own.logic(name, *[self._condition(a) for a in value.args])
        left, right = (self.expr(a) for a in value.args)
        if left.kind is Kind.MODE and right is own.one:
            return left if isinstance(value, sp.Eq) else own.logic("not", left)
        return own.compare(value.rel_op, left, right)


class OwnFunction(sp.Function):  # type: ignore[misc]
    """A function that SymPy does not have as such; `called` as an expression calls it."""

    called = ""

    def fdiff(self, argindex: int = 1) -> Any:
        """The slope by an argument."""
        record = FUNCTIONS.get(self.called)
        if record is None:
            return own_function(f"{self.called} by {argindex}")(*self.args)
        pool = Pool()
        value, *args = (pool.symbol(f"x{k}", Kind.CONST) for k in range(len(self.args) + 1))
        slope = record.slopes[argindex - 1](pool, value, *args)
        return _applied(slope, dict(zip((value, *args), (self, *self.args), strict=True)), {})


@cache
def own_function(name: str) -> Any:
    """The SymPy function for a name that SymPy does not have."""
    own = {"called": name, "_eval_is_extended_real": lambda _: True}
    kind: Any = type(OwnFunction)
    return kind(name, (OwnFunction,), own)


def _applied(expr: Expr, leaves: dict[Expr, Any], starts: Mapping[Symbol, Expr]) -> Any:
    """An expression with functions of its own, of what stands for its `leaves`."""
    for node in topological([expr], stop=leaves.__contains__):
        if node.op is Op.FN and (node.name in WRITTEN_OUT or node.name not in FUNCTIONS):
            args = [to_sympy(a, leaves, starts) for a in node.args]
            leaves[node] = own_function(node.name)(*args)
        elif node.op is Op.ROOT:
            args = [to_sympy(a, leaves, starts) for a in node.args]
            leaves[node] = own_function(_ROOT + node.root.name)(*args)
    return to_sympy(expr, leaves, starts)


def name_of(value: Any) -> str | None:
    """What an expression calls the function that a SymPy value is of."""
    return value.called if isinstance(value, OwnFunction) else called(value)


def undone(value: Any, at: int, target: Any) -> Any:
    """The argument number `at` of a function that has the value `target`; None if that is open."""
    name = name_of(value)
    if name is not None and name.startswith(_TABLE):
        read, args = reading(name.removeprefix(_TABLE), value.args, target, at)
        return own_function(_TABLE + read)(*args)
    record = FUNCTIONS.get(name or "")
    if record is None or record.inverse is None:
        return None
    if isinstance(record.inverse, int):
        return target**record.inverse
    found = record.inverse
    return own_function(found)(target) if found in WRITTEN_OUT else applied(found, target)


def taken(value: Any) -> Any:
    """The expression with every derivative taken, and no integral."""
    return value.doit(integrals=False) if value.has(sp.Derivative) else value
