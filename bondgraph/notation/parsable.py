"""Expressions as text that a Python algebra system parses, with exact numbers and shared parts."""

from __future__ import annotations

import keyword
import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from types import MappingProxyType

from bondgraph.ir.expr import Expr, Pool, Symbol
from bondgraph.ir.tables import backwards, columns, knots
from bondgraph.notation.formula import Formula, Reader, Shape, below
from bondgraph.notation.speller import ATOM, COMPARE, POWER, PRODUCT, Spelled, Speller
from bondgraph.text.tuples import NamedTuple

#: Names that mean something in the text and so cannot be names of the model as well.
FUNCTIONS = frozenset(
    "D Int ssqrt Abs sign sqrt exp log sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh"
    " atan2 delay Min Max Piecewise Eq And Or Not nan".split()
)
#: Those of SymPy among them, and its exact quotient of two numbers.
CALLED = FUNCTIONS - {"D", "Int", "ssqrt", "delay", "nan"} | {"Rational"}
#: What SymPy has no inverse of: what it is, its slope in Python, and what undoes it.
UNKNOWN_TO_SYMPY = {
    "ssq": ("x |x|", "2*sp.Abs(self.args[0])", "ssqrt"),
    "ssqrt": ("sign(x) sqrt(|x|)", "1/(2*sp.Abs(self))", "ssq"),
    "cbrt": ("The real root of the third degree", "1/(3*self**2)", ""),
}
_RENAMED = {"abs": "Abs", "min": "Min", "max": "Max", "and": "And", "or": "Or", "not": "Not"}
#: Above this many written nodes, parts that occur more than once get a name.
LARGE = 400
#: Parentheses within one text; Python's own parser gives up at 200.
DEEP = 40
#: Nodes written within one text, so that no line is endless.
LONG = 2000


class Parsable(NamedTuple):
    """`expr` in `symbols` and the names of `defs`, each in symbols and earlier names.

    `implicit` has the inner unknowns, which are among the symbols: name, expression that vanishes
    where the unknown has its value, and a number from which a search may start.
    """

    expr: str
    symbols: tuple[str, ...]
    defs: tuple[tuple[str, str], ...]
    implicit: tuple[tuple[str, str, float], ...] = ()


class Names:
    """Names of the model as Python identifiers: `.` and `[i]` become `__`, keywords get a `_`.

    So do names that are `reserved`, because the code around calls something else so.

    >>> Names(["m[1].wh.ws", "lambda", "D"]).by_model
    {'m[1].wh.ws': 'm__1__wh__ws', 'lambda': 'lambda_', 'D': 'D_'}
    """

    def __init__(self, names: Iterable[str], reserved: Iterable[str] = ()) -> None:
        self.by_model: dict[str, str] = {}
        self.known_as: dict[str, str] = {}  # inner unknowns by identifier: variable of the model
        self._taken = set(reserved)
        for name in names:
            self.add(name)

    def add(self, name: str) -> str:
        """The identifier of a name of the model, the same for the same name."""
        if name not in self.by_model:
            plain = name.replace("].", "__").replace("[", "__").replace("]", "")
            plain = plain.replace("?", "").replace("'", "_")
            plain = unicodedata.normalize("NFKC", plain.replace(".", "__"))
            while keyword.iskeyword(plain) or plain in FUNCTIONS or plain in self._taken:
                plain += "_"
            self._taken.add(plain)
            self.by_model[name] = plain
        return self.by_model[name]

    def fresh(self, number: int) -> str:
        """A name for shared part `number` that no name of the model is."""
        name = f"t{number}"
        while name in self._taken:
            name += "_"
        return name


