"""Expressions in MathML, in pieces between which a line may end."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction

from bondgraph.ir.expr import Expr, Op, Symbol, topological
from bondgraph.text.tuples import NamedTuple

_SUM, _PRODUCT, _ATOM = range(3)
_NARROW = 3.0  # em, of what may be written twice
_SPEAKING = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "sign": "sgn", "log": "ln"}
_MINUS = "−"


class Box(NamedTuple):
    """A piece of mathematics: its elements, how tightly it binds, about how wide it is in em."""

    xml: str
    level: int
    width: float


Letters = Callable[[str, int], Box]


def atom(xml: str, width: float) -> Box:
    """A box that needs no parentheses."""
    return Box(xml, _ATOM, width)


def escape(text: str) -> str:
    """Text that is safe between tags and in quotes."""
    for sign, safe in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;")):
        text = text.replace(sign, safe)
    return text


def sign(text: str, form: str = "infix") -> str:
    """An operator; its form keeps its spaces where it stands at the end of a piece."""
    return f'<mo form="{form}">{escape(text)}</mo>'


_OPEN, _SHUT = '<mo stretchy="true">(</mo>', '<mo stretchy="true">)</mo>'


def _wrap(box: Box, level: int) -> Box:
    if box.level >= level:
        return box
    return atom(f"<mrow>{_OPEN}{box.xml}{_SHUT}</mrow>", box.width + 0.8)


def number(value: Fraction) -> Box:
    """A rational: a decimal where that is exact and short, else a fraction."""
    text = str(value.numerator)
    if value.denominator in (2, 3, 4, 6, 8, 12) and abs(value.numerator) < 12:
        found = atom(
            f"<mfrac><mn>{abs(value.numerator)}</mn><mn>{value.denominator}</mn></mfrac>", 0.8
        )
        return found if value > 0 else _negative(found)
    if value.denominator != 1:
        text = repr(float(value))
        if Fraction(text) != value or len(text) > 8:
            size = max(len(str(abs(value.numerator))), len(str(value.denominator)))
            above, below = abs(value.numerator), value.denominator
            found = atom(f"<mfrac><mn>{above}</mn><mn>{below}</mn></mfrac>", 0.5 * size + 0.3)
            return found if value > 0 else _negative(found)
    if len(text.lstrip("-")) > 8 or "e" in text:
        text = f"{float(value):.6g}" if float(f"{float(value):.6g}") == value else text
    digits, _, power = text.lstrip("-").partition("e")
    xml = f"<mn>{digits}</mn>"
    if power:
        shown = str(int(power)).replace("-", _MINUS)
        raised = f"<msup><mn>10</mn><mn>{shown}</mn></msup>"
        xml = raised if digits == "1" else f"<mrow>{xml}{sign('·')}{raised}</mrow>"
    found = atom(xml, 0.5 * len(text))
    return found if value >= 0 else _negative(found)


def _negative(box: Box) -> Box:
    return Box(f"<mrow>{sign(_MINUS, 'prefix')}{box.xml}</mrow>", _SUM, box.width + 0.6)


class Typist:
    """Sets expressions: `letters` gives the box of a name with 0 to 2 dots for derivatives.

    `named` nodes stand for themselves, as letters of these names.

    `starts` are the values from which integrals begin, as for `show`.
    """

    def __init__(
        self,
        letters: Letters,
        named: Mapping[Expr, str] | None = None,
        starts: Mapping[Symbol, Expr] | None = None,
    ) -> None:
        self.letters = letters
        self.named = dict(named or {})
        self.starts = starts or {}
        self._boxes: dict[Expr, Box] = {}

    def box(self, expr: Expr, own: bool = False) -> Box:
        """The expression in one piece; its `own` name is not used."""
        if own and expr in self.named:
            return self._of(expr, [self.box(a) for a in expr.args])
        stop = self._boxes.keys() | self.named.keys()
        for node in topological([expr], stop=stop.__contains__):
            if node not in self._boxes:
                name = self.named.get(node)
                boxes = [self._boxes[a] for a in node.args] if name is None else []
                self._boxes[node] = self._of(node, boxes) if name is None else self.letters(name, 0)
        return self._boxes[expr]

    def _of(self, node: Expr, args: list[Box]) -> Box:
        match node.op:
            case Op.NUM:
                return number(node.number)
            case Op.SYM:
                return self.letters(node.symbol.name, 0)
            case Op.ADD:
                return self._sum(node)
            case Op.MUL:
                return _product(node, args)
            case Op.DER:
                return self._derivative(node)
            case Op.INT:
                return self._integral(node, args[0])
            case Op.ROOT:
                return self.letters(node.root.name, 0)
            case Op.FN:
                return _function(node.name, args)
            case Op.IF:
                return _cases(args)
            case Op.CMP:
                shown = {"<": "<", "<=": "≤", "==": "="}[node.name]
                return _joined(args, shown, _SUM)
            case Op.LOGIC:
                if node.name == "not":
                    inner = _wrap(args[0], _ATOM)
                    return Box(f"<mrow>{sign('¬', 'prefix')}{inner.xml}</mrow>", _SUM,
                               inner.width + 0.7)  # fmt: skip
                return _joined([_wrap(a, _ATOM) for a in args],
                               "∧" if node.name == "and" else "\N{LOGICAL OR}", _SUM)  # fmt: skip

    def terms(self, node: Expr) -> list[tuple[Fraction, Expr]]:
        """The terms of a sum as a person writes them: sums inside opened, the positive first."""
        found: list[tuple[Fraction, Expr]] = []
        open_ = [(Fraction(c), a) for c, a in zip(node.coefficients, node.args, strict=True)]
        while open_:
            c, arg = open_.pop(0)
            if arg.op is Op.ADD and arg not in self.named:
                inner = zip(arg.coefficients, arg.args, strict=True)
                open_[:0] = [(c * k, a) for k, a in inner]
            else:
                found.append((c, arg))
        return sorted(found, key=lambda t: t[0] * _sign(t[1]) < 0)

    def _sum(self, node: Expr) -> Box:
        parts: list[str] = []
        width = 0.0
        terms = self.terms(node)
        for c, arg in terms:
            minus = c * _sign(arg) < 0
            box = term(abs(c), arg, self.box(arg))
            if parts or minus:
                parts.append(sign(_MINUS if minus else "+", "infix" if parts else "prefix"))
                width += 1.2
            parts.append(box.xml)
            width += box.width
        alone = len(terms) == 1 and terms[0][0] > 0
        return Box(f"<mrow>{''.join(parts)}</mrow>", _PRODUCT if alone else _SUM, width)

    def inside(self, node: Expr) -> Typist:
        """Who sets what vanishes at the number that a ROOT node is."""
        root = node.root
        inside = Typist(self.letters, {}, self.starts)
        inside._boxes[root.unknown] = self.letters(root.name, 0)
        for place, arg in zip(root.places, node.args, strict=True):
            inside._boxes[place] = self.box(arg)
        return inside

    def _derivative(self, node: Expr) -> Box:
        inner, order = node.args[0], 1
        while inner.op is Op.DER and inner not in self.named:
            inner, order = inner.args[0], order + 1
        box = self.box(inner)
        name = self.named.get(inner)
        if name is None and inner.op is Op.SYM:
            name = inner.symbol.name
        if name is not None and order <= 2:
            return self.letters(name, order)
        if name is not None:
            raised = f"<mrow><mo>(</mo><mn>{order}</mn><mo>)</mo></mrow>"
            return atom(f"<msup>{_one(box.xml)}{raised}</msup>", box.width + 0.9)
        inner_box = _wrap(box, _ATOM)
        return Box(f"<mrow>{d_dt(order)}{inner_box.xml}</mrow>", _PRODUCT, inner_box.width + 1.2)

    def _integral(self, node: Expr, inner: Box) -> Box:
        body = _wrap(inner, _PRODUCT)
        area = f"{_FROM_ZERO}{body.xml}{_DT}"
        start = self.start(node)
        if start is None:
            return Box(f"<mrow>{area}</mrow>", _PRODUCT, body.width + 2.4)
        xml = f"<mrow>{_OPEN}{start.xml}{sign('+')}{area}{_SHUT}</mrow>"
        return atom(xml, body.width + start.width + 4.2)

    def start(self, node: Expr) -> Box | None:
        """What an integral begins from; None where that is zero."""
        value = self.starts.get(node.symbol)
        if value is None:
            return None if node.symbol.name == "0" else self.letters(node.symbol.name, 0)
        return None if value.op is Op.NUM and not value.number else self.box(value)


_DT = "<mspace width='0.17em'/><mrow><mi>d</mi><mi>t</mi></mrow>"
_FROM_ZERO = '<msubsup><mo stretchy="false" largeop="true">∫</mo><mn>0</mn><mi>t</mi></msubsup>'


def d_dt(order: int) -> str:
    """The sign of the time derivative of some order."""
    power = "" if order == 1 else f"<mn>{order}</mn>"
    above = f"<msup><mi>d</mi>{power}</msup>" if power else "<mi>d</mi>"
    time = f"<msup><mi>t</mi>{power}</msup>" if power else "<mi>t</mi>"
    return f"<mfrac>{above}<mrow><mi>d</mi>{time}</mrow></mfrac>"


def _one(xml: str) -> str:
    """The elements as one element."""
    return f"<mrow>{xml}</mrow>"


def term(size: Fraction, arg: Expr, box: Box) -> Box:
    """One term of a sum without its sign: a number above zero times something."""
    if arg.op is Op.NUM:
        return number(size * abs(arg.number))
    inner = _wrap(box, _PRODUCT)
    if size == 1:
        return inner
    times = number(size)
    xml = f"{times.xml}<mspace width='0.17em'/>{inner.xml}"
    return Box(xml, _PRODUCT, times.width + inner.width + 0.2)


def _sign(arg: Expr) -> int:
    """Of a number in a sum its own sign, of anything else plus."""
    return -1 if arg.op is Op.NUM and arg.number < 0 else 1


def _power(box: Box, exponent: int) -> Box:
    if exponent == 1:
        return _wrap(box, _PRODUCT)
    inner = _wrap(box, _ATOM)
    return atom(f"<msup>{_one(inner.xml)}<mn>{exponent}</mn></msup>", inner.width + 0.5)


def _side(boxes: list[Box]) -> Box:
    if len(boxes) == 1:
        return boxes[0]
    inner = [_wrap(b, _PRODUCT) for b in boxes]
    xml = "<mspace width='0.17em'/>".join(b.xml for b in inner)
    width = sum(b.width for b in inner) + 0.17 * len(inner)
    return Box(f"<mrow>{xml}</mrow>", _PRODUCT, width)


def _product(node: Expr, args: list[Box]) -> Box:
    above, below = sides(node, args)
    if not below:
        return _side(above)._replace(level=_PRODUCT)
    one = Box("<mn>1</mn>", _ATOM, 0.5)
    top = above[0] if len(above) == 1 else _side(above) if above else one
    bottom = below[0] if len(below) == 1 else _side(below)
    xml = f"<mfrac>{_one(top.xml)}{_one(bottom.xml)}</mfrac>"
    return Box(xml, _PRODUCT, max(top.width, bottom.width) + 0.4)


def sides(node: Expr, args: list[Box]) -> tuple[list[Box], list[Box]]:
    """The factors above and below the bar of a fraction; a lone sum is left without parentheses."""
    above = [(b, e) for b, e in zip(args, node.exponents, strict=True) if e > 0]
    below = [(b, -e) for b, e in zip(args, node.exponents, strict=True) if e < 0]
    return _lone(above), _lone(below)


def _lone(factors: list[tuple[Box, int]]) -> list[Box]:
    if len(factors) == 1 and factors[0][1] == 1:
        return [factors[0][0]]
    return [_power(box, e) for box, e in factors]


def _joined(args: Iterable[Box], between: str, level: int) -> Box:
    boxes = list(args)
    xml = sign(between).join(b.xml for b in boxes)
    return Box(f"<mrow>{xml}</mrow>", level, sum(b.width for b in boxes) + 1.2 * (len(boxes) - 1))


def called(name: str) -> str:
    """The name of a function as it is set."""
    return f"<mi>{escape(_SPEAKING.get(name, name.split(':')[-1]))}</mi>"


def _function(name: str, args: list[Box]) -> Box:
    inner, width = args[0].xml, args[0].width
    match name:
        case "abs":
            bar = '<mo stretchy="true" form="{}">|</mo>'
            xml = f"<mrow>{bar.format('prefix')}{inner}{bar.format('postfix')}</mrow>"
            return atom(xml, width + 0.6)
        case "sqrt":
            return atom(f"<msqrt>{inner}</msqrt>", width + 0.9)
        case "ssq" | "ssqrt" if width <= _NARROW:
            bars = _function("abs", args)
            if name == "ssq":
                xml = f"<mrow>{_wrap(args[0], _PRODUCT).xml}{bars.xml}</mrow>"
                return Box(xml, _PRODUCT, 2 * width + 0.6)
            root = _function("sqrt", [bars])
            side = _function("sign", args)
            return Box(f"<mrow>{side.xml}{root.xml}</mrow>", _PRODUCT, side.width + root.width)
        case "cbrt":
            return atom(f"<mroot>{_one(inner)}<mn>3</mn></mroot>", width + 1)
        case "pow":
            base = _wrap(args[0], _ATOM)
            return atom(f"<msup>{_one(base.xml)}{_one(args[1].xml)}</msup>",
                        base.width + 0.7 * args[1].width)  # fmt: skip
        case _:
            inner = '<mo separator="true">,</mo>'.join(a.xml for a in args)
            width = sum(a.width for a in args) + 0.4 * len(args)
            shown = called(name)
            xml = f"<mrow>{shown}<mo>&#x2061;</mo><mrow>{_OPEN}{inner}{_SHUT}</mrow></mrow>"
            return Box(xml, _PRODUCT, width + 0.5 * len(name) + 0.8)


def _cases(args: list[Box]) -> Box:
    condition, yes, no = args
    rows = (
        f"<mtr><mtd>{yes.xml}</mtd><mtd><mtext>if&#xa0;</mtext>{condition.xml}</mtd></mtr>"
        f"<mtr><mtd>{no.xml}</mtd><mtd><mtext>else</mtext></mtd></mtr>"
    )
    brace = '<mo stretchy="true" form="prefix">{</mo>'
    width = max(yes.width, no.width) + max(condition.width + 1, 2) + 2
    table = f'<mtable columnalign="left left">{rows}</mtable>'
    return atom(f"<mrow>{brace}{table}</mrow>", width)
