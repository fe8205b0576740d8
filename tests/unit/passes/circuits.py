"""Two models that are small enough to be worked out by hand."""

from __future__ import annotations

from bondgraph.compilation import Compilation
from bondgraph.text.source import Source

#: A resistor and a capacitor at a source, the current and the voltage measured.
RC = """bg 1
model M {
    param R = 2
    1:s { <- Se:u; -> R:R; -> 0:n; -> Df:i }
    n { -> C:C = 3; -> De:y }
}
"""
#: A motor of which the speed alone is measured.
MOTOR = """bg 1
model M {
    param L = 3
    param R = 2
    param k = 5
    param J = 7
    param b = 4
    1:el { <- Se:U; -> I:L; -> R:R; -> GY:k -> 1:rotor }
    rotor { -> I:J; -> R:b; -> Df:w }
}
"""


def compiled(text: str) -> Compilation:
    return Compilation(Source("m.bg", text))
