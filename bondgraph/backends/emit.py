"""A residual program as files, in every language asked for."""

from __future__ import annotations

from bondgraph.backends import c, python
from bondgraph.backends.decision import UNTUNED, Tuned
from bondgraph.backends.facts import Facts, facts
from bondgraph.backends.golden import golden
from bondgraph.backends.readme import readme
from bondgraph.backends.target import load
from bondgraph.backends.templates import fill
from bondgraph.ir.artifact import Artifact
from bondgraph.ir.program import Program

_HOLES = {"c": c.holes, "python": python.holes}
_EXAMPLES = {"c": "example.c", "python": "example.py"}


#: Where the thresholds go, and what only the residuals have.
_THRESHOLD, _ONCE = "threshold", ("example.c", "example.py")


def emit(
    program: Program,
    targets: tuple[str, ...],
    thresholds: Program | None = None,
    tuned: Tuned = UNTUNED,
) -> tuple[Artifact, ...]:
    """The files of `program` in the `targets` (`c`, `python`), and a README about them.

    The files of `thresholds` go to a folder of their own. Limits that were `tuned` go with
    `diagnose`. The same program gives the same bytes.
    Raises ValueError for a target that is not there.
    """
    about = facts(program)
    found = _files(program, targets, about, thresholds is not None, tuned)
    examples = {name: found[_EXAMPLES[name]] for name in dict.fromkeys(targets)}
    found["README.md"] = fill("README.md.j2", readme(program, about, examples, thresholds))
    if thresholds is not None:
        bounds = _files(thresholds, targets, facts(thresholds), False)
        found |= {f"{_THRESHOLD}/{path}": text for path, text in bounds.items()}
    return tuple(Artifact(path, text) for path, text in found.items())


def _files(
    program: Program,
    targets: tuple[str, ...],
    about: Facts,
    bounded: bool,
    tuned: Tuned = UNTUNED,
) -> dict[str, str]:
    """The code of a program in all languages; `bounded` says that thresholds go beside it."""
    vectors = golden(program)
    found: dict[str, str] = {}
    for name in dict.fromkeys(targets):
        target = load(name)
        holes = _HOLES[name](program, target, about, vectors, tuned) | {"bounded": bounded}
        for template, path in target.files:
            if not (program.bounds and path in _ONCE):
                found[path.format(file=about.file)] = fill(template, holes)
    return found
