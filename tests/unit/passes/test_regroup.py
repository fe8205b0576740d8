"""The halves of the relations of a switched plant, joined by what they hold."""

from __future__ import annotations

import sympy as sp

from bondgraph.compilation import Compilation
from bondgraph.text.source import Source

BOOST = """
bg 1
model M {
  param R = 2; param L = 0.01; param C = 0.001; param Rl = 10
  input U; input on : bool
  1:a { <- Se:u = U; -> I:L; -> R:R; -> Df:i; -> sw }
  0:sw { -> R:s { 0 = if(on, e, f) }; -> b }
  1:b { -> R:d { 0 = if(on, f, e) }; -> out }
  0:out { -> C:C; -> R:load = Rl; -> De:v }
}
"""


def compiled(text: str) -> Compilation:
    return Compilation(Source("test.bg", text))


def test_a_boost_converter_has_a_relation_for_its_coil_and_one_for_its_capacitor() -> None:
    # averaged with a duty cycle d = on these are U - R i - L i' - (1 - d) v and
    # (1 - d) i - C v' - v/Rl (Middlebrook and Cuk, 1976)
    c = compiled(BOOST)
    t = sp.Symbol("t", real=True)
    on, U, i, v = (sp.Function(name, real=True)(t) for name in ("on", "U", "i", "v"))
    R, L, C, Rl = sp.symbols("R L C Rl", real=True)
    r1, r2 = (r.expr for r in c.residuals)
    for d in (0, 1):
        coil = U - R * i - L * i.diff(t) - (1 - d) * v
        capacitor = (1 - d) * i - C * v.diff(t) - v / Rl
        assert sp.simplify(r1.subs(on, d).doit() - coil) == 0
        assert sp.simplify(r2.subs(on, d).doit() + capacitor) == 0
    assert c.verification.method.startswith("exact")
    sees = {f: c.signatures.row(f) for f in c.signatures.faults}
    assert sees["R"] == sees["L"] == sees["U"] == (True, False)
    assert sees["C"] == sees["Rl"] == (False, True)
    assert sees["i"] == sees["v"] == (True, True)


def test_no_derivative_is_left_below_a_switch() -> None:
    assert not any(r.approximate for r in compiled(BOOST).program.residuals)


def test_an_integral_that_a_switch_feeds_is_left_alone() -> None:
    # the charge that the switch let through must not be forgotten when it opens
    text = BOOST.replace("-> C:C; -> R:load = Rl; -> De:v", "-> C:C(q0 = 0); -> Sf:z = 2")
    text = text.replace("}\n}", "}\n  sensor w = C.q + C.q^3\n}")
    c = compiled(text)
    assert c.residuals
    assert c.verification.method.startswith("exact")
