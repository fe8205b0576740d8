"""The numbers of a model: parameters, constants and initial values, some of them replaced."""

from __future__ import annotations

from collections.abc import Mapping

from bondgraph.ir.expr import Expr, Op, topological
from bondgraph.ir.graph import BondGraph
from bondgraph.runtime.simulation.code import NAMES


class Values:
    """Parameter values of a machine, in SI units; `replaced` by name takes precedence."""

    def __init__(self, graph: BondGraph, replaced: Mapping[str, float] | None = None) -> None:
        self.graph = graph
        self._known: dict[Expr, float | None] = {}
        given = {v.name: v for v in graph.values}
        self._meant: dict[Expr, Expr | None]
        self.replaced = {n: float(v) for n, v in (replaced or {}).items() if n in given}
        for name, number in self.replaced.items():
            self._known[given[name].symbol] = number
        self._meant = {v.symbol: v.value for v in graph.values}
        ports = [(p.initial, p.initial_value) for node in graph.nodes for p in node.ports]
        written = [(i.initial, i.initial_value) for i in graph.integrals]
        self._meant |= {s: v for s, v in (*ports, *written) if s is not None}

    def number(self, expr: Expr) -> float:
        """The value of an expression of parameters; raises KeyError with the name of a parameter
        that has none."""
        found = self.constant(expr)
        if found is None:
            missing = [
                n.symbol.name for n in topological([expr]) if n.op is Op.SYM and n in self._meant
            ]
            raise KeyError(missing[0] if missing else repr(expr))
        return found

    def constant(self, expr: Expr) -> float | None:
        """The value, None where a signal or a parameter without a number is in it."""
        if expr in self._known:
            return self._known[expr]
        for node in topological([expr], stop=self._known.__contains__):
            if node in self._known:
                continue
            self._known[node] = None  # also for a definition that runs in a circle
            if node.op is Op.SYM:
                meant = self._meant.get(node)
                self._known[node] = None if meant is None else self.constant(meant)
            else:
                self._known[node] = self._apply(node)
        return self._known[expr]

    def _apply(self, node: Expr) -> float | None:
        args = [self._known[a] for a in node.args]
        numbers = [a for a in args if a is not None]
        if len(numbers) < len(args):
            return None
        try:
            match node.op:
                case Op.NUM:
                    return float(node.number)
                case Op.ADD:
                    pairs = zip(node.coefficients, numbers, strict=True)
                    return sum(float(c) * a for c, a in pairs)
                case Op.MUL:
                    product = 1.0
                    for a, e in zip(numbers, node.exponents, strict=True):
                        product *= a**e
                    return product
                case Op.FN if node.name in NAMES:
                    return float(NAMES[node.name](*numbers))
                case Op.DER:
                    return 0.0
                case Op.IF:
                    return numbers[1] if numbers[0] else numbers[2]
                case Op.CMP:
                    left, right = numbers
                    holds = {"<": left < right, "<=": left <= right, "==": left == right}
                    return float(holds[node.name])
                case Op.LOGIC:
                    if node.name == "not":
                        return float(not numbers[0])
                    return float((all if node.name == "and" else any)(numbers))
        except (ArithmeticError, ValueError):
            return None
        return None
