"""The coefficients of a program at its own parameters, as configure computes them in double."""

from __future__ import annotations

import math

from bondgraph.algebra.interpreter import Interpreter
from bondgraph.backends.blocks import lines
from bondgraph.ir.program import Program, Ref
from bondgraph.text.tuples import NamedTuple

_MOST = 500  # numbers that are written out


class Nominal(NamedTuple):
    """By coefficient its values; delays in samples; samples until a residual is valid, or never."""

    coefficients: tuple[tuple[float, ...], ...]
    back: tuple[float, ...]
    settle: tuple[int | None, ...]


def nominal(program: Program) -> Nominal | None:
    """All coefficients; None where a parameter has no value, or there are too many."""
    if any(f.default is None for f in program.params):
        return None
    if sum(f.size or 1 for f in program.coefs) > _MOST:
        return None
    run = Interpreter(program)
    try:
        run.configure()
    except (ArithmeticError, ValueError):
        return None
    found = tuple(
        tuple(float(run.values[Ref("coef", f.name, k)]) for k in range(f.size or 1))
        for f in program.coefs
    )
    if not all(math.isfinite(x) for values in found for x in values):
        return None
    time = 1.0 / program.rate
    back = tuple(p.seconds / time for line in lines(program).values() for p in line.past)
    pace = program.bandwidth * time
    settle = tuple(
        None if r.unavailable else math.ceil(r.wait(pace) / pace) for r in program.residuals
    )
    return Nominal(found, back, settle)
