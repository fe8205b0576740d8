"""What is said of dependent storages and of loops, word by word."""

from __future__ import annotations

import pytest

from bondgraph.compilation import Compilation
from bondgraph.text.diagnostic import Diagnostic
from bondgraph.text.source import Source


def _told(text: str, code: str) -> list[Diagnostic]:
    model = Compilation(Source("m.bg", f"bg 1\n{text}\n"))
    _ = model.integral
    return [d for d in model.report.diagnostics if d.code == code]


def _model(text: str) -> str:
    return f"model M {{\n{text}\n}}"


@pytest.mark.parametrize(
    ("text", "message", "labels"),
    [
        (
            "1:v { <- Se:F; -> I:m; -> TF:n { f1 = 4*f2 } -> 1:w }\nw -> I:M\nw -> Df:y",
            "I:M is in derivative causality: its flow is fixed by I:m, which has the state.",
            ["takes its flow from the others", "holds the state"],
        ),
        (
            "0:n { <- Se:u; -> C:c; -> R:r; -> De:y }",
            "C:c is in derivative causality: its effort is imposed by Se:u.",
            ["takes its effort from the others", "imposes it"],
        ),
        (
            "Sf:i -> 0:a -> C:ca\nSf:j -> 0:b -> C:cb\na -> 1:s\nb -> s\ns -> 0:d -> C:cd\n"
            "d -> De:y",
            "C:cd is in derivative causality: its effort is fixed by C:ca and C:cb, which have the "
            "state.",
            ["takes its effort from the others", "holds the state", "holds the state"],
        ),
    ],
)
def test_a_dependent_storage_is_told_with_what_it_depends_on(
    text: str, message: str, labels: list[str]
) -> None:
    names = "".join(f"param {n} = 2\n" for n in ("m", "M", "c", "ca", "cb", "cd", "r"))
    (found,) = _told(_model(names + text), "dependent-storage")
    assert found.message == message and found.severity == "info"
    assert [label.text for label in found.labels] == labels
    own = "the storage has no state of its own" if "imposed" in message else "share their states"
    assert own in str(found.help)


_CELL = """model Cell { param C = 2; param r = 1
0:n { <- Se:u; -> C:C; -> R:r } }
"""


@pytest.mark.parametrize(
    ("count", "more"), [(1, ""), (2, "; so is 1 more like it"), (4, "; so are 3 more like it")]
)
def test_storages_of_like_instances_are_counted(count: int, more: str) -> None:
    text = f"{_CELL}model M {{\nCell:cell[{count}]\nsensor y = cell[1].n.e\n}}"
    (found,) = _told(text, "dependent-storage")
    assert found.message == (
        "C:cell[1].C is in derivative causality: its effort is imposed by Se:cell[1].u" + more + "."
    )


_LOOP = """model Loop { port p : in electrical; param r = 1; param s = 2
1:n { <- p; -> R:r; -> R:s } }
"""


@pytest.mark.parametrize(
    ("count", "more"), [(1, ""), (2, "; so does 1 more like it"), (4, "; so do 3 more like it")]
)
def test_loops_of_like_instances_are_counted(count: int, more: str) -> None:
    bonds = "\n".join(f"Se:u{k} -> loop[{k}].p" for k in range(1, count + 1))
    text = f"{_LOOP}model M {{\nLoop:loop[{count}]\n{bonds}\nsensor y = loop[1].n.f\n}}"
    (found,) = _told(text, "algebraic-loop")
    assert found.message == (
        "R:loop[1].r and R:loop[1].s form an algebraic loop: each needs what the other answers, "
        f"without delay{more}."
    )
    assert [label.text for label in found.labels] == ["in the loop", "in the loop"]


def test_a_loop_without_a_resistance_is_that_of_its_junctions() -> None:
    found = _told(_model("0:a -> TF:t { e1 = 2*e2 } -> 0:b; a -> b; a -> R:r = 1; b -> De:y"),
                  "algebraic-loop")  # fmt: skip
    assert found and all(
        d.message.startswith("0:a, TF:t and 0:b form a closed loop without delay") for d in found
    )
