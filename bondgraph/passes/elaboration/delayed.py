"""Puts delays at the boundary of the graph: inside it every signal is there at once.

Relations are derived for the plant's own time. A delayed sensor stands for what it will say of now,
a delayed input for what reaches the plant now, and what a law received of a sensor some time ago is
an input: at one moment all of them are independent of each other, so that what vanishes whatever
they are vanishes on the machine.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction

from bondgraph.ir.expr import Expr, Kind, symbols
from bondgraph.ir.graph import BondGraph, Input
from bondgraph.ir.past import past_name
from bondgraph.passes.elaboration.calls import Past
from bondgraph.passes.elaboration.problems import rough
from bondgraph.text.diagnostic import Label, Report


def delayed(
    graph: BondGraph,
    past: Mapping[Expr, Past],
    ages: Mapping[Expr, Past],
    number: Callable[[Expr], Fraction | None],
    report: Report,
) -> BondGraph:
    """The graph with a signal for each delay that laws and sensors use.

    `past` are the symbols of past values that laws use, `ages` how late sensors say what they say,
    `number` gives the value of a constant. Errors: `delay-time`, `delay-twice`.
    """

    def seconds(of: Past) -> Fraction:
        value = number(of.age)
        if value is None or value < 0:
            report.error("delay-time", "A delay is a number, zero or more.", of.origin,
                         help="Give its constants values.")  # fmt: skip
        return value or Fraction(0)

    late = {symbol: seconds(age) for symbol, age in ages.items()}
    roots = [law.zero for node in graph.nodes for law in node.laws]
    roots += [s.reads for s in graph.sensors] + [i.integrand for i in graph.integrals]
    used = symbols(*roots)
    own = {i.symbol: i for i in graph.inputs}
    own_delay: dict[Expr, tuple[Fraction, Past | None]] = {
        s: (Fraction(0), None) for s in used if s in own
    }
    inputs: dict[str, Input] = {}
    mapping: dict[Expr, Expr] = {}
    readings = {graph.pool.symbol(s.name, Kind.READING): s for s in graph.sensors}
    for symbol in [s for s in used if s in past or s in readings]:
        of = past.get(symbol)
        base, age = (symbol, Fraction(0)) if of is None else (of.base, seconds(of))
        if base in own:
            before = own_delay.setdefault(base, (age, of))
            if before[0] != age:
                places = [Label(p.origin) for p in (of, before[1]) if p is not None]
                report.error("delay-twice", f"`{base.symbol.name}` acts with two delays, "
                             f"{rough(before[0])} s and {rough(age)} s.", *places,
                             help="Declare an input for each: both are then signals, and faults, "
                             "of their own.")  # fmt: skip
            mapping[symbol] = base
            continue
        sensor = readings[base]
        if not age and not late.get(sensor.symbol):
            mapping[symbol] = base  # what it says now is what is now
            continue
        name = past_name(sensor.name, age)
        mapping[symbol] = graph.pool.symbol(name, Kind.INPUT)
        inputs[name] = Input(name, mapping[symbol], True, False, sensor.dimension, sensor.unit,
                             sensor.doc, sensor.origin, age, sensor.name)  # fmt: skip
    return _written(graph, mapping)._replace(
        inputs=(
            *[i._replace(delay=own_delay.get(i.symbol, (i.delay,))[0]) for i in graph.inputs],
            *inputs.values(),
        ),
        sensors=tuple(
            s._replace(reads=graph.pool.substitute([s.reads], mapping)[0],
                       delay=late.get(s.symbol, s.delay))
            for s in graph.sensors
        ),
    )  # fmt: skip


def _written(graph: BondGraph, mapping: Mapping[Expr, Expr]) -> BondGraph:
    """The graph with its laws, integrals and `let`s in other signals."""

    def new(expr: Expr) -> Expr:
        return graph.pool.substitute([expr], mapping)[0]

    return graph._replace(
        nodes=tuple(
            n._replace(laws=tuple(law._replace(zero=new(law.zero)) for law in n.laws))
            for n in graph.nodes
        ),
        integrals=tuple(i._replace(integrand=new(i.integrand)) for i in graph.integrals),
        lets=tuple(let._replace(value=new(let.value)) for let in graph.lets),
    )
