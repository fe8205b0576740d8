"""C texts as a library in this process: compiled by the system's compiler, kept in a cache."""

from __future__ import annotations

import ctypes
import hashlib
import os
import platform
import shlex
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

from bondgraph.cache import user_cache
from bondgraph.ir.artifact import Artifact
from bondgraph.text.whole_file import folder_aside

#: One rounding for each operation, as in Python; nothing is seen from outside that is not shared.
_FLAGS = "-std=c99 -O2 -ffp-contract=off -fPIC -shared -fvisibility=hidden".split()


class NativeError(Exception):
    """Why generated C cannot be run here: no compiler, or one that fails."""


def warn(message: str) -> None:
    """Tell what is told to nobody else, as a RuntimeWarning."""
    warnings.warn(message, RuntimeWarning, stacklevel=3)


def library(
    files: Sequence[Artifact],
    sources: Sequence[str],
    what: str,
    sound: Callable[[ctypes.CDLL], bool],
    tell: Callable[[str], None],
) -> ctypes.CDLL:
    """The library of the `sources` among the files; raises NativeError where there can be none.

    `what` it holds, in words. `sound` says whether a library is the one that is wanted; it may
    raise AttributeError for a function that is not there. `tell` is told, in one line, of a cache
    that cannot be trusted.
    """
    compiler = _compiler()
    name = _digest(files, [*compiler, *_FLAGS], _version(tuple(compiler)))
    libraries = user_cache("so", lambda why: tell(f"{why}; {what} are compiled at each start"))
    kept = libraries.find(name) if libraries else iter(())
    found = next((found for path in kept if (found := _load(path, sound))), None)
    if found is None:
        try:
            with folder_aside(Path(tempfile.gettempdir())) as temporary:
                built = temporary / f"{name}.so"
                _compile(files, sources, what, compiler, built)
                taken = libraries.keep(name, built.read_bytes()) if libraries else None
                found = (_load(taken, sound) if taken else None) or _load(built, sound)
        except OSError as error:
            raise _unwritten(what, error) from error
    if found is None:
        raise NativeError(f"what {compiler[0]} made cannot be loaded")
    return found


def built(files: Sequence[Artifact], sources: Sequence[str], what: str) -> bytes:
    """The library of the `sources` among the files, for others to load; raises NativeError."""
    try:
        with folder_aside(Path(tempfile.gettempdir())) as temporary:
            made = temporary / "built"
            _compile(files, sources, what, _compiler(), made)
            return made.read_bytes()
    except OSError as error:
        raise _unwritten(what, error) from error


def _compiler() -> list[str]:
    """The words of the command that compiles C."""
    return shlex.split(os.environ.get("CC", "")) or ["cc"]


def _unwritten(what: str, error: OSError) -> NativeError:
    place = error.filename or tempfile.gettempdir()
    return NativeError(f"{what} cannot be compiled: {error.strerror}: {place}")


@cache
def _version(compiler: tuple[str, ...]) -> str:
    """What the compiler says of itself; raises NativeError where there is none."""
    try:
        done = subprocess.run([*compiler, "--version"], capture_output=True, check=False)
    except OSError as error:
        raise NativeError(f"no C compiler `{compiler[0]}` ({error.strerror})") from error
    return done.stdout.decode("utf-8", "replace")


def _digest(files: Sequence[Artifact], *facts: Sequence[str] | str) -> str:
    """Identifies what would come out: all texts, the compiler, its flags, the machine."""
    texts = [(a.path, a.text) for a in files]
    everything = repr((texts, facts, sys.platform, platform.machine()))
    return hashlib.sha256(everything.encode("utf-8", "surrogatepass")).hexdigest()[:32]


def _compile(
    files: Sequence[Artifact], sources: Sequence[str], what: str, compiler: list[str], built: Path
) -> None:
    folder = built.parent
    for artifact in files:
        (folder / artifact.path).write_text(artifact.text, encoding="utf-8")
    command = [*compiler, *_FLAGS, "-o", str(built), *sources, "-lm"]
    done = subprocess.run(command, cwd=folder, capture_output=True, check=False)
    if done.returncode:
        told = done.stderr.decode("utf-8", "replace").splitlines()
        why = next((line for line in told if "error" in line), told[0] if told else "no reason")
        raise NativeError(f"{compiler[0]} does not compile {what}: {why.strip()}")


def _load(path: Path, sound: Callable[[ctypes.CDLL], bool]) -> ctypes.CDLL | None:
    """The library in a file; None if it cannot be loaded here, or is another one."""
    try:
        found = ctypes.CDLL(str(path))
        return found if sound(found) else None
    except (OSError, AttributeError):
        return None
