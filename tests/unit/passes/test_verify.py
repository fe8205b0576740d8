"""Verification passes what is right and names what is wrong: residual, fault, and why not."""

from collections.abc import Set as AbstractSet

import pytest

from bondgraph.compilation import Compilation
from bondgraph.exact.plant import Plant
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.passes.analysis.signatures import signatures
from bondgraph.passes.analysis.verify import verify
from bondgraph.passes.relation.form import relations
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source

DRIVE = """bg 1
model Drive {
    param L = 1; param Re = 1; param k = 1; param J = 1; param K = 1; param m = 1
    Se:U -> 1:el
    el { -> I:L; -> R:Re; -> GY:k -> 1:rotor }
    rotor { -> I:J; -> Df:w1; -> 0:shaft }
    shaft { -> C:spring = 1/K; -> 1:load }
    load { -> I:m; -> Df:w2 }
}
"""

SWITCHED = """bg 1
model Switched {
    param R = 1; param C = 1; param Rl = 1
    input on : bool
    1:sw when on { <- Se:U; -> R:R; -> 0:o; -> Df:i }
    o { -> C:C; -> R:Rl; -> De:y }
}
"""

NONLINEAR = """bg 1
model Tanks {
    param C1 = 1; param C2 = 1; param k1 = 1; param k2 = 1
    Sf:Q -> 0:t1
    t1 { -> C:C1; -> De:h1; -> 1:v }
    v { -> R:r1 { f = k1*ssqrt(e) }; -> 0:t2 }
    t2 { -> C:C2; -> De:h2; -> R:r2 { f = k2*ssqrt(e) } }
}
"""


class Compiled:
    def __init__(self, text: str) -> None:
        c = Compilation(Source("test.bg", text))
        self.graph = c.graph
        plant = Plant(c.graph)
        self.residuals = relations(c.reduced, plant)
        self.signatures = signatures(self.residuals, plant)


@pytest.mark.parametrize("text", [DRIVE, SWITCHED, NONLINEAR])
def test_right_residuals_pass(text: str) -> None:
    c = Compiled(text)
    report = Report()
    found = verify(c.graph, c.residuals, c.signatures, report, 1)
    assert report.diagnostics == []
    assert found.residuals == len(c.residuals.residuals) > 0
    assert found.faults == found.candidates == len(c.graph.faults)
    assert found.trajectories > 1  # at the declared numbers and at others


@pytest.mark.parametrize("text", [DRIVE, NONLINEAR])
def test_every_wrong_entry_of_the_matrix_is_found(text: str) -> None:
    c = Compiled(text)
    right = c.signatures
    for at, fault in enumerate(right.faults):
        for residual in range(len(right.residuals)):
            row = list(right.rows[at])
            row[residual] = not row[residual]
            rows = (*right.rows[:at], tuple(row), *right.rows[at + 1 :])
            report = Report()
            verify(c.graph, c.residuals, right._replace(rows=rows), report, 1)
            [found] = report.diagnostics
            assert found.code == "signature-unconfirmed" and found.severity == "warning"
            assert fault in found.message and right.residuals[residual] in found.message


@pytest.mark.parametrize("at", [0, 1])
def test_a_wrong_residual_is_found(at: int) -> None:
    c = Compiled(DRIVE)
    right = c.residuals.residuals
    pool = c.graph.pool
    signal = c.graph.sensors[0].symbol
    wrong = right[at]._replace(expr=pool.add((1, right[at].expr), (1, pool.der(signal))))
    report = Report()
    residuals = c.residuals._replace(residuals=(*right[:at], wrong, *right[at + 1 :]))
    found = verify(c.graph, residuals, c.signatures, report, 1)
    [told] = report.diagnostics
    assert told.code == "verification-failed" and told.severity == "error"
    assert told.message == f"residual {wrong.name} is not zero on the healthy model"
    assert [label.span for label in told.labels] == [wrong.closing.origin]
    assert found.method == "failed" and found.residuals == found.faults == 0
    assert found.candidates == len(c.graph.faults)


def test_a_residual_that_is_wrong_away_from_the_declared_numbers_is_found() -> None:
    """J - 1 is zero at the number that the model gives."""
    c = Compiled(DRIVE)
    pool, first = c.graph.pool, c.residuals.residuals[0]
    inertia = c.graph.fault_symbols()["J"]
    excess = pool.mul(pool.sub(inertia, pool.one), c.graph.sensors[0].symbol)
    wrong = first._replace(expr=pool.add((1, first.expr), (1, excess)))
    report = Report()
    residuals = c.residuals._replace(residuals=(wrong, *c.residuals.residuals[1:]))
    found = verify(c.graph, residuals, c.signatures, report, 1)
    assert [d.code for d in report.diagnostics] == ["verification-failed"]
    assert found.trajectories == 2  # at the declared numbers and beside them


