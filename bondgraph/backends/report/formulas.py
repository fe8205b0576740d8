"""Formulas of a model as HTML: MathML in pieces, so that long ones wrap like text."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from bondgraph.algebra.present import Parts
from bondgraph.ir.expr import Expr, Op, Symbol, topological
from bondgraph.notation.formula import Reader
from bondgraph.notation.lettering import Letter, Spare, letters, split_name
from bondgraph.notation.line_breaks import pieces
from bondgraph.notation.mathml import MathML, escape, sign
from bondgraph.notation.speller import Spelled

ROOM = 30.0  # em, of a piece that is not broken
_NESTED = 3  # fractions, integrals and the like inside each other, before one gets a name


class Typesetter:
    """Sets formulas in the letters of one model: `names` are all names that may occur."""

    def __init__(self, names: Iterable[str], starts: Mapping[Symbol, Expr]) -> None:
        self.letters = letters(dict.fromkeys(names))
        self.starts = starts

    def name(self, path: str, dots: int = 0) -> Spelled:
        """A name of the model, under dots for derivatives; the element carries the name itself."""
        letter = self.letters.get(path) or Letter(*split_name(path), ())
        base = f"<mi>{escape(letter.base)}</mi>"
        if dots:
            over = "˙" if dots == 1 else "¨"
            base = f'<mover accent="true">{base}<mo stretchy="false">{over}</mo></mover>'
        width = 0.6 * len(letter.base)
        below = [part for part in (letter.below, " ".join(letter.where)) if part]
        if not below:
            return Spelled(f'<mrow data-name="{escape(path)}">{base}</mrow>', width=width)
        text = escape(", ".join(below)).replace(" ", "&#x202f;")
        index = f'<mtext class="index">{text}</mtext>'
        width += 0.36 * sum(map(len, below)) + 0.2 * len(below)
        return Spelled(f'<msub data-name="{escape(path)}">{base}{index}</msub>', width=width)

    def inline(self, path: str) -> str:
        """A name in running text."""
        return f"<math>{self.name(path).text}</math>"

    def equations(self, head: str, parts: Parts, room: float = ROOM) -> list[str]:
        """`head` = the relation, and one line for each part that has a name, outermost first."""
        named = readable(parts)
        reader, speller = Reader(named, self.starts), MathML(self.name)
        lines = [_row(head, pieces(speller, reader.definition(parts.root), room))]
        for node in reversed(parts.order):
            if node in named and node is not parts.root:
                head = self.name(named[node]).text
                if node.op is Op.ROOT:  # no formula gives it: where it makes an expression vanish
                    head = f"{head}<mtext>&#xa0;where&#xa0;</mtext><mn>0</mn>"
                    part = reader.vanishing(node, named[node])
                else:
                    part = reader.definition(node)
                lines.append(_row(head, pieces(speller, part, room)))
        return lines

    def assigned(self, variable: str, value: Expr, room: float = ROOM) -> str:
        """`variable` = `value`, all on its own."""
        return self._line(self.name(variable).text, value, room)

    def vanishing(self, zero: Expr) -> str:
        """0 = `zero`."""
        return self._line("<mn>0</mn>", zero, ROOM)

    def continued(self, value: Expr) -> str:
        """= `value`, below an equation."""
        return self._line("", value, ROOM)

    def _line(self, head: str, value: Expr, room: float) -> str:
        formula = Reader({}, self.starts).of(value)
        return _row(head, pieces(MathML(self.name), formula, room))


def _row(head: str, parts: list[str]) -> str:
    """An equation: the left side stays, the right side wraps between its pieces."""
    left = f"<math displaystyle='true'><mrow>{head}{sign('=')}</mrow></math>"
    right = " ".join(f'<math displaystyle="true"><mrow>{p}</mrow></math>' for p in parts)
    return f'<div class="eq"><span class="lhs">{left}</span><span class="rhs">{right}</span></div>'


def readable(parts: Parts) -> dict[Expr, str]:
    """Names for the shared parts, for implicit numbers, and for what is nested too deep to read."""
    named = dict(parts.named)
    spare = Spare(parts.taken().union(named.values()))
    depth: dict[Expr, int] = {}
    count = len(named)
    for node in parts.order:
        if node.op is Op.ROOT:  # by the variable that it is, unless another part is called so
            named.pop(node, None)
            another = node.root.name in named.values()
            count += another
            named[node] = spare.name(count) if another else node.root.name
        own = 0 if node in named else max([depth[a] for a in node.args], default=0)
        deeper = node.op in (Op.FN, Op.INT, Op.IF, Op.DER) and bool(node.args[0].args)
        deeper |= node.op is Op.MUL and any(
            e < 0 or a.op is Op.ADD for a, e in node.factors
        )
        depth[node] = own + deeper
        if depth[node] > _NESTED and node is not parts.root and node not in named:
            name = parts.variables.get(node)
            if name is None or name in named.values():
                count += 1
                name = spare.name(count)
            named[node] = name
            depth[node] = 0
    return named


def operations(expr: Expr) -> int:
    """How many nodes a formula has."""
    return len(topological([expr]))
