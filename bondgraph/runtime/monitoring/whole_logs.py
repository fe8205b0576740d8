"""Whole logs on the grid of an engine, in pieces without a gap."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from bondgraph.runtime.log import Log, LogError
from bondgraph.runtime.monitoring.clock import Piece, clock_of
from bondgraph.runtime.monitoring.columns import Columns, Mapped
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.runtime.time_column import Pace

if TYPE_CHECKING:
    from bondgraph.runtime.monitoring.operating import Operating


def stretches(
    engine: Engine,
    logs: Iterable[tuple[str, Log]],
    mapping: Mapping[str, Mapped] | None = None,
    operating: str | None = None,
    asked: bool = False,
) -> list[tuple[str, Piece]]:
    """What an engine reads from logs, by their names, in pieces without a gap; see `on_grid`.

    `operating` is an expression that holds while the machine is on. Raises LogError where it holds
    for no sample, CompileError for a text that is no expression.
    """
    from bondgraph.runtime.monitoring.operating import Operating

    named = list(logs)
    found = []
    for name, log in named:
        on = None if operating is None else Operating(operating, mapping, name)
        pieces = on_grid(engine, log, mapping, name, on, asked)
        found += [(name, piece) for piece in pieces if len(piece.samples)]
    if operating is not None and not found:
        names = ", ".join(name for name, _ in named)
        raise LogError(names, None, f"`{operating}` (--while) holds for no sample of {names}")
    return found


def on_grid(
    engine: Engine,
    log: Log,
    mapping: Mapping[str, Mapped] | None = None,
    name: str = "log",
    operating: Operating | None = None,
    asked: bool = False,
) -> list[Piece]:
    """The signals of an engine in a whole log while it is `operating`, on its grid; see `Columns`.

    Raises LogError where the steps of the log are no steps of this grid, whose rate somebody has
    `asked` for.
    """
    clock = clock_of(engine)
    Pace(engine.sample_time, name, asked).look(log)
    on = None if operating is None else operating(log)
    samples = Columns(engine.signals, mapping, name)(log)
    return _joined(clock.feed(log.time, samples, on) + clock.finish())


def _joined(pieces: Iterable[Piece]) -> list[Piece]:
    """The pieces of a clock, which come block by block, each with those that go on with it."""
    found: list[list[Piece]] = []
    for piece in pieces:
        if piece.anew or not found:
            found.append([])
        found[-1].append(piece)
    return [
        first._replace(
            time=np.concatenate([one.time for one in (first, *rest)]),
            samples=np.concatenate([one.samples for one in (first, *rest)]),
        )
        for first, *rest in found
    ]
