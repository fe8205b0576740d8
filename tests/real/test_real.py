"""The judge is right where the answer is known by hand; what it says of a sample of plants."""

from __future__ import annotations

import re
from collections.abc import Callable
from fractions import Fraction
from random import Random
from typing import Any

import pytest

from tests.real import nodes
from tests.real.answer import answer
from tests.real.build import Build, Law, Model
from tests.real.draw import of_seed
from tests.real.judge import Judgement, judge
from tests.real.laws import E, F
from tests.real.nodes import Node, choose, compare, fn, node, sym
from tests.real.plant import course
from tests.real.run import outcome
from tests.real.series import Program, prepare, sound

#: Plants that are judged within a second or so each; `make real` draws two thousand.
_SAMPLE = (201, 203, 204, 207, 208, 209)


def by_hand(
    model: Model,
    expr: str,
    signature: str = "",
    orders: int = 0,
    **more: Any,
) -> Judgement:
    """The judgement on one residual with a signature, as the compiler would write them."""
    words = re.findall(r"[a-z]\w*", f"{expr} {more.get('implicit')}")
    symbols = sorted({*words} & {*model.plant.faults, "root"})
    arr = {
        "name": "r1",
        "expr": expr,
        "symbols": symbols,
        "orders": dict.fromkeys(symbols, orders),
        "signature": signature.split(),
        **more,
    }
    groups = [list(model.plant.faults)]
    return judge(
        model.plant,
        {"arrs": [arr], "names": {x: x for x in symbols}, "undetectable": [], "groups": groups},
    )


def seen(model: Model, expr: str, orders: int = 0, **more: Any) -> str:
    """The faults that the judge sees, whatever is claimed: nothing or everything."""
    faults = model.plant.faults
    without = by_hand(model, expr, "", orders, **more)
    with_all = by_hand(model, expr, " ".join(faults), orders, **more)
    assert not without.broken and not without.unjudged, without
    found = {e.fault for e in without.entries if e.verdict == "wrong"}
    assert found == {e.fault for e in with_all.entries if e.verdict == "right"}
    assert {*faults} - found == {e.fault for e in with_all.entries if e.verdict == "wrong"}
    return " ".join(sorted(found))


def building() -> Build:
    return Build(Random("by hand"))


def linear(k: Node) -> Law:
    return Law("e", k * F, {"f": E / k})


def divider(equal: bool) -> Model:
    """u over k1 and k2 in series, y is the voltage of the second."""
    build = building()
    u = build.input()
    k1 = build.param("2", 0)
    k2 = k1 if equal else build.param("3", 0)
    loop, middle = build.junction("1"), build.junction("0")
    build.source(loop, u)
    build.element(loop, "R", linear(k1))
    build.bond(loop, middle)
    build.element(middle, "R", linear(k2))
    build.detector(middle)
    return build.model()


def test_a_divider() -> None:
    assert seen(divider(False), "(k1 + k2)*y1 - k2*u1") == "k1 k2 u1 y1"


def test_a_divider_of_equal_resistors_does_not_show_them() -> None:
    assert seen(divider(True), "2*y1 - u1") == "u1 y1"


def test_a_residual_that_does_not_vanish() -> None:
    broken = by_hand(divider(False), "(k1 + k2)*y1 - 2*k2*u1").broken
    assert len(broken) == 1 and broken[0].startswith("r1 does not vanish")


def bridge(balanced: bool) -> Model:
    """Wheatstone's: u over k1, k2 on the left and k3, k4 on the right, y is the current in k5."""
    build = building()
    u = build.input()
    top, left, right = (build.junction("0") for _ in range(3))
    values = ("1", "2", "3", "6" if balanced else "5", "1.5")
    k1, k2, k3, k4, k5 = (build.param(v, 0) for v in values)
    feed = build.junction("1")
    build.source(feed, u)
    build.bond(feed, top)
    across = build.junction("1")
    for a, b, k in ((top, left, k1), (top, right, k3)):
        arm = build.junction("1")
        build.bond(a, arm)
        build.bond(arm, b)
        build.element(arm, "R", linear(k))
    build.element(left, "R", linear(k2))
    build.element(right, "R", linear(k4))
    build.bond(left, across)
    build.bond(across, right)
    build.element(across, "R", linear(k5))
    build.detector(across)
    return build.model()


_BRIDGE = "y1*(k1*k2/(k1 + k2) + k3*k4/(k3 + k4) + k5) - u1*(k2/(k1 + k2) - k4/(k3 + k4))"


def test_a_balanced_bridge_shows_its_arms_only() -> None:
    # 1*6 = 2*3: no current flows, whatever the voltage is and the resistance across
    assert seen(bridge(True), _BRIDGE) == "k1 k2 k3 k4 y1"


def test_a_bridge_out_of_balance() -> None:
    assert seen(bridge(False), _BRIDGE) == "k1 k2 k3 k4 k5 u1 y1"


