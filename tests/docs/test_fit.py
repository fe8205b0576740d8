"""The intervals of `bondgraph fit`, as its page states them, and as they are of some machines."""

from __future__ import annotations

import re

from scipy.stats import binom

from tests.fit import MACHINES, PAGE, rows
from tests.measured import measured


def test_the_truth_lies_in_the_intervals_now_and_in_the_table() -> None:
    found = [row for machine in MACHINES[::2] for row in rows(machine, 1)]
    inside, logs = sum(r.inside for r in found), sum(r.logs for r in found)
    assert logs >= 20
    assert binom.cdf(inside, logs, 0.95) > 0.01
    (table,) = (m.text for m in measured(PAGE) if m.command == "python -m tests.fit 20")
    share = re.search(r"([\d.]+) % \| \| \|$", table)
    assert share is not None
    assert 90.0 <= float(share[1]) <= 98.0
