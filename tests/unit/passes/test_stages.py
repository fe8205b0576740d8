"""What comes out of `step` is what its transfer function says, sample by sample.

The reference shares nothing with the compiler: the trapezoid rule D and the stage H are power
series in the delay z of one sample (docs/decisions/hold.md), multiplied with the samples. Before
its first sample a signal is taken to have been constant.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from itertools import accumulate, pairwise
from typing import NamedTuple

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson
from scipy.stats import gamma

from bondgraph.ir.expr import Expr, Kind
from bondgraph.ir.normal import Term
from bondgraph.ir.program import Program
from bondgraph.passes.lowering.law_chain import order
from bondgraph.passes.lowering.stages import BEGIN
from tests.sampled import Sampled
from tests.unit.passes.lowering_models import Bench, drive

Samples = list[Fraction]

SLOW = Fraction(1, 10), Fraction(3)  # sample time in s and bandwidth in rad/s
QUICK = SLOW[0], Fraction(8)
LAWS = QUICK[0], Fraction(16)  # the same in front of laws: 1.6 is above the root of 0.8
_LONG = 12
X = [Fraction(n, 3) for n in (2, -1, 4, 4, 0, -7, 5, 1, 1, 3, -2, 6)]
Y = [Fraction(n, 2) for n in (1, 3, -2, 5, 5, 1, 0, -4, 2, 2, 7, -1)]
U = [Fraction(n) for n in (-1, 2, 2, 3, -5, 1, 4, 0, 0, 6, -2, 3)]
COUNTS = [40, 47, 45, 45, 61, 80, 79, 70, 70, 71, 90, 64]


def times(left: Samples, right: Samples) -> Samples:
    """The product of two series, as far as they go."""
    return [sum((left[i] * right[n - i] for i in range(n + 1)), Fraction()) for n in range(_LONG)]


def over(left: Samples, right: Samples) -> Samples:
    """The quotient of two series, by long division."""
    found: Samples = []
    for n in range(_LONG):
        rest = left[n] - sum((found[i] * right[n - i] for i in range(n)), Fraction())
        found.append(rest / right[0])
    return found


def series(*first: int) -> Samples:
    return [Fraction(n) for n in first] + [Fraction()] * (_LONG - len(first))


class Reference(NamedTuple):
    """A filter whose residual has order `highest`, for sample time and bandwidth."""

    highest: int
    time: Fraction = SLOW[0]
    bandwidth: Fraction = SLOW[1]

    def derivative(self) -> Samples:
        """D = 2/T (1-z)/(1+z)."""
        return [2 / self.time * c for c in over(series(1, -1), series(1, 1))]

    def stage(self) -> Samples:
        """H = 1/(1 + D/w)."""
        slope = self.derivative()
        w = min(self.bandwidth, 2 / self.time)
        return over(series(1), [one + c / w for one, c in zip(series(1), slope, strict=True)])

    def passed(self, k: int, u: Samples, stages: int | None = None) -> Samples:
        """p**k F of samples: D**k (1 - (K-k) (D T)**2/12) H**(K+1)."""
        slope = self.derivative()
        transfer = series(1)
        for _ in range(k):
            transfer = times(transfer, slope)
        bend = times(transfer, times(slope, slope))
        off = (self.highest - k) * self.time**2 / 12
        transfer = [a - off * b for a, b in zip(transfer, bend, strict=True)]
        for _ in range(self.highest + 1 if stages is None else stages):
            transfer = times(transfer, self.stage())
        moved = times(transfer, [value - u[0] for value in u])
        return [value + (u[0] if k == 0 else 0) for value in moved]


def came_out(
    program: Program, samples: dict[str, Samples], filter: tuple[Fraction, Fraction] = SLOW
) -> Samples:
    """The residual r1 at each sample, in fractions."""
    time, bandwidth = filter
    params = {f.name: Fraction(str(f.default)) for f in program.params}
    run = Sampled(program, params, real=Fraction, sample_time=time, bandwidth=bandwidth)
    return [
        run.step({name: values[n] for name, values in samples.items()}).residuals["r1"]
        for n in range(_LONG)
    ]


def behind_laws(filter: Reference, program: Program, k: int, law: Samples) -> Samples:
    """p**k F of what a law gives: at rest until what starts in front of it has settled."""
    (info,) = program.residuals
    held = math.ceil(gamma.isf(1e-3, info.laws) / float(LAWS[0] * LAWS[1])) - 1
    assert 0 < held < _LONG - 3
    later = [*law[held:], *[law[-1]] * held]
    passed = filter.passed(k, later, info.stages)[: _LONG - held]
    return [*(value if k == 0 else Fraction() for value in law[:held]), *passed]


def close(found: Samples, expected: Samples) -> bool:
    """As close as doubles hold the numbers that stand in the program, such as 1/12."""
    size = max(map(abs, expected))
    return size > 0 and all(
        abs(a - b) <= size * Fraction(1, 10**13) for a, b in zip(found, expected, strict=True)
    )


def high(bench: Bench, symbol: Expr, times: int) -> Expr:
    for _ in range(times):
        symbol = bench.pool.der(symbol)
    return symbol


# ---------------------------------------------------------------- linear


_PLANTS = {
    "one of each order": [(5, "x", 3), (-4, "y", 2), (3, "u", 1), (-7, "x", 0), (2, "y", 0)],
    "two of the highest": [(-5, "x", 2), (-4, "y", 2), (3, "u", 0)],
    "a gap": [(6, "x", 3), (-2, "y", 0), (-1, "x", 0)],
    "nothing of order 0": [(-6, "x", 2), (2, "y", 1), (3, "u", 1)],
    "a single sample": [(4, "x", 0), (-3, "y", 0)],
}


@pytest.mark.parametrize("name", _PLANTS)
@pytest.mark.parametrize("filter", [SLOW, (Fraction(1, 5), Fraction(30))])
def test_each_derivative_passes_the_same_filter(
    name: str, filter: tuple[Fraction, Fraction]
) -> None:
    """Also with a bandwidth above what the samples allow, where it is the mean of two of them."""
    bench = Bench()
    pool = bench.pool
    signals = {"x": bench.sensor("x"), "y": bench.sensor("y"), "u": bench.input("u")}
    terms = _PLANTS[name]
    named = [bench.param(f"p{i}", str(abs(c))) for i, (c, _, _) in enumerate(terms)]
    program = bench.program(
        pool.add(
            *(
                (1 if c > 0 else -1, pool.mul(p, high(bench, signals[s], k)))
                for p, (c, s, k) in zip(named, terms, strict=True)
            ),
            (1, bench.param("p_", "0.5")),
        )
    )
    samples = {"x": X, "y": Y, "u": U}
    used = {s for _, s, _ in terms}
    found = came_out(program, {s: v for s, v in samples.items() if s in used}, filter)
    reference = Reference(max(k for _, _, k in terms), *filter)
    parts = [[c * v for v in reference.passed(k, samples[s])] for c, s, k in terms]
    assert close(found, [sum(at) + Fraction(1, 2) for at in zip(*parts, strict=True)])


def test_a_residual_has_one_memory_a_stage_whatever_signals_it_has() -> None:
    """So few as the order of its transfer function has poles."""
    for count in (1, 4):
        bench = Bench()
        pool = bench.pool
        signals = [bench.sensor(f"y{i}") for i in range(count)]
        every = [(k + 1, high(bench, s, k)) for s in signals for k in range(4)]
        assert len(bench.program(pool.add(*every)).states) == 4


def test_a_product_of_derivatives_has_a_chain_of_stages_for_each_signal() -> None:
    """In front of it, and one for all behind it."""
    bench = Bench()
    pool = bench.pool
    x, y = bench.sensor("x"), bench.sensor("y")
    program = bench.program(pool.mul(pool.der(x), pool.der(y), pool.power(x, 2)))
    assert (program.residuals[0].stages, program.residuals[0].laws) == (2, 2)
    assert len(program.states) == 2 * 2 + 2 + 1  # and how far it has begun


def test_the_first_sample_empties_the_memory_before_all_else() -> None:
    bench = Bench()
    program = bench.program(drive(bench)[0], bench.pool.der(bench.sensor("Ws")))
    for name in ("r1", "r2"):
        own = [s for s in program.first if s.target.name.startswith(name)]
        empties = [s.comment == BEGIN for s in own]
        assert empties == sorted(empties, reverse=True) and any(empties)
        assert all(s.target.space == "state" for s in own if s.comment == BEGIN)


# -------------------------------------------------------------- encoders


def _angle(start: Fraction) -> Samples:
    turn = Fraction(2 * math.pi)  # a hundred counts
    return [start + (n - COUNTS[0]) * turn / 100 for n in COUNTS]


@pytest.mark.parametrize("orders", [(0,), (1,), (2,), (0, 1), (0, 1, 2), (0, 3)])
def test_counts_pass_as_the_angle_that_they_stand_for(orders: tuple[int, ...]) -> None:
    """From the start that is declared, though no angle is formed where only its speed is asked."""
    bench = Bench()
    pool = bench.pool
    bench.initial("th0", pool.num(Fraction(3, 4)))
    reads = pool.symbol("th0 state", Kind.INTEGRAL)
    angle, x = bench.sensor("th", counts=100, reads=reads), bench.sensor("x")
    factors = [bench.param(f"a{k}", str(2 + k)) for k in orders]
    terms = [pool.mul(a, high(bench, angle, k)) for a, k in zip(factors, orders, strict=True)]
    program = bench.program(pool.add(*((-1, t) for t in terms), (1, x)))
    assert all(known.sampled for known in program.knowns)
    found = came_out(program, {"th": [Fraction(n) for n in COUNTS], "x": X})
    reference = Reference(max(orders))
    expected = reference.passed(0, X)
    for k in orders:
        part = reference.passed(k, _angle(Fraction(3, 4)))
        expected = [e - (2 + k) * p for e, p in zip(expected, part, strict=True)]
    assert close(found, expected)


def test_an_angle_in_two_products() -> None:
    bench = Bench()
    pool = bench.pool
    angle, x, y = bench.sensor("th", counts=100), bench.sensor("x"), bench.sensor("y")
    both = pool.add((1, pool.mul(x, angle)), (1, pool.der(pool.mul(y, angle))))
    program = bench.program(both)
    found = came_out(program, {"th": [Fraction(n) for n in COUNTS], "x": X, "y": Y})
    reference = Reference(1)
    left, right = (
        reference.passed(k, [a * b for a, b in zip(u, _angle(Fraction()), strict=True)])
        for k, u in enumerate((X, Y))
    )
    assert close(found, [a + b for a, b in zip(left, right, strict=True)])


# ------------------------------------------------------------- nonlinear


@pytest.mark.parametrize("orders", [(0, 1), (1, 1), (2, 1), (0, 3)])
def test_a_product_of_derivatives_is_that_of_filtered_ones(orders: tuple[int, int]) -> None:
    """Of those that are hardly filtered; what they make passes the filter."""
    bench = Bench()
    pool = bench.pool
    x, y = bench.sensor("x"), bench.sensor("y")
    program = bench.program(pool.mul(high(bench, x, orders[0]), high(bench, y, orders[1])))
    assert program.residuals[0].approximate
    before = Reference(max(orders), *LAWS)
    left, right = before.passed(orders[0], X), before.passed(orders[1], Y)
    product = [a * b for a, b in zip(left, right, strict=True)]
    found = came_out(program, {"x": X, "y": Y}, QUICK)
    assert close(found, behind_laws(Reference(0, *QUICK), program, 0, product))


@pytest.mark.parametrize("order", [0, 1, 2])
def test_what_needs_no_law_passes_what_the_signals_of_laws_do(order: int) -> None:
    """p**2 x - 3 p**k (y'**2) + 5 u with k = 0, 1, 2: the signals pass both filters alike."""
    bench = Bench()
    pool = bench.pool
    x, y, u = bench.sensor("x"), bench.sensor("y"), bench.input("u")
    law = high(bench, pool.power(pool.der(y), 2), order)
    program = bench.program(pool.add((1, high(bench, x, 2)), (-3, law), (5, u)))
    assert (program.residuals[0].stages, program.residuals[0].laws) == (max(2, order + 1) + 1, 2)
    before, behind = Reference(1, *LAWS), Reference(2, *QUICK)
    square = [v**2 for v in before.passed(1, Y)]
    expected = [-3 * law for law in behind_laws(behind, program, order, square)]
    for factor, k, signal in ((1, 2, X), (5, 0, U)):
        passed = behind.passed(k, before.passed(0, signal), program.residuals[0].stages)
        expected = [e + factor * p for e, p in zip(expected, passed, strict=True)]
    assert close(came_out(program, {"x": X, "y": Y, "u": U}, QUICK), expected)


def test_a_start_that_a_law_makes_much_of_is_not_remembered() -> None:
    """exp(40 y') of a ramp of slope 1, which y' misses by 1 at first: it is said how long to wait.

    The ramp begins with the log, as of a machine that moves already. What the first derivatives
    make is e**-40 of what is there later, or with a slope of -1 e**40 times it.
    """
    for sign in (1, -1):
        bench = Bench()
        pool = bench.pool
        law = pool.fn("exp", pool.mul(pool.num(40 * sign), pool.der(bench.sensor("y"))))
        program = bench.program(law)
        run = Sampled(program, {}, sample_time=0.01, bandwidth=1.0)
        wait = program.residuals[0].wait(0.01)
        found = [run.step({"y": 0.01 * n}).residuals["r1"] for n in range(round(100 * wait) + 2)]
        assert float(found[-1]) == pytest.approx(math.exp(40 * sign), rel=0.05)


def test_the_speed_of_an_encoder_in_a_product() -> None:
    bench = Bench()
    pool = bench.pool
    angle, y = bench.sensor("th", counts=100), bench.sensor("y")
    speed = pool.der(angle)
    program = bench.program(pool.mul(pool.add((1, speed), (1, y)), pool.der(speed)))
    found = came_out(program, {"th": [Fraction(n) for n in COUNTS], "y": Y}, QUICK)
    before = Reference(2, *LAWS)
    slope, bend = (before.passed(k, _angle(Fraction())) for k in (1, 2))
    level = before.passed(0, Y)
    product = [(a + b) * c for a, b, c in zip(slope, level, bend, strict=True)]
    assert close(found, behind_laws(Reference(0, *QUICK), program, 0, product))


# ------------------------------------------------------------- integrals


def _trapezoid(u: Samples, time: Fraction = SLOW[0]) -> Samples:
    return [Fraction(), *accumulate((a + b) / 2 * time for a, b in pairwise(u))]


def _adams(u: Samples, time: Fraction = SLOW[0]) -> Samples:
    """The implicit rule of Adams of fourth order (Hairer, Norsett, Wanner 1993, III.1).

    y' = f: y[n] = y[n-1] + T/24 (9 f[n] + 19 f[n-1] - 5 f[n-2] + f[n-3]).
    """
    before = [u[0]] * 3 + u
    found = [Fraction()]
    for n in range(4, len(before)):
        f = before[n - 3 : n + 1][::-1]
        found.append(found[-1] + time / 24 * (9 * f[0] + 19 * f[1] - 5 * f[2] + f[3]))
    return found


def test_an_integral_beside_other_terms() -> None:
    """By the trapezoid rule, less T**2/12 times the filtered slope of what is integrated."""
    bench = Bench()
    pool = bench.pool
    x, y = bench.sensor("x"), bench.sensor("y")
    a, b, start = bench.param("a", "2"), bench.param("b", "3"), pool.num(Fraction(5, 4))
    zero = bench.initial("q0", start)
    inside = pool.integral(pool.add((1, pool.mul(b, x)), (-1, y)), zero)
    program = bench.program(pool.add((1, pool.mul(a, pool.der(y))), (-4, inside)))
    inner = [3 * p - q for p, q in zip(X, Y, strict=True)]
    reference = Reference(1)
    area = [value + Fraction(5, 4) for value in _trapezoid(inner)]
    slope = times(reference.derivative(), [value - inner[0] for value in inner])
    for _ in range(2):
        slope = times(slope, reference.stage())
    parts = reference.passed(1, Y), reference.passed(0, area), slope
    expected = [2 * p - 4 * (q - SLOW[0] ** 2 / 12 * r) for p, q, r in zip(*parts, strict=True)]
    assert close(came_out(program, {"x": X, "y": Y}), expected)


@pytest.mark.parametrize("start", [Fraction(0), Fraction(7, 2)])
def test_an_integral_inside_of_a_product(start: Fraction) -> None:
    bench = Bench()
    pool = bench.pool
    x, y, zero = bench.sensor("x"), bench.sensor("y"), bench.initial("q0", pool.num(start))
    area = pool.integral(pool.add((1, x), (-2, y)), zero)
    inner = [p - 2 * q for p, q in zip(X, Y, strict=True)]
    program = bench.program(pool.add((1, pool.mul(x, area)), (1, pool.der(y))))
    reference = Reference(1)
    product = [x * (start + i) for x, i in zip(X, _adams(inner), strict=True)]
    parts = reference.passed(0, product), reference.passed(1, Y)
    assert close(came_out(program, {"x": X, "y": Y}), [p + q for p, q in zip(*parts, strict=True)])


def test_an_integral_beside_a_derivative_is_of_what_was_filtered() -> None:
    bench = Bench()
    pool = bench.pool
    x, y, zero = bench.sensor("x"), bench.sensor("y"), bench.initial("q0", pool.num(2))
    program = bench.program(pool.mul(pool.integral(x, zero), pool.der(y), pool.der(y)))
    before = Reference(1, *LAWS)
    area = _adams(before.passed(0, X))
    product = [(2 + a) * b**2 for a, b in zip(area, before.passed(1, Y), strict=True)]
    found = came_out(program, {"x": X, "y": Y}, QUICK)
    assert close(found, behind_laws(Reference(0, *QUICK), program, 0, product))


def test_the_integral_of_a_law_of_a_derivative() -> None:
    """tanh(y') of y = 1 - cos t, which begins at rest, is tanh(sin t): its integral by Simpson."""
    bench = Bench()
    pool = bench.pool
    x, y, zero = bench.sensor("x"), bench.sensor("y"), bench.initial("q0", pool.num(0))
    area = pool.integral(pool.fn("tanh", pool.der(y)), zero)
    program = bench.program(pool.add((1, area), (-1, x)))
    run = Sampled(program, {}, sample_time=0.01, bandwidth=5.0)
    fine = np.arange(0.0, 20.0, 0.005)
    areas = cumulative_simpson(np.tanh(np.sin(fine)), x=fine, initial=0.0)[::2].tolist()
    found = [
        float(run.step({"y": 1.0 - math.cos(0.01 * n), "x": area}).residuals["r1"])
        for n, area in enumerate(areas)
    ]
    assert np.abs(found[500:]).max() < 2e-3 and max(areas) > 1.5


def test_the_integral_of_a_rate_is_its_change() -> None:
    bench = Bench()
    pool = bench.pool
    x, y, zero = bench.sensor("x"), bench.sensor("y"), bench.initial("q0", pool.num(2))
    change = pool.integral(pool.der(x), zero)
    program = bench.program(pool.mul(y, change))
    expected = [b * (2 + a - X[0]) for a, b in zip(X, Y, strict=True)]
    found = came_out(program, {"x": X, "y": Y})
    reference = Reference(0)
    assert close(found, reference.passed(0, expected))


def _error(steps: int, expr: Callable[[Bench, Expr], Expr], y: Callable[[float], float]) -> float:
    """What is left, a second after the start, of y less an expression of u = t**4."""
    bench = Bench()
    program = bench.program(bench.pool.sub(bench.sensor("y"), expr(bench, bench.input("u"))))
    run = Sampled(program, sample_time=1 / steps, bandwidth=20.0)
    for n in range(steps + 1):
        t = n / steps
        found = run.step({"u": t**4, "y": y(t)}).residuals["r1"]
    return abs(float(found))


@pytest.mark.parametrize("depth", [1, 2, 3])
def test_integrals_are_of_fourth_order_in_the_samples(depth: int) -> None:
    """Half the sample time leaves a sixteenth of the error: the nth integral of t**4 is known."""

    def nested(bench: Bench, u: Expr) -> Expr:
        for _ in range(depth):
            u = bench.pool.integral(u, bench.initial("zero", bench.pool.zero))
        return u

    def by_hand(t: float) -> float:
        return t ** (4 + depth) * math.factorial(4) / math.factorial(4 + depth)

    coarse, fine = (_error(steps, nested, by_hand) for steps in (50, 100))
    assert 13 < coarse / fine < 19


# ----------------------------------------------------------------- order


def test_the_order_of_a_term_counts_derivatives_inside_of_it() -> None:
    bench = Bench()
    pool = bench.pool
    x, y, zero = bench.sensor("x"), bench.sensor("y"), bench.initial("q0", pool.zero)
    product = pool.mul(y, pool.der(pool.der(x)))

    def needed(atom: Expr, own: int = 0, static: bool = False) -> int:
        return order(Term(atom, own, pool.one, static))

    assert needed(x, 3, static=True) == 3
    assert needed(x, -1, static=True) == 0
    assert needed(product) == 2
    assert needed(product, 1) == 3
    assert needed(pool.fn("sin", pool.mul(x, pool.der(product)))) == 3
    # an integral takes a derivative away that stands before it, and none that does not
    area = pool.integral(product, zero)
    assert needed(pool.mul(x, area)) == 2
    assert needed(pool.mul(y, pool.der(pool.mul(x, area)))) == 2
    assert needed(pool.mul(y, pool.der(pool.der(pool.mul(x, area))))) == 3
