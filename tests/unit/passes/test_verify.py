"""Verification passes what is right and names what is wrong: residual, fault, and why not."""

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


def test_a_wrong_residual_is_found() -> None:
    c = Compiled(DRIVE)
    right = c.residuals
    pool = c.graph.pool
    first = right.residuals[0]
    signal = c.graph.sensors[0].symbol
    wrong = first._replace(expr=pool.add((1, first.expr), (1, pool.der(signal))))
    report = Report()
    residuals = right._replace(residuals=(wrong, *right.residuals[1:]))
    verify(c.graph, residuals, c.signatures, report, 1)
    [found] = report.diagnostics
    assert found.code == "verification-failed"
    assert first.name in found.message and "healthy" in found.message


def test_a_model_without_residuals_has_nothing_to_verify() -> None:
    c = Compiled("bg 1\nmodel M { param R = 1\n Se:U -> R:R }")
    report = Report()
    empty = SignatureMatrix((), c.graph.faults, tuple(() for _ in c.graph.faults), ())
    found = verify(c.graph, c.residuals._replace(residuals=()), empty, report, 1)
    assert found.residuals == found.trajectories == found.faults == 0
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
