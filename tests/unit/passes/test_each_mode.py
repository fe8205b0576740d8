"""Plants that no one order of elimination serves: every mode by itself, and what stays refused."""

from __future__ import annotations

import pytest

from bondgraph.compilation import Compilation
from bondgraph.ir.expr import Op, topological
from bondgraph.notation.line import show
from bondgraph.text.diagnostic import CompileError
from bondgraph.text.source import Source

CONVERTER = """
1:tr when {0} {{ <- Se:E; -> x }}
1:fw when {1} {{ <- Se:gnd = 0; -> x }}
0:x -> 1:coil
coil {{ -> I:L = 0.3; -> R:r = 0.5; -> Df:i }}
"""


INPUTS = "".join(f"input m{k} : bool\n" for k in range(6))
SEVEN = "on and m0 and m1 and m2 and m3 and m4 and m5"


def compiled(text: str) -> Compilation:
    """A model around some statements."""
    return Compilation(Source("m.bg", f"bg 1\nmodel M {{\ninput on : bool\n{text}\n}}\n"))


def shown(model: Compilation) -> list[str]:
    """The relations."""
    return [show(r.residual.expr) for r in model.residuals]


def test_what_the_modes_share_stays_outside_the_choice() -> None:
    """Kirchhoff: E or nothing, less R i and L di/dt in either mode."""
    (relation,) = shown(compiled(CONVERTER.format("on", "not on")))
    assert relation.count("D(") == 1
    assert "if(on, E, 0)" in relation


def test_the_path_to_a_relation_has_a_choice_where_the_modes_part() -> None:
    (relation,) = compiled(CONVERTER.format("on", "not on")).residuals.residual_set.residuals
    steps = {show(s.variable): (show(s.value), show(s.closed)) for s in relation.steps}
    assert steps["coil.f"] == ("i", "i")
    assert steps["r.e"] == ("coil.f/2", "i/2")
    assert steps["L.e"] == ("D(L.p)", "0.3*D(i)")
    # the transistor lays the source on the node, the diode the ground
    assert steps["x.e"] == ("if(on, E.e, gnd.e)", "if(on, E, 0)")


def test_a_mode_without_current_has_a_relation_of_its_own() -> None:
    """Both switches open: the coil carries nothing. Both closed: there is no such machine."""
    model = compiled("input d : bool\n" + CONVERTER.format("on", "d"))
    (relation,) = model.residuals.residual_set.residuals
    choices = [n for n in topological([relation.expr]) if n.op is Op.IF]
    assert {show(c.args[0]) for c in choices} == {"on", "d"}
    inner = next(c for c in choices if show(c.args[0]) == "d")
    assert show(inner.args[2]) in ("i", "-i")
    none = [m for m in model.mode_signatures.modes if m.matrix is None]
    assert [m.modes for m in none] == [{"on": True, "d": True}]


@pytest.mark.parametrize(
    "text",
    [
        # seven modes are more than are looked at
        INPUTS + CONVERTER.format(SEVEN, f"not ({SEVEN})"),
        # the charge that flowed while the switch was closed: no mode knows what others added
        CONVERTER.format("on", "not on") + "sensor q = int(tr.f)^4",
    ],
)
def test_what_no_mode_by_itself_decides_is_refused(text: str) -> None:
    model = compiled(text)
    with pytest.raises(CompileError):
        _ = model.reduced
    wrong = [d.code for d in model.report.diagnostics if d.severity == "error"]
    assert wrong == ["loop-unsolvable"]
