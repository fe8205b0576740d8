"""Whole logs through the engines: C called once, C in a loop, Python; and whether they agree."""

from __future__ import annotations

import shutil
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

import bondgraph
from bondgraph.backends.write import write
from bondgraph.compilation import Compilation
from bondgraph.runtime.monitoring.clock import clock_of
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.runtime.monitoring.native import NativeError
from tests.generated.scale import waves, worst

ROOT = Path(__file__).parents[2]
HAND = Path(__file__).parent / "hand"
ROBOT = ROOT / "models" / "khepera.bg"
_FLEET = 100


def build(c: Compilation, folder: Path) -> Path:
    """The program with the loop over the files of the robot."""
    robot = folder / "robot"
    write(c.artifacts, robot)
    program = folder / "loop"
    sources = [HAND / "loop.c", robot / "khepera.c"]
    command = ["cc", "-std=c99", "-O2", "-ffp-contract=off", f"-I{robot}"]
    subprocess.run([*command, "-o", str(program), *map(str, sources), "-lm"], check=True)
    return program


def loop(program: Path, samples: np.ndarray, runs: int) -> tuple[np.ndarray, np.ndarray]:
    """Seconds of each run for residuals and thresholds, and both after the last sample."""
    file = program.with_name("samples")
    samples.tofile(file)
    command = [str(program), str(file), str(len(samples)), str(runs)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    lines = np.array([[float(x) for x in line.split()] for line in done.stdout.splitlines()])
    return lines[:runs], lines[runs:]


def _seconds(engine: Engine, samples: np.ndarray) -> float:
    engine.reset()
    start = time.perf_counter()
    engine.run(samples)
    return time.perf_counter() - start


def report(short: bool) -> None:
    """The batch against the loop, many engines at once, C against Python."""
    if shutil.which("cc") is None:
        print("Whole logs: not compared, cc is not installed")
        return
    c = bondgraph.compile(ROBOT)
    try:
        engine = c.engine(native=True)
    except NativeError as error:
        print(f"Whole logs: not compared, {error}")
        return
    samples = np.nan_to_num(waves(c, 600_000))
    plain = engine.configured(bounds=False)
    rounds = 1 if short else 9
    own: list[tuple[float, float]] = []
    hand: list[np.ndarray] = []
    with tempfile.TemporaryDirectory() as folder:
        program = build(c, Path(folder))
        for _ in range(rounds):
            hand.append(loop(program, samples, 1)[0][0])
            own.append((_seconds(plain, samples), _seconds(engine, samples)))
    residuals, thresholds = np.median(hand, axis=0)
    print("10 minutes of the robot at 1 kHz, 600 000 samples in one call:")
    for what, k, other in (
        ("residuals", 0, residuals),
        ("residuals and thresholds", 1, residuals + thresholds),
    ):
        taken = statistics.median(pair[k] for pair in own)
        print(f"  {what:26} {taken * 1e3:6.0f} ms  C loop {other * 1e3:6.0f} ms", end="  ")
        print(f"{taken / other:5.2f}x  <= 1.5x")
    fleet = [plain.configured() for _ in range(_FLEET)]
    start = time.perf_counter()
    fleet[0].run_with(fleet[1:], samples[:6000])
    each = (time.perf_counter() - start) / _FLEET / 6000 / (residuals / len(samples))
    print(f"  {_FLEET} engines over one block: {each:.2f}x the C loop for each")
    clock = clock_of(engine)
    random = np.random.default_rng(1)
    times = (np.arange(len(samples)) + random.uniform(-0.05, 0.05, len(samples))) / 1e3
    start = time.perf_counter()
    clock.feed(times, samples)
    print(f"  the clock, with 5 % jitter: {(time.perf_counter() - start) * 1e3:.0f} ms")
    rows = 20_000 if short else len(samples)
    gappy, python = waves(c, rows), c.engine(native=False)
    start = time.perf_counter()
    error = worst(c.engine(native=True), python, gappy, 1000)
    taken = time.perf_counter() - start
    print(f"  C and Python over {rows / 1000:.0f} s: {error:.1e} of the terms  <= 1e-12", end="  ")
    print(f"(in Python {taken / rows * 1e6:.0f} us a sample)")
