"""From written expressions to nodes of the pool, each with its dimension."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from fractions import Fraction
from typing import NoReturn, assert_never

from bondgraph.ir.expr import Expr, Op, Pool
from bondgraph.ir.nodes import constant
from bondgraph.ir.syntax import Binary, Call, Expression, Number, Ref, Text, Truth, Unary
from bondgraph.library.dimensions import Term
from bondgraph.library.units import parse_unit
from bondgraph.passes.elaboration.problems import Skip, fail, rough
from bondgraph.passes.elaboration.quantities import PURE, Quantities
from bondgraph.passes.elaboration.scope import Env, Scope, Typed
from bondgraph.text.diagnostic import Report, replacing
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

_MOST_DEEP = 80
_MOST_POWER = 1000
_MOST_BITS = 4096
_MOST_EXACT = 64
#: A double holds numbers between 2^-1022 and 2^1023; products of a few need some room.
_MOST_MAGNITUDE = 996
_COUNTS = frozenset({1, 2, 4})
_MOST_COUNT = 16


class Place(NamedTuple):
    """Where an expression stands: its names are looked up in `scope`, law variables in `local`.

    `owner` is the path that integrals written in it are named after.
    """

    scope: Scope
    env: Env
    owner: str
    local: dict[str, Typed] | None = None


class Expressions(ABC):
    """Converts expressions; what a name means is asked of `names` (see `values`)."""

    def __init__(self, pool: Pool, report: Report, quantities: Quantities) -> None:
        self.pool = pool
        self.report = report
        self.quantities = quantities
        self._constant: dict[Expr, bool] = {}
        self._made: dict[tuple[str, Expr, Expr], Expr] = {}
        self._depth = 0

    @abstractmethod
    def reference(self, ref: Ref, place: Place) -> Typed:
        """The value of a reference."""

    @abstractmethod
    def is_value(self, name: str, place: Place) -> bool:
        """Whether something is called so that has a value here."""

    @abstractmethod
    def no_mode(self, ref: Ref, place: Place) -> None:
        """Report an input that is used as a condition and not declared as one."""

    @abstractmethod
    def call(self, call: Call, place: Place) -> Typed:
        """The value of a function."""

    def convert(self, expr: Expression, place: Place) -> Typed:
        """The expression and its dimension; what is wrong is reported and raises Skip."""
        self._depth += 1
        try:
            if self._depth > _MOST_DEEP:
                fail(self.report, "expression-too-deep", "This expression is nested too deeply.",
                     expr.origin, help="Split it into several `let`s.")  # fmt: skip
            match expr:
                case Number():
                    return self.number(expr, place)
                case Ref():
                    return self.reference(expr, place)
                case Binary():
                    return self.binary(expr, place)
                case Unary():
                    return self.unary(expr, place)
                case Call():
                    return self.call(expr, place)
                case Truth():
                    return self.truth_value(expr.value), None
                case Text():
                    fail(self.report, "wrong-type", "A text is no value.", expr.origin,
                         help='A text is the file name of a table: `table("file.csv", x)`.'
                         )  # fmt: skip
                case _:
                    assert_never(expr)
        finally:
            self._depth -= 1

    def quantity(self, expr: Expression, place: Place) -> tuple[Expr, Term]:
        """An expression that must be a number."""
        node, term = self.convert(expr, place)
        if term is None:
            fail(self.report, "wrong-type", f"`{expr.origin.text}` is true or false: a number is "
                 "needed here.", expr.origin, help="Choose one with `if(condition, a, b)`."
                 )  # fmt: skip
        return node, term

    def condition(self, expr: Expression, place: Place) -> Expr:
        """An expression that must be true or false."""
        node, term = self.convert(expr, place)
        if term is not None:
            if isinstance(expr, Ref):
                self.no_mode(expr, place)
            fail(self.report, "not-a-condition", f"`{expr.origin.text}` is a number: a condition "
                 "is needed here.", expr.origin, help="Compare it with something, as in `x > 0`, "
                 "or use an `input ... : bool`.")  # fmt: skip
        return node

    def constant(self, expr: Expr) -> bool:
        """Whether no signal occurs: only numbers, params and initial values."""
        return constant(expr, self._constant)

    # ------------------------------------------------------------------ leaves

    def truth_value(self, value: bool) -> Expr:
        """A truth value known when the model is built."""
        return self.pool.one if value else self.pool.zero

    def number(self, number: Number, place: Place | None = None) -> tuple[Expr, Term]:
        """A literal in SI; without a unit it takes the one that its use requires."""
        if number.unit is None:
            return self.pool.num(self.held(number.value, number.origin)), (
                self.quantities.dimensions.fresh(number.origin, f"`{number.text}`", plain=True)
            )
        if place is not None:
            self.value_for_unit(number, number.unit, place)
        dimension, factor = self.quantities.unit(number.unit, number.origin)
        term = self.quantities.known(dimension, number.origin, "")
        return self.pool.num(self.held(number.value * factor, number.origin)), term

    def value_for_unit(self, number: Number, unit: str, place: Place) -> None:
        """Refuse `2 R` and `3 J/K/n` where R and n are values, or variables of the law."""
        if parse_unit(unit) is not None:
            return
        parts = re.split("([./])", unit)
        names = [self.is_value(part.partition("^")[0], place) for part in parts]
        if not any(names):
            return
        at = names.index(True)
        own, rest = "".join(parts[: max(at - 1, 0)]), "".join(parts[at:])
        sign = "/" if at and parts[at - 1] == "/" else "*"
        left = f"({number.text} {own})" if own else number.text
        meant = f"{left}{sign}{rest}"
        fail(self.report, "unknown-unit", f"`{unit}` is no unit.", number.origin,
             help=replacing(number.origin, meant, f"`{parts[at]}` is a value, and no part of a "
             f"unit: write `{meant}`."))  # fmt: skip

    # ------------------------------------------------------------------ operators

    def unary(self, expr: Unary, place: Place) -> Typed:
        """`-x` and `not x`."""
        if expr.op == "not":
            node = self.condition(expr.operand, place)
            if node.op is Op.NUM:
                return self.truth_value(node is self.pool.zero), None
            return self.pool.logic("not", node), None
        node, term = self.quantity(expr.operand, place)
        return self.pool.neg(node), term

    def binary(self, expr: Binary, place: Place) -> Typed:
        """All operators of two operands; a long sum or product is not a deep one."""
        spine = [expr]
        while isinstance(spine[-1].left, Binary):
            spine.append(spine[-1].left)
        first = spine[-1]
        result = self.convert(first.left, place)
        left: Expression = first.left
        while spine:
            step = spine.pop()
            result = self.step(step, left, result, place)
            left = step
        return result

    def step(self, expr: Binary, left: Expression, so_far: Typed, place: Place) -> Typed:
        """One operator, its left operand already converted."""
        op = expr.op
        if op in ("and", "or"):
            return self.connective(expr, left, so_far, place)
        a, s = so_far
        if s is None:
            if op in ("==", "!="):
                return self.equivalence(expr, a, place)
            fail(self.report, "wrong-type", f"`{left.origin.text}` is true or false: a number is "
                 "needed here.", left.origin, help="Choose one with `if(condition, a, b)`."
                 )  # fmt: skip
        b, t = self.quantity(expr.right, place)
        match op:
            case "+" | "-":
                self.alike(s, t, expr.origin, "the terms of a sum have one unit")
                return self.combined(op, a, b, expr), _firmer(s, t)
            case "*":
                s, t = self.counted(left, a, b, s), self.counted(expr.right, b, a, t)
                return self.combined(op, a, b, expr), self.product(s, t)
            case "/":
                s, t = self.counted(left, a, b, s), self.counted(expr.right, b, a, t)
                if b is self.pool.zero:
                    self.divides_by_zero(expr.right)
                return self.combined(op, a, b, expr), self.quotient(s, t)
            case "^":
                return self.power((a, s), (b, t), expr)
        self.alike(s, t, expr.origin, "both sides of a comparison have one unit")
        if a.op is Op.NUM and b.op is Op.NUM:
            return self.truth_value(_compared(op, a.number, b.number)), None
        return self.pool.compare(op, a, b), None

    def combined(self, op: str, a: Expr, b: Expr, expr: Binary) -> Expr:
        """Sum, difference, product or quotient; instances of a model often repeat the same."""
        key = (op, a, b)
        made = self._made.get(key)
        if made is None:
            pool = self.pool
            match op:
                case "+":
                    made = pool.add((1, a), (1, b))
                case "-":
                    made = pool.sub(a, b)
                case "*":
                    made = pool.mul(a, b)
                case _:
                    made = pool.div(a, b)
            self._made[key] = self.checked(made, expr)
        return made

    def alike(self, left: Term, right: Term, origin: Span, what: str) -> None:
        """One dimension on both sides, or an error."""
        if not self.quantities.same(left, right, origin, what):
            raise Skip

    def product(self, left: Term, right: Term) -> Term:
        """The dimension of a product."""
        if left is PURE:
            return right
        return left if right is PURE else self.quantities.dimensions.product(left, right)

    def quotient(self, left: Term, right: Term) -> Term:
        """The dimension of a quotient."""
        return left if right is PURE else self.quantities.dimensions.quotient(left, right)

    def counted(self, expr: Expression, node: Expr, other: Expr, term: Term) -> Term:
        """A small whole number (or half of one) beside a constant is a count: it has no unit.

        The 2 of `L/2` and of `2*R` is one; so `R:R1 = L/2` is found. Beside a signal, as in
        `e = 10*f`, a plain number may stand for a coefficient with a unit, and so may 9.81.
        """
        if node.op is not Op.NUM or not _plain(expr):
            return term
        value = node.number
        if value.denominator not in _COUNTS or abs(value.numerator) > _MOST_COUNT:
            return term
        return PURE if other.op is not Op.NUM and self.constant(other) else term

    def checked(self, node: Expr, expr: Expression) -> Expr:
        """Refuse numbers and powers that the generated code could not hold."""
        if node.op is Op.NUM:
            self.held(node.number, expr.origin)
        for coefficient, _ in node.terms:
            self.held(coefficient, expr.origin)
        highest = max(abs(e) for _, e in node.factors)
        if highest > _MOST_POWER:
            self.too_high(expr, Fraction(highest))
        return node

    def held(self, value: Fraction, origin: Span) -> Fraction:
        """The number, if a double can hold it."""
        magnitude = value.numerator.bit_length() - value.denominator.bit_length()
        if value and abs(magnitude) > _MOST_MAGNITUDE:
            what = "large" if magnitude > 0 else "close to zero"
            fail(self.report, "number-too-large", f"This number is too {what}: {rough(value)}.",
                 origin, help="Numbers from 1e-299 to 1e299 can be computed with; perhaps an "
                 "exponent or a unit is not the one that was meant.")  # fmt: skip
        return value

    def too_high(self, expr: Expression, exponent: Fraction) -> NoReturn:
        """Report a power that is beyond any use."""
        fail(self.report, "number-too-large", f"A power of {rough(exponent)} is beyond any use.",
             expr.origin, help="Use `exp`, or a smaller exponent.")  # fmt: skip

    def raised(self, term: Term, exponent: Fraction, expr: Expression) -> Term:
        """The dimension of a power."""
        if term is PURE:
            return PURE
        result = self.quantities.dimensions.power(term, exponent)
        for power in map(Fraction, (*result.known, *result.unknown.values())):
            if abs(power) > _MOST_POWER or power.denominator.bit_length() > _MOST_EXACT:
                self.too_high(expr, power)
        return result

    def divides_by_zero(self, expr: Expression) -> None:
        """Report a division by the number zero."""
        fail(self.report, "division-by-zero", f"`{expr.origin.text}` is zero and divides.",
             expr.origin, help="Change the divisor; a coefficient that may be zero belongs on the "
             "other side of the law.")  # fmt: skip

    def connective(self, expr: Binary, left: Expression, so_far: Typed, place: Place) -> Typed:
        """`and`, `or`."""
        a, s = so_far
        if s is not None:
            fail(self.report, "not-a-condition", f"`{left.origin.text}` is a number: a condition "
                 "is needed here.", left.origin, help="Compare it with something, as in `x > 0`."
                 )  # fmt: skip
        b = self.condition(expr.right, place)
        absorbing = self.truth_value(expr.op == "or")
        for one, other in ((a, b), (b, a)):
            if one.op is Op.NUM:
                return (absorbing if one is absorbing else other), None
        return self.pool.logic(expr.op, a, b), None

    def equivalence(self, expr: Binary, a: Expr, place: Place) -> Typed:
        """`==` and `!=` of two conditions."""
        b = self.condition(expr.right, place)
        pool = self.pool
        if a.op is Op.NUM and b.op is Op.NUM:
            return self.truth_value((a is b) == (expr.op == "==")), None
        if b.op is Op.NUM:
            a, b = b, a
        if a.op is Op.NUM:
            same = (a is pool.one) == (expr.op == "==")
            return (b if same else pool.logic("not", b)), None
        both = pool.logic("and", a, b)
        neither = pool.logic("and", pool.logic("not", a), pool.logic("not", b))
        same_truth = pool.logic("or", both, neither)
        return (same_truth if expr.op == "==" else pool.logic("not", same_truth)), None

    def power(self, base: tuple[Expr, Term], exponent: tuple[Expr, Term], expr: Expression
              ) -> tuple[Expr, Term]:  # fmt: skip
        """`a^b`: a whole power stays a product, a half is a root."""
        (a, s), (b, t) = base, exponent
        self.pure_exponent(t, expr)
        if b.op is not Op.NUM:
            if not self.quantities.pure(s, expr.origin, "the base of a variable power has no unit"):
                raise Skip
            return self.pool.fn("pow", a, b), PURE
        n = b.number
        if a.op is Op.NUM:
            self.number_power(a.number, n, expr)
        elif a.op is Op.ADD and len(a.args) == 1 and n.denominator == 1:
            self.number_power(a.coefficients[0], n, expr)
        if abs(n) > _MOST_POWER:
            self.too_high(expr, n)
        return self.checked(self.pool.fn("pow", a, b), expr), self.raised(s, n, expr)

    def pure_exponent(self, term: Term, expr: Expression) -> None:
        """An exponent has no unit."""
        if not self.quantities.pure(term, expr.origin, "an exponent has no unit"):
            raise Skip

    def number_power(self, base: Fraction, exponent: Fraction, expr: Expression) -> None:
        """Refuse powers of numbers that are no real number, or an absurdly long one."""
        if base == 0 and exponent < 0:
            self.divides_by_zero(expr)
        if base < 0 and exponent.denominator != 1:
            fail(self.report, "undefined-value", "A root of a negative number is not real.",
                 expr.origin, help="Change the base; `ssqrt` and `cbrt` take negative numbers."
                 )  # fmt: skip
        bits = max(base.numerator.bit_length(), base.denominator.bit_length())
        magnitude = abs(base.numerator.bit_length() - base.denominator.bit_length())
        if bits * abs(exponent) > _MOST_BITS or magnitude * abs(exponent) > _MOST_MAGNITUDE:
            fail(self.report, "number-too-large", f"{rough(base)} to the power {rough(exponent)} "
                 "is beyond all numbers of physics.", expr.origin,
                 help="Use a smaller exponent.")  # fmt: skip


def _plain(expr: Expression) -> bool:
    """Whether only numbers without a unit are written, as in `1/2`."""
    match expr:
        case Number():
            return expr.unit is None
        case Unary():
            return _plain(expr.operand)
        case Binary():
            return _plain(expr.left) and _plain(expr.right)
        case _:
            return False


def _firmer(left: Term, right: Term) -> Term:
    """Of two equal dimensions the one that is less of an unknown."""
    return right if left.unknown and not right.unknown else left


def _compared(op: str, a: Fraction, b: Fraction) -> bool:
    return {"<": a < b, "<=": a <= b, ">": a > b, ">=": a >= b, "==": a == b, "!=": a != b}[op]
