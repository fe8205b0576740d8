"""Loops that only a declared integral opens; the relations by hand."""

from __future__ import annotations

import sympy as sp

from tests.unit.passes.relations import compiled, is_multiple, t, value

# Ideal gas below a piston: both laws of the field say p, so they give one of its two states only.
CYLINDER = """
model Cylinder {{
  param k = 1.3; param V = 0.8; param A = 0.7; param m = 1.5; param b = 0.6
  C:gas{start} {{
    port mass; port vol
    mass.e = k*mass.q/(V - vol.q)
    vol.e = k*mass.q/(V - vol.q)
  }}
  0:chamber {{ <- Sf:G; -> gas.mass; -> De:p }}
  gas.vol -> TF:A {{ f2 = f1/A }} -> rod
  1:rod {{ -> I:m; -> R:b; -> Df:v }}
}}
"""


def test_a_declared_volume_gives_the_mass() -> None:
    """m v' + b v = A p; and G = d/dt of the mass p (V - vol)/k, where vol' = -A v, vol(0) = 1/5."""
    c = compiled(CYLINDER.format(start="(vol.q0 = 1/5)"))
    names = ("k", "V", "A", "m", "b")
    values = ("13/10", "4/5", "7/10", "3/2", "3/5")
    params = {n: sp.Rational(x) for n, x in zip(names, values, strict=True)}
    force, mass = c.residuals
    assert is_multiple(
        force, lambda A, m, b, p, v, **_: m * v.diff(t) + b * v - A * p, params, ("p", "v", "G")
    )
    assert is_multiple(
        mass,
        lambda k, V, A, p, v, G, **_: (
            G - (p * (V - sp.Rational(1, 5) + A * sp.integrate(v, (t, 0, t)))).diff(t) / k
        ),
        params,
        ("p", "v", "G"),
    )


def test_an_undeclared_volume_is_taken_out() -> None:
    """With x = V - vol, x' = A v: k G = p' x + p x' gives x, and so a relation of second order."""
    c = compiled(CYLINDER.format(start=""))
    names = ("k", "A", "m", "b")
    values = ("13/10", "7/10", "3/2", "3/5")
    params = {n: sp.Rational(x) for n, x in zip(names, values, strict=True)}
    params["V"] = sp.Rational(4, 5)
    force, mass = c.residuals
    assert is_multiple(
        force, lambda A, m, b, p, v, **_: m * v.diff(t) + b * v - A * p, params, ("p", "v", "G")
    )
    found = [value(mass.expr, params, dict(zip("pvG", s, strict=True))) for s in healthy(params)]
    assert all(abs(x) < 1e-25 for x in found)
    wrong = [
        value(mass.expr, params, dict(zip("pvG", (p, v, G + 1), strict=True)))
        for p, v, G in healthy(params)
    ]
    assert all(abs(x) > 1e-6 for x in wrong)


def healthy(params: dict[str, sp.Expr]) -> list[tuple[sp.Expr, ...]]:
    """Pressure, speed and the mass flow that they take, for two motions."""
    motions = [(2 + t + t**2 / 3, 1 - t / 2 + t**3), (5 - t**3, t**2 / 2 - t / 3)]
    found = []
    for p, v in motions:
        volume = sp.Rational(3, 7) + params["A"] * sp.integrate(v, (t, 0, t))
        found.append((p, v, (p * volume).diff(t) / params["k"]))
    return found


def test_the_generated_relations_verify() -> None:
    check = compiled(CYLINDER.format(start="(vol.q0 = 1/5)")).verification
    assert check.residuals == 2 and check.faults == len("k V A m b G p v".split())
