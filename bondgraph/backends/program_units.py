"""The statements of a residual program as what functions of C are made of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from graphlib import TopologicalSorter
from heapq import heappop, heappush

from bondgraph.backends.c_functions import Unit
from bondgraph.backends.one_procedure import Start, asks
from bondgraph.backends.short_functions import together
from bondgraph.ir.program import Dot, PolynomialTape, Ref, Statement, flat
from bondgraph.notation.dialect import CodeSpeller
from bondgraph.notation.walk import reads

#: The arguments of generated functions by which a value can be reached.
_REACHED = {
    "param": ("p",),
    "coef": ("c",),
    "state": ("x",),
    "known": ("s", "d"),
    "increment": ("x", "e"),
    "total": ("x", "e"),
    "start": ("d",),
    "integral": ("d",),
    "time": ("d",),
    "residual": ("r",),
    "local": (),
}


def units(
    statements: Sequence[Statement | Start], speller: CodeSpeller, prefix: str = ""
) -> list[Unit]:
    """What each statement needs of the function that it stands in; comments without the prefix.

    In `r1_w2: terms of order 0` the key is `r1_w2`, and what has that name belongs to it, too. So
    does what a first sample begins with.
    """
    found: list[Unit] = []
    for statement in statements:
        unit = _unit(statement, speller, prefix)
        if found and not unit.key and not isinstance(statement, (Start, PolynomialTape)):
            own = statement.target.name == found[-1].key
            unit = unit._replace(key=found[-1].key if own else "")
        found.append(unit)
    others: dict[str, set[str]] = {}  # the parts that read a value
    for unit in found:
        for name in unit.takes:
            others.setdefault(name, set()).add(unit.key)
    after = ""
    for at in range(len(found) - 1, -1, -1):
        unit = found[at]
        shared = any(others.get(name, set()) - {unit.key, ""} for name in unit.gives)
        begins = isinstance(statements[at], Start) and not unit.key
        after = "" if shared else after if begins else unit.key
        found[at] = unit._replace(key=after)
    return found


def _unit(statement: Statement | Start, speller: CodeSpeller, prefix: str) -> Unit:
    own: tuple[Statement, ...] = (
        statement.statements if isinstance(statement, Start) else (statement,)
    )
    read = reads(own)
    targets = [s.target for s in flat(own) if not isinstance(s, PolynomialTape)]
    uses = {name for ref in read for name in _REACHED.get(ref.space, (ref.name,))}
    if isinstance(statement, Start) or any(
        asks(s) for s in own if not isinstance(s, (Dot, PolynomialTape))
    ):
        uses.add("first")
    inside = {ref for ref in targets if ref.space == "local"}
    return Unit(
        tuple(speller.name(ref) for ref in targets[-1:] if ref.space == "local"),
        frozenset(speller.name(r) for r in read if r.space == "local" and r not in inside),
        frozenset(uses),
        *_parted(own[0].comment.removeprefix(prefix)),
    )


def _parted(comment: str) -> tuple[str, str]:
    """Of `r1_w2: stage 3` both parts."""
    key, colon, text = comment.partition(": ")
    return (key, text) if colon and key.isidentifier() else ("", comment)


def grouped(statements: Sequence[Statement]) -> list[tuple[str, int]]:
    """Statements of configure by number with the key of each, those of a key together.

    A local value goes to what all that need it are parts of: what both `r1_w1` and `r1_w2` need
    is computed before either, in `r1`. What reads a coefficient comes behind what computes that,
    and goes to it where nothing else tells: the first number of a tape of `r1` belongs to `r1`.
    """
    writers = _writers(statements)
    keys: dict[int, str] = {}
    users: dict[Ref, list[str]] = {}
    for at, statement in reversed([*enumerate(statements)]):
        own = _local(statement)
        key = _parted(statement.comment)[0] if own is None else together(users.get(own, ()))
        keys[at] = key
        for ref in reads([statement]):
            if ref.space == "local" and ref != own:
                users.setdefault(ref, []).append(key)
    needs = {at: _needed(statements[at], at, writers) for at in keys}
    for at in sorted(keys):
        given = [keys[k] for k in needs[at] if _local(statements[k]) is None]
        keys[at] = keys[at] or together(given)
    seen: dict[str, int] = {}

    def order(at: int) -> tuple[list[int], bool, int]:
        """Parts as they first occur, what is computed for all of a part first."""
        return [seen[part] for part in _parts(keys[at])], _local(statements[at]) is None, at

    for at in sorted(keys, key=lambda at: (_local(statements[at]) is not None, at)):
        for part in _parts(keys[at]):
            seen.setdefault(part, len(seen))
    rows: list[tuple[str, int]] = []
    ready: list[tuple[list[int], bool, int]] = []
    sorter = TopologicalSorter(needs)
    sorter.prepare()
    while sorter.is_active():
        for at in sorter.get_ready():
            heappush(ready, order(at))
        at = heappop(ready)[-1]
        sorter.done(at)
        rows.append((keys[at], at))
    return rows


def _writers(statements: Sequence[Statement]) -> dict[tuple[str, str], int]:
    """Which statement computes each coefficient and each local value, by space and name."""
    found: dict[tuple[str, str], int] = {}
    for at, statement in enumerate(statements):
        if isinstance(statement, PolynomialTape):
            found |= {("coef", output.array): at for output in statement.outputs}
        else:
            found[statement.target[:2]] = at
    return found


def _needed(statement: Statement, at: int, writers: Mapping[tuple[str, str], int]) -> list[int]:
    """The statements that compute what this one reads, by number."""
    own = {writers[ref[:2]] for ref in reads([statement]) if ref[:2] in writers}
    return sorted(own - {at})


def _parts(key: str) -> list[str]:
    """Of `r1_w2` it and what it is a part of: `r1`, `r1_w2`."""
    words = key.split("_") if key else []
    return ["_".join(words[:k]) for k in range(1, len(words) + 1)]


def _local(statement: Statement) -> Ref | None:
    """The local value that a statement computes."""
    if isinstance(statement, PolynomialTape) or statement.target.space != "local":
        return None
    return statement.target
