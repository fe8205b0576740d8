"""Units: the factors are the SI brochure's, the grammar that of the language."""

from __future__ import annotations

import doctest
import time
from fractions import Fraction
from math import isclose, pi, sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bondgraph.ir.unit import NONE, over, times
from bondgraph.library import units
from bondgraph.library.units import DOMAINS, describe, parse_unit, suggest_unit


def test_examples_in_docstrings() -> None:
    assert doctest.testmod(units).failed == 0


def _dimension(text: str) -> tuple[Fraction | int, ...]:
    unit = parse_unit(text)
    assert unit is not None, text
    return unit.dimension


@pytest.mark.parametrize(
    ("left", "right"),
    [
        ("N.m/A", "V.s/rad"),
        ("W", "V.A"),
        ("J", "N.m"),
        ("Pa", "N/m^2"),
        ("Wb", "V.s"),
        ("F", "C/V"),
        ("Ohm", "V/A"),
        ("Ω", "Ohm"),
        ("\N{OHM SIGN}", "Ohm"),
        ("S", "1/Ohm"),
        ("T", "Wb/m^2"),
        ("H", "Wb/A"),
        ("Hz", "1/s"),
        ("turn", "1"),
        ("N.m.s/rad", "J.s"),
        ("m^3/s.Pa^-0.5", "m^3/s/Pa^0.5"),
        ("W/K", "J/s/K"),
        ("degC", "K"),
        ("kat", "mol/s"),
    ],
)
def test_same_dimension(left: str, right: str) -> None:
    assert _dimension(left) == _dimension(right)


@pytest.mark.parametrize(
    ("text", "factor"),
    [
        ("uH", Fraction(1, 10**6)),
        ("µs", Fraction(1, 10**6)),
        ("g", Fraction(1, 1000)),
        ("kg", Fraction(1)),
        ("mg", Fraction(1, 10**6)),
        ("min", Fraction(60)),
        ("h", Fraction(3600)),
        ("l/min", Fraction(1, 60000)),
        ("bar", Fraction(100000)),
        ("mbar", Fraction(100)),
        ("MPa", Fraction(10**6)),
        ("kW.h", Fraction(3600000)),
        ("kWh", Fraction(3600000)),
        ("cm^2", Fraction(1, 10**4)),
        ("N/mm^2", Fraction(10**6)),
        ("%", Fraction(1, 100)),
        ("t/h", Fraction(1000, 3600)),
        ("kPa^0.5.kPa^0.5", Fraction(1000)),
        ("mm^-0.5.mm^1.5", Fraction(1, 1000)),
        ("cm^0.5/cm^2.5", Fraction(10**4)),
        ("m^3/h.bar^-1", Fraction(1, 3600 * 10**5)),
        ("inch", Fraction(254, 10000)),
        ("cd", Fraction(1)),
        ("Pa", Fraction(1)),
        ("dam", Fraction(10)),
    ],
)
def test_exact_factor(text: str, factor: Fraction) -> None:
    unit = parse_unit(text)
    assert unit is not None
    assert unit.factor == factor


@pytest.mark.parametrize(
    ("text", "factor"),
    [
        ("rpm", 2 * pi / 60),
        ("deg", pi / 180),
        ("turn", 2 * pi),
        ("bar^0.5", sqrt(1e5)),
        ("m^3/s.bar^-0.5", 1 / sqrt(1e5)),
        ("psi", 6894.757293168361),
        ("km^0.333", 1000**0.333),
        ("hp", 745.6998715822702),
    ],
)
def test_factor_of_pi_and_roots(text: str, factor: float) -> None:
    unit = parse_unit(text)
    assert unit is not None
    assert isclose(unit.factor, factor, rel_tol=3e-16)


def test_a_slash_divides_only_what_follows_it() -> None:
    assert _dimension("J/kg.K") == times(over(_dimension("J"), _dimension("kg")), _dimension("K"))


