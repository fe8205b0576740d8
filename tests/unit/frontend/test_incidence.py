"""Incidence tables: what they say, and what is said about those that are wrong."""

from __future__ import annotations

import pytest

from bondgraph.frontend.incidence import read_table
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source

TANK = """\
# a tank
equation, x:h, x:dh, x:q, z:y, f:leak

valve,    1,   ,     x,   ,    .
tank,     0,   1,    1,   ,    1
der,      I,   D
sensor,   1,   ,     ,    1
"""


def test_a_table_says_what_occurs_where() -> None:
    report = Report()
    model = read_table(Source("plant/tank.csv", TANK), report)
    assert model is not None
    assert (model.name, model.unknowns, model.knowns) == ("tank", ("h", "dh", "q"), ("y",))
    assert model.faults == ("leak",)
    assert [e.name for e in model.equations] == ["valve", "tank", "der", "sensor"]
    assert [e.unknowns for e in model.equations] == [(0, 2), (1, 2), (0, 1), (0,)]
    assert model.equations[2].marks == ("I", "D")
    assert model.equations[2].states == (0,)
    assert [e.knowns for e in model.equations] == [(), (), (), (0,)]
    assert model.holders(0) == (1,)
    assert str(model.equations[3].origin) == "plant/tank.csv:7:1"


@pytest.mark.parametrize("separator", ["\t", ";", " , "])
def test_separators(separator: str) -> None:
    text = TANK.replace(",", separator)
    one = read_table(Source("tank.csv", TANK), Report())
    other = read_table(Source("tank.csv", text), Report())
    assert one is not None and other is not None
    assert [e[:5] for e in one.equations] == [e[:5] for e in other.equations]


def test_quotation_marks_of_a_spreadsheet() -> None:
    model = read_table(Source("t.csv", '"e","x:a","z:y"\n"s","1","1"\n'), Report())
    assert model is not None
    assert model.unknowns == ("a",) and model.equations[0].name == "s"


@pytest.mark.parametrize(
    ("text", "code", "place"),
    [
        ("", "table-empty", ""),
        ("# only words\n", "table-empty", ""),
        ("e,x:a\n", "table-empty", "e,x:a"),
        ("e\ns\n", "table-column", "e"),
        ("e,a\ns,1\n", "table-column", "a"),
        ("e,y:a\ns,1\n", "table-column", "y:a"),
        ("e,x:\ns,1\n", "table-column", "x:"),
        ("e,x:a,x:a\ns,1\n", "duplicate-name", "x:a"),
        ("e,x:a\ns,1\ns,1\n", "duplicate-name", "s"),
        ("e,x:a\ns,1,1\n", "table-row", "1"),
        ("e,x:a\ns,2\n", "table-mark", "2"),
        ("e,x:a,z:y\ns,1,D\n", "table-mark", "D"),
        ("e,x:a,f:g\ns,1,I\n", "table-mark", "I"),
        ("e,x:a\ns,D\n", "table-mark", "D"),
    ],
)
def test_wrong_tables(text: str, code: str, place: str) -> None:
    report = Report()
    assert read_table(Source("t.csv", text), report) is None
    found = report.diagnostics
    assert [d.code for d in found] == [code]
    assert found[0].labels[0].span.text == place
    assert found[0].help


def test_every_fault_is_reported_at_once() -> None:
    report = Report()
    read_table(Source("t.csv", "e,a,x:b\ns,1,?\nt,1,1,1\n"), report)
    assert [d.code for d in report.diagnostics] == ["table-column", "table-mark", "table-row"]
