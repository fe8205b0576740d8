"""Relations of rates alone are had from declared initial values, without a derivative."""

from __future__ import annotations

import contextlib
import io
from pathlib import Path

import numpy as np
import pytest

import bondgraph
from tests.simulation.machines import opened

ONCE = Path(__file__).resolve().parents[2] / "random" / "once"
SPRINGS = """
    input v : m/s unknown
    param c1 = 0.01 m/N
    param c2 = 0.02 m/N
    param x0 = 0.1 m
    Sf:v
    1:x
    v -> x
    0:a { <- x; -> C:c1(q0 = x0); -> De:F1 }
    0:b { <- x; -> C:c2(q0 = -0.3 m); -> De:F2 }
"""


def test_two_springs_on_a_velocity_that_is_not_known() -> None:
    """c1 F1 - x0 = c2 F2 + 0.3 is what both have been moved by."""
    (relation,) = (c := opened(SPRINGS)).residuals
    assert relation.residual.orders == {"F1": 0, "F2": 0}
    moved = np.cumsum(np.random.default_rng(3).normal(size=1000))
    right = np.column_stack([(0.1 + moved) / 0.01, (-0.3 + moved) / 0.02])
    engine = c.engine(native=False)
    assert [s.path for s in engine.signals] == ["F1", "F2"]
    found = engine.run(right)
    assert found.valid[-1] and abs(found.value).max() < 1e-9
    engine.reset()
    assert engine.run(right + [5.0, 0.0]).value[-1] == pytest.approx(0.01 * 5)  # an offset stays


def test_sympy_derives_it_and_so_does_its_script() -> None:
    found = opened(SPRINGS).derivation("r1")
    moves = [step.move for step in found[0].steps]
    assert not found[0].stopped
    assert moves[-2:] == ["close", "since"]
    script = found.script
    assert "assert vanishes(D(kept) - relation)" in script
    with contextlib.redirect_stdout(io.StringIO()):
        exec(compile(script, "derivation.py", "exec"), {"__name__": "__main__"})


@pytest.mark.parametrize(
    "text",
    [
        SPRINGS.replace("(q0 = x0)", ""),  # nobody knows how it begins
        SPRINGS.replace("-> De:F2", "-> De:F2; -> R:R = 3 N.s/m"),  # the damper takes of the rate
    ],
)
def test_where_more_than_rates_is_left_over_they_stay(text: str) -> None:
    for relation in opened(text).residuals:
        assert max(relation.residual.orders.values()) == 1, relation.closed_form


def test_what_holds_in_one_position_of_a_switch_is_not_kept_from_the_start() -> None:
    """While the junction is off a charge stands still, wherever it was when that began."""
    for relation in bondgraph.compile(ONCE / "off_twice.bg").residuals:
        assert relation.residual.differentiated == 0
