"""The steps of algebra that need SymPy: equations that hold a variable more than once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy as sp

from bondgraph.algebra.fractions import monomials, only_root
from bondgraph.algebra.symbolic import from_sympy, to_sympy
from bondgraph.ir.expr import RATIONAL, Expr, Op, Pool, topological
from bondgraph.ir.nodes import holding

_EXPANDED = 500  # terms that SymPy may make of an equation
_FACTORED = 60  # and of one that it has to factor


def solve_symbolic(pool: Pool, zero: Expr, variable: Expr) -> Expr | None:
    """The value of `variable` where the equation is linear once fractions are cleared.

    `e = k*f/(1 + f)` has one solution for f; an equation of higher degree has several, or none
    that holds for every value of the parameters, and gives None.
    """
    holders = holding([zero, variable], lambda n: n is variable)
    leaves: dict[Expr, Any] = {variable: sp.Symbol("x", real=True)}
    names: dict[Any, Expr] = {leaves[variable]: variable}
    if any(n.op not in RATIONAL for n in holders):
        return None  # a choice is no fraction, whatever SymPy makes of it
    for node in holders:
        for arg in node.args:
            if arg not in holders and arg not in leaves:
                leaves[arg] = sp.Symbol(f"c{len(leaves)}", real=True)
                names[leaves[arg]] = arg
    if monomials([zero], {n for n in leaves if n not in holders}) > _EXPANDED:
        return only_root(pool, zero, variable)
    x = leaves[variable]
    numerator = sp.fraction(sp.together(to_sympy(zero, leaves)))[0]
    if not numerator.is_polynomial(x) or numerator.has(sp.Function):
        return None
    polynomial = sp.Poly(numerator, x)
    if polynomial.degree() != 1:
        return None
    slope, rest = polynomial.all_coeffs()
    return from_sympy(pool, sp.factor_terms(-rest / slope), names)


def simplified_slope(
    pool: Pool, zero: Expr, variable: Expr, positive: Callable[[Expr], bool]
) -> Expr | None:
    """The derivative of an algebraic equation with respect to a variable, factored, or None.

    `positive` says which parts without the variable are. `p/sqrt(1 + p^2)` has the slope
    (1 + p^2)^(-3/2), which shows its sign; the quotient rule does not.
    """
    holders = holding([zero, variable], lambda n: n is variable)
    leaves: dict[Expr, Any] = {variable: sp.Symbol("x", real=True)}
    for node in holders:
        power = node.op is Op.FN and node.name in ("sqrt", "pow")
        if not power and node.op not in RATIONAL:
            return None  # factoring sums of functions may take for ever
        for arg in node.args:
            if arg not in holders and arg not in leaves and arg.op is not Op.NUM:
                sign = True if positive(arg) else None
                leaves[arg] = sp.Symbol(f"c{len(leaves)}", real=True, positive=sign)
    if monomials([zero], {n for n in leaves if n is not variable}) > _FACTORED:
        return None
    names = {s: n for n, s in leaves.items()}
    slope = sp.factor(sp.together(sp.diff(to_sympy(zero, leaves), leaves[variable])))
    return from_sympy(pool, slope, names)


def without_common_factor(
    pool: Pool, a: list[Expr], b: list[Expr]
) -> tuple[list[Expr], list[Expr]]:
    """Two polynomials in D (coefficients from D**0 up) divided by their greatest common divisor."""
    d = sp.Symbol("D")
    leaves = [n for n in topological([*a, *b]) if not n.args]
    symbols = {n: sp.Symbol(f"a{n.id}") for n in leaves if n.op.value == "sym"}
    names = {s: n for n, s in symbols.items()}
    one, other = (
        sp.Poly(sum(to_sympy(c, symbols) * d**k for k, c in enumerate(p)), d) for p in (a, b)
    )
    common = sp.gcd(one, other)
    if common.degree() <= 0:
        return a, b
    result = []
    for polynomial in (one, other):
        quotient = sp.Poly(sp.cancel(polynomial.as_expr() / common.as_expr()), d)
        parts = [from_sympy(pool, sp.factor_terms(c), names) for c in quotient.all_coeffs()[::-1]]
        kept = [p for p in parts if p is not None]
        if len(kept) != len(parts):
            return a, b
        result.append(kept)
    return result[0], result[1]
