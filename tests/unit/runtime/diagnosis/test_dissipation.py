"""Which sign a leak or a friction that is not there yet may take: no R delivers power."""

from __future__ import annotations

import pytest

import bondgraph
from bondgraph.runtime.diagnosis.dissipation import dissipating_signs


@pytest.mark.parametrize(("law", "sign"), [
    ("{ f = p*ssqrt(e) }", 1),  # e f = p |e|^1.5
    ("{ f = -p*ssqrt(e) }", -1),
    ("{ f = p*sqrt(max(e, 0)) }", 1),  # a check valve: nothing the other way
    ("{ e = p*tanh(f/0.1) }", 1),
    ("{ e = p*f*abs(f) }", 1),
    ("{ 0 = f - p*e }", 1),
    ("= p", 1),  # e = p f
    ("{ f = (k + p)*ssqrt(e) }", None),  # dissipates with either, as long as p > -k
    ("{ f = p*e^2 }", None),  # e f = p e^3: delivers power on one side with either
    ("{ f = p*ssqrt(e)*y }", None),  # y may be of either sign
    ("{ 0 = p*e + f + f^3 }", None),  # neither is had without solving a cubic
])  # fmt: skip
def test_the_sign_with_which_an_r_dissipates(law: str, sign: int | None) -> None:
    text = f"0:n {{ <- Sf:Q; -> C:c = 2; -> R:r {law}; -> De:y }}"
    model = bondgraph.compile(text=f"bg 1\nmodel M {{ param p = 0; param k = 1\n{text} }}")
    assert dissipating_signs(model.graph).get("p") == sign


def test_two_r_that_contradict_each_other_tell_nothing() -> None:
    text = "0:n { <- Sf:Q; -> C:c = 2; -> R:a { f = p*e }; -> R:b { f = -p*ssqrt(e) }; -> De:y }"
    model = bondgraph.compile(text=f"bg 1\nmodel M {{ param p = 0\n{text} }}")
    assert dissipating_signs(model.graph) == {}


def test_what_is_no_r_or_not_zero_may_be_anything() -> None:
    text = "0:n { <- Sf:Q; -> C:c = 2; -> Sf:s = p*ssqrt(n.e); -> R:r { f = k*ssqrt(e) }; -> De:y }"
    model = bondgraph.compile(text=f"bg 1\nmodel M {{ param p = 0; param k = 1\n{text} }}")
    assert dissipating_signs(model.graph) == {}
