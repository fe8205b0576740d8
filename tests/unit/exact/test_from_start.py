"""States that no input, no other state and no fault takes from their declared initial values."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import bondgraph
from bondgraph.exact.from_start import from_start
from bondgraph.exact.plant import Plant
from tests.unit.exact.models import graph


def _held(text: str, seed: int = 1, differs: str = "") -> set[str]:
    """The initial values that are kept, by name, where one is perhaps not the declared one."""
    plant = Plant(graph(text))
    starts = {i.symbol.name: i for i, _, _ in plant.structure.declared_starts()}
    found = from_start(plant, seed, starts.get(differs))
    assert (found is plant) == (not found.structure.held)
    return {initial.symbol.name for initial in found.structure.held}


def _lag(*rates: str) -> str:
    """Charges h0, h1 ... that begin at zero, with their rates; u drives a current i beside them."""
    lines = ["model M { param R = 2; param k = 3; input u"]
    for at, rate in enumerate(rates):
        law = re.sub(r"h(\d+)", r"n\1.e", re.sub(r"\bi\b", "m.f", rate))
        lines.append(
            f"  0:n{at} {{ -> C:h{at}(q0 = 0) = 1 }}\n  Sf:s{at} = {law}\n  s{at} -> n{at}"
        )
    shown = " + ".join(f"n{k}.e" for k in range(len(rates)))
    lines.append(f"  Se:u -> 1:m {{ -> R:R; -> Df:i }}\n  sensor y = m.f + {shown} }}")
    return "\n".join(lines)


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize(
    ("rates", "kept"),
    [
        (("k*h0*i",), {0}),  # only itself could move it
        (("k*i",), set()),
        (("h1*i", "h0*i"), {0, 1}),  # each could move the other
        (("h1*i", "u"), set()),  # the second leaves, and takes the first along
        (("h1*i", "u", "h2*u"), {2}),
        (("h1*u", "h2*u", "h3*u", "h4*u", "u", "k*h5"), {5}),  # one after the other leaves
        (("max(h0, 0)*u",), {0}),
        (("max(u - 300, 0)",), set()),  # on one side of a limit only, and a far one
        (("if(abs(u) > 3, u, 0)",), set()),
        (("max(-k*u*u, 0)",), set()),  # where k has the other sign
        (("(k - 3)*u",), set()),  # a fault of k moves it
        (("(R - k)*h0 + h0^2",), {0}),
    ],
)
def test_what_keeps_its_start(rates: tuple[str, ...], kept: set[int], seed: int) -> None:
    assert _held(_lag(*rates), seed) == {f"h{k}.q0" for k in kept}


def test_a_start_that_differs_is_kept_by_nothing_that_it_moves() -> None:
    text = _lag("h0*i", "k*h1 + h0*u", "k*h2")
    assert _held(text) == {f"h{k}.q0" for k in range(3)}
    assert _held(text, differs="h0.q0") == {"h2.q0"}
    assert _held(text, differs="h1.q0") == {"h0.q0", "h2.q0"}


def test_a_chain_that_takes_too_many_rounds_to_leave_is_not_said_to_stay() -> None:
    """Of fifteen states each moves the one before it; twelve rounds do not see the first ones go,
    and nothing is claimed then."""
    rates = [f"h{k + 1}*u" for k in range(14)]
    assert _held(_lag(*rates, "u", "k*h15")) == set()
    assert _held(_lag(*rates[:5], "u", "k*h6")) == {"h6.q0"}


def test_a_start_that_rests_on_a_fault_is_no_start_to_keep() -> None:
    """The charge begins at what a parameter says, and that may be another one."""
    text = """model M {{ param a = 0; param R = 2; param k = 3
      1:s {{ <- C:c(q0 = {start}) {{ e = (k + a)*q }}; -> R:R; -> Df:i }}
      sensor y = c.e }}"""
    assert _held(text.format(start="0")) == {"c.q0"}
    assert _held(text.format(start="a")) == set()
    assert _held(text.format(start="1")) == set()


def test_where_a_law_has_no_value_at_the_start_nothing_is_held() -> None:
    assert _held(_lag("h0*u/h0")) == set()  # that is u
    assert _held(_lag("u*h0^(-1)*h0^2")) == {"h0.q0"}  # and that u*h0
    assert _held(_lag("u*log(h0)")) == set()
    assert _held(_lag("u/h0")) == set()


def test_in_some_position_of_a_switch_a_state_may_leave() -> None:
    text = _lag("if(on, u, h0*u)", "if(on, h1*u, 2*h1)")
    text = text.replace("input u", "input u; input on : bool")
    assert _held(text) == {"h1.q0"}


def test_all_positions_of_switches_are_tried_that_a_state_may_need_to_leave() -> None:
    """One of sixteen positions of four switches moves it."""
    text = _lag("s0*s1*s2*s3*u", "h1*s0*u")
    for at in range(4):
        text = text.replace("input u", f"input u; input s{at} : bool", 1)
    text = re.sub(r"s(\d)\*", r"if(s\1, 1, 0)*", text)
    assert _held(text) == {"h1.q0"}


@pytest.mark.parametrize("law", ["if(abs(u) > 40, u, 0)", "if(u > 40, u, 0)", "if(u < -40, u, 0)"])
def test_a_state_leaves_where_an_input_is_beyond_a_limit_wherever_that_is(law: str) -> None:
    """Numbers that are drawn are of about one: what is compared has to be drawn for a limit."""
    text = f"""bg 1
model M {{
    param R = 2; param k = 3; input u
    0:n0 {{ -> C:h0(q0 = 0) {{ e = k*q }} }}
    Sf:s0 = {law}
    s0 -> n0
    Se:u -> 1:m {{ -> R:R; -> Df:i }}
    sensor y = m.f + n0.e
}}
"""
    for seed in range(8):
        found = bondgraph.compile(Path("m.bg"), text=text, seed=seed).signatures
        seen = [{f for f in found.faults if r in found.seen_by(f)} for r in found.residuals]
        assert sorted(seen, key=sorted) == [{"R", "i", "u"}, {"i", "k", "u", "y"}]
