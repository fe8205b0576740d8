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
    "a spring whose twist is counted from the start": """bg 1
model M { param m = 2; param k = 3
  1:v { <- Se:F; -> I:m; -> C:s(q0 = 0) { e = k*sin(q) }; -> Df:y } }""",
    "a spring that begins anywhere": """bg 1
model M { param m = 2; param k = 3; 1:v { <- Se:F; -> I:m; -> C:s { e = k*q }; -> Df:y } }""",
    "a leak that answers late": """bg 1
model M { param C = 2; param k = 3
  0:t { <- Sf:Q; -> C:C; -> R:v { f = k*delay(h, 0.5) }; -> De:h } }""",
    "a bridge": """bg 1
model M { param R1 = 2; param R2 = 3; param R3 = 5; param R4 = 7; param R5 = 11
  1:s { <- Se:U; -> 0:t; -> Df:i }
  t -> 1:a -> 0:p; a -> R:R1; t -> 1:b -> 0:q; b -> R:R2
  p -> 1:c -> q; c -> R:R3; p -> R:R4; q -> R:R5 }""",
    "a constant that is called as the time": """bg 1
model M { param t = 2; param R = 3; param l = 5
  1:a { <- Se:U; -> R:R { e = R*f + t }; -> I:l; -> Df:i } }""",
}


#: The relations as one writes them by hand, in the names of the scripts.
_BY_HAND = {
    "a motor": "U - k*w - R*(b*w + J*D(w))/k - L*D((b*w + J*D(w))/k)",
    "a tank": "Q - C*D(h) - k*ssqrt(h)",
    "a switch": "sp.Piecewise((u - R*i - y, on), (i, True))",
    "a spring whose twist is counted from the start": "F - m*D(y) - k*sp.sin(Int(y))",
    "a spring that begins anywhere": "(D(F) - m*D(y, 2))/k - y",
    "a leak that answers late": "Q - C*D(h) - k*h.subs(t, t - sp.Rational(1, 2))",
    # the voltages of p and q by Cramer's rule, times what all resistances have in common
    "a bridge": "(i - U*(1/R1 + 1/R2))*((1/R1 + 1/R3 + 1/R4)*(1/R2 + 1/R3 + 1/R5) - R3**-2)"
    " + U*((1/R1 + 1/R3 + 1/R4)/R2**2 + (1/R2 + 1/R3 + 1/R5)/R1**2 + 2/(R1*R2*R3))",
    "a constant that is called as the time": "U - l*D(i) - R*i - t_",
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
    ratio = sp.simplify((known["relation"] / by_hand).doit(integrals=False))
    if name == "a bridge":  # a relation of constants holds with any constant before it
        assert not ratio.has(known["t"])
    else:
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


def test_what_only_iteration_finds_is_a_signal_of_its_own() -> None:
    """Two leaks whose flows no formula gives: one of them has to be turned around."""
    text = """bg 1
model M { param C = 2
  0:n { <- Sf:Q; -> C:C; -> R:r { e = f + sinh(f) }; -> R:s { e = 2*f + f^5 }; -> De:y } }"""
    derivation = bondgraph.compile(text=text).derivation("r1")
    assert "iterate" in [step.move for step in derivation[0].steps]
    found = cells(list(derivation), "M", Source("m.bg", text))
    code = next(cell.text for cell in found if cell.kind == "code")
    unknowns = code.partition("# unknowns\n")[2].partition("\n\n")[0].splitlines()
    assert len(unknowns) == len(set(unknowns))
    known = _run(script(found))
    kept = {line.partition(" = ")[0] for line in unknowns if " = " in line}
    others = {known[name] for name in kept} - set(known["known"])
    roots = [other for other in others if known["relation"].has(other)]
    assert roots  # what was found by iteration stands in the relation as itself
    for above in ("# commands and measurements", "# parameters and initial values"):
        names = code.partition(f"{above}\n")[2].partition("#")[0]
        assert not any(f"{root.func.__name__} = " in names for root in roots)


def test_a_script_shows_nothing_below_its_cells() -> None:
    """A notebook does: the last line of a cell that is a name, or one of those that are known."""

    def written(text: str) -> str:
        return script([Cell("code", text)])

    assert written("a = 1\na") == "# %%\na = 1\n"
    assert written("known[x] = 1\nknown[x]") == "# %%\nknown[x] = 1\n"
    assert written("a = 1\nprint(a)") == "# %%\na = 1\nprint(a)\n"
    assert written("a") == "# %%\na\n"
    both = [Cell("markdown", "# One\n\ntwo"), Cell("code", "a = 1\nb = 2\nb")]
    assert script(both) == "# %% [markdown]\n# # One\n#\n# two\n\n# %%\na = 1\nb = 2\n"


def test_a_notebook_is_one_that_has_not_been_run() -> None:
    written = json.loads(notebook([Cell("markdown", "one\ntwo"), Cell("code", "a = 1")]))
    assert written["cells"] == [
        {"cell_type": "markdown", "id": "step-1", "metadata": {}, "source": ["one\n", "two"]},
        {"cell_type": "code", "id": "step-2", "metadata": {}, "execution_count": None,
         "outputs": [], "source": ["a = 1"]},
    ]  # fmt: skip
    assert (written["nbformat"], written["nbformat_minor"]) == (4, 5)
