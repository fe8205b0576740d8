"""A switch that is not in the position it is told: signatures by hand, and what is said of them."""

from __future__ import annotations

import json

import pytest

from bondgraph.cli.main import main
from bondgraph.compilation import Compilation
from tests.unit.passes.relations import compiled


def rows(c: Compilation, **modes: bool) -> dict[str, frozenset[frozenset[str]]]:
    """By fault what the residuals that see it see of the model's faults together with it."""
    (mode,) = (m for m in c.mode_signatures.modes if m.modes == modes)
    assert mode.matrix is not None
    union = {r: frozenset(c.signatures.signature(r)) for r in c.signatures.residuals}
    return {f: frozenset(union[r] for r in mode.matrix.seen_by(f)) for f in mode.matrix.faults}


@pytest.mark.parametrize("command", ["max(set - T, 0)", "min(set - T, 0)", "max(T - set, 0)"])
def test_a_command_that_saturates_is_tried_where_it_acts(command: str) -> None:
    """A logged command u, at its limit for half of all references, feeds C through a switch.

    r1 = if(on, P u, 0) + heat - C T', r2 = u - command. Turned over, C T' is 0 in place of P u, or
    P u in place of 0: r1 is P u or -P u, which is zero only while u is at its limit; r2 is zero.
    """
    c = compiled(
        f"""model M {{ param P=2; param C=3
        input on : bool
        input set
        sensor u = {command}
        Sf:heat = if(on, P*u, 0) -> 0:h {{ -> C:C; -> De:T }} }}"""
    )
    balance = frozenset({"P", "C", "heat", "T"})
    told_on, told_off = rows(c, on=True), rows(c, on=False)
    assert told_on["on"] == told_on["P"] == told_on["C"] == {balance}
    assert told_off["on"] == told_off["C"] == {balance} and told_off["P"] == frozenset()


def test_a_circuit_with_a_switch() -> None:
    """U feeds R and C through a switch; i and v are measured.

    On: r1 = U - R i - v, off: r1 = i; in both r2 = i - C v'. Stuck off while told on: i = 0, so
    that r1 = U - v is not zero, and r2 = -C v' = 0 as v' = 0. Stuck on while told off: r1 = i is
    not zero, and r2 is. So it looks like R or U while on. Off it looks like no other fault: the
    sensor of the current moves r2 as well.
    """
    c = compiled(
        """model M { param R=2; param C=3
        input on : bool
        Se:U -> 1:a when on { -> R:R; -> Df:i; -> 0:o }
        o { -> C:C; -> De:v } }"""
    )
    switch = frozenset({"U", "R", "i", "v"})
    charge = frozenset({"C", "i", "v"})
    told_on = rows(c, on=True)
    assert told_on["on"] == told_on["R"] == told_on["U"] == {switch}
    assert told_on["C"] == {charge} and told_on["i"] == told_on["v"] == {switch, charge}
    told_off = rows(c, on=False)
    assert told_off["on"] == {switch} and told_off["i"] == {switch, charge}
    assert told_off["R"] == told_off["U"] == frozenset() and told_off["v"] == {charge}


def test_two_tanks_with_a_valve() -> None:
    """Both levels and the flow q between are measured: q = k (p1 - p2) if open, else 0.

    The balances of the tanks hold with the measured q wherever the valve is, and the third
    relation, q - k (p1 - p2) told open or q told shut, shows it in both positions. k is seen only
    open.
    """
    c = compiled(
        """model M { param A1=2; param A2=3; param k=5; param G=7
        input open : bool
        Sf:Q -> 0:t1; t1 { -> C:A1; -> De:p1; -> v }
        1:v when open { -> R:k = 1/k; -> Df:q; -> t2 }
        0:t2 { -> C:A2; -> De:p2; -> R:G = 1/G } }"""
    )
    first, second = frozenset({"A1", "Q", "p1", "q"}), frozenset({"A2", "G", "p2", "q"})
    valve = frozenset({"k", "p1", "p2", "q"})
    for position in (True, False):
        found = rows(c, open=position)
        assert found["open"] == {valve}
        assert found["k"] == ({valve} if position else frozenset())
        assert found["q"] == {first, second, valve}
        assert found["Q"] == {first}


def test_a_buck_converter() -> None:
    """The node behind transistor and diode has E while on and 0 while off, and never both.

    r1 = v + R i + L i' - (E if on), r2 = i - G v - C v'. The true position enters through the node
    alone: told on while off r1 = -E, told off while on r1 = E; r2 has no part in it.
    """
    c = compiled(
        """model M { param L=2; param R=3; param C=5; param G=7
        input on : bool
        input E
        Se:E -> 1:tr when on { -> 0:n }
        Se:ground = 0 -> 1:fw when not on { -> n }
        n -> 1:coil; coil { -> I:L; -> R:R; -> Df:i; -> 0:out }
        out { -> C:C; -> R:load = 1/G; -> De:v } }"""
    )
    coil, out = frozenset({"E", "L", "R", "i", "v"}), frozenset({"C", "G", "i", "v"})
    for on in (True, False):
        found = rows(c, on=on)
        assert found["on"] == {coil} and found["C"] == {out}
        assert found["E"] == ({coil} if on else frozenset())


