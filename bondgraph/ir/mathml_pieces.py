"""Formulas wider than a line, opened at their sums: MathML itself never breaks a line."""

from __future__ import annotations

from bondgraph.ir.expr import Expr, Op
from bondgraph.ir.mathml import Typist, called, d_dt, escape, sign, term

_DEEPEST = 40  # sums inside sums that are opened


def pieces(typist: Typist, expr: Expr, room: float, own: bool = False) -> list[str]:
    """The MathML of an expression in pieces of at most about `room` em, in order.

    A line may end between any two. A fraction too wide becomes a product of a narrow fraction and
    its sums in parentheses. What cannot be opened stays wider. `own`: as for `Typist.box`.

    >>> from bondgraph.ir.expr import Kind, Pool
    >>> from bondgraph.ir.mathml import atom
    >>> p = Pool(); x, y = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR)
    >>> typist = Typist(lambda name, dots: atom(f"<mi>{name}</mi>", 0.6))
    >>> pieces(typist, p.add((1, x), (-1, y)), room=1)
    ['<mi>x</mi>', '<mo form="infix">−</mo><mi>y</mi>']
    """
    return _Opener(typist, room).open(expr, own, 0)


class _Opener:
    def __init__(self, typist: Typist, room: float) -> None:
        self.typist = typist
        self.room = room

    def open(self, expr: Expr, own: bool, depth: int) -> list[str]:
        box = self.typist.box(expr, own)
        named = expr in self.typist.named and not own
        if box.width <= self.room or named or depth > _DEEPEST:
            return [box.xml]
        deeper = depth + 1
        match expr.op:
            case Op.ADD:
                return self._sum(expr, deeper)
            case Op.MUL:
                return self._product(expr, deeper)
            case Op.DER:
                inner, order = expr.args[0], 1
                while inner.op is Op.DER and inner not in self.typist.named:
                    inner, order = inner.args[0], order + 1
                return _around(d_dt(order), self._closed(inner, deeper, 2), "")
            case Op.INT:
                return self._integral(expr, deeper)
            case Op.FN:
                return self._function(expr, deeper)
            case Op.IF:
                return self._choice(expr, deeper)
            case Op.CMP | Op.LOGIC if len(expr.args) > 1:
                shown = {"<": "<", "<=": "≤", "==": "=", "and": "∧"}.get(expr.name, "or")
                parts = [self._closed(a, deeper) for a in expr.args]
                after = [_around(sign(shown), p, "") for p in parts[1:]]
                return [*parts[0], *[piece for part in after for piece in part]]
            case _:
                return [box.xml]

    def _closed(self, expr: Expr, depth: int, level: int = 1) -> list[str]:
        """The pieces, between parentheses unless they bind at `level` (1: factor, 2: atom).

        What fits has parentheses of its own height.
        """
        box = self.typist.box(expr)
        if box.level >= level:
            return self.open(expr, False, depth)
        if box.width <= self.room:
            return [f'<mrow><mo stretchy="true">(</mo>{box.xml}<mo stretchy="true">)</mo></mrow>']
        return _around(_OPEN, self.open(expr, False, depth), _SHUT)

    def _sum(self, expr: Expr, depth: int) -> list[str]:
        found: list[str] = []
        for c, arg in self.typist.terms(expr):
            box = self.typist.box(arg)
            minus = (c < 0) != (arg.op is Op.NUM and arg.number < 0)
            lead = sign("−" if minus else "+", "infix" if found else "prefix")
            lead = lead if found or minus else ""
            if box.width <= self.room or arg.op is Op.NUM:
                found.append(lead + term(abs(c), arg, box).xml)
                continue
            if abs(c) != 1:
                lead += term(abs(c), arg, box._replace(xml="", level=2)).xml
            found += _around(lead, self.open(arg, False, depth), "")
        return found

    def _product(self, expr: Expr, depth: int) -> list[str]:
        """Narrow factors as a fraction of their own, then the wide ones one after the other."""
        narrow: list[tuple[Expr, int]] = []
        wide: list[tuple[Expr, int]] = []
        for arg, e in zip(expr.args, expr.exponents, strict=True):
            fits = self.typist.box(arg).width <= self.room / 3
            (narrow if fits else wide).append((arg, e))
        found: list[str] = []
        if narrow:
            found.append(self._fraction(narrow))
        for arg, e in wide:
            part = self._closed(arg, depth, 1 if e == 1 else 2)
            if len(part) == 1 and e < 0:
                found.append(f"<mfrac><mn>1</mn><mrow>{part[0]}{_raised(-e)}</mrow></mfrac>")
            elif e == 1:
                found += part
            else:
                found += _around("", part, _raised(e))
        return found

    def _fraction(self, factors: list[tuple[Expr, int]]) -> str:
        boxes = [(self.typist.box(a), e) for a, e in factors]

        def side(ones: list[tuple[str, int]]) -> str:
            return "<mspace width='0.17em'/>".join(
                xml if e == 1 else f"<msup><mrow>{xml}</mrow><mn>{e}</mn></msup>" for xml, e in ones
            )

        safe = [(b.xml if b.level == 2 else f"<mrow><mo>(</mo>{b.xml}<mo>)</mo></mrow>", e)
                for b, e in boxes]  # fmt: skip
        above = side([(xml, e) for xml, e in safe if e > 0])
        below = side([(xml, -e) for xml, e in safe if e < 0])
        if not below:
            return f"<mrow>{above}</mrow>"
        return f"<mfrac><mrow>{above or '<mn>1</mn>'}</mrow><mrow>{below}</mrow></mfrac>"

    def _integral(self, expr: Expr, depth: int) -> list[str]:
        integral = '<msubsup><mo stretchy="false">∫</mo><mn>0</mn><mi>t</mi></msubsup>'
        inner = _around(_OPEN, self.open(expr.args[0], False, depth), _SHUT)
        body = _around(integral, inner, "<mrow><mi>d</mi><mi>t</mi></mrow>")
        start = self.typist.start(expr)
        if start is None:
            return body
        return [_OPEN + start.xml, *_around(sign("+"), body, _SHUT)]

    def _function(self, expr: Expr, depth: int) -> list[str]:
        parts = [self.open(a, False, depth) for a in expr.args]
        for part in parts[:-1]:
            part[-1] += '<mo separator="true">,</mo>'
        inner = [piece for part in parts for piece in part]
        match expr.name:
            case "abs":
                bar = '<mo stretchy="false" form="{}">|</mo>'
                return _around(bar.format("prefix"), inner, bar.format("postfix"))
            case "sqrt":
                return _around(_OPEN, inner, _root(2))
            case "cbrt":
                return _around(_OPEN, inner, _root(3))
            case _:
                return _around(called(expr.name) + _OPEN, inner, _SHUT)

    def _choice(self, expr: Expr, depth: int) -> list[str]:
        condition, yes, no = (self.open(a, False, depth) for a in expr.args)
        return [
            *_around(_words("if "), condition, ""),
            *_around(_words("then "), yes, ""),
            *_around(_words("else "), no, ""),
        ]


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
