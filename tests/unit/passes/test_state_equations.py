"""State equations of laws in which equal parts occur again and again."""

from __future__ import annotations

from bondgraph.compilation import Compilation
from bondgraph.text.source import Source


def test_a_law_of_many_paths_is_gone_through_once() -> None:
    # each `let` has the one before twice: 2^40 ways lead from the law to the flow
    lets = "\n".join(f"let a{k} = sin(a{k - 1}) + cos(a{k - 1})" for k in range(1, 41))
    text = (
        "bg 1\nmodel M {\n1:s { <- Se:u; -> I:l = 1; -> R:r { e = a40*f } }\n"
        f"let a0 = s.f\n{lets}\ns -> Df:y\n}}\n"
    )
    found = Compilation(Source("m.bg", text)).state_equations()
    assert len(found.states) == 1
