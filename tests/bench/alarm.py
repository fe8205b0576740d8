"""What a watch costs while an alarm is active: samples a second, and its share of a core live.

The robot of `models/khepera_encoders.bg` does its errands at 1 kHz; the winding of a motor has
3 ohm more from 20 s on, and is not repaired. Processor time; `python -m tests.bench.alarm` is one
run, `report` makes them with one thread, as `bondgraph monitor` has it.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
_HEALTHY, _ONSET, _END = 10.0, 20.0, 60.0  # s: limits are known, the fault sets in, the log ends
_RATE = 1000.0
_FILE, _LIVE = 1000, 10  # samples at a time: of a log, and of a line (`sample_source`: 10 ms)


class Cost(NamedTuple):
    """Seconds of processor time for a second of samples, healthy and in alarm; what was named.

    `named` is the time (s) from the first sample that came to the alarm to the name, `longest` the
    most that samples that came together took.
    """

    healthy: float
    alarm: float
    named: float
    longest: float


def watched(together: int) -> Cost:
    """One watch, with so many samples at a time."""
    from bondgraph.runtime.simulation.scenario import Fault
    from tests.robots import campaign

    kind = campaign.KINDS[0]
    fault = Fault(kind.target, kind.op, 3.0, _ONSET, float("inf"), 0.0, 0.0, 1.0, kind.name)
    log = campaign.compiled().simulate(campaign.errands(7, _END, fault)).log
    rows, engine = campaign.samples(log), campaign.engine()
    base, watch = engine.configured(), campaign.compiled().diagnosis(engine)
    taken: list[float] = []
    said = []
    for k in range(0, len(rows), together):
        part, at = rows[k : k + together], log.time[k : k + together]
        start = time.process_time()
        said += watch.update(at, base.run(part), part)
        taken.append(time.process_time() - start)
    alarm = next(v.time for v in said if v.event == "fault")
    named = next(v.time for v in said if v.group)
    assert alarm >= _ONSET and said[-1].event != "cleared", "the alarm is true, and goes on"
    first, last = (round(t * _RATE) // together for t in (_HEALTHY, _ONSET))
    of_alarm = taken[round(alarm * _RATE) // together :]
    seconds = len(of_alarm) * together / _RATE
    healthy = sum(taken[first:last]) / (_ONSET - _HEALTHY)
    return Cost(healthy, sum(of_alarm) / seconds, named - alarm, max(of_alarm))


def report() -> None:
    """Samples a second in a log, and the share of a core at 1 kHz live; each run by itself."""
    if shutil.which("cc") is None:
        print("A watch in alarm: not measured, cc is not installed")
        return
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    for together, what in ((_FILE, "of a log"), (_LIVE, "live, 10 ms together")):
        command = [sys.executable, "-m", "tests.bench.alarm", "--together", str(together)]
        done = subprocess.run(
            command, cwd=ROOT, env=environment, check=True, capture_output=True, text=True
        )
        cost = Cost(**json.loads(done.stdout))
        healthy, alarm = _RATE / cost.healthy, _RATE / cost.alarm
        print(f"the robot watched, {what}: {healthy:.0f} samples/s healthy, {alarm:.0f} in alarm"
              f" ({alarm / healthy:.2f}x), {100.0 * cost.alarm:.1f} % of a core at 1 kHz; the name"
              f" {cost.named:.2f} s of samples and at most {cost.longest * 1e3:.0f} ms behind"
              " the alarm")  # fmt: skip


def main() -> None:
    """One run."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--together", type=int, default=_FILE, help="samples at a time")
    print(json.dumps(watched(parser.parse_args().together)._asdict()))


if __name__ == "__main__":
    main()
