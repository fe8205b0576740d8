"""What is said about conflicts: who, which way, and changes that a SAT solver finds to mend it."""

from __future__ import annotations

import re

import pytest

from bondgraph.compilation import Compilation
from bondgraph.ir.expr import Pool
from bondgraph.ir.graph import BondGraph
from bondgraph.passes.causality.conflicts import conflicts
from bondgraph.passes.causality.cores import cores
from bondgraph.passes.causality.explanation import explanation
from bondgraph.passes.causality.mends import Change, mends
from bondgraph.passes.causality.rules import demands, network
from bondgraph.text.diagnostic import CompileError, Diagnostic
from bondgraph.text.source import Source, Span
from tests.unit.passes.causality_graphs import assemble, build
from tests.unit.passes.causality_random import SHAPES, random_graph
from tests.unit.passes.causality_sat import hard, most


def changed(graph: BondGraph, change: Change) -> BondGraph:
    """The graph after a change, drawn anew."""
    span = Span(Source("changed.bg", " "), 0, 1)
    kinds = [(node.kind, f"n{n}", False, span) for n, node in enumerate(graph.nodes)]
    bonds = [(bond.tail.node, bond.head.node, span) for bond in graph.bonds]
    if change.drop >= 0:
        bonds = [bond for bond in bonds if change.drop not in bond[:2]]
    elif change.cut >= 0:
        del bonds[change.cut]
    elif change.turn >= 0:
        kind = {"0": "1", "1": "0", "Se": "Sf", "Sf": "Se"}[graph.nodes[change.turn].kind]
        kinds[change.turn] = (kind, *kinds[change.turn][1:])
    elif change.splice is not None:
        at, kind = change.splice
        tail, head, _ = bonds.pop(at)
        new = len(kinds)
        kinds += [(kind, "junction", False, span), ("R", "loss", False, span)]
        bonds += [(tail, new, span), (new, head, span), (new, new + 1, span)]
    else:
        bonds.append((change.grow, len(kinds), span))
        kinds.append(("R", "more", False, span))
    return assemble(span.source, Pool(), kinds, bonds)


@pytest.mark.parametrize("shape", SHAPES)
def test_every_proposed_change_mends(shape: str) -> None:
    proposed = 0
    for seed in range(60):
        graph = random_graph(seed, shape)
        net, at = network(graph)
        found = cores(net, demands(graph, at, "integral")[0])
        if len(found) != 1:  # others would still be there
            continue
        nodes = found[0].nodes(net)
        alike = list(range(len(graph.nodes)))
        told = explanation(graph, net, found[0])
        for change, text, _ in mends(graph, nodes, told, set(), alike):
            proposed += 1
            assert most(hard(changed(graph, change)), []) is not None, text
    assert proposed > 10


def findings(text: str) -> list[Diagnostic]:
    """The errors of a model given by the lines between its braces."""
    with pytest.raises(CompileError) as caught:
        _ = Compilation(Source("m.bg", f"bg 1\nmodel M {{\n{text}\n}}\n")).integral
    errors = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert {d.code for d in errors} == {"causality-conflict"}
    return errors


