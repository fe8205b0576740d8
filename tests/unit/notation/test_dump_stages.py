"""The stages of a model as text: what stands beside each node, and what is not said of it."""

from __future__ import annotations

from bondgraph.compilation import Compilation
from bondgraph.ir.causal import Reason
from bondgraph.ir.residuals import Missing
from bondgraph.notation.dump_stages import (
    dump_causal,
    dump_equations,
    dump_graph,
    dump_residuals,
    dump_signatures,
    dump_syntax,
    order_line,
    place,
    reason,
    residual_origin,
    residual_path,
    table,
)
from bondgraph.text.diagnostic import Diagnostic
from bondgraph.text.source import Source, Span

_CIRCUIT = """bg 1
model M { param R : Ohm; param k = 3
  1:s { <- Se:u; -> R:R; -> 0:n; -> Df:i }
  n { -> C:C = k; -> De:y }
  1:t { <- Se:v; -> I:L = 2; -> R:r = 3 } }
"""


def _sections(text: str) -> dict[str, list[list[str]]]:
    """The words of each line, by the heading that they stand under."""
    dump = dump_graph(Compilation(Source("m.bg", f"bg 1\n{text}\n")).graph)
    found: dict[str, list[list[str]]] = {}
    for line in dump.splitlines():
        if line and not line.startswith(" "):
            found[line] = rows = []
        elif line:
            rows.append([word for word in line.split("  ") if word])
    return found


def test_each_node_has_its_name_once_and_a_line_for_whatever_it_says() -> None:
    found = _sections("""model M { param R : Ohm; param k = 3; input on : bool
      1:s when on { <- Se:u; -> I:L(p0 = 3) = 4; -> R:R; -> Df:i; -> 0:n }
      n -> C:c { e = k*q }
      sensor y = 2*L.p }""")
    nodes = [[word.strip() for word in row] for row in found["nodes"]]
    assert nodes == [
        ["1:s", "when", "on"],
        ["Se:u", "0 =", "u.e - u"],
        ["I:L", "0 =", "L.p - 4*L.f"],
        ["D(L.p) =", "L.e, from 3"],
        ["R:R", "0 =", "R.e - R.f*R"],
        ["Df:i", "reads", "i"],
        ["0:n"],
        ["C:c", "0 =", "c.e - c.q*k"],
        ["D(c.q) =", "c.f"],
    ]
    values = [[word.strip() for word in row] for row in found["values"]]
    assert values[0][:3] == ["param", "R", "(given at configure)"]
    assert values[1][:3] == ["param", "k", "3"]
    assert [[word.strip() for word in row] for row in found["inputs"]] == [
        ["on", "mode"], ["u", "known"],
    ]  # fmt: skip
    assert [row[0].strip() for row in found["sensors"]] == ["i", "y"]
    assert [row[-1].strip() for row in found["bonds"]] == [
        "u -> s", "s -> L", "s -> R", "s -> i", "s -> n", "n -> c",
    ]  # fmt: skip


def _circuit() -> Compilation:
    return Compilation(Source("m.bg", _CIRCUIT))


def _rows(text: str) -> list[list[str]]:
    """The words of the indented lines, and a line that is not indented as one."""
    return [line.split() if line[0] == " " else [line] for line in text.splitlines() if line]


def test_a_stroke_stands_where_the_effort_is_given_and_has_its_reason() -> None:
    """u and the detector decide i and y; what is left at s and n follows from those."""
    found = _rows(dump_causal(_circuit().integral))
    assert found[:10] == [
        ["preferred integral causality of M"],
        "0 u ->| s fixed by source u".split(),
        "1 s ->| R forced at s by 0, 2, 3".split(),
        "2 s |-> n forced at n by 4".split(),
        "3 s |-> i fixed by sensor i".split(),
        "4 n |-> C preferred by C".split(),
        "5 n ->| y fixed by sensor y".split(),
        "6 v ->| t fixed by source v".split(),
        "7 t ->| L preferred by L".split(),
        "8 t |-> r forced at t by 7".split(),
    ]
    assert found[10:] == [["storages"], ["C:C:", "integral"], ["I:L:", "integral"]]


