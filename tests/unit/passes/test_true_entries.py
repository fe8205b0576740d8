"""What residuals see on a real machine, each entry derived by hand: the comment says how."""

from __future__ import annotations

from pathlib import Path

import pytest

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.from_start import from_start
from bondgraph.exact.plant import Plant
from bondgraph.ir.expr import Kind
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.text.source import Source

_TWO_CURRENTS = """
  input U
  Se:U -> 1:a
  a { -> R:R1; -> 0:n; -> Df:ia }
  n { -> C:C; -> 1:b }
  b { -> R:R2; -> Df:ib }"""


def compiled(text: str) -> Compilation:
    found = Compilation(Source("test.bg", f"bg 1\nmodel M {{ {text}\n}}\n"))
    assert found.verification.method.startswith("exact")
    return found


def the_one_with(matrix: SignatureMatrix, sensor: str) -> set[str]:
    """The signature of the only residual that sees a sensor."""
    [residual] = [r for r in matrix.residuals if sensor in matrix.signature(r)]
    return set(matrix.signature(residual))


def test_a_difference_of_logarithms_hides_what_both_divide_by() -> None:
    # dV - Vt log(ia/Is) + Vt log(ib/Is) = dV - Vt log(ia/ib)
    c = compiled(
        "param Vt = 0.026; param Is = 1e-12; param R1 = 1000; param R2 = 2000; param C = 1e-6"
        + _TWO_CURRENTS
        + "\n  sensor dV = Vt*log(a.f/Is) - Vt*log(b.f/Is)"
    )
    assert the_one_with(c.signatures, "dV") == {"Vt", "ia", "ib", "dV"}


@pytest.mark.parametrize("form", ["(a.f/s)^n/(b.f/s)^n", "exp(n*log(a.f/s) - n*log(b.f/s))"])
def test_a_ratio_of_powers_hides_the_scale(form: str) -> None:
    # (ia/s)^n / (ib/s)^n = (ia/ib)^n
    c = compiled(
        "param s = 2; param n = 1.5; param R1 = 1; param R2 = 2; param C = 1"
        + _TWO_CURRENTS
        + f"\n  sensor y = {form}"
    )
    assert the_one_with(c.signatures, "y") == {"n", "ia", "ib", "y"}


@pytest.mark.parametrize(
    ("form", "seen"),
    [
        ("k*exp(a.f + s)*exp(-s)", {"k", "i", "y"}),  # k exp(i)
        ("k*sin(a.f + s)*cos(s) - k*cos(a.f + s)*sin(s)", {"k", "i", "y"}),  # k sin(i)
        ("k*(cosh(a.f*s)^2 - sinh(a.f*s)^2)*a.f", {"k", "i", "y"}),  # k i
        ("k*log(exp(s)*exp(a.f)) - k*s", {"k", "i", "y"}),  # k i
        ("k*exp(a.f + s)", {"k", "s", "i", "y"}),
    ],
)
def test_identities_of_functions_hide_what_they_cancel(form: str, seen: set[str]) -> None:
    c = compiled(
        "param k = 2; param s = 0.5; param R = 1; param C = 2\n  input U\n  Se:U -> 1:a\n"
        f"  a {{ -> R:R; -> C:C; -> Df:i }}\n  sensor y = {form}"
    )
    assert the_one_with(c.signatures, "y") == seen


_VALVES = ["g*(e + b*e^3)", "g*tanh(e) + b*e", "g*ssqrt(e) + b*e", "g*sinh(b*e)"]


@pytest.mark.parametrize("law", _VALVES)
def test_two_equal_valves_in_series_tell_nothing_of_themselves(law: str) -> None:
    # the same flow through equal laws: equal drops, whatever g and b are
    c = compiled(
        "param g = 0.5; param b = 0.3; param A = 1; param B = 2\n  input Q\n"
        "  0:t1 { <- Sf:Q; -> C:A; -> De:p1 }\n  0:t2 { -> De:p2 }\n  0:t3 { -> C:B; -> De:p3 }\n"
        "  t1 -> 1:v1 -> t2 -> 1:v2 -> t3\n"
        f"  v1 -> R:r1 {{ f = {law} }}\n  v2 -> R:r2 {{ f = {law} }}"
    )
    rows = {frozenset(c.signatures.signature(r)) for r in c.signatures.residuals}
    assert {"p1", "p2", "p3"} in rows