CASES = {
    "pumps": ("Sf:a -> 1:line; Sf:b -> line; line -> R:hose = 2; line -> Df:y", {"a", "b", "line"}),
    "chain": (
        "Se:a -> TF:s { e1 = 2*e2 } -> TF:t { e1 = 3*e2 } -> 0:bus; Se:b -> bus; bus -> C:c = 1; "
        "bus -> De:y",
        {"a", "s", "t", "b", "bus"},
    ),
    "gyrators": (
        "Se:u -> 1:arm -> GY:m = 2 -> 1:shaft -> GY:g = 3 -> 0:bus; Sf:w -> shaft; Se:grid -> bus; "
        "arm -> R:r = 1; bus -> R:s = 1",
        {"shaft", "g", "bus", "w", "grid"},
    ),
    "ring": (
        "Se:tx -> 1:x; Se:ty -> 1:y; Se:tz -> 1:z; x -> GY:a = 1 -> y; y -> GY:b = 2 -> z; "
        "z -> GY:c = 3 -> x; x -> Df:wx",
        {"x", "y", "z", "a", "b", "c", "tx", "ty", "tz", "wx"},
    ),
    "detectors": (
        "Sf:q -> 0:tank; tank -> De:p1; tank -> 1:pipe -> 0:out; out -> De:p2; out -> Sf:leak",
        {"tank", "pipe", "out", "q", "p1", "p2", "leak"},
    ),
    "field": (
        "C:f { port x; port y; x.e = x.q + y.q; y.e = x.q + 2*y.q }; Se:a -> TF:t { e1 = 2*e2 } "
        "-> 0:n; n -> f.x; 0:m -> f.y; n -> TF:s { e1 = 2*e2 } -> m; Se:b -> m; m -> De:y",
        {"a", "t", "n", "s", "m", "b"},
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_all_members_are_named_and_shown(case: str) -> None:
    text, members = CASES[case]
    (error,) = findings(text)
    spoken = set(re.findall(r"\b\w+:(\w+)", error.message + error.help))
    shown = {re.split(r"[ :=]", label.span.text)[1] for label in error.labels if label.text}
    assert members <= spoken | shown
    assert members >= shown
    assert len({label.span for label in error.labels}) == len(error.labels)
    assert error.help.count("\n- ") >= 2


@pytest.mark.parametrize(
    ("case", "roles"),
    [
        # into the tank flows what q says, and nothing into its gauge: the pipe has to answer
        ("detectors", {"tank": "only 1:pipe is left to impose its effort",
                       "pipe": "has the flow of 0:tank", "q": "imposes a flow"}),
        ("field", {"t": "passes the effort on", "n": "has the effort of TF:t"}),
        ("gyrators", {"shaft": "has the flow of Sf:w", "g": "makes an effort of it"}),
    ],
)  # fmt: skip
def test_what_each_member_does_on_the_way(case: str, roles: dict[str, str]) -> None:
    (error,) = findings(CASES[case][0])
    told = {re.split(r"[ :=]", label.span.text)[1]: label.text for label in error.labels}
    assert {name: told[name] for name in roles} == roles


@pytest.mark.parametrize(
    ("line", "hose", "link", "loss"),
    [
        ("line", "hose", "link", "loss"),
        ("link", "loss", "link2", "loss2"),  # a word that is taken gets a number, from two on
        ("loss", "link", "link2", "loss2"),
        ("loss", "link2", "link", "loss2"),
    ],
)
def test_the_lines_proposed_can_be_written_into_the_model(
    line: str, hose: str, link: str, loss: str
) -> None:
    text = CASES["pumps"][0].replace("; ", "\n").replace("line", line).replace("hose", hose)
    (error,) = findings(text)
    (first, *_) = re.findall(r"\n    (.*)", error.help)
    assert re.findall(r"[01R]:(\w+)", first) == [link, loss]
    bond = first.split(" -> ")[0]  # the name of the source whose bond gets the junction
    mended = re.sub(rf"Sf:{bond} -> [^\n]*", f"Sf:{bond}\n{first}", text)
    assert mended != text
    source = Source("m.bg", f"bg 1\nmodel M {{\n{mended}\n}}\n")
    assert Compilation(source).integral.strokes


def test_two_ways_from_one_place_are_told_from_where_they_fork() -> None:
    (error,) = findings(
        "Se:u -> 1:i -> 0:a -> TF:s { e1 = 2*e2 } -> 0:c; a -> 0:b -> TF:t { e1 = 3*e2 } -> c; "
        "c -> R:r = 1; i -> Df:y"
    )
    assert error.message == (
        "TF:t receives effort from both sides, by 0:a (through 0:b) and 0:a (through TF:s "
        "and 0:c); the effort of 0:a is fixed by Se:u and Df:y (through 1:i)."
    )
    assert "between TF:t and 0:c" in error.help


def test_a_bond_that_closes_a_ring_is_left_out_beside_a_transformer() -> None:
    (error,) = findings("Se:u -> 0:a -> TF:s { e1 = 2*e2 } -> 0:c; a -> c; c -> R:r = 1")
    assert "\n- leave out the bond between 0:a and 0:c\n" in error.help


def test_a_loop_is_proved_by_two_cases() -> None:
    (error,) = findings(CASES["ring"][0])
    assert error.message.startswith("1:x, 1:y and 1:z cannot all get their flow beside ")
    assert error.help.startswith(
        "If GY:a imposes the flow of 1:x, 1:y gets two flows, by GY:a and GY:b; if not, 1:y gets "
        "no flow. Each of these mends it:\n"
    )


def test_where_no_single_bond_proves_it_the_first_junction_stands_for_all() -> None:
    """Three 0-junctions, each bonded to all of four 1-junctions.

    A bond is strong at both of its junctions or at none, so that strong bonds would pair each 0
    with a 1 of its own, and one is left over. One pair taken away leaves two and three, weak at one
    bond leaves two others: whichever bond is looked at, nothing follows from its stroke.
    """
    zeros, ones = ["a", "b", "c"], ["p", "q", "r", "s"]
    nodes = [f"0:{n}" for n in zeros] + [f"1:{n}" for n in ones]
    graph = build("; ".join(nodes + [f"{a} -> {p}" for a in zeros for p in ones]))
    net, at = network(graph)
    (core,) = cores(net, demands(graph, at, "integral")[0])
    told = explanation(graph, net, core)
    assert told.physics.endswith("these bonds are too few or too many.")
    assert told.meet == net.name[0] == min(core.nodes(net))


def test_what_instances_repeat_is_told_once_and_mended_in_all() -> None:
    source = Source(
        "m.bg",
        "bg 1\nmodel Cell { port a : in electrical; a -> 0:n <- Se:inner; n -> R:r; const r = 1 }\n"
        "model M { Se:u -> 0:bus; Cell:cell[5]; for j in 1..5 { bus -> cell[j].a } }\n",
    )
    with pytest.raises(CompileError) as caught:
        _ = Compilation(source).integral
    (error,) = caught.value.diagnostics
    assert "Se:cell[" in error.message
    assert "(and the 4 like it)" in error.help


def test_a_sound_graph_has_no_conflict() -> None:
    assert conflicts(build("Se:u -> 1:i -> I:l; i -> R:r")) == ()


def test_the_strokes_that_clash_are_kept() -> None:
    graph = build("Se:a -> 0:n <- Se:b; n -> R:r")
    (conflict,) = conflicts(graph)
    assert conflict.nodes == (1, 0, 2)
    assert conflict.bonds == (0, 1)
    assert conflict.meet == 1
    assert conflict.strokes == ((0, "head"), (1, "head"))  # both bonds bring their effort to 0:n


def warnings(text: str) -> list[Diagnostic]:
    """What is said about the switches of a sound model."""
    model = Compilation(Source("m.bg", f"bg 1\nmodel M {{\ninput on : bool\n{text}\n}}\n"))
    _ = model.integral
    return [d for d in model.report.diagnostics if d.code == "switch-conflict"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "1:sw when on { <- Sf:pump; -> R:r = 1 }",
            "While `on` does not hold, 1:sw lets no flow through, but then the flow of one bond is "
            "imposed at both ends, by 1:sw and Sf:pump.",
        ),
        (
            "Se:u -> 1:in\n 0:bus when not on { <- in; -> R:r = 1 }\n in -> I:l = 1",
            "",  # the coil carries what the short asks for
        ),
        (
            "Se:u -> TF:t { e1 = 2*e2 } -> bus\n 0:bus when not on { -> R:r = 1 }",
            "While `on` holds, 0:bus has no effort, but then TF:t receives effort from "
            "both sides, by 0:bus and Se:u.",
        ),
        (
            "Sf:q -> 0:tank\n 1:valve when on { <- tank; -> R:r = 1 }\n tank -> De:y",
            "While `on` does not hold, 1:valve lets no flow through, but then nothing imposes the "
            "effort of 0:tank: Sf:q, 1:valve and De:y all take the effort from it.",
        ),
        ("Sf:q -> 0:tank\n 1:valve when on { <- tank; -> R:r = 1 }\n tank -> C:c = 1", ""),
        ("1:sw when on { <- Sf:pump = if(on, 2, 0); -> R:r = 1 }", ""),
        # two ways, one of which may be open while the other is closed
        (
            "input up : bool\n Sf:q -> 0:n\n 1:a when on { <- n; -> R:r = 1 }\n"
            "1:b when up { <- n; -> R:s = 1 }",
            "",
        ),
    ],
)
def test_a_switch_that_cannot_be_off_is_told(text: str, message: str) -> None:
    assert [d.message for d in warnings(text)] == ([message] if message else [])


