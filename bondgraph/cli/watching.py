"""`--watch`: do something again whenever a file changes that it was made of, until ^C."""

from __future__ import annotations

import os
import sys
import time
from typing import TYPE_CHECKING

from bondgraph.cli import console
from bondgraph.text.diagnostic import CompileError, Trouble
from bondgraph.text.numerals import plural

if TYPE_CHECKING:
    from argparse import ArgumentParser
    from collections.abc import Callable, Iterable

    from bondgraph.ir.graph import BondGraph

_PAUSE = 0.2  # s between two looks at the files
_KINDS = (".bg", ".csv", ".tsv", ".toml")

#: What a file is as far as a look at it tells: time, size and place on the disk.
_Look = dict[str, tuple[int, int, int] | None]


def watching(parser: ArgumentParser) -> None:
    """The option `--watch`."""
    parser.add_argument(
        "--watch", action="store_true", help="again whenever a file changes, until ^C"
    )


def watched(act: Callable[[], int], models: Iterable[str], used: Callable[[], set[str]]) -> int:
    """Do it, and again after each change; 0 at ^C.

    Models, tables and maps in the folders of the `models` are looked at, and what was `used`
    besides, as imports of other folders. A change that comes while it is done counts too.
    """
    names = list(models)
    if "-" in names:
        raise Trouble("the input cannot be watched: name a file")
    try:
        while True:
            before = _looked(_files(names))
            try:
                act()
            except CompileError as error:
                console.failed(error, False)
            except Trouble as error:
                print(f"error: {error}", file=sys.stderr)
            before = {**_looked(used()), **before}
            sys.stdout.flush()
            print(f"watching {plural(len(before), 'file')}; ^C ends", file=sys.stderr, flush=True)
            while _looked(before) == before and _files(names) <= before.keys():
                time.sleep(_PAUSE)
    except KeyboardInterrupt:
        return 0


def sources_of(graph: BondGraph) -> set[str]:
    """The files that a graph was read from."""
    origins = [node.origin for node in graph.nodes] + [bond.origin for bond in graph.bonds]
    origins += [value.origin for value in graph.values] + [item.origin for item in graph.inputs]
    return {origin.source.path for origin in origins}


def _files(models: Iterable[str]) -> set[str]:
    """The models and what stands beside them."""
    found: set[str] = set()
    for name in models:
        path = name if os.path.exists(name) or ":" not in name else name.rpartition(":")[0]
        folder = os.path.dirname(path)
        found.add(path)
        for entry in os.scandir(folder or ".") if os.path.isdir(folder or ".") else ():
            if entry.name.endswith(_KINDS):
                found.add(os.path.join(folder, entry.name))
    return found


def _looked(paths: Iterable[str]) -> _Look:
    found: _Look = {}
    for path in paths:
        try:
            own = os.stat(path)
            found[path] = own.st_mtime_ns, own.st_size, own.st_ino
        except OSError:
            found[path] = None
    return found