def test_what_was_dualised_is_told_and_so_are_storages_in_derivative_causality() -> None:
    """The measured flow decides all of s, the measured effort all of n."""
    found = _rows(dump_causal(_circuit().derivative))
    assert "3 s ->| i fixed by sensor i, dualised".split() in found
    assert "5 n |-> y fixed by sensor y, dualised".split() in found
    assert found[found.index(["storages"]) :] == [
        ["storages"], ["C:C:", "derivative"], ["I:L:", "derivative"],
        ["dualised"], ["Df:i"], ["De:y"],
    ]  # fmt: skip


def test_equations_are_counted_and_stand_with_their_kind_and_line() -> None:
    """A balance a junction, a law an element, D(x) a storage, a reading a detector."""
    head, *rows = _rows(dump_equations(_circuit().equations))
    assert head == ["13 equations in 11 unknowns"]
    assert [row[:2] for row in rows] == [
        ["balance", "s"], ["law", "u"], ["law", "R"],
        ["balance", "n"], ["law", "C"], ["state", "C"],
        ["balance", "t"], ["law", "v"], ["law", "L"], ["state", "L"], ["law", "r"],
        ["sensor", "i"], ["sensor", "y"],
    ]  # fmt: skip
    assert [row[-1] for row in rows] == list("3333" + "44" + "55555" + "34")
    assert all(row[2:4] == ["0", "="] and row[-3:-1] == ["#", "line"] for row in rows)


def test_a_residual_is_told_step_by_step_by_its_equations() -> None:
    """C D(y) = i, where the storage of n is left with the balance of n."""
    found = _circuit().residuals.residual_set
    (text,) = [t for t in dump_residuals(found).split("\n\n") if t.startswith("r2")]
    head, *steps, last = text.splitlines()
    assert head == "r2: left over is balance of n, line 3"
    assert sorted(" ".join(step.split()) for step in steps) == [
        "C.f = D(C.q) # differentiated: storage C, line 4",
        "C.q = n.e*k # solved: law of C, line 4",
        "n.e = y # solved: sensor y, line 4",
        "s.f = i # solved: sensor i, line 3",
    ]
    assert last == "  0 = s.f - C.f"


def test_what_is_not_monitored_or_missing_is_told_without_residuals_too() -> None:
    """Elements by name, each once however many equations it has."""
    found = _circuit().residuals.residual_set
    nothing = found._replace(residuals=(), unmonitored=(), missing=())
    assert dump_residuals(nothing) == "no residual"
    own = [e for e in found.system.equations if e.name in ("L", "v")]
    unmonitored = nothing._replace(unmonitored=tuple(own))
    assert len(own) == 3 and dump_residuals(unmonitored) == "not monitored: v, L"
    (sensor,) = [e for e in found.system.equations if (e.kind, e.name) == ("sensor", "i")]
    missing = Missing(sensor, (), (), Diagnostic("BG000", "it is not had"))
    assert dump_residuals(nothing._replace(missing=(missing,))) == "missing: sensor i, line 3"


def test_a_residual_says_what_it_was_made_to_be_free_of() -> None:
    compilation = _circuit()
    residual = compilation.residuals.residual_set.residuals[1]
    free = residual._replace(free_of="k")
    assert residual_origin(free, compilation.source) == "balance of n, line 3, free of k"


def test_how_often_a_relation_was_differentiated_is_told_in_words() -> None:
    assert order_line(0) == []
    assert [order_line(n)[0].partition(":")[0] for n in (1, 2, 3)] == [
        "  differentiated once", "  differentiated 2 times", "  differentiated 3 times",
    ]  # fmt: skip
    assert order_line(-1)[0].startswith("  since the start")


