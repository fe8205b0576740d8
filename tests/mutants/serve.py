"""Runs pytest again and again, each time in a fork that has the heavy packages already.

A line of standard input is a JSON list: how many seconds of processor time each file of tests takes
without a mutant, and the arguments of pytest. The answer is a line with its status, `timed out`
when a test took several times as long as its file should, or waited for very long. Importing the
packages takes longer than most mutants live.
"""

from __future__ import annotations

import importlib
import json
import math
import os
import resource
import signal
import sys
import time

import pytest

_PACKAGES = "jinja2 networkx numpy scipy.optimize scipy.stats sympy".split()
_MEMORY = 3 << 30  # bytes; a mutant may make a loop endless


def main() -> None:
    """Serve until the end of the input."""
    for name in _PACKAGES:
        importlib.import_module(name)
    for line in sys.stdin:
        seconds, *arguments = json.loads(line)
        child = os.fork()
        if child == 0:
            os._exit(_pytest(seconds, arguments))
        most = 120.0 + 30.0 * sum(seconds.values())
        print(_waited(child, time.monotonic() + most), flush=True)


class _Limit:
    """Gives each test its time: an endless loop in the first is not one for as long as all take."""

    def __init__(self, seconds: dict[str, float]) -> None:
        self.seconds = seconds

    def more(self, seconds: float) -> None:
        """So many seconds of processor time from here on."""
        _, hard = resource.getrlimit(resource.RLIMIT_CPU)
        resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(time.process_time() + seconds), hard))

    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        """Before each test."""
        self.more(10.0 + 3.0 * self.seconds.get(item.nodeid.split("::")[0], 0.0))


def _pytest(seconds: dict[str, float], arguments: list[str]) -> int:
    """Pytest without a word, in a group of processes of its own, with an end to what it takes."""
    os.setsid()
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    limit = _Limit(seconds)
    limit.more(30.0)  # for what is imported
    silent = os.open(os.devnull, os.O_RDWR)
    for stream in range(3):
        os.dup2(silent, stream)
    return int(pytest.main(arguments, plugins=[limit]))


def _waited(child: int, until: float) -> str:
    """The status of a child; it and all that it has started are stopped when the time is over."""
    while time.monotonic() < until:
        pid, status = os.waitpid(child, os.WNOHANG)
        if pid:
            found = os.waitstatus_to_exitcode(status)
            late = found in (-signal.SIGXCPU, -signal.SIGKILL)  # the second ends every excess
            return "timed out" if late else str(found)
        time.sleep(0.02)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return "timed out"


if __name__ == "__main__":
    main()
