"""Random laws of resistors, storages and sensors, by the functions of the language."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import cache

from tests.real.build import Build, Law, Points
from tests.real.nodes import Node, choose, compare, fn, node, sym, table

E, F, Q, P = (sym(x) for x in "efqp")
_K = Callable[[], Node]


def _limited(x: Node, bound: Node) -> Node:
    return fn("min", fn("max", x, -bound), bound)


#: Efforts as functions of a flow x; k draws a coefficient. The flows of an effort are of the
#: same kind. Those marked fold back or rest somewhere, so that only one side is explicit.
GROWING: list[Callable[[Node, _K], Node]] = [
    lambda x, k: k() * x * fn("abs", x),
    lambda x, k: k() * x + k() * x**3,
    lambda x, k: k() * fn("tanh", x / k()) + k() * x,
    lambda x, k: k() * x + k() * x * fn("abs", x),
    lambda x, k: k() * _limited(x, node(1)) + k() * x,
    lambda x, k: k() * fn("ssqrt", x),
    lambda x, k: k() * (fn("exp", x / k()) - 1),
    lambda x, k: k() * fn("atan", x),
    lambda x, k: choose(compare("<", x, 0), k() * x, k() * x),
    lambda x, k: k() * fn("sinh", x),
    lambda x, k: k() * fn("asinh", x / k()),
    lambda x, k: k() * x / (1 + fn("abs", x)),
    lambda x, k: k() * x + fn("sin", x) / 2 * k(),
    lambda x, k: k() * fn("sign", x) * fn("abs", x) ** Fraction(3, 2),
    lambda x, k: k() * fn("log", 1 + fn("abs", x)) * fn("sign", x),
]
FLAT: list[Callable[[Node, _K], Node]] = [
    lambda x, k: k() * (x - _limited(x, node(1))),
    lambda x, k: k() * (fn("max", x - 1, 0) + fn("min", x + 1, 0)),
    lambda x, k: k() * _limited(x, k()),
    lambda x, k: k() * fn("max", x, 0),
    lambda x, k: k() * x**2,
    lambda x, k: k() * fn("sin", x),
    lambda x, k: k() * fn("cos", x) + x,
    lambda x, k: choose(compare(">", fn("abs", x), 1), k() * (x - fn("sign", x)), 0),
]
#: Only where x is positive.
POSITIVE: list[Callable[[Node, _K], Node]] = [
    lambda x, k: k() * fn("log", x / k()),
    lambda x, k: k() * fn("sqrt", x),
    lambda x, k: k() * x ** Fraction(3, 2),
    lambda x, k: k() / x,
    lambda x, k: k() * x**2 / k(),
]


def points(build: Build) -> Points:
    """Rows of a table that rises, with a flat piece now and then."""
    random = build.random
    flat = random.random() < 0.3
    x, y = Fraction(random.choice((-4, -3, -2))), Fraction(random.choice((-6, -3)))
    rows = [(x, y)]
    for _ in range(random.randint(2, 4)):
        x += random.choice((Fraction(1), Fraction(2), Fraction(3, 2)))
        if not (flat and random.random() < 0.5):
            y += random.choice((Fraction(1), Fraction(2), Fraction(1, 2), Fraction(3)))
        rows.append((x, y))
    return tuple(rows)


def _curve(build: Build, x: Node) -> Node:
    """A random function of x with coefficients of its own."""
    random = build.random
    draw = random.random()
    k = build.coefficient
    if draw < 0.1:
        rows = points(build)
        return k() * table(build.table(rows), rows, x) + (k() * x if random.random() < 0.5 else 0)
    which = GROWING if draw < 0.75 else FLAT if draw < 0.9 else POSITIVE
    return random.choice(which)(x, k)


def resistor(build: Build, bent: float) -> Law:
    """A law of an R: linear, or with the given chance a curve in one of its two directions."""
    if build.random.random() >= bent:
        k = build.coefficient()
        return Law("e", k * F, {"f": E / k})
    if build.random.random() < 0.5:
        return Law("e", _curve(build, F))
    return Law("f", _curve(build, E))


def storage(build: Build, kind: str, bent: float) -> Law:
    """A law of a C (effort of its charge) or an I (flow of its momentum)."""
    state, out = ("q", "e") if kind == "C" else ("p", "f")
    x = sym(state)
    if build.random.random() >= bent:
        k = build.coefficient()
        return Law(out, x / k, {state: k * sym(out)})
    if build.random.random() < 0.15:
        k = build.coefficient()
        return Law(out, x / fn("sqrt", k**2 + x**2))
    return Law(out, _curve(build, x))


def readings(build: Build, a: Node, b: Node) -> Node:
    """What a sensor may show of two quantities."""
    k = build.coefficient
    shared = cache(k)  # the same each time

    def diodes() -> Node:
        v, i = k(), k()
        return v * fn("log", a / i) - v * fn("log", b / i)

    def powers() -> Node:
        n = build.random.choice((2, 3))
        return a**n / b**n

    made: list[Callable[[], Node]] = [
        diodes,
        diodes,
        powers,
        lambda: fn("log", a * b),
        lambda: fn("log", a / b),
        lambda: fn("log", k() * a),
        lambda: fn("exp", a - b),
        lambda: fn("sqrt", a * b),
        lambda: fn("exp", fn("log", a) * 2) * k(),
        lambda: a * b,
        lambda: a - b,
        lambda: k() * a + b,
        lambda: fn("abs", a),
        lambda: fn("max", a, b),
        lambda: fn("min", a, k()),
        lambda: fn("tanh", k() * a),
        lambda: fn("atan2", a, b),
        lambda: fn("sin", a),
        lambda: fn("sin", a) ** 2 + fn("cos", a) ** 2 * b,
        lambda: choose(compare(">", a, b), a, b),
        lambda: a / (a + b),
        lambda: fn("ssqrt", a - b),
        lambda: k() * fn("max", fn("tanh", a) - 1, 0) + b,  # never
        lambda: k() * choose(compare(">", fn("sin", a), 2), a, 0) + b,  # never
        lambda: fn("exp", shared() * fn("log", a)) / fn("exp", shared() * fn("log", 2 * a)),
        lambda: fn("sqrt", (shared() * a) ** 2) / shared(),
        lambda: shared() * a / (shared() * b),
        lambda: fn("exp", shared() * a) * fn("exp", -(shared() * b)),
        lambda: fn("abs", shared() * a) - shared() * fn("abs", b),
        lambda: fn("atan2", shared() * a, shared() * b),
    ]
    return build.random.choice(made)()


def related(build: Build, a: Node, b: Node) -> tuple[Node, ...]:
    """Readings that functions tie together."""
    k = build.coefficient
    shared = cache(build.param)  # the same each time
    made: list[Callable[[], tuple[Node, ...]]] = [
        lambda: (fn("log", a), fn("log", b), fn("log", a * b)),
        lambda: (fn("log", a), fn("log", shared() * a)),
        lambda: (fn("log", a / shared()), fn("log", b / shared()), a / b),
        lambda: (fn("sin", a), fn("cos", a)),
        lambda: (fn("exp", a), fn("exp", b), fn("exp", a + b)),
        lambda: (fn("abs", a), a**2),
        lambda: (fn("max", a, b), fn("min", a, b), a + b),
        lambda: (a * b, a / b),
        lambda: (shared() * a, shared() * b),
        lambda: (shared() * a, fn("exp", shared() * a)),
        lambda: (fn("tanh", a), fn("exp", 2 * a)),
        lambda: (fn("min", a, 1), fn("max", a, 1)),
        lambda: (fn("sqrt", a), a * fn("sqrt", a) * k()),
        lambda: (fn("sinh", a), fn("cosh", a)),
        lambda: (fn("ssqrt", a), a * fn("abs", a)),
        lambda: (fn("sin", 2 * a), fn("sin", a) * fn("cos", a)),
    ]
    return build.random.choice(made)()
