"""Real power series with 90 digits: the functions of the language, values and slopes of trees.

A value is a truncated series of FLINT's real numbers. What has no value (a logarithm of a negative
number) is a series that is not finite; nothing is raised, so that a branch that is not taken does
not matter.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import reduce
from typing import Any

from flint import arb, arb_series, ctx, fmpq

from tests.real.nodes import Node, ordered

Series = Any  # flint has no types
_SMALL = arb("1e-45")  # a leading coefficient below this is none
_BITS = 300


def prepare(length: int) -> None:
    """Work with series of so many coefficients."""
    ctx.prec = _BITS
    ctx.cap = length


def exact(value: Fraction) -> Any:
    return fmpq(value.numerator, value.denominator)


def constant(value: Any) -> Series:
    return arb_series([arb(value)], ctx.cap)


def nothing() -> Series:
    """What has no value, in any coefficient: a derivative of it has none either."""
    return arb_series([arb.nan()] * ctx.cap, ctx.cap)


def sound(s: Series) -> bool:
    return all(c.is_finite() for c in s.coeffs())


def middle(s: Series) -> Series:
    return arb_series([c.mid() for c in s.coeffs()], s.prec)


def positive(s: Series) -> bool:
    """Whether a value is above zero by more than what rounding leaves of nothing."""
    return s[0].is_finite() and s[0].mid() > _SMALL


def product(a: Series, b: Series) -> Series:
    """The product; nothing times what has no value has none."""
    out = a * b
    return out if out.length() or (sound(a) and sound(b)) else nothing()


def quotient(a: Series, b: Series) -> Series:
    lead = b[0]
    if not lead.is_finite() or lead.contains(0) or abs(lead.mid()) < _SMALL:
        return nothing()
    return a / b


def sign_of(s: Series) -> int:
    """The sign just behind the point; 0 of what vanishes, 2 of what has no value.

    The last coefficients say nothing: a plant with derivatives in it leaves them open.
    """
    for c in s.coeffs()[: ctx.cap // 2]:
        if not c.is_finite():
            return 2
        if abs(c.mid()) > _SMALL:
            return 1 if c.mid() > 0 else -1
    return 0


def _by_sign(s: Series, made: Callable[[Series], Series]) -> Series:
    sign = sign_of(s)
    if sign == 0:
        return constant(0)
    return nothing() if sign == 2 else made(s * sign) * sign


def derivative(s: Series, order: int) -> Series:
    for _ in range(order):
        s = s.derivative() if s.prec > 1 else nothing()
    return s


def power(s: Series, c: Fraction) -> Series:
    if c.denominator == 1:
        out = constant(1)
        for _ in range(abs(c.numerator)):
            out = out * s
        return out if c >= 0 else quotient(constant(1), out)
    if c.denominator == 2 and 0 < c < 3:
        root = FUNCTIONS["sqrt"](s)
        return root if c == Fraction(1, 2) else root * s
    return (s.log() * exact(c)).exp() if positive(s) else nothing()


def _tanh(s: Series) -> Series:
    if abs(s[0]) > 100:
        return constant(1 if s[0] > 0 else -1)
    e = (s * 2).exp()
    return quotient(e - 1, e + 1)


def _atan2(y: Series, x: Series) -> Series:
    if not (positive(x) or positive(y) or positive(-y)):
        return nothing()
    flat = abs(x[0].mid()) > abs(y[0].mid())
    out = quotient(y, x).atan() if flat else -quotient(x, y).atan()
    return arb_series([arb.atan2(y[0], x[0]), *out.coeffs()[1:]], out.prec)


def _pick(a: Series, b: Series, least: bool) -> Series:
    sign = sign_of(a - b)
    if sign == 2:
        return nothing()
    return a if (sign < 0) == least else b


def _inverse_hyperbolic(s: Series) -> Series:
    return _by_sign(s, lambda x: (x + (x * x + 1).sqrt()).log())


FUNCTIONS: dict[str, Callable[..., Series]] = {
    "exp": lambda s: s.exp(),
    "log": lambda s: s.log() if positive(s) else nothing(),
    "sin": lambda s: s.sin(),
    "cos": lambda s: s.cos(),
    "tan": lambda s: quotient(s.sin(), s.cos()),
    "asin": lambda s: s.asin(),
    "acos": lambda s: s.acos(),
    "atan": lambda s: s.atan(),
    "sinh": lambda s: (s.exp() - (-s).exp()) / 2,
    "cosh": lambda s: (s.exp() + (-s).exp()) / 2,
    "tanh": _tanh,
    "asinh": _inverse_hyperbolic,
    "acosh": lambda s: (s + (s * s - 1).sqrt()).log(),
    "atanh": lambda s: quotient(s + 1, 1 - s).log() / 2,
    "sqrt": lambda s: s.sqrt() if positive(s) else nothing(),
    "ssqrt": lambda s: _by_sign(s, lambda x: FUNCTIONS["sqrt"](x)),
    "cbrt": lambda s: _by_sign(s, lambda x: (FUNCTIONS["log"](x) / 3).exp()),
    "abs": lambda s: _by_sign(s, lambda x: x) * (sign_of(s) or 1),
    "sign": lambda s: nothing() if sign_of(s) == 2 else constant(sign_of(s)),
    "min": lambda a, b: _pick(a, b, True),
    "max": lambda a, b: _pick(a, b, False),
    "atan2": _atan2,
    "pow": lambda a, b: (a.log() * b).exp() if positive(a) else nothing(),
}


def _slope(name: str, s: Series, value: Series) -> Series:
    """The derivative of a function of one argument; `value` is the function there."""
    match name:
        case "exp":
            return value
        case "log":
            return quotient(constant(1), s)
        case "sin":
            return s.cos()
        case "cos":
            return -s.sin()
        case "tan":
            return value * value + 1
        case "asin":
            return quotient(constant(1), (1 - s * s).sqrt())
        case "acos":
            return quotient(constant(-1), (1 - s * s).sqrt())
        case "atan":
            return quotient(constant(1), s * s + 1)
        case "sinh":
            return FUNCTIONS["cosh"](s)
        case "cosh":
            return FUNCTIONS["sinh"](s)
        case "tanh":
            return 1 - value * value
        case "asinh":
            return quotient(constant(1), (s * s + 1).sqrt())
        case "sqrt":
            return quotient(constant(0.5), value)
        case "ssqrt":
            return quotient(constant(sign_of(s)) / 2, value)
        case "cbrt":
            return quotient(constant(1) / 3, value * value)
        case "abs":
            return constant(sign_of(s) or 1)
        case "sign":
            return constant(0)
    raise NotImplementedError(name)


def _interpolated(points: Sequence[tuple[Fraction, Fraction]], x: Series) -> tuple[Series, Any]:
    """Value and slope of straight lines between points; the ends keep their value."""
    before = points[0]
    if not x[0].is_finite():
        return nothing(), exact(Fraction(0))
    if sign_of(x - constant(exact(before[0]))) < 0:
        return constant(exact(before[1])), exact(Fraction(0))
    for after in points[1:]:
        if sign_of(x - constant(exact(after[0]))) < 0:
            slope = exact((after[1] - before[1]) / (after[0] - before[0]))
            return (x - constant(exact(before[0]))) * slope + exact(before[1]), slope
        before = after
    return constant(exact(before[1])), exact(Fraction(0))


def _holds(sign: str, difference: Series) -> bool | None:
    s = sign_of(difference)
    if s == 2:
        return None
    return {"<": s < 0, "<=": s <= 0, ">": s > 0, ">=": s >= 0, "==": s == 0, "!=": s != 0}[sign]


class Program:
    """Expressions put in an order in which they can be computed.

    `bound` gives expressions for symbols; all others are given with every evaluation.
    """

    def __init__(self, roots: Sequence[Node], bound: Mapping[str, Node] | None = None) -> None:
        self.steps: list[tuple[Node, tuple[int, ...]]] = []
        self.makers: list[Maker] = []
        self.place: dict[int, int] = {}
        self.bound: dict[str, int] = {}
        self.kept = [*roots, *(bound or {}).values()]
        for name, root in (bound or {}).items():
            self.bound[name] = self._add(root)
        self.roots = [self._add(root) for root in roots]

    def _add(self, root: Node) -> int:
        for n in ordered([root]):
            if id(n) in self.place:
                continue
            if n.op == "sym" and n.data in self.bound:
                self.place[id(n)] = self.bound[str(n.data)]
                continue
            self.place[id(n)] = len(self.steps)
            self.steps.append((n, tuple(self.place[id(a)] for a in n.args)))
            self.makers.append(_maker(*self.steps[-1]))
        return self.place[id(root)]

    def values(self, given: Mapping[str, Any]) -> list[Any]:
        """The value of every step."""
        out: list[Any] = []
        for make in self.makers:
            out.append(make(out, given))
        return out


Maker = Callable[[list[Any], Mapping[str, Any]], Any]


def _maker(n: Node, at: tuple[int, ...]) -> Maker:
    """What computes one operation from the steps before it: a series, or a truth (None: none)."""
    data: Any = n.data
    i, j = (*at, -1, -1)[:2]
    match n.op:
        case "sym":
            return lambda _, given: given[data]
        case "nan":
            return lambda *_: nothing()
        case "num":
            number = exact(data)
            return lambda *_: constant(number)
        case "add":
            return _sum(at, data)
        case "mul" if len(at) == 2:
            return lambda v, _: product(v[i], v[j])
        case "div":
            return lambda v, _: quotient(v[i], v[j])
        case "pow":
            return lambda v, _: power(v[i], data)
        case "fn" if data in ("min", "max"):
            pick = FUNCTIONS[data]
            return lambda v, _: reduce(pick, [v[k] for k in at])
        case "fn":
            function = FUNCTIONS[data]
            return lambda v, _: function(*[v[k] for k in at])
        case "if":
            return lambda v, _: nothing() if v[i] is None else v[j] if v[i] else v[at[2]]
        case "cmp":
            return lambda v, _: _holds(data, v[i] - v[j])
        case "and" | "or" | "not":
            return lambda v, _: _logic(n.op, [v[k] for k in at])
        case "der":
            return lambda v, _: derivative(v[i], data)
        case "int":
            return lambda v, _: v[i].integral() + v[j][0]
        case "table":
            return lambda v, _: _interpolated(data, v[i])[0]
    raise ValueError(n.op)


def _sum(at: tuple[int, ...], coefficients: Any) -> Maker:
    terms = [
        (k, int(c) if c in (1, -1) else exact(c)) for k, c in zip(at, coefficients, strict=True)
    ]
    if len(terms) == 2 and terms[0][1] == 1 and terms[1][1] in (1, -1):
        i, j = at
        if terms[1][1] == 1:
            return lambda v, _: v[i] + v[j]
        return lambda v, _: v[i] - v[j]

    def add(v: list[Any], _: Mapping[str, Any]) -> Any:
        out = None
        for k, c in terms:
            term = v[k] if c == 1 else v[k] * c
            out = term if out is None else out + term
        return out

    return add


def _logic(op: str, args: list[Any]) -> bool | None:
    if None in args:
        return None
    return not args[0] if op == "not" else all(args) if op == "and" else any(args)


Tangent = dict[tuple[int, int], Any]  # of an unknown and an order of derivative: its factor


def tangents(program: Program, values: list[Any], unknown: Mapping[str, int]) -> list[Tangent]:
    """How the value of every step moves with the unknowns: sum of factor * d^k/dt^k unknown."""
    out: list[Tangent] = []
    for (n, at), v in zip(program.steps, values, strict=True):
        below = [out[i] for i in at]
        here: Tangent = {}
        if n.op == "sym" and n.data in unknown:
            here = {(unknown[str(n.data)], 0): constant(1)}
        elif any(below):
            for factor, arg in _factors(n, [values[i] for i in at], v, below):
                if isinstance(factor, str):
                    arg = _differentiated(arg, int(factor))
                    factor = None
                for key, x in arg.items():
                    term = x if factor is None else factor * x
                    here[key] = here[key] + term if key in here else term
        out.append(here)
    return out


def _factors(n: Node, args: list[Any], v: Any, below: list[Tangent]) -> list[tuple[Any, Tangent]]:
    """Pairs of a factor (None: one, text: so many derivatives) and the tangent it multiplies."""
    match n.op:
        case "add":
            return [(exact(c), t) for c, t in zip(n.data, below, strict=True)]  # type: ignore[call-overload]
        case "mul":
            pairs = []
            for k, t in enumerate(below):
                if t:
                    rest = constant(1)
                    for i, x in enumerate(args):
                        if i != k:
                            rest = rest * x
                    pairs.append((rest, t))
            return pairs
        case "div":
            inverse = quotient(constant(1), args[1])
            return [(inverse, below[0]), (-v * inverse, below[1])]
        case "pow":
            c: Any = n.data
            return [(power(args[0], c - 1) * exact(c), below[0])]
        case "if":
            return [(None, below[1] if args[0] else below[2])]
        case "fn" if n.data in ("min", "max"):
            return [(None, below[0] if v is args[0] else below[1])]
        case "fn" if n.data == "atan2":
            y, x = args
            square = x * x + y * y
            return [(quotient(x, square), below[0]), (quotient(-y, square), below[1])]
        case "fn":
            return [(_slope(str(n.data), args[0], v), below[0])]
        case "der":
            return [(str(n.data), below[0])]
        case "table":
            return [(_interpolated(n.data, args[0])[1], below[0])]  # type: ignore[arg-type]
    return []


def _differentiated(t: Tangent, times: int) -> Tangent:
    for _ in range(times):
        out: Tangent = {}
        for (j, k), a in t.items():
            slope = a.derivative()
            out[j, k] = out[j, k] + slope if (j, k) in out else slope
            out[j, k + 1] = out[j, k + 1] + a if (j, k + 1) in out else a
        t = out
    return t
