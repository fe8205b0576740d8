"""Episodes as figures: residual strips with thresholds, the time line of verdicts, trajectories.

What matplotlib draws becomes SVG for inside of a page, in its colours and fonts.
"""

from __future__ import annotations

import io
import math
import re
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from bondgraph.backends.drawing.paint import escape
from bondgraph.backends.drawing.style import palette
from bondgraph.backends.report.episode import (
    Array,
    Episode,
    Panel,
    Plane,
    Said,
    Trace,
    coarse,
    envelope,
    stretches,
)
from bondgraph.text.numerals import readable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDE = 10.0  # inch, of 72 px
_STRIP = 1.05  # inch, of one signal with its name above
_LEFT, _RIGHT = 0.75, 0.25  # inch, beside a strip
_BINS = 700  # points of a line, each with its least and its largest
_MOST = 8  # strips of one figure, so that it fits a page
LINES = ("inertia", "resistor", "capacity", "source")
STYLES: tuple[Any, ...] = ("-", (0, (6, 2)), (0, (2, 1.5)), (0, (7, 2, 1.5, 2)))
_SAID = {"fault": "resistor", "invalid": "faint", "gap": "faint", "warm-up": "box"}
_SETTINGS = {
    "svg.fonttype": "none",
    "svg.hashsalt": "bondgraph",
    "font.family": "sans-serif",
    "font.size": 10.0,
    "axes.labelsize": 10.0,
    "axes.unicode_minus": True,
    "legend.fontsize": 9.5,
    "path.simplify": True,
    "text.parse_math": False,  # names are names, also with a dollar in them
}


_NOISE = re.compile(r"<metadata>.*?</metadata>|<style[^>]*>.*?</style>|<!--.*?-->", re.S)


def strips(episode: Episode, key: str) -> list[str]:
    """Residuals above each other on one time axis, thresholds, marks, and the verdicts below.

    As many figures as it takes; `key` keeps their identifiers apart from others on the page.
    """
    traces = episode.residuals
    starts = range(0, len(traces), _MOST)
    return [_strips(episode, traces[k : k + _MOST], f"{key}{k}") for k in starts]


def _strips(episode: Episode, traces: Sequence[Trace], key: str) -> str:
    rows = _rows(episode.said)
    below = 0.45 + 0.24 * (max(rows.values(), default=-1) + 1) if rows else 0.0
    names = traces[0].name if len(traces) == 1 else f"{traces[0].name} to {traces[-1].name}"
    what = f"Residuals {names} of {episode.name} over time, with thresholds and verdicts"
    with looks():
        figure, axes = _stack(episode, len(traces), _STRIP, below)
        for axis, trace in zip(axes, traces, strict=False):
            _residual(axis, episode.time, trace)
        if rows:
            _verdicts(axes[-1], episode, rows)
        return drawn(figure, key, what, _told(episode))


def signals(episode: Episode, key: str) -> str:
    """The panels of an episode above each other on one time axis."""
    names = ", ".join(p.title for p in episode.panels)
    with looks():
        figure, axes = _stack(episode, len(episode.panels), 1.25, 0.0)
        for axis, panel in zip(axes, episode.panels, strict=True):
            _panel(axis, episode.time, panel)
        return drawn(figure, key, f"Signals of {episode.name} over time", names)


def plane(found: Plane, key: str) -> str:
    """Trajectories on equal scales, each with its name at its end."""
    names = ", ".join(c.name for c in found.curves)
    told = f"Curves: {names}. A ring is the start, a disc the end."
    with looks():
        return drawn(_plane(found), key, found.title, told)


def _plane(found: Plane) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.6, 5.0))
    axis = figure.add_axes((0.13, 0.12, 0.66, 0.82))
    for at, curve in enumerate(found.curves):
        look = {"color": colour(LINES[at % 4]), "linestyle": STYLES[at % 4]}
        x, y = _thinned(curve.x, curve.y)
        axis.plot(x, y, linewidth=1.5, **look)
        if len(x):
            axis.plot(x[0], y[0], "o", markersize=4, color=look["color"], markerfacecolor="none")
            axis.plot(x[-1], y[-1], "o", markersize=4, color=look["color"])
    axis.set_xlabel(found.x)
    axis.set_ylabel(found.y)
    axis.set_aspect("equal", adjustable="datalim")
    axis.margins(0.08)
    plain(axis)
    figure.draw_without_rendering()
    _names_at_ends(axis, found)
    return figure


