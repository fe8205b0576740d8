"""How results and failures reach the terminal: colour, diagnostics, files written whole."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import IO

from bondgraph.cli.terminal import styled
from bondgraph.text.diagnostic import CompileError, Diagnostic
from bondgraph.text.limits import SHOWN
from bondgraph.text.printable import printable


class Unknown(Exception):
    """A name among the arguments that nothing has: status 2."""

    def __init__(self, name: str, what: str, names: Iterable[str]) -> None:
        super().__init__(f"{what} is called `{name}`{hint(name, names)}")


def hint(name: str, names: Iterable[str]) -> str:
    """Which names may be meant, as the end of a message."""
    from difflib import get_close_matches

    close = get_close_matches(name, list(names), 3, 0.5)
    return f"; did you mean {' or '.join(f'`{c}`' for c in close)}?" if close else ""


def coloured(stream: IO[str]) -> bool:
    """Whether colour is wanted on `stream`: a terminal, and NO_COLOR (no-color.org) not set."""
    return stream.isatty() and not os.environ.get("NO_COLOR")


def show(diagnostics: Iterable[Diagnostic]) -> None:
    """Print diagnostics on the error stream."""
    found = tuple(diagnostics)
    if found:
        from bondgraph.text.render import render

        some = _some(found)
        styled(sys.stderr, render(some, color=coloured(sys.stderr)))
        if len(some) < len(found):
            print(f"{len(found) - len(some)} more are not shown: mend these first", file=sys.stderr)


def _some(found: tuple[Diagnostic, ...]) -> list[Diagnostic]:
    """The first ones of each kind, in order."""
    seen: dict[str, int] = {}
    shown = []
    for diagnostic in found:
        seen[diagnostic.code] = seen.get(diagnostic.code, 0) + 1
        if seen[diagnostic.code] <= SHOWN:
            shown.append(diagnostic)
    return shown


def print_json(value: object) -> None:
    """Print one JSON object on the output stream."""
    from bondgraph.text.printable import json_text

    print(json_text(value, indent=2, allow_nan=True))


def told(
    json: bool,
    diagnostics: Iterable[Diagnostic],
    message: str,
    result: Callable[[], dict[str, object]],
    lines: Callable[[], list[str]],
) -> int:
    """Print what a command has found, as one JSON object or as lines; the exit status is 0."""
    if json:
        from bondgraph.text.render import as_json

        diagnosed = as_json(tuple(diagnostics))
        print_json({"status": "ok", "message": message, "diagnostics": diagnosed, **result()})
    else:
        show(diagnostics)
        print("\n".join(lines()))
    return 0


#: Findings about a model that is sound, but that the compiler cannot solve.
_REFUSALS = frozenset({"initial-value-needed", "loop-too-large", "loop-unsolvable"})


def status(error: CompileError) -> str:
    """`error` where the model is wrong, `refused` where it cannot be solved."""
    codes = {d.code for d in error.diagnostics if d.severity == "error"}
    return "refused" if codes and codes <= _REFUSALS else error.status


def failure(error: CompileError) -> dict[str, object]:
    """The machine-readable result of a model that is wrong or cannot be solved."""
    from bondgraph.text.render import as_json

    return {
        "status": status(error),
        "message": str(error),
        "diagnostics": as_json(error.diagnostics),
        "n_arr": 0,
        "files": [],
        "arrs": [],
        "missing": [],
        "undetectable": [],
        "groups": [],
    }


def failed(error: CompileError, json: bool) -> int:
    """Report a model that is wrong or cannot be solved; the exit status is 1."""
    if json:
        print_json(failure(error))
    elif error.diagnostics:
        show(error.diagnostics)
    else:
        print(f"error: {error}", file=sys.stderr)
    return 1


def broken(message: str, json: bool) -> int:
    """Report a failure that is not a finding about the model; the exit status is 1."""
    if json:
        print_json({**failure(CompileError(())), "message": message})
    else:
        print(f"error: {message}", file=sys.stderr)
    return 1


def stem(path: str) -> str:
    """The name of a file without its folder and suffix."""
    return os.path.splitext(os.path.basename(path))[0]


def columns(rows: list[tuple[str, ...]]) -> list[str]:
    """The lines of a table, each column as wide as it has to be."""
    sizes = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return [
        "  " + "  ".join(c.ljust(n) for c, n in zip(row, sizes, strict=True)).rstrip()
        for row in rows
    ]


def deliver(output: str, made: str | bytes, what: str) -> None:
    """Write a text or bytes to a file and say what it is; a text for `-` is printed alone."""
    if output == "-" and isinstance(made, str):
        sys.stdout.write(made)
        return
    from bondgraph.text.whole_file import write_bytes, write_whole

    os.makedirs(os.path.dirname(output) or ".", exist_ok=True)
    if isinstance(made, str):
        write_whole(output, made)
    else:
        write_bytes(output, made)
    print(f"{output}: {what}")


@contextmanager
def progress_bar(word: str = "", patience: float = 1.0) -> Iterator[Callable[..., None]]:
    """Gives a function that says which share, 0 to 1, is done; a bar as of `progress`.

    A word besides says what is being done now, in place of the one for all.
    """
    parts = 24
    with progress(parts, patience) as advance:
        shown = 0

        def share(done: float, now: str = word) -> None:
            nonlocal shown
            while shown <= done * parts:
                advance(now)
                shown += 1

        yield share


@contextmanager
def progress(steps: int, patience: float = 1.0) -> Iterator[Callable[[str], None]]:
    """Gives a function that says what is being done now.

    On a terminal a bar appears once that has taken longer than `patience` seconds.
    """
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    from threading import Event, Thread

    done = 0
    word = ""
    finished = Event()

    def draw() -> None:
        if finished.wait(patience):
            return
        while True:
            filled = 24 * (done - 1) // steps
            bar = "=" * filled + " " * (24 - filled)
            styled(sys.stderr, f"\r[{bar}] {printable(word):<16}")
            sys.stderr.flush()
            if finished.wait(0.1):
                styled(sys.stderr, "\r" + " " * 44 + "\r")
                sys.stderr.flush()
                return

    def advance(now: str) -> None:
        nonlocal done, word
        done, word = done + 1, now

    thread = Thread(target=draw, daemon=True)
    thread.start()
    try:
        yield advance
    finally:
        finished.set()
        thread.join()
