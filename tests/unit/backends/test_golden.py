"""The reference evaluation is right where the answer is known otherwise."""

from __future__ import annotations

import math
from decimal import Decimal
from fractions import Fraction

import pytest

from bondgraph.backends import forty_digits as module
from bondgraph.backends.blocks import lines
from bondgraph.backends.forty_digits import Evaluation, value
from bondgraph.backends.golden import Vector, _orders, golden, inputs
from bondgraph.compilation import Compilation
from bondgraph.ir.program import Assign, Const, Function, Known, PolynomialTape, Product, Ref
from bondgraph.text.source import Source
from tests.unit.backends import programs


def _ladder(cells: int) -> list[Fraction]:
    """v/y of a chain of RC cells as polynomial in p, cell by cell from the open end."""
    resistance, capacity = Fraction(3.2) / cells, Fraction(1.1e-2) / 2  # per time_unit 0.5
    v, i = [Fraction(1)], [Fraction(0)]
    for _ in range(cells):
        size = max(len(v), len(i))
        v = [*v, *[Fraction(0)] * (size - len(v))]
        v = [a + resistance * b for a, b in zip(v, [*i, *[Fraction(0)] * size], strict=False)]
        i = [*i, *[Fraction(0)] * (len(v) + 1 - len(i))]
        i = [b + (capacity * v[k - 1] if k else 0) for k, b in enumerate(i)]
    return v


def _coefficients(cells: int) -> list[module.Value]:
    program = programs.ladder(cells)
    run = Evaluation(program)
    options = {"sample_time": 0.001, "bandwidth": 20.0, "time_unit": 0.5}
    run.configure(
        {"R": value(3.2), "C": value(1.1e-2)}, {name: value(x) for name, x in options.items()}
    )
    return [run.values[Ref("coef", "y_polynomial", k)] for k in range(cells + 1)]


@pytest.mark.parametrize(("number", "power", "wanted"), [
    (0.0, 1, (0.0, 0.5)), (0.0, 3, (0.0, 0.0)), (2.0, 3, (8.0, 12.0)), (4.0, -1, (0.25, 0.25)),
])  # fmt: skip
def test_a_power_is_as_large_as_what_its_base_was_added_up_from_makes_it(
    number: float, power: int, wanted: tuple[float, float]
) -> None:
    size = 0.5 if number == 0.0 else 1.0
    found = module.Value(Decimal(number), size) ** power
    assert (float(found), found.size) == wanted  # |n x^(n-1)| size, the number itself at least


