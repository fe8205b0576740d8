"""Formulas wider than a line, opened at their sums: MathML itself never breaks a line."""

from __future__ import annotations

from bondgraph.ir.functions import FUNCTIONS
from bondgraph.notation.formula import Formula, Shape
from bondgraph.notation.mathml import MathML, escape, sign
from bondgraph.notation.speller import ATOM, PRODUCT

_DEEPEST = 40  # sums inside sums that are opened


def pieces(speller: MathML, formula: Formula, room: float) -> list[str]:
    """The MathML of a formula in pieces of at most about `room` em, in order.

    A line may end between any two. A fraction too wide becomes a product of a narrow fraction and
    its sums in parentheses. What cannot be opened stays wider.

    >>> from bondgraph.ir.expr import Kind, Pool
    >>> from bondgraph.notation.formula import Reader
    >>> from bondgraph.notation.speller import Spelled
    >>> p = Pool(); x, y = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR)
    >>> speller = MathML(lambda name, dots: Spelled(f"<mi>{name}</mi>", width=0.6))
    >>> pieces(speller, Reader().of(p.add((1, x), (-1, y))), room=1)
    ['<mi>x</mi>', '<mo form="infix">−</mo><mi>y</mi>']
    """
    return _Opener(speller, room).open(formula, 0)


class _Opener:
    def __init__(self, speller: MathML, room: float) -> None:
        self.speller = speller
        self.room = room

    def open(self, node: Formula, depth: int) -> list[str]:
        whole = self.speller.spell(node)
        if whole.width <= self.room or depth > _DEEPEST:
            return [whole.text]
        deeper = depth + 1
        match node.shape:
            case Shape.SUM:
                return self._sum(node, deeper)
            case Shape.PRODUCT:
                return self._product(node, deeper)
            case Shape.RATE:
                inner = self._closed(node.parts[0], deeper, ATOM)
                return _around(self.speller.d_dt(node.data), inner, "")
            case Shape.AREA:
                return self._integral(node, deeper)
            case Shape.CALL:
                return self._function(node, deeper)
            case Shape.CHOICE:
                return self._choice(node, deeper)
            case Shape.COMPARE | Shape.LOGIC if len(node.parts) > 1:
                parts = [self._closed(part, deeper) for part in node.parts]
                after = [_around(self.speller.words[node.data], p, "") for p in parts[1:]]
                return [*parts[0], *[piece for part in after for piece in part]]
            case _:
                return [whole.text]

    def _closed(self, node: Formula, depth: int, level: int = PRODUCT) -> list[str]:
        """The pieces, between parentheses unless they bind at `level`.

        What fits has parentheses of its own height.
        """
        whole = self.speller.spell(node)
        if whole.level >= level:
            return self.open(node, depth)
        if whole.width <= self.room:
            return [self.speller.within(node, level).text]
        return _around(_OPEN, self.open(node, depth), _SHUT)

    def _sum(self, node: Formula, depth: int) -> list[str]:
        found: list[str] = []
        for c, part in self.speller.terms(node):
            whole = self.speller.spell(part)
            lead = sign("−" if c < 0 else "+", "infix" if found else "prefix")
            lead = lead if found or c < 0 else ""
            if whole.width <= self.room or part.shape is Shape.NUMBER:
                found.append(lead + self.speller.term(abs(c), part).text)
                continue
            if abs(c) != 1:
                lead += self.speller.number(abs(c)).text + self.speller.times
            found += _around(lead, self.open(part, depth), "")
        return found

    def _product(self, node: Formula, depth: int) -> list[str]:
        """Narrow factors as a fraction of their own, then the wide ones one after the other."""
        narrow: list[tuple[Formula, int]] = []
        wide: list[tuple[Formula, int]] = []
        for part, e in zip(node.parts, node.data, strict=True):
            fits = self.speller.spell(part).width <= self.room / 3
            (narrow if fits else wide).append((part, e))
        found: list[str] = []
        if narrow:
            parts, exponents = zip(*narrow, strict=True)
            found.append(self.speller.spell(Formula(Shape.PRODUCT, parts, exponents)).text)
        for part, e in wide:
            inner = self._closed(part, depth, PRODUCT if e == 1 else ATOM)
            if len(inner) == 1 and e < 0:
                found.append(f"<mfrac><mn>1</mn><mrow>{inner[0]}{_raised(-e)}</mrow></mfrac>")
            else:
                found += _around("", inner, _raised(e))
        return found

    def _integral(self, node: Formula, depth: int) -> list[str]:
        integral = '<msubsup><mo stretchy="false">∫</mo><mn>0</mn><mi>t</mi></msubsup>'
        inner = _around(_OPEN, self.open(node.parts[0], depth), _SHUT)
        body = _around(integral, inner, "<mrow><mi>d</mi><mi>t</mi></mrow>")
        if len(node.parts) == 1:
            return body
        start = self.speller.spell(node.parts[1]).text
        return [_OPEN + start, *_around(sign("+"), body, _SHUT)]

    def _function(self, node: Formula, depth: int) -> list[str]:
        parts = [self.open(part, depth) for part in node.parts]
        if node.data == "delay":
            parts[1] = [self.speller.words["seconds"].format(*parts[1])]
        for part in parts[:-1]:
            part[-1] += self.speller.words[","]
        inner = [piece for part in parts for piece in part]
        if node.data == "abs":
            bar = '<mo stretchy="false" form="{}">|</mo>'
            return _around(bar.format("prefix"), inner, bar.format("postfix"))
        undone = FUNCTIONS[node.data].inverse if node.data in FUNCTIONS else None
        if isinstance(undone, int):
            return _around(_OPEN, inner, _root(undone))
        return _around(self.speller.called(node.data) + _OPEN, inner, _SHUT)

    def _choice(self, node: Formula, depth: int) -> list[str]:
        """The two values in a line, which ends where the formula does or at a parenthesis."""
        found: list[str] = []
        for word, part in zip(("if ", "then ", "else "), node.parts, strict=True):
            found += _around(_words(word), self.open(part, depth), "")
        return found if depth == 1 else _around(_OPEN, found, _SHUT)


_OPEN = '<mo stretchy="false" form="prefix">(</mo>'
_SHUT = '<mo stretchy="false" form="postfix">)</mo>'


def _words(text: str) -> str:
    return f"<mtext>{escape(text).replace(' ', '&#xa0;')}</mtext>"


def _root(order: int) -> str:
    power = f"<mrow><mn>1</mn><mo>/</mo><mn>{order}</mn></mrow>"
    return f'<msup><mo stretchy="false" form="postfix">)</mo>{power}</msup>'


def _raised(e: int) -> str:
    """An exponent behind a closed parenthesis."""
    shown = str(e).replace("-", "−")
    return "" if e == 1 else f"<msup><mrow></mrow><mn>{shown}</mn></msup>"


def _around(before: str, inner: list[str], after: str) -> list[str]:
    """The pieces with something that stays on the lines of the first and the last."""
    found = list(inner)
    found[0] = before + found[0]
    found[-1] += after
    return found
