"""One relation that cannot be had does not cost the others, and the count still agrees."""

from __future__ import annotations

import pytest

from bondgraph.compilation import Compilation
from bondgraph.ir.residuals import ResidualSet
from bondgraph.passes.elimination import chaining as chain
from bondgraph.passes.elimination.shortfall import stop_without_any
from bondgraph.structural.rank import relations
from bondgraph.text.diagnostic import CompileError, Report
from tests.unit.passes.relations import compiled

#: A swing whose angle at the start is not declared.
SWING = "1:v { <- Se:F; -> I:m = 2; -> C:pend { e = q + 2*sin(q) }; -> Df:y }"
#: The voltage of node n, which is not measured, has several values.
WAVE = """1:s { <- Se:U; -> R:R = 2; -> n }
        0:n { -> R:wave { f = e + 3*sin(e) }; -> b; -> c }
        1:b { -> R:Rb = 1; -> C:Cb = 1; -> Df:i }
        1:c { -> R:Rc = 3; -> C:Cc = 2; -> Df:j }"""
#: A coil and a tank, each with a relation of its own.
COIL = "1:a { <- Se:V; -> R:Ra = 2; -> I:La = 1; -> Df:ia }"
TANK = "0:t { <- Sf:Q; -> C:A = 2; -> R:out { f = ssqrt(e) }; -> De:p }"
UNKNOWN = "input d unknown; 1:u { <- Se:D = d; -> R:Ru = 2; -> Df:iu }"

#: Body of a model; sensors less the rank of the unknown inputs, by hand; how many are found; for
#: each missing one what it is about, the code and the elements.
CASES = {
    "a swing beside two other parts": (
        f"{SWING}\n{COIL}\n{TANK}",
        3,
        2,
        [("v", "initial-value-needed", {"pend"})],
    ),
    "two swings and a coil": (
        f"{SWING}\n{SWING.replace('v', 'w').replace('F', 'G').replace(':y', ':z')}\n{COIL}".replace(
            "I:m = 2; -> C:pend { e = q + 2*sin(q) }; -> Df:z",
            "I:m2 = 2; -> C:pend2 { e = q + 2*sin(q) }; -> Df:z",
        ),
        3,
        1,
        [("v", "initial-value-needed", {"pend"}), ("w", "initial-value-needed", {"pend2"})],
    ),
    "a loop of several solutions, and what two branches of it say of each other": (
        WAVE,
        2,
        1,
        [("*", "*", {"wave"})],
    ),
    "such a loop beside a coil": (
        f"{WAVE}\n{COIL}",
        3,
        2,
        [("*", "*", {"wave"})],
    ),
    "an unknown input takes up a sensor of its own": (
        f"{SWING}\n{UNKNOWN}\n{TANK}",
        2,
        1,
        [("v", "initial-value-needed", {"pend"})],
    ),
    "a swing that shares a node with what can be told": (
        """1:v { <- Se:F; -> I:m = 2; -> C:pend { e = q + 2*sin(q) }; -> Df:y; -> n }
        0:n { -> R:leak = 2; -> C:k = 1; -> De:e1 }
        sensor y3 = 2*leak.f""",
        3,
        2,
        [("v", "initial-value-needed", {"pend"})],
    ),
}


def model(body: str) -> Compilation:
    return compiled(f"model M {{\n{body}\n}}")


@pytest.mark.parametrize("case", CASES)
def test_what_can_be_had_is_had(case: str) -> None:
    body, expected, found, missing = CASES[case]
    c = model(body)
    told = c.residuals.missing
    assert len(c.residuals) == found
    assert len(c.residuals) + len(told) == expected == relations(c.equations)
    assert len(told) == len(missing)
    for own, (about, code, elements) in zip(told, missing, strict=True):
        assert about in ("*", own.about.name)
        assert code in ("*", own.finding.code)
        assert elements <= set(own.elements)
    assert c.verification.method.startswith("exact")
    errors = [d for d in c.report.diagnostics if d.severity == "error"]
    warned = [d.code for d in c.report.diagnostics if d.severity == "warning"]
    assert not errors
    assert warned == [m.finding.code for m in told]
    assert c.program.residuals


def test_two_branches_behind_an_unknown_voltage() -> None:
    """D(e) = Rb D(i) + i/Cb = Rc D(j) + j/Cc, whatever the law of the node is."""
    (relation,) = model(WAVE).residuals
    assert set(relation.faults) == {"i", "j"}
    assert relation.orders == {"i": 1, "j": 1}


def test_without_the_missing_part_the_others_are_the_same() -> None:
    both, alone = model(f"{SWING}\n{COIL}\n{TANK}"), model(f"{COIL}\n{TANK}")
    assert [r.closed_form.text for r in both.residuals] == [
        r.closed_form.text for r in alone.residuals
    ]


def test_a_linear_loop_too_large_beside_a_coil(monkeypatch: pytest.MonkeyPatch) -> None:
    from tests.unit.passes.test_linear_block import grid

    text = grid(7)[0]
    monkeypatch.setattr(chain, "LARGEST", 50)
    end = text.rindex("}")
    c = compiled(f"{text[:end]}\n{COIL}\n}}")
    assert len(c.residuals) == 1
    sensors = sum(s.same_as is None for s in c.graph.sensors)
    told = c.residuals.missing
    assert [m.finding.code for m in told] == ["loop-too-large"] * (sensors - 1)
    assert all("l1" in m.elements for m in told)


def test_nothing_at_all_is_refused() -> None:
    c = model(SWING)
    with pytest.raises(CompileError) as caught:
        c.residuals  # noqa: B018
    (error,) = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert error.code == "initial-value-needed"


def test_a_relation_that_turns_out_to_say_nothing_is_none() -> None:
    c = model(f"{SWING}\n{COIL}")
    found = c.residuals.residual_set
    report = Report()
    for d in c.report.diagnostics:
        report.add(d)
    stop_without_any(report, found)  # there is one
    empty = ResidualSet(found.system, (), found.unsolved, found.unmonitored, found.missing)
    with pytest.raises(CompileError) as caught:
        stop_without_any(report, empty)
    said = [(d.code, d.severity) for d in caught.value.diagnostics if d.severity != "info"]
    assert said == [("initial-value-needed", "error")]
    stop_without_any(report, empty._replace(missing=()))
