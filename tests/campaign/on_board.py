"""The verdict on board beside that of the monitor: the generated example in C reads the logs.

It runs here in double precision, or as an image for a Cortex-M4F in qemu, in single precision.
Both have one tuning, of healthy machines of the kind. On board nothing is learned of the one that
is watched, and what tolerances may do is the largest of the tuning's logs.
"""

from __future__ import annotations

import re
import subprocess
import tempfile
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bondgraph.backends.identifiers import snake
from bondgraph.cli.tune import WINDOW
from bondgraph.runtime.diagnosis.calibration import tune
from bondgraph.runtime.diagnosis.hypotheses import rows_apart
from bondgraph.runtime.diagnosis.tuning import Tuning, bandwidth_for
from bondgraph.runtime.log import Array, Log
from bondgraph.runtime.log_file import write_log
from tests.campaign.faults import Kind, kinds, lasting, span
from tests.campaign.machines import MACHINES, Machine, compiled, run

_HEALTHY = 1, 2, 3  # seeds of the machines that the tuning is of
_HERE = "cc", "-std=c99", "-O2"
_M4F = ("arm-none-eabi-gcc", "-std=c99", "-O2", "-mcpu=cortex-m4", "-mthumb",
        "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard", "--specs=rdimon.specs")  # fmt: skip
_QEMU = ("qemu-system-arm", "-M", "mps2-an386", "-display", "none", "-monitor", "none",
         "-serial", "none", "-kernel")  # fmt: skip
_SAID = re.compile(
    r"sample (\d+): (.*?) in alarm(?:; (perhaps|one of) (.*?))?(?:; or, if it is small, (.*))?$"
)


class Said(NamedTuple):
    """One line: the sample, whether a class is named, its faults or the likely ones, and all that
    are not ruled out."""

    sample: int
    named: bool
    likely: set[str]
    left: set[str]


class Compared(NamedTuple):
    """Of one run: rows from the monitor's alarm to that on board, None without one of them; false
    alarms on board; whether the fault was never ruled out, and always among the likely ones;
    whether a class was named at the end, and the right one; whether the monitor's class is among
    the likely ones at the end."""

    late: float | None
    seen: tuple[bool, bool]
    false: bool
    held: bool
    likely: bool
    named: bool
    right: bool
    same: bool | None


@cache
def _tuning(machine: Machine) -> Tuning:
    c = compiled(machine)
    logs = [run(machine, seed, span(machine)[0]) for seed in _HEALTHY]
    bandwidth = bandwidth_for(machine.rate, len(logs[0]))
    engine = c.engine().configured(bandwidth=bandwidth)
    window = WINDOW / bandwidth
    return tune(engine, c.diagnosis_model, logs, c.program.digest, 1.0, window).tuning


@cache
def _program(machine: Machine, qemu: bool) -> Path:
    """The example of the generated code, compiled with the tuning."""
    folder = Path(tempfile.mkdtemp(prefix="on-board-"))
    c = compiled(machine).tuned(_tuning(machine))
    c.write(folder, targets=["c"], extras=["example", "qemu"])
    stem = snake(c.program.name)
    files = ["-I.", "example/example.c", f"{stem}.c", "-o", "watch", "-lm"]
    board = [f"-D{stem.upper()}_FLOAT", "-T", "qemu/link.ld", "qemu/start.c"]
    command = [*_M4F, *board, *files] if qemu else [*_HERE, *files]
    subprocess.run(command, cwd=folder, check=True)
    return folder / "watch"


def _said(machine: Machine, samples: Array, qemu: bool) -> list[Said]:
    """What the example says of samples."""
    engine = compiled(machine).engine()
    columns = {k.path: samples[:, at] for at, k in enumerate(engine.signals)}
    units = {k.path: k.unit for k in engine.signals}
    time = np.arange(len(samples)) * engine.sample_time
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log.csv"
        write_log(Log(time, columns, units, {}), str(log))
        program = _program(machine, qemu)
        host = f"enable=on,target=native,arg=watch,arg={log}"
        command = [*_QEMU, program, "-semihosting-config", host] if qemu else [program, log]
        # whether all was read is in the last line: the image has no status of its own
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if "samples, " not in done.stdout:
            raise RuntimeError(f"{done.stdout}\n{done.stderr}")
    found = []
    for line in done.stdout.splitlines():
        if said := _SAID.match(line):
            at, _, how, likely, small = said.groups()
            names = [set(filter(None, (text or "").split(", "))) for text in (likely, small)]
            found.append(Said(int(at), how == "one of", names[0], names[0] | names[1]))
    return found


def _compared(task: tuple[str, int, Kind, bool]) -> Compared:
    name, seed, kind, qemu = task
    machine = next(m for m in MACHINES if m.name == name)
    duration, onset = span(machine)
    samples = run(machine, seed, duration, (lasting(machine, kind),))
    c = compiled(machine)
    engine = c.engine().configured(bandwidth=_tuning(machine).bandwidth)
    watch = c.diagnosis(engine, _tuning(machine))
    time = np.arange(len(samples)) * engine.sample_time
    verdicts = watch.update(time, engine.configured().run(samples), samples)
    alarm = next((v.time for v in verdicts if v.event == "fault" and v.time >= onset), None)
    classes = [v.group for v in verdicts if v.event == "update" and v.time >= onset]
    monitor = set(classes[-1]) if classes else set()
    said = _said(machine, samples, qemu)
    first = round(onset * machine.rate)
    after = [one for one in said if one.sample >= first]
    row = rows_apart(engine) * engine.sample_time
    late = (after[0].sample / machine.rate - alarm) / row if after and alarm is not None else None
    last = next((one.likely for one in reversed(after) if one.named), set())
    return Compared(
        late,
        (alarm is not None, bool(after)),
        len(after) < len(said),
        all(kind.of in one.left for one in after),
        all(kind.of in one.likely for one in after),
        bool(last),
        kind.of in last,
        bool(monitor & after[-1].likely) if monitor and after else None,
    )


def on_board(
    machines: Sequence[Machine], seeds: int, start: int, jobs: int, qemu: bool = False
) -> str:
    """A table of both, by machine."""
    lines = [
        "| machine | runs | seen by the monitor | on board | rows later, median | 95 % | false"
        " before | never ruled out | always likely | class named | right | the monitor's likely |",
        "|---" * 12 + "|",
    ]
    for machine in machines:
        _program(machine, qemu)
        numbers = range(start, start + seeds)
        tasks = [(machine.name, seed, kind, qemu) for kind in kinds(machine) for seed in numbers]
        with ProcessPoolExecutor(jobs) as pool:
            found = list(pool.map(_compared, tasks))
        late = [f.late for f in found if f.late is not None]
        middle, most = np.quantile(late, [0.5, 0.95]) if late else (np.nan, np.nan)
        both = [f.same for f in found if f.same is not None]
        seen = [f for f in found if f.seen[1]]
        lines.append(
            f"| {machine.name} | {len(found)} | {sum(f.seen[0] for f in found)} | {len(seen)} |"
            f" {middle:.1f} | {most:.1f} | {sum(f.false for f in found)} |"
            f" {sum(f.held for f in seen)} of {len(seen)} |"
            f" {sum(f.likely for f in seen)} of {len(seen)} | {sum(f.named for f in found)} |"
            f" {sum(f.right for f in found)} | {sum(both)} of {len(both)} |"
        )
        print(lines[-1], flush=True)
    return "\n".join(lines)
