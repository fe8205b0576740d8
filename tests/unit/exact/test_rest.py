"""Signals that the structure keeps at zero, and the nonlinear laws that rest there."""

from __future__ import annotations

import pytest

from bondgraph.compilation import Compilation
from bondgraph.text.source import Source

_TWO_RATIOS = """bg 1
model M {{
  param m = 1.2; param n = 1.03; param k = 0.8; input u
  0:a {{ -> De:y; -> R:x {{ {law} }}
        -> TF:t1 {{ f1 = m*f2 }} -> b; -> TF:t2 {{ f1 = n*f2 }} -> b }}
  0:b {{ <- Sf:u; -> R:z = 2 }}
}}
"""


def _signature(text: str) -> dict[str, list[str]]:
    compilation = Compilation(Source("rest.bg", text))
    matrix = compilation.signatures
    assert compilation.verification.method.startswith("exact")
    return {
        name: [f for f, row in zip(matrix.faults, matrix.rows, strict=True) if row[at]]
        for at, name in enumerate(matrix.residuals)
    }


@pytest.mark.parametrize(
    "law",
    [
        "e = tanh(k*f) + f",
        "f = exp(k*e) - 1 + e",
        "e = k*f*abs(f)",
        "f = k*ssqrt(e)",
        "e = k*f + f^3",
        "0 = e - k*f - sinh(f)",
        "e = k*sign(f) + f",
    ],
)
def test_no_effort_between_two_ratios(law: str) -> None:
    # e_b = m e_a = n e_a leaves e_a = 0 for m != n: no parameter can be seen, only the sensor
    assert _signature(_TWO_RATIOS.format(law=law)) == {"r1": ["y"]}


def test_two_laws_that_rest_together() -> None:
    # No source: e1 = e2, f1 + f2 = 0 and both laws rise, so that only rest is left.
    text = """bg 1
model M { param a = 1; param b = 2
  0:j { -> R:x { f = exp(a*e) - 1 }; -> R:z { e = tanh(b*f) + f }; -> De:y } }
"""
    assert _signature(text) == {"r1": ["y"]}


def test_a_law_behind_a_loop_of_bonds() -> None:
    # The flow around the loop is open; the balance of the three junctions together is not.
    text = """bg 1
model M { param k = 3; param r = 2; input u
  0:a { <- Sf:u; -> De:y; -> b; -> c }
  0:b { -> R:x { f = k*ssqrt(e) }; -> c }
  0:c { -> R:r } }
"""
    assert _signature(text) == {"r1": ["k", "r", "u", "y"]}