@pytest.mark.parametrize("many", [10**9, 0], ids=["40 digits", "double"])
def test_a_tape_is_the_polynomial_of_the_chain(many: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_MANY", many)
    wanted = _ladder(20)
    for found, exact in zip(_coefficients(20), wanted, strict=False):
        tolerance = Decimal("1e-26") if many else Decimal("1e-14")
        number = Decimal(exact.numerator) / Decimal(exact.denominator)
        assert abs(found.number - number) <= tolerance * max(abs(number), Decimal("1e-300"))
        assert found.size == pytest.approx(float(exact))  # all terms are positive


def test_the_size_says_what_cancels() -> None:
    """1000.001 - 1000 is 0.001, from terms of 2000."""
    run = Evaluation(programs.motor())
    run.values = {Ref("known", "U"): value(1000.001), Ref("known", "y"): value(1000.0)}
    run.run([programs.put("local:d", programs.minus(*run.values))])
    found = run.values[Ref("local", "d")]
    assert float(found.number) == pytest.approx(0.001, rel=1e-9)
    assert found.size == pytest.approx(2000.001)


@pytest.mark.parametrize(
    ("name", "args", "wanted"),
    [
        ("ssqrt", (-4.0,), -2.0),
        ("ssq", (-3.0,), -9.0),
        ("sign", (-3.0,), -1.0),
        ("pow", (2.0, -2.0), 0.25),
        ("pow", (2.0, 0.5), math.sqrt(2.0)),
        ("min", (2.0, 1.0), 1.0),
        ("atan2", (1.0, 1.0), math.pi / 4.0),
        ("table:pump", (0.25,), 1.0),
        ("table:pump", (9.0,), -1.0),
        ("table:constant.csv", (-7.0,), 3.5),
    ],
)
def test_functions(name: str, args: tuple[float, ...], wanted: float) -> None:
    run = Evaluation(programs.functions())
    run.run([programs.put("local:f", Function(name, tuple(map(Const, args))))])
    assert float(run.values[Ref("local", "f")].number) == pytest.approx(wanted, rel=1e-15)


@pytest.mark.parametrize("make", programs.ALL, ids=lambda m: m.__name__)
def test_vectors_are_there_and_the_same_each_time(make: programs.Maker) -> None:
    found = golden(make())
    assert found == golden(make())
    assert found.exact and found.step
    for vector in (*found.exact, *found.step):
        told = [(value, size) for value, size in vector.results if not math.isnan(value)]
        assert all(abs(value) <= size for value, size in told)
        missing = sum(r.unwritten != "" for r in make().residuals) if vector in found.exact else 0
        assert len(told) == len(vector.results) - missing


def test_signals_lie_where_the_law_has_a_value() -> None:
    """A logarithm of a signal: the vectors are positive."""
    program = programs.motor()
    law = programs.put("residual:r1", Function("log", (Ref("known", "U"),)))
    found = golden(program._replace(exact=(law, program.exact[1])))
    assert found.exact and all(v.values[Ref("known", "U")] > 0.0 for v in found.exact)


def test_a_root_of_what_cancels_is_as_large_as_what_it_is_made_of() -> None:
    """Nothing is left of 1000 - 1000, and a little less has no root."""
    run = Evaluation(programs.motor())
    run.values = {Ref("known", "U"): value(1000.0), Ref("known", "y"): value(1000.0)}
    run.run([programs.put("local:d", Function("sqrt", (programs.minus(*run.values),)))])
    found = run.values[Ref("local", "d")]
    assert float(found) == 0.0 and 1.0 < found.size < math.inf


def test_signals_that_are_alike_may_cancel_in_a_divisor() -> None:
    """1/(U - y) has no value where all signals are the same, as they are to begin with."""
    program = programs.motor()
    U, y = Ref("known", "U"), Ref("known", "y")
    law = programs.put("residual:r1", programs.over(Const(1.0), programs.minus(U, y)))
    found = golden(program._replace(exact=(law, program.exact[1]))).exact
    assert found
    for vector in found:
        wanted = 1.0 / (vector.values[U] - vector.values[y])
        assert vector.results[0][0] == pytest.approx(wanted)


def test_samples_are_taken_as_long_as_results_are_finite() -> None:
    """A state that grows is larger than any number in the end."""
    program = programs.motor()
    x, r1 = Ref("state", "x"), Ref("residual", "r1")
    grows = Assign(x, Product((Const(1e40), x)), "", None)
    told = Assign(r1, x, "", None)
    first = (Assign(x, Const(1.0), "", None), told)
    found = golden(program._replace(first=first, step=(grows, told))).step
    assert [v.results[0][0] for v in found[:3]] == pytest.approx([1.0, 1e40, 1e80])
    assert len(found) == 8
    assert all(math.isfinite(n) for v in found for pair in v.results for n in pair)


def test_every_tape_is_found() -> None:
    assert any(isinstance(s, PolynomialTape) for s in programs.ladder().configure)


def test_many_derivatives_are_tried_once_and_as_they_come(monkeypatch: pytest.MonkeyPatch) -> None:
    """Few are scaled by powers of two, so that each is felt as much as the signals."""
    program = programs.motor()
    refs = list(inputs(program))
    rates = [ref for ref in refs if ref.space == "known" and ref.order > 0]
    assert 0 < len(rates) < len(refs)

    def vectors(many: int) -> tuple[Vector, ...]:
        monkeypatch.setattr("bondgraph.backends.golden._MANY", many)
        return golden(program).exact

    assert [len(vectors(many)) for many in (len(refs), len(refs) - 1)] == [4, 1]
    scaled, plain = vectors(len(rates))[0].values, vectors(len(rates) - 1)[0].values
    shares = {ref: scaled[ref] / plain[ref] for ref in refs if plain[ref]}
    assert all(share == 1.0 for ref, share in shares.items() if ref not in rates)
    powers = [math.log2(shares[ref]) for ref in rates if ref in shares]
    assert any(powers) and all(power == round(power) for power in powers)


_LATE = """bg 1
model M { param C = 2; param k = 3
0:t { <- Sf:Q; -> C:C; -> R:v { f = k*delay(h, 0.5) }; -> De:h } }"""


@pytest.mark.parametrize(
    ("rate", "kept", "samples"), [(2.0, 4, 16), (20.0, 13, 25), (1000.0, 503, 16)]
)
def test_as_many_samples_as_are_remembered_and_a_dozen_more(
    rate: float, kept: int, samples: int
) -> None:
    """Sixteen at least; where there are hundreds, step is tried before it has a value."""
    program = Compilation(Source("m.bg", _LATE)).with_options(rate=rate).program
    (line,) = lines(program).values()
    assert line.length == kept  # half a second, and three that are beside it
    assert len(golden(program).step) == samples
    assert len(golden(programs.motor()).step) == 16


def test_what_exact_takes_of_a_signal() -> None:
    """Its derivatives from itself up, its integral, and nothing of itself for that alone."""
    y = Known("y", "y", "", "", "sensor", 2, False, None, None)
    told = {
        "derivatives": y,
        "itself": y._replace(highest=0),
        "its integral": y._replace(highest=-1, integral=True, lowest=-1),
        "both": y._replace(highest=1, integral=True, lowest=-1),
        "nothing is itself": y._replace(highest=-1),
    }
    found = {name: [ref.order for ref in _orders(known)] for name, known in told.items()}
    assert found == {
        "derivatives": [0, 1, 2], "itself": [0], "its integral": [-1], "both": [0, 1, -1],
        "nothing is itself": [0],
    }  # fmt: skip
