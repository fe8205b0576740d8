"""The structure of models, equation by equation, as one reads it off their laws."""

from __future__ import annotations

from bondgraph.passes.analysis.extract import extract
from tests.unit.passes.circuits import MOTOR, RC, compiled


def _table(text: str) -> dict[str, tuple[dict[str, str], set[str], set[str]]]:
    """The marked unknowns, the known signals and the faults of each equation."""
    model = extract(compiled(text).equations)
    found: dict[str, tuple[dict[str, str], set[str], set[str]]] = {}
    for e in model.equations:
        name = e.name + "'" * (e.name in found)  # a gyrator has two laws
        marks = {model.unknowns[v]: m for v, m in zip(e.unknowns, e.marks, strict=True)}
        own = {model.knowns[k] for k in e.knowns}, {model.faults[f] for f in e.faults}
        found[name] = marks, *own
    return found


def _plain(*names: str) -> dict[str, str]:
    return dict.fromkeys(names, "")


def test_a_circuit_has_its_laws_balances_and_readings() -> None:
    assert _table(RC) == {
        "balance s": (_plain("u.e", "R.e", "n.e"), set(), set()),
        "law u": (_plain("u.e"), {"u"}, {"u"}),
        "law R": (_plain("s.f", "R.e"), set(), {"R"}),
        "balance n": (_plain("s.f", "C.f"), set(), set()),
        "law C": (_plain("n.e", "C.q"), set(), set()),  # 3 is no parameter
        "state C": ({"C.f": "D", "C.q": "I"}, set(), set()),
        "sensor i": (_plain("s.f"), {"i"}, {"i"}),
        "sensor y": (_plain("n.e"), {"y"}, {"y"}),
    }


def test_a_gyrator_has_two_laws_with_the_same_fault() -> None:
    found = _table(MOTOR)
    assert found["law k"] == (_plain("k.e1", "rotor.f"), set(), {"k"})
    assert found["law k'"] == (_plain("el.f", "k.e2"), set(), {"k"})
    assert found["state J"] == ({"J.e": "D", "J.p": "I"}, set(), set())
    assert len(found) == 12


def test_a_law_that_gets_a_reading_holds_the_signal_without_its_fault() -> None:
    """The controller of a valve: what is wrong with the reading acts on the number it got."""
    text = RC.replace("-> R:R;", "-> R:R { e = f*R*(1 + y^2) };")
    found = _table(text)
    assert found["law R"] == (_plain("s.f", "R.e"), {"y"}, {"R"})
    assert found["sensor y"] == (_plain("n.e"), {"y"}, {"y"})
