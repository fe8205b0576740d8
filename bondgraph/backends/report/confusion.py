"""Which fault could be taken for which, as a picture."""

from __future__ import annotations

import re
from collections.abc import Sequence

from bondgraph.backends.drawing.paint import escape
from bondgraph.backends.drawing.style import width
from bondgraph.backends.report.content import Signatures

MOST = 120  # rows of a picture that is still one
_CELL = 13.0  # px
_TEXT = 10.0
_LONGEST = 28  # letters of a label before its words are shortened


def isolability(signatures: Signatures) -> str:
    """The isolability matrix as SVG; "" where there is nothing to confuse, or too much.

    The faults stand in the order of the signature matrix. Where they are too many, one row stands
    for each set of faults that nothing can divide.
    """
    classes = list(signatures.best or [tuple(r.fault for r in g.rows) for g in signatures.groups])
    faults = [f for group in signatures.groups for part in group.parts for f in part]
    if signatures.best is None:
        faults = [f for c in classes for f in c]
    units: list[tuple[str, ...]] = [(f,) for f in faults]
    if len(units) > MOST // 2:
        order = {f: at for at, f in enumerate(faults)}
        units = sorted(classes, key=lambda c: order[c[0]])
    if not 1 < len(units) <= MOST:
        return ""
    sees = {r.fault: frozenset(g.residuals) for g in signatures.groups for r in g.rows}
    best = {f: at for at, part in enumerate(classes) for f in part}
    cells = []
    for i, (one, *_) in enumerate(units):
        for j, (other, *_) in enumerate(units):
            cells.append(_cell(_relation(sees, best, one, other), j, i))
    return _picture([_label(u) for u in units], cells)


def _relation(sees: dict[str, frozenset[str]], best: dict[str, int], one: str, other: str) -> str:
    """How `one` is confused with `other`: always, by signature, or if silence is not trusted."""
    if best[one] == best[other]:
        return "always"
    if sees[one] == sees[other]:
        return "signature"
    return "silence" if sees[one] < sees[other] else ""


def _label(faults: Sequence[str]) -> str:
    name = faults[0]
    if len(name) > _LONGEST:  # every word and index of the path stays recognisable
        name = re.sub(r"([^.\[\]]{5})[^.\[\]]{4,}([^.\[\]]{4})", r"\1…\2", name)
    return name if len(faults) == 1 else f"{name} +{len(faults) - 1}"


def _cell(kind: str, column: int, row: int) -> str:
    x, y = column * _CELL, row * _CELL
    inner = _CELL - 3
    match kind:
        case "always":
            return (
                f'<rect class="on" x="{x + 1.5}" y="{y + 1.5}" width="{inner}" height="{inner}"/>'
            )
        case "signature":
            half = f"M{x + 1.5},{y + 1.5} h{inner} l-{inner},{inner} z"
            frame = f"M{x + 2},{y + 2} h{inner - 1} v{inner - 1} h-{inner - 1} z"
            return f'<path class="on" d="{half}"/><path class="edge" d="{frame}"/>'
        case "silence":
            return f'<circle class="dot" cx="{x + _CELL / 2}" cy="{y + _CELL / 2}" r="1.4"/>'
        case _:
            return ""


def _picture(labels: list[str], cells: list[str]) -> str:
    room = max(width(text, _TEXT) for text in labels) + 8
    side = _CELL * len(labels)
    total = room + side + 4
    names = []
    for at, text in enumerate(labels):
        middle = room + at * _CELL + _CELL / 2
        names.append(
            f'<text x="{room - 5:g}" y="{middle + 3.5:g}" text-anchor="end">{escape(text)}</text>'
            f'<text transform="translate({middle + 3.5:g} {room - 5:g}) rotate(-90)">'
            f"{escape(text)}</text>"
        )
    return "\n".join(
        [
            f'<svg class="isolability" width="{total:g}" height="{total:g}"'
            f' viewBox="0 0 {total:g} {total:g}" role="img" font-size="{_TEXT:g}">',
            "<title>Isolability matrix</title>",
            "<desc>Row: the fault that is there. Column: what it could be taken for."
            " The same is said in words above.</desc>",
            *names,
            f'<g transform="translate({room:g} {room:g})">',
            f'<rect class="edge" width="{side:g}" height="{side:g}"/>',
            *[cell for cell in cells if cell],
            "</g>",
            "</svg>",
        ]
    )
