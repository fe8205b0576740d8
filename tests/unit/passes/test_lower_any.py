"""Random residuals, derivatives and integrals anywhere: the exact value is right, the step runs."""

from __future__ import annotations

import math
import random

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from bondgraph.ir.expr import Expr
from tests.sampled import Sampled
from tests.unit.algebra.test_normalise import SIGNALS, TIME, to_sympy
from tests.unit.passes.lowering_models import Bench


def random_residual(source: random.Random, bench: Bench, integrals: bool) -> Expr:
    """Any expression of three signals and three parameters, derivatives anywhere."""
    p = bench.pool
    counts = 96 if integrals and source.randrange(2) else None
    signals = [bench.sensor("x"), bench.sensor("y", counts), bench.sensor("z")]
    params = [bench.param("a", "1.3"), bench.param("b", "-0.7"), bench.param("leak", "0")]
    start, on = bench.initial("x0", params[0]), bench.input("on", mode=True)

    def build(depth: int) -> Expr:
        if depth == 0:
            return source.choice(signals + params)
        kind = source.randrange(8)
        if kind == 0:
            return p.add((source.randint(-3, 3), build(depth - 1)), (2, build(depth - 1)))
        if kind in (1, 2):
            return p.mul(build(depth - 1), build(depth - 1))
        if kind == 3:
            return p.der(build(depth - 1))
        if kind == 4:
            name = source.choice(["sin", "tanh", "exp"])
            return p.fn(name, p.fn("sin", build(depth - 1)))
        if kind == 5 and integrals:
            return p.integral(build(depth - 1), start)
        if kind == 6 and integrals:
            condition = p.compare("<", build(depth - 1), build(depth - 1))
            return p.choose(source.choice([on, condition]), build(depth - 1), build(depth - 1))
        return p.add((1, build(depth - 1)), (1, p.der(build(depth - 1))))

    return build(5)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32), st.booleans())
def test_any_residual_gives_its_exact_value(seed: int, taped: bool) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("bondgraph.passes.lowering.lower.LIMIT", 10 if taped else 1500)
        bench = Bench()
        expr = random_residual(random.Random(seed), bench, integrals=False)
        program = bench.program(expr)
    at = {TIME: 0.3}
    known = {
        k.name: {
            n: float(SIGNALS[k.name].diff(TIME, n).subs(at)) * program.time_unit**n
            for n in range(k.highest + 1)
        }
        for k in program.knowns
        if k.name in SIGNALS
    }
    values = {sympy.Symbol("a"): 1.3, sympy.Symbol("b"): -0.7, sympy.Symbol("leak"): 0.0}
    reference = float(sympy.N(to_sympy(expr).doit().subs(values).subs(at)))
    found = Sampled(program).exact(known)["r1"]
    assert found == pytest.approx(reference, rel=1e-7, abs=1e-7)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32), st.booleans())
def test_any_residual_has_a_step(seed: int, taped: bool) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("bondgraph.passes.lowering.lower.LIMIT", 10 if taped else 1500)
        bench = Bench()
        program = bench.program(random_residual(random.Random(seed), bench, integrals=True))
    run = Sampled(program)
    counted = any(k.counts for k in program.knowns)
    for i in range(8):
        y = 3 * i if counted else math.cos(0.02 * i)
        samples = {"x": 1 + math.sin(0.01 * i), "y": y, "z": 0.5}
        try:
            outcome = run.step(samples, {"on": i > 5})
        except OverflowError:
            return  # exp of something huge: C gives infinity there, Python's math does not
        assert math.isfinite(outcome.residuals["r1"])
