"""Runs pytest again and again, each time in a fork that has the heavy packages already.

A line of standard input is a JSON list: seconds of processor time at most, and the arguments of
pytest. The answer is a line with its status, `timed out` when it took longer, or waited for very
long. Importing the packages takes longer than most mutants live.
"""

from __future__ import annotations

import importlib
import json
import os
import resource
import signal
import sys
import time

_PACKAGES = "jinja2 networkx numpy pytest scipy.optimize scipy.stats sympy".split()
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
        print(_waited(child, time.monotonic() + 60.0 + 10.0 * seconds), flush=True)


def _pytest(seconds: int, arguments: list[str]) -> int:
    """Pytest without a word, in a group of processes of its own, with an end to what it takes."""
    import pytest

    os.setsid()
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    silent = os.open(os.devnull, os.O_RDWR)
    for stream in range(3):
        os.dup2(silent, stream)
    return int(pytest.main(arguments))


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
