"""Settings of switched junctions, and what the sources forbid of them, by hand."""

from __future__ import annotations

import pytest

from bondgraph.compilation import Compilation
from bondgraph.ir.graph import BondGraph
from bondgraph.passes.causality.rules import demands, network
from bondgraph.passes.causality.switches import held, settings, sound_in_a_mode
from bondgraph.text.diagnostic import Diagnostic
from bondgraph.text.source import Source


def compiled(text: str, *inputs: str) -> Compilation:
    lines = "\n".join(f"input {name} : bool" for name in inputs)
    return Compilation(Source("m.bg", f"bg 1\nmodel M {{\n{lines}\n{text}\n}}\n"))


def told(graph: BondGraph) -> list[tuple[dict[str, bool], set[str]]]:
    """The settings by the names of modes, and the junctions that are off with each."""
    return [
        ({atom.symbol.name: value for atom, value in setting}, {graph.nodes[n].path for n in off})
        for setting, off in settings(graph)
    ]


_JUNCTION = "1:{0} when {1} {{ <- Se:u{0}; -> R:r{0} = 1 }}\n"


def junctions(**when: str) -> str:
    return "".join(_JUNCTION.format(name, condition) for name, condition in when.items())


def test_the_settings_of_two_switches_those_with_most_on_first() -> None:
    graph = compiled(junctions(a="p", b="not p", c="p and q", d="p or q"), "p", "q").graph
    assert told(graph) == [
        ({"p": True, "q": True}, {"b"}),
        ({"p": True, "q": False}, {"b", "c"}),
        ({"p": False, "q": True}, {"a", "c"}),
        ({"p": False, "q": False}, {"a", "c", "d"}),
    ]
    plain = compiled("1:a { <- Se:u; -> R:r = 1 }").graph
    assert told(plain) == [({}, set())]


def test_of_more_than_eight_switches_the_first_eight_are_set_and_the_others_on() -> None:
    names = [f"p{k}" for k in range(9)]
    graph = compiled(junctions(**{f"j{k}": name for k, name in enumerate(names)}), *names).graph
    found = told(graph)
    assert len(found) == 2**8 and all(len(setting) == 8 for setting, _ in found)
    assert found[-1] == (dict.fromkeys(names[:8], False), {f"j{k}" for k in range(8)})
    assert all("j8" not in off for _, off in found)


@pytest.mark.parametrize(("kind", "side"), [("1", "flow"), ("0", "effort")])
def test_a_junction_that_is_off_imposes_its_flow_or_effort_on_all_its_bonds(
    kind: str, side: str
) -> None:
    source = "Se" if kind == "1" else "Sf"
    text = f"{kind}:a when p {{ <- {source}:u; -> R:r = 1; -> R:s = 2 }}"
    graph = compiled(text, "p").graph
    net, _ = network(graph)
    (at,) = [n for n, node in enumerate(graph.nodes) if node.path == "a"]
    part, imposed = held(net, frozenset({at}))
    assert part.ends == [] and part.bonds == net.bonds
    assert sorted(wish.bond for wish in imposed) == [0, 1, 2]
    for wish in imposed:
        bond = graph.bonds[wish.bond]
        # the stroke is where effort is taken: at the junction if it gives flow, else at the other
        own = int(bond.head.node == at)
        assert wish.value == (own if side == "flow" else 1 - own)
        assert (wish.node, wish.port, wish.cause) == (at, -1, "switched")  # it has no ports
    same, none = held(net, frozenset())
    assert same.ends == net.ends and none == []


@pytest.mark.parametrize(
    ("text", "inputs", "sound"),
    [
        (junctions(a="p"), "p", True),
        ("1:a { <- Se:u; -> R:r = 1 }", "", False),  # nothing switches
        ("1:a when p { <- Sf:u; <- Sf:v; -> R:r = 1 }", "p", False),  # on two flows, off more
        # beside two efforts at one place no setting helps
        (junctions(a="p") + "0:n { <- Se:x; <- Se:y; -> R:z = 1 }", "p", False),
        # switches that take turns between two sources of effort at a coil
        ("1:a when p { <- Se:E; -> x }\n1:b when not p { <- Se:G; -> x }\n0:x -> 1:i\ni -> I:L = 1",
         "p", True),
    ],
)  # fmt: skip
def test_a_graph_is_sound_if_it_is_with_some_setting(text: str, inputs: str, sound: bool) -> None:
    graph = compiled(text, *inputs.split()).graph
    net, at = network(graph)
    assert sound_in_a_mode(graph, net, demands(graph, at, "integral")[0]) is sound


def warnings(text: str, *inputs: str) -> list[Diagnostic]:
    model = compiled(text, *inputs)
    _ = model.integral
    return [d for d in model.report.diagnostics if d.code == "switch-conflict"]


#: A pump that a switch cuts off.
_CUT = "1:sw{0} when {1} {{ <- Sf:pump{0}{2}; -> R:r{0} = 1 }}\n"


def test_each_switch_is_looked_at_by_itself_and_told_by_its_own_junction() -> None:
    text = _CUT.format("1", "p", "") + junctions(b="p") + _CUT.format("2", "not q", "")
    found = warnings(text, "p", "q")
    assert [d.message.partition(" lets")[0] for d in found] == [
        "While `p` does not hold, 1:sw1",
        "While `q` holds, 1:sw2",
    ]
    assert "`if(p, ..., 0)`" in str(found[0].help)
    assert "`if(not (q), ..., 0)`" in str(found[1].help)
    for d, name in zip(found, ("1", "2"), strict=True):
        shown = " ".join(label.span.text for label in d.labels)
        assert f"pump{name}" in shown and f"pump{3 - int(name)}" not in shown


def test_a_source_that_follows_the_mode_by_any_of_its_laws_is_no_conflict() -> None:
    assert warnings(_CUT.format("", "p", " = if(p, 2, 0)"), "p") == []
    assert warnings(_CUT.format("", "p and q", " = if(q, 2, 0)"), "p", "q") == []
    assert len(warnings(_CUT.format("", "p", " = if(q, 2, 0)"), "p", "q")) == 1


@pytest.mark.parametrize(("count", "told"), [(40, 40), (41, 0)])
def test_forty_switches_are_tried_and_no_more(count: int, told: int) -> None:
    names = [f"p{k}" for k in range(count)]
    text = "".join(_CUT.format(k, name, "") for k, name in enumerate(names))
    assert len(warnings(text, *names)) == told
