"""Elaboration: submodels, arrays, ports, signs and laws, against LANGUAGE's rules by hand."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.ir.expr import Kind
from tests.unit.passes.elaborating import body, bonds, errors, graph, laws, node, run, signs

CELL = """
model Cell {
    port a : in  electrical
    port b : out electrical
    param R : Ohm
    param C : F
    1:left { <- a; -> R:R; -> mid }
    0:mid  { -> C:C; -> b }
}
model Line(n : int = 2) {
    port a : in electrical
    port b : out electrical
    param R = 4 Ohm +- 10%
    param C = 6 nF
    Cell:cell[n](R = R/n, C = C/n)
    a -> cell[1..n] -> b
}
"""


# ---------------------------------------------------------------- submodels


def test_series_of_cells_is_one_chain_of_junctions() -> None:
    g = graph(CELL + "model T { Se:U -> Line:line(n = 3) -> 0:out; out -> De:y }")
    between = [b for b in bonds(g) if "cell" in b[0] and "cell" in b[1] and b[0][10] != b[1][10]]
    assert between == [
        ("line.cell[1].mid", "line.cell[2].left"),
        ("line.cell[2].mid", "line.cell[3].left"),
    ]
    assert ("U", "line.cell[1].left") in bonds(g)
    assert ("line.cell[3].mid", "out") in bonds(g)


def test_bound_params_are_aliases_of_what_they_are_bound_to() -> None:
    g = graph(CELL + "model T { Se:U -> Line:line(n = 3) -> 0:out; out -> De:y }")
    assert [v.name for v in g.values] == ["line.R", "line.C"]
    assert laws(g, "line.cell[2].R") == ["line.cell[2].R.e - line.cell[2].R.f*line.R/3"]
    assert g.faults == ("line.R", "line.C", "U", "y")
    assert g.values[0].tolerance == Fraction(1, 10)
    assert repr(g.values[1].value) == repr(g.pool.num(Fraction(6, 10**9)))


def test_an_empty_range_joins_its_neighbours() -> None:
    g = graph(CELL + "model T { Se:U -> Line:line(n = 0) -> 0:out; out -> De:y; out -> R:r = 1 }")
    assert bonds(g)[0] == ("U", "out")


def test_binding_reaches_into_submodels() -> None:
    g = graph(
        """
        model In { port p : in any; param a = 1; input w; p -> 1:j; j -> C:c = a; j <- Se:w }
        model Mid { port p : in any; In:x(a = 3); p -> x }
        model T { Mid:m(x.c.q0 = 2, x.w = 3*k); param k = 2; Se:U -> m; sensor y = m.x.j.f }
        """
    )
    port = node(g, "m.x.c").ports[0]
    assert port.initial is not None
    assert port.initial.symbol == ("m.x.c.q0", Kind.INITIAL)
    assert port.initial_value is g.pool.num(2)
    assert laws(g, "m.x.w") == ["m.x.w.e - 3*k"]
    assert [i.name for i in g.inputs] == ["U"]


def test_for_if_and_indices() -> None:
    g = body(
        """
        for i in 1..3 {
            Se:U[i] -> 1:j[i]
            j[i] -> R:r[i] = i*2 Ohm
            if i > 2 { j[i] -> Df:y[i] } else { j[i] -> C:c[i] = 1 F }
        }
        """
    )
    assert [n.path for n in g.nodes if n.kind in ("Df", "C")] == ["c[1]", "c[2]", "y[3]"]
    assert laws(g, "r[3]") == ["r[3].e - 6*r[3].f"]
    assert [i.name for i in g.inputs] == ["U[1]", "U[2]", "U[3]"]


def test_order_of_statements_does_not_matter() -> None:
    first = body("Se:U -> 1:j; j -> R:R; param R = 2 Ohm; j -> Df:y")
    second = body("j -> R:R; param R = 2 Ohm; j -> Df:y; Se:U -> 1:j")
    assert sorted(bonds(first)) == sorted(bonds(second))
    assert sorted(n.path for n in first.nodes) == sorted(n.path for n in second.nodes)


def test_reopened_junction_and_labels() -> None:
    g = body("Se:U -[7]-> 1:j; j { -> R:r = 1; -[9]-> Df:y }")
    assert [b.label for b in g.bonds] == ["7", None, "9"]


def test_the_model_that_no_other_uses() -> None:
    text = "model A { port p : in any; p -> R:r = 1 }\nmodel B { Se:U -> A:a }"
    assert graph(text).name == "B"
    assert errors(text, "A") == ["open-port"]
    assert errors(text, "C") == ["unknown-model"]
    assert errors("model A { Se:U -> R:r = 1 }\nmodel B { Se:U -> R:r = 1 }") == ["several-models"]


def test_open_port_of_the_top_model() -> None:
    g = graph("model A { port p : in any; p -> 1:j; j -> R:r = 1 }", open_ports=True)
    port = node(g, "p")
    assert (port.kind, port.keyword, port.laws) == ("R", "port", ())
    assert bonds(g)[0] == ("p", "j")


def test_imports() -> None:
    others = {"parts.bg": "model Load { port p : in electrical; p -> R:r = 2 Ohm }"}
    text = 'import Load from "parts.bg"\nmodel M { Se:U -> Load:load }'
    g, _ = run(text, others=others)
    assert g is not None
    assert bonds(g) == [("U", "load.r")]
    assert [d.code for d in run(text)[1]] == ["file-not-found"]
    cyclic = {"parts.bg": 'import M from "model.bg"\nmodel Load { port p : in any; p -> R:r = 1 }',
              "model.bg": text}  # fmt: skip
    assert [d.code for d in run(text, others=cyclic)[1]] == ["import-cycle"]
    roundabout = {"parts.bg": cyclic["parts.bg"].replace("model.bg", "x/../model.bg"),
                  "x/../model.bg": text}  # fmt: skip
    assert [d.code for d in run(text, others=roundabout)[1]] == ["import-cycle"]


# ---------------------------------------------------------------- ports and signs


def test_ports_that_agree_vanish() -> None:
    g = graph(
        """
        model A { port a : in electrical; port b : out electrical; a -> b }
        model T { A:x[3]; Se:U -> 1:j -> x[1..3] -> 0:k; k -> De:y; k -> R:r = 5 Ohm }
        """
    )
    assert bonds(g)[:2] == [("U", "j"), ("j", "k")]


def test_half_arrows_that_disagree_negate_the_flow() -> None:
    g = graph(
        """
        model A { port a : in electrical; 1:j { <- a; -> R:r = 2 Ohm; -> Df:y } }
        model T { A:x; x.a -> Se:U }
        """
    )
    # both half arrows leave the port: a 0-junction with f_inside + f_outside = 0
    assert node(g, "x.a").kind == "0"
    assert bonds(g)[:2] == [("x.a", "x.j"), ("x.a", "U")]


def test_power_of_a_passive_port_is_into_the_element() -> None:
    g = body(
        """
        Se:U -> 1:i
        i -> R:r1 = 1; i <- R:r2 = 1; i -> C:c1 = 1; i <- I:m1 = 1
        i -> 0:o
        o -> R:r3 = 1; o <- R:r4 = 1; o -> C:c2 = 1; o <- I:m2 = 1
        o -> TF:a { f1 = 2*f2 } -> 1:p; p -> R:r5 = 1
        o -> TF:b { f1 = 2*f2 } <- 1:q; q -> R:r6 = 1
        o <- GY:g = 2 -> 1:s; s -> R:r7 = 1
        """
    )
    for bond in g.bonds:
        for end, into in ((bond.tail, -1), (bond.head, 1)):
            element = g.nodes[end.node]
            if end.port < 0 or element.kind in ("Se", "Sf"):
                continue
            positive = -1 if element.kind in ("TF", "GY") and end.port == 1 else 1
            assert end.effort * end.flow == into * positive, element.path
    # the common variable of the junction stays
    assert signs(g, "r2") == (-1, 1)
    assert signs(g, "m1") == (-1, 1)
    assert signs(g, "r4") == (1, -1)
    # where both bonds of a two-port leave it or enter it, the first one written is port 1
    assert signs(g, "b", 0) == (1, 1)
    assert signs(g, "b", 1) == (1, -1)
    assert signs(g, "g", 0) == (1, -1)
    assert signs(g, "g", 1) == (1, 1)


def test_an_element_on_an_element_negates_the_flow() -> None:
    g = body("R:r = 1 -> Se:U")
    assert signs(g, "r") == (1, -1)
    assert signs(g, "U") == (1, 1)


# ---------------------------------------------------------------- laws


@pytest.mark.parametrize(
    ("element", "expected"),
    [
        ("R:x = 3", "x.e - 3*x.f"),
        ("C:x = 3", "x.q - 3*x.e"),
        ("I:x = 3", "x.p - 3*x.f"),
        ("R:x { e = 3*f^3 }", "x.e - 3*x.f^3"),
        ("R:x { 0 = e - f*abs(f) }", "x.e - ssq(x.f)"),
        ("C:x { e = q + q^3 }", "x.e - (x.q + x.q^3)"),
        ("I:x { f = tanh(p/2) }", "x.f - tanh(x.p/2)"),
    ],
)
def test_one_port_laws(element: str, expected: str) -> None:
    g = body(f"Se:U -> 1:j; j -> {element}; j -> Df:y")
    assert laws(g, "x") == [expected]


def test_direction_is_what_the_law_is_solved_for() -> None:
    g = body(
        """
        Se:U -> 1:j
        j -> R:a { e = 3*f^3 }; j -> R:b { f = 3*e }; j -> R:c { 0 = e - 2*f }
        j -> R:d = 2; j -> R:g { 2*e = f }; j -> R:h { e = 2*e - f }
        """
    )
    found = {n.path: n.laws[0].direction for n in g.nodes if n.kind == "R"}
    names = {k: None if v is None else v.symbol.name for k, v in found.items()}
    assert names == {"a": "a.e", "b": "b.f", "c": None, "d": None, "g": None, "h": None}


@pytest.mark.parametrize(
    ("kind", "relation", "values"),
    [
        # (e1, f1, e2, f2) that satisfy the relation and e1*f1 = e2*f2, chosen by hand
        ("TF", "f1 = 5*f2", (2, 15, 10, 3)),
        ("TF", "e1 = 5*e2", (10, 3, 2, 15)),
        ("TF", "f2 = f1/5", (2, 15, 10, 3)),
        ("TF", "e2 = 5*e1", (2, 15, 10, 3)),
        ("TF", "2*e1 = 3*e2", (3, 4, 2, 6)),
        ("GY", "e1 = 5*f2", (10, 3, 15, 2)),
        ("GY", "e2 = 5*f1", (10, 3, 15, 2)),
        ("GY", "f1 = e2/5", (10, 3, 15, 2)),
    ],
)
def test_two_ports_conserve_power(kind: str, relation: str, values: tuple[int, ...]) -> None:
    g = body(f"Se:U -> {kind}:x {{ {relation} }} -> R:r = 1")
    x = node(g, "x")
    at = {}
    for port, (e, f) in zip(x.ports, (values[:2], values[2:]), strict=True):
        at[port.effort], at[port.flow] = g.pool.num(e), g.pool.num(f)
    assert len(x.laws) == 2
    assert g.pool.substitute([law.zero for law in x.laws], at) == [g.pool.zero] * 2


def test_modulus_of_signals_and_conditions() -> None:
    g = body("input on : bool; Se:U -> 1:i; i -> MTF:x { f1 = if(on, 2, 3)*f2 } -> 0:o; o -> De:y"
             "; o -> MGY:z { e1 = y*f2 } -> R:r = 1")  # fmt: skip
    assert [repr(law.direction) for law in node(g, "x").laws] == ["x.f1", "x.e2"]
    assert [repr(law.direction) for law in node(g, "z").laws] == ["z.e1", "z.e2"]


def test_field_with_named_ports() -> None:
    g = body(
        """
        param eA = 3 F.m
        C:mic(el.q0 = 1 C, mech.q0 = 1 mm) {
            port el; port mech
            el.e = el.q*mech.q/eA
            mech.e = el.q^2/(2*eA)
        }
        Se:U -> 1:i; i -> R:R = 5 Ohm; i -> mic.el
        1:v { <- mic.mech; -> I:m = 1 kg; -> Df:y }
        """
    )
    mic = node(g, "mic")
    assert [(p.name, repr(p.state), repr(p.initial)) for p in mic.ports] == [
        ("el", "mic.el.q", "mic.el.q0"), ("mech", "mic.mech.q", "mic.mech.q0"),
    ]  # fmt: skip
    assert repr(mic.ports[1].initial_value) == "0.001"
    assert signs(g, "mic", 1) == (-1, 1)
    assert node(g, "v").domain == "translation"


def test_sources() -> None:
    g = body(
        """
        input road : m/s unknown
        input F[2] : N
        Sf:road -> 0:s; s -> C:k = 1 mm/N; s -> 1:b; b -> I:m = 2 kg; b -> Df:y
        for j in 1..2 { b <- Se:F[j] }
        b <- MSe:extra = 3 N.s/m*y
        """
    )
    assert [(i.name, i.known, i.unit) for i in g.inputs] == [
        ("road", False, "m/s"), ("F[1]", True, "N"), ("F[2]", True, "N"),
    ]  # fmt: skip
    assert laws(g, "extra") == ["extra.e - 3*y - extra"]  # a controller may deliver wrongly
    assert g.faults == ("extra", "F[1]", "F[2]", "y")


# ---------------------------------------------------------------- signals, sensors, values


def test_integrals_are_shared_and_start_where_they_say() -> None:
    g = body(
        """
        param x0 = 2 rad
        Se:U -> 1:j; j -> I:m = 1 kg.m^2; j -> R:r = 1 N.m.s; j -> Df:w
        let a = int(j.f, x0)
        let b = 2*int(j.f, x0) + int(j.f)
        let c = der(int(j.f))
        sensor th : rad = int(j.f, x0) counts 24/turn
        """
    )
    assert [repr(i.initial_value) for i in g.integrals] == ["x0", "0"]
    lets = {t.name: t.value for t in g.lets}
    assert lets["a"] is g.integrals[0].symbol
    assert lets["c"] is node(g, "j").common
    th = g.sensors[1]
    assert th.reads is g.integrals[0].symbol
    assert th.counts is g.pool.num(24)
    assert th.unit == "rad"
    # nothing but an initial value uses x0
    assert g.faults == ("U", "w", "th")


def test_one_instrument_read_twice() -> None:
    g = body("Se:U -> 1:j; j -> R:r = 1; j -> Df:a; 1:k { <- j; -> C:c = 1; -> Df:b = a }")
    assert g.sensors[1].symbol is g.sensors[0].symbol
    assert (g.sensors[1].same_as, g.faults) == ("a", ("U", "a"))


def test_signals_of_ports() -> None:
    g = graph(
        """
        model In { port p : in any; p -> 1:j; j -> R:r = 1; sensor power = p.e*p.f }
        model T { In:x; Se:U -> 0:k -> x.p; let back = -x.p.f }
        """
    )
    effort, flow = node(g, "k").common, node(g, "x.j").common
    assert effort is not None and flow is not None
    assert g.sensors[0].reads is g.pool.mul(effort, flow)
    assert repr(g.lets[0].value) == "-x.j.f"


def test_exact_units() -> None:
    g = body("param a = 0.1 mm; param b = 3 km/h; const c = 2*a; Se:U = c*b -> R:r = 1")
    assert [repr(v.value) for v in g.values] == ["0.0001", "5/6", "2*a"]
    assert [(v.name, v.fault) for v in g.values] == [("a", False), ("b", True), ("c", False)]


def test_tolerance_of_an_element_and_absolute_tolerance() -> None:
    g = body("param L = 20 mH +- 1 mH; Se:U -> 1:j; j -> I:L; j -> R:r = 5 Ohm +- 2%; "
             "j -> R:s = 2*r0 +- 3%; param r0 = 2 Ohm")  # fmt: skip
    found = {v.name: (v.tolerance, v.fault, v.symbol.symbol.kind) for v in g.values}
    assert found["L"] == (Fraction(1, 20), True, Kind.PARAM)
    assert found["r.value"] == (Fraction(1, 50), False, Kind.CONST)
    assert found["s.factor"] == (Fraction(3, 100), False, Kind.CONST)
    assert found["r0"][1]


def test_modes() -> None:
    g = body("input on : bool; Se:U -> 0:k; k -> R:r = 1; "
             "1:sw when on and not false { <- k; -> R:l = 2 }")  # fmt: skip
    assert repr(node(g, "sw").when) == "on"
    assert g.inputs[0].mode
    assert g.faults == ("U",)


def test_events() -> None:
    g = graph(
        CELL + "model T { Se:U -> Line:line -> 0:out; out -> De:y; "
        "fault cut : line.R += 100 Ohm; fault drift[2] : y *= 1.1 }"
    )
    assert [(e.name, e.target, e.op, repr(e.value)) for e in g.events] == [
        ("cut", "line.R", "+=", "100"), ("drift[2]", "y", "*=", "1.1"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    "corner", ["", ",", "flow\\speed, ", "head in Pa\n\n x/y ", "0;", "flow (l/s) / speed; "]
)
def test_a_map_beside_the_model(tmp_path: object, corner: str) -> None:
    folder = str(tmp_path)
    with open(f"{folder}/pump.csv", "w") as file:
        file.write(f"# measured\n{corner}100, 200\n0 10\t40 # stalled\n\n2; 8; 37.5\n")
    text = 'model M { input w; Se:U -> R:r { e = table("pump.csv", f, w) } }'
    g, _ = run(text, path=f"{folder}/model.bg")
    assert g is not None
    assert g.pool.tables["pump.csv"] == ((0, 100, 200), (0, 10, 40), (2, 8, Fraction(75, 2)))
    assert laws(g, "r") == ["r.e - table:pump.csv(r.f, w)"]


@pytest.mark.parametrize(
    ("inputs", "text", "says"),
    [
        ("f", "0,1\n2\n", "Line 2 of \"t.csv\" is no pair of numbers"),
        ("f", "0,1\n\n2,x\n", "Line 3 of \"t.csv\" is no pair of numbers"),
        ("f", ",1,2\n0,1,2\n1,2,3\n", "Line 2 of \"t.csv\" is no pair of numbers"),
        ("f", "x,y\n0,1\n0,2\n", "Line 3 of \"t.csv\": x does not ascend"),
        ("f", "x,y\n0,1\n", "\"t.csv\" has fewer than two points"),
        ("f", "", "\"t.csv\" has fewer than two points"),
        ("f, w", "", "\"t.csv\" has fewer than two points"),
        ("f, w", ",1,2\n0,1,2\n", "\"t.csv\" has fewer than two points"),
        ("f, w", "0,1\n2,3\n4,5\n", "Line 1 of \"t.csv\": the first line has no two numbers"),
        ("f, w", ",1,2\n0,1,2\n1,2\n", "Line 3 of \"t.csv\" has not 3 numbers"),
        ("f, w", ",1,2\n0,1,2\n1,2,3,4\n", "Line 3 of \"t.csv\" has not 3 numbers"),
        ("f, w", ",1,2\n0,1,2\n1,2,nan\n", "Line 3 of \"t.csv\" has not 3 numbers"),
        ("f, w", ",1,x,3\n0,1,2,5\n1,2,2,5\n", "Line 1 of \"t.csv\" has not 4 numbers"),
        ("f, w", "1\n0,1,2\n1,2,5\n", "Line 1 of \"t.csv\" has not 3 numbers"),
        ("f, w", ",1,2\n1,1,2\n0,2,3\n", "Line 3 of \"t.csv\": x does not ascend"),
        ("f, w", ",2,2\n0,1,2\n1,2,3\n", "Line 1 of \"t.csv\": the first line has no two"),
    ],
)
def test_a_table_that_is_none_is_refused(
    tmp_path: object, inputs: str, text: str, says: str
) -> None:
    folder = str(tmp_path)
    with open(f"{folder}/t.csv", "w") as file:
        file.write(text)
    model = f'model M {{ input w; Se:U -> R:r {{ e = table("t.csv", {inputs}) }} }}'
    g, diagnostics = run(model, path=f"{folder}/model.bg")
    assert g is None
    (told,) = diagnostics
    assert told.code == "wrong-table" and told.message.startswith(says), told.message
    assert told.help and told.labels[0].span.text == '"t.csv"'


def test_a_table_beside_the_model(tmp_path: object) -> None:
    folder = str(tmp_path)
    with open(f"{folder}/valve.csv", "w") as file:
        file.write("x,y\n-1,-2\n0,0\n# comment\n1.5; 2.5\n")
    text = 'model M { Se:U -> R:r { e = table("valve.csv", f) } }'
    g, _ = run(text, path=f"{folder}/model.bg")
    assert g is not None
    half = Fraction(1, 2)
    assert g.pool.tables["valve.csv"] == ((-1, -2), (0, 0), (3 * half, 5 * half))
    assert laws(g, "r") == ["r.e - table:valve.csv(r.f)"]
