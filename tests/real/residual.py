"""Read a residual from the JSON of the compiler and evaluate it on told signals."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from flint import arb, arb_series, ctx

from tests.real.nodes import Node, fn, node, ordered, sym, total
from tests.real.series import Program, constant, derivative, sound

_RENAMED = {"Abs": "abs", "Min": "min", "Max": "max"}
_LOGIC = {"And": "and", "Or": "or", "Not": "not"}
_SIGNS: dict[type[ast.cmpop], str] = {
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="
}  # fmt: skip
_BRANCHES = ("abs", "sign", "min", "max", "ssqrt", "cbrt")
_ROOT = 1e-70
_NOISE = 1e-10  # terms below this, of signals near one, have cancelled already


class NoValue(Exception):
    """A residual that has no value at a point."""


class Residual(NamedTuple):
    """A residual; `roots` are inner unknowns: what vanishes at each and where to start."""

    name: str
    root: Node
    roots: Mapping[str, tuple[Node, float]]
    symbols: frozenset[str]
    orders: int
    integrates: bool
    decides: bool  # whether it has branches
    signature: frozenset[str]
    only_off: Mapping[str, tuple[str, ...]]
    unconfirmed: frozenset[str]


def residuals(answer: Mapping[str, Any]) -> list[Residual]:
    """The residuals of a result of `compile --json`; their symbols have the names of the model."""
    return [_residual(arr, answer["names"]) for arr in answer["arrs"]]


def _residual(arr: Mapping[str, Any], named: Mapping[str, str]) -> Residual:
    inner = dict(arr.get("implicit", {}))
    known: dict[str, Node] = {
        plain: sym(plain if plain in inner else named.get(plain, plain)) for plain in arr["symbols"]
    }
    for name, text in arr.get("defs", []):
        known[name] = parsed(text, known)
    root = parsed(arr["expr"], known)
    roots = {x: (parsed(text, known), arr["guess"][x]) for x, text in inner.items()}
    every = ordered([root, *[zero for zero, _ in roots.values()]])
    return Residual(
        arr["name"],
        root,
        roots,
        frozenset(str(n.data) for n in every if n.op == "sym") - frozenset(roots),
        max([0, *arr["orders"].values()]),
        any(n.op == "int" for n in every),
        decides(root) or any(decides(zero) for zero, _ in roots.values()),
        frozenset(arr["signature"]),
        {x: tuple(numbers) for x, numbers in arr.get("only_off_nominal", {}).items()},
        frozenset(arr.get("unconfirmed", ())),
    )


def decides(root: Node) -> bool:
    """Whether an expression has branches."""
    every = ordered([root])
    return any(n.op in ("if", "table") or (n.op == "fn" and n.data in _BRANCHES) for n in every)


def parsed(text: str, known: Mapping[str, Node]) -> Node:
    """The text of an expression as a tree; numbers are exact."""
    return _read(ast.parse(text, mode="eval").body, known)


def _read(e: ast.expr, known: Mapping[str, Node]) -> Node:
    match e:
        case ast.Constant(value=bool(truth)):
            return Node("cmp", (node(0), node(0 if truth else 1)), "==")
        case ast.Constant(value=int(n)):
            return node(n)
        case ast.Constant(value=float()):
            return node(Fraction(ast.unparse(e)))
        case ast.Name(id="nan"):
            return Node("nan")
        case ast.Name(id=name):
            return known[name]
        case ast.UnaryOp(op=ast.USub(), operand=a):
            inner = _read(a, known)
            return node(-_number(inner)) if inner.op == "num" else -inner
        case ast.BinOp(left=a, op=op, right=b):
            return _binary(op, _read(a, known), _read(b, known))
        case ast.Compare(left=a, ops=[op], comparators=[b]):
            return Node("cmp", (_read(a, known), _read(b, known)), _SIGNS[type(op)])
        case ast.Call(func=ast.Name(id=name), args=args):
            return _call(name, args, known)
    raise ValueError(ast.dump(e))


def _number(n: Node) -> Fraction:
    assert isinstance(n.data, Fraction)
    return n.data


def _binary(op: ast.operator, a: Node, b: Node) -> Node:
    numbers = a.op == "num" and b.op == "num"
    match op:
        case ast.Add() | ast.Sub():
            terms: list[tuple[Fraction, Node]] = []
            for c, x in ((1, a), (1 if isinstance(op, ast.Add) else -1, b)):
                if x.op == "add":
                    inner = zip(x.data, x.args, strict=True)  # type: ignore[call-overload]
                    terms += [(c * k, y) for k, y in inner]
                else:
                    terms.append((Fraction(c), x))
            return total(*terms)
        case ast.Mult():
            return node(_number(a) * _number(b)) if numbers else a * b
        case ast.Div():
            return node(_number(a) / _number(b)) if numbers else a / b
        case ast.Pow() if b.op == "num":
            return a ** _number(b)
        case ast.Pow():
            return fn("pow", a, b)
    raise ValueError(ast.dump(op))


def _call(name: str, args: list[ast.expr], known: Mapping[str, Node]) -> Node:
    if name == "Piecewise":
        out: Node | None = None
        for pair in reversed(args):
            assert isinstance(pair, ast.Tuple)
            yes = _read(pair.elts[0], known)
            out = yes if out is None else Node("if", (_read(pair.elts[1], known), yes, out))
        assert out is not None
        return out
    inner = [_read(a, known) for a in args]
    if name == "D":
        return Node("der", (inner[0],), int(_number(inner[1])))
    if name == "Int":
        return Node("int", tuple(inner))
    if name == "Eq":
        return Node("cmp", tuple(inner), "==")
    if name in _LOGIC:
        return Node(_LOGIC[name], tuple(inner))
    return fn(_RENAMED.get(name, name), *inner)


class Value(NamedTuple):
    """The leading coefficients of a residual, and the sums of the sizes of its terms."""

    coefficients: tuple[Any, ...]
    sizes: tuple[float, ...]

    def part(self) -> float:
        """The largest coefficient as a share of the terms that make it."""
        share = 0.0
        for c, size in zip(self.coefficients, self.sizes, strict=True):
            share = max(share, float(abs(c)) / max(size, _NOISE))
        return share


class Evaluator:
    """Evaluates one residual again and again."""

    def __init__(self, residual: Residual) -> None:
        self.residual = residual
        self.program = Program([residual.root])
        self.zeros = {x: Program([zero]) for x, (zero, _) in residual.roots.items()}
        self.inner = {
            x: {str(n.data) for n in ordered([zero]) if n.op == "sym"} & set(residual.roots)
            for x, (zero, _) in residual.roots.items()
        }

    def __call__(self, told: Mapping[str, Any], count: int) -> Value:
        """Up to `count` coefficients of the residual; raises NoValue."""
        given = dict(told)
        for x in self.residual.roots:
            if x not in given:
                self.solve(x, given)
        values = self.program.values(given)
        out = values[self.program.roots[0]]
        if not sound(out) or out.prec < 1:
            raise NoValue
        n = min(count, out.prec)
        scale = _Scale(self.program, values, n)
        sizes = scale.of(self.program.roots[0])
        return Value(tuple(out[k].mid() for k in range(n)), tuple(sizes))

    def solve(self, x: str, given: dict[str, Any]) -> None:
        """An inner unknown: its lead by a bracket, then one coefficient after another."""
        for other in self.inner[x] - {x} - set(given):
            self.solve(other, given)
        zero, guess = self.zeros[x], self.residual.roots[x][1]

        def at(s: Any) -> Any:
            out = zero.values({**given, x: s})[zero.roots[0]]
            if not sound(out):
                raise NoValue
            return out

        lead = _bracketed(lambda v: at(constant(v))[0].mid(), arb(guess))
        jet = [lead]
        known = min(ctx.cap, at(constant(lead)).prec)
        for k in range(1, known):
            here = at(arb_series([*jet, arb(0)], ctx.cap))[k]
            there = at(arb_series([*jet, arb(1)], ctx.cap))[k]
            if abs(there - here) < arb("1e-60"):
                raise NoValue
            jet.append((-here / (there - here)).mid())
        given[x] = arb_series(jet, known)


def _bracketed(f: Any, guess: Any) -> Any:
    """The zero of a function that rises or falls everywhere: a bracket, halving, then secants."""
    width = arb(1) / 64
    low = high = guess
    at_low = at_high = f(guess)
    while at_low * at_high > 0:
        if width > 1e9:
            raise NoValue
        low, high = guess - width, guess + width
        at_low, at_high, width = f(low), f(high), width * 2
    for turn in range(400):
        if abs(high - low) < arb(_ROOT) or at_low == 0 or at_high == 0:
            break
        middle = (low + high) / 2
        if turn % 3 and at_high != at_low:
            middle = (low - at_low * (high - low) / (at_high - at_low)).mid()
            # a little towards the far end, so that the bracket shrinks from both sides
            middle = middle + (high - middle) * arb(1e-3) if turn % 3 == 1 else middle
        middle = middle.mid()
        here = f(middle)
        if here * at_low > 0:
            low, at_low = middle, here
        else:
            high, at_high = middle, here
    return low if abs(at_low) < abs(at_high) else high


class _Scale:
    """The sum of the absolute values of the terms of which a value is made."""

    def __init__(self, program: Program, values: list[Any], count: int) -> None:
        self.program, self.values, self.count = program, values, count

    def plain(self, s: Any) -> list[float]:
        if not sound(s):
            return [0.0] * self.count
        return [float(abs(s[k].mid())) if k < s.prec else 0.0 for k in range(self.count)]

    def of(self, at: int) -> list[float]:
        """Of the step `at`; a factor counts with all its terms, as does the branch taken."""
        n, below = self.program.steps[at]
        match n.op:
            case "add":
                out = [0.0] * self.count
                for c, i in zip(n.data, below, strict=True):  # type: ignore[call-overload]
                    terms = self.of(i)
                    out = [a + abs(float(c)) * b for a, b in zip(out, terms, strict=True)]
                return out
            case "mul":
                return self.product(below)
            case "div":
                divisor = float(abs(self.values[below[1]][0].mid())) or 1.0
                return [a / divisor for a in self.of(below[0])]
            case "if":
                return self.of(below[1] if self.values[below[0]] else below[2])
            case "der" if self.program.steps[below[0]][0].op == "add":
                inner, terms = self.program.steps[below[0]]
                out = [0.0] * self.count
                for c, i in zip(inner.data, terms, strict=True):  # type: ignore[call-overload]
                    slope = self.plain(derivative(self.values[i], n.data))  # type: ignore[arg-type]
                    out = [a + abs(float(c)) * b for a, b in zip(out, slope, strict=True)]
                return out
        return self.plain(self.values[at])

    def product(self, below: tuple[int, ...]) -> list[float]:
        out = [1.0] + [0.0] * (self.count - 1)
        for i in below:
            factor = self.of(i)
            out = [sum(out[j] * factor[k - j] for j in range(k + 1)) for k in range(self.count)]
        return out
