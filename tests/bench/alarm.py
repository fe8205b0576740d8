"""What a watch costs while an alarm is active: samples a second of a log, a share of a core live.

The robot of `models/khepera_encoders.bg` does its errands at 1 kHz; the winding of a motor has
3 ohm more from 20 s on, and is not repaired. Processor time with one thread, as `bondgraph monitor`
has it; live is the whole command, with a line written into its pipe each millisecond.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from subprocess import PIPE
from threading import Thread
from typing import IO, Any, NamedTuple

from bondgraph.runtime.log import Log
from bondgraph.runtime.log_file import write_log
from bondgraph.runtime.simulation.scenario import Fault
from tests.robots import campaign

ROOT = Path(__file__).parents[2]
_HEALTHY, _ONSET, _END = 10.0, 20.0, 60.0  # s: limits are known, the fault sets in, the log ends
_RATE = 1000.0
_FILE = 1000  # samples of a log at a time
_SETTLED = 2.0  # s behind an alarm until it costs the same each second


class Cost(NamedTuple):
    """Seconds of processor time for a second of samples, healthy and in alarm; what was named.

    `named` is the time (s) from the first sample that came to the alarm to the name, `longest` the
    most that samples that came together took.
    """

    healthy: float
    alarm: float
    named: float
    longest: float


def errands() -> Log:
    """The log of the robot."""
    kind = campaign.KINDS[0]
    fault = Fault(kind.target, kind.op, 3.0, _ONSET, float("inf"), 0.0, 0.0, 1.0, kind.name)
    return campaign.compiled().simulate(campaign.errands(7, _END, fault)).log


def watched(together: int = _FILE) -> Cost:
    """One watch, with so many samples at a time."""
    log = errands()
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


class Live(NamedTuple):
    """Shares of a core: healthy, in the first seconds of an alarm, in alarm after these; how long
    (s) the name was told behind the sample of its time was written."""

    healthy: float
    first: float
    alarm: float
    named: float


def live() -> Live:
    """The whole command with the samples of a log in its pipe as time goes by; takes a minute."""
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "log.csv"
        write_log(errands(), path)
        header, *lines = path.read_bytes().splitlines(keepends=True)
    command = [sys.executable, "-m", "bondgraph", "monitor", str(ROOT / campaign.PLANT), "--json"]
    with subprocess.Popen(command, stdin=PIPE, stdout=PIPE, cwd=ROOT) as watch:
        assert watch.stdin is not None and watch.stdout is not None
        said: list[tuple[float, dict[str, Any]]] = []
        reader = Thread(target=_read, args=(watch.stdout, said))
        reader.start()
        watch.stdin.write(header)
        begin, spent = time.monotonic(), [0.0]
        for k, line in enumerate(lines, 1):
            watch.stdin.write(line)
            watch.stdin.flush()
            time.sleep(max(0.0, begin + k / _RATE - time.monotonic()))
            if k % _RATE == 0:
                spent.append(_processor_time(watch.pid))
        watch.stdin.close()
        reader.join()
    each = [b - a for a, b in pairwise(spent)]  # a second of samples each
    alarm = next(v["time"] for _, v in said if v["event"] == "fault")
    named, then = next((v["time"], at) for at, v in said if v.get("group"))
    first, settled = int(alarm), int(alarm + _SETTLED) + 1
    return Live(
        _mean(each[int(_HEALTHY) : int(_ONSET)]), _mean(each[first:settled]),
        _mean(each[settled:]), then - begin - named,
    )  # fmt: skip


def _read(pipe: IO[bytes], said: list[tuple[float, dict[str, Any]]]) -> None:
    said += ((time.monotonic(), json.loads(line)) for line in pipe)


def _processor_time(process: int) -> float:
    """Seconds that a running process has taken so far."""
    words = Path(f"/proc/{process}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values)


def report(short: bool = False) -> None:
    """Samples a second in a log and, unless `short`, the share of a core at 1 kHz live."""
    if shutil.which("cc") is None:
        print("A watch in alarm: not measured, cc is not installed")
        return
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "tests.bench.alarm"]
    done = subprocess.run(
        command, cwd=ROOT, env=environment, check=True, capture_output=True, text=True
    )
    cost = Cost(**json.loads(done.stdout))
    healthy, alarm = _RATE / cost.healthy, _RATE / cost.alarm
    print(f"the robot watched, of a log: {healthy:.0f} samples/s healthy, {alarm:.0f} in alarm"
          f" ({alarm / healthy:.2f}x); the name {cost.named:.2f} s of samples and at most"
          f" {cost.longest * 1e3:.0f} ms behind the alarm")  # fmt: skip
    if short:
        return
    share = live()
    print(f"live at 1 kHz, whole command: {100 * share.healthy:.1f} % of a core healthy,"
          f" {100 * share.alarm:.1f} % in alarm ({100 * share.first:.1f} % in its first"
          f" {_SETTLED:.0f} s); the name {share.named:.2f} s behind its sample")  # fmt: skip


def main() -> None:
    """One run of a log."""
    print(json.dumps(watched()._asdict()))


if __name__ == "__main__":
    main()
