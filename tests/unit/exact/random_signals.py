"""Independent random signals, for expressions without a plant."""

from random import Random

from bondgraph.exact.signal_algebra import Taylor
from bondgraph.field.prime import PrimeField
from bondgraph.field.series import Series
from bondgraph.ir.expr import Expr, Kind, Pool, Symbol


class Signals:
    """Independent random signals, as power series."""

    def __init__(self, order: int = 6, seed: int = 0) -> None:
        self.algebra = Taylor(PrimeField(1))
        self.order, self.seed = order, seed

    def value(self, symbol: Expr) -> Series:
        signal = symbol.symbol.kind in (Kind.SENSOR, Kind.INPUT)
        draw = Random(f"{symbol.symbol.name}{self.seed if signal else ''}")
        n = self.order + 1 if signal else 1
        return [self.algebra.numbers.any(draw) for _ in range(n)]

    def start(self, initial: Symbol) -> int:
        return 12345 + self.seed

    def earlier(self, steps: int) -> "Signals":
        return Signals(self.order, self.seed + steps)


pool = Pool()
x, y = (pool.symbol(n, Kind.SENSOR) for n in "xy")
a, b = (pool.symbol(n, Kind.PARAM) for n in "ab")
x0 = pool.symbol("x0", Kind.INITIAL)
D, mul, add = pool.der, pool.mul, pool.add
