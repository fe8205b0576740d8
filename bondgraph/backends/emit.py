"""A residual program as files, in every language asked for."""

from __future__ import annotations

from bondgraph.backends import c, python
from bondgraph.backends.facts import facts
from bondgraph.backends.golden import golden
from bondgraph.backends.readme import readme
from bondgraph.backends.target import load
from bondgraph.backends.templates import fill
from bondgraph.ir.artifact import Artifact
from bondgraph.ir.program import Program

_HOLES = {"c": c.holes, "python": python.holes}
_EXAMPLES = {"c": "example.c", "python": "example.py"}


def emit(program: Program, targets: tuple[str, ...]) -> tuple[Artifact, ...]:
    """The files of `program` in the `targets` (`c`, `python`), and a README about them.

    The same program gives the same bytes. Raises ValueError for a target that is not there.
    """
    about = facts(program)
    vectors = golden(program)
    found: dict[str, str] = {}
    for name in dict.fromkeys(targets):
        target = load(name)
        holes = _HOLES[name](program, target, about, vectors)
        for template, path in target.files:
            found[path.format(stem=about.stem)] = fill(template, holes)
    examples = {name: found[_EXAMPLES[name]] for name in dict.fromkeys(targets)}
    found["README.md"] = fill("README.md.j2", readme(program, about, examples))
    return tuple(Artifact(path, text) for path, text in found.items())
