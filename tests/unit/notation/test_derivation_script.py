"""Scripts of derivations: they run, say what was derived, and notice what is not so."""

from __future__ import annotations

import json
from typing import Any

import pytest

import bondgraph
from bondgraph.notation.derivation_script import Cell, cells, notebook, script
from bondgraph.text.source import Source

_MODELS = {
    "a motor": """bg 1
model M { param L = 3; param R = 2; param k = 5; param J = 7; param b = 4
  1:el { <- Se:U; -> I:L; -> R:R; -> GY:k -> 1:rotor }
  rotor { -> I:J; -> R:b; -> Df:w } }""",
    "a tank": """bg 1
model M { param C = 2; param k = 3
  0:t { <- Sf:Q; -> C:C; -> R:v { f = k*ssqrt(e) }; -> De:h } }""",
    "a switch": """bg 1
model M { param R = 2; param C = 3; input on : bool
  1:s when on { <- Se:u; -> R:R; -> 0:n; -> Df:i }
  n { -> C:C; -> De:y } }""",
}


#: The relations as one writes them by hand, in the names of the scripts.
_BY_HAND = {
    "a motor": "U - k*w - R*(b*w + J*D(w))/k - L*D((b*w + J*D(w))/k)",
    "a tank": "Q - C*D(h) - k*ssqrt(h)",
    "a switch": "sp.Piecewise((u - R*i - y, on), (i, True))",
}


def _cells(name: str) -> list[Cell]:
    """The cells of the derivations of the first residual."""
    text = _MODELS[name]
    return cells(list(bondgraph.compile(text=text).derivation("r1")), "M", Source("m.bg", text))


def _run(code: str) -> dict[str, Any]:
    """What a script has defined at its end; it asserts its own result."""
    known: dict[str, Any] = {}
    exec(compile(code, "derivation", "exec"), known)
    return known


@pytest.mark.parametrize("name", _MODELS)
def test_a_script_runs_and_ends_with_the_relation_that_one_writes_by_hand(name: str) -> None:
    known = _run(script(_cells(name)))
    sp = known["sp"]
    by_hand = eval(_BY_HAND[name], known)
    ratio = sp.simplify((known["relation"] / by_hand).doit())
    assert ratio in (1, -1), ratio


def test_a_script_of_another_relation_fails() -> None:
    code = script(_cells("a motor"))
    assert code.count("\nr1 = ") == 1
    with pytest.raises(AssertionError):
        _run(code.replace("\nr1 = ", "\nr1 = w + "))


def test_the_names_of_a_model_stand_below_what_they_are() -> None:
    code = "\n".join(cell.text for cell in _cells("a motor") if cell.kind == "code")
    below: dict[str, set[str]] = {}
    for line in code.splitlines():
        if line.startswith("# "):
            names = below.setdefault(line[2:], set())
        elif not line:
            names = set()
        elif below:
            names.add(line.partition(" = ")[0])
    assert below["parameters and initial values"] == {"L", "R", "k", "J", "b"}
    assert below["commands and measurements"] == {"U", "w"}
    assert {"el__f", "rotor__f", "U__e", "J__p"} <= below["unknowns"]


def test_a_notebook_has_the_cells_of_every_derivation_in_turn() -> None:
    text = _MODELS["a motor"]
    (one,) = bondgraph.compile(text=text).derivation("r1")
    alone = cells([one], "M", Source("m.bg", text))
    assert cells([one, one], "M", Source("m.bg", text)) == alone + alone
    written = json.loads(notebook(alone))
    assert [cell["cell_type"] for cell in written["cells"]] == [cell.kind for cell in alone]
    assert ["".join(cell["source"]) for cell in written["cells"]] == [c.text for c in alone]
