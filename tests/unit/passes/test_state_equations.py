"""State equations of laws in which equal parts occur again and again."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from bondgraph.algebra.numeric import EXACT, evaluate
from bondgraph.compilation import Compilation
from bondgraph.field.evaluation import Evaluated
from bondgraph.ir.expr import Op
from bondgraph.ir.state import StateEquations
from bondgraph.passes.elimination.state_equations import Wanted
from bondgraph.text.diagnostic import CompileError
from bondgraph.text.source import Source


def test_a_law_of_many_paths_is_gone_through_once() -> None:
    # each `let` has the one before twice: 2^40 ways lead from the law to the flow
    lets = "\n".join(f"let a{k} = sin(a{k - 1}) + cos(a{k - 1})" for k in range(1, 41))
    text = (
        "bg 1\nmodel M {\n1:s { <- Se:u; -> I:l = 1; -> R:r { e = a40*f } }\n"
        f"let a0 = s.f\n{lets}\ns -> Df:y\n}}\n"
    )
    found = Compilation(Source("m.bg", text)).state_equations()
    assert len(found.states) == 1


class _Motion(dict[str, float]):
    """All that the equations give at a state and inputs, by name; numbers of the model besides."""

    def __init__(self, found: StateEquations, **known: float) -> None:
        given = {v.name: evaluate(v.value, {}) for v in found.graph.values if v.value is not None}
        super().__init__({name: float(x) for name, x in given.items() if x is not None} | known)
        for block in found.blocks:
            names = [u.symbol.name for u in block.unknowns]
            if block.value is not None:
                self[names[0]] = self.at(block.value)
                continue
            assert block.rests  # a linear one
            slopes = np.array([[self.at(slope) for slope in row] for row in block.slopes])
            solved = np.linalg.solve(slopes, [-self.at(rest) for rest in block.rests])
            self.update(zip(names, solved.tolist(), strict=True))
            for zero in block.zeros:
                assert abs(self.at(zero)) < 1e-9
        self.rates = {s.name: self[s.rate.symbol.name] for s in found.states}

    def at(self, expr: Any) -> float:
        still = {**EXACT, Op.DER: lambda *_: 0.0}  # what is told of errors does not move
        found = Evaluated(still, lambda node: self.get(node.symbol.name)).value(expr)
        assert found is not None
        return float(found)


def _equations(text: str, **wanted: Any) -> StateEquations:
    model = Compilation(Source("m.bg", f"bg 1\nmodel M {{\n{text}\n}}\n"))
    return model.state_equations(Wanted(**wanted) if wanted else None)


_MOTOR = """param L = 0.5; param R = 3; param k = 2; param J = 4; param b = 7
1:el { <- Se:U; -> I:L; -> R:R; -> GY:k -> 1:shaft }
shaft { -> I:J; -> R:b; -> Df:w }"""


def test_the_rates_of_a_motor_are_those_of_its_differential_equations() -> None:
    found = _equations(_MOTOR)
    assert [s.name for s in found.states] == ["L.p", "J.p"]
    at = _Motion(found, **{"L.p": 1.5, "J.p": 10.0, "U": 20.0})
    i, w = 1.5 / 0.5, 10.0 / 4.0
    assert at.rates == pytest.approx({"L.p": 20.0 - 3.0 * i - 2.0 * w, "J.p": 2.0 * i - 7.0 * w})
    assert at["w"] == pytest.approx(w)
    assert [[at.at(c) for c in s.capacities] for s in found.states] == [[-0.5], [-4.0]]
    assert found.dependent == () and found.static == () and found.modes == ()


_GEAR = """param m = 2; param M = 5; param b = 3
1:v { <- Se:F; -> I:m; -> TF:n { f1 = 4*f2 } -> 1:w }
w { -> I:M; -> R:b; -> Df:y }"""


def test_of_two_inertias_on_a_gear_one_is_a_state_and_the_other_takes_impulses() -> None:
    """(16 m + M) w' = 4 F - b w, whichever of both is the state."""
    found = _equations(_GEAR)
    (state,), (other,) = found.states, found.dependent
    assert {state.name, other.name} == {"m.p", "M.p"} and other.storage == other.name[0]
    w, impulse = 1.25, 6.0
    momentum = {"m.p": 2.0 * 4.0 * w, "M.p": 5.0 * w}
    known = {state.name: momentum[state.name], "F": 9.0}
    at = _Motion(found, **known, **{other.signal.symbol.name: 0.0})
    assert at["y"] == pytest.approx(w) and at[other.name] == pytest.approx(momentum[other.name])
    rate = (4.0 * 9.0 - 3.0 * w) / (16.0 * 2.0 + 5.0)
    share = {"m.p": 8.0, "M.p": 5.0}
    assert at.rates == pytest.approx({state.name: share[state.name] * rate})
    # what is hit from outside moves with the other one
    hit = _Motion(found, **known, **{other.signal.symbol.name: impulse})
    lever = {"m.p": 4.0, "M.p": 1.0}[other.name]
    more = lever * impulse / 37.0
    assert hit.rates == pytest.approx({state.name: share[state.name] * (rate + more)})


