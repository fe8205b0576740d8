"""Bond graphs that the tests of the exact oracle share, with access to their values."""

from bondgraph.compilation import Compilation
from bondgraph.ir.expr import Expr
from bondgraph.ir.graph import BondGraph
from bondgraph.text.source import Source

MOTOR = """
model Motor {
    param L = 1; param Re = 1; param k = 1; param J = 1; param b = 1
    Se:U -> 1:el
    el { -> I:L; -> R:Re; -> GY:k -> 1:rotor }
    rotor { -> I:J; -> R:b; -> Df:w }
}
"""

TANKS = """
model Tanks {
    param C1 = 1; param C2 = 1; param k1 = 1; param k2 = 1
    Sf:Q -> 0:t1
    t1 { -> C:C1; -> De:h1; -> 1:v }
    v { -> R:r1 { f = k1*ssqrt(e) }; -> 0:t2 }
    t2 { -> C:C2; -> De:h2; -> R:r2 { f = k2*ssqrt(e) } }
}
"""

GEAR = """
model Gear {
    param J1 = 1; param J2 = 1; param N = 1; param b = 1
    1:fast { <- Se:T; -> I:J1; -> TF:N { f1 = N*f2 } -> 1:slow }
    slow { -> I:J2; -> R:b; -> Df:w }
}
"""

FLEXIBLE = """
model Flexible {
    param J = 1; param K = 1; param m = 1
    1:motor { <- Se:T; -> I:J; -> Df:w1; -> 0:shaft }
    shaft { -> C:spring(q0 = 0) = 1/K; -> 1:load }
    load { -> I:m; -> Df:w2 }
}
"""


def graph(text: str) -> BondGraph:
    """The bond graph of a model without its first line."""
    return Compilation(Source("test.bg", "bg 1\n" + text)).graph


def symbols(model: BondGraph) -> dict[str, Expr]:
    """Parameters, inputs and sensors by name."""
    out = {v.name: v.symbol for v in model.values}
    out |= {i.name: i.symbol for i in model.inputs}
    return out | {s.name: s.symbol for s in model.sensors}
