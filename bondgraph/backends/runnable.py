"""A residual program as code to be loaded: the files of `compile`, and a call for whole arrays.

The wrapper (`codegen/c/batch.c.j2`) is not among the files that `compile` writes: it is made for
the process that loads it, and its form may change with any version. Who embeds the code in a
machine has one sample at a time and calls `step`.
"""

from __future__ import annotations

from bondgraph.backends import c, python
from bondgraph.backends.facts import ABI, facts
from bondgraph.backends.identifiers import snake
from bondgraph.backends.members import samples
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import Target, load
from bondgraph.backends.templates import fill
from bondgraph.ir.artifact import Artifact
from bondgraph.ir.program import Program
from bondgraph.ir.runnable_code import Runnable, Together

_CHUNK, _SIGNALS = 64, 4096  # rows taken at a time, and what they may have in all
_KINDS = {"real": "{0}", "bool": "{0} != 0.0", "count": "{1}_whole({0})"}


def runnable(program: Program) -> Runnable:
    """The code of a program of residuals or thresholds, with what is needed to run it."""
    about = facts(program)
    own, other = load("c"), load("python")
    holes = c.files(program, own, decides=False)  # the monitor decides
    files = {name: fill(f"c/model.{name}.j2", holes) for name in ("h", "c")}
    spelling = Spelling(program, other)
    return Runnable(
        program,
        ABI * 256 + 8,
        about.stem,
        (
            *(Artifact(f"{about.file}.{name}", text) for name, text in files.items()),
            Artifact(f"{about.stem}_batch.c", fill("c/batch.c.j2", holes | _batch(program, own))),
        ),
        f"{about.stem}_batch.c",
        fill("python/model.py.j2", python.files(program, other, decides=False)),
        tuple(spelling.params[f.name] for f in program.params),
        tuple(spelling.knowns[k.name] for k in program.knowns),
        tuple(spelling.residuals[r.name] for r in program.residuals),
        _blocks(program, spelling),
    )


def _blocks(program: Program, spelling: Spelling) -> tuple[Together, ...]:
    residuals = {r.name: at for at, r in enumerate(program.residuals)}
    place = {k.name: at for at, k in enumerate(program.knowns)}
    whole = {
        k.name: at
        for at, k in enumerate(program.knowns)
        if k.kind == "mode" or k.counts is not None
    }
    return tuple(
        Together(
            tuple(residuals[name] for name in block.residuals),
            tuple(whole[name] for name in block.knowns if name in whole),
            tuple(place[name] for name in block.knowns if name in place),
        )
        for block in spelling.blocks
    )


def _batch(program: Program, target: Target) -> dict[str, object]:
    """What batch.c.j2 leaves open beyond the holes of the residuals."""
    spelling, stem = Spelling(program, target), snake(program.name)
    taken = [
        f"s->{m.name} = {_KINDS[m.type].format(f'row[columns[{k}]]', stem)};"
        for k, m in enumerate(samples(program, spelling))
    ]
    given = [f"p.{spelling.params[f.name]} = values[{k}];" for k, f in enumerate(program.params)]
    blocks = [
        {
            "number": number,
            "residuals": block.residuals,
            "there": " && ".join(f"{stem}_exists(row[columns[{k}]])" for k in block.whole),
        }
        for number, block in enumerate(_blocks(program, spelling))
        if block.whole
    ]
    return {
        "chunk": max(1, min(_CHUNK, _SIGNALS // max(1, len(taken)))),
        "taken": taken,
        "given": given,
        "whole_blocks": blocks,
        "of_residuals": not program.bounds,
        "has_bound": [str(not r.unavailable).lower() for r in program.residuals],
    }
