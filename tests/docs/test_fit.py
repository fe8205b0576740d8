"""The intervals of `bondgraph fit`, as its page states them and as they are."""

from __future__ import annotations

import re

from tests.fit import MACHINES, PAGE, rows, table
from tests.measured import measured


def test_the_small_table_is_what_is_measured_now_and_the_large_one_holds() -> None:
    found = [row for machine in MACHINES for row in rows(machine, 3)]
    inside, logs = sum(r.inside for r in found), sum(r.logs for r in found)
    assert inside >= 0.85 * logs  # of 111, where 105 are to be expected
    small, large = (
        m.text for n in (3, 20) for m in measured(PAGE) if m.command == f"python -m tests.fit {n}"
    )
    assert table(found).splitlines()[-1] == small.splitlines()[-1]
    share = re.search(r"([\d.]+) % \| \| \|$", large)
    assert share is not None
    assert 90.0 <= float(share[1]) <= 98.0
