"""A residual program in two: what runs on samples, and what takes exact derivatives."""

from __future__ import annotations

from functools import lru_cache

from bondgraph.ir.program import Assign, Assignment, Const, PolynomialTape, Program, Ref, TapeOp
from bondgraph.notation.walk import reads
from bondgraph.passes.lowering.filter import FORGOTTEN, settle
from bondgraph.passes.lowering.prune import pruned


@lru_cache(maxsize=4)  # each target language asks
def step_part(program: Program) -> Program:
    """`step` with the coefficients that it reads; the parameters are those of the whole."""
    part = pruned(program._replace(exact=(), integrals=()))
    return _shortened(part)._replace(params=program.params)


def _shortened(program: Program) -> Program:
    """A program whose tapes make no more coefficients than are read."""
    tapes = [s for s in program.configure if isinstance(s, PolynomialTape)]
    others = [s for s in program.configure if not isinstance(s, PolynomialTape)]
    if not tapes:
        return program
    most: dict[str, int] = {}
    for ref in reads((*others, *program.first, *program.step)):
        if ref.space == "coef":
            most[ref.name] = max(most.get(ref.name, 0), ref.order + 1)
    short = {tape.residual: _short(tape, most) for tape in tapes}
    return program._replace(
        configure=tuple(
            short[s.residual] if isinstance(s, PolynomialTape) else s for s in program.configure
        ),
        coefs=tuple(
            f._replace(size=min(f.size, most.get(f.name, 1))) if f.size else f
            for f in program.coefs
        ),
    )


def _short(tape: PolynomialTape, most: dict[str, int]) -> PolynomialTape:
    """The same polynomials up to the powers that are read."""
    length = max((min(out.length, most.get(out.array, 1)) for out in tape.outputs), default=1)
    if length >= tape.length:
        return tape
    ops: list[TapeOp] = []
    for op in tape.ops:
        own = max(0, min(op.length, length - op.shift))
        if own or op.fresh:
            ops.append(op._replace(length=own))
    outputs = tuple(
        out._replace(length=min(out.length, most.get(out.array, 1))) for out in tape.outputs
    )
    return tape._replace(length=length, ops=tuple(ops), outputs=outputs)


def exact_part(program: Program) -> Program:
    """`exact` with the coefficients that it reads; the parameters are those of the whole."""
    infos = tuple(info._replace(held=0.0, begins="") for info in program.residuals)
    part = program._replace(residuals=infos, first=(), step=(), states=(), openings=())
    return pruned(part)._replace(params=program.params)


def begun(program: Program) -> Program:
    """The program whose laws begin at the second sample, for code that has no choice of two values.

    What they make of a start is remembered then, and bounded where all ranges are: so a residual
    waits until 1e-8 of it is left.
    """
    paces = {info.begins for info in program.residuals if info.begins}
    if not paces:
        return program
    pace = {Ref("coef", name) for name in paces}
    progress = {s.target for s in program.step if not pace.isdisjoint(reads([s]))}
    states = {s.target.name for s in program.step if isinstance(s, Assign) and s.value in progress}

    def later(statements: tuple[Assignment, ...], value: float) -> tuple[Assignment, ...]:
        return tuple(
            Assign(s.target, Const(value), s.comment, s.origin) if s.target in progress else s
            for s in statements
            if s.target.name not in states
        )

    return program._replace(
        states=tuple(s for s in program.states if s.name not in states),
        coefs=tuple(c for c in program.coefs if c.name not in paces),
        configure=tuple(s for s in program.configure if _target(s) not in paces),
        residuals=tuple(
            info._replace(settle=settle(info.stages, FORGOTTEN), begins="") if info.begins else info
            for info in program.residuals
        ),
        first=later(program.first, 0.0),
        step=later(program.step, 1.0),
    )


def _target(statement: Assignment | PolynomialTape) -> str:
    return "" if isinstance(statement, PolynomialTape) else statement.target.name
