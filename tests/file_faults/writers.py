"""The commands that write files, each with what stands there before and what it is asked for."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from tests.measured import ROOT

Run = Callable[[list[str]], None]

_SCENARIO = """\
duration = 6
[sampling]
rate = 250
[sensors.current]
noise = "1 mA"
[sensors.speed]
noise = "0.5 rad/s"
[inputs]
U = { table = [[0, 0], [0.5, 6], [2, 3], [3, 6]] }
[[fault]]
of = "R"
change = "*= 3"
at = 4
"""


class Writer(NamedTuple):
    """A command by its words, and the files that it writes, all relative to its folder.

    `begin` makes what stands there before. Files of `outputs` are the old ones or the new ones at
    any time; those of `folder` after the next run. A `journal` is looked at by its records. `cold`
    is one that finds no template in memory. What is run next is the same command, or `then`.
    """

    name: str
    words: str
    outputs: tuple[str, ...] = ()
    folder: str = ""
    journal: str = ""
    begin: Callable[[Path, Run], None] = lambda folder, run: None
    cold: bool = False
    then: str = ""


def plant(folder: Path, run: Run) -> None:
    """A model with a log of it, and warm caches: what all writers begin with."""
    shutil.copy(ROOT / "models" / "dc_motor.bg", folder / "motor.bg")
    (folder / "s.toml").write_text(_SCENARIO)
    run("simulate motor.bg s.toml -o log.csv".split())
    run("monitor motor.bg log.csv --json".split())
    run("compile motor.bg -o warm".split())
    shutil.rmtree(folder / "warm")


def _old(*names: str) -> Callable[[Path, Run], None]:
    def begin(folder: Path, run: Run) -> None:
        for name in names:
            (folder / name).write_text("old\n")

    return begin


def _compiled(folder: Path, run: Run) -> None:
    run("compile motor.bg -o out".split())


def _spaced(folder: Path, run: Run) -> None:
    model = folder / "motor.bg"
    model.write_text(model.read_text().replace("->", "   ->"))


def _half(folder: Path, run: Run) -> None:
    """A journal of the first half of the log."""
    log = folder / "log.csv"
    whole = log.read_text()
    log.write_text("".join(whole.splitlines(keepends=True)[:800]))
    run("monitor motor.bg log.csv --json --journal journal".split())
    log.write_text(whole)


def _two_logs(folder: Path, run: Run) -> None:
    shutil.copy(folder / "log.csv", folder / "other.csv")


def _cold(folder: Path, run: Run) -> None:
    shutil.rmtree(folder.parent / "cache")


WRITERS = (
    Writer("compile, new folder", "compile motor.bg -o out", folder="out",
           then="compile motor.bg -o out --rate 250"),
    Writer("compile, other files", "compile motor.bg -o out --target c --rate 500",
           folder="out", begin=_compiled, then="compile motor.bg -o out --rate 250"),
    Writer("draw", "draw motor.bg -o out.svg", ("out.svg",), begin=_old("out.svg")),
    Writer("report", "report motor.bg -o out.html", ("out.html",), begin=_old("out.html")),
    Writer("format", "format motor.bg", ("motor.bg",), begin=_spaced),
    Writer("simulate", "simulate motor.bg s.toml -o out.csv --truth out.parquet",
           ("out.csv", "out.parquet"), begin=_old("out.csv", "out.parquet")),
    Writer("tune", "tune motor.bg log.csv -o out.json", ("out.json",), begin=_old("out.json")),
    Writer("fit", "fit motor.bg log.csv -o out.toml", ("out.toml",), begin=_old("out.toml")),
    Writer("states, CSV", "monitor motor.bg log.csv --states out.csv", ("out.csv",),
           begin=_old("out.csv")),
    Writer("states, Parquet", "monitor motor.bg log.csv --states out.parquet", ("out.parquet",),
           begin=_old("out.parquet")),
    Writer("fleet, CSV", "monitor motor.bg log.csv other.csv --output out.csv", ("out.csv",),
           begin=_two_logs),
    Writer("fleet, Parquet", "monitor motor.bg log.csv other.csv --output out.parquet",
           ("out.parquet",), begin=_two_logs),
    Writer("journal, new", "monitor motor.bg log.csv --json --journal journal",
           journal="journal"),
    Writer("journal, again", "monitor motor.bg log.csv --json --journal journal",
           journal="journal", begin=_half),
    Writer("templates", "compile motor.bg -o out --target python", folder="out", begin=_cold,
           cold=True),
    Writer("libraries", "monitor motor.bg log.csv --json", begin=_cold),
)  # fmt: skip


def lines(text: str) -> list[dict[str, object]]:
    """The lines of JSON that were printed to their end."""
    return [json.loads(line) for line in text.split("\n")[:-1]]
