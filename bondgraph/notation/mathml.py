"""Expressions in MathML, with about how wide each piece is."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from types import MappingProxyType

from bondgraph.notation.formula import Formula, Shape
from bondgraph.notation.typeset import Typeset, spoken


def escape(text: str) -> str:
    """Text that is safe between tags and in quotes."""
    for sign, safe in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;")):
        text = text.replace(sign, safe)
    return text


def sign(text: str, form: str = "infix") -> str:
    """An operator; its form keeps its spaces where it stands at the end of a piece."""
    return f'<mo form="{form}">{escape(text)}</mo>'


_OPEN, _SHUT = '<mo stretchy="true">(</mo>', '<mo stretchy="true">)</mo>'
_BAR = '<mo stretchy="true" form="{}">|</mo>'
_SPACE = "<mspace width='0.17em'/>"


class MathML(Typeset):
    """MathML; the value of an implicit number is its name, its equation stands elsewhere."""

    plus, minus, negative, times = sign("+"), sign("−"), sign("−", "prefix"), _SPACE
    power = "<msup><mrow>{}</mrow><mn>{}</mn></msup>"
    bracket = f"<mrow>{_OPEN}{{}}{_SHUT}</mrow>"
    row = "<mrow>{}</mrow>"
    words = MappingProxyType({
        "fraction": "<mfrac>{}{}</mfrac>",
        "1e": "<msup><mn>10</mn><mn>{0}</mn></msup>",
        "e": f"<mrow>{{1}}{sign('·')}<msup><mn>10</mn><mn>{{0}}</mn></msup></mrow>",
        "dash": "−",
        "times": _SPACE,
        "pow": "<msup><mrow>{}</mrow><mrow>{}</mrow></msup>",
        "prime": "<msup><mrow>{}</mrow><mrow><mo>(</mo><mn>{}</mn><mo>)</mo></mrow></msup>",
        "d/dt": "<mfrac><mi>d</mi><mrow><mi>d</mi><mi>t</mi></mrow></mfrac>",
        "dn/dtn": "<mfrac><msup><mi>d</mi><mn>{0}</mn></msup>"
        "<mrow><mi>d</mi><msup><mi>t</mi><mn>{0}</mn></msup></mrow></mfrac>",
        "area": '<msubsup><mo stretchy="false" largeop="true">∫</mo><mn>0</mn><mi>t</mi></msubsup>'
        f"{{}}{_SPACE}<mrow><mi>d</mi><mi>t</mi></mrow>",
        "root": "{0}",
        "cases": '<mrow><mo stretchy="true" form="prefix">{{</mo><mtable columnalign="left left">'
        "<mtr><mtd>{1}</mtd><mtd><mtext>if&#xa0;</mtext>{0}</mtd></mtr>"
        "<mtr><mtd>{2}</mtd><mtd><mtext>else</mtext></mtd></mtr></mtable></mrow>",
        "seconds": f"<mrow>{{}}{_SPACE}<mi>s</mi></mrow>",
        "call": f"<mrow>{{}}<mo>&#x2061;</mo><mrow>{_OPEN}{{}}{_SHUT}</mrow></mrow>",
        ",": '<mo separator="true">,</mo>',
        "abs": f"<mrow>{_BAR.format('prefix')}{{}}{_BAR.format('postfix')}</mrow>",
        "sqrt": "<msqrt>{}</msqrt>",
        "cbrt": "<mroot><mrow>{}</mrow><mn>3</mn></mroot>",
        "<": sign("<"), "<=": sign("≤"), "==": sign("="), "not": sign("¬", "prefix"),
        "and": sign("∧"), "or": sign("\N{LOGICAL OR}"),
    })  # fmt: skip

    def digits(self, text: str) -> str:
        """The digits as a number."""
        return f"<mn>{text}</mn>"

    def called(self, name: str) -> str:
        """The name as an identifier."""
        return f"<mi>{escape(spoken(name))}</mi>"

    def terms(self, node: Formula) -> Iterable[tuple[Fraction, Formula]]:
        """The terms with sums inside opened, the positive first."""
        found: list[tuple[Fraction, Formula]] = []
        open_ = list(zip(node.data, node.parts, strict=True))
        while open_:
            c, part = open_.pop(0)
            if part.shape is Shape.SUM:
                open_[:0] = [(c * k, p) for k, p in zip(part.data, part.parts, strict=True)]
            elif part.shape is Shape.NUMBER and abs(c) != 1:
                size = Formula(Shape.NUMBER, (), abs(c) * part.data)
                found.append((Fraction(1 if c > 0 else -1), size))
            else:
                found.append((c, part))
        return sorted(found, key=lambda term: term[0] < 0)
