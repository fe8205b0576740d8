"""What each stage promises, as checks that run after each pass.

A check is a generator that is given a stage and yields a line for each place where the promise is
broken; its docstring is the promise. The product does not pay for them: tests run them over every
model (`test_promises`), and each one is shown to find a value that was broken on purpose
(`test_broken`). A developer asks `broken("ReducedSystem", compilation.reduced)`.
"""

from __future__ import annotations

from collections.abc import Callable

from bondgraph.compilation import Compilation
from bondgraph.text.diagnostic import CompileError
from tests.promises import elimination, graphs, programs
from tests.promises.check import CHECKS

ROOMS = (graphs, elimination, programs)  # each enters its checks

#: What is checked of a compilation, in its order.
_STAGES: dict[str, tuple[str, Callable[[Compilation], object]]] = {
    "graph": ("BondGraph", lambda c: c.graph),
    "integral": ("CausalGraph", lambda c: c.integral),
    "derivative": ("CausalGraph", lambda c: c.derivative),
    "equations": ("EquationSystem", lambda c: c.equations),
    "reduced": ("ReducedSystem", lambda c: c.reduced),
    "residuals": ("ResidualSet", lambda c: c.residuals.residual_set),
    "signatures": ("Analysis", lambda c: (c.residuals.residual_set, c.signatures)),
    "program": ("Program", lambda c: c.program),
    "thresholds": ("Program", lambda c: c.thresholds),
}


def broken(stage: str, value: object) -> list[str]:
    """The promises that the value of a stage breaks, each with the place."""
    return [f"{check.__name__}: {line}" for check in CHECKS[stage] for line in check(value)]


def broken_stages(compilation: Compilation) -> dict[str, list[str]]:
    """What each stage breaks, as far as the model gets: a refusal is an answer too."""
    found: dict[str, list[str]] = {}
    for name, (stage, value_of) in _STAGES.items():
        try:
            value = value_of(compilation)
        except CompileError:
            break
        found[name] = [] if value is None else broken(stage, value)
    return found

