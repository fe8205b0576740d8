"""Hand-built residuals with the smallest graph around them that `lower` asks for."""

from __future__ import annotations

from fractions import Fraction

from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.ir.graph import BondGraph, Input, Integral, Sensor, Value
from bondgraph.ir.program import Program
from bondgraph.ir.residuals import Residual, ResidualSet
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.passes.lowering.lower import LowerOptions, lower
from bondgraph.text.source import Source, Span

SOURCE = Source("model.bg", "bg 1\n")
HERE = Span(SOURCE, 0, 4)


class Bench:
    """Collects declarations; `program` lowers residuals given as expressions."""

    def __init__(self) -> None:
        self.pool = Pool()
        self.values: list[Value] = []
        self.inputs: list[Input] = []
        self.sensors: list[Sensor] = []
        self.integrals: list[Integral] = []

    def param(self, name: str, value: str | Expr | None, fault: bool = True) -> Expr:
        """A parameter with a nominal value."""
        symbol = self.pool.symbol(name, Kind.PARAM if fault else Kind.CONST)
        given = self.pool.num(Fraction(value)) if isinstance(value, str) else value
        self.values.append(Value(name, symbol, given, None, None, None, fault, "", HERE))
        return symbol

    def input(self, name: str, mode: bool = False) -> Expr:
        """A known input, or a mode."""
        symbol = self.pool.symbol(name, Kind.MODE if mode else Kind.INPUT)
        self.inputs.append(Input(name, symbol, True, mode, None, None, "", HERE))
        return symbol

    def sensor(self, name: str, counts: int | None = None, reads: Expr | None = None) -> Expr:
        """A sensor, or an encoder with so many counts a turn."""
        symbol = self.pool.symbol(name, Kind.SENSOR)
        turn = None if counts is None else self.pool.num(counts)
        self.sensors.append(
            Sensor(name, symbol, reads or symbol, "Df", 0, turn, None, None, "rad", "", HERE)
        )
        return symbol

    def initial(self, name: str, value: Expr) -> Expr:
        """A declared initial value of an integral."""
        symbol = self.pool.symbol(name, Kind.INITIAL)
        state = self.pool.symbol(f"{name} state", Kind.INTEGRAL)
        self.integrals.append(Integral(state, self.pool.zero, symbol, value, HERE))
        return symbol

    def program(self, *exprs: Expr, options: LowerOptions | None = None) -> Program:
        """The program of residuals r1, r2, ..., each taken to see every fault."""
        graph = BondGraph(
            "Model",
            SOURCE,
            "A model.",
            self.pool,
            (),
            (),
            tuple(self.values),
            tuple(self.inputs),
            tuple(self.sensors),
            tuple(self.integrals),
            (),
            (),
        )
        equation = Equation("balance", "junction", self.pool.zero, (), 0, HERE)
        names = tuple(f"r{i + 1}" for i in range(len(exprs)))
        residuals = tuple(
            Residual(n, e, equation, (), 0, None, e, {})
            for n, e in zip(names, exprs, strict=True)
        )
        system = EquationSystem(graph, (equation,), (), (), (), {})
        rows = tuple((True,) * len(exprs) for _ in graph.faults)
        matrix = SignatureMatrix(names, graph.faults, rows, tuple({} for _ in exprs))
        return lower(
            graph, ResidualSet(system, residuals, (), ()), matrix, options or LowerOptions()
        )


def drive(bench: Bench) -> tuple[Expr, Expr]:
    """r1 and r2i of one drive of the robot (Merzouki, Fawaz, Ould Bouamama 2008, corrected)."""
    p, d = bench.pool, bench.pool.der
    k, re, ind = bench.param("k", "3.51e-3"), bench.param("Re", "17.6"), bench.param("L", "300e-6")
    je, fe = bench.param("Je", "1.4e-8"), bench.param("fe", "1.19e-5")
    ratio, js = bench.param("N", "25"), bench.param("Js", "1e-5")
    fs, radius = bench.param("fs", "3e-4"), bench.param("R", "0.005")
    stiff, a = bench.param("K", "0.1"), bench.param("A", "-4")
    tau, zero = bench.param("tau0", "0.01"), bench.initial("twist0", p.num(Fraction(1, 100)))
    u0, fx = bench.input("U0"), bench.input("Fx")
    we, ws = bench.sensor("We"), bench.sensor("Ws")
    load = p.add((1, p.mul(js, d(ws))), (1, p.mul(fs, ws)), (1, p.mul(radius, fx)))
    torque = p.add((1, p.mul(je, d(we))), (1, p.mul(fe, we)), (1, p.div(load, ratio)))
    r1 = p.add(
        (1, p.mul(k, we)),
        (-1, u0),
        (1, p.div(p.mul(re, torque), k)),
        (1, p.div(p.mul(ind, d(torque)), k)),
    )
    twist = p.integral(p.sub(we, p.mul(ratio, ws)), zero)
    play = p.mul(a, stiff, tau, p.fn("tanh", p.div(twist, p.scale(4, tau))))
    r2 = p.sub(load, p.mul(ratio, p.add((1, play), (1, p.mul(stiff, twist)))))
    return r1, r2


def cable(bench: Bench, cells: int) -> Expr:
    """The residual of a cable of T cells with a capacitor at its open end, as a nested graph."""
    p, d = bench.pool, bench.pool.der
    r = bench.param("R", str(3.2 / cells))
    ind, c = bench.param("L", str(250e-9 / cells)), bench.param("C", str(110e-12 / cells))
    us = bench.sensor("Us")
    voltage, current = us, p.mul(c, d(us))
    half = Fraction(1, 2)
    for _ in range(cells):
        for last in (False, True):
            voltage = p.add((1, voltage), (half, p.mul(r, current)), (half, p.mul(ind, d(current))))
            if not last:
                current = p.add((1, current), (1, p.mul(c, d(voltage))))
    return p.sub(bench.input("Uin"), voltage)


def operations(value: object) -> int:
    """Additions, subtractions, multiplications and divisions in an expression of a program."""
    from bondgraph.ir.program import Product, Sum

    if isinstance(value, Sum):
        signs = 0 if value.terms[0][0] else 1
        return len(value.terms) - 1 + signs + sum(operations(t) for _, t in value.terms)
    if isinstance(value, Product):
        parts = (*value.factors, *value.divisors)
        return len(parts) - 1 + sum(map(operations, parts))
    return 0