def test_a_balanced_bridge_sees_neither_its_supply_nor_its_middle() -> None:
    # i (R5 + ...) = U (R2 R3 - R1 R4) / ...; with 2*3 = 1*6 no current flows, whatever U and R5
    c = compiled(
        "param R1 = 1; param R2 = 2; param R3 = 3; param R4 = 6; param R5 = 5\n"
        "  Se:U -> 0:s; 0:l; 0:r\n  s -> 1:a -> l; s -> 1:b -> r; a -> R:R1; b -> R:R2\n"
        "  l -> R:R3; r -> R:R4; l -> 1:m -> r; m { -> R:R5; -> Df:i }"
    )
    assert set(c.signatures.signature("r1")) == {"R1", "R2", "R3", "R4", "i"}
    arms = ("R1", "R2", "R3", "R4")  # any one of them unbalances it
    assert c.signatures.only_off_nominal("r1") == {"R5": arms, "U": arms}


def test_a_coupling_declared_zero_hides_all_behind_it() -> None:
    # D C k-circuit: its flow y is driven by k times the current of the first; k = 0 leaves y = 0
    c = compiled(
        "param k = 0; param R = 2; param C = 3; param L = 1; param D = 0.5\n  Se:U -> 1:a\n"
        "  a { -> R:R; -> I:L; -> TF:t { f2 = k*f1 } -> 1:b }\n  b { -> C:C; -> R:D; -> Df:y }"
    )
    assert set(c.signatures.signature("r1")) == {"k", "y"}
    hidden = c.signatures.only_off_nominal("r1")
    assert hidden and all(values == ("k",) for values in hidden.values())


def test_a_square_at_zero_is_seen_by_a_finite_change() -> None:
    # e = th^2 f has no slope in th at th = 0, and a value at any other th
    c = compiled(
        "param th = 0; param R = 2; param C = 3\n  Se:U -> 1:a\n"
        "  a { -> R:R; -> C:C; -> Df:i; -> R:x { e = th^2*f } }"
    )
    assert "th" in c.signatures.signature("r1")


def test_a_branch_that_no_real_number_reaches_hides_what_is_in_it() -> None:
    c = compiled(
        "param k = 1; param R = 2; param C = 3\n  Se:U -> 1:a\n"
        "  a { -> R:R; -> C:C; -> Df:i; -> R:x { e = if(f^2 < -1, k*f, 0) } }"
    )
    assert "k" not in c.signatures.signature("r1")
    assert "k" not in c.signatures.only_off_nominal("r1")


@pytest.mark.parametrize("width", [1e-6, 0.01, 1.0, 1000.0])
def test_a_dead_zone_of_any_width_shows_its_width_and_its_slope(width: float) -> None:
    # outside the zone e = k (q - d): both matter there, however far outside is
    c = compiled(
        f"param k = 3; param d = {width}; param J = 2\n  1:a {{ <- Se:T; -> I:J; -> Df:w }}\n"
        "  a -> C:gap(q0 = 0) { e = k*(max(q - d, 0) + min(q + d, 0)) }"
    )
    assert {"k", "d", "J", "T", "w"} == set(c.signatures.signature("r1"))


def _table(folder: Path, rows: str) -> None:
    (folder / "curve.csv").write_text(rows)


