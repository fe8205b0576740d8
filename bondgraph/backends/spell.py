"""Expressions of the residual program as text: as few brackets as the language allows."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import assert_never

from bondgraph.backends.walk import is_written_out
from bondgraph.ir.program import (
    Choice,
    Compare,
    Condition,
    Const,
    Expression,
    Function,
    Logic,
    Mode,
    Product,
    Ref,
    Sum,
    integer_power,
)
from bondgraph.text.tuples import NamedTuple

# How tightly a text holds together; an operand looser than its place wants gets brackets.
_CHOICE, _LOGIC, _COMPARE, _SUM, _PRODUCT, _UNARY, _ATOM = range(7)
_Bound = tuple[str, int]


class Dialect(NamedTuple):
    """How one language writes what languages write differently; holes are `{0}`, `{1}`, ...

    `functions` has an entry for every function of `bondgraph.ir.expr.FUNCTIONS`, and for `power`
    (integer exponent), `table` and `root`; `equal` and `unequal` compare two reals, perhaps by a
    call.
    """

    constant: str
    choice: str
    conjunction: str
    disjunction: str
    negation: str
    equal: str
    unequal: str
    functions: Mapping[str, str]


class Speller:
    """Writes expressions in one dialect; `name` says how a value, how a mode is called."""

    def __init__(
        self,
        dialect: Dialect,
        name: Callable[[Ref | Mode], str],
        tables: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        self.dialect = dialect
        self.tables = tables
        self.name = name

    def expression(self, value: Expression) -> str:
        """The text of a value.

        >>> choice = "{1} if {0} else {2}"
        >>> plain = Dialect("{0}", choice, "and", "or", "not {0}", "{0} == {1}", "{0} != {1}", {})
        >>> a, b, c = (Ref("local", x) for x in "abc")
        >>> Speller(plain, lambda ref: ref.name).expression(
        ...     Product((Sum(((True, a), (False, Product((Const(2.0), b))))), b), (c,)))
        '(a - 2.0 * b) * b / c'
        """
        return self._value(value)[0]

    def condition(self, value: Condition) -> str:
        """The text of a condition."""
        return self._condition(value)[0]

    # ---------------------------------------------------------------------- values

    def _value(self, value: Expression) -> _Bound:
        negative, size = _signed(value)
        if negative:
            return "-" + self._within(size, _PRODUCT), _PRODUCT
        match size:
            case Const():
                return self.dialect.constant.format(digits(size.value)), _ATOM
            case Ref():
                return self.name(size), _ATOM
            case Sum():
                return self._sum(size)
            case Product():
                return self._product(size)
            case Function():
                return self._function(size)
            case Choice():
                condition = _bracket(self._condition(size.condition), _COMPARE)
                yes, no = self._within(size.yes, _SUM), self._within(size.no, _SUM)
                return self.dialect.choice.format(condition, yes, no), _CHOICE
            case _:
                assert_never(size)

    def _within(self, value: Expression, place: int) -> str:
        return _bracket(self._value(value), place)

    def _sum(self, value: Sum) -> _Bound:
        if not value.terms:
            return self.dialect.constant.format("0.0"), _ATOM
        (positive, first), *rest = value.terms
        # the first term may itself be a sum: it is read from the left anyway
        text = self._within(first if positive else Sum(((False, first),)), _SUM)
        for positive, term in rest:
            negative, size = _signed(term)
            text += " + " if positive is not negative else " - "
            text += self._within(size, _PRODUCT)
        return text, _SUM

    def _product(self, value: Product) -> _Bound:
        factors = [f for f in value.factors if f != Const(1.0)] or [Const(1.0)]
        if len(factors) == 1 and not value.divisors:
            return self._value(factors[0])
        text = self._within(factors[0], _PRODUCT)
        for factor in factors[1:]:
            text += " * " + self._within(factor, _ATOM)
        for divisor in value.divisors:
            text += " / " + self._within(divisor, _ATOM)
        return text, _PRODUCT

    def _function(self, value: Function) -> _Bound:
        functions, args = self.dialect.functions, value.args
        power = integer_power(value)
        if power is not None and is_written_out(value):
            return self._value(Product(args[:1] * power))
        if power is not None:
            return functions["power"].format(self.expression(args[0]), power), _ATOM
        texts = [self.expression(a) for a in args]
        if value.name.startswith("table:"):
            table = self.tables[value.name.removeprefix("table:")]
            return functions["table"].format(*texts, table), _ATOM
        if value.name.startswith("root:"):
            return functions["root"].format(", ".join(texts), self.tables[value.name]), _ATOM
        return functions[value.name].format(*texts), _ATOM

    # ------------------------------------------------------------------ conditions

    def _condition(self, value: Condition) -> _Bound:
        match value:
            case Compare():
                return self._compare(value, self.dialect.equal), _COMPARE
            case Logic():
                if value.op == "not":
                    (negated,) = value.args
                    if isinstance(negated, Compare) and negated.op == "==":
                        return self._compare(negated, self.dialect.unequal), _COMPARE
                    inner = _bracket(self._condition(negated), _ATOM)
                    return self.dialect.negation.format(inner), _UNARY
                word = self.dialect.conjunction if value.op == "and" else self.dialect.disjunction
                # brackets between `and` and `or` even where precedence has none: readers differ
                parts = [_bracket(self._condition(a), _COMPARE) for a in value.args]
                return f" {word} ".join(parts), _LOGIC
            case Mode():
                return self.name(value), _ATOM
            case _:
                assert_never(value)

    def _compare(self, value: Compare, equal: str) -> str:
        left, right = self._within(value.left, _SUM), self._within(value.right, _SUM)
        return equal.format(left, right) if value.op == "==" else f"{left} {value.op} {right}"


def _bracket(item: _Bound, place: int) -> str:
    text, bound = item
    return text if bound >= place else f"({text})"


def digits(value: float) -> str:
    """The shortest decimal that is this double again, always with a point.

    >>> digits(1.0), digits(1e-30), digits(0.1)
    ('1.0', '1.0e-30', '0.1')
    """
    text = repr(float(value))
    if "e" in text and "." not in text:
        text = text.replace("e", ".0e")
    return text


def _signed(value: Expression) -> tuple[bool, Expression]:
    """The value without the minus in front of it; changing a sign never rounds."""
    if isinstance(value, Const) and (value.value < 0):
        return True, Const(-value.value)
    if isinstance(value, Sum) and len(value.terms) == 1:
        positive, term = value.terms[0]
        negative, size = _signed(term)
        return negative is positive, size
    if isinstance(value, Product) and value.factors:
        negative, size = _signed(value.factors[0])
        if negative and not isinstance(size, Sum):
            return True, Product((size, *value.factors[1:]), value.divisors)
    return False, value