def parsable(
    pool: Pool,
    expr: Expr,
    names: Names,
    starts: Mapping[Symbol, Expr] = MappingProxyType({}),
    functions: dict[str, str] | None = None,
) -> Parsable:
    """The expression as text; `starts` gives the value of each symbol of an initial value.

    With `functions` the text is Python that runs: quotients of numbers are exact, and what has an
    inverse that SymPy does not know is a call, as is a table. The names of these functions are
    added, by what they are called in an expression.

    `D(x, n)` is the n-th time derivative, `Int(x, x0)` the integral of x that starts at x0,
    `ssqrt(x)` is sign(x) sqrt(|x|); all other functions have the names they have in SymPy. Numbers
    are exact rationals. The text of n distinct nodes is linear in n.
    """
    return _Writer(pool, names, functions).write(Reader({}, starts).of(expr))


class _Writer(Speller):
    """Spells one formula; what is shared, deep or long is spelled once, under a name."""

    power = "{}**{}"

    def __init__(self, pool: Pool, names: Names, functions: dict[str, str] | None) -> None:
        super().__init__()
        self.pool = pool
        self.names = names
        self.functions = functions
        self.symbols: dict[str, None] = {}
        self.asked: dict[Formula, str] = {}  # roots and their unknowns, as they are called

    def write(self, root: Formula) -> Parsable:
        """The text, its parts and the equations of its inner unknowns."""
        roots = self._roots(root)
        targets = [root, *[found.parts[1] for found in roots]]
        order = below(targets, self.parts)
        uses = Counter(part for node in order for part in self.parts(node))
        written: dict[Formula, int] = {}
        for node in order:
            written[node] = min(1 + sum(written[p] for p in self.parts(node)), 10 * LARGE)
        shared = sum(written[target] for target in targets) > LARGE
        depth: dict[Formula, int] = {}
        size: dict[Formula, int] = {}
        defs: list[tuple[str, str]] = []
        for node in order:
            parts = self.parts(node)
            depth[node] = 1 + max((depth[p] for p in parts), default=0)
            size[node] = 1 + sum(size[p] for p in parts)
            text = self.spell(node).text
            if node in targets or not parts:
                continue
            repeated = shared and uses[node] > 1 and size[node] > 3
            if repeated or depth[node] >= DEEP or size[node] >= LONG:
                name = self.names.fresh(len(defs) + 1)
                defs.append((name, text))
                self._done[node] = Spelled(name)
                depth[node] = size[node] = 1
        implicit = tuple((self.asked[n], self.spell(n.parts[1]).text, float(n.data)) for n in roots)
        return Parsable(self.spell(root).text, tuple(self.symbols), tuple(defs), implicit)

    def number(self, value: Fraction) -> Spelled:
        """An exact number."""
        if self.functions is None or value.denominator == 1:
            return super().number(value)
        return Spelled(f"Rational({value.numerator}, {value.denominator})")

    def _roots(self, root: Formula) -> list[Formula]:
        """The inner unknowns that have to be solved for, each with a name of its own."""
        roots = [n for n in below([root], lambda node: node.parts) if n.shape is Shape.ROOT]
        taken: set[str] = set()
        for node in roots:
            name = node.parts[0].data
            while name in taken:
                name += "'"
            taken.add(name)
            plain = self.asked[node] = self.asked[node.parts[0]] = self.names.add(f"{name}?")
            self.names.known_as[plain] = node.parts[0].data
        return roots

    def parts(self, node: Formula) -> tuple[Formula, ...]:
        """A root is a name; its equation is written elsewhere."""
        return () if node.shape is Shape.ROOT else node.parts

    def _name(self, node: Formula) -> Spelled:
        plain = self.asked.get(node) or self.names.by_model[node.data]
        self.symbols[plain] = None
        return Spelled(plain)

    _root = _name

    def terms(self, node: Formula) -> Iterable[tuple[Fraction, Formula]]:
        """The terms as they are stored."""
        return zip(node.data, node.parts, strict=True)

    def _rate(self, node: Formula) -> Spelled:
        return Spelled(f"D({self._texts(node)[0]}, {node.data})")

    def _area(self, node: Formula) -> Spelled:
        area, *start = self._texts(node)
        return Spelled(f"Int({area}, {start[0] if start else 0})")

    def _choice(self, node: Formula) -> Spelled:
        return Spelled("Piecewise(({1}, {0}), ({2}, True))".format(*self._texts(node)))

    def _compare(self, node: Formula) -> Spelled:
        left, right = self._texts(node)
        if node.data == "==":
            return Spelled(f"Eq({left}, {right})")
        return Spelled(f"({left}) {node.data} ({right})", COMPARE)

    def _call(self, node: Formula) -> Spelled:
        x, *others = self._texts(node)
        if self.functions is not None and (
            node.data in UNKNOWN_TO_SYMPY or node.data.startswith("table:")
        ):
            plain = self.functions.setdefault(node.data, self._called(node.data))
            return Spelled(f"{plain}({', '.join([x, *others])})")
        match node.data:
            case "pow":
                base, exponent = (self.within(part, ATOM).text for part in node.parts)
                return Spelled(f"{base}**{exponent}", POWER)
            case "ssq":
                return Spelled(f"{self.within(node.parts[0], PRODUCT).text}*Abs({x})", PRODUCT)
            case "cbrt":  # the real root, also of a negative number
                return Spelled(f"sign({x})*Abs({x})**(1/3)", PRODUCT)
            case name if name.startswith("table:"):
                return Spelled(self._table(name[6:], x, *others))
            case name:
                return Spelled(f"{_RENAMED.get(name, name)}({', '.join([x, *others])})")

    _logic = _call

    def _called(self, name: str) -> str:
        """The identifier of a table, which may be the name of a file."""
        if name in UNKNOWN_TO_SYMPY:
            return name
        own, marks = name.rstrip("'"), len(name) - len(name.rstrip("'"))
        plain = re.sub(r"\W+", "_", own.removeprefix("table:")).strip("_")
        return self.names.add(f"table_{plain}" + "_inverse" * marks)

    def _table(self, key: str, x: str, *others: str) -> str:
        """A table as straight pieces; beyond its ends it keeps the last value, or has none."""
        rows = self.pool.tables[key]
        if not others:
            return _pieces([(str(a), str(b)) for a, b in rows], x, backwards(key))
        first, second = knots(rows)
        lines = []
        for a, values in zip(first, zip(*columns(rows), strict=True), strict=True):
            points = [(str(b), str(z)) for b, z in zip(second, values, strict=True)]
            lines.append((str(a), _pieces(points, others[0])))
        if not backwards(key):
            return _pieces(lines, x)
        falls = columns(rows)[0][0] > columns(rows)[0][1]
        return _pieces([(z, a) for a, z in (lines[::-1] if falls else lines)], x, gap=True)


def _pieces(points: Sequence[tuple[str, str]], x: str, gap: bool = False) -> str:
    """What is straight between points; from its ends on it has no value if there is a `gap`."""
    ends, beyond = [points[k][1] for k in (0, -1)], "<"
    if gap:
        ends, beyond = ["nan", "nan"], "<="
    pieces = [f"({ends[0]}, ({x}) {beyond} ({points[0][0]}))"]
    for (x0, y0), (x1, y1) in pairwise(points):
        line = f"{y0} + ({_slope(x0, y0, x1, y1)})*(({x}) - ({x0}))"
        pieces.append(f"({line}, ({x}) < ({x1}))")
    return f"Piecewise({', '.join(pieces)}, ({ends[1]}, True))"


def _slope(x0: str, y0: str, x1: str, y1: str) -> str:
    """The slope between two points; a number where they are numbers."""
    if "(" in x0 + y0:
        return f"(({y1}) - ({y0}))/(({x1}) - ({x0}))"
    return str((Fraction(y1) - Fraction(y0)) / (Fraction(x1) - Fraction(x0)))
