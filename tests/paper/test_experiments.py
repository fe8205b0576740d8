"""One row of the experiments is measured again."""

from __future__ import annotations

from tests.measured import measured
from tests.paper.experiments import COMMAND, EXPERIMENTS, PAGE, episode, row


def test_the_actuator_fault_of_the_page_is_what_is_measured_now() -> None:
    (page,) = [m for m in measured(PAGE) if m.command == COMMAND]
    rows = page.text.splitlines()[2:]
    assert [r.split(" | ")[0].removeprefix("| ") for r in rows] == [e.name for e in EXPERIMENTS]
    assert rows[1] == row(EXPERIMENTS[1], episode(EXPERIMENTS[1]))
