"""The entry point that takes exact derivatives: every residual as it stands in the theory."""

from __future__ import annotations

from bondgraph.algebra.derivative import TooManyOperations, operations
from bondgraph.algebra.normalise import LIMIT, rewritten
from bondgraph.ir.expr import Expr, Kind, Op
from bondgraph.ir.normal import NormalForm, Term
from bondgraph.ir.program import (
    Assign,
    Assignment,
    Dot,
    DotTerm,
    Expression,
    Field,
    Product,
    Ref,
    Sum,
)
from bondgraph.ir.residuals import Residual
from bondgraph.passes.lowering.builder import Builder
from bondgraph.passes.lowering.procedure import ONE, ZERO, Procedure, positive_part
from bondgraph.passes.lowering.program_names import Names, brief, identifier, short
from bondgraph.text.source import Span

#: Operations that one residual may take in exact; a longer one has no exact.
LARGEST = 20_000


class Exactly:
    """Writes the statements of `exact`, residual by residual."""

    def __init__(self, builder: Builder) -> None:
        self.builder = builder
        self.statements: list[Assignment | Dot] = []
        self.highest = 0
        self._procedure = Procedure(
            builder.pool,
            self.leaf,
            self.statements.append,
            Names(),
            "",
            builder.hoist,
            builder.is_constant,
        )

    def residual(
        self, residual: Residual, form: NormalForm, arrays: dict[Expr, tuple[str, int]], text: str
    ) -> int | None:
        """Append the statements of one residual; the highest derivative that it reads.

        `arrays` has the coefficient array and its length of every atom of a large residual.
        Where more than `LARGEST` operations would be needed, nothing is written: None.
        """
        self.highest = 0
        name = identifier(residual.name)
        origin = residual.closing.origin
        try:
            exprs, series = self._expressions(form.terms, arrays)
        except TooManyOperations:
            return None
        operands = self._operands(form.terms, exprs, origin)
        terms = [
            self._term(residual, t, value) for t, value in zip(form.terms, operands, strict=True)
        ]
        dots: list[DotTerm] = []
        for atom, (array, length) in arrays.items():
            if atom in series:
                terms += self._series(array, series[atom], origin)
            else:
                self._need(atom, length - 1)
                dots.append(DotTerm(array, self.builder.signals[atom].name, length))
        target = Ref("residual", name)
        if dots and terms:
            linear = Ref("local", f"{name}_linear")
            self.statements.append(Dot(linear, tuple(dots), f"{name}, its linear part", origin))
            terms.insert(0, (True, linear))
        elif dots:
            self.statements.append(Dot(target, tuple(dots), text, origin))
            return self.highest
        self.statements.append(Assign(target, total(terms), text, origin))
        return self.highest

    def _term(self, residual: Residual, term: Term, operand: Expression) -> tuple[bool, Expression]:
        builder = self.builder
        value = term.coefficient
        if builder.scaled and term.atom in builder.signals and term.order:
            unit = builder.option("time_unit")
            value = builder.pool.mul(value, builder.pool.power(unit, -term.order))
        sign, size = positive_part(builder.pool, value)
        name = identifier(residual.name)
        words = short(term.atom, term.order)
        doc = f"{residual.name}: factor of {words}: {brief(size)}"
        wish = f"{name}_{label(builder, term.atom)}" + suffix(term.order)
        factor = builder.coef(size, wish, doc, residual.closing.origin)
        if term.atom is builder.pool.one and term.order == 0:
            return sign, factor
        return sign, operand if factor == ONE else Product((factor, operand))

    def _expressions(
        self, terms: tuple[Term, ...], arrays: dict[Expr, tuple[str, int]]
    ) -> tuple[list[Expr], dict[Expr, list[Expr]]]:
        """What stands beside each coefficient; of a large residual, all derivatives by atom.

        Raises `TooManyOperations` if that is more than `LARGEST`.
        """
        builder, pool = self.builder, self.builder.pool
        end = len(pool) + LARGEST

        def derivative(expr: Expr, order: int) -> Expr:
            return builder.jets.of(expr, order, end - len(pool))

        exprs: list[Expr] = []
        for term in terms:
            expr = term.atom
            if expr not in builder.signals and (term.order > 0 or not term.static):
                expr = derivative(expr, max(term.order, 0))
            for _ in range(-term.order):
                expr = pool.integral(expr, builder.zero_start)
            exprs.append(expr)
        series: dict[Expr, list[Expr]] = {}
        for atom, (_, length) in arrays.items():
            if atom in builder.signals:
                continue
            plain = rewritten(pool, atom, LIMIT, builder.initials)
            own = series[atom] = [derivative(plain, 0)]
            while len(own) < length and own[-1] is not pool.zero:
                own.append(derivative(plain, len(own)))
        if operations([*exprs, *[e for own in series.values() for e in own]]) > LARGEST:
            raise TooManyOperations
        return exprs, series

    def _operands(
        self, terms: tuple[Term, ...], exprs: list[Expr], origin: Span
    ) -> list[Expression]:
        """What the coefficients are multiplied by; nonlinear parts share what they can."""
        signals = self.builder.signals
        nonlinear = [e for t, e in zip(terms, exprs, strict=True) if t.atom not in signals]
        values = iter(self._procedure.values(nonlinear, origin))
        return [self._need(t.atom, t.order) if t.atom in signals else next(values) for t in terms]

    def _series(self, array: str, exprs: list[Expr], origin: Span) -> list[tuple[bool, Expression]]:
        """An atom of a large residual with all its derivatives, each beside its coefficient."""
        out: list[tuple[bool, Expression]] = []
        for k, value in enumerate(self._procedure.values(exprs, origin)):
            factor: Expression = Ref("coef", array, k)
            for _ in range(k):
                unit = self.builder.hoist(self.builder.option("time_unit"))
                factor = Product((factor, unit))
            out.append((True, factor if value == ONE else Product((factor, value))))
        return out

    # -------------------------------------------------------------- leaves

    def _need(self, symbol: Expr, order: int) -> Ref:
        self.highest = max(self.highest, order)
        return self.builder.need(symbol, order)

    def leaf(self, node: Expr) -> Expression | None:
        """What exact is given: derivatives and integrals of known signals."""
        builder = self.builder
        if node.kind is Kind.MODE and node in builder.signals:
            return builder.mode(node)
        order, inner = 0, node
        while inner.op is Op.DER:
            order, inner = order + 1, inner.args[0]
        if inner in builder.signals:
            value = self._need(inner, order)
            return self._scaled(value, order) if order else value
        return self._integral(node) if node.op is Op.INT else None

    def _scaled(self, value: Expression, order: int) -> Expression:
        builder = self.builder
        if not builder.scaled:
            return value
        unit = builder.pool.power(builder.option("time_unit"), -order)
        return Product((builder.coef(unit, f"per_time_{order}", "time unit"), value))

    def _integral(self, node: Expr) -> Expression:
        builder = self.builder
        inner = node.args[0]
        depth = 1
        while inner.op is Op.INT and inner.symbol == builder.zero_start.symbol:
            depth, inner = depth + 1, inner.args[0]
        value: Expression
        if inner in builder.signals and inner.symbol.kind is not Kind.MODE:
            value = self._scaled(self._need(inner, -depth), -depth)
        elif inner is builder.pool.one and depth == 1:
            value = self._scaled(Ref("time", "time"), -1)
        elif inner.op is Op.DER and inner.args[0] in builder.signals:
            symbol = inner.args[0]
            name = builder.signals[symbol].name
            builder.starts[name] = None
            value = Sum(((True, self._need(symbol, 0)), (False, Ref("start", name))))
        else:
            value = self._given(node)
        if node.symbol == builder.zero_start.symbol:
            return value
        start = builder.pool.symbol(node.symbol.name, node.symbol.kind)
        return Sum(((True, builder.hoist(start)), (True, value)))

    def _given(self, node: Expr) -> Ref:
        """An integral that does not follow from integrals of signals: it has to be given."""
        builder = self.builder
        plain = builder.pool.integral(node.args[0], builder.zero_start)
        field = builder.integrals.get(plain)
        if field is None:
            name = f"integral_{len(builder.integrals) + 1}"
            doc = f"integral of {brief(node.args[0])} since the start"
            field = Field(name, brief(plain), "", doc)
            builder.integrals[plain] = field
        return Ref("integral", field.name)


def total(terms: list[tuple[bool, Expression]]) -> Expression:
    """The sum of signed terms, the positive ones first."""
    if not terms:
        return ZERO
    terms = sorted(terms, key=lambda t: not t[0])
    return terms[0][1] if len(terms) == 1 and terms[0][0] else Sum(tuple(terms))


_LABELS = {Op.NUM: "constant", Op.MUL: "product", Op.IF: "choice", Op.INT: "integral"}


def label(builder: Builder, atom: Expr) -> str:
    """A name for an atom inside the name of a coefficient."""
    if atom in builder.signals:
        return builder.signals[atom].name
    if atom.op is Op.FN:
        return identifier(atom.name.partition(":")[0])
    if atom.op is Op.ROOT:
        return identifier(atom.root.name)
    return _LABELS.get(atom.op, "term")


def suffix(order: int) -> str:
    """The order of a derivative inside the name of a coefficient."""
    return f"_{order}" if order > 0 else "_int" * -order
