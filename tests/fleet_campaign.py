"""A fleet as large as one likes: `python -m tests.fleet_campaign --logs 200 --minutes 10`.

Motors are simulated with seeds and parameters of their own, half of them with a fault, and five
logs are damaged. They are watched by one process, by two, by a LocalCluster and by a scheduler with
two workers in processes of their own, and by two that are killed in the middle and started again.
All have to write the same file. Prints what came of the logs and how long it took, as markdown;
`--write` puts that into docs/fleets.md, where the command stands.
"""

from __future__ import annotations

import argparse
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np

import bondgraph
from bondgraph import Course, Fault, Instrument, Scenario
from bondgraph.runtime.fleet.verdict_table import read_verdicts
from bondgraph.runtime.fleet.watched_log import BAD, WatchedLog
from bondgraph.runtime.log_file import write_log
from tests import measured

ROOT = Path(__file__).resolve().parents[1]
MODEL = str(ROOT / "models" / "dc_motor.bg")
PAGE = ROOT / "docs" / "fleets.md"

_DAMAGED = 5
_FAULTS = (None, ("R", 1.4), None, ("f", 3.0))  # one log after the other


class Motor(NamedTuple):
    """One log that is to be made."""

    path: str
    seed: int
    seconds: float
    fault: tuple[str, float] | None


def make(motor: Motor) -> None:
    """Simulate a motor whose voltage swings, with a fault in the middle; keep what is there."""
    if os.path.exists(motor.path):
        return
    seconds = motor.seconds
    time = np.arange(0.0, seconds + 0.2, 0.1)
    voltage = 8.0 + 2.0 * np.sin(0.7 * time + motor.seed)
    known = None if motor.fault is None else Fault(motor.fault[0], "*=", motor.fault[1],
                                                   at=seconds / 2)  # fmt: skip
    scenario = Scenario(
        "motor",
        duration=seconds,
        seed=motor.seed,
        start="steady",
        spread="uniform",
        inputs={"U": Course(None, tuple(zip(time.tolist(), voltage.tolist(), strict=True)))},
        instruments={"current": Instrument(noise=2e-4), "speed": Instrument(noise=0.1)},
        faults=() if known is None else (known,),
    )
    write_log(bondgraph.compile(MODEL).simulate(scenario).log, motor.path)


