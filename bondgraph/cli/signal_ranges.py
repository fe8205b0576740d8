"""How far samples can go: what `--range` says of a signal, and `--ranges` has in a log."""

from __future__ import annotations

import math
from argparse import ArgumentParser, Namespace
from collections.abc import Mapping
from typing import TYPE_CHECKING

from bondgraph.cli.options import Amount, amount, check_read, check_units
from bondgraph.text.diagnostic import Trouble

if TYPE_CHECKING:
    from bondgraph import Compilation

#: How much farther than in a log a signal may go, both ways: a fault is not in it.
FARTHER = 2.0


def ranging(parser: ArgumentParser) -> None:
    """The options `--real`, `--range`, `--ranges` and `--map`."""
    add = parser.add_argument
    add("--real", choices=("double", "fixed"), default="double",
        help="what C computes with: double (or float, as it is compiled), or whole numbers of 32"
        " bits (default: double)")  # fmt: skip
    add("--range", metavar="NAME=LOW..HIGH", type=bounded, action="append", default=[],
        dest="bounds", help="what a signal can be, in SI or with a unit, for `--real fixed`"
        " (\"speed=-300..300 rad/s\"); may be repeated")  # fmt: skip
    add("--ranges", metavar="LOG", action="append", default=[],
        help="a log of the machine: signals go twice as far as in it; may be repeated")  # fmt: skip
    add("--map", metavar="FILE.toml",
        help="which column of that log is which signal, and in which unit")  # fmt: skip


def bounded(text: str) -> tuple[str, Amount, Amount]:
    """`NAME=LOW..HIGH`; a unit behind the second number is one of the first, too.

    >>> bounded("speed=-10..20 km/h")[0], bounded("speed=-3..6 m/s")[1:]
    ('speed', (-3.0, 6.0))
    """
    name, _, both = text.rpartition("=")
    low, dots, high = both.partition("..")
    upper = amount(high)
    lower = amount(low)
    if lower.unit is None and upper.unit is not None:
        lower = amount(f"{low} {upper.unit.text}")
    if not name or not dots or not -math.inf < lower < upper < math.inf:
        raise ValueError
    return name, lower, upper


bounded.__name__ = "NAME=LOW..HIGH"


def with_ranges(compilation: Compilation, args: Namespace) -> Compilation:
    """The same in the numbers that are asked for, with all ranges; raises `console.Unknown`."""
    given = [*(f"--range {b[0]}" for b in args.bounds), *args.ranges]
    if args.real == "double":
        if given or args.map:
            raise Trouble(f"{(*given, '--map')[0]}: ranges are for --real fixed only")
        return compilation
    found: dict[str, tuple[float, float]] = {}
    if compilation.options.extras:
        compilation.with_options(real="fixed")  # which says that there is no such thing
    if not compilation.residuals:
        return compilation  # there is nothing to be written
    for path in args.ranges:
        for name, own in _logged(compilation, path, args.map).items():
            low, high = found.get(name, own)
            found[name] = min(low, own[0]), max(high, own[1])
    program = compilation.program
    counted = {k.path for k in program.knowns if k.counts is not None}
    known = [k.path for k in program.knowns] + [s.name for s in program.states]
    check_read(compilation.graph, [name for name, _, _ in args.bounds], known)
    for name, low, high in args.bounds:
        check_units(compilation.graph, [(name, low), (name, high)])
        if name in counted and high.unit is not None:
            raise Trouble(f"`{name}` is an encoder: its range is in counts from sample to sample")
        found[name] = float(low), float(high)
    return compilation.with_options(real="fixed", ranges=found)


def _logged(
    compilation: Compilation, path: str, map_file: str | None
) -> Mapping[str, tuple[float, float]]:
    """By path the range of each signal that is not always 0 in a log."""
    import numpy as np

    from bondgraph.runtime.log_file import read_form
    from bondgraph.runtime.log_numbers import Form
    from bondgraph.runtime.monitoring.columns import Columns, read_map

    knowns = compilation.program.knowns
    mapping = read_map(map_file, knowns) if map_file else None
    log = read_form(path, Form(path, rate=compilation.options.rate))
    samples = Columns(knowns, mapping, path)(log)
    found = {}
    for known, column in zip(knowns, samples.T, strict=True):
        there = column[np.isfinite(column)]
        if known.counts is not None:  # a counter runs over
            there = (np.diff(there) + 2.0**31) % 2.0**32 - 2.0**31
        if len(there) and np.abs(there).max() > 0.0:
            size = FARTHER * float(np.abs(there).max())
            found[known.path] = -size, size
    return found
