"""SymPy's own route from the equations of a bond graph to each residual, and where it stops."""

from __future__ import annotations

import contextlib
import io
import os
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest
import sympy as sp

import bondgraph
from bondgraph.algebra.numeric import DOUBLES
from bondgraph.algebra.symbolic import t
from bondgraph.algebra.sympy_elimination import Loop, Unshown, factor_of, solve_for
from bondgraph.derivations import Derivations, UnknownForm
from bondgraph.ir.functions import FUNCTIONS
from bondgraph.passes.relation.derive import _divisors, derive

ROOT = Path(__file__).resolve().parents[3]
MODELS = sorted((ROOT / "models").glob("*.bg"))
#: Residuals of more steps are derived as well, and take a while.
LARGE = 30
CASES = ROOT / "tests" / "cases"

x, y, u = (sp.Function(n, real=True)(t) for n in "xyu")
a, b = sp.symbols("a b", real=True)


@cache
def compiled(path: Path) -> bondgraph.Compilation:
    return bondgraph.compile(path)


@cache
def derived(path: Path, name: str = "r1") -> Derivations:
    return compiled(path).derivation(name)


def small(path: Path) -> list[str]:
    return [r.name for r in compiled(path).residuals if len(r.residual.steps) <= LARGE]


def moves(found: Derivations) -> list[str]:
    return [step.move for step in found[0].steps]


@pytest.mark.parametrize("path", MODELS, ids=lambda p: p.stem)
def test_sympy_derives_every_residual_of_the_models(path: Path) -> None:
    for name in small(path):
        found = derived(path, name)
        assert found.complete, found.ending
        # up to the sign, in all of them: what `cleared` takes out stands in the steps as well
        assert [abs(d.factor.number) for d in found] == [1]


@pytest.mark.slow
def test_the_large_ones_too() -> None:
    for path in MODELS:
        for relation in compiled(path).residuals:
            if relation.name not in small(path):
                assert derived(path, relation.name).complete