def _of_one(expr_of: str, sees: AbstractSet[str]) -> tuple[list[str], str]:
    """What is said of one residual w1 D(parameter) with such a row in the matrix, and where."""
    c = Compiled(DRIVE)
    pool, first = c.graph.pool, c.residuals.residuals[0]
    moving = pool.mul(c.graph.sensors[0].symbol, pool.der(c.graph.fault_symbols()[expr_of]))
    rows = tuple((fault in sees,) for fault in c.signatures.faults)
    matrix = SignatureMatrix((first.name,), c.signatures.faults, rows, ())
    residuals = c.residuals._replace(residuals=(first._replace(expr=moving),))
    report = Report()
    verify(c.graph, residuals, matrix, report, 1)
    assert all(
        [label.span for label in d.labels] == [first.closing.origin] for d in report.diagnostics
    )
    return [d.message for d in report.diagnostics], first.name


@pytest.mark.parametrize("parameter", ["J", "Re"])
def test_what_shows_only_while_a_parameter_changes_is_not_seen(parameter: str) -> None:
    """A fault changes a parameter once: that there is a slope is not enough."""
    told, name = _of_one(parameter, {parameter})
    assert told == [f"residual {name} does not see {parameter} at some points, as it should"]
    assert _of_one(parameter, set())[0] == []
    # nor is the sensor, as its factor is zero as long as the parameter is what it is
    told, _ = _of_one(parameter, {parameter, "w1"})
    assert told == [
        f"residual {name} does not see {fault} at some points, as it should"
        for fault in (parameter, "w1")
    ]


def test_how_it_was_verified_is_told() -> None:
    c = Compiled(DRIVE)
    found = verify(c.graph, c.residuals, c.signatures, Report(), 1)
    assert found.method.startswith("exact Taylor series modulo a ")
    assert found.method.endswith(f"; {len(c.graph.faults)} of {len(c.graph.faults)} faults")


def test_an_entry_that_is_unconfirmed_already_is_not_told_again() -> None:
    c = Compiled(DRIVE)
    right = c.signatures
    rows = tuple((not row[0], *row[1:]) for row in right.rows)
    report = Report()
    known = right._replace(rows=rows, unconfirmed={right.residuals[0]: "in a branch"})
    verify(c.graph, c.residuals, known, report, 1)
    assert report.diagnostics == []


def test_a_relation_without_a_sensor_is_no_residual() -> None:
    c = Compiled(DRIVE)
    source = c.graph.inputs[0].symbol
    *others, last = c.residuals.residuals
    report = Report()
    residuals = c.residuals._replace(residuals=(*others, last._replace(expr=source)))
    found = verify(c.graph, residuals, c.signatures, report, 1)
    assert [d.code for d in report.diagnostics] == ["sources-contradict"]
    assert f"`{last.closing.name}`" in report.diagnostics[0].message
    assert found.method == "not verified: a relation without a sensor"
    assert found.residuals == found.trajectories == 0


def test_a_model_without_residuals_has_nothing_to_verify() -> None:
    c = Compiled("bg 1\nmodel M { param R = 1\n Se:U -> R:R }")
    report = Report()
    empty = SignatureMatrix((), c.graph.faults, tuple(() for _ in c.graph.faults), ())
    found = verify(c.graph, c.residuals._replace(residuals=()), empty, report, 1)
    assert found.residuals == found.trajectories == found.faults == 0
    assert found.method == "nothing to verify: the model has no residual"
    assert report.diagnostics == []


def test_what_cannot_be_simulated_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    from bondgraph.exact.plant import Plant
    from bondgraph.exact.trajectory import ExactUnavailable

    def refuse(*_: object, **__: object) -> None:
        raise ExactUnavailable("its laws hold a riddle")

    monkeypatch.setattr(Plant, "sample", refuse)
    c = Compiled(DRIVE)
    report = Report()
    found = verify(c.graph, c.residuals, c.signatures, report, 1)
    [warning] = report.diagnostics
    assert warning.code == "verification-unavailable" and warning.severity == "warning"
    assert "riddle" in warning.message and "riddle" in found.method
    assert found.residuals == found.faults == 0


def test_the_same_seed_gives_the_same_answer() -> None:
    c = Compiled(DRIVE)
    one = verify(c.graph, c.residuals, c.signatures, Report(), 3)
    assert one == verify(c.graph, c.residuals, c.signatures, Report(), 3)
