"""Equations straight from the bonds, and the parts of a plant with numbers of their own."""

from __future__ import annotations

from bondgraph.exact.assembly import Assembly, Parts, assemble
from bondgraph.ir.expr import Expr, Kind, Op, topological
from tests.unit.exact.models import FLEXIBLE, MOTOR, graph, symbols

_TWO = """
model A { param R = 2; param S = 3; input on : bool
    1:a when on { <- Se:u; -> R:ra = R; -> Df:i }
    0:b { <- Sf:v; -> C:cb = S; -> De:j }
    sensor z = 2*j
    sensor both = i + j
}
"""


def _variable(plant: Assembly, name: str) -> int:
    (found,) = {v for s, (v, _) in plant.place.items() if s.symbol.name == name}
    return found


def test_a_junction_has_one_variable_in_common_and_balances_the_other_with_signs() -> None:
    """The source brings its effort, the inertia, the meter and the shaft take theirs."""
    model = graph(FLEXIBLE)
    plant = assemble(model)
    at = {node.path: number for number, node in enumerate(model.nodes)}

    def effort(path: str) -> int:
        return plant.place[model.nodes[at[path]].ports[0].effort][0]

    def flow(path: str) -> int:
        return plant.place[model.nodes[at[path]].ports[0].flow][0]

    motor = next(b for b in plant.balances if b.node == at["motor"])
    signs = dict(motor.terms)
    assert motor.when is None and sorted(signs.values()) == [-1, -1, -1, 1]
    assert signs[effort("T")] == 1 and signs[effort("J")] == -1
    assert motor.common == flow("T") == flow("J") != flow("m")
    shaft = next(b for b in plant.balances if b.node == at["shaft"])
    assert dict(shaft.terms) == {flow("J"): 1, flow("spring"): -1, flow("m"): -1}
    assert shaft.common == effort("spring") in signs


def test_integrals_and_states_have_rates_and_sensors_take_no_power() -> None:
    model = graph(MOTOR.replace("Df:w }", "Df:w }\n let h = int(rotor.f)\n sensor a = h"))
    plant = assemble(model)
    of_nodes = {r.node: r for r in plant.rates}
    assert of_nodes.keys() == {-1, *(n for n, node in enumerate(model.nodes) if node.kind == "I")}
    integral = next(s for s in plant.place if s.symbol.kind is Kind.INTEGRAL)
    assert of_nodes[-1].variable == plant.place[integral][0]
    assert len(plant.silent) == 1  # the effort of Df:w
    assert len(plant.free) == 1 and not plant.unknown
    assert plant.count_of == 1 + max(v for v, _ in plant.place.values())


def test_what_comes_back_to_a_junction_cancels_in_its_balance() -> None:
    """One flow goes from the 0-junction through a 1-junction and back: source, meter, resistor."""
    model = graph("""
model A { 0:n { <- Sf:i; -> R:r = 2; -> De:y }
    n -> 1:s
    s -> n
    s -> R:q = 3
}""")
    plant = assemble(model)
    at = {node.path: number for number, node in enumerate(model.nodes)}
    balance = next(b for b in plant.balances if b.node == at["n"])
    around = plant.place[model.nodes[at["q"]].ports[0].flow][0]
    assert sorted(sign for _, sign in balance.terms) == [-1, -1, 1]
    assert around not in dict(balance.terms)


def _parts(text: str) -> tuple[Assembly, Parts, dict[str, Expr]]:
    model = graph(text)
    plant = assemble(model)
    return plant, Parts(plant), symbols(model)


