"""What cannot be is told, and what only looks so is not."""

from __future__ import annotations

import pytest

from bondgraph.compilation import compile as open_model

OURS = {"negative-coefficient", "wide-tolerance", "source-kind", "temperature-scale"}
CIRCUIT = "Se:U -> 1:i; i -> R:r = 1 Ohm; i -> I:l = 1 mH; i -> Df:y; "


def codes(body: str) -> list[tuple[str, str]]:
    """What is said of a model with this body, and how grave it is."""
    text = "bg 1\nmodel M {\n" + body.replace("; ", "\n") + "\n}\n"
    compilation = open_model(text=text)
    assert compilation.graph
    return [(d.code, d.severity) for d in compilation.report.diagnostics if d.code in OURS]


NEGATIVE = {
    "i -> C:c = -1 uF": "warning",
    "param C = -1 uF; i -> C:C": "warning",
    "param C = 1 uF; i -> C:c = -C/2": "warning",
    "param k = -3 V/C; i -> C:c { e = k*q }": "warning",
    "i -> I:c { p = -2 mH*f }": "warning",
    "i -> I:c { f = -p/2 mH }": "warning",
    "param R = -2 Ohm; i -> R:R": "info",
    "param R = 2 Ohm; i -> R:s { f = -e/R }": "info",
}


@pytest.mark.parametrize("body", NEGATIVE)
def test_a_negative_coefficient(body: str) -> None:
    assert codes(CIRCUIT + body) == [("negative-coefficient", NEGATIVE[body])]


@pytest.mark.parametrize(
    "body",
    [
        "i <- C:c = 1 uF",
        "param C : F; i -> C:C",
        "param a = -2 uF; param b = -3 V; i -> C:c = a*b/(1 V)",
        "i -> C:c { e = 1e6 V/C^3*q^3 - 2 V/C*q }",  # a spring that snaps through
        "i -> R:s { e = 2 V - 3 Ohm*f }",  # the line of a battery
        "i -> I:c { f = p/2 mH }",
    ],
)
def test_a_sign_that_may_be(body: str) -> None:
    assert codes(CIRCUIT + body) == []


TOLERANCES = {
    "param R = 2 Ohm +- 200%; i -> R:R": True,
    "param R = 2 Ohm +- 100%; i -> R:R": True,
    "param R = 2 Ohm +- 3 Ohm; i -> R:s = R/2": True,
    "i -> R:s = 2 Ohm +- 150%": True,
    "param R = 2 Ohm +- 99%; i -> R:R": False,
    "param R = 2 Ohm +- 150%; param S = 9 Ohm; i -> R:s = R + S": False,
    "param E = 2 V +- 150%; Se:E -> i": False,  # an offset of either sign
}


@pytest.mark.parametrize("body", TOLERANCES)
def test_a_tolerance_that_reaches_zero(body: str) -> None:
    assert codes(CIRCUIT + body) == [("wide-tolerance", "warning")] * TOLERANCES[body]


SOURCES = {
    "Se:W = 3 A -> 1:i; i -> R:r = 1 Ohm; i -> Df:y": True,
    "input W : A; Se:W -> 1:i; i -> R:r = 1 Ohm; i -> Df:y": True,
    "Sf:W = 3 N -> 0:i; i -> C:c = 1 m/N; i -> De:y": True,
    "Sf:W = 3 A -> 0:i; i -> R:r = 1 Ohm; i -> De:y": False,
    "Se:W = 3 A -> 1:i; i -> R:r { e = 2*f }; i -> Df:y": False,  # what the flow is stays open
    # a magnetic circuit: A is its effort, and V its flow
    "param n = 100; Se:U -> 1:i; i -> R:r = 1 Ohm; i -> GY:n -> 1:m; m -> C:P = 1 uH; "
    "Se:bias = 3 A -> m; i -> Df:y": False,
    # pseudo bond graphs: a temperature and a heat flow, a level and a volume flow
    "Sf:Q = 3 W -> 0:t; t -> R:r = 2 K/W; t -> De:y": False,
    "Sf:Q = 3 m^3/s -> 0:h; h -> C:A = 2 m^2; h -> De:y": False,
}


@pytest.mark.parametrize("body", SOURCES)
def test_a_source_of_the_other_kind(body: str) -> None:
    assert codes(body) == [("source-kind", "warning")] * SOURCES[body]


ROOM = "Sf:P -> 0:n; n -> C:c = 100 J/K; n -> 1:l; l -> R:r = 2 K/W; n -> De:y; "
TEMPERATURES = {
    "l -> Se:T = 20 degC": True,
    "param T = 68 degF; l -> Se:T": True,
    "const T0 = 20 °C; l -> Se:T = T0": True,
    "param T = 293 K; l -> Se:T": False,
    "input T : degC; l -> Se:T": False,  # what a log says has its own unit
    "param d = 3 degC; input T : K; l -> Se:T2 = T + d": False,
}


@pytest.mark.parametrize("body", TEMPERATURES)
def test_a_temperature_on_a_scale_with_its_own_zero(body: str) -> None:
    assert codes(ROOM + body) == [("temperature-scale", "info")] * TEMPERATURES[body]
