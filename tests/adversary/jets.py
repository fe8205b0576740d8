"""Truncated power series with 40 digits, and the evaluation of SymPy expressions on them."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import mpmath
import sympy
from mpmath import mpf
from mpmath.libmp import from_man_exp

mpmath.mp.dps = 40
Jet = list[Any]  # the Taylor coefficients, lowest first


def constant(value: Any, n: int) -> Jet:
    return [mpf(value)] + [mpf(0)] * (n - 1)


def add(a: Jet, b: Jet) -> Jet:
    return [x + y for x, y in zip(a, b, strict=False)]


def scale(c: Any, a: Jet) -> Jet:
    return [c * x for x in a]


def mul(a: Jet, b: Jet) -> Jet:
    """Each coefficient is summed exactly and rounded once, as `mpmath.fdot` does, but on integers:
    products of series are most of what the judge computes."""
    n = min(len(a), len(b))
    one, other = _whole(a[:n]), _whole(b[:n])
    if one is None or other is None:
        return [mpmath.fdot([(a[i], b[k - i]) for i in range(k + 1)]) for k in range(n)]
    (x, low), (y, lower), prec = one, other, mpmath.mp.prec
    sums = [sum(map(operator.mul, x[: k + 1], y[k::-1])) for k in range(n)]
    return [mpmath.mp.make_mpf(from_man_exp(s, low + lower, prec, "n")) for s in sums]


def _whole(a: Jet) -> tuple[list[int], int] | None:
    """Integers and an exponent of two that are the same numbers; None where they are not finite."""
    parts = [getattr(x, "_mpf_", (0, 0, 1, 0)) for x in a]
    if any(exp and not man for _, man, exp, _ in parts):
        return None
    low = min((exp for _, man, exp, _ in parts if man), default=0)
    shifted = [man << (exp - low) if man else 0 for _, man, exp, _ in parts]
    return [-x if sign else x for x, (sign, *_) in zip(shifted, parts, strict=True)], low


def div(a: Jet, b: Jet) -> Jet:
    n = min(len(a), len(b))
    out: Jet = []
    for k in range(n):
        out.append((a[k] - mpmath.fdot([(out[i], b[k - i]) for i in range(k)])) / b[0])
    return out


def der(a: Jet, n: int = 1) -> Jet:
    for _ in range(n):
        a = [k * a[k] for k in range(1, len(a))]
    return a


def integral(a: Jet, start: Any) -> Jet:
    return [mpf(start)] + [a[k] / (k + 1) for k in range(len(a))]


def _through(a: Jet, f0: Any, slope: Callable[[Jet], Jet]) -> Jet:
    """F with F' = slope(F) a', for example exp: slope(F) = F."""
    out = [mpf(f0)]
    rate = der(a)
    for k in range(1, len(a)):
        s = slope(out)
        out.append(mpmath.fdot([(s[i], rate[k - 1 - i]) for i in range(k)]) / k)
    return out


def _of_argument(a: Jet, f0: Any, slope: Jet) -> Jet:
    rate = mul(slope, der(a)) if len(a) > 1 else []
    return integral(rate, f0)[: len(a)]


def power(a: Jet, c: Any) -> Jet:
    if c == int(c):
        out = constant(1, len(a))
        for _ in range(abs(int(c))):
            out = mul(out, a)
        return out if c >= 0 else div(constant(1, len(a)), out)
    c = mpf(c)
    out = [a[0] ** c]
    for k in range(1, len(a)):
        out.append(
            mpmath.fsum((c * i - (k - i)) * a[i] * out[k - i] for i in range(1, k + 1)) / (k * a[0])
        )
    return out


def sign_of(a: Jet) -> int:
    for x in a:
        if abs(x) > mpf(10) ** -25:
            return 1 if x > 0 else -1
    return 0


def sincos(a: Jet, hyperbolic: bool = False) -> tuple[Jet, Jet]:
    s0, c0 = (
        (mpmath.sinh(a[0]), mpmath.cosh(a[0]))
        if hyperbolic
        else (mpmath.sin(a[0]), mpmath.cos(a[0]))
    )
    s, c = [s0], [c0]
    rate = der(a)
    for k in range(1, len(a)):
        ds = mpmath.fdot([(c[i], rate[k - 1 - i]) for i in range(k)]) / k
        dc = mpmath.fdot([(s[i], rate[k - 1 - i]) for i in range(k)]) / k
        s.append(ds)
        c.append(dc if hyperbolic else -dc)
    return s, c


def function(name: str, args: Sequence[Jet]) -> Jet:
    a = args[0]
    n = len(a)
    one = constant(1, n)
    match name:
        case "exp":
            return _through(a, mpmath.exp(a[0]), lambda f: f)
        case "log":
            return _of_argument(a, mpmath.log(a[0]), div(one, a))
        case "sin":
            return sincos(a)[0]
        case "cos":
            return sincos(a)[1]
        case "tan":
            return div(*sincos(a))
        case "sinh":
            return sincos(a, True)[0]
        case "cosh":
            return sincos(a, True)[1]
        case "tanh":
            return div(*sincos(a, True))
        case "atan":
            return _of_argument(a, mpmath.atan(a[0]), div(one, add(one, mul(a, a))))
        case "asin":
            root = power(add(one, scale(-1, mul(a, a))), 0.5)
            return _of_argument(a, mpmath.asin(a[0]), div(one, root))
        case "acos":
            return add(constant(mpmath.pi / 2, n), scale(-1, function("asin", args)))
        case "asinh":
            root = power(add(one, mul(a, a)), 0.5)
            return _of_argument(a, mpmath.asinh(a[0]), div(one, root))
        case "acosh":
            root = power(add(mul(a, a), scale(-1, one)), 0.5)
            return _of_argument(a, mpmath.acosh(a[0]), div(one, root))
        case "atanh":
            slope = div(one, add(one, scale(-1, mul(a, a))))
            return _of_argument(a, mpmath.atanh(a[0]), slope)
        case "Abs" | "myabs":
            return scale(sign_of(a), a)
        case "sign" | "mysign":
            return constant(sign_of(a), n)
        case "sqrt":
            return power(a, 0.5)
        case "ssqrt":
            s = sign_of(a)
            return scale(s, power(scale(s, a), 0.5))
        case "cbrt":
            s = sign_of(a)
            return scale(s, power(scale(s, a), mpf(1) / 3))
        case "Min" | "Max":
            best = a
            for b in args[1:]:
                d = sign_of(add(best, scale(-1, b)))
                if (d > 0) == (name == "Min"):
                    best = b
            return best
        case "atan2":
            lead = mpmath.atan2(args[0][0], args[1][0])
            out = function("atan", [div(args[0], args[1])])
            return [lead, *out[1:]]
    raise NotImplementedError(name)


def _names(e: Any) -> set[str]:
    return {symbol.name for symbol in e.free_symbols}


class _Outside(NamedTuple):
    """Of the search for a root: what the names that move with it are no part of, evaluated once."""

    of: Evaluator
    moved: set[str]
    known: dict[Any, bool]

    def holds(self, e: Any) -> bool:
        if e not in self.known:
            self.known[e] = not _names(e) & self.moved
        return self.known[e]


class Evaluator:
    """Values of SymPy expressions; `signals` gives the jet, number or truth of every symbol.

    `fixed_integrals` replaces the start of every Int by a number of its own, so that the jets
    need not begin where the integrals do. `roots` gives expressions that vanish at a symbol which
    is no signal, each with a number to start from.
    """

    def __init__(
        self,
        signals: Mapping[str, Any],
        n: int,
        free_integrals: bool = False,
        roots: Mapping[str, tuple[Any, float]] | None = None,
    ) -> None:
        self.signals = signals
        self.roots = roots or {}
        self.n = n
        self.free = free_integrals
        self.memo: dict[Any, Any] = {}
        self.starts: dict[Any, Any] = {}
        self.outside: _Outside | None = None

    def truth(self, e: Any) -> bool:
        if e is sympy.true or e is True:
            return True
        if e is sympy.false or e is False:
            return False
        if isinstance(e, sympy.Symbol):
            value = self.signals[e.name]
            assert isinstance(value, bool), e
            return value
        if isinstance(e, sympy.Not):
            return not self.truth(e.args[0])
        if isinstance(e, sympy.And):
            return all(self.truth(a) for a in e.args)
        if isinstance(e, sympy.Or):
            return any(self.truth(a) for a in e.args)
        if isinstance(e, sympy.ITE):
            return self.truth(e.args[1] if self.truth(e.args[0]) else e.args[2])
        if isinstance(e, sympy.core.relational.Relational):
            if all(self.is_boolean(a) for a in e.args):
                same = self.truth(e.args[0]) == self.truth(e.args[1])
                return same == isinstance(e, sympy.Eq)
            d = sign_of(add(self(e.args[0]), scale(-1, self(e.args[1]))))
            return {
                "<": d < 0,
                "<=": d <= 0,
                ">": d > 0,
                ">=": d >= 0,
                "==": d == 0,
                "!=": d != 0,
            }[e.rel_op]
        raise NotImplementedError(e)

    def is_boolean(self, e: Any) -> bool:
        if isinstance(e, sympy.Symbol):
            return isinstance(self.signals[e.name], bool)
        return isinstance(e, sympy.logic.boolalg.Boolean)

    def __call__(self, e: Any) -> Jet:
        if e not in self.memo:
            outside = self.outside is not None and self.outside.holds(e)
            self.memo[e] = self.outside.of(e)[: self.n] if outside else self._value(e)
        return self.memo[e]

    def _root(self, name: str, zero: Any, guess: float) -> Jet:
        """The lead by a bracket and bisection with secants, the rest one coefficient at a time."""
        others = {k: v for k, v in self.roots.items() if k != name}
        moved = {name}
        for _ in others:
            moved |= {k for k, (z, _) in others.items() if _names(z) & moved}
        apart: dict[Any, bool] = {}

        def at(jet: Jet) -> Jet:
            inner = Evaluator({**self.signals, name: jet}, len(jet), self.free, others)
            inner.starts, inner.outside = self.starts, _Outside(self, moved, apart)
            return inner(zero)

        known = len(at(constant(guess, self.n)))
        least = self.n - known + 1  # coefficients that the first of the result rests on

        def lead(x: Any) -> Any:
            return at(constant(x, least))[0]

        jet = constant(_bracketed(lead, mpf(guess)), self.n)
        for k in range(1, known):
            other = [*jet[:k], mpf(1), *jet[k + 1 :]]
            here, there = at(jet)[k], at(other)[k]
            jet[k] = -here / (there - here)
        return jet[:known]

    def _value(self, e: Any) -> Jet:
        if e.is_Number or e.is_NumberSymbol:
            return constant(mpmath.mpmathify(e.evalf(40)), self.n)
        if isinstance(e, sympy.Symbol):
            if e.name in self.roots:
                return self._root(e.name, *self.roots[e.name])
            value = self.signals[e.name]
            return value if isinstance(value, list) else constant(value, self.n)
        if isinstance(e, sympy.Add):
            out = self(e.args[0])
            for a in e.args[1:]:
                out = add(out, self(a))
            return out
        if isinstance(e, sympy.Mul):
            out = self(e.args[0])
            for a in e.args[1:]:
                out = mul(out, self(a))
            return out
        if isinstance(e, sympy.Pow):
            if e.args[1].is_Rational:
                c = e.args[1]
                return power(self(e.args[0]), int(c) if c.is_Integer else mpf(c.p) / c.q)
            exponent = self(e.args[1])
            return function("exp", [mul(exponent, function("log", [self(e.args[0])]))])
        if isinstance(e, sympy.Piecewise):
            for value, condition in e.args:
                if self.truth(condition):
                    return self(value)
            raise ValueError("no branch holds")
        name = e.func.__name__
        if name == "D":
            return der(self(e.args[0]), int(e.args[1]))
        if name == "Int":
            if self.free:
                start = self.starts.setdefault(e, mpf(1) / (3 + len(self.starts)))
            else:
                start = self(e.args[1])[0]
            return integral(self(e.args[0]), start)[: self.n]
        return function(name, [self(a) for a in e.args])


def _bracketed(f: Callable[[Any], Any], guess: Any) -> Any:
    """The zero of a function that grows or falls everywhere."""
    width = mpf(1) / 64
    low = high = guess
    while f(low) * f(high) > 0:
        low, high, width = guess - width, guess + width, 2 * width
    below, above, stale = f(low), f(high), 0
    for step in range(400):
        if not below or not above or high - low <= mpf(10) ** -60:
            break
        # a secant with the kept end halved (Illinois); every fourth time the middle, for corners
        share = below / (below - above) if step % 4 else mpf(1) / 2
        middle = low + share * (high - low)
        if middle in (low, high):
            return middle  # no number lies between
        value = f(middle)
        if (value > 0) == (below > 0):
            low, below = middle, value
            above, stale = (above / 2 if stale < 0 else above), -1
        else:
            high, above = middle, value
            below, stale = (below / 2 if stale > 0 else below), 1
    return low if not below else high if not above else (low + high) / 2