def test_a_switch_that_only_a_law_knows() -> None:
    """A gear of two ratios, w2 = w1/n with n = 2 or n = 3: told the wrong one, w2 does not fit.

    The input torque is measured by nothing else, so this is all that there is.
    """
    c = compiled(
        """model M { param a=2; param b=3; param J=1
        input low : bool
        Se:T -> 1:s; s { -> I:J; -> Df:w1; -> TF:n { f1 = if(low, a, b)*f2 } -> e }
        1:e { -> R:load = 1; -> Df:w2 } }"""
    )
    for low in (True, False):
        found = rows(c, low=low)
        ratio = frozenset({"a", "b", "w1", "w2"})
        (other,) = {s for seen in found.values() for s in seen} - {ratio}
        assert found["low"] == ({ratio, other} if "a" in other else {ratio})
        assert found["a" if low else "b"] == found["low"]
        assert found["b" if low else "a"] == frozenset()


def test_two_switches_that_only_together_matter() -> None:
    """Current flows if both are on. Told off and off, one alone stuck on is not seen."""
    c = compiled(
        """model M { param R=2
        input s1 : bool; input s2 : bool
        Se:U -> 1:a when s1 and s2 { -> R:R; -> Df:i } }"""
    )
    sees = {
        tuple(m.modes.values()): {n: bool(m.matrix.seen_by(n)) for n in m.modes}
        for m in c.mode_signatures.modes
        if m.matrix is not None
    }
    assert sees == {
        (False, False): {"s1": False, "s2": False},
        (False, True): {"s1": True, "s2": False},
        (True, False): {"s1": False, "s2": True},
        (True, True): {"s1": True, "s2": True},
    }


_FORBIDDEN = """bg 1
model M { param R=1
input on : bool
input cool : bool
Se:U -> 0:b; b { -> R:short { 0 = if(on, e - 5, f) }; -> a }
1:a { -> R:R; -> Df:i; -> R:fan { e = if(cool, 2, 3)*f } } }
"""


def test_a_position_that_cannot_be(tmp_path: object, capsys: pytest.CaptureFixture[str]) -> None:
    """On, two sources of effort stand against each other: told off, it cannot be on."""
    path = f"{tmp_path}/m.bg"
    with open(path, "w") as file:
        file.write(_FORBIDDEN)
    assert main(["compile", path, "--json", "-o", f"{tmp_path}/out"]) == 0
    modes = json.loads(capsys.readouterr().out)["modes"]
    off = [m for m in modes if not m["inputs"]["on"]]
    for mode in off:
        assert "more than the variables" in mode["impossible"]["on"]
        assert list(mode["impossible"]) == ["on"]
        assert any("cool" in seen for seen in mode["signatures"].values())
        assert not any("on" in seen for seen in mode["signatures"].values())
        assert mode["stuck"]["on"] == "on stuck on"
    assert main(["explain", path, "on"]) == 0
    out = capsys.readouterr().out
    off, on = out.split("  on stuck on\n")
    assert "on stuck off\n    no behaviour, " in off
    assert on.startswith("    no behaviour in that position, ")
    assert main(["explain", path, "cool"]) == 0
    out = capsys.readouterr().out
    assert out.count("    on off: moves r1, like ") == out.count("    on on: no behaviour, ") == 2


def test_what_is_said_of_a_switch(tmp_path: object, capsys: pytest.CaptureFixture[str]) -> None:
    path = "models/oven.bg"
    assert main(["compile", path, "-o", f"{tmp_path}/out"]) == 0
    out = capsys.readouterr().out
    assert "  on stuck off: moves r1, like Ch or P\n  on stuck on: moves r1, like Ch\n" in out
    assert main(["explain", path, "on"]) == 0
    assert "  on stuck on\n    moves r1, like Ch\n" in capsys.readouterr().out
    assert main(["explain", path, "P"]) == 0
    assert "  on off: not seen\n" in capsys.readouterr().out


def test_large_plants_are_decided_by_exponentials() -> None:
    """A ladder of 40 cells behind a switch: as many coefficients as trajectories cannot have."""
    cells = "\n".join(
        f"0:n{k} {{ -> C:c{k} = 1; -> 1:l{k} }}\nl{k} {{ -> R:r{k} = 2; -> n{k + 1} }}"
        for k in range(40)
    )
    c = compiled(
        f"""model M {{ param R=3
        input on : bool
        Se:U -> 1:a when on {{ -> R:R; -> n0 }}
        {cells}
        0:n40 {{ -> C:c40 = 1; -> De:v; -> R:end = 4 }} }}"""
    )
    for mode in c.mode_signatures.modes:
        assert mode.matrix is not None and mode.matrix.seen_by("on") == ("r1",)