def test_parameters_of_nothing_store_nothing_unless_they_are_open_or_disturbed() -> None:
    def states(**wanted: Any) -> list[str]:
        return [s.name for s in _equations(_MOTOR, modes={}, **wanted).states]

    assert states(numbers={"L": 0.0}) == ["J.p"]
    assert states(numbers={"L": 0.0}, open=frozenset({"L"})) == ["L.p", "J.p"]
    assert states(numbers={"L": 0.0}, disturbed=("L",)) == ["L.p", "J.p"]
    assert states(numbers={"L": 2.0}) == states(numbers={"R": 0.0}) == ["L.p", "J.p"]
    found = _equations(_MOTOR, modes={}, numbers={"L": 0.0})
    at = _Motion(found, **{"J.p": 10.0, "U": 20.0, "impulse of L.p": 0.0})
    assert at.rates["J.p"] == pytest.approx(2.0 * (20.0 - 5.0) / 3.0 - 7.0 * 2.5)


@pytest.mark.parametrize(
    ("static", "told"), [(("L",), ["L"]), (("el",), []), (("L.p",), []), (("L", "J"), ["L", "J"])]
)
def test_storages_at_rest_have_no_rate(static: tuple[str, ...], told: list[str]) -> None:
    found = _equations(_MOTOR, modes={}, static=static)
    assert list(found.static) == told
    assert [s.name for s in found.states] == [f"{n}.p" for n in "LJ" if n not in told]
    if told == ["L"]:
        at = _Motion(found, **{"J.p": 10.0, "U": 20.0})
        i = (20.0 - 2.0 * 2.5) / 3.0
        assert at.rates["J.p"] == pytest.approx(2.0 * i - 7.0 * 2.5)


def test_storages_below_a_path_are_at_rest_and_none_that_only_begins_so() -> None:
    text = """model Mass { port p : in translation
1:v { <- p; -> I:m = 2; -> R:b = 3 } }
model M { Mass:a; Mass:ab; Mass:c[2]
Se:F -> a.p; Se:G -> ab.p; Se:H -> c[1].p; Se:K -> c[2].p
sensor y = a.v.f }"""
    model = Compilation(Source("m.bg", f"bg 1\n{text}\n"))
    for static, told in (("a", ["a.m"]), ("c", ["c[1].m", "c[2].m"]), ("c[2]", ["c[2].m"])):
        assert list(model.state_equations(Wanted({}, (static,))).static) == told


def test_what_may_be_wrong_has_a_gain_and_a_bias() -> None:
    found = _equations(_MOTOR, modes={}, disturbed=("w", "R", "U"))
    assert [d.name for d in found.disturbances] == ["w", "R", "U"]
    wrong = {"w": (3.0, 0.5), "R": (2.0, 1.0), "U": (0.5, -4.0)}
    signals = {f"{kind} of {n}": x for n, own in wrong.items()
               for kind, x in zip(("gain", "bias"), own, strict=True)}  # fmt: skip
    at = _Motion(found, **{"L.p": 1.5, "J.p": 10.0, "U": 20.0}, **signals)
    assert at["w"] == pytest.approx(3.0 * 2.5 + 0.5)  # what is told of it
    assert at.rates["L.p"] == pytest.approx((0.5 * 20.0 - 4.0) - (2.0 * 3.0 + 1.0) * 3.0 - 5.0)
    assert at.rates["J.p"] == pytest.approx(2.0 * 3.0 - 7.0 * 2.5)


