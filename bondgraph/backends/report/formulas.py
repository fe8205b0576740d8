"""Formulas of a model as HTML: MathML in pieces, so that long ones wrap like text."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from bondgraph.algebra.present import Parts
from bondgraph.ir.expr import Expr, Op, Symbol, topological
from bondgraph.ir.lettering import Letter, letters, split_name
from bondgraph.ir.mathml import Box, Typist, atom, escape, sign
from bondgraph.ir.mathml_pieces import pieces

ROOM = 30.0  # em, of a piece that is not broken
_NESTED = 3  # fractions, integrals and the like inside each other, before one gets a name


class Typesetter:
    """Sets formulas in the letters of one model: `names` are all names that may occur."""

    def __init__(self, names: Iterable[str], starts: Mapping[Symbol, Expr]) -> None:
        self.letters = letters(dict.fromkeys(names))
        self.starts = starts

    def name(self, path: str, dots: int = 0) -> Box:
        """A name of the model, under dots for derivatives; the element carries the name itself."""
        letter = self.letters.get(path) or Letter(*split_name(path), ())
        base = f"<mi>{escape(letter.base)}</mi>"
        if dots:
            over = "˙" if dots == 1 else "¨"
            base = f'<mover accent="true">{base}<mo stretchy="false">{over}</mo></mover>'
        width = 0.6 * len(letter.base)
        below = [part for part in (letter.below, " ".join(letter.where)) if part]
        if not below:
            return atom(f'<mrow data-name="{escape(path)}">{base}</mrow>', width)
        text = escape(", ".join(below)).replace(" ", "&#x202f;")
        index = f'<mtext class="index">{text}</mtext>'
        width += 0.36 * sum(map(len, below)) + 0.2 * len(below)
        return atom(f'<msub data-name="{escape(path)}">{base}{index}</msub>', width)

    def inline(self, path: str) -> str:
        """A name in running text."""
        return f"<math>{self.name(path).xml}</math>"

    def equations(self, head: str, parts: Parts, room: float = ROOM) -> list[str]:
        """`head` = the relation, and one line for each part that has a name, outermost first."""
        named = readable(parts)
        typist = Typist(self.name, named, self.starts)
        lines = [self._line(head, typist, parts.root, room)]
        for node in reversed(parts.order):
            if node in named and node is not parts.root:
                if node.op is Op.ROOT:
                    lines.append(self._solved(named[node], typist, node))
                else:
                    lines.append(self._line(self.name(named[node]).xml, typist, node, room))
        return lines

    def assigned(self, variable: str, value: Expr, room: float = ROOM) -> str:
        """`variable` = `value`, all on its own."""
        typist = Typist(self.name, {}, self.starts)
        return _row(self.name(variable).xml, pieces(typist, value, room))

    def vanishing(self, zero: Expr) -> str:
        """0 = `zero`."""
        return _row("<mn>0</mn>", pieces(Typist(self.name, {}, self.starts), zero, ROOM))

    def _line(self, head: str, typist: Typist, node: Expr, room: float) -> str:
        return _row(head, pieces(typist, node, room, own=True))

    def _solved(self, name: str, typist: Typist, node: Expr) -> str:
        """A number that no formula gives: where it makes an expression vanish."""
        where = f"{self.name(name).xml}<mtext>&#xa0;where&#xa0;</mtext><mn>0</mn>"
        return _row(where, pieces(typist.inside(node), node.root.zero, ROOM))


def _row(head: str, parts: list[str]) -> str:
    """An equation: the left side stays, the right side wraps between its pieces."""
    left = f"<math displaystyle='true'><mrow>{head}{sign('=')}</mrow></math>"
    right = " ".join(f'<math displaystyle="true"><mrow>{p}</mrow></math>' for p in parts)
    return f'<div class="eq"><span class="lhs">{left}</span><span class="rhs">{right}</span></div>'


def readable(parts: Parts) -> dict[Expr, str]:
    """Names for the shared parts, for implicit numbers, and for what is nested too deep to read."""
    named = dict(parts.named)
    taken = {*named.values(), *(v for v in parts.variables.values())}
    depth: dict[Expr, int] = {}
    count = len(named)
    for node in parts.order:
        if node.op is Op.ROOT:
            named[node] = node.root.name
        own = 0 if node in named else max([depth[a] for a in node.args], default=0)
        deeper = node.op in (Op.FN, Op.INT, Op.IF, Op.DER) and bool(node.args[0].args)
        deeper |= node.op is Op.MUL and any(
            e < 0 or a.op is Op.ADD for a, e in zip(node.args, node.exponents, strict=True)
        )
        depth[node] = own + deeper
        if depth[node] > _NESTED and node is not parts.root and node not in named:
            name = parts.variables.get(node)
            while name is None or (name in taken and name not in parts.variables.values()):
                count += 1
                name = f"x{count}"
            named[node] = name
            depth[node] = 0
    return named


def operations(expr: Expr) -> int:
    """How many nodes a formula has."""
    return len(topological([expr]))
