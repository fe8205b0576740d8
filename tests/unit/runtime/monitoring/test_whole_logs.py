"""Whole logs on the grid: pieces end at gaps, and not where a block of samples does."""

from __future__ import annotations

import numpy as np

import bondgraph
from bondgraph import Log
from bondgraph.runtime.monitoring.whole_logs import stretches

_TEXT = "bg 1\nmodel M { param R = 2 Ohm; Se:U -> 1:i; i -> R:R; i -> Df:y }"


def test_a_log_is_one_piece_but_for_its_gaps() -> None:
    """Of 30 000 samples a minute is missing behind the first 20 000; `b` has no gap."""
    engine = bondgraph.compile(text=_TEXT, rate=1000.0).engine(native=False)
    time = np.arange(30_000) / 1000.0
    late = time + np.where(time >= 20.0, 60.0, 0.0)
    columns = {"U": np.sin(time), "y": np.cos(time)}
    logs = [("a", Log(late, columns, {}, {})), ("b", Log(time, columns, {}, {}))]
    found = stretches(engine, logs)
    assert [(name, len(piece.time)) for name, piece in found] == [
        ("a", 20_000), ("a", 10_000), ("b", 30_000),
    ]  # fmt: skip
    assert [bool(piece.anew) for _, piece in found] == [False, True, False]
    order = [k.path for k in engine.signals]
    for name in columns:
        assert np.array_equal(found[2][1].samples[:, order.index(name)], columns[name])
    assert np.allclose(found[1][1].time, late[20_000:], rtol=0.0, atol=1e-9)
