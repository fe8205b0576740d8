"""Expressions of the residual program as text: as few brackets as the language allows."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from types import MappingProxyType
from typing import assert_never

from bondgraph.ir.program import (
    Choice,
    Compare,
    Condition,
    Const,
    Expression,
    First,
    Function,
    Logic,
    Mode,
    Product,
    Ref,
    Sum,
    called,
    integer_power,
)
from bondgraph.notation.formula import Formula, Shape
from bondgraph.notation.speller import (
    ATOM,
    CHOICE,
    COMPARE,
    LOGIC,
    PRODUCT,
    SUM,
    UNARY,
    Spelled,
    Speller,
)
from bondgraph.text.tuples import NamedTuple

#: Up to this exponent an integer power of a name is written as a product.
WRITTEN_POWER = 4


class Dialect(NamedTuple):
    """How one language writes what languages write differently; holes are `{0}`, `{1}`, ...

    `functions` has an entry for every function of `bondgraph.ir.expr.FUNCTIONS`, and for `power`
    (integer exponent), `table`, `map`, `inverse` and `root`; what it has not is called by its own
    name. `equal` and `unequal` compare two reals, perhaps by a call.
    """

    constant: str
    choice: str
    conjunction: str
    disjunction: str
    negation: str
    equal: str
    unequal: str
    functions: Mapping[str, str]


class Language(NamedTuple):
    """A dialect with the statements around it, as patterns of a name `{0}` and a value `{1}`.

    `local` makes a value, `assign` sets one that was `declared`: either side of a branch does,
    whose lines stand before, between and after the sides. A line that is empty is none.
    """

    dialect: Dialect
    local: str
    assign: str
    declared: str
    branch: tuple[str, str, str]


_ONE, _MINUS_ONE = Const(1.0), Const(-1.0)

#: No language: for who reads the program itself.
PLAIN = Dialect(
    "{0}", "if({0}, {1}, {2})", "and", "or", "not {0}", "{0} == {1}", "{0} != {1}", {}
)


def is_written_out(value: Function) -> bool:
    """Whether a power becomes a product: a small one, of a name."""
    power = integer_power(value)
    return power is not None and 0 < power <= WRITTEN_POWER and isinstance(value.args[0], Ref)


def digits(value: float) -> str:
    """The shortest decimal that is this double again, always with a point.

    >>> digits(1.0), digits(1e-30), digits(0.1)
    ('1.0', '1.0e-30', '0.1')
    """
    text = repr(float(value))
    if "e" in text and "." not in text:
        text = text.replace("e", ".0e")
    return text


def read(value: Expression | Condition) -> Formula:
    """The print tree of a value, with every sign in front; changing a sign never rounds.

    What is first is read from the left anyway: a sum in a sum, a product in a product is opened
    there, and nowhere else, since each operation rounds.
    """
    match value:
        case Ref() | Mode():
            return Formula(Shape.NAME, (), value)
        case Product():
            front, *others = [f for f in value.factors if f != _ONE] or [_ONE]
            if front == _MINUS_ONE and (others or value.divisors):
                return _sum([_signed(Product(tuple(others), value.divisors), -1)])
            sign, leading = _signed(front)
            factors = [(leading, 1), *[(read(f), 1) for f in others]]
            if leading.shape is Shape.PRODUCT:
                factors[:1] = zip(leading.parts, leading.data, strict=True)
            factors += [(read(d), -1) for d in value.divisors]
            if len(factors) == 1:
                return _sum([(sign, leading)])
            parts, exponents = zip(*factors, strict=True)
            return _sum([(sign, Formula(Shape.PRODUCT, parts, exponents))])
        case Sum():
            terms = [_signed(term, 1 if positive else -1) for positive, term in value.terms]
            sign, first = terms[0] if terms else (1, read(Const(0.0)))
            if sign > 0 and first.shape is Shape.SUM:
                return _sum([*zip(first.data, first.parts, strict=True), *terms[1:]])
            return _sum([(sign, first), *terms[1:]])
        case Const():
            negative = value.value < 0
            size = Formula(Shape.NUMBER, (), -value.value if negative else value.value)
            return _sum([(-1 if negative else 1, size)])
        case Function():
            power = integer_power(value)
            if power is not None and is_written_out(value):
                return read(Product(value.args[:1] * power))
            if power is not None:
                exponent = Formula(Shape.NAME, (), str(power))
                return Formula(Shape.CALL, (read(value.args[0]), exponent), "power")
            return Formula(Shape.CALL, tuple(map(read, value.args)), called(value))
        case Choice():
            parts = (read(value.condition), read(value.yes), read(value.no))
            return Formula(Shape.CHOICE, parts)
        case Compare():
            return Formula(Shape.COMPARE, (read(value.left), read(value.right)), value.op)
        case First():
            return Formula(Shape.NAME, (), "first")
        case Logic():
            return Formula(Shape.LOGIC, tuple(map(read, value.args)), value.op)
        case _:
            assert_never(value)


def _signed(value: Expression, sign: int = 1) -> tuple[int, Formula]:
    """The sign of a value, and its formula without the minus in front."""
    formula = read(value)
    if formula.shape is Shape.SUM and len(formula.parts) == 1:
        return -sign, formula.parts[0]
    return sign, formula


def _sum(terms: list[tuple[int, Formula]]) -> Formula:
    if len(terms) == 1 and terms[0][0] > 0:
        return terms[0][1]
    signs, parts = zip(*terms, strict=True)
    return Formula(Shape.SUM, parts, signs)


class CodeSpeller(Speller):
    """Spells values in one dialect, in the order in which they are computed.

    `name` says how a value, how a mode is called; `tables` are the names of tables and roots.
    """

    times = " * "

    def __init__(
        self,
        dialect: Dialect,
        name: Callable[[Ref | Mode], str],
        tables: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        super().__init__()
        self.dialect = dialect
        self.name = name
        self.tables = tables

    def expression(self, value: Expression | Condition) -> str:
        """The text of a value or of a condition.

        >>> a, b, c = (Ref("local", x) for x in "abc")
        >>> CodeSpeller(PLAIN, lambda ref: ref.name).expression(
        ...     Product((Sum(((True, a), (False, Product((Const(2.0), b))))), b), (c,)))
        '(a - 2.0 * b) * b / c'
        """
        return self.spell(read(value)).text

    def spell(self, formula: Formula) -> Spelled:
        """A statement is never deep, and has no part twice: nothing is kept."""
        return self._spell(formula)

    def number(self, value: Fraction | float) -> Spelled:
        """A constant of the language."""
        return Spelled(self.dialect.constant.format(digits(float(value))))

    def terms(self, node: Formula) -> Iterable[tuple[Fraction, Formula]]:
        """The terms in the order in which they are added."""
        return zip(node.data, node.parts, strict=True)

    def _name(self, node: Formula) -> Spelled:
        return Spelled(node.data if isinstance(node.data, str) else self.name(node.data))

    def _product(self, node: Formula) -> Spelled:
        text = self.within(node.parts[0], PRODUCT).text
        for part, e in zip(node.parts[1:], node.data[1:], strict=True):
            text += (" * " if e > 0 else " / ") + self.within(part, ATOM).text
        return Spelled(text, PRODUCT)

    def _call(self, node: Formula) -> Spelled:
        kind, _, which = node.data.partition(":")
        if kind not in self.dialect.functions:
            return super()._call(node)
        texts = self._texts(node)
        if kind in ("table", "map", "inverse"):
            texts.append(self.tables[which])
        if kind == "root":
            texts = [", ".join(texts), self.tables[node.data]]
        return Spelled(self.dialect.functions[kind].format(*texts))

    def _choice(self, node: Formula) -> Spelled:
        condition, yes, no = node.parts
        parts = self.within(condition, COMPARE), self.within(yes, SUM), self.within(no, SUM)
        return Spelled(self.dialect.choice.format(*[part.text for part in parts]), CHOICE)

    def _compare(self, node: Formula) -> Spelled:
        return self._compared(node, self.dialect.equal)

    def _compared(self, node: Formula, equal: str) -> Spelled:
        sides = [self.within(part, SUM).text for part in node.parts]
        template = equal if node.data == "==" else f"{{0}} {node.data} {{1}}"
        return Spelled(template.format(*sides), COMPARE)

    def _logic(self, node: Formula) -> Spelled:
        (first, *_), dialect = node.parts, self.dialect
        if node.data == "not" and first.shape is Shape.COMPARE and first.data == "==":
            return self._compared(first, dialect.unequal)
        if node.data == "not":
            return Spelled(dialect.negation.format(self.within(first, ATOM).text), UNARY)
        word = dialect.conjunction if node.data == "and" else dialect.disjunction
        # brackets between `and` and `or` even where precedence has none: readers differ
        return Spelled(f" {word} ".join(self.within(p, COMPARE).text for p in node.parts), LOGIC)