def test_an_encoder_counts_wrong_from_then_on() -> None:
    text = """param J = 4\n1:s { <- Se:T; -> I:J; -> Df:w }
sensor a : rad = int(s.f) counts 500/turn"""
    found = _equations(text, modes={}, disturbed=("a",))
    names = [s.name for s in found.states]
    assert "a.counted" in names and len(names) == 3
    known = dict.fromkeys(names, 0.0) | {"J.p": 10.0, "a.counted": 7.0}
    at = _Motion(found, **known, T=1.0, **{"gain of a": 3.0, "bias of a": 0.5})
    assert at.rates["a.counted"] == pytest.approx(3.0 * 2.5)
    assert at["a"] == pytest.approx(7.5)  # whatever the gain is now


_SWITCHED = """input on : bool; param R = 2; param C = 3
1:s when on { <- Se:u; -> R:R; -> 0:n }
n { -> C:C; -> R:leak = 5; -> De:y }"""


@pytest.mark.parametrize("on", [True, False])
def test_the_equations_are_those_of_a_mode(on: bool) -> None:
    found = _equations(_SWITCHED, modes={"on": on})
    assert found.modes == (("on", on),)
    at = _Motion(found, **{"C.q": 6.0, "u": 10.0})
    assert at.rates["C.q"] == pytest.approx((10.0 - 2.0) / 2.0 * on - 2.0 / 5.0)


def test_a_bridge_is_one_block_of_what_hangs_together() -> None:
    found = _equations("""Se:U -> 1:i -> 0:t; i -> Df:y; t -> 1:a -> 0:p; t -> 1:b -> 0:q
a -> R:R1 = 1; b -> R:R2 = 2; p -> 1:c -> q; c -> R:R3 = 3; p -> R:R4 = 4; q -> R:R5 = 5""")
    assert found.states == ()
    at = _Motion(found, U=10.0)
    g = 1.0 / np.arange(1.0, 6.0)
    matrix = [[g[0] + g[2] + g[3], -g[2]], [-g[2], g[1] + g[2] + g[4]]]
    p, q = np.linalg.solve(matrix, [10.0 * g[0], 10.0 * g[1]])
    assert at["y"] == pytest.approx((10.0 - p) * g[0] + (10.0 - q) * g[1])


@pytest.mark.parametrize(
    ("parts", "words"),
    [(1, "`s1`, `q1`:"), (2, "`s1`, `q1`, `s2`, `q2`:"), (5, "`s1`, `q1`, `s2`, `q2` and 6 more:")],
)
def test_what_contradicts_in_a_mode_is_told_by_its_elements(parts: int, words: str) -> None:
    """A pump that a valve cuts off has nowhere to go."""
    lines = [
        f"1:s{k} when on {{ <- Sf:q{k}; -> R:r{k} = 1; -> De:y{k} }}" for k in range(1, parts + 1)
    ]
    text = "input on : bool\n" + "\n".join(lines).replace("-> De:y", "-> R:y").replace(
        " }", " = 2 }"
    )
    with pytest.raises(CompileError) as caught:
        _equations(text + "\nsensor z = q1", modes={"on": False})
    (error,) = [d for d in caught.value.diagnostics if d.code == "no-state-equations"]
    assert error.message.startswith(f"The plant has no motion that satisfies {words} these")
    assert len(error.labels) == min(2 * parts, 4)
    assert len(_equations(text + "\nsensor z = q1", modes={"on": True}).states) == 0


@pytest.mark.parametrize(
    "text",
    [
        _GEAR,
        _GEAR.replace("Se:F", "Sf:F"),
        "param a = 1; param b = 2\n0:n { <- Sf:i; -> C:a; -> C:b; -> R:r = 1; -> De:y }",
        "param a = 1; param b = 2\n0:n { <- Sf:i; -> C:b; -> C:a; -> R:r = 1; -> De:y }",
        "param a = 1; param b = 2\n1:s { <- Se:u; -> I:b; -> R:r = 1; -> Df:y }\ns -> I:a",
        "param m = 2; param M = 5\n1:w { -> I:M; -> Df:y }\n1:v { <- Se:F; -> I:m }\n"
        "v -> TF:n { f1 = 4*f2 } -> w",
    ],
)
def test_storages_in_integral_causality_are_the_states(text: str) -> None:
    """As the strokes of the bond graph say; the others follow from them."""
    model = Compilation(Source("m.bg", f"bg 1\nmodel M {{\n{text}\n}}\n"))
    told = {model.graph.nodes[s.node].path for s in model.integral.storages if s.integral}
    found = model.state_equations()
    assert {s.name.partition(".")[0] for s in found.states} == told
    others = {model.graph.nodes[s.node].path for s in model.integral.storages} - told
    assert {impulse.storage for impulse in found.dependent} == others