def test_what_would_be_seen_with_other_numbers() -> None:
    arms = ["k1", "k2", "k3", "k4"]

    def verdicts(off: dict[str, list[str]]) -> dict[str, tuple[str, str]]:
        found = by_hand(bridge(True), _BRIDGE, "k1 k2 k3 k4 y1", only_off_nominal=off)
        return {e.fault: (e.verdict, e.detail) for e in found.entries if e.verdict != "right"}

    assert verdicts({"u1": arms, "k5": []}) == {
        "u1": ("off nominal", ""),
        "k5": ("off nominal", ""),
    }
    blind = "said off nominal, not seen with other k5"
    assert verdicts({"u1": ["k5"]})["u1"] == ("wrong", blind)
    both = "said both seen and only off nominal"
    assert verdicts({"k1": arms}) == {"k1": ("wrong", both)}


def logs() -> Model:
    """y is the difference of the voltages of two diodes, k1*log(i/k2), with currents u1 and u2."""
    build = building()
    u1, u2 = build.input(), build.input()
    k1, k2 = build.param("0.8", 0), build.param("0.2", 0)
    flows = []
    for u in (u1, u2):
        j = build.junction("0")
        build.source(j, u)
        flows.append(sym(build.element(j, "R", Law("f", k2 * fn("exp", E / k1))) + ".f"))
    build.sensor(k1 * fn("log", flows[0] / k2) - k1 * fn("log", flows[1] / k2))
    return build.model()


def test_a_difference_of_logs_does_not_show_their_unit() -> None:
    for expr in ("y1 - k1*log(u1/u2)", "y1 - k1*log(u1/k2) + k1*log(u2/k2)"):
        assert seen(logs(), expr) == "k1 u1 u2 y1"


def test_what_no_numbers_show_is_not_off_nominal() -> None:
    found = by_hand(logs(), "y1 - k1*log(u1/u2)", "k1 u1 u2 y1", only_off_nominal={"k2": []})
    verdicts = {e.fault: e.verdict for e in found.entries}
    assert verdicts == {"k1": "right", "k2": "wrong", "u1": "right", "u2": "right", "y1": "right"}


def valves() -> Model:
    """Two equal valves side by side between a tank and the outside; y1 and y2 their flows."""
    build = building()
    u = build.input()
    area, k = build.param("2", 0), build.param("0.5", 0)
    tank = build.junction("0")
    build.source(tank, u)
    build.element(tank, "C", Law("e", sym("q") / area, {"q": area * E}))
    for _ in range(2):
        valve = build.junction("1")
        build.bond(tank, valve)
        build.element(valve, "R", Law("f", k * fn("ssqrt", E)))
        build.detector(valve)
    return build.model()


def test_two_equal_valves() -> None:
    assert seen(valves(), "y1 - y2") == "y1 y2"
    # y1 = k ssqrt(e): e = y1|y1|/k^2
    balance = "u1 - y1 - y2 - k1*D(y1*Abs(y1)/k2**2, 1)"
    assert seen(valves(), balance, 1) == "k1 k2 u1 y1 y2"


def one_resistor(law: Callable[[Build], Node], side: str = "e") -> Model:
    """A flow u1 through one resistor, y1 its effort; or an effort u1 at it, y1 its flow."""
    build = building()
    u = build.input()
    j = build.junction("0" if side == "e" else "1")
    build.source(j, u)
    build.element(j, "R", Law(side, law(build)))
    build.detector(j)
    return build.model()


def test_a_dead_zone_shows_its_slope_beyond() -> None:
    model = one_resistor(lambda b: b.param("2", 0) * (F - fn("max", fn("min", F, 1), -1)))
    assert seen(model, "y1 - k1*(u1 - Max(-1, Min(1, u1)))") == "k1 u1 y1"


def test_what_is_within_a_dead_zone_for_ever() -> None:
    # tanh stays between -1 and 1
    def law(build: Build) -> Node:
        inner = fn("tanh", F)
        return build.param("2", 0) * (inner - fn("max", fn("min", inner, 1), -1)) + F

    model = one_resistor(law)
    assert seen(model, "y1 - u1") == "u1 y1"


def test_a_branch_by_a_condition() -> None:
    def law(build: Build) -> Node:
        return choose(compare("<", F, 0), build.param("2", 0) * F, build.param("3", 0) * F)

    expr = "y1 - Piecewise((k1*u1, (u1) < (0)), (k2*u1, True))"
    assert seen(one_resistor(law), expr) == "k1 k2 u1 y1"


def test_the_flat_end_of_a_table() -> None:
    points = ((Fraction(0), Fraction(0)), (Fraction(1), Fraction(2)), (Fraction(2), Fraction(2)))

    def law(build: Build) -> Node:
        # beyond 1 the table is flat, and 2 + exp never gets below that
        at = 2 + fn("exp", build.param("0.5", 0) * F)
        return build.param("3", 0) * nodes.table(build.table(points), points, at) + F

    assert seen(one_resistor(law), "y1 - 2*k2 - u1") == "k2 u1 y1"


