"""A tank with a measured inflow and a gauge, sampled once a second."""

from __future__ import annotations

from functools import cache

from bondgraph.compilation import Compilation
from bondgraph.text.source import Source

_TEXT = """bg 1
model Tank {
    input q : m^3/s
    param C = 20
    param R = 2
    0:liquid { <- Sf:q; -> C:C; -> R:R; -> De:p }
}
"""


@cache
def tank() -> Compilation:
    """Its residual, behind a filter of 0.2 rad/s."""
    return Compilation(Source("tank.bg", _TEXT)).with_options(rate=1.0, bandwidth=0.2)