def test_a_battery_has_an_open_circuit_voltage_that_can_be_inverted(tmp_path: Path) -> None:
    _table(tmp_path, "0,3.0\n0.2,3.4\n0.5,3.6\n0.8,3.8\n1.0,4.2\n")
    model = tmp_path / "battery.bg"
    model.write_text(
        'bg 1\nmodel M { param R0 = 0.05; param Q = 3600; param R1 = 0.02; param C1 = 1000\n'
        '  Sf:load -> 0:t -> De:u\n  t -> 1:s\n  s { -> R:R0; -> 0:rc\n'
        '    -> C:cell(q0 = 1800) { e = table("curve.csv", q/Q) } }\n  rc { -> R:R1; -> C:C1 } }\n'
    )
    c = Compilation(Source(str(model), model.read_text()))
    assert c.verification.method.startswith("exact")
    # u = OCV(int load / Q) + R0 load + the lag of R1, C1 driven by load
    assert set(c.signatures.signature("r1")) == {"R0", "Q", "R1", "C1", "load", "u"}


@pytest.mark.parametrize("law", ["T*log(q)", "T*sqrt(q)", "T*q^3 + q"])
def test_a_constant_error_of_a_level_shows_behind_a_nonlinear_storage(law: str) -> None:
    # Q = q' with q a curved function of y: y + b moves q' as long as the level moves; for a
    # straight law q' forgets b, and the error shows only as it sets in
    text = "param T = 2\n  0:t {{ <- Sf:Q; -> C:c {{ e = {law} }}; -> De:y }}"
    curved, straight = compiled(text.format(law=law)), compiled(text.format(law="T*q"))
    assert "y" not in (curved.detectability.weak("r1") or ())
    assert "y" in (straight.detectability.weak("r1") or ())


def test_a_model_without_numbers_takes_generic_ones() -> None:
    c = compiled("param R : Ohm; param L : H\n  Se:U -> 1:a\n  a { -> R:R; -> I:L; -> Df:i }")
    assert set(c.signatures.signature("r1")) == {"R", "L", "U", "i"}
    assert not c.signatures.apart and not c.signatures.unconfirmed


def test_what_stands_at_its_dead_centre_hides_what_other_angles_show() -> None:
    # h' = k sin(h) y3: from h = 0 it is zero for good, so y2 = 0 whatever k and y3 are
    c = compiled(
        "param k = 2; param R = 3; param r0 = 1\n  input u\n  1:n2\n  1:n3\n"
        "  let h = int(n2.f)\n  n2 -> TF:w { f1 = (k*sin(h))*f2 } -> n3\n"
        "  n3 <- Se:drive = u\n  n3 -> R:r = R\n  n2 -> R:s = r0\n  n2 -> Df:y2\n  n3 -> Df:y3"
    )
    matrix = c.signatures
    [law] = [r for r in matrix.residuals if "u" not in matrix.signature(r)]
    assert set(matrix.signature(law)) == {"y2"}
    start = ("h.int.x0",)
    assert matrix.only_off_nominal(law) == {"k": start, "y3": start}


@pytest.mark.parametrize(("start", "hidden"), [("0", {"k"}), ("1", set())])
def test_an_empty_tank_that_nothing_fills_hides_its_law(start: str, hidden: set[str]) -> None:
    # i = d/dt (y/k), which is zero for any k as long as y is
    c = compiled(
        "param R = 1; param k = 1\n"
        f"  1:m {{ <- C:c(q0 = {start}) {{ e = k*q }}; -> R:R; -> Df:i }}\n  sensor y = c.e"
    )
    seen = {f for r in c.signatures.residuals for f in c.signatures.signature(r)}
    assert {"R", "k", "i", "y"} - seen == ({"R"} if hidden else set()) | hidden


def test_a_fault_may_drive_a_state_from_its_start() -> None:
    # (a - b) i is zero while a and b are what is declared, and no longer when one of them changes
    c = compiled(
        "param a = 2; param b = 2; param R = 1\n  input U\n  Se:U -> 1:n { -> R:R; -> Df:i }\n"
        "  let h = int((a - b)*n.f)\n  sensor y = h + U"
    )
    assert the_one_with(c.signatures, "y") == {"U", "a", "b", "y"}


