"""Multiply a relation through with the moduli it divides by, so that it holds where they are zero.

A two-port that a known signal modulates is read backwards by dividing by its modulus: by 1 - a of
a duty cycle a, by a speed of a rotating body. Both may be zero while the machine runs, and a leak,
or the difference of two moments of inertia, is zero all the time. The relation is kept as a
fraction and only its numerator is left: (N/m)' becomes N' m - N m'.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from bondgraph.algebra.nominal import Nominal
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Op, Pool, topological
from bondgraph.ir.nodes import constant, holding
from bondgraph.ir.residuals import Step

Denominator = dict[Expr, int]


def moduli(system: EquationSystem, steps: Sequence[Step]) -> list[Expr]:
    """The moduli of two-ports that some step divides by, in known signals.

    They stand in the law of a two-port or, where it modulates another one, in a balance or a loop.
    Constant ones are left out: a transformer whose ratio is zero is none.
    """
    pool = system.graph.pool
    top: dict[Expr, None] = {}
    inside: dict[Expr, None] = {}
    seen: set[Expr] = set()  # values of a loop share nearly all that they are made of
    for step in steps:
        equation = step.equation
        kind = system.graph.nodes[equation.node].kind if equation.node >= 0 else ""
        if step.how == "loop":
            top.update(dict.fromkeys(_divisors([step.closed])))
        elif equation.kind == "balance" or kind in ("TF", "GY"):
            written = {*_divisors(topological([equation.zero]))}  # no work of the elimination
            nodes = topological([step.value], stop=seen.__contains__)
            own = _divisors(n for n in nodes if n not in seen)
            inside.update(dict.fromkeys(d for d in own if d not in written))
            seen.update(nodes)
    found = dict.fromkeys([*top, *pool.substitute(inside, {s.variable: s.closed for s in steps})])
    known = holding(found, lambda n: n.kind in KNOWN_SIGNALS)
    return [base for base in found if base in known]


def vanishing_divisors(nominal: Nominal, expr: Expr) -> list[Expr]:
    """The constants below an expression that it divides by and that are nominally zero."""
    nodes = topological([expr])
    known: dict[Expr, bool] = {}
    found = dict.fromkeys(_divisors(nodes))
    return [base for base in found if constant(base, known) and nominal.vanishes(base)]


def signals_below(expr: Expr) -> list[Expr]:
    """What a relation divides by and that holds known signals: it may become zero on the way."""
    found = dict.fromkeys(_divisors(topological([expr])))
    moving = holding(found, lambda n: n.kind in KNOWN_SIGNALS)
    return [base for base in found if base in moving]


def _divisors(nodes: Iterable[Expr]) -> list[Expr]:
    return [
        arg
        for item in nodes
        if item.op is Op.MUL
        for arg, exponent in item.factors
        if exponent < 0
    ]


def cleared(pool: Pool, expr: Expr, bases: Iterable[Expr]) -> Expr:
    """The numerator of a relation, as far as its denominators are among the `bases`.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); U, y, m = (p.symbol(n, Kind.INPUT) for n in ("U", "y", "m"))
    >>> cleared(p, p.sub(U, p.div(y, m)), [m])
    U*m - y
    >>> cleared(p, p.sub(U, p.der(p.div(y, m))), [m])
    U*m^2 - (m*D(y) - y*D(m))
    """
    work = _Fractions(pool, dict.fromkeys(bases))
    for node in topological([expr]):
        work.visit(node)
    return work.parts[expr][0] if expr in work.parts else expr


class _Fractions:
    """Numerator and denominator of the nodes that hold one of the bases as a divisor."""

    def __init__(self, pool: Pool, bases: dict[Expr, None]) -> None:
        self.pool = pool
        self.bases = bases
        self.parts: dict[Expr, tuple[Expr, Denominator]] = {}

    def visit(self, node: Expr) -> None:
        if node.op is Op.MUL:
            self.product(node)
            return
        if not any(a in self.parts for a in node.args):
            return
        if node.op is Op.ADD:
            terms, below = self.common(node.args)
            sum_ = self.pool.add(*zip(node.coefficients, terms, strict=True))
            self.parts[node] = sum_, below
        elif node.op is Op.DER:
            self.parts[node] = self.derivative(*self.parts[node.args[0]])
        elif node.op is Op.IF and node.args[0] not in self.parts:
            (yes, no), below = self.common(node.args[1:])
            self.parts[node] = self.pool.choose(node.args[0], yes, no), below
        # inside a function or an integral a quotient stays one

    def product(self, node: Expr) -> None:
        if not any(
            a in self.parts or (e < 0 and a in self.bases)
            for a, e in node.factors
        ):
            return
        factors: list[Expr] = []
        below: Denominator = {}
        for arg, exponent in node.factors:
            upper, lower = self.parts.get(arg, (arg, {}))
            if arg in self.bases:
                lower = {arg: -1}
            else:
                factors.append(self.pool.power(upper, exponent))
            for base, power in lower.items():
                below[base] = below.get(base, 0) + power * exponent
        factors += [self.pool.power(b, -k) for b, k in below.items() if k < 0]
        self.parts[node] = self.pool.mul(*factors), {b: k for b, k in below.items() if k > 0}

    def common(self, args: Sequence[Expr]) -> tuple[list[Expr], Denominator]:
        """The numerators over the least common denominator."""
        split = [self.parts.get(a, (a, {})) for a in args]
        below: Denominator = {}
        for _, lower in split:
            for base, power in lower.items():
                below[base] = max(below.get(base, 0), power)
        out = []
        for upper, lower in split:
            lift = [self.pool.power(b, k - lower.get(b, 0)) for b, k in below.items()]
            out.append(self.pool.mul(upper, *lift))
        return out, below

    def derivative(self, upper: Expr, lower: Denominator) -> tuple[Expr, Denominator]:
        """(N / prod b^k)' = (N' prod b - N sum k b' prod of the other b) / prod b^(k+1)."""
        pool = self.pool
        terms = [(1, pool.mul(pool.der(upper), *lower))]
        for base, power in lower.items():
            others = [b for b in lower if b is not base]
            terms.append((-power, pool.mul(upper, pool.der(base), *others)))
        return pool.add(*terms), {b: k + 1 for b, k in lower.items()}
