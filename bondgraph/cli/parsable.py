"""Expressions as text that a Python algebra system parses, with exact numbers and shared parts."""

from __future__ import annotations

import keyword
import unicodedata
from collections.abc import Iterable, Mapping
from fractions import Fraction
from itertools import pairwise

from bondgraph.ir.expr import Expr, Kind, Op, Pool, backwards, topological
from bondgraph.text.tuples import NamedTuple

#: Names that mean something in the text and so cannot be names of the model as well.
FUNCTIONS = frozenset(
    "D Int ssqrt Abs sign sqrt exp log sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh"
    " atan2 Min Max Piecewise Eq And Or Not nan".split()
)
_RENAMED = {"abs": "Abs", "min": "Min", "max": "Max"}
#: Above this many written nodes, parts that occur more than once get a name.
LARGE = 400
#: Parentheses within one text; Python's own parser gives up at 200.
DEEP = 40
#: Nodes written within one text, so that no line is endless.
LONG = 2000

_SUM, _PRODUCT, _POWER, _ATOM = range(4)


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

    >>> Names(["m[1].wh.ws", "lambda", "D"]).by_model
    {'m[1].wh.ws': 'm__1__wh__ws', 'lambda': 'lambda_', 'D': 'D_'}
    """

    def __init__(self, names: Iterable[str]) -> None:
        self.by_model: dict[str, str] = {}
        self.known_as: dict[str, str] = {}  # inner unknowns by identifier: variable of the model
        self._taken: set[str] = set()
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
    pool: Pool, expr: Expr, names: Names, initial: Mapping[str, Expr] | None = None
) -> Parsable:
    """The expression as text; `initial` gives the value of each initial-value symbol by name.

    `D(x, n)` is the n-th time derivative, `Int(x, x0)` the integral of x that starts at x0,
    `ssqrt(x)` is sign(x) sqrt(|x|); all other functions have the names they have in SymPy. Numbers
    are exact rationals. The text of n distinct nodes is linear in n.
    """
    return _Writer(pool, names, initial or {}).write(expr)


class _Writer:
    def __init__(self, pool: Pool, names: Names, initial: Mapping[str, Expr]) -> None:
        self.pool = pool
        self.names = names
        self.initial = initial
        self.text: dict[Expr, tuple[str, int]] = {}
        self.depth: dict[Expr, int] = {}
        self.size: dict[Expr, int] = {}
        self.symbols: dict[str, None] = {}
        self.defs: list[tuple[str, str]] = []
        self.unknown: dict[Expr, str] = {}  # ROOT nodes by what they are called
        self.inner: list[tuple[str, Expr, float]] = []

    def write(self, root: Expr) -> Parsable:
        targets = self._targets(root)
        nodes = self._order(targets)
        uses: dict[Expr, int] = {}
        written: dict[Expr, int] = {}
        for node in nodes:
            args = self._args(node)
            written[node] = min(1 + sum(written[a] for a in args), 10 * LARGE)
            for arg in args:
                uses[arg] = uses.get(arg, 0) + 1
        shared = sum(written[t] for t in targets) > LARGE
        for node in nodes:
            args = self._args(node)
            self.depth[node] = 1 + max((self.depth[a] for a in args), default=0)
            self.size[node] = 1 + sum(self.size[a] for a in args)
            self.text[node] = self._text(node)
            if node in targets or not args:
                continue
            repeated = shared and uses[node] > 1 and self.size[node] > 3
            if repeated or self.depth[node] >= DEEP or self.size[node] >= LONG:
                name = self.names.fresh(len(self.defs) + 1)
                self.defs.append((name, self.text[node][0]))
                self.text[node] = (name, _ATOM)
                self.depth[node] = self.size[node] = 1
        implicit = tuple((n, self.text[zero][0], guess) for n, zero, guess in self.inner)
        return Parsable(self.text[root][0], tuple(self.symbols), tuple(self.defs), implicit)

    def _targets(self, root: Expr) -> list[Expr]:
        """The expression, and one for each inner unknown that has to be solved for."""
        targets = [root]
        for target in targets:  # grows: a root may rest on others
            for node in topological([target]):
                if node.op is Op.ROOT and node not in self.unknown:
                    solved = node.root
                    name = solved.name
                    while name in self.unknown.values():
                        name += "'"
                    self.unknown[node] = name
                    plain = self.names.add(f"{name}?")
                    self.names.known_as[plain] = solved.name
                    inside = dict(zip(solved.places, node.args, strict=True))
                    inside[solved.unknown] = self.pool.symbol(f"{name}?", Kind.TEAR)
                    zero = self.pool.substitute([solved.zero], inside)[0]
                    self.inner.append((plain, zero, float(solved.guess)))
                    targets.append(zero)
        return targets

    def _order(self, roots: list[Expr]) -> list[Expr]:
        """Everything that is written, arguments first; initial values stand for their symbols."""
        done: dict[Expr, None] = {}
        stack = [(root, False) for root in reversed(roots)]
        while stack:
            node, ready = stack.pop()
            if ready:
                done[node] = None
            elif node not in done:
                stack.append((node, True))
                stack.extend((a, False) for a in self._args(node) if a not in done)
        return list(done)

    def _args(self, node: Expr) -> tuple[Expr, ...]:
        """What the text of a node is put together from."""
        if node.op is Op.SYM:
            value = self.initial.get(node.symbol.name)
            return () if value is None else (value,)
        if node.op is Op.ROOT:
            return ()
        if node.op is Op.INT:
            start = self.initial.get(node.symbol.name)
            return (*node.args, *([] if start is None else [start]))
        return node.args

    def _wrap(self, node: Expr, level: int) -> str:
        text, own = self.text[node]
        return text if own >= level else f"({text})"

    def _text(self, node: Expr) -> tuple[str, int]:
        match node.op:
            case Op.NUM:
                return _number(node.number)
            case Op.SYM:
                if self._args(node):
                    return self.text[self._args(node)[0]]
                return self._symbol(node.symbol.name), _ATOM
            case Op.ADD:
                return self._sum(node)
            case Op.MUL:
                return self._product(node), _PRODUCT
            case Op.FN:
                return self._function(node)
            case Op.ROOT:
                return self._symbol(f"{self.unknown[node]}?"), _ATOM
            case Op.DER:
                return self._derivative(node), _ATOM
            case Op.INT:
                args = self._args(node)
                start = self.text[args[1]][0] if len(args) > 1 else self._symbol(node.symbol.name)
                return f"Int({self.text[args[0]][0]}, {start})", _ATOM
            case Op.IF:
                condition, yes, no = (self.text[a][0] for a in node.args)
                return f"Piecewise(({yes}, {condition}), ({no}, True))", _ATOM
            case Op.CMP:
                left, right = (self.text[a][0] for a in node.args)
                if node.name == "==":
                    return f"Eq({left}, {right})", _ATOM
                return f"({left}) {node.name} ({right})", _SUM
            case Op.LOGIC:
                called = {"and": "And", "or": "Or", "not": "Not"}[node.name]
                return f"{called}({', '.join(self.text[a][0] for a in node.args)})", _ATOM

    def _symbol(self, name: str) -> str:
        plain = self.names.by_model[name]
        self.symbols[plain] = None
        return plain

    def _sum(self, node: Expr) -> tuple[str, int]:
        out = ""
        for c, arg in zip(node.coefficients, node.args, strict=True):
            size = abs(c)
            if arg.op is Op.NUM:
                text = _number(size * arg.number)[0]
            elif size == 1:
                text = self._wrap(arg, _PRODUCT)
            else:
                text = f"{_number(size)[0]}*{self._wrap(arg, _PRODUCT)}"
            sign = "-" if c < 0 else "+"
            out += f" {sign} {text}" if out else text if sign == "+" else f"-{text}"
        return out, _SUM

    def _product(self, node: Expr) -> str:
        above: list[str] = []
        below: list[str] = []
        for base, exponent in zip(node.args, node.exponents, strict=True):
            size = abs(exponent)
            text = self._wrap(base, _POWER) if size == 1 else f"{self._wrap(base, _ATOM)}**{size}"
            (above if exponent > 0 else below).append(text)
        text = "*".join(above) or "1"
        if not below:
            return text
        return text + "/" + (below[0] if len(below) == 1 else f"({'*'.join(below)})")

    def _derivative(self, node: Expr) -> str:
        inner = self.text[node.args[0]][0]
        if node.args[0].op is Op.DER and inner.startswith("D("):
            body, _, order = inner[2:-1].rpartition(", ")
            return f"D({body}, {int(order) + 1})"
        return f"D({inner}, 1)"

    def _function(self, node: Expr) -> tuple[str, int]:
        args = [self.text[a][0] for a in node.args]
        match node.name:
            case "pow":
                base, exponent = (self._wrap(a, _ATOM) for a in node.args)
                return f"{base}**{exponent}", _POWER
            case "ssq":
                return f"{self._wrap(node.args[0], _PRODUCT)}*Abs({args[0]})", _PRODUCT
            case "cbrt":  # the real root, also of a negative number
                return f"sign({args[0]})*Abs({args[0]})**(1/3)", _PRODUCT
            case name if name.startswith("table:"):
                return self._table(name[6:], args[0]), _ATOM
            case name:
                return f"{_RENAMED.get(name, name)}({', '.join(args)})", _ATOM

    def _table(self, key: str, x: str) -> str:
        """A table as straight pieces; beyond its ends it keeps the last value, or has none."""
        points = self.pool.tables[key]
        ends, beyond = [_number(points[k][1])[0] for k in (0, -1)], "<"
        if backwards(key):
            ends, beyond = ["nan", "nan"], "<="
        pieces = [f"({ends[0]}, ({x}) {beyond} ({_number(points[0][0])[0]}))"]
        for (x0, y0), (x1, y1) in pairwise(points):
            slope = _number((y1 - y0) / (x1 - x0))[0]
            line = f"{_number(y0)[0]} + ({slope})*(({x}) - ({_number(x0)[0]}))"
            pieces.append(f"({line}, ({x}) < ({_number(x1)[0]}))")
        return f"Piecewise({', '.join(pieces)}, ({ends[1]}, True))"


def _number(value: Fraction) -> tuple[str, int]:
    if value.denominator == 1:
        return str(value.numerator), _ATOM if value >= 0 else _SUM
    return f"{value.numerator}/{value.denominator}", _PRODUCT if value >= 0 else _SUM
