"""Which functions of the compiler a test file reaches, and how long it takes: a pytest plugin.

`python -m pytest -p tests.mutants.reach tests/unit/x.py` with the name of a JSON file to be
written in BONDGRAPH_REACH.
"""

from __future__ import annotations

import json
import os
import resource
import sys
import threading
import time
from pathlib import Path
from types import CodeType, FrameType

_PACKAGE = str(Path(__file__).resolve().parents[2] / "bondgraph") + os.sep
_seen: dict[int, CodeType] = {}


def _seconds() -> float:
    """Processor time, also of what was started: a busy machine does not count."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def _called(frame: FrameType, event: str, argument: object) -> None:
    """Keep the function that is entered; no line of it is followed."""
    code = frame.f_code
    _seen[id(code)] = code


def pytest_configure() -> None:
    """Look at every call from here on."""
    threading.settrace(_called)
    sys.settrace(_called)


def pytest_sessionfinish(session: object, exitstatus: int) -> None:
    """Write what was seen: `bondgraph/passes/elimination/chaining.py:Chain.look`."""
    sys.settrace(None)
    threading.settrace(None)  # type: ignore[arg-type]
    functions = {
        f"bondgraph/{code.co_filename.removeprefix(_PACKAGE)}:{code.co_qualname}"
        for code in _seen.values()
        if code.co_filename.startswith(_PACKAGE)
    }
    found = {
        "status": int(exitstatus),
        "seconds": round(_seconds(), 1),
        "functions": sorted(functions),
    }
    Path(os.environ["BONDGRAPH_REACH"]).write_text(json.dumps(found), encoding="utf-8")