def test_a_place_in_another_file_has_its_name() -> None:
    other = Source("parts/cable.bg", "bg 1\nmodel C {}\n")
    span = Span(other, 5, 6)
    assert place(span) == place(span, other) == "line 2"
    assert place(span, Source("m.bg", "")) == "cable.bg line 2"


def test_signatures_have_their_orders_groups_and_what_nobody_sees() -> None:
    """u - R i - y and i - D(k y): R and u have the same row, v has none."""
    text = dump_signatures(_circuit().signatures)
    matrix, orders, groups, last = text.split("\n\n")
    assert len(matrix.splitlines()) == 1 + 6  # a row a fault: R, k, u, v, i, y
    assert sorted(orders.splitlines()[1].split(": ")[1].split(", ")) == ["i 0", "u 0", "y 0"]
    assert sorted(orders.splitlines()[2].split(": ")[1].split(", ")) == ["i 0", "y 1"]
    assert [orders.splitlines()[0], *groups.splitlines()] == [
        "orders", "groups", "  R, u", "  k", "  i, y",
    ]  # fmt: skip
    assert last == "undetectable: v"


def test_a_tree_has_its_parts_two_blanks_further_in_each_with_its_place() -> None:
    lines = dump_syntax(Compilation(Source("m.bg", _CIRCUIT)).syntax).splitlines()
    assert lines[:8] == [
        "File edition=1  @1:1",
        "  models: 1",
        "    Model name='M'  @2:1",
        "      body: 5",  # two parameters and three junctions
        "        Param keyword='param' unit='Ohm'  @2:11",
        "          name: Part name='R'  @2:17",
        "        Param keyword='param'  @2:26",
        "          name: Part name='k'  @2:32",
    ]
    assert lines[8] == "          value: Number value=3 text='3'  @2:36"
    assert sum(line.startswith("        Junction") for line in lines) == 3


def test_columns_are_as_wide_as_what_has_another_column_behind_it() -> None:
    """The last word of a row needs no room; rows may be of different lengths."""
    assert table([("a", "long word"), ("abc", "d", "e"), ("b",)], "") == [
        "a    long word",
        "abc  d  e",
        "b",
    ]
    assert table([("a", "", ""), ("b", "c", "d")]) == ["  a", "  b  c  d"]
    assert table([]) == []


def test_a_reason_names_its_node() -> None:
    causal = _circuit().integral
    at = next(n for n, node in enumerate(causal.graph.nodes) if node.path == "R")
    causes = ("law", "chosen", "switched", "ring")
    assert [reason(causal, Reason(cause, at)) for cause in causes] == [
        "fixed by the law of R", "chosen at R", "while R is off", "closes a ring at R",
    ]  # fmt: skip
    assert reason(causal, Reason("propagated", at)) == "forced at R"


def test_what_is_declared_of_a_value_or_a_signal_stands_beside_it() -> None:
    found = _sections("""model M { param R = 4 Ohm +- 5%; input U; const k = 2 H
      1:s { <- Se:u = delay(U, 0.25 s); -> R:R; -> I:L = k }
      sensor y : A = delay(s.f, 0.5 s) }""")
    assert [[word.strip() for word in row] for row in found["values"]] == [
        ["param", "R", "4", "Ohm", "+- 5%", "fault"], ["const", "k", "2", "H"],
    ]  # fmt: skip
    assert [word.strip() for word in found["inputs"][0]] == ["U", "known, 0.25 s late", "V"]
    assert [word.strip() for word in found["sensors"][0]][-2:] == ["delay(s.f, 0.5 s)", "A"]


def test_what_a_relation_was_differentiated_for_is_told_above_it() -> None:
    compilation = _circuit()
    residual = compilation.residuals.residual_set.residuals[1]._replace(differentiated=2)
    *_, line, last = residual_path(residual, compilation.source).splitlines()
    assert [line] == order_line(2) and last == "  0 = s.f - C.f"
