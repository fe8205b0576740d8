"""CableBench watched by its residuals; a program to start from.

Put your sensors into read_samples and what to do about a fault into tell. Run it without an
argument for a machine at rest, or with a log: a CSV file with the names of its columns.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterator

import cable_bench_residuals as m

TICKS = 1000
#: How far a residual may be from 0: measure that, or compile with a tuning, which knows more.
LIMITS = [m.Limit(0.0, 0.001)] * 1


def read_samples() -> m.Samples:
    """One sample of every signal, all taken at the same moment. Here: a machine at rest."""
    return m.Samples(
        Uin=0.0,  # V
        Us=0.0,   # V
    )


def read_log(path: str) -> Iterator[m.Samples]:
    """The samples of a log."""
    with open(path, newline="") as log:
        for row in csv.DictReader(line for line in log if not line.startswith("#")):
            yield m.Samples(
                Uin=float(row["Uin"]),
                Us=float(row["Us"]),
            )


def tell(found: m.Diagnosis, tick: int) -> None:
    """What is wrong now, in words."""
    fired = [n for n, state in zip(m.RESIDUALS, found.state, strict=True) if state == m.ALARM]
    text = f"sample {tick}: {', '.join(fired)} in alarm"
    likely = "perhaps" if found.fault_class is None else "one of"
    for left, words in ((m.LIKELY, likely), (m.SMALL, "or, if it is small,")):
        own = [f for c, what in zip(m.CLASSES, found.candidate, strict=True) if what == left
               for f in c]  # fmt: skip
        text += f"; {words} {', '.join(own)}" if own else ""
    print(text)


def main() -> None:
    """Watch the machine for a while."""
    monitor = m.Monitor()
    found = m.Diagnosis(LIMITS)
    log = read_log(sys.argv[1]) if len(sys.argv) > 1 else (read_samples() for _ in range(TICKS))
    alarmed, told, alarms, tick = False, None, 0, -1
    for tick, samples in enumerate(log):  # every SAMPLE_TIME, from a timer
        alarm = found.update(monitor.step(samples))
        news = (m.ALARM, 0) in zip(found.state, found.since, strict=True)
        if alarm and (news or found.fault_class != told):
            tell(found, tick)
            alarms += not alarmed
            told = found.fault_class
        alarmed = alarm
    print(f"{tick + 1} samples, {alarms} alarms")


if __name__ == "__main__":
    main()