@pytest.mark.parametrize(
    "text",
    ["", ".", "/s", "m.", "m..s", "m^", "m^x", "m ^2", "N m", "N*m", "J/(kg.K)", "Nm", "2", "m^1e9",
     "m^999999999", "kkg", "mmin", "m^0.0000001", "1/", "-m", "m^--2", "²"],
)  # fmt: skip
def test_no_unit(text: str) -> None:
    assert parse_unit(text) is None


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("Nm", "N.m"),
        ("Nms", "N.m.s"),
        ("Nm/A", "N.m/A"),
        ("N*m", "N.m"),
        ("kg.m²", "kg.m^2"),
        ("kgm2", "kg.m^2"),
        ("m/s2", "m/s^2"),
        ("m/s**2", "m/s^2"),
        ("J/(kg.K)", "J/kg/K"),
        ("Volts", "V"),
        ("ohm", "Ohm"),
        ("OHM", "Ohm"),
        ("pa", "Pa"),
        ("RPM", "rpm"),
        ("As", "A.s"),
        ("sec", "s"),
        ("N·m", "N.m"),
        ("turns", "turn"),
        ("barr", "bar"),
        ("Ohmm", "Ohm"),
        ("Nmm", "N.mm"),
        ("qqqq", None),
        ("", None),
        ("(((", None),
    ],
)
def test_suggestion(text: str, meant: str | None) -> None:
    assert suggest_unit(text) == meant


def test_every_name_is_known_and_suggestions_are_units() -> None:
    for name in units._entries():
        assert parse_unit(name) is not None, name
    for word in units._WORDS:
        meant = suggest_unit(word)
        assert parse_unit(word) or (meant and parse_unit(meant)), word
    for text in units._WRITTEN.split():
        assert parse_unit(text) is not None, text


@given(st.lists(st.integers(-12, 12), min_size=7, max_size=7))
def test_description_is_a_unit_of_the_dimension(quarters: list[int]) -> None:
    exponents = tuple(Fraction(q, 4) for q in quarters)
    unit = parse_unit(describe(exponents))
    assert unit is not None
    assert unit.dimension == exponents
    assert unit.factor == 1


@given(st.text(max_size=12) | st.text("NmAsVk./^-10²()µ*% ", max_size=12))
def test_any_text_is_a_unit_or_none(text: str) -> None:
    parse_unit(text)
    meant = suggest_unit(text)
    assert meant is None or parse_unit(meant) is not None


@pytest.mark.parametrize(
    ("text", "said"),
    [("V/A", "Ohm"), ("Wb", "N.m/A"), ("kg.m^2", "kg.m^2"), ("N.s/m", "kg/s"), ("m/m", "1"),
     ("W.s", "N.m"), ("m^3/s", "m^3/s"), ("1/s", "rad/s"), ("Pa.s/m^3", "Pa.s/m^3"),
     ("V.s.A^2/rad", "N.m.A"), ("N.m.s.A", "N.m.s.A")],
)  # fmt: skip
def test_description(text: str, said: str) -> None:
    assert describe(_dimension(text)) == said


@pytest.mark.parametrize("name", ["electrical", "rotation", "translation", "hydraulic", "thermal",
                                  "chemical"])  # fmt: skip
def test_effort_times_flow_is_power(name: str) -> None:
    domain = DOMAINS[name]
    assert domain.effort is not None and domain.flow is not None
    assert times(domain.effort, domain.flow) == _dimension("W")


def test_any_domain_fixes_nothing() -> None:
    assert DOMAINS["any"].effort is None and DOMAINS["any"].flow is None
    assert over(NONE, NONE) == NONE


def test_a_long_unit_that_is_none_is_answered_at_once() -> None:
    start = time.perf_counter()
    for text in ("s" * 50, "m" * 59, "Ns" * 29, "m/" + "s" * 40, "kgm" * 2000):
        assert suggest_unit(text) is None or len(text) < 61
    assert time.perf_counter() - start < 5.0