def test_a_line_that_starts_at_rest_is_moved_from_its_end() -> None:
    # each cell is driven by the one before it: all of them leave their start, one after the other
    cells = "\n".join(f"  0:n{k} {{ -> C:c{k}(q0 = 0) {{ e = q/C{k} }} }}" for k in range(6))
    links = "\n".join(f"  n{k} -> 1:m{k} {{ -> R:R{k}; -> n{k + 1} }}" for k in range(5))
    numbers = "".join(f"param C{k} = 1; " for k in range(6))
    numbers += "".join(f"param R{k} = 1; " for k in range(5))
    c = compiled(
        f"{numbers}param Rs = 1\n  input U\n{cells}\n{links}\n"
        "  Se:U -> 1:m { -> R:Rs; -> n0; -> Df:i }\n  n5 -> De:y"
    )
    assert not c.signatures.apart
    matrix = c.signatures
    assert set(matrix.faults) == {f for r in matrix.residuals for f in matrix.signature(r)}


def test_a_controller_far_from_zero_shows_its_set_point_between_its_limits() -> None:
    # y2 is 5 to 15 V, so that only a set point near it leaves the limits of 2 V: there the
    # residual y5 - clip(k (r - y2)) sees the set point
    c = compiled(
        "param k1 = 5; param k = 4; param R = 0.2\n  input u; input r\n"
        "  0:n { -> C:c { e = k1*q }; -> R:R; -> De:y1 }\n  n <- Sf:pump1 = u\n"
        "  sensor y2 = 10 + 5*tanh(n.e)\n  let s = min(max(k*(r - y2), -2), 2)\n"
        "  n <- Sf:pump2 = s\n  sensor y5 = s"
    )
    assert the_one_with(c.signatures, "y5") == {"k", "r", "y5"}


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("rate", ["max(u - 300, 0)", "max(n.f - 3, 0)", "if(abs(u) > 40, u, 0)"])
def test_what_overflows_only_beyond_a_limit_is_not_held_at_its_start(rate: str, seed: int) -> None:
    # below the limit the count rests at zero; an input beyond it moves the count, and k shows
    c = compiled(
        "param R = 1; param k = 2\n  input u\n  Se:u -> 1:n { -> R:R; -> Df:i }\n"
        f"  let h = int({rate})\n  sensor y = k*sin(h) + n.f"
    )
    assert not from_start(Plant(c.graph), seed).structure.held
    assert "k" in the_one_with(c.signatures, "y")


@pytest.mark.parametrize(
    "law",
    [
        "0 = min(-e, one*f)",
        "0 = max(e, -one*f)",
        "0 = if(e > -one*f, e, one*f)",
        "0 = if(one*f > -e, e, one*f)",
    ],
)
def test_a_diode_conducts_and_blocks(law: str) -> None:
    """An ideal diode: no drop while it conducts, no current while it blocks, e < 0 then.

    U = R i + u holds while it conducts alone, so that U and R show then; i = 0 otherwise.
    """
    c = bondgraph.compile(text=f"""bg 1
        model Rectifier {{
            param R = 10; param C = 1; param load = 100; const one = 1
            1:a {{ <- Se:U; -> R:R; -> R:diode {{ {law} }}; -> 0:n; -> Df:i }}
            n {{ -> C:C; -> R:load; -> De:u }}
        }}""")  # fmt: skip
    seen = {frozenset(r.faults) for r in c.residuals}
    assert seen == {frozenset({"R", "U", "i", "u"}), frozenset({"C", "load", "i", "u"})}
    (first,) = [r.residual.expr for r in c.residuals if "R" in r.faults]
    current = c.graph.pool.symbol("i", Kind.SENSOR)
    signs = set()
    for number in range(16):
        sample = c._plant.sample([first, current], number, 2)
        value = float(evaluate([current], sample, 2)[0][0])
        signs.add((value > 1e-9) - (value < -1e-9))
    assert signs == {0, 1}
