"""A point at which every signal is independent of the others: expressions as such, no plant."""

from __future__ import annotations

import random
from typing import Any

from bondgraph.exact.outline import highest_order, outline
from bondgraph.exact.signal_algebra import Algebra, Exponentials, Taylor
from bondgraph.field.numbers import Number
from bondgraph.field.prime import PrimeField
from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Kind, Op, Symbol


class FreeSample:
    """Random values for all symbols of an expression, each drawn when it is asked for."""

    def __init__(
        self, algebra: Algebra[Any, Any], order: int, seed: int, constants: int | None = None
    ) -> None:
        self._algebra = algebra
        self._order = order
        self._seed = seed
        self._constants = seed if constants is None else constants

    @classmethod
    def of(cls, expr: Expr, seed: int) -> FreeSample:
        """Exponentials where the expression is linear in derivatives of signals, else series."""
        numbers = PrimeField(seed)
        if highest_order([expr]) and linear(expr):
            draw = random.Random(seed)
            return cls(Exponentials(numbers, numbers.any(draw), numbers.any(draw)), 0, seed)
        return cls(Taylor(numbers), highest_order([expr]), seed)

    @property
    def algebra(self) -> Algebra[Any, Any]:
        """The algebra that the values belong to."""
        return self._algebra

    def value(self, symbol: Expr) -> Any:
        """A random signal, or a random constant for a parameter; the same at every call."""
        signal = symbol.symbol.kind in KNOWN_SIGNALS
        source = self._seed if signal else self._constants
        draw = random.Random(f"{source}:{symbol.symbol.name}")
        numbers = self._algebra.numbers
        if isinstance(self._algebra, Exponentials):
            return (numbers.any(draw), int(signal))
        if symbol.symbol.kind is Kind.MODE:
            return [draw.randrange(2)]
        if not signal:
            return [numbers.any(draw)]
        return [numbers.any(draw) for _ in range(self._order + 1)]

    def start(self, initial: Symbol) -> Number:
        """A random value for integrals to begin with."""
        return self._algebra.numbers.any(random.Random(f"{self._seed}:{initial.name}"))

    def earlier(self, steps: int) -> FreeSample:
        """Other signals with the same constants."""
        later = self._seed + 1_000_003 * steps
        return FreeSample(self._algebra, self._order, later, self._constants)


def linear(expr: Expr) -> bool:
    """Whether an expression is a sum of constants times derivatives of signals."""
    degree: dict[Expr, int] = {}
    for node in outline(expr).nodes:
        below = [degree[a] for a in node.args]
        if node.op is Op.SYM:
            if node.symbol.kind is Kind.MODE:
                return False
            degree[node] = int(node.symbol.kind in KNOWN_SIGNALS)
        elif node.op is Op.ADD:
            if len(set(below)) > 1:
                return False
            degree[node] = below[0]
        elif node.op is Op.MUL:
            if any(d and e != 1 for d, e in zip(below, node.exponents, strict=True)):
                return False
            degree[node] = sum(below)
            if degree[node] > 1:
                return False
        elif node.op is Op.NUM:
            degree[node] = 0
        elif node.op is Op.DER:
            degree[node] = below[0]
        elif any(below) or node.op in (Op.INT, Op.IF, Op.CMP, Op.LOGIC, Op.ROOT):
            return False
        else:
            degree[node] = 0
    return True