def damage(path: Path, kind: int) -> None:
    """Make a log one that cannot be read to its end."""
    data = path.read_bytes()
    if kind == 0:
        path.write_bytes(b"")
    elif kind == 1:
        path.write_bytes(data[: len(data) // 2])
    elif kind == 2:
        noise = np.random.default_rng(kind).bytes(len(data) // 2)
        path.write_bytes(data[:4] + noise + data[4 + len(noise) :])
    elif kind == 3:
        path.write_text("t,U\n0,1\n1,1\n2,1\n")
    else:
        path.write_text("no log\n")


def made(folder: Path, count: int, seconds: float, jobs: int) -> list[Motor]:
    """The logs, the last ones damaged; those that are there already are taken as they are."""
    folder.mkdir(parents=True, exist_ok=True)
    motors = [
        Motor(str(folder / f"motor{k:04}.parquet"), k + 1, seconds, _FAULTS[k % len(_FAULTS)])
        for k in range(count)
    ]
    with ProcessPoolExecutor(jobs) as pool:
        list(pool.map(make, motors))
    for kind, motor in enumerate(motors[-_DAMAGED:]):
        damage(Path(motor.path), kind)
    return motors


def command(folder: Path, output: Path, *words: str) -> list[str]:
    """The command that watches them."""
    words = ("monitor", MODEL, str(folder), "-o", str(output), *words)
    return [sys.executable, "-m", "bondgraph", *words]


def watch(folder: Path, output: Path, *words: str) -> None:
    """Watch them; raises where that fails."""
    quiet = subprocess.DEVNULL
    subprocess.run(command(folder, output, *words), check=True, stdout=quiet, stderr=quiet)


def killed(folder: Path, output: Path, count: int) -> None:
    """Watch them with two processes, killed once half of them are done, and started again."""
    kept, quiet = Path(f"{output}.part"), subprocess.DEVNULL
    words = command(folder, output, "--jobs", "2")
    with subprocess.Popen(words, stdout=quiet, stderr=quiet) as process:
        while len(list(kept.glob("*.json"))) < (count - _DAMAGED) // 2:
            if process.poll() is not None:
                raise RuntimeError("it ended before it could be killed")
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
    done = subprocess.run(words, check=True, capture_output=True, text=True)
    if "watched before" not in done.stderr:
        raise RuntimeError("nothing was kept")


@contextmanager
def local_cluster() -> Iterator[str]:
    """The address of two workers that this process has started."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        yield cluster.scheduler_address


@contextmanager
def scheduler(folder: Path) -> Iterator[str]:
    """The address of a scheduler, with two workers in processes of their own."""
    from distributed import Client

    file = folder / "scheduler.json"
    quiet = subprocess.DEVNULL

    def start(module: str, *words: str) -> subprocess.Popen[bytes]:
        program = [sys.executable, "-m", f"distributed.cli.{module}", "--scheduler-file", str(file)]
        return subprocess.Popen([*program, *words], stdout=quiet, stderr=quiet, cwd=folder)

    with ExitStack() as stack:
        started = [start("dask_scheduler", "--port", "0", "--no-dashboard")]
        started += [start("dask_worker", "--nthreads", "1", "--no-dashboard") for _ in range(2)]
        for process in started:
            stack.callback(process.wait)
            stack.callback(process.terminate)
        while not file.exists():
            time.sleep(0.05)
        with Client(scheduler_file=str(file)) as client:
            client.wait_for_workers(2)
            address = str(client.scheduler.address)
        yield address


def processors() -> float:
    """Seconds that processors have worked for processes that have ended, killed ones aside."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def right(motors: Sequence[Motor], logs: Sequence[WatchedLog]) -> list[tuple[str, int, int]]:
    """For each kind of log how many there are, and of how many what was said is right."""
    found: dict[str, list[bool]] = {}
    damaged = {motor.path for motor in motors[-_DAMAGED:]}
    for motor, log in zip(motors, logs, strict=True):
        if motor.path in damaged:
            found.setdefault("damaged: said to be bad", []).append(log.state == BAD)
        elif motor.fault is None:
            found.setdefault("healthy: no alarm", []).append(log.state != BAD and not log.alarms)
        else:
            name = f"{motor.fault[0]} times {motor.fault[1]:g}: named, and not before"
            alarm, onset = log.last_alarm, motor.seconds / 2
            good = alarm is not None and alarm.since is not None and alarm.since > onset - 1.0
            named = alarm is not None and motor.fault[0] in alarm.group
            found.setdefault(name, []).append(log.alarms == 1 and good and named)
    return [(name, len(all_), sum(all_)) for name, all_ in found.items()]


def main(words: Sequence[str] | None = None) -> int:
    """Make, watch, compare, print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--logs", type=int, default=200)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--jobs", type=int, default=2, help="processes that make the logs")
    parser.add_argument("--folder", help="where logs are kept for another time (default: nowhere)")
    parser.add_argument("--write", action="store_true", help="write the table into the page")
    args = parser.parse_args(words)
    if args.logs < 2 * _DAMAGED:
        parser.error(f"at least {2 * _DAMAGED} logs, {_DAMAGED} of them are damaged")
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(args.folder or temporary) / "logs"
        motors = made(folder, args.logs, 60.0 * args.minutes, args.jobs)
        table = "\n".join(campaign(folder, Path(temporary), motors))
    print(table)
    if args.write:
        command = f"python -m tests.fleet_campaign --logs {args.logs} --minutes {args.minutes:g}"
        measured.write(PAGE, command, table)
    return 0 if "differs" not in table else 1


def campaign(folder: Path, outputs: Path, motors: Sequence[Motor]) -> Iterator[str]:
    """The lines of the table."""

    def on(cluster: Callable[[], object], output: Path) -> float:
        with cluster() as address:  # type: ignore[attr-defined]
            return timed(lambda: watch(folder, output, "--scheduler", address))

    def timed(what: Callable[[], None]) -> float:
        start = time.monotonic()
        what()
        return time.monotonic() - start

    ways: dict[str, Callable[[Path], float]] = {
        "one process": lambda o: timed(lambda: watch(folder, o)),
        "two processes": lambda o: timed(lambda: watch(folder, o, "--jobs", "2")),
        "two, killed half way and started again": (
            lambda o: timed(lambda: killed(folder, o, len(motors)))
        ),
        "the same once more, all known": lambda o: timed(lambda: watch(folder, o, "--jobs", "2")),
        "Dask, a LocalCluster of two": lambda o: on(local_cluster, o),
        "Dask, a scheduler and two workers": lambda o: on(lambda: scheduler(outputs), o),
    }
    seconds = sum(m.seconds for m in motors[:-_DAMAGED])
    yield "| watched by | s | s of log in one | s of processors | output |"
    yield "|---|---|---|---|---|"
    first: bytes | None = None
    output = outputs / "none.parquet"
    for k, (name, way) in enumerate(ways.items()):
        if "once more" not in name:  # which is about the output of the one before
            output = outputs / f"verdicts{k}.parquet"
        before = processors()
        took = way(output)
        first = first or output.read_bytes()
        same = "the same" if output.read_bytes() == first else "differs"
        worked = processors() - before
        yield f"| {name} | {took:.1f} | {seconds / took:.0f} | {worked:.1f} | {same} |"
    yield ""
    yield "| logs | number | right |"
    yield "|---|---|---|"
    for name, count, good in right(motors, read_verdicts(str(output))):
        yield f"| {name} | {count} | {good} |"


if __name__ == "__main__":
    sys.exit(main())
