"""Choices whose sides need work of their own, in the languages that the code is written in."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bondgraph.compilation import Compilation
from bondgraph.ir.program import Branch
from bondgraph.text.source import Source

#: What is above the root is there twice, so that it gets a name; below one it has no value.
_LAW = """bg 1
model M {
  input U
  1:s { <- Se:u = U; -> R:r { e = if(f > 1, sqrt(f - 1)*(2 + sqrt(f - 1)), f - 1) }; -> Df:i }
}
"""


def _law(i: float) -> float:
    root = math.sqrt(i - 1.0) if i > 1.0 else 0.0
    return root * (2.0 + root) if i > 1.0 else i - 1.0


@pytest.mark.parametrize("native", [False, True])
def test_only_the_side_that_is_taken_is_computed(native: bool) -> None:
    """u less the law, by hand; on the other side the root of a negative number has no value."""
    c = Compilation(Source("m.bg", _LAW), "M")
    (choice,) = [s for s in c.program.step if isinstance(s, Branch)]
    assert choice.yes and not choice.no
    engine = c.engine(native=native)
    currents = [-3.0, 0.0, 0.5, 1.25, 5.0, 0.0, 2.0]
    held = np.repeat(currents, 1000)  # until the filter has forgotten what was before
    columns = {"U": np.full(len(held), 7.0), "i": held}
    found = engine.run(np.column_stack([columns[k.path] for k in engine.signals]))
    assert found.valid[999::1000].all()
    expected = [7.0 - _law(i) for i in currents]
    assert np.abs(found.value[999::1000, 0]) == pytest.approx(np.abs(expected), rel=1e-6)
