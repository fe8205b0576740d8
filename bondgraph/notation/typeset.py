"""What typeset notations share: fractions, roots, dots, cases; their templates are what differs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import ClassVar

from bondgraph.ir.functions import FUNCTIONS
from bondgraph.notation.formula import Formula, Shape
from bondgraph.notation.speller import ATOM, COMPARE, POWER, PRODUCT, Spelled, Speller

#: The letter of a name, under so many dots for derivatives.
Letters = Callable[[str, int], Spelled]

_DOTS = 2  # more derivatives of a name become an exponent
_FRACTIONS = (2, 3, 4, 6, 8, 12)  # of small numbers: written as fractions rather than decimals
_NARROW = 3.0  # em, of what may be written twice
_AROUND: Mapping[object, float] = {None: 0.6, 2: 0.9, 3: 1.0}  # em, of bars, and of roots


def spoken(name: str) -> str:
    """A function as mathematicians call it, a table by its own name."""
    return (name in FUNCTIONS and FUNCTIONS[name].spoken) or name.rpartition(":")[2]


class Typeset(Speller, ABC):
    """Spells formulas in two dimensions, with `letters` for the names.

    `words` has the template of every sign: `fraction`, `e` (digits, power of ten), `dash` (the
    minus of an exponent), `times` (between factors), `pow`, `prime` (base, order), `d/dt` and
    `dn/dtn` (order), `area`, `root` (unknown, what vanishes), `cases` (condition, yes, no), `call`
    (name, arguments), `,`, `seconds`, `abs`, `sqrt`, `cbrt`, and of each comparison and logical
    operator.
    """

    inner = PRODUCT
    words: ClassVar[Mapping[str, str]]

    def __init__(self, letters: Letters) -> None:
        super().__init__()
        self.letters = letters

    def digits(self, text: str) -> str:
        """The digits of a number."""
        return text

    @abstractmethod
    def called(self, name: str) -> str:
        """The name of a function."""

    def d_dt(self, order: int) -> str:
        """The sign of the time derivative of some order."""
        return self.words["d/dt" if order == 1 else "dn/dtn"].format(order)

    def number(self, value: Fraction) -> Spelled:
        """A decimal where that is exact and short, else a fraction."""
        above, below = value.numerator, value.denominator
        text = str(above) if below == 1 else repr(float(value))
        small = below in _FRACTIONS and above < 12
        if small or (below != 1 and (Fraction(text) != value or len(text) > 8)):
            sides = [self.digits(str(side)) for side in (above, below)]
            size = 1 if small else max(len(str(above)), len(str(below)))
            return Spelled(self.words["fraction"].format(*sides), ATOM, 0.5 * size + 0.3)
        short = f"{float(value):.6g}"
        if (len(text) > 8 or "e" in text) and float(short) == value:
            text = short
        mantissa, _, power = text.partition("e")
        shown = "" if power and mantissa == "1" else self.digits(mantissa)
        if power:
            exponent = str(int(power)).replace("-", self.words["dash"])
            shown = self.words["e" if shown else "1e"].format(exponent, shown)
        return Spelled(shown, ATOM, 0.5 * len(text))

    def _name(self, node: Formula) -> Spelled:
        return self.letters(node.data, 0)

    def _product(self, node: Formula) -> Spelled:
        above, below = self._beside_bar(node, False), self._beside_bar(node, True)
        if below is None:
            return above._replace(level=PRODUCT) if above else self.number(Fraction(1))
        above = above or self.number(Fraction(1))
        sides = [self.row.format(side.text) for side in (above, below)]
        width = max(above.width, below.width) + 0.4
        return Spelled(self.words["fraction"].format(*sides), PRODUCT, width)

    def _beside_bar(self, node: Formula, below: bool) -> Spelled | None:
        """What stands above or below a bar, if there is one; a lone sum needs no brackets there."""
        side = self._side(node, below)
        if len(side) == 1 and side[0][1] == 1 and min(node.data) < 0:
            return self.spell(side[0][0])
        factors = [self._factor(*pair) for pair in side]
        if len(factors) < 2:
            return factors[0] if factors else None
        text = self.words["times"].join(factor.text for factor in factors)
        width = sum(factor.width + 0.17 for factor in factors)
        return Spelled(self.row.format(text), PRODUCT, width)

    def _call(self, node: Formula) -> Spelled:
        args = [self.spell(part) for part in node.parts]
        if node.data == "pow":
            base = self.within(node.parts[0], ATOM)
            text = self.words["pow"].format(base.text, args[1].text)
            return Spelled(text, POWER, base.width + 0.7 * args[1].width)
        if node.data == "delay":
            args[1] = args[1]._replace(text=self.words["seconds"].format(args[1].text))
        record = FUNCTIONS.get(node.data)
        if record is not None and record.odd is not None and args[0].width <= _NARROW:
            bars = self._function("abs", args)
            left, right = self.within(node.parts[0], PRODUCT), bars
            if isinstance(record.odd, str):
                left, right = self._function("sign", args), self._function(record.odd, [bars])
            text = self.row.format(left.text + right.text)
            return Spelled(text, PRODUCT, left.width + right.width)
        return self._function(node.data, args)

    def _function(self, name: str, args: list[Spelled]) -> Spelled:
        width = sum(arg.width for arg in args)
        if name in self.words:
            around = _AROUND[FUNCTIONS[name].inverse]
            return Spelled(self.words[name].format(args[0].text), ATOM, width + around)
        inner = self.words[","].join(arg.text for arg in args)
        text = self.words["call"].format(self.called(name), inner)
        return Spelled(text, POWER, width + 0.4 * len(args) + 0.5 * len(name) + 0.8)

    def _rate(self, node: Formula) -> Spelled:
        (part,), order = node.parts, node.data
        if part.shape is Shape.NAME and order <= _DOTS:
            return self.letters(part.data, order)
        inner = self.within(part, ATOM)
        if part.shape is Shape.NAME:
            return Spelled(self.words["prime"].format(inner.text, order), ATOM, inner.width + 0.9)
        return Spelled(self.row.format(self.d_dt(order) + inner.text), PRODUCT, inner.width + 1.2)

    def _area(self, node: Formula) -> Spelled:
        inner = self.within(node.parts[0], PRODUCT)
        text = self.words["area"].format(inner.text)
        if len(node.parts) == 1:
            return Spelled(self.row.format(text), PRODUCT, inner.width + 2.4)
        start = self.spell(node.parts[1])
        text = self.bracket.format(start.text + self.plus + text)
        return Spelled(text, ATOM, start.width + inner.width + 4.2)

    def _choice(self, node: Formula) -> Spelled:
        condition, yes, no = (self.spell(part) for part in node.parts)
        width = max(yes.width, no.width) + max(condition.width + 1, 2) + 2
        return Spelled(self.words["cases"].format(*self._texts(node)), ATOM, width)

    def _compare(self, node: Formula) -> Spelled:
        return self._joined(node.data, [self.spell(part) for part in node.parts])

    def _logic(self, node: Formula) -> Spelled:
        parts = [self.within(part, ATOM) for part in node.parts]
        if node.data == "not":
            text = self.row.format(self.words["not"] + parts[0].text)
            return Spelled(text, COMPARE, parts[0].width + 0.7)
        return self._joined(node.data, parts)

    def _joined(self, word: str, parts: list[Spelled]) -> Spelled:
        text = self.row.format(self.words[word].join(part.text for part in parts))
        return Spelled(text, COMPARE, sum(part.width for part in parts) + 1.2 * (len(parts) - 1))

    def _root(self, node: Formula) -> Spelled:
        text = self.words["root"].format(*self._texts(node))
        return Spelled(text, ATOM, self.spell(node.parts[0]).width)
