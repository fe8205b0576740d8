"""The library that counts operations on files and has them fail: built, loaded, and told what."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

SOURCE = Path(__file__).with_name("interpose.c")

#: What can happen at an operation, as in the enumeration of the C file, and at which ones.
_CHANGES = "create open write sync truncate chmod utime rename unlink rmdir mkdir link".split()
_GROWS = "create write mkdir rename sync link".split()
_NAMES = "create open look chmod utime rename unlink rmdir mkdir link".split()
KINDS: dict[str, tuple[int, list[str]]] = {
    "killed": (1, _CHANGES),
    "power lost": (2, _CHANGES),
    "killed in a write": (3, ["write"]),
    "full in a write": (4, ["write"]),
    "ENOSPC from then on": (5, _GROWS),
    "EIO": (6, [*_CHANGES, "look", "read"]),
    "EACCES": (7, _NAMES),
}
ENDS = {"killed", "power lost", "killed in a write"}  # the process does not live on


class Operation(NamedTuple):
    """What was done to which file; `to` is the new name of one that is renamed."""

    what: str
    path: str
    to: str


class Point(NamedTuple):
    """Something that happens at an operation, counted from 0."""

    at: int
    kind: str


def again(module: str, root: Path, words: list[str]) -> int:
    """Run a module with the library loaded, its caches below `root`; the exit status."""
    library = root.parent / "interpose.so"
    flags = ["-shared", "-fPIC", "-O1", "-Wall", "-Wextra", "-Werror"]
    subprocess.run(["cc", *flags, "-o", str(library), str(SOURCE), "-ldl"], check=True)
    own = {"LD_PRELOAD": str(library), "XDG_CACHE_HOME": str(root / "cache"), "HOME": str(root),
           "TMPDIR": str(root / "tmp"), "OPENBLAS_NUM_THREADS": "1"}  # fmt: skip
    command = [sys.executable, "-m", module, *words]
    return subprocess.run(command, env={**os.environ, **own}, check=False).returncode


def loaded() -> bool:
    """Whether this process has the library."""
    return hasattr(ctypes.CDLL(None), "faults_arm")


def arm(root: Path, point: Point | None = None) -> None:
    """Count from here on what is done below `root`; with a point that happens there."""
    at, how = (-1, 0) if point is None else (point.at, KINDS[point.kind][0])
    ctypes.CDLL(None).faults_arm(str(root).encode(), ctypes.c_long(at), how)


def disarm() -> list[Operation]:
    """Count no longer; the operations so far."""
    library = ctypes.CDLL(None)
    library.faults_log.restype = ctypes.c_char_p
    lines = library.faults_log().decode(errors="surrogateescape").splitlines()
    library.faults_arm(b"", ctypes.c_long(-1), 0)
    return [Operation(*line.split("\t")) for line in lines]


def points(operations: Iterable[Operation]) -> list[Point]:
    """All that can happen at all of them."""
    return [
        Point(k, kind)
        for k, one in enumerate(operations)
        for kind, (_, where) in KINDS.items()
        if one.what in where
    ]


def unsynced(operations: Iterable[Operation]) -> list[str]:
    """What had another name before it was on the disk, and names that are not there at the end."""
    wet: set[str] = set()  # written since they were put on the disk
    names: dict[str, str] = {}  # folders with new names, and which
    found = []
    for what, path, to in operations:
        if what == "write":
            wet.add(path)
        elif what == "sync":
            wet.discard(path)
            names.pop(path, None)
        elif what == "rename":
            if path in wet:
                found.append(f"{path} is renamed to {to} before it is on the disk")
            names[os.path.dirname(to)] = to
    return found + [f"the name {name} is not on the disk" for name in names.values()]