def run(script: str) -> str:
    """What a script prints."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(compile(script, "derivation.py", "exec"), {"__name__": "__main__"})
    return out.getvalue()


@pytest.mark.parametrize("path", MODELS, ids=lambda p: p.stem)
def test_a_script_of_sympy_alone_comes_to_the_same(path: Path) -> None:
    """A second route: `sp.solve` for the unknowns, and a comparison of its own at the end."""
    for name in small(path):
        found = derived(path, name)
        factor = found[0].factor.number
        assert run(found.script) == f"the derived relation is {name} times {factor}\n"
        assert "import bondgraph" not in found.script


@pytest.mark.parametrize(
    ("case", "expected"),
    [
        ("eliminate/algebraic_loop", {"tear", "row", "untear", "put", "scale"}),
        ("eliminate/operator_elimination", {"tear", "row", "lower", "scale", "differentiate"}),
        ("eliminate/start_not_declared", {"free", "integrate"}),
        ("eliminate/inverted_by_iteration", {"iterate"}),
        ("program/delay", {"shift"}),
        ("program/table", {"solve", "close"}),
    ],
)
def test_steps_beyond_the_straight_path(case: str, expected: set[str]) -> None:
    path = CASES / f"{case}.bg"
    found = derived(path)
    assert found.complete, found.ending
    assert expected <= set(moves(found))
    assert run(found.script).startswith("the derived relation is r1 times ")


def law(text: str, inertia: str, params: str) -> Derivations:
    """The derivation of 0 = F - e - inertia*D(v), for the law e of a resistor."""
    declared = "; ".join(f"param {name} = 2" for name in params.split())
    body = f"1:a {{ <- Se:F; -> I:m = {inertia}; -> R:d {{ e = {text} }}; -> Df:v }}"
    return bondgraph.compile(text=f"bg 1\nmodel M {{ {declared}\n{body} }}\n").derivation("r1")


def test_a_script_calls_no_value_like_something_of_its_own() -> None:
    params = "sp t known relation row_1 r1"
    found = law("tanh(known*f + r1)*sin(t*f + relation)", "sp*row_1", params)
    assert run(found.script) == "the derived relation is r1 times 1\n"
    for name in ("sp", "known", "relation", "row_1"):
        assert f'\n{name}_ = sp.Symbol("{name}", real=True)\n' in found.script
    # SymPy takes two symbols of one name for the same: D(t*v) would be v + t*D(v)
    assert '\nt_ = sp.Symbol("constant t", real=True)\n' in found.script


def test_a_part_of_a_long_expression_is_not_put_into_a_longer_name() -> None:
    # 2**7 times the innermost sum: a text of 400 nodes and more calls shared parts t1, t2, ...
    text = "(f + port1)"
    for _ in range(7):
        text = f"({text} + sin{text})"
    found = law(text, "port1", "port1")
    assert "por(" not in found.script
    assert run(found.script) == "the derived relation is r1 times 1\n"


def test_a_relation_of_each_position_has_a_derivation_of_each() -> None:
    found = derived(CASES / "eliminate" / "each_mode.bg")
    assert [d.switches for d in found] == [(("on", True),), (("on", False),)]
    assert found.complete
    assert run(found.script).count("the derived relation is r1") == 2


def test_what_drops_out_is_named_where_it_does() -> None:
    """The torque of the backlash is in both halves of the drive (docs/paper.md)."""
    steps = derived(ROOT / "models" / "drive.bg")[0].steps
    [step] = [s for s in steps if s.gone]
    assert step.equation is not None and step.equation.name == "m.me.rotor"
    assert set(step.gone) == {"m.tau0", "m.A", "m.me.K"}


def test_a_wrong_residual_is_not_agreed_to() -> None:
    c = bondgraph.compile(ROOT / "models" / "dc_motor.bg")
    one, other = (r.residual for r in c.residuals)
    [found] = derive(one._replace(expr=other.expr), c.graph, one)
    assert found.stopped == "SymPy does not see that what is left is a multiple of the compiler's"
    assert found.factor is found.pool.zero and len(found.steps) == 8
    [found] = derive(one._replace(steps=one.steps[:-1]), c.graph, one)
    assert found.stopped


def test_a_step_that_cannot_be_shown_is_told() -> None:
    """A crank that is known up to a choice of two positions: no equation gives it."""
    found = derived(ROOT / "tests" / "adversary" / "models" / "two_links.bg", "r2")
    assert not found.complete and found[0].steps
    assert found.ending.startswith("Here the replay of r2 stops: ")
    assert "the equation has no closed solution" in found.text
    assert "assert vanishes" not in found.script


def test_looking_at_a_derivation_changes_no_code() -> None:
    path = ROOT / "models" / "drive.bg"
    plain, looked = bondgraph.compile(path), bondgraph.compile(path)
    looked.derivation("r1")
    texts = [{a.path: a.text for a in c.artifacts if hasattr(a, "text")} for c in (plain, looked)]
    assert texts[0] == texts[1]


def test_two_hash_seeds_give_equal_bytes(tmp_path: Path) -> None:
    texts = []
    for seed in ("1", "2"):
        command = [sys.executable, "-m", "bondgraph.cli.main", "explain", "models/two_tanks.bg"]
        own = {**os.environ, "PYTHONHASHSEED": seed}
        out = tmp_path / f"{seed}.ipynb"
        subprocess.run([*command, "r1", "--derive", "-o", out], check=True, cwd=ROOT, env=own)
        texts.append(out.read_text())
    assert texts[0] == texts[1]


def test_files_of_other_kinds_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UnknownForm, match=r"\.ipynb, \.py, \.md, \.tex or \.txt"):
        derived(ROOT / "models" / "dc_motor.bg").write(tmp_path / "x.docx")
    assert list(tmp_path.iterdir()) == []


# ------------------------------------------------------------------------ the algebra


def test_factors_are_no_excuse() -> None:
    assert factor_of(a * y - u, u - a * y) == -1
    assert factor_of((a * y - u) / b, a * y - u) == 1 / b
    assert factor_of(y - u / x, x * y - u) == 1 / x  # what it is divided by may be a factor
    assert factor_of(y - u, y + u) is None
    assert factor_of(x * (y - u), y - u) is None  # what may vanish on its own is none
    assert factor_of((y - u) * (y + u), y - u) is None
    assert factor_of(sp.Integer(0), y) is None


def test_equal_relations_in_other_clothes_are_found_equal() -> None:
    start = sp.Integral(a * y + u, (t, 0, t))
    apart = a * sp.Integral(y, (t, 0, t)) + sp.Integral(u, (t, 0, t))
    assert factor_of(sp.tanh(start / b), -sp.tanh(-apart / b)) == 1
    on = sp.Eq(sp.Function("on", real=True)(t), 1)
    switched = sp.Piecewise((y - u, on), (2 * y, True))
    found = factor_of(switched, sp.Piecewise((u - y, on), (y, True)))
    assert found == sp.Piecewise((-1, on), (2, True))


def test_equations_are_solved_where_they_have_one_solution() -> None:
    assert solve_for(y - a * x, x) == y / a
    assert solve_for(y - sp.tanh(x / a), x) == a * sp.atanh(y)
    assert sp.simplify(solve_for(y - x / (1 + x), x) - y / (1 - y)) == 0
    for equation in (y - x**2, y - x - sp.exp(x), y + 0 * x):
        with pytest.raises(Unshown):
            solve_for(equation, x)


def test_what_may_be_zero_is_told_where_it_divides() -> None:
    """What moves is; a sum of parameters may be zero where it is made on the way, by itself not."""
    value = u / a + u / (a + b) + u / y + a / (y + b) ** 2
    assert set(_divisors(value)) == {y, y + b}
    assert set(_divisors(value, sums=True)) == {y, y + b, a + b}


def test_rows_of_differential_loops_are_divided() -> None:
    """x' + a x = u and x'' = y: from the first x'' = u' - a x', and a x' + y = u' is left of it."""
    rows = [x.diff(t) + a * x - u, x.diff(t, 2) - y]
    loop = Loop(rows, [x])
    kinds = [(c.solved, c.lowered, c.times) for c in loop.changes()]
    assert kinds[0] == (False, True, 1)
    assert list(loop.rows) in ([0], [1])
    [left] = loop.rows.values()
    # by hand: y + a (u - a x) = u', so x = (y + a u - u')/a**2, and its x' = u - a x
    by_hand = y.diff(t) + a * u.diff(t) - u.diff(t, 2) - a**2 * u + a * (y + a * u - u.diff(t))
    assert factor_of(left, by_hand) in (1, -1)


def test_parities_of_functions_are_those_of_their_values() -> None:
    for name, record in FUNCTIONS.items():
        if len(record.slopes) == 1:
            at = 0.37
            try:
                turned = DOUBLES[name](-at)
            except ValueError:
                continue
            value = DOUBLES[name](at)
            parity = -1 if turned == -value else 1 if turned == value else 0
            assert record.parity == parity, name


def test_a_chain_of_nonlinear_laws_is_too_long_to_be_derived() -> None:
    # each pipe differentiates the turbulent friction of those behind it: 10^9 terms after five
    pipes = "".join(
        f"0:n{k} {{ -> C:c{k} = 1; -> 1:m{k} }}; m{k} {{ -> I:i{k} = 1; "
        f"-> R:r{k} {{ e = k*ssq(f) }}; -> n{k + 1} }}\n"
        for k in range(5)
    )
    text = f"bg 1\nmodel M {{ param k = 2\n Sf:q -> n0\n{pipes}0:n5 {{ -> C:c5 = 1; -> De:y }} }}"
    found = bondgraph.compile(text=text).derivation("r1")
    assert not found.complete
    assert "has more than 50,000 terms" in found[0].stopped
