"""Time commands in turn and compare their medians: A B A B, so that drift hits both alike."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time
from collections.abc import Sequence
from typing import NamedTuple


class Timing(NamedTuple):
    """Seconds of one command: the median, and the spread."""

    median: float
    least: float
    most: float


def once(command: Sequence[str]) -> float:
    """Wall-clock seconds of one run; raises CalledProcessError if it fails.

    Bytecode is kept, whatever the environment says: installed packages bring theirs.
    """
    kept = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    start = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env=kept)
    return time.perf_counter() - start


def in_turn(commands: Sequence[Sequence[str]], runs: int) -> list[Timing]:
    """Every command `runs` times, taken in turn, after one run each that does not count."""
    for command in commands:
        once(command)
    seconds: list[list[float]] = [[] for _ in commands]
    for _ in range(runs):
        for own, command in zip(seconds, commands, strict=True):
            own.append(once(command))
    return [Timing(statistics.median(s), min(s), max(s)) for s in seconds]


def python(*arguments: str) -> list[str]:
    """A command of this interpreter."""
    return [sys.executable, *arguments]