def test_a_change_shows_at_all_like_places_of_the_first_node_too() -> None:
    # one text drawn twice, with its junction first; as a 1-junction it has a flow: that of its R
    graph = build("0:n <- Se:a; n <- Se:b; n -> R:r; 0:m <- Se:c; m <- Se:d; m -> R:s")
    net, at = network(graph)
    core = cores(net, demands(graph, at, "integral")[0])[0]
    alike = [0, 1, 2, 3] * 2
    found = mends(graph, core.nodes(net), explanation(graph, net, core), set(), alike)
    (text,) = [mend.text for mend in found if mend.change == Change(turn=0)]
    assert text.startswith("make 0:n (and the 1 like it) a 1-junction")


@pytest.mark.parametrize(("work", "proposals"), [(2, 1), (3, 2), (5, 2), (6, 3)])
def test_work_on_proposals_ends(
    work: int, proposals: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    graph = build("Se:a -> 0:n <- Se:b; n -> R:r")
    net, at = network(graph)
    (core,) = cores(net, demands(graph, at, "integral")[0])
    told, nodes = explanation(graph, net, core), core.nodes(net)
    every = mends(graph, nodes, told, set(), [0, 1, 2, 3])
    assert len(every) > 3
    # a trial of the whole model looks at its three bonds; the last one may take more than is left
    monkeypatch.setattr("bondgraph.passes.causality.mends._WORK", work)
    assert mends(graph, nodes, told, set(), [0, 1, 2, 3]) == every[:proposals]


_TURNS = """1:a when {0} {{ <- Se:E; -> x }}
1:b when {1} {{ <- Se:G; -> x }}
0:x -> 1:i
i -> I:L = 1"""


@pytest.mark.parametrize(
    ("one", "other"),
    [("on", "not on"), ("on and up", "not on or not up"), ("on or up", "not on and not up")],
)
def test_ideal_switches_may_take_turns(one: str, other: str) -> None:
    """Never on together, the two are no conflict, and there is no mode to warn of."""
    text = "input up : bool\n" + _TURNS.format(one, other)
    assert warnings(text) == []
    model = Compilation(Source("m.bg", f"bg 1\nmodel M {{\ninput on : bool\n{text}\n}}\n"))
    assert model.conflicts == ()
    imposed = [s.reason.cause for s in model.integral.strokes]
    assert imposed.count("switched") == 2  # both bonds of the junction that is off


#: A coil that the switches lay beside the source and beside a capacitor.
_LIFTS = """1:a when on {{ <- Se:E; -> x }}
1:b when {} {{ <- x; -> out }}
0:x -> 1:i -> I:L = 1
0:out {{ -> C:c = 1; -> R:r = 1 }}"""


def test_a_storage_is_not_told_to_depend_on_a_switch_that_is_never_on_with_its_own() -> None:
    """A buck-boost converter: only with both switches on would the source lie at the capacitor."""
    start = "input on : bool\ninput up : bool\n"
    dependent = []
    for when in ("not on", "up"):
        text = f"bg 1\nmodel M {{\n{start}{_LIFTS.format(when)}\n}}\n"
        model = Compilation(Source("m.bg", text))
        assert model.integral is not None
        dependent.append([model.graph.nodes[s.node].path for s in model.integral.dependent])
    assert dependent == [[], ["c"]]


def test_switches_that_may_meet_are_warned_of_in_the_mode_in_which_they_do() -> None:
    found = warnings("input up : bool\n" + _TURNS.format("on", "up"))
    assert [d.message for d in found] == [
        "While `on` holds and `up` holds, nothing imposes the flow of 1:b: Se:E (through 1:a and "
        "0:x) and Se:G both take the flow from it."
    ]
    assert "Where the machine never is in it" in str(found[0].help)


def test_a_conflict_in_every_mode_is_an_error() -> None:
    text = "input on : bool\n1:s when on { <- Se:a; -> R:r = 1 }\nSe:b -> 0:n <- Se:c; n -> De:y"
    model = Compilation(Source("m.bg", f"bg 1\nmodel M {{\n{text}\n}}\n"))
    names = [[model.graph.nodes[n].path for n in c.nodes] for c in model.conflicts]
    assert names == [["n", "b", "c"]]
