"""How many samples a signal's line remembers."""

from __future__ import annotations

import math

import pytest

from bondgraph.backends.blocks import NEAR, lines, recalled
from bondgraph.ir.program import Delayed, Program
from tests.unit.backends import programs
from tests.unit.backends.programs import known, minus, put, ref, residual


def _late(*seconds: float, rate: float = 1000.0) -> Program:
    """y less what U was some time ago, for each of the delays."""
    past = tuple(Delayed(known(f"U_{k}"), "U", s) for k, s in enumerate(seconds))
    each = [put(f"residual:r{k}", minus(ref("known:y"), ref(f"known:{p.known.name}")))
            for k, p in enumerate(past)]  # fmt: skip
    return programs.program(
        "Late",
        tuple(residual(f"r{k}", ("y",)) for k in range(len(past))),
        knowns=(known("U", kind="input"), known("y")),
        first=tuple(each),
        step=tuple(each),
        rate=rate,
        delayed=past,
    )


@pytest.mark.parametrize(("samples", "rate"), [(0.25, 10.0), (10, 1000.0), (10.5, 8.0), (1e6, 1e3)])
def test_a_line_is_just_long_enough_for_the_shortest_sample_time(
    samples: float, rate: float
) -> None:
    """Which is two millionths shorter than what the code was made for."""
    (line,) = lines(_late(samples / rate, rate=rate)).values()
    back = samples / (1.0 - 2e-6)
    assert not math.isnan(recalled([0.0] * line.length, back))
    assert math.isnan(recalled([0.0] * (line.length - 2), back))


def test_delays_of_one_signal_share_the_line_of_the_longest() -> None:
    (line,) = lines(_late(0.010, 0.030, 0.020)).values()
    assert line.length == lines(_late(0.030))["U"].length
    assert [past.seconds for past in line.past] == [0.010, 0.030, 0.020]
    assert lines(programs.motor()) == {}


def test_a_delay_that_no_step_reads_has_no_line() -> None:
    program = _late(0.010, 0.030)
    (line,) = lines(program._replace(step=program.step[:1], first=program.first[:1])).values()
    assert [past.known.name for past in line.past] == ["U_0"]


@pytest.mark.parametrize(
    ("back", "value"),
    [(0, 4.0), (1, 2.0), (2, 1.0), (1.25, 1.75), (NEAR / 2, 4.0), (1 - NEAR / 2, 2.0),
     (2 + NEAR / 2, 1.0), (2 + 2 * NEAR, math.nan), (3, math.nan)],
)  # fmt: skip
def test_what_was_between_two_samples_is_on_a_straight_line(back: float, value: float) -> None:
    """So near to a sample that it is that one, nothing before it need be there."""
    found = recalled([1.0, 2.0, 4.0], back)
    assert found == value or (math.isnan(found) and math.isnan(value))
