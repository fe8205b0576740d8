"""A residual program in two: what runs on samples, and what takes exact derivatives."""

from __future__ import annotations

from functools import lru_cache

from bondgraph.ir.program import PolynomialTape, Program, TapeOp
from bondgraph.notation.walk import reads
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
    part = program._replace(first=(), step=(), states=(), openings=())
    return pruned(part)._replace(params=program.params)
