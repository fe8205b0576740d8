"""From the print tree to text: traversal, signs and brackets, the same in every notation."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from bondgraph.notation.formula import Formula, Shape, bottom_up
from bondgraph.text.tuples import NamedTuple

#: How tightly a text holds together; a part looser than its place wants gets brackets.
CHOICE, LOGIC, COMPARE, SUM, PRODUCT, UNARY, POWER, ATOM = range(8)


class Spelled(NamedTuple):
    """A text, how tightly it binds, and about how wide it is in em where it is typeset."""

    text: str
    level: int = ATOM
    width: float = 0.0


class Speller:
    """Spells formulas on one line of text, the way they are typed; a notation says what differs."""

    plus, minus, negative, times = " + ", " - ", "-", "*"
    power = "{}^{}"
    bracket = "({})"
    row = "{}"  # around several signs and terms that are one piece
    inner = POWER  # how tightly a factor has to hold together

    def __init__(self) -> None:
        self._done: dict[Formula, Spelled] = {}

    def spell(self, formula: Formula) -> Spelled:
        """The text of a formula, with how tightly it binds."""
        return self._done.get(formula) or bottom_up(formula, self._done, self.parts, self._spell)

    def parts(self, node: Formula) -> tuple[Formula, ...]:
        """What the text of a node is put together from."""
        return node.parts

    def _spell(self, node: Formula) -> Spelled:
        match node.shape:
            case Shape.NAME:
                return self._name(node)
            case Shape.NUMBER:
                return self.number(node.data)
            case Shape.SUM:
                return self._sum(node)
            case Shape.PRODUCT:
                return self._product(node)
            case Shape.CALL:
                return self._call(node)
            case Shape.RATE:
                return self._rate(node)
            case Shape.AREA:
                return self._area(node)
            case Shape.CHOICE:
                return self._choice(node)
            case Shape.COMPARE:
                return self._compare(node)
            case Shape.LOGIC:
                return self._logic(node)
            case Shape.ROOT:
                return self._root(node)

    def _texts(self, node: Formula) -> list[str]:
        """The parts without brackets."""
        return [self.spell(part).text for part in node.parts]

    def within(self, part: Formula, level: int) -> Spelled:
        """A part in a place that wants it to bind at `level`."""
        own = self.spell(part)
        if own.level >= level:
            return own
        return Spelled(self.bracket.format(own.text), ATOM, own.width + 0.8)

    # --------------------------------------------------------------- what may differ

    def number(self, value: Fraction) -> Spelled:
        """A rational that is not negative, as an exact quotient."""
        return Spelled(str(value), ATOM if value.denominator == 1 else PRODUCT)

    def _name(self, node: Formula) -> Spelled:
        """A name."""
        return Spelled(node.data)

    def terms(self, node: Formula) -> Iterable[tuple[Fraction, Formula]]:
        """The terms of a sum in the order of writing: the positive first, as a person does."""
        return sorted(zip(node.data, node.parts, strict=True), key=lambda term: term[0] < 0)

    def _sum(self, node: Formula) -> Spelled:
        """Terms with their signs."""
        text, width, level = "", 0.0, PRODUCT
        for c, part in self.terms(node):
            term = self.term(abs(c), part)
            lead = self.minus if c < 0 else self.plus
            if not text:
                lead = self.negative if c < 0 else ""
            if lead:
                level = SUM
            text += lead + term.text
            width += term.width + (1.2 if lead else 0)
        return Spelled(self.row.format(text), level, width)

    def term(self, size: Fraction, part: Formula) -> Spelled:
        """A term of a sum without its sign: a number above zero times something."""
        inner = self.within(part, PRODUCT)
        if size == 1:
            return inner
        number = self.number(size)
        text = number.text + self.times + inner.text
        return Spelled(text, PRODUCT, number.width + inner.width + 0.2)

    def _side(self, node: Formula, below: bool) -> list[tuple[Formula, int]]:
        """What stands above or below the bar of a fraction, each with its power."""
        pairs = zip(node.parts, node.data, strict=True)
        return [(part, abs(e)) for part, e in pairs if (e < 0) is below]

    def _factor(self, part: Formula, exponent: int) -> Spelled:
        """A factor with its power."""
        if exponent == 1:
            return self.within(part, self.inner)
        base = self.within(part, ATOM)
        return Spelled(self.power.format(base.text, exponent), POWER, base.width + 0.5)

    def _sides(self, node: Formula) -> tuple[list[str], list[str]]:
        """The factors above and below the bar."""
        above, below = (self._side(node, below) for below in (False, True))
        return [self._factor(*f).text for f in above], [self._factor(*f).text for f in below]

    def _product(self, node: Formula) -> Spelled:
        """Factors, and what they are divided by."""
        return self._quotient(*self._sides(node))

    def _quotient(self, above: list[str], below: list[str]) -> Spelled:
        """Texts of factors on a line, those below behind one slash."""
        text = self.times.join(above) or "1"
        if below:
            bottom = self.times.join(below)
            text += f"/{bottom}" if len(below) == 1 else f"/({bottom})"
        return Spelled(text, PRODUCT)

    def _call(self, node: Formula) -> Spelled:
        """A function of its arguments."""
        unit = " s" if node.data == "delay" else ""
        return Spelled(f"{node.data}({', '.join(self._texts(node))}{unit})")

    def _rate(self, node: Formula) -> Spelled:
        """A time derivative."""
        order = "" if node.data == 1 else f", {node.data}"
        return Spelled(f"D({self._texts(node)[0]}{order})")

    def _area(self, node: Formula) -> Spelled:
        """An integral, and where it begins unless that is zero."""
        return Spelled(f"Int({', '.join(self._texts(node))})")

    def _choice(self, node: Formula) -> Spelled:
        """One of two values."""
        return Spelled(f"if({', '.join(self._texts(node))})")

    def _compare(self, node: Formula) -> Spelled:
        """A comparison."""
        return Spelled(f" {node.data} ".join(self._texts(node)), COMPARE)

    def _logic(self, node: Formula) -> Spelled:
        """Conditions, joined or negated."""
        conditions = [f"({text})" for text in self._texts(node)]
        if node.data == "not":
            return Spelled(f"not {conditions[0]}", LOGIC)
        return Spelled(f" {node.data} ".join(conditions), LOGIC)

    def _root(self, node: Formula) -> Spelled:
        """`root(x, zero)`: the x at which the second vanishes."""
        return Spelled(f"root({', '.join(self._texts(node))})")
