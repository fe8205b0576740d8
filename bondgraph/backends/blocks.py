"""Which residuals run together: those that share memory or intermediate values.

A bad sample restarts the filter of the blocks that see its signal, and no other.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence, Set
from functools import lru_cache

from bondgraph.backends.one_procedure import Procedure, heard, one_procedure
from bondgraph.ir.groups import Groups
from bondgraph.ir.program import Assignment, Delayed, Program, Ref
from bondgraph.notation.walk import reads
from bondgraph.text.tuples import NamedTuple


class Block(NamedTuple):
    """Residuals that are computed by one function, with the signals and the memory they need."""

    name: str
    residuals: tuple[str, ...]
    knowns: tuple[str, ...]
    states: tuple[str, ...]
    first: tuple[Assignment, ...]
    step: tuple[Assignment, ...]
    run: Procedure  # both as one
    heard: frozenset[str]  # the signals that make a residual NaN or infinite if they are
    spaces: frozenset[str]  # of all values that occur


class Line(NamedTuple):
    """The last `length` samples of a signal, remembered for its `past` values."""

    length: int
    past: tuple[Delayed, ...]


#: How near to a sample, in samples, a past value is that sample.
NEAR = 1e-6
_SLACK = 2e-6  # by which the sample time may be shorter than the code was made for

_Key = tuple[str, str]
_SIGNALS = frozenset({"known", "increment", "total"})


@lru_cache(maxsize=4)  # each target language asks
def blocks(program: Program) -> tuple[Block, ...]:
    """The blocks of `step`, in the order of their first residual.

    A residual that step never assigns is in none.
    """
    groups = Groups[_Key]()
    first = [(_key(s.target, "first"), s, reads([s])) for s in program.first]
    step = [(_key(s.target, "step"), s, reads([s])) for s in program.step]
    for procedure, statements in (("first", first), ("step", step)):
        for key, _, refs in statements:
            for ref in refs:
                if ref.space in ("state", "local", "residual"):
                    groups.join(key, _key(ref, procedure))
    for opening in program.openings:  # what is valid and when is decided together with the value
        groups.join(("residual", opening.residual), ("state", opening.progress))
    members: dict[_Key, list[str]] = {}
    for info in program.residuals:
        members.setdefault(groups.find(("residual", info.name)), []).append(info.name)
    own: dict[_Key, tuple[list[Assignment], list[Assignment], set[Ref]]]
    own = {root: ([], [], set()) for root in members}
    for procedure, statements in (("first", first), ("step", step)):
        for key, statement, refs in statements:
            if (root := groups.find(key)) in own:
                begin, go_on, read = own[root]
                (begin if procedure == "first" else go_on).append(statement)
                read.update(refs)
    knowns = {k.name: at for at, k in enumerate(program.read)}
    states = {s.name: at for at, s in enumerate(program.states)}
    return tuple(
        _block(knowns, states, residuals, tuple(begin), tuple(go_on), refs)
        for (begin, go_on, refs), residuals in zip(own.values(), members.values(), strict=True)
        if refs
    )


def lines(program: Program) -> dict[str, Line]:
    """The signals of which `step` needs past values."""
    if not program.delayed:
        return {}
    used = {name for block in blocks(program) for name in block.knowns}
    found: dict[str, Line] = {}
    for past in program.delayed:
        if past.known.name in used:
            line = found.get(past.of, Line(0, ()))
            length = int(past.seconds * program.rate * (1 + _SLACK)) + 3
            found[past.of] = Line(max(line.length, length), (*line.past, past))
    return found


def recalled(past: Sequence[float], back: float) -> float:
    """The sample so many before the last one, on a straight line between two; NaN if there is none.

    >>> recalled([1.0, 2.0, 4.0], 1.5), recalled([1.0, 2.0, 4.0], 3.0)
    (1.5, nan)
    """
    whole = int(back + NEAR)
    part = back - whole
    if len(past) < whole + (2 if part > NEAR else 1):
        return math.nan
    value = past[-1 - whole]
    return value + part * (past[-2 - whole] - value) if part > NEAR else value


def _block(
    knowns: Mapping[str, int],
    states: Mapping[str, int],
    residuals: list[str],
    first: tuple[Assignment, ...],
    step: tuple[Assignment, ...],
    refs: Set[Ref],
) -> Block:
    signals = {ref.name for ref in refs if ref.space in _SIGNALS}
    memory = {ref.name for ref in refs if ref.space == "state"}
    few = len(residuals) <= 3
    run = one_procedure(first, step)
    return Block(
        "_".join(residuals) if few else f"{residuals[0]}_to_{residuals[-1]}",
        tuple(residuals),
        tuple(sorted(signals & knowns.keys(), key=knowns.__getitem__)),
        tuple(sorted(memory & states.keys(), key=states.__getitem__)),
        first,
        step,
        run,
        heard(run),
        frozenset(ref.space for ref in refs),
    )


def _key(ref: Ref, procedure: str) -> _Key:
    """A local variable belongs to its procedure, everything else to the program."""
    return (f"local of {procedure}" if ref.space == "local" else ref.space), ref.name
