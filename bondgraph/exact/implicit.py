"""Numbers of the field that solve an equation without a closed solution, and their series.

On a healthy plant the solution is known: it is the variable that the root stands for, and it has
to solve the equation. Where a fault acts, any solution in the field will do; a transcendental
function, which is a random table there, is given the value that makes the equation true.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import product
from random import Random
from typing import Any, NamedTuple

from bondgraph.exact import evaluate, polynomials
from bondgraph.exact.algebra import Mixed, Taylor, Waves
from bondgraph.exact.field import FORCED, P, Undefined, inverse, of_fraction
from bondgraph.exact.polynomials import Polynomial
from bondgraph.exact.series import Series
from bondgraph.ir.expr import Expr, Op, Symbol, topological

_TRIES = 8
_BRANCHES = 4  # nodes with a sign in them, whose sides are tried one by one

#: Functions whose power is their argument, up to a sign.
_RADICALS = {"sqrt": 2, "ssqrt": 2, "cbrt": 3}
#: Functions that are a power on each side of zero.
_SIDES = {"abs": 1, "ssq": 2, "sign": 0}


class _Inside:
    """The sample on which the equation of a root is looked at."""

    def __init__(self, algebra: Any, values: dict[Expr, Any]) -> None:
        self.algebra = algebra
        self._values = values

    def value(self, symbol: Expr) -> Any:
        return self._values[symbol]

    def start(self, initial: Symbol) -> int:
        raise Mixed("an integral inside a root")


def root_value(node: Expr, args: Sequence[Any], sample: Any, n: int) -> Any:
    """The root as a series: its value at the point, then one coefficient after the other.

    A sample without a plant (it has no `truly`) gets a random number, as if an argument were
    free to make the equation true. Raises `Undefined` where no solution is found, `Mixed` for
    exponentials.
    """
    algebra = sample.algebra
    if not isinstance(algebra, Taylor):
        if isinstance(algebra, Waves) and all(not a.degree for a in args):
            raise Undefined("a root of constants among exponentials")
        raise Mixed("an equation without a closed solution")
    root = node.root
    inside = dict(zip(root.places, args, strict=True))
    nodes = topological([root.zero])

    def zero(x: Series, size: int) -> tuple[Series, dict[Expr, Any]]:
        point = _Inside(algebra, {**inside, root.unknown: x})
        found, failures = evaluate.values_of(nodes, dict.fromkeys(nodes, size), point)
        if root.zero in failures:
            raise failures[root.zero]
        return found[root.zero], found

    lead = _lead(node, [a[0] for a in args], sample, lambda x: zero([x], 1)[0][0])
    series = [lead]
    if n > 1 and any(len(a) > 1 for a in args):
        steep = tangent(root.zero, root.unknown, zero(series, 1)[1], algebra, 1)[0]
        factor = -inverse(steep)
        for k in range(1, n):
            value = zero(series, k + 1)[0]
            series.append(value[k] * factor % P if k < len(value) else 0)
    return series


def root_slopes(node: Expr, value: Any, args: Sequence[Any], algebra: Any, n: int) -> list[Any]:
    """The partial derivatives of a root, by the theorem of the implicit function."""
    root = node.root
    point = _Inside(algebra, {**dict(zip(root.places, args, strict=True)), root.unknown: value})
    nodes = topological([root.zero])
    found, failures = evaluate.values_of(nodes, dict.fromkeys(nodes, n), point)
    if root.zero in failures:
        raise failures[root.zero]
    steep = tangent(root.zero, root.unknown, found, algebra, n)
    out = []
    for place in root.places:
        above = tangent(root.zero, place, found, algebra, n)
        out.append(algebra.combine([(-1, algebra.product([(above, 1), (steep, -1)], n))], n))
    return out


def tangent(root: Expr, wrt: Expr, values: dict[Expr, Any], algebra: Any, n: int) -> Any:
    """The partial derivative of an expression without D and Int, forwards."""
    slopes: dict[Expr, Any] = {wrt: algebra.number(1)}
    for node in topological([root]):
        if node is wrt or not any(a in slopes for a in node.args):
            continue
        parts = [
            (1, algebra.product([(slope, 1), (slopes[a], 1)], n))
            for a, slope in evaluate.slopes(node, values, algebra, n, False)
            if a in slopes
        ]
        slopes[node] = algebra.combine(parts, n) if parts else algebra.number(0)
    return slopes.get(root, algebra.number(0))


# ---------------------------------------------------------------------- the value at the point


def _lead(node: Expr, leads: list[int], sample: Any, zero: Callable[[int], int]) -> int:
    """A solution at the point, the same for equal arguments."""
    functions = sample.algebra.functions
    memo: dict[object, int] = functions.roots
    key = (node.root.zero, *leads)
    if key in memo:
        return memo[key]
    truly = getattr(sample, "truly", None)
    if truly is None:
        memo[key] = functions.draw()
        return memo[key]
    found: int | None = truly(node.root.variable)
    if found is None or zero(found):
        if sample.healthy:
            raise Undefined("a variable of the plant that does not solve its equation")
        found = _solve(node, leads, functions)
    memo[key] = found
    return found


def _solve(node: Expr, leads: list[int], functions: Any) -> int:
    """Any solution in the field; raises `Undefined` if none is found."""
    root = node.root
    leaves = {p: [x] for p, x in zip(root.places, leads, strict=True)}
    return solve(root.zero, {**leaves, root.unknown: [0, 1]}, [], functions)


def solve(zero: Expr, leaves: dict[Expr, Polynomial], rest: Polynomial, functions: Any) -> int:
    """A number z of the field at which `zero` + `rest` vanishes; raises `Undefined` without one.

    `leaves` gives the symbols of `zero` as polynomials in z of degree one or zero. Functions of z
    that are random tables get the values that make the equation true.
    """
    moving = {leaf for leaf, value in leaves.items() if len(value) > 1}
    nodes = topological([zero])
    for node in nodes:
        if any(a in moving for a in node.args):
            moving.add(node)
    open_ones = [n for n in nodes if n in moving and n.op is Op.FN]
    forced = [n for n in open_ones if n.name in FORCED or n.name.startswith("table:")]
    work = _Polynomials(functions, zero, leaves, rest)
    for _ in range(_TRIES):
        try:
            return work.by_function(forced[-1]) if forced else work.by_sides(open_ones)
        except Undefined:
            continue
    raise Undefined("no solution of an equation was found")


class _Rational(NamedTuple):
    above: Polynomial
    below: Polynomial


class _Polynomials:
    """Solves an equation that is rational in one open quantity."""

    def __init__(
        self, functions: Any, zero: Expr, leaves: dict[Expr, Polynomial], rest: Polynomial
    ) -> None:
        self.functions = functions
        self.zero = zero
        self.leaves = leaves
        self.rest = rest
        self.random = Random(functions.draw())

    def by_function(self, forced: Expr) -> int:
        """A random number, and the value that a function must have there."""
        z: int = self.functions.draw()
        at = self._at(z)
        inner = _number(self.value(forced.args[0], dict(at), {}))
        total = self.value(self.zero, {**at, forced: _Rational([0, 1], [1])}, {})
        for found in self.roots(total, [_in(self.rest, z)]):
            try:
                self.functions.force(forced.name, inner, found)
            except Undefined:
                continue
            if self.solves(z):
                return z
        raise Undefined("no value of a function solves an equation")

    def by_sides(self, functions: list[Expr]) -> int:
        """A root of a polynomial, with the sides of absolute values guessed and checked."""
        radicals = [n for n in functions if n.name in _RADICALS]
        if radicals:
            return self.by_radical(radicals[0], [n for n in functions if n is not radicals[0]])
        sided = [n for n in functions if n.name in _SIDES or n.name in ("min", "max")]
        if len(sided) > _BRANCHES:
            raise Undefined("an equation with many sides")
        leaves = {leaf: _Rational(polynomials.trim(v), [1]) for leaf, v in self.leaves.items()}
        for sides in product((1, -1), repeat=len(sided)):
            guessed = dict(zip(sided, sides, strict=True))
            total = self.value(self.zero, dict(leaves), guessed)
            for z in self.roots(total, self.rest):
                if self.solves(z):
                    return z
        raise Undefined("no number of the field solves an equation")

    def by_radical(self, radical: Expr, others: list[Expr]) -> int:
        """A root of a number linear in z is the open quantity, and gives z."""
        leaves = {leaf: _Rational(polynomials.trim(v), [1]) for leaf, v in self.leaves.items()}
        inner = self.value(radical.args[0], leaves, {})
        if len(inner.above) != 2 or len(inner.below) != 1 or others:
            raise Undefined("a root of a root")
        scale = inverse(inner.above[1])
        for side in (1, -1) if radical.name == "ssqrt" else (1,):
            square = [0] * _RADICALS[radical.name] + [side * inner.below[0] % P]
            z = polynomials.mul(polynomials.add(square, [-inner.above[0] % P]), [scale])
            at = {leaf: _Rational(_of(v, z), [1]) for leaf, v in self.leaves.items()}
            at[radical] = _Rational([0, 1], [1])
            for w in self.roots(self.value(self.zero, at, {}), _of(self.rest, z)):
                if self.solves(_in(z, w)):
                    return _in(z, w)
        raise Undefined("no root in the field")

    def solves(self, z: int) -> bool:
        """Whether the equation is true, decisions included."""
        algebra = Taylor(self.functions)
        point = _Inside(algebra, {leaf: [_in(v, z)] for leaf, v in self.leaves.items()})
        try:
            value = evaluate.evaluate([self.zero], point)[0][0]
        except (Undefined, Mixed):
            return False
        total: int = (value + _in(self.rest, z)) % P
        return not total

    def value(self, root: Expr, values: dict[Expr, _Rational], sides: dict[Expr, int]) -> _Rational:
        """An expression as a rational function of the open quantity."""
        for node in topological([root]):
            if node not in values:
                values[node] = _rational(node, values, self.functions, sides)
        return values[root]

    def roots(self, value: _Rational, rest: Polynomial) -> list[int]:
        """Where a rational expression plus a polynomial vanishes."""
        total = polynomials.add(value.above, polynomials.mul(rest, value.below))
        return polynomials.roots_of(total, self.random)

    def _at(self, z: int) -> dict[Expr, _Rational]:
        return {
            leaf: _Rational(polynomials.trim([_in(v, z)]), [1]) for leaf, v in self.leaves.items()
        }


def _of(polynomial: Polynomial, z: Polynomial) -> Polynomial:
    """A polynomial of degree one or less in a polynomial."""
    scaled = polynomials.mul(z, polynomial[1:])
    return polynomials.add(scaled, polynomials.trim(polynomial[:1]))


def _in(polynomial: Polynomial, z: int) -> int:
    """The value of a polynomial."""
    out = 0
    for c in reversed(polynomial):
        out = (out * z + c) % P
    return out


def _rational(
    node: Expr, values: dict[Expr, _Rational], functions: Any, sides: dict[Expr, int]
) -> _Rational:
    args = [values[a] for a in node.args]
    match node.op:
        case Op.NUM:
            return _Rational(polynomials.trim([of_fraction(node.number)]), [1])
        case Op.ADD:
            total = _Rational([], [1])
            for c, a in zip(node.coefficients, args, strict=True):
                scaled = polynomials.mul(a.above, [of_fraction(c)])
                total = _Rational(
                    polynomials.add(
                        polynomials.mul(total.above, a.below), polynomials.mul(scaled, total.below)
                    ),
                    polynomials.mul(total.below, a.below),
                )
            return total
        case Op.MUL:
            return _product(list(zip(args, node.exponents, strict=True)))
        case Op.FN if node in sides:
            return _on_side(node, args, sides[node])
        case Op.FN:
            numbers = [[_number(a)] for a in args]
            found = Taylor(functions).function(node.name, numbers, 1)
            return _Rational(polynomials.trim([found[0]]), [1])
        case _:
            raise Undefined("a decision on an open quantity")


def _on_side(node: Expr, args: list[_Rational], side: int) -> _Rational:
    if node.name in ("min", "max"):
        return args[0] if side > 0 else args[1]
    power = _product([(args[0], _SIDES[node.name])])
    return _Rational(polynomials.mul(power.above, [side % P]), power.below)


def _product(factors: list[tuple[_Rational, int]]) -> _Rational:
    above: Polynomial = [1]
    below: Polynomial = [1]
    for value, exponent in factors:
        up, down = (value.above, value.below) if exponent > 0 else (value.below, value.above)
        if not down:
            raise Undefined("division by zero")
        for _ in range(abs(exponent)):
            above, below = polynomials.mul(above, up), polynomials.mul(below, down)
    return _Rational(above, below)


def _number(value: _Rational) -> int:
    """A rational function that is constant."""
    if len(value.above) > 1 or len(value.below) != 1:
        raise Undefined("a function of an open quantity")
    return (value.above[0] if value.above else 0) * inverse(value.below[0]) % P
