"""Loops that are singular at the nominal values only, against determinants by hand and by SymPy."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import pytest
import sympy

from bondgraph.compilation import Compilation
from bondgraph.text.diagnostic import Diagnostic
from bondgraph.text.source import Source


def warnings(text: str) -> list[Diagnostic]:
    compilation = Compilation(Source("m.bg", f"bg 1\nmodel M {{\n{text}\n}}\n"))
    assert compilation.equations.equations
    return [d for d in compilation.report.diagnostics if d.code == "loop-gain-one"]


FEEDBACK = (
    "param A = {}; param R1 = {}; param R2 = {}; Se:U -> 1:i; Se:fb = A*out.e -> i; i -> R:R1; "
    "i -> 0:out; out -> R:R2; out -> De:y"
)


@pytest.mark.parametrize(
    ("a", "r1", "r2", "singular"),
    [
        # i (R1 + R2 - A R2) = U
        ("2", "2", "2", True),
        ("1.5", "1", "2", True),
        ("1.1", "0.3", "3", True),  # decimals are exact: no rounding comes between
        ("2.0000001", "2", "2", False),
        ("1", "2", "2", False),
        ("-2", "2", "2", False),
    ],
)
def test_feedback(a: str, r1: str, r2: str, singular: bool) -> None:
    numbers = [Fraction(x) for x in (a, r1, r2)]
    assert (numbers[1] + numbers[2] - numbers[0] * numbers[2] == 0) == singular
    found = warnings(FEEDBACK.format(a, r1, r2))
    assert len(found) == singular
    for d in found:
        assert d.severity == "warning"
        assert "the loop of Se:fb, R:R1 and R:R2 has the gain 1" in d.message
        assert f"A = {a}, R1 = {r1} and R2 = {r2} cancel in it." in d.help
        assert [label.span.text.split()[0] for label in d.labels] == ["Se:fb", "R:R1", "R:R2"]


@pytest.mark.parametrize(
    ("text", "count"),
    [
        # e1 = n e2 beside e1 = e2: undetermined at n = 1, zero elsewhere
        ("param n = 1; 0:a -> TF:n { e1 = n*e2 } -> 0:b; a -> b; Sf:q -> a; b -> R:r = 2", 1),
        ("param n = 2; 0:a -> TF:n { e1 = n*e2 } -> 0:b; a -> b; Sf:q -> a; b -> R:r = 2", 0),
        # m (1/R1 + 1/R2 + 1/Rm) = y/R1 + w/R2
        (
            "param Rm = -1; Sf:q -> 0:a; a -> C:Ca = 1; a -> 1:x -> 0:m; x -> R:R1 = 2; m -> R:Rm; "
            "m -> 1:z -> 0:b; z -> R:R2 = 2; b -> C:Cb = 1; b -> De:w",
            1,
        ),
        # the same with a storage at the node: its equation is a differential one
        (
            "param Rm = -1; Sf:q -> 0:a; a -> C:Ca = 1; a -> 1:x -> 0:m; x -> R:R1 = 2; m -> R:Rm; "
            "m -> 1:z -> 0:b; z -> R:R2 = 2; b -> C:Cb = 1; b -> De:w; m -> C:Cm = 1",
            0,
        ),
        # parameters of which one is defined by the others
        (
            "param R1 = 2; param A = (R1 + 1)/1; Se:U -> 1:i; Se:fb = A*out.e -> i; i -> R:R1; "
            "i -> 0:out; out -> R:R2 = 1; out -> De:y",
            1,
        ),
        # nothing but numbers: singular for all values, which is another's finding
        ("0:a -> TF:n { e1 = 1*e2 } -> 0:b; a -> b; Sf:q -> a; b -> R:r = 2", 0),
        # a leak that is nominally none, beside a loop that is sound
        (
            "param leak = 0; Se:U -> 1:i; i -> R:R1 = 2; i -> 0:m; m -> R:R2 = 3; "
            "m -> R:l { f = leak*e }; m -> De:y",
            0,
        ),
        # two loops of their own, both singular
        (
            "param A = 2; param B = 3; Se:U -> 1:i; Se:fa = A*a.e -> i; i -> R:R1 = 1; i -> 0:a; "
            "a -> R:R2 = 1; a -> De:y; Se:V -> 1:j; Se:fb = B*b.e -> j; j -> R:R3 = 2; j -> 0:b; "
            "b -> R:R4 = 1; b -> De:z",
            2,
        ),
        # a law that is not linear has the slope that its signal gives it
        (
            "param A = 2; Se:U -> 1:i; Se:fa = A*a.e -> i; i -> R:R1 { e = f + f^3 }; i -> 0:a; "
            "a -> R:R2 = 1; a -> De:y",
            0,
        ),
    ],
)
def test_loops_of_the_junction_structure_and_of_elements(text: str, count: int) -> None:
    assert len(warnings(text)) == count


def test_only_what_takes_part_is_named() -> None:
    (found,) = warnings(FEEDBACK.format("1", "0", "2"))  # whatever R2 is
    assert "the loop of Se:fb and R:R1 has the gain 1" in found.message
    assert "A = 1 and R1 = 0 cancel in it." in found.help


def determinant(size: int, pairs: list[tuple[int, int]], values: list[Fraction]) -> Fraction:
    """Of the conductance matrix of the inner nodes 1..size (Maxwell 1873)."""
    matrix = sympy.zeros(size, size)
    for (a, b), g in zip(pairs, values, strict=True):
        for one, other in ((a, b), (b, a)):
            if 1 <= one <= size:
                matrix[one - 1, one - 1] += sympy.Rational(g.numerator, g.denominator)
                if 1 <= other <= size:
                    matrix[one - 1, other - 1] -= sympy.Rational(g.numerator, g.denominator)
    found = matrix.det()
    return Fraction(int(found.p), int(found.q))


def net(seed: int) -> tuple[str, bool]:
    """Inner nodes between two given voltages, and whether Kirchhoff's equations are singular.

    In every other net one conductance is such that the determinant, linear in it, vanishes.
    """
    random = Random(seed)
    size = random.choice([2, 3])
    pairs = [(k, k + 1) for k in range(size + 1)] + [(0, 2), (1, size + 1)]
    values = [Fraction(random.choice([-2, -1, 1, 1, 2, 3])) for _ in pairs]
    if seed % 2:
        at = random.randrange(len(pairs))
        zero, one = (
            determinant(size, pairs, [*values[:at], Fraction(g), *values[at + 1 :]]) for g in (0, 1)
        )
        if one != zero:
            values[at] = -zero / (one - zero)
    lines = ["Se:U -> 0:n0", f"Se:V -> 0:n{size + 1}", *[f"0:n{k + 1}" for k in range(size)]]
    for at, ((a, b), g) in enumerate(zip(pairs, values, strict=True)):
        lines.append(f"param G{at} = {g.numerator}/{g.denominator}")
        lines.append(f"n{a} -> 1:b{at} -> n{b}; b{at} -> R:r{at} {{ f = G{at}*e }}")
    return "; ".join(lines), determinant(size, pairs, values) == 0


NETS = [net(seed) for seed in range(60)]


def test_nets_of_resistances_of_both_signs() -> None:
    assert 20 <= sum(singular for _, singular in NETS) <= 40
    for text, singular in NETS:
        assert bool(warnings(text)) == singular, text


def test_the_first_node_of_a_model_takes_part_as_well() -> None:
    text = FEEDBACK.format("2", "2", "2").replace("Se:U -> 1:i", "R:R1 <- 1:i; Se:U -> i")
    (found,) = warnings(text.replace("; i -> R:R1", ""))
    assert "the loop of R:R1, Se:fb and R:R2 has the gain 1" in found.message
    assert [label.span.text.split()[0] for label in found.labels] == ["R:R1", "Se:fb", "R:R2"]


def test_a_loop_with_one_element_is_that_of_all_its_nodes() -> None:
    (found,) = warnings(
        "param n = 1; 0:a -> TF:n { e1 = n*e2 } -> 0:b; a -> b; Sf:q -> a; b -> R:r = 2"
    )
    assert "the loop of 0:a, TF:n and 0:b has the gain 1" in found.message
    assert found.help.startswith("n = 1 makes it so. The relations")


def test_a_loop_of_numbers_that_no_parameter_leads_out_of() -> None:
    """The gain 2*3/6 of numbers is no finding of this pass; with a parameter that cancels it is."""
    (found,) = warnings(
        "param R1 = 1; param R2 = 1; Se:U -> 1:i; Se:fb = 2*out.e -> i; i -> R:R1; i -> 0:out; "
        "out -> R:R2; out -> De:y"
    )
    assert found.help.startswith("R1 = 1 and R2 = 1 cancel in it. The relations")


@pytest.mark.parametrize(("count", "told"), [(1, 1), (3, 3), (4, 3)])
def test_no_more_than_three_loops_are_told(count: int, told: int) -> None:
    one = (
        "param A{0} = 2; Se:U{0} -> 1:i{0}; Se:f{0} = A{0}*o{0}.e -> i{0}; i{0} -> R:r{0} = 1; "
        "i{0} -> 0:o{0}; o{0} -> R:s{0} = 1; o{0} -> De:y{0}"
    )
    found = warnings("; ".join(one.format(k) for k in range(count)))
    assert len(found) == told


@pytest.mark.parametrize("resistances", [3, 6, 8])
def test_no_more_than_six_places_of_a_loop_are_shown(resistances: int) -> None:
    """A = R1 + ... + Rn + Ro, of a resistance of 1 at the output."""
    ladder = "; ".join(f"i -> R:r{k} {{ e = {k + 1}*f }}" for k in range(resistances))
    gain = sum(range(1, resistances + 1)) + 1
    (found,) = warnings(
        f"param A = {gain}; Se:U -> 1:i; Se:fb = A*out.e -> i; {ladder}; i -> 0:out; "
        "out -> R:ro = 1; out -> De:y"
    )
    assert len(found.labels) == min(resistances + 2, 6)
