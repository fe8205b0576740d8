"""A drawing as TikZ: a picture for LaTeX, with its text as text and its colours by name."""

from __future__ import annotations

from bondgraph.backends.drawing.canvas import Point
from bondgraph.backends.drawing.shapes import Area, Stroke, Words, shapes
from bondgraph.backends.drawing.style import palette

#: Of a px in pt: CSS has 96 px an inch, TeX 72.27 pt.
_PT = 0.75
_SPECIAL = {
    "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "$": r"\$", "&": r"\&", "#": r"\#",
    "%": r"\%", "_": r"\_", "^": r"\textasciicircum{}", "~": r"\textasciitilde{}",
    "·": r"\(\cdot\)", "−": r"\(-\)", "…": r"\dots{}", "Ω": r"\(\Omega\)",
    **{c: rf"\(^{{{d}}}\)" for c, d in zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-", strict=True)},
}  # fmt: skip


def tikz(svg: str) -> str:
    r"""A `tikzpicture` of the drawing; needs `\usepackage{tikz}` and nothing else.

    One unit is a px of the drawing, 0.75 pt; `scale` and font size are at its head.
    """
    size, found = shapes(svg)
    names = {colour: f"bg{name}" for name, colour in palette().items()}
    lines = [
        "% A bond graph by bondgraph; \\usepackage{tikz} before \\begin{document}.",
        *[f"\\definecolor{{{n}}}{{HTML}}{{{c[1:].upper()}}}" for c, n in names.items()],
        f"\\begin{{tikzpicture}}[x={_PT}pt, y=-{_PT}pt, line cap=butt, line join=round,"
        " every node/.style={inner sep=0pt, outer sep=0pt, anchor=base, font=\\sffamily}]",
        f"\\path[use as bounding box] (0,0) rectangle {_at(size)};",
    ]
    for shape in found:
        if isinstance(shape, Stroke):
            lines.append(_stroke(shape, names))
        elif isinstance(shape, Area):
            if shape.fill != palette()["paper"] or shape.edge:
                lines.append(_area(shape, names))
        else:
            lines.append(_words(shape, names))
    return "\n".join([*lines, "\\end{tikzpicture}"]) + "\n"


def _at(p: Point) -> str:
    return f"({p[0]:.1f},{p[1]:.1f})"


def _look(colour: str, width: float, dash: tuple[float, ...], names: dict[str, str]) -> list[str]:
    found = [f"draw={names[colour]}", f"line width={_PT * width:.2f}pt"]
    if dash:
        found.append(f"dash pattern=on {_PT * dash[0]:.2f}pt off {_PT * dash[1]:.2f}pt")
    return found


def _stroke(shape: Stroke, names: dict[str, str]) -> str:
    way = ""
    points = shape.points
    for k, p in enumerate(points):
        if k in shape.breaks:
            way += f" {_at(p)}"
        elif k in shape.curves:  # a quadratic as the cubic that it is
            a, b = points[k - 1], points[k + 1]
            one = (a[0] + 2 * (p[0] - a[0]) / 3, a[1] + 2 * (p[1] - a[1]) / 3)
            two = (b[0] + 2 * (p[0] - b[0]) / 3, b[1] + 2 * (p[1] - b[1]) / 3)
            way += f" .. controls {_at(one)} and {_at(two)} .. {_at(b)}"
        elif k - 1 not in shape.curves:
            way += f" -- {_at(p)}"
    return f"\\path[{', '.join(_look(shape.colour, shape.width, shape.dash, names))}]{way};"


def _area(shape: Area, names: dict[str, str]) -> str:
    look = _look(shape.edge, shape.width, shape.dash, names) if shape.edge else []
    look += [f"fill={names[shape.fill]}"] if shape.fill else []
    if shape.radius:
        look.append(f"rounded corners={_PT * shape.radius:.1f}pt")
    return f"\\path[{', '.join(look)}] {' -- '.join(map(_at, shape.points))} -- cycle;"


def _words(shape: Words, names: dict[str, str]) -> str:
    text = "".join(
        f"\\textcolor{{{names[p.colour]}}}{{{_bold(_escaped(p.text), p.bold)}}}"
        for p in shape.pieces
    )
    size = f"\\fontsize{{{_PT * shape.size:.2f}}}{{{_PT * shape.size * 1.2:.2f}}}\\selectfont"
    slant = "\\itshape" if shape.italic else ""
    anchor = "" if shape.middle else "[anchor=base west]"
    return f"\\node{anchor} at {_at(shape.at)} {{{size}{slant} {text}}};"


def _bold(text: str, bold: bool) -> str:
    return f"\\textbf{{{text}}}" if bold else text


def _escaped(text: str) -> str:
    return "".join(_SPECIAL.get(c, c) for c in text)
