"""Options of the commands that read logs: which column is what, in which unit, what counts."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from bondgraph.text.diagnostic import Trouble

if TYPE_CHECKING:
    from argparse import Namespace
    from collections.abc import Callable, Mapping

    from bondgraph.runtime.log import Log
    from bondgraph.runtime.log_numbers import Form
    from bondgraph.runtime.monitoring.columns import Mapped
    from bondgraph.runtime.monitoring.operating import Operating


def logged(add: Callable[..., object]) -> None:
    """The arguments that say what the columns of a log are."""
    add("--map", metavar="FILE.toml", help="which column is which signal, and in which unit")
    add("--columns", metavar="NAMES", default="",
        help="the header of CSV that comes without one: names, separated by commas")  # fmt: skip
    add("--time", metavar="NAME",
        help="the column of time (default: t, time or timestamp, if it grows)")  # fmt: skip
    add("--time-unit", metavar="s|ms|us|ns|min|h|d", type=timely,
        help="its unit (default: as its name says, else s)")  # fmt: skip
    add("--while", metavar="EXPR", dest="operating",
        help="only samples for which this holds, over columns: \"pump > 0\"")  # fmt: skip


def timely(text: str) -> str:
    """A unit of time; raises ValueError for any other text."""
    from bondgraph.runtime.time_column import timely as unit

    if unit(text) is None:
        raise ValueError
    return text


timely.__name__ = "unit of time"


def form_of(args: Namespace, name: str) -> Form:
    """What the arguments, and the map file, say of a log before it is read."""
    from bondgraph.runtime.log_numbers import Form
    from bondgraph.runtime.monitoring.columns import read_columns, read_time

    mapped = read_time(args.map) if args.map else None
    time = args.time or (mapped.column if mapped else None)
    unit = args.time_unit or (mapped.unit if mapped and not args.time else None)
    names = tuple(n.strip() for n in args.columns.split(",")) if args.columns else ()
    wanted = read_columns(args.map) if args.map and args.operating is None else frozenset()
    return Form(name, time, unit, names, args.rate, wanted)


def operating_of(
    args: Namespace, mapping: Mapping[str, Mapped] | None, name: str
) -> Operating | None:
    """What `--while` says, None where there is no such word; raises CompileError."""
    from bondgraph.runtime.monitoring.operating import Operating

    return None if args.operating is None else Operating(args.operating, mapping, name)


def note(text: str) -> None:
    """Say something on the error stream that is no result."""
    print(f"note: {text}", file=sys.stderr)


def read_logs(args: Namespace) -> list[tuple[str, Log]]:
    """The logs of the files, folders and patterns that the arguments name, each with its name."""
    from bondgraph.runtime.fleet.log_paths import log_files
    from bondgraph.runtime.log import LogError
    from bondgraph.runtime.log_file import read_form
    from bondgraph.text.numerals import listed

    names = [file.name for file in log_files(args.logs, note)]
    if not names:
        raise Trouble(f"no log to read in {listed(args.logs, 'and')}")
    logs = [(name, read_form(name, form_of(args, name))) for name in names]
    for name, log in logs:
        if not log.rows:
            raise LogError(name, None, "no samples: there are columns, and no rows below them")
    return logs


def times_of(logs: list[tuple[str, Log]]) -> dict[str, str]:
    """What was taken for the time of each log, which is said on the error stream too."""
    from bondgraph.runtime.log import TIME

    times = {name: log.meta[TIME] for name, log in logs if TIME in log.meta}
    for name, time in times.items():
        note(f"{name}: time is {time}")
    return times


def behind_gaps(lost: Mapping[str, float]) -> list[str]:
    """For how many seconds residuals were of no use behind gaps of the logs, in words."""
    from bondgraph.text.numerals import listed

    found = []
    for seconds in dict.fromkeys(lost.values()):
        names = [name for name, own in lost.items() if own == seconds]
        text = "is not used: it keeps" if len(names) == 1 else "are not used: they keep"
        found.append(
            f"For {seconds:.4g} s behind gaps {listed(names, 'and')} {text} something of where a"
            " log began, and nobody knows where that is after a gap"
        )
    return found
