"""What cancels takes no other term with it: laws in which a parameter, or a storage, drops out.

Two branches, each with its current measured, and a meter whose law does not depend on a parameter
`k` (or on a hidden charge) although it holds it, in a logarithm, a power or a quotient that has no
value where that is zero. The judge knows the physics by hand.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.adversary.judge import judge
from tests.adversary.plant import Plant
from tests.adversary.test_adversary import compiled, self_tests

#: The law of the meter in the model, its physics, and the parameters of it that are faults; the
#: first one cancels.
METERS = {
    "the Nernst voltage of two concentrations": (
        "Vt*log(one.f/Is) - Vt*log(two.f/Is)",
        "Vt*log(i/j)",
        "Is Vt",
    ),
    "the same, written with products": (
        "Vt*log(one.f*k) - Vt*log(two.f*k)",
        "Vt*log(i/j)",
        "k Vt",
    ),
    "a reference that is taken out again": ("log(one.f*k) - log(k) + two.f", "log(i) + j", "k"),
    "an angle between two sides of one scale": ("atan2(one.f*k, two.f*k)", "atan(i/j)", "k"),
    "powers of one scale": ("(one.f*k)^0.7*(two.f*k)^-0.7", "exp(0.7*log(i/j))", "k"),
    "roots of one scale": ("sqrt(one.f*k)*sqrt(two.f*k)/k", "sqrt(i*j)", "k"),
    "a factor of exponentials": ("exp(one.f + k)*exp(two.f - k)", "exp(i + j)", "k"),
    "a part that cancels beside one that must not": (
        "log(one.f*k) - log(two.f*k) + one.f*(k + two.f) - k*one.f + m*(one.f + 1) - m*one.f",
        "log(i/j) + i*j + m",
        "k m",
    ),
}


@pytest.mark.parametrize("name", METERS)
def test_a_parameter_that_cancels(name: str, tmp_path: Path) -> None:
    law, physics, own = METERS[name]
    text = f"""bg 1
model Meter {{
    param R1 = 2
    param R2 = 3
    param L1 = 1
    param L2 = 2
    {"; ".join(f"param {p} = 0.7" for p in own.split())}
    1:one {{ <- Se:U; -> R:R1; -> I:L1; -> Df:y1 }}
    1:two {{ <- Se:V; -> R:R2; -> I:L2; -> Df:y2 }}
    sensor y = {law}
}}
"""
    plant = Plant(
        "meter",
        text,
        "U - D(p) - R1*i; p - L1*i; V - D(q) - R2*j; q - L2*j",
        {"y1": "i", "y2": "j", "y": physics},
        3,
        params=f"R1 R2 L1 L2 {own}",
        inputs="U V",
        values={"p": 1.3, "q": 1.4, "i": 1.3, "j": 0.7},
    )
    path = tmp_path / "meter.bg"
    path.write_text(text, encoding="utf-8")
    answer = compiled(path, tmp_path / "out")
    gone = own.split()[0]
    # over a prime field a logarithm has no identities: there `gone` may seem to be seen
    wrong = [t for t in judge(plant, answer) if f"with {gone}" not in t and "by ranks" not in t]
    assert wrong == []
    self_tests(tmp_path / "out")


def test_a_product_of_states(tmp_path: Path) -> None:
    text = """bg 1
model Meter {
    param L1 = 1
    param L2 = 2
    1:one { <- Se:U; -> R:R1 = 2; -> I:L1; -> Df:y1 }
    1:two { <- Se:V; -> R:R2 = 3; -> I:L2; -> Df:y2 }
    sensor y = log(L1.p*L2.p) - log(one.f)
}
"""
    plant = Plant(
        "meter",
        text,
        "U - D(p) - 2*i; p - L1*i; V - D(q) - 3*j; q - L2*j",
        {"y1": "i", "y2": "j", "y": "log(L1*L2*j)"},
        3,
        params="L1 L2",
        inputs="U V",
        values={"p": 1.3, "q": 1.4, "i": 1.3, "j": 0.7},
    )
    path = tmp_path / "meter.bg"
    path.write_text(text, encoding="utf-8")
    # y1 stays in two logarithms whose difference does not depend on it
    wrong = [t for t in judge(plant, compiled(path, tmp_path / "out")) if "'y1': -1" not in t]
    assert [t for t in wrong if "with y1" not in t and "by ranks" not in t] == []
