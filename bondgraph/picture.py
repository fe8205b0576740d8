"""A picture of runs as a person works with it: shown in a notebook, written to a file."""

from __future__ import annotations

import os
from collections.abc import Mapping
from importlib.util import find_spec
from typing import TYPE_CHECKING

from bondgraph.text.diagnostic import Trouble
from bondgraph.text.numerals import plural
from bondgraph.text.whole_file import write_bytes

if TYPE_CHECKING:
    from bondgraph.backends.report.run_figure import ShownRun
    from bondgraph.runtime.simulation.run import Run

_SUFFIXES = (".png", ".svg", ".pdf", ".html")
_STRIPS = 12  # signals of one picture


class Picture:
    """Signals of some runs over time; `runs` by label."""

    def __init__(self, title: str, runs: Mapping[str, Run], signals: tuple[str, ...]) -> None:
        self.title = title
        self.runs = dict(runs)
        first = next(iter(self.runs.values()))
        every = {**first.truth.columns, **first.log.columns}
        for name in signals:
            if name not in every:
                raise KeyError(name)
        self.signals = signals or tuple(first.log.columns)
        if len(self.signals) > _STRIPS:
            many = plural(len(self.signals), "signal")
            raise Trouble(f"{many} are too many for one picture: choose up to {_STRIPS} of them")

    def data(self, suffix: str) -> bytes:
        """The file of a suffix: .png, .svg, .pdf or .html; the same runs give the same bytes."""
        from bondgraph.backends.report.run_figure import run_picture

        suffix_of(f"picture{suffix}")
        runs = [_shown(label, run) for label, run in self.runs.items()]
        return run_picture(runs, self.signals, self.title, suffix)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the picture; its suffix says what it is, and its folder is made."""
        name = os.fspath(path)
        data = self.data(suffix_of(name))
        os.makedirs(os.path.dirname(name) or ".", exist_ok=True)
        write_bytes(name, data)

    def __repr__(self) -> str:
        labels = ", ".join(filter(None, self.runs))
        return f"<picture of {', '.join(self.signals)}{labels and f': {labels}'}>"

    def _repr_svg_(self) -> str:
        return self.data(".svg").decode()


def suffix_of(path: str) -> str:
    """The suffix of a picture; raises `Trouble` where there is no such kind, or no matplotlib."""
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in _SUFFIXES:
        raise Trouble(f"{path}: a picture is a .png, .svg, .pdf or .html file")
    if find_spec("matplotlib") is None:
        raise Trouble("pictures need matplotlib: pip install 'bondgraph-arr[robot]'")
    return suffix


def _shown(label: str, run: Run) -> ShownRun:
    """A run as it is drawn: as it was read, states and true values besides."""
    from bondgraph.backends.report.run_figure import ShownRun

    log, truth = run.log, run.truth
    columns = {**truth.columns, **log.columns} if truth.rows == log.rows else dict(log.columns)
    marks = tuple((fault.at, fault.label) for fault in run.scenario.faults)
    return ShownRun(label, log.time, columns, {**truth.units, **log.units}, marks)
