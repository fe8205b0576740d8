"""What elaboration refuses: one error a cause, with place and remedy, and no traceback."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.unit.passes.elaborating import body_errors, errors, run

BASE = "Se:U -> 1:j; j -> R:r = 2; j -> Df:y\n"

ONE = [
    ("j -> R:x = k", "unknown-name"),
    ("j -> R:x = r", "not-a-value"),
    ("j -> R:x", "missing-value"),
    ("j -> y2", "unknown-name"),
    ("j -> X:x", "unknown-type"),
    ("j -> C:x(p0 = 1) = 1", "unknown-argument"),
    ("j -> R:x(q0 = 1) = 1", "unknown-argument"),
    ("j -> C:x(q0 = y) = 1", "not-constant"),
    ("j -> TF:x = 2 -> R:z = 1", "missing-relation"),
    ("j -> TF:x { f1 = 2*f2 }", "unconnected"),
    ("j -> R:x { e = 2*q }", "wrong-variable"),
    ("j -> R:x { y = 2 }", "law-without-variable"),
    ("j -> R:x { e = 2*f; e = 3*f }", "wrong-law-count"),
    ("j -> R:x = 1 { e = 2*f }", "law-twice"),
    ("j -> De:x", "misplaced-detector"),
    ("j -> Df:x { e = f }", "law-not-allowed"),
    ("C:x = 1", "unconnected"),
    ("0:k", "unconnected"),
    ("j -> R:r = 1", "duplicate-name"),
    ("1:j -> Df:z", "duplicate-name"),
    ("1:j { -> Df:z }", "duplicate-name"),
    ("for k in 1..2 { R:x = 1 }", "duplicate-name"),
    ("param a = 1; param a = 2", "duplicate-name"),
    ("param y = 1", "duplicate-name"),
    ("r -> 0:k; k -> R:z = 1", "too-many-bonds"),
    ("let a = b; let b = a", "circular-definition"),
    ("let a = a", "circular-definition"),
    ("param a = b + 1; param b = 2*a; j -> R:x = a", "circular-definition"),
    ("sensor s = s + j.f", "circular-definition"),
    ("sensor s = 2", "constant-sensor"),
    ("param a = y", "not-constant"),
    ("let a = j.e", "no-such-signal"),
    ("let a = r.q", "no-such-signal"),
    ("let a = y > 1; j -> R:x = a", "wrong-type"),
    ("let a = y + (y > 1)", "wrong-type"),
    ("let a = if(y, 1, 2)", "not-a-condition"),
    ('let a = "text"', "wrong-type"),
    ("let a = 1/0", "division-by-zero"),
    ("let a = 0^(-1)", "division-by-zero"),
    ("let a = sqrt(-1)", "undefined-value"),
    ("let a = log(0)*y", "undefined-value"),
    ("let a = (-8)^0.5", "undefined-value"),
    ("let a = 10^100000", "number-too-large"),
    ("let a = y^100000", "number-too-large"),
    ("let a = y^1e400", "number-too-large"),
    ("let a = 2^1000000", "number-too-large"),
    ("let a = (1e200*y)^1000", "number-too-large"),
    ("let a = (y^1000)^1000", "number-too-large"),
    ("let a = 1e200*y*1e200", "number-too-large"),
    ("param a = 1e400", "number-too-large"),
    ("param a = 1e-400", "number-too-large"),
    ("param a = 1e290^3.5", "number-too-large"),
    ("param a = 1 +- 1e400%", "number-too-large"),
    ("param a = 1e-290 +- 1e290", "number-too-large"),
    ("param a[1e400] = 1", "number-too-large"),
    ("sensor s = j.f counts 1e400/turn", "number-too-large"),
    ("sensor s = j.f counts 0/turn", "wrong-counts"),
    ("sensor s = j.f counts n/turn; const n = 2 - 3", "wrong-counts"),
    ("param a = 0; param b = 1/a", "undefined-value"),
    ("param a = -1; param b = sqrt(a); param c = b + 1", "undefined-value"),
    ("param a = 1e200; param b = a*a; param c = b*b", "undefined-value"),
    ("param a = exp(1000)", "undefined-value"),
    ("param a = 2; param b = a^1000; param c = b^1000; param d = c^1000", "undefined-value"),
    ("let a = tan(1, 2)", "wrong-arguments"),
    ("let a = sine(y)", "unknown-function"),
    ("param k = 2; j -> R:a = 3 V/k", "unknown-unit"),
    ("let a = integral(y)", "unknown-function"),
    ("let a = int(y - a)", "circular-definition"),
    ("let a = d/dt(y)", "unknown-name"),
    ("let a = exp*y", "not-a-value"),
    ("input s; j -> 0:n; n -> R:a = 1; 1:k when s { <- n; -> R:b = 1 }", "not-a-condition"),
    ('let a = table("none.csv", y)', "unreadable-table"),
    ("param a = 2 furlong", "unknown-unit"),
    ("let a = 2 m + 3 s", "unit-mismatch"),
    ("let a = sin(2 m)", "unit-mismatch"),
    ("let a = 2^(1 m)", "unit-mismatch"),
    ("let a = 1 m > 2 s", "unit-mismatch"),
    ("input road : N; j <- Se:road; j -> R:z = 2 V/A; j -> C:c = 1 m", "unit-mismatch"),
    ("sensor s : V = j.f; j -> I:m = 1 V.s/A; j -> C:c = 1 V; let w = j.f*1 Ohm", "unit-mismatch"),
    ("for i in 1..1.5 { }", "not-an-integer"),
    ("for i in 1..y { }", "not-structural"),
    ("if 3 { }", "not-a-condition"),
    ("param a[2] = 1; let b = a[3]", "index-out-of-range"),
    ("param a[2] = 1; let b = a", "index-missing"),
    ("param a = 1; let b = a[1]", "index-not-allowed"),
    ("param a[2] = 1; let b = a[1..2]", "range-not-allowed"),
    ("fault f : nothing += 1", "unknown-name"),
    ("const c = 1; fault f : c += 1", "not-a-fault"),
    ("input on : bool; fault f : on += 1", "wrong-type"),
    ("input on : bool; input b : bool; fault f : on = b", "wrong-type"),
    ("input on : bool; fault f : on = 1", "not-a-condition"),
    ("param a = 1; fault f : a = true", "wrong-type"),
    ("fault f : y *= 2 V", "unit-mismatch"),
    ("fault f : y *= y", "not-constant"),
    ("param a = 2 A +- 1 V; j -> R:x = a", "unit-mismatch"),
    ("param a = 0 V +- 1 V; let b = a", "wrong-tolerance"),
    ("1:k when y > 1 { <- j }", "not-a-mode"),
    ("1:k when 3 { <- j }", "not-a-condition"),
    ("1:k when j.f > 0 { <- j }", "not-a-mode"),
    ("1:k when r.e > 0 { <- j }", "not-a-mode"),
    ("sensor s = int(j.f); 1:k when s > 0 { <- j }", "not-a-mode"),
    ("let a = int(j.f); 1:k when a > 0 { <- j }", "not-a-mode"),
    ("j -> j", "self-bond"),
    ("r { -> R:x = 1 }", "not-a-junction"),
    ("j -> TF:x { port a; port b; a.e = b.e; a.f = b.f } -> R:z = 1", "ports-not-allowed"),
    ("Se:V { f = 2 } -> j", "wrong-variable"),
    ("j -> TF:x { f1 = f2^2 } -> R:z = 1", "not-a-relation"),
    ("j -> TF:x { f1/f2 = 2 } -> R:z = 1", "not-a-relation"),
    ("j -> TF:x { f1 = 2*f2; f2 = f1/3 } -> R:z = 1", "power-not-conserved"),
    ("j -> TF:x { f1 = 2*f2; e1 = 2*e2 } -> R:z = 1", "power-not-conserved"),
    ("j -> GY:x { e1 = 2*f2; f1 = 2*e2 } -> R:z = 1", "power-not-conserved"),
    ("Df:z = j.f; j -> z", "not-a-sensor"),
    ("param R : Ohm; j -> C:c = 1 F; let a = R + c.q/c.e", "unit-mismatch"),
]


@pytest.mark.parametrize(("line", "code"), ONE)
def test_one_error_a_cause(line: str, code: str) -> None:
    said = run(f"model M {{\n{BASE}{line}\n}}")[1]
    assert [d.code for d in said if d.severity == "error"] == [code]
    assert all(d.message and d.help and d.labels for d in said)


PART = "model Part { port a : in electrical; port b : out electrical; a -> R:R = 1 -> b }\n"
LOAD = "model Load(n : int = 1) { port a : in electrical; param R : Ohm; input w; a -> R:R }\n"

SUBMODELS = [
    (PART + "model M { Part:p; Se:U -> p.a }", ["open-port", "too-many-bonds"]),
    (LOAD + "model M { Load:p(R = 1) }", ["open-port"]),
    (LOAD + "model M { Se:U -> Load:p }", ["missing-argument"]),
    (LOAD + "model M { Se:U -> Load:p(R = 1, S = 2) }", ["unknown-argument"]),
    (LOAD + "model M { Se:U -> Load:p(R = 1, R = 2) }", ["duplicate-argument"]),
    (LOAD + "model M { Se:U -> Load:p(R = 1, n = 1.5) }", ["not-an-integer"]),
    (LOAD + "model M { Se:U -> Load:p(R = 1, n = true) }", ["wrong-type"]),
    (LOAD + "model M { Se:U -> Load:p(R = 3 V) }", ["unit-mismatch"]),
    (LOAD + "model M { Se:U -> 1:j; Load:p(R = j.f); j -> p }", ["not-constant"]),
    (LOAD + "model M { Se:U -> Load:p(R = 1) = 3 }", ["not-an-element"]),
    (LOAD + "model M { Se:U -> Load:p(R = 1); Se:V -> p.b }", ["unknown-port"]),
    ("model A { port p : in any; input u; p -> MSe:s = u }\n"
     "model M { 0:a { <- Se:U; -> A:b(u = 1) }; b.u -> R:r = 1 }", ["unknown-port"]),
    (LOAD + "model M { Se:U -> Load:p(R = 1); Se:V -> p }", ["too-many-bonds"]),
    (LOAD + "model M { Se:U -> Load:p(R = 1); Se:V -> p.R }", ["hidden-node"]),
    (LOAD + "model M { Load:p[2](R = 1); Se:U -> p[3]; }", ["index-out-of-range"]),
    ("model A { A:a }", ["recursive-model"]),
    ("model A { B:b }\nmodel B { A:a }", ["recursive-model"]),
    ("model A { port p : in any; Se:U -> R:r = 1 }\nmodel M { A:a; Se:V -> a }", ["unconnected"]),
    ("model A { port p : in rotation; p -> R:r = 1 }\n"
     "model B { port p : out hydraulic; Se:U -> p }\nmodel M { B:b -> A:a }", ["unit-mismatch"]),
    ("model M { param a = 1 }", ["empty-model"]),
    ("model R { Se:U -> C:c = 1 }", ["reserved-name"]),
    ("model A { port p : in any; port q : out any; p -> q }\nmodel M { A:a -> a }", ["port-loop"]),
]  # fmt: skip


@pytest.mark.parametrize(("text", "codes"), SUBMODELS)
def test_submodels(text: str, codes: list[str]) -> None:
    assert errors(text) == codes


@pytest.mark.parametrize(
    ("bonds", "message"),
    [
        ("", "`1:w` has no bond."),
        ("Se:U -> w[1..3]; w[1] -> w[2]", "`1:w[4]` has no bond."),
        ("Se:U -> w[2]; w[2] -> R:r = 1", "`1:w[1]`, `1:w[3]` and `1:w[4]` have no bond."),
    ],
)
def test_which_of_a_row_has_no_bond_is_said_in_one_error(bonds: str, message: str) -> None:
    found = [d.message for d in run(f"model M {{ 1:w[4]; {bonds} }}")[1]]
    assert message in found and len([m for m in found if "no bond" in m]) == 1


def test_an_error_inside_a_thousand_instances_is_one() -> None:
    text = (
        "model Cell { port a : in any; port b : out any; 1:j { <- a; -> R:r = k; -> b } }\n"
        "model M { Cell:c[1000]; Se:U -> c[1..1000] -> R:r = 1 }"
    )
    assert errors(text) == ["unknown-name"]


def test_several_errors_in_one_run() -> None:
    found = body_errors(BASE + "j -> R:x = a\nlet b = 1/0\nparam c = 2 Ohmm\nj -> X:z\nlet d = z.f")
    assert sorted(found) == ["division-by-zero", "unknown-name", "unknown-type", "unknown-unit"]


def test_the_remedy_names_what_was_meant() -> None:
    said = run(f"model M {{ {BASE} param stiffness = 2; j -> C:c = 1/stifness }}")[1]
    assert "`stiffness`" in said[0].help
    assert said[0].labels[0].span.text == "stifness"


def test_who_writes_a_function_of_time_is_told_of_inputs_and_scenarios() -> None:
    said = run(f"model M {{ {BASE} let u = exp(-t) }}")[1]
    assert [d.code for d in said] == ["unknown-name"]
    assert "`input`" in said[0].help and "scenario" in said[0].help


@pytest.mark.parametrize(
    ("written", "meant"),
    [("3 kg*m^2", "3 kg.m^2"), ("2*3e-4 N*m*s/rad", "3e-4 N.m.s/rad"), ("3 N * m", "3 N.m")],
)
def test_a_unit_written_as_a_product_is_spelt(written: str, meant: str) -> None:
    said = run(f"model M {{ {BASE} param J = {written} }}")[1]
    assert [d.code for d in said] == ["unknown-name"]
    assert f"`{meant}`" in said[0].help


def test_powers_of_units_stay_finite() -> None:
    doubled = "\n".join(f"let a{i + 1} = ssq(a{i})" for i in range(1200))
    assert body_errors(BASE + "let a0 = y*1 m\n" + doubled) == ["number-too-large"]
    raised = "\n".join(f"let a{i + 1} = pow(a{i}, 0.123456789)" for i in range(900))
    assert body_errors(BASE + "let a0 = y*1 m\n" + raised) == ["number-too-large"]


def test_a_coefficient_of_another_unit_is_told_as_such() -> None:
    load = "model M { port a : in electrical; a -> 1:i; i -> R:R = 2 N.m.s; i -> C:c = 1 F }"
    message = run(load, open_ports=True)[1][0].message
    assert message == "The resistance of `R` is effort over flow: Ohm against N.m.s."


def test_a_mismatch_names_both_units_and_places() -> None:
    said = run(
        "model Load { port a : in electrical; param R = 3 V; a -> R:R }\nmodel M { Se:U -> Load:x }"
    )[1]
    assert "V" in said[0].message
    assert len(said[0].labels) > 1


def test_plain_numbers_take_the_unit_their_use_requires() -> None:
    assert body_errors("Se:U = 3 V -> 1:j; j -> R:r = 10; j -> Df:y; j -> C:c = 1 uF; "
                       "j -> R:z { e = 10*f + 3*tanh(f/0.1) }") == []  # fmt: skip
    assert body_errors("Se:U = 2 V + 3 -> 1:j; j -> R:r = 2 kOhm; let h = 9.81*2 kg") == []


def test_a_model_of_plain_numbers_is_not_checked() -> None:
    text = "Se:U -> 1:j; j -> R:r = k; j -> C:c = k; param k = 2; let odd = c.q + j.f + c.e"
    found, said = run(f"model M {{ {text} }}")
    assert found is not None and said == []
    assert [v.unit for v in (*found.values, *found.lets)] == [None, None]
    assert body_errors(text + "; sensor s : V = c.e") == ["unit-mismatch"]


def test_counts_beside_a_constant_have_no_unit() -> None:
    text = "param L = 1 mH; Se:U = 3 V -> 1:j; j -> I:m = L; j -> R:r = {}*L; j -> Df:y"
    assert body_errors(text.replace("{}", "1/2")) == ["unit-mismatch"]


def test_units_go_through_junctions_and_two_ports() -> None:
    text = (
        "param k = 0.1 N.m/A; input T : {}\n"
        "Se:U = 3 V -> 1:i; i -> R:r = 2 Ohm; i -> GY:k -> 1:w; w -> R:b = 1 N.m.s; w <- Se:T"
    )
    assert body_errors(text.replace("{}", "N.m")) == []
    assert body_errors(text.replace("{}", "N")) == ["unit-mismatch"]


def test_huge_sizes_are_refused_at_once() -> None:
    assert body_errors(BASE + "for i in 1..1000000000 { let a[i] = 1 }") == ["model-too-large"]
    assert body_errors(BASE + "param a[999999999] = 1") == ["model-too-large"]
    cell = "model Cell {{ port a : in any; port b : out any; {} }}\n"
    part = cell.format("a -> 1:j -> b; j -> R:r = 1")
    chain = f"Cell:c[{{0}}]; {BASE} j -> c[1..{{0}}] -> R:end = 1"
    assert errors(part + f"model M {{ {chain.format(10**7)} }}") == ["model-too-large"]
    loop = cell.format("a -> 1:j -> b; for i in 1..1000 { j -> R:r[i] = 1 }")
    assert errors(loop + f"model M {{ {chain.format(10**4)} }}") == ["model-too-large"]
    sized = part + "model All(n : int = 1) { Cell:c[n]; Se:U -> c[1..n] -> R:end = 1 }\n"
    uneven = "model Some { All:x[3] }\nmodel M { Some:s(x[2].n = 100000000) }"
    assert errors(sized + uneven) == ["model-too-large"]


@pytest.mark.parametrize(
    "repeated",
    ["", "let a[i] = i", "j -> 0:k[i] -> R:a[i] = 1", "if i > 5 { }", "for k in 1..i { }"],
)
def test_a_loop_of_millions_is_refused_before_it_runs(repeated: str) -> None:
    said = run(f"model M {{ {BASE} for i in 1..3000000 {{ {repeated} }} }}")[1]
    assert [d.code for d in said] == ["model-too-large"]
    assert "Cell:cell[n]" in said[0].help


def test_a_long_statement_in_a_loop_counts_as_the_many_that_it_is() -> None:
    chain = "j" + "".join(f" -> 0:k{n}[i] -> 1:m{n}[i]" for n in range(40))
    text = f"{BASE} for i in 1..10000 {{ {chain} }}"
    assert body_errors(text) == ["model-too-large"]


WORDS = st.sampled_from(
    "Se:U R:r C:c 1:j 0:k TF:t GY:g De:y Df:z j k r t = 2 3 * ( ) { } -> <- ; param let sensor "
    "fault input a b e f a[1] for i in 1..2 if true cell model M port p : in any out when int Ohm"
    .split()
)  # fmt: skip


@given(st.lists(WORDS, max_size=40))
def test_any_words_give_a_model_or_a_diagnostic(words: list[str]) -> None:
    from bondgraph.frontend.parser import parse
    from bondgraph.passes.elaboration.elaborate import elaborate
    from bondgraph.text.diagnostic import Report
    from bondgraph.text.source import Source

    source, report = Source("m.bg", "bg 1\nmodel T {\n" + " ".join(words) + "\n}"), Report()
    file = parse(source, report)
    if file is not None:
        found = elaborate(file, source, None, lambda _, __: None, report, False)
        assert (found is None) == report.failed


@pytest.mark.parametrize(
    "law",
    [
        "f1 = 2*f2; e2 = 2*e1",
        "e1 = 2*e2; f2 = 2*f1",
        "f2 = f1/2; 0 = e2 - 2*e1",
        "f1 = (1-a)*f2; e2 = (1-a)*e1",
        "e1 = e2/(1-a); f1 = (1-a)*f2",
    ],
)
def test_both_relations_of_a_transformer_may_stand_where_they_agree(law: str) -> None:
    said = run(f"model M {{\n{BASE}input a\nj -> TF:x {{ {law} }} -> R:z = 1\n}}")[1]
    assert {d.code for d in said} <= {"value-not-used", "value-without-name"}


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("j -> MR:z = 2", True),
        ("param k = 2; j -> MTF:x { f1 = k*f2 } -> R:z = 1", True),
        ("j -> MR:z { e = f*abs(f) }", True),
        ("input a; j -> MR:z = a", False),
        ("j -> MTF:x { f1 = r.e*f2 } -> R:z = 1", False),
        ("j -> MGY:x = int(j.f) -> R:z = 1", False),
    ],
)
def test_an_m_without_a_signal_is_told(line: str, told: bool) -> None:
    codes = [d.code for d in run(f"model M {{\n{BASE}{line}\n}}")[1]]
    assert ("not-modulated" in codes) == told
    assert set(codes) <= {"not-modulated", "value-without-name"}


@pytest.mark.parametrize(
    ("value", "remedy"), [("0 V", "A share of zero is nothing"), ("V0", "Give it in percent")]
)
def test_a_tolerance_of_nothing_is_told_what_would_be_one(value: str, remedy: str) -> None:
    text = f"model M {{\n{BASE}param V0 : V\nparam a = {value} +- 1 V; let b = a\n}}"
    (error,) = [d for d in run(text)[1] if d.severity == "error"]
    assert error.code == "wrong-tolerance" and remedy in error.help
