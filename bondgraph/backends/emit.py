"""A residual program as files, in every language asked for."""

from __future__ import annotations

from bondgraph.backends import c, python
from bondgraph.backends.facts import facts
from bondgraph.backends.target import load
from bondgraph.backends.templates import fill
from bondgraph.ir.artifact import Artifact
from bondgraph.ir.program import Program

_HOLES = {"c": c.holes, "python": python.holes}


def emit(program: Program, targets: tuple[str, ...]) -> tuple[Artifact, ...]:
    """The files of `program` in the `targets` (`c`, `python`), and a README about them.

    The same program gives the same bytes. Raises ValueError for a target that is not there.
    """
    about = facts(program)
    found: list[Artifact] = []
    for name in targets:
        target = load(name)
        holes = _HOLES[name](program, target, about)
        for template, path in target.files:
            if template.split("/")[1] in ("residuals.h.j2", "residuals.c.j2", "residuals.py.j2"):
                found.append(Artifact(path.format(stem=about.stem), fill(template, holes)))
    return tuple(found)
