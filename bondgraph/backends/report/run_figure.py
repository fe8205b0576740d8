"""Runs of a machine compared in one picture: a strip for each signal, a line for each run."""

from __future__ import annotations

import io
import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from bondgraph.backends.report.episode import Array, envelope
from bondgraph.backends.report.page import markup, style_sheet
from bondgraph.backends.report.plots import LINES, STYLES, colour, drawn, looks, plain, titled
from bondgraph.backends.templates import fill
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDE, _STRIP = 9.0, 1.35  # inch
_LEFT, _RIGHT, _FOOT, _HEAD = 0.8, 0.25, 0.55, 0.3  # inch, around the strips
_ROW = 0.24  # inch, of a line of the legend
_BINS = 1000  # points of a line, each with its least and its largest
_DOTS = 160  # a PNG, in an inch


class ShownRun(NamedTuple):
    """A run as it is shown: what it is called, its samples by signal, what happened when."""

    label: str
    time: Array
    columns: Mapping[str, Array]
    units: Mapping[str, str]
    marks: tuple[tuple[float, str], ...] = ()


def run_picture(runs: Sequence[ShownRun], names: Sequence[str], title: str, suffix: str) -> bytes:
    """A picture of the signals called `names`, as .png, .svg, .pdf or .html.

    The same runs give the same bytes.
    """
    with looks():
        figure = _figure(runs, names)
        if suffix == ".html":
            return _page(figure, runs, names, title).encode()
        stream = io.BytesIO()
        empty = {
            ".svg": {"Date": None, "Creator": None, "Title": title},
            ".pdf": {"CreationDate": None, "ModDate": None, "Creator": None, "Producer": None},
            ".png": {"Software": None},
        }[suffix]
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Glyph .* missing from font", UserWarning)
            figure.savefig(
                stream, format=suffix[1:], dpi=_DOTS, facecolor=colour("paper"), metadata=empty
            )
    return stream.getvalue()


def _figure(runs: Sequence[ShownRun], names: Sequence[str]) -> Figure:
    from matplotlib.figure import Figure

    several = len(runs) > 1
    columns = max(1, min(4, int(90 / (6 + max(len(run.label) for run in runs)))))
    legend = _ROW * -(-len(runs) // columns) + 0.16 if several else 0.0
    head = legend + (_HEAD if any(run.marks for run in runs) else 0.06)
    high = head + _FOOT + _STRIP * len(names)
    figure = Figure(figsize=(_WIDE, high))
    wide = (_WIDE - _LEFT - _RIGHT) / _WIDE
    axes: list[Axes] = []
    for at, name in enumerate(names):
        bottom = high - head - (at + 1) * _STRIP
        box = (_LEFT / _WIDE, bottom / high, wide, (_STRIP - 0.32) / high)
        axis = figure.add_axes(box, sharex=axes[0] if axes else None)
        axes.append(axis)
        _strip(axis, runs, name)
        if at < len(names) - 1:
            axis.tick_params(labelbottom=False)
    last = max((float(run.time[-1]) for run in runs if len(run.time)), default=1.0)
    axes[0].set_xlim(0.0, last or 1.0)
    axes[-1].set_xlabel("time in s")
    _marked(axes, runs)
    if several:
        _legend(figure, runs, columns, high)
    return figure


def _look(at: int, count: int) -> dict[str, Any]:
    """Colour and dashes of one of so many runs: of many, from dark to light in their order."""
    if count <= len(LINES):
        return {"color": colour(LINES[at]), "linestyle": STYLES[at]}
    from matplotlib import colormaps

    return {"color": colormaps["viridis"](0.82 * at / (count - 1)), "linestyle": "-"}


def _strip(axis: Axes, runs: Sequence[ShownRun], name: str) -> None:
    """One signal of all runs that have it."""
    plain(axis)
    unit = ""
    for at, run in enumerate(runs):
        values = run.columns.get(name)
        if values is None or not np.isfinite(values).any():
            continue
        unit = unit or run.units.get(name, "")
        t, v = envelope(run.time, values, _BINS)
        axis.plot(t, v, linewidth=1.2, **_look(at, len(runs)))
    axis.margins(y=0.12)
    titled(axis, name, unit)


def _marked(axes: Sequence[Axes], runs: Sequence[ShownRun]) -> None:
    """What happened, as a line through all strips, with its words above the first."""
    for time, text in dict.fromkeys(mark for run in runs for mark in run.marks):
        for axis in axes:
            axis.axvline(time, color=colour("ink"), linewidth=0.8, linestyle=(0, (1, 2)))
        axes[0].annotate(
            text, (time, 1), xycoords=("data", "axes fraction"), xytext=(2, 16),
            textcoords="offset points", ha="left", va="bottom", fontsize=9,
        )  # fmt: skip


def _legend(figure: Figure, runs: Sequence[ShownRun], columns: int, high: float) -> None:
    from matplotlib.lines import Line2D

    lines = [Line2D([], [], linewidth=1.5, **_look(k, len(runs))) for k in range(len(runs))]
    figure.legend(
        lines, [run.label for run in runs], loc="upper left", ncols=columns, frameon=False,
        bbox_to_anchor=(_LEFT / _WIDE, 1.0 - 0.1 / high), borderaxespad=0.0, handlelength=2.6,
        borderpad=0.0,
    )  # fmt: skip


def _page(figure: Figure, runs: Sequence[ShownRun], names: Sequence[str], title: str) -> str:
    """A page of its own: the picture, and each signal at the end of each run."""
    told = f"Signals: {', '.join(names)}. Lines: {', '.join(run.label for run in runs)}."
    rows = []
    for run in runs:
        ends = [run.columns[n][-1] if n in run.columns else np.nan for n in names]
        rows.append((run.label, [f"{v:.5g}" if np.isfinite(v) else "" for v in ends]))
    units = {n: next((u for r in runs if (u := r.units.get(n, ""))), "") for n in names}
    heads = [f"{n} in {units[n]}" if units[n] not in ("", "1") else n for n in names]
    picture = markup(drawn(figure, "runs", title, told))
    holes: dict[str, object] = {
        "title": title, "style": markup(style_sheet()), "picture": picture, "heads": heads,
        "rows": rows,
    }  # fmt: skip
    return fill("report/runs.html.j2", holes, html=True)