def controlled() -> Model:
    """A tank whose level y1 a controller reads; y2 is the log of what it commands."""
    build = building()
    area, outlet, gain = (build.param(v, 0) for v in ("2", "3", "4"))
    tank = build.junction("0")
    build.element(tank, "C", Law("e", sym("q") / area, {"q": area * E}))
    build.element(tank, "R", linear(outlet))
    reading = build.detector(tank)
    command = build.let(gain * (build.input() - reading))
    build.source(tank, command, readings=True)
    build.sensor(command)
    return build.model()


def test_a_controller_acts_on_the_wrong_reading_too() -> None:
    assert seen(controlled(), "y2 - k3*(u1 - y1)") == "k3 u1 y2"
    balance = "k3*(u1 - y1) - y1/k2 - k1*D(y1, 1)"
    # what a wrong y1 makes it pump is what the residual thinks it pumps
    assert seen(controlled(), balance, 1) == "k1 k2 k3 pump1 u1 y1"


def test_integrals_begin_at_the_start() -> None:
    build = building()
    u = build.input()
    loop = build.junction("1")
    build.source(loop, u)
    k = build.param("2", 0)
    build.element(loop, "R", linear(build.param("3", 0)))
    build.element(loop, "C", Law("e", sym("q") / k + sym("q") ** 3, {}), "0.5")
    build.detector(loop)
    charge = "Int(y1, 1/2)"
    expr = f"u1 - k2*y1 - {charge}/k1 - {charge}**3"
    assert seen(build.model(), expr) == "k1 k2 u1 y1"


def test_an_inner_unknown() -> None:
    # u1 = k1*root + root^3 through the resistor, y1 its flow
    def law(build: Build) -> Node:
        return build.param("2", 0) * F + F**3

    model = one_resistor(law)
    assert seen(model, "y1 - k1*u1 - u1**3") == "k1 u1 y1"
    inverse = {"implicit": {"root": "y1 - k1*root - root**3"}, "guess": {"root": 0.5}}
    assert seen(model, "u1 - root", **inverse) == "k1 u1 y1"


def test_functions_keep_their_identities() -> None:
    def law(build: Build) -> Node:
        return fn("log", fn("exp", build.param("2", 0) * F)) + node(1)

    model = one_resistor(law)
    for expr in ("y1 - k1*u1 - 1", "exp(y1) - exp(k1*u1)*exp(1)", "y1 - log(exp(k1*u1 + 1))"):
        assert seen(model, expr) == "k1 u1 y1"
    for expr in ("sin(k1)**2 + cos(k1)**2 + y1 - k1*u1 - 2", "y1 - k1*u1 - exp(log(k1)) + k1 - 1"):
        assert seen(model, expr) == "k1 u1 y1"


def test_the_rate_of_what_has_no_value_has_none() -> None:
    prepare(6)
    started = course(Random(1), -1, 6)
    for name in ("log", "sqrt"):
        for n in (fn(name, sym("x")), nodes.der(fn(name, sym("x"))), fn(name, sym("x")) * 0):
            program = Program([n])
            assert not sound(program.values({"x": started})[program.roots[0]])
            assert sound(program.values({"x": -started})[program.roots[0]])


# ------------------------------------------------------------------------------- the campaign


def test_one_drawing_makes_the_text_and_the_plant() -> None:
    for seed in range(40):
        model = of_seed(seed)
        assert of_seed(seed).text == model.text
        told = set(re.findall(r"(?:De:|Df:|sensor )(\w+)", model.text))
        assert told == {*model.plant.sensors}
        for name in (*model.plant.params, *model.plant.inputs, *model.plant.unknown):
            assert len(re.findall(rf"\b{name}\b", model.text)) > 1, name  # declared and used


def test_an_answer_is_what_the_command_prints() -> None:
    found = answer(divider(False))
    assert found["status"] == "ok" and found["n_arr"] == 1
    judged = judge(divider(False).plant, found)
    assert [e.verdict for e in judged.entries] == ["right"] * 4


@pytest.fixture(scope="module")
def sample() -> dict[int, Judgement]:
    return {seed: outcome(seed).judged for seed in _SAMPLE}


def test_residuals_of_a_sample_vanish(sample: dict[int, Judgement]) -> None:
    assert {seed: found.broken for seed, found in sample.items() if found.broken} == {}
    assert sum(len(found.entries) for found in sample.values()) > 100


def test_signatures_of_a_sample_are_those_of_the_machine(sample: dict[int, Judgement]) -> None:
    wrong = [
        (seed, e) for seed, found in sample.items() for e in found.entries if e.verdict == "wrong"
    ]
    assert wrong == []