def test_a_part_has_what_hangs_together_and_numbers_without_gaps() -> None:
    plant, parts, s = _parts(_TWO)
    one, two = parts.about([s["u"]]), parts.about([s["v"]])
    both = parts.about([s["u"], s["v"]])
    assert one.count_of + two.count_of == both.count_of == plant.count_of
    for part in (one, two):
        used = {v for v, _ in part.place.values()}
        assert max(used) < part.count_of and len(part.free) == 1
        inside = [v for b in part.balances for v, _ in b.terms] + [r.variable for r in part.rates]
        assert all(0 <= v < part.count_of for v in inside)
    assert {n for n, _, _ in one.shown} == {"i"} and {n for n, _, _ in two.shown} >= {"j"}
    assert {n for n, _, _ in both.shown} == {n for n, _, _ in plant.shown}
    assert [b.when is not None for b in one.balances] == [True]
    assert not one.rates and [r.value for r in two.rates] == [r.value for r in plant.rates]
    assert parts.about([s["u"], s["i"]]).count_of == one.count_of
    assert parts.about([s["u"]]) is one  # kept
    assert parts.about([s["R"]]).count_of == 0


def test_a_reading_that_a_law_uses_is_a_variable_of_the_part_that_has_the_law() -> None:
    plant, parts, s = _parts("""
model A { param R = 2
    1:a { <- Se:u; -> R:ra = R; -> Df:i }
    0:b { <- MSf:v { f = 3*i }; -> R:rb = 5; -> De:j }
    0:c { <- Sf:w; -> R:rc = 5; -> De:k }
}""")
    ((name, variable, reads),) = plant.readings
    (reading,) = (symbol for symbol, where in plant.place.items() if where == (variable, 1))
    assert name == "i" and reading.symbol.kind is Kind.READING
    part = parts.about([s["u"]])
    ((_, at, same),) = part.readings
    assert same is reads and part.place[reading] == (at, 1) and at < part.count_of
    assert {n for n, _, _ in part.shown} == {"i", "j"}
    assert not parts.about([s["w"]]).readings


def test_derivatives_of_expressions_get_a_variable_of_their_own_that_equals_them() -> None:
    model = graph("""
model A { param m = 1; param b = 2
    1:v { <- Se:F; -> I:m; -> R:b { e = b*f + der(sin(f)) + der(f)/4 }; -> Df:y }
}""")
    plant = assemble(model)
    nodes = topological([law for _, law in plant.laws])
    assert all(n.args[0].op is Op.SYM for n in nodes if n.op is Op.DER)
    ((inner, at),) = [(s, v) for s, (v, _) in plant.place.items() if s.symbol.name == "der#0"]
    (says,) = [law for _, law in plant.laws if inner in [a for _, a in law.terms]]
    assert {a.op for _, a in says.terms} == {Op.SYM, Op.FN}
    assert sum(c for c, _ in says.terms) == 0  # the symbol less the sine
    assert at < plant.count_of


def test_bonds_between_junctions_have_names_and_no_others() -> None:
    """A port has symbols of its own."""
    names = {s.symbol.name for s in assemble(graph(FLEXIBLE)).place if "->" in s.symbol.name}
    assert {name.partition(".")[0] for name in names} == {"motor->shaft", "shaft->load"}
    assert len(names) == 4  # an effort and a flow of each
    assert {sign for s, (_, sign) in assemble(graph(FLEXIBLE)).place.items()
            if "->" in s.symbol.name} == {1}  # fmt: skip
    model = graph(MOTOR)
    assert not [s for s in assemble(model).place if "->" in s.symbol.name]


def test_what_says_nothing_of_variables_belongs_to_every_part() -> None:
    """A law of parameters alone, and a sensor that shows one."""
    plant, _, s = _parts(_TWO)
    constant = (0, plant.pool.sub(s["R"], s["S"]))
    shown = ("fixed", plant.pool.symbol("fixed", Kind.SENSOR), plant.pool.scale(2, s["R"]))
    parts = Parts(plant._replace(laws=(constant, *plant.laws), shown=(*plant.shown, shown)))
    one, two, none = parts.about([s["u"]]), parts.about([s["v"]]), parts.about([])
    for part in (one, two, none):
        assert constant in part.laws and shown in part.shown
    assert none.laws == (constant,) and none.count_of == 0 and not none.balances
    assert len(one.laws) + len(two.laws) == len(plant.laws) + 2