# ------------------------------------------------------------------------- strips


def _stack(episode: Episode, count: int, height: float, below: float) -> tuple[Figure, list[Axes]]:
    """Axes above each other with marks through all of them; the last one for verdicts."""
    from matplotlib.figure import Figure

    top, foot = (0.36 if episode.marks else 0.05), 0.5
    high = top + foot + count * height + below
    figure = Figure(figsize=(_WIDE, high))
    wide = (_WIDE - _LEFT - _RIGHT) / _WIDE
    heights = [height] * count + ([below] if below else [])
    axes: list[Axes] = []
    at = high - top
    for own in heights:
        at -= own
        gap = 0.27
        box = (_LEFT / _WIDE, at / high, wide, (own - gap) / high)
        axes.append(figure.add_axes(box, sharex=axes[0] if axes else None))
    first, last = (float(episode.time[0]), float(episode.time[-1])) if len(episode.time) else (0, 1)
    for axis in axes:
        plain(axis)
        axis.set_xlim(first, last if last > first else first + 1)
        for mark in episode.marks:
            axis.axvline(mark.time, color=colour("ink"), linewidth=0.8, linestyle=(0, (1, 2)))
    for axis in axes[:-1]:
        axis.tick_params(labelbottom=False)
    axes[-1].set_xlabel("time in s")
    _marks(axes[0], episode, first, last)
    return figure, axes


def _marks(axis: Axes, episode: Episode, first: float, last: float) -> None:
    """What was done, above the first strip; where marks are near each other, in two lines."""
    span = (last - first) or 1.0
    inches = _WIDE - _LEFT - _RIGHT
    ends = [-math.inf, -math.inf]
    for mark in sorted(episode.marks):
        share = (mark.time - first) / span
        wide = 0.068 * len(mark.text) / inches
        side = "left" if share + wide < 1 else "right"
        start = share if side == "left" else share - wide
        line = next((k for k, end in enumerate(ends) if start > end + 0.01), None)
        if line is None:
            continue  # the verdicts and the list of marks have it
        ends[line] = start + wide
        axis.annotate(
            mark.text, (mark.time, 1), xycoords=("data", "axes fraction"),
            xytext=(2 if side == "left" else -2, 16 + 11 * line), textcoords="offset points",
            ha=side, va="bottom", fontsize=9,
        )  # fmt: skip


