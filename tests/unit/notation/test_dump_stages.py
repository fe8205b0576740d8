"""The stages of a model as text: what stands beside each node, and what is not said of it."""

from __future__ import annotations

from bondgraph.compilation import Compilation
from bondgraph.notation.dump_stages import dump_graph
from bondgraph.text.source import Source


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
