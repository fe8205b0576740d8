"""How long the workbench takes from a key to the drawing: python -m tests.redraw [--write].

The robot (models/khepera.bg) in Chromium. Each key makes a number of the model longer, one at a
time and then ten a second; what is timed is from the key to the moment when the new drawing is on
the page.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

from tests.measured import ROOT, write
from tests.unit.cli.workbench.pages import Workbench, shown

_LINE = "    param d = 0.04 m"  # whose number gets longer: the model stays sound at every key
_RATE = 10.0  # keys a second, of somebody who types fast


def redraw(page: Workbench, keys: int) -> tuple[list[list[float]], list[list[float]]]:
    """Of so many keys one at a time, and of so many in a row, (ms to the drawing, ms of CPU)."""
    page.until("document.querySelectorAll('.relation').length > 0")
    page.write()
    page.press("Home", control=True)
    lines = page.typed_text().split("\n")
    for _ in range(lines.index(_LINE)):
        page.press("ArrowDown")
    page.press("End")
    for _ in " m":
        page.press("ArrowLeft")
    page.tab.run("workbench.times.length = 0")
    for k in range(keys):
        page.type(str(k % 10))
        page.until(f"workbench.times.length > {k}")
    alone: list[list[float]] = page.tab.run("workbench.times")
    page.tab.run("workbench.times.length = 0")
    for k in range(keys):
        start = time.monotonic()
        page.type(str(k % 10))
        time.sleep(max(0.0, 1 / _RATE - (time.monotonic() - start)))
    page.until("workbench.answered >= workbench.version")
    page.until("document.querySelectorAll('.relation').length > 0")
    return alone, page.tab.run("workbench.times")


def table(alone: list[list[float]], row: list[list[float]]) -> str:
    """What was found, for a page of the documentation."""
    rows = []
    for words, found in (("one key at a time", alone), (f"{_RATE:g} keys a second", row)):
        times, work = sorted(t for t, _ in found), sorted(cpu for _, cpu in found)
        rows.append(f"| {words} | {len(times)} | {times[len(times) // 2]:.0f} ms | "
                    f"{times[int(0.95 * len(times))]:.0f} ms | {times[-1]:.0f} ms | "
                    f"{work[len(work) // 2]:.0f} ms |")  # fmt: skip
    head = ["| | drawings | median | 95 % | worst | processor time of a sketch |",
            "|---|---|---|---|---|---|"]  # fmt: skip
    return "\n".join([*head, *rows])


def main() -> int:
    """Measure once and tell."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--keys", type=int, default=100)
    parser.add_argument("--write", action="store_true", help="put the table into docs/workbench.md")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "robot.bg"
        shutil.copy(ROOT / "models" / "khepera.bg", file)
        with shown(file, Path(folder) / "profile") as page:
            found = table(*redraw(page, args.keys))
    print(found)
    print(f"load average {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")
    if args.write:
        write(ROOT / "docs" / "workbench.md", "python -m tests.redraw --write", found)
    return 0


if __name__ == "__main__":
    sys.exit(main())