def _residual(axis: Axes, time: Array, trace: Trace) -> None:
    """The value between its thresholds; a bar below where it is outside, grey where invalid."""
    value = np.where(trace.valid, trace.value, np.nan) if trace.valid is not None else trace.value
    if trace.valid is not None:
        for a, b in stretches(~trace.valid, time):
            axis.axvspan(a, b, facecolor=colour("box"), alpha=0.45, linewidth=0)
    peak = float(np.nanmax(np.abs(value), initial=0.0)) if np.isfinite(value).any() else 0.0
    if trace.bound is not None:
        bound = np.where(np.isnan(value), np.nan, trace.bound)
        known = bound[np.isfinite(bound)]
        peak = max(peak, 1.15 * float(np.max(known, initial=0.0)))
        t, limit = envelope(time, bound, _BINS // 2)
        for side in (limit, -limit):
            axis.plot(t, side, color=colour("faint"), linewidth=0.9, linestyle=(0, (4, 2)))
    t, v = envelope(time, value, _BINS)
    axis.plot(t, v, color=colour("inertia"), linewidth=1.0)
    peak = peak or 1.0
    axis.set_ylim(-1.18 * peak, 1.18 * peak)
    if trace.bound is not None:
        with np.errstate(invalid="ignore"):
            outside = np.abs(value) > trace.bound
        for start, end in stretches(*coarse(outside, time, _BINS)):
            axis.plot([start, end], [-1.1 * peak] * 2, color=colour("resistor"), linewidth=3,
                      solid_capstyle="butt")  # fmt: skip
    titled(axis, trace.name, trace.unit)


def _panel(axis: Axes, time: Array, panel: Panel) -> None:
    """Signals of one unit, named at the right end of the strip where they are."""
    for at, trace in enumerate(panel.traces):
        t, v = envelope(time, trace.value, _BINS)
        axis.plot(t, v, color=colour(LINES[at % 4]), linestyle=STYLES[at % 4], linewidth=1.2)
    titled(axis, panel.title, panel.unit)
    axis.margins(y=0.12)
    if len(panel.traces) > 1:
        low, high = axis.get_ylim()
        axis.set_ylim(low, high + 0.3 * (high - low))  # room for the names
        from matplotlib.lines import Line2D

        lines = [
            Line2D([], [], color=colour(LINES[k % 4]), linestyle=STYLES[k % 4], linewidth=1.2)
            for k in range(len(panel.traces))
        ]
        axis.legend(
            lines, [t.name for t in panel.traces], loc="upper right", ncols=len(lines),
            frameon=False, borderaxespad=0, handlelength=2.6,
        )  # fmt: skip


def titled(axis: Axes, name: str, unit: str) -> None:
    """The name of a strip, above it on the left: however long it is, it has room."""
    text = f"{name} in {unit}" if unit and unit != "1" else name
    axis.annotate(text, (0, 1), xycoords="axes fraction", xytext=(0, 3),
                  textcoords="offset points", ha="left", va="bottom")  # fmt: skip


# ------------------------------------------------------------------------ verdicts


def _rows(said: Sequence[Said]) -> dict[int, int]:
    """The row of each verdict, by its place, so that none lies upon another."""
    ends: list[float] = []
    rows = {}
    for at, verdict in sorted(enumerate(said), key=lambda item: item[1].start):
        end = math.inf if verdict.end is None else verdict.end
        row = next((k for k, before in enumerate(ends) if before <= verdict.start), len(ends))
        ends[row : row + 1] = [end]
        rows[at] = row
    return rows


def _verdicts(axis: Axes, episode: Episode, rows: dict[int, int]) -> None:
    """A bar for each verdict with its words on it or beside it."""
    last = float(episode.time[-1]) if len(episode.time) else 1.0
    span = last - float(episode.time[0]) if len(episode.time) else 1.0
    most = max(rows.values()) + 1
    axis.set_ylim(most - 0.5, -0.5)
    axis.set_yticks([])
    titled(axis, "said", "")
    for at, row in rows.items():
        verdict = episode.said[at]
        end = last if verdict.end is None else verdict.end
        shade = colour(_SAID.get(verdict.kind, "faint"))
        axis.plot([verdict.start, end], [row + 0.28] * 2, color=shade, linewidth=3.2,
                  solid_capstyle="butt")  # fmt: skip
        if verdict.since is not None:
            axis.plot(
                verdict.since, row + 0.28, "|", color=shade, markersize=8, markeredgewidth=1.5
            )
        room = 7 * (_WIDE - _LEFT - _RIGHT) / 0.48 * (last - verdict.start) / span
        late = room < len(verdict.short)
        axis.annotate(
            verdict.short, (end if late else verdict.start, row + 0.12), fontsize=9,
            ha="right" if late else "left", va="bottom", annotation_clip=True,
        )  # fmt: skip


def _told(episode: Episode) -> str:
    """The verdicts as text, for those who do not see the figure."""
    return " ".join(f"{v.start:g} s: {v.text}" for v in episode.said)


# --------------------------------------------------------------------- trajectories


def _thinned(x: Array, y: Array) -> tuple[Array, Array]:
    """At most some hundred points along a curve, its ends included."""
    most = 2 * _BINS
    if len(x) <= most:
        return x, y
    at = np.unique(np.linspace(0, len(x) - 1, most).astype(int))
    return x[at], y[at]


def _names_at_ends(axis: Axes, found: Plane) -> None:
    """The name of each curve at the right, with a piece of its line, in the order of the ends."""
    box = axis.get_window_extent()
    high = box.height
    ends = []
    for at, curve in enumerate(found.curves):
        if len(curve.x):
            y = float(axis.transData.transform((curve.x[-1], curve.y[-1]))[1]) - box.y0
            ends.append((y / high, at))
    placed = -math.inf
    step = 0.055
    ends.sort()
    room = 1.0 - step * max(len(ends) - 1, 0)
    for rank, (y, at) in enumerate(ends):
        placed = max(min(y, room + step * rank), placed + step)
        look = {"color": colour(LINES[at % 4]), "linestyle": STYLES[at % 4]}
        axis.plot([1.02, 1.09], [placed] * 2, transform=axis.transAxes, clip_on=False,
                  linewidth=1.5, **look)  # fmt: skip
        axis.text(1.105, placed, found.curves[at].name, transform=axis.transAxes, va="center")


def plain(axis: Axes) -> None:
    """Axes without a box: two thin lines and outward ticks."""
    for side in ("top", "right"):
        axis.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axis.spines[side].set_linewidth(0.7)
    axis.tick_params(width=0.7, length=3)
    axis.locator_params(axis="y", nbins=3)
    for scale in (axis.xaxis, axis.yaxis):
        scale.set_major_formatter(lambda value, _: readable(value, 4))


def colour(name: str) -> str:
    """The colour of a figure by its name on the page (`ink`, `faint`, `inertia`, ...)."""
    return palette()[name]


@contextmanager
def looks() -> Iterator[None]:
    """Figures made inside look like those of the page, whatever the user's settings are."""
    import matplotlib

    ink = {f"{part}.color": colour("ink") for part in ("xtick", "ytick", "text")}
    ink |= {"axes.edgecolor": colour("ink"), "axes.labelcolor": colour("ink")}
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update({**_SETTINGS, **ink})
        yield


def drawn(figure: Figure, key: str, title: str, told: str) -> str:
    """The figure as SVG with `title` and `told` as what it says in words.

    Colours become those of the page, so that dark and light both work; identifiers begin with
    `key`; lengths have a tenth of a point. The same figure gives the same text.
    """
    stream = io.StringIO()
    metadata = {"Date": None, "Creator": None, "Format": None, "Type": None}
    with warnings.catch_warnings():
        # Letters are those of the browser: that matplotlib has no picture of one is no matter.
        warnings.filterwarnings("ignore", "Glyph .* missing from font", UserWarning)
        figure.savefig(stream, format="svg", transparent=True, metadata=metadata)
    return _inlined(stream.getvalue(), key, title, told)


def _inlined(text: str, key: str, title: str, told: str) -> str:
    head, _, body = text[text.index("<svg") :].partition(">")
    box = re.search(r'viewBox="([^"]*)"', head)
    assert box is not None
    wide, high = box[1].split()[2:]
    body = _NOISE.sub("", body)
    body = re.sub(r'(?<= id=")', f"{key}-", body)
    body = re.sub(r"url\(#", f"url(#{key}-", body)
    body = re.sub(r'xlink:href="#', f'href="#{key}-', body)
    body = re.sub(r"<[^>]*>", lambda tag: re.sub(r"(\d+\.\d)\d+", r"\1", tag[0]), body)
    body = re.sub(r"font: ([\d.]+)px [^;\"]*", r"font-size: \1px", body)
    body = re.sub(r"font-family: [^;\"]*; ?", "", body)
    for name, value in palette().items():
        body = body.replace(value, f"var(--{name})")
    body = re.sub(r"#000000\b|(?<=: )black\b", "var(--ink)", body)
    body = re.sub(r"\n\s*", "\n", body)
    return (
        f'<svg class="plot" viewBox="0 0 {wide} {high}" width="{wide}" height="{high}" role="img"'
        f' aria-labelledby="{key}-title"><title id="{key}-title">{escape(title)}</title>'
        f"<desc>{escape(told)}</desc>{body.rstrip()}\n"
    )
