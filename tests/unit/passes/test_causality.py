"""Causality of single graphs: strokes, reasons, dualised detectors, loops and messages."""

from __future__ import annotations

import subprocess
import sys
from itertools import product

import pytest

from bondgraph.compilation import Compilation
from bondgraph.ir.causal import CausalGraph, Reason
from bondgraph.ir.expr import Pool
from bondgraph.passes.causality.assign import _exact, _free_choices, _greedy, assign
from bondgraph.passes.causality.cores import oblige
from bondgraph.passes.causality.repair import Matching
from bondgraph.passes.causality.rules import demands, network
from bondgraph.passes.causality.strokes import Strokes
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source, Span
from tests.unit.passes.causality_graphs import assemble, broken_rules, build, receivers

MOTOR = "Se:U -> 1:i -> I:L; i -> R:Re; i -> GY:k -> 1:w -> I:J; w -> R:f; w -> Df:speed"


def causal(text: str, preference: str = "integral") -> CausalGraph:
    result = assign(build(text), preference, Report())  # type: ignore[arg-type]
    assert result is not None
    return result


def names(graph: CausalGraph, nodes: tuple[int, ...]) -> list[str]:
    return [graph.graph.nodes[n].path for n in nodes]


def refusal(text: str) -> tuple[str, list[str]]:
    report = Report()
    assert assign(build(text), "integral", report) is None
    (error,) = report.diagnostics
    assert error.code == "causality-conflict"
    assert error.help
    return error.message, [label.span.text for label in error.labels]


def test_a_dc_motor_has_all_storages_integral() -> None:
    motor = causal(MOTOR)
    at = names(motor, tuple(receivers(motor)))
    # Se and the gyrator bring efforts to 1:i, L answers with the current, and so on
    assert at == ["i", "L", "i", "i", "w", "J", "w", "w"]
    assert [s.integral for s in motor.storages] == [True, True]
    assert motor.loops == ()
    assert [s.reason.cause for s in motor.strokes] == [
        "source", "preferred", "propagated", "propagated",
        "propagated", "preferred", "propagated", "sensor",
    ]  # fmt: skip


def test_the_dualised_tachometer_imposes_the_speed() -> None:
    motor = causal(MOTOR, "derivative")
    assert names(motor, motor.dualised) == ["speed"]
    assert not any(s.integral for s in motor.storages)
    assert names(motor, (receivers(motor)[7],)) == ["speed"]


@pytest.mark.parametrize(
    ("text", "dualised", "plain"),
    [
        ("Se:u -> 0:n -> R:r; n -> De:y", [], ["y"]),  # the source fixes what De reads
        ("1:v -> I:m; v -> R:b; v -> Df:y1; v -> Df:y2", ["y1"], ["y2"]),
        ("1:v -> I:m; v -> TF:g -> 1:w -> R:b; v -> Df:y1; w -> Df:y2", ["y1"], ["y2"]),
        ("Sf:q -> 0:a -> R:r; a -> De:y1; a -> 1:b -> R:s; b -> Df:y2", ["y1", "y2"], []),
    ],
)
def test_a_detector_that_would_conflict_stays(
    text: str, dualised: list[str], plain: list[str]
) -> None:
    graph = causal(text, "derivative")
    assert names(graph, graph.dualised) == dualised
    assert names(graph, graph.not_dualised) == plain


def test_a_law_that_is_not_linear_in_one_case_is_used_as_it_is_written() -> None:
    # both R could impose the flow; a would have to invert its square for it, b only divides
    model = Compilation(
        Source(
            "m.bg",
            "bg 1\nmodel M {\ninput on : bool\nparam g = 1\n"
            "1:s { <- Se:u; -> R:b = 1; -> R:a { e = if(on, f*abs(f), f) } }\n}\n",
        )
    )
    strokes = dict(zip("uba", model.integral.strokes, strict=True))
    assert strokes["a"].reason.cause == "law"
    assert [strokes[name].at for name in "uba"] == ["head", "head", "tail"]


@pytest.mark.parametrize(
    ("text", "at"),
    [
        ("Se:u -> R:r", ["r"]),
        ("R:r -> Se:u", ["r"]),
        ("Sf:q -> R:r", ["q"]),
        ("C:c -> I:l", ["l"]),
        ("Se:u -> C:c", ["c"]),
        ("R:r! -> R:s", ["r"]),
        ("Se:u -> TF:t -> R:r", ["t", "r"]),
        ("Se:u -> GY:t -> R:r", ["t", "t"]),
        ("Se:u -> TF:t -> TF:s -> C:c", ["t", "s", "c"]),
        ("Se:u -> 0:a -> 0:b -> R:r", ["a", "b", "r"]),
        ("Se:u -> 1:a -> 1:b -> I:r", ["a", "b", "r"]),
    ],
)
def test_bonds_without_junctions_and_chains_of_equals(text: str, at: list[str]) -> None:
    graph = causal(text)
    assert names(graph, tuple(receivers(graph))) == at


@pytest.mark.parametrize("text", ["1:v -> I:a; v -> I:b", "1:v <- I:a; v <- I:b"])
@pytest.mark.parametrize("preference", ["integral", "derivative"])
def test_a_refused_wish_that_follows_from_others_is_no_dead_end(text: str, preference: str) -> None:
    """One of two inertias of one speed has to follow: no search is needed to find that out.

    Both ways of drawing the bonds, as the stroke that stands is 0 in one and 1 in the other.
    """
    graph = build(text)
    net, at = network(graph)
    musts, wishes = demands(graph, at, preference)[:2]  # type: ignore[arg-type]
    strokes = Strokes(net)
    assert oblige(strokes, musts) is None
    assert _greedy(strokes, wishes)
    assert sum(strokes.value[w.bond] == w.value for w in wishes) == 1


def test_fields_are_assigned_port_by_port() -> None:
    # an I-field on two meshes, one of which has a current source: mixed causality
    graph = causal("Se:u -> 1:a -> I:m; Sf:q -> 1:b -> m; a -> R:r; b -> R:s")
    assert [(s.port, s.integral) for s in graph.storages] == [(0, True), (1, False)]


def test_a_law_that_gives_flow_is_used_that_way() -> None:
    text = "Sf:q -> 0:a -> R:orifice!; a -> R:linear"
    graph = causal(text)
    assert names(graph, tuple(receivers(graph)))[1] == "orifice"
    assert graph.strokes[1].reason.cause == "law"
    assert names(graph, graph.loops[0]) == ["orifice", "linear"]


@pytest.mark.parametrize(
    ("ring", "what"),
    [
        ("Se:u -> 1:i -> 0:a -> 0:b -> 0:c -> a; c -> R:r; i -> Df:y", "flow"),
        ("Sf:u -> 0:i -> 1:a -> 1:b -> 1:c -> a; c -> R:r; i -> De:y", "effort"),
        ("C:u -> 0:a -> 0:b; a <- b; b -> R:r", "flow"),
        ("Se:u -> 1:a -> 1:b; a -> 1:c; b -> 1:d; c -> d; d -> I:r", "effort"),
    ],
)
def test_a_ring_of_like_junctions_is_one_junction(ring: str, what: str) -> None:
    report = Report()
    graph = assign(build(ring), "integral", report)
    assert graph is not None
    assert [s.reason.cause for s in graph.strokes].count("ring") == 1
    assert broken_rules(graph.graph, tuple(int(s.at == "head") for s in graph.strokes), set()) == []
    (note,) = report.diagnostics
    assert (note.severity, note.code) == ("warning", "junction-ring")
    assert f"what {what} it carries is not determined" in note.message


@pytest.mark.parametrize("closes", ["c -> a", "a -> c"])
def test_a_bond_that_closes_a_ring_has_its_stroke_at_the_junction_that_comes_later(
    closes: str,
) -> None:
    """Whichever way it is drawn; that junction is the reason."""
    graph = assign(build(f"Se:u -> 1:i -> 0:a -> 0:b -> 0:c; {closes}; c -> R:r"), "integral",
                   Report())  # fmt: skip
    assert graph is not None
    nodes = graph.graph.nodes
    ((bond, stroke),) = [
        (b, s) for b, s in zip(graph.graph.bonds, graph.strokes, strict=True)
        if s.reason.cause == "ring"
    ]  # fmt: skip
    at = bond.head if stroke.at == "head" else bond.tail
    assert nodes[at.node].path == "c" and stroke.reason.node == at.node


def test_resistances_in_series_form_a_loop_and_a_storage_between_them_opens_it() -> None:
    assert [len(loop) for loop in causal("Se:u -> 1:a -> R:r; a -> R:s").loops] == [2]
    assert causal("Se:u -> 1:a -> R:r; a -> 0:b -> R:s; b -> C:c").loops == ()


def test_a_ring_of_junctions_has_a_loop_of_efforts_and_one_of_flows() -> None:
    # a gives its effort to b, b to t, t to a; the flow of each bond comes from the other end, so
    # that flows go round the other way. r answers to the effort of a and feeds the second loop:
    # it is in neither.
    graph = causal("0:a -> TF:t -> 0:b; a -> b; a -> R:r")
    assert [names(graph, loop) for loop in graph.loops] == [["a", "t", "b"], ["a", "t", "b"]]


def test_two_effort_sources_meet_at_a_junction() -> None:
    message, places = refusal("Se:a -> 0:n <- Se:b; n -> R:r")
    assert message == "The effort of 0:n is imposed twice, by Se:a and Se:b."
    assert places == ["0:n", "Se:a", "Se:b"]


def test_the_way_to_the_conflict_is_told() -> None:
    message, places = refusal(
        "Se:a -> 1:x -> R:r; x -> 0:y -> C:c; Se:b -> 0:n -> TF:t -> 0:m <- Se:d; m -> R:s"
    )
    assert message == "The effort of 0:m is imposed twice, by Se:b (through 0:n and TF:t) and Se:d."
    assert places == ["0:m", "Se:b", "Se:d", "TF:t", "0:n"]


def test_nobody_imposes_the_effort() -> None:
    message, _ = refusal("Sf:a -> 0:n <- Sf:b; n -> De:y")
    assert message == (
        "Nothing imposes the effort of 0:n: Sf:a, Sf:b and De:y all take the effort from it."
    )


@pytest.mark.parametrize(
    ("text", "start"),
    [
        ("Sf:a -> 1:n <- Sf:b", "The flow of 1:n is imposed twice, by Sf:a and Sf:b"),
        ("Se:a -> 1:n <- Se:b", "Nothing imposes the flow of 1:n: Se:a and Se:b both take"),
        ("Se:a -> TF:t <- Se:b", "TF:t receives effort from both sides, by Se:a and Se:b"),
        ("Sf:a -> TF:t <- Sf:b", "TF:t receives a flow from both sides, by Sf:a and Sf:b"),
        ("Se:a -> GY:t <- Sf:b", "GY:t receives"),
        ("Se:a -> Se:b", "The effort of one bond is imposed at both ends, by Se:a and Se:b"),
        ("Sf:a -> Sf:b", "The flow of one bond is imposed at both ends, by Sf:a and Sf:b"),
        ("Sf:a -> De:b", "The flow of one bond is imposed at both ends, by Sf:a and De:b"),
        ("0:alone", "Nothing imposes the effort of 0:alone: it has no bond"),
        (
            "1:c -> 0:x; c -> 0:y",
            "Nothing imposes the effort of 0:y: 0:x (through 1:c) takes the effort from it",
        ),
        (
            "1:a -> GY:x -> 1:b -> GY:y -> 1:c -> GY:z -> a",
            "1:a, 1:b and 1:c cannot all get their flow.",
        ),
    ],
)
def test_each_kind_of_conflict_has_its_words(text: str, start: str) -> None:
    message, _ = refusal(text)
    assert message.startswith(start), message


def test_independent_conflicts_are_independent_errors() -> None:
    report = Report()
    assign(build("Se:a -> 0:n <- Se:b; Sf:c -> 1:m <- Sf:d"), "integral", report)
    assert [d.message.split(" is ")[0] for d in report.diagnostics] == [
        "The effort of 0:n",
        "The flow of 1:m",
    ]


def test_dependent_storages_name_their_partner() -> None:
    report = Report()
    text = "Se:u -> 1:a -> I:j1; a -> TF:g -> 1:b -> I:j2; b -> R:r"
    assert assign(build(text), "integral", report) is not None
    (note,) = report.diagnostics
    assert (note.severity, note.code) == ("info", "dependent-storage")
    assert note.message == (
        "I:j2 is in derivative causality: its flow is fixed by I:j1, which has the state."
    )


def test_no_storage_is_its_own_partner() -> None:
    # the gyrator on one node gives back to j1 what j1 takes: the search comes round to it
    report = Report()
    text = "1:a -> 0:n; n -> GY:g -> n; 0:m -> R:r; a -> I:j1; m -> I:j2; a -> m"
    assert assign(build(text), "integral", report) is not None
    note = next(d for d in report.diagnostics if d.code == "dependent-storage")
    assert note.message == (
        "I:j1 is in derivative causality: its flow is fixed by I:j2, which has the state."
    )


def test_three_coils_at_a_node_have_two_states() -> None:
    report = Report()
    text = "Se:u -> 1:a -> I:j1; Se:v -> 1:b -> I:j2; a -> 0:n; b -> n; n -> 1:c -> I:j3"
    assert assign(build(text), "integral", report) is not None
    (note,) = report.diagnostics
    assert note.message == (
        "I:j3 is in derivative causality: its flow is fixed by I:j1 and I:j2, which have the state."
    )
    assert [(label.span.text, label.text) for label in note.labels] == [
        ("I:j3", "takes its flow from the others"),
        ("I:j1", "holds the state"),
        ("I:j2", "holds the state"),
    ]
    assert note.help.startswith("This is no error: these storages share their states.")


def test_a_capacitor_across_a_source_is_told_as_such() -> None:
    report = Report()
    assert assign(build("Se:u -> 0:a -> C:c; a -> R:r"), "integral", report) is not None
    assert report.diagnostics[0].message == (
        "C:c is in derivative causality: its effort is imposed by Se:u."
    )


def test_chained_cells_are_counted_in_one_message() -> None:
    source = Source("cells.bg", "I:L1 I:L2 and the rest")
    first, second, rest = Span(source, 0, 4), Span(source, 5, 9), Span(source, 10, 22)
    kinds = [("Se", "U", False, rest)]
    bonds: list[tuple[int, int, Span]] = []
    last, n = 0, 6
    for i in range(n):
        for kind, span in (("1", rest), ("I", first), ("0", rest), ("C", rest), ("1", rest),
                           ("I", second)):  # fmt: skip
            kinds.append((kind, f"cell[{i + 1}].x{len(kinds)}", False, span))
        one = 1 + 6 * i
        pairs = [(last, one), (one, one + 1), (one, one + 2), (one + 2, one + 3),
                 (one + 2, one + 4), (one + 4, one + 5)]  # fmt: skip
        bonds += [(a, b, rest) for a, b in pairs]
        last = one + 4
    kinds.append(("R", "load", False, rest))
    bonds.append((last, len(kinds) - 1, rest))
    report = Report()
    graph = assign(assemble(source, Pool(), kinds, bonds), "integral", report)
    assert graph is not None
    assert len(graph.dependent) == n - 1
    (note,) = report.diagnostics
    assert note.message.endswith("which has the state; so are 4 more like it.")
    assert [label.span.text for label in note.labels] == ["I:L1", "I:L2"]


def test_derivative_preference_reports_no_findings() -> None:
    report = Report()
    assert assign(build("Se:u -> 0:a -> C:c; a -> R:r"), "derivative", report) is not None
    assert report.diagnostics == []


def _ladder(cells: int) -> tuple[list[tuple[str, str, bool, Span]], list[tuple[int, int, Span]]]:
    span = Span(Source("ladder.bg", " "), 0, 1)
    kinds = [("Se", "U", False, span)]
    bonds = []
    last = 0
    for i in range(cells):
        one = len(kinds)
        kinds += [(kind, f"{kind}{i}", False, span) for kind in ("1", "I", "R", "0", "C")]
        for pair in ((last, one), (one, one + 1), (one, one + 2), (one, one + 3),
                     (one + 3, one + 4)):  # fmt: skip
            bonds.append((*pair, span))
        last = one + 3
    kinds.append(("De", "y", False, span))
    bonds.append((last, len(kinds) - 1, span))
    return kinds, bonds


def test_a_long_ladder() -> None:
    cells = 4000
    kinds, bonds = _ladder(cells)
    result = assign(assemble(bonds[0][2].source, Pool(), kinds, bonds), "derivative", Report())
    assert result is not None
    assert len(result.dependent) == len(result.storages) == 2 * cells


def test_the_exact_search_alone_agrees_with_the_rules() -> None:
    # the witness starts empty: every rule is covered by alternating paths
    graph = build(
        "1:a -> GY:x -> 1:b -> GY:y -> 1:c -> GY:z -> a; a -> 0:d -> 1:e -> 0:f -> b; "
        "d -> C:p; e -> I:q; f -> C:r; c -> I:s; Se:u -> a"
    )
    net, at = network(graph)
    strokes = Strokes(net)
    for wish in demands(graph, at, "integral")[0]:
        assert strokes.wish(wish) is None
    witness = Matching(strokes, [-1] * net.bonds)
    assert witness.complete()
    found = tuple(v if v >= 0 else witness.value(b) for b, v in enumerate(strokes.value))
    assert broken_rules(graph, found, set()) == []


_RINGS = (
    "1:a -> GY:x -> 1:b -> GY:y -> 1:c -> GY:z -> a; a -> 0:d -> b; d -> C:p; c -> I:s; Se:u -> a",
    "1:a -> 0:b -> 1:c; a -> R:r; b -> C:p; c -> R:s; c -> I:q; Se:u -> a",
    "0:a -> TF:t -> 1:b; a -> R:r; a -> R:s; b -> R:q; b -> R:v; Sf:u -> a; R:w -> C:o",
)


@pytest.mark.parametrize("text", _RINGS)
def test_an_assignment_that_keeps_all_rules_is_its_own_witness(text: str) -> None:
    """Whatever it is: all that exist are found by trying every one."""
    graph = build(text)
    net, at = network(graph)
    found = 0
    for hint in product((0, 1), repeat=net.bonds):
        if broken_rules(graph, hint, set()):
            continue
        found += 1
        strokes = Strokes(net)
        for wish in demands(graph, at, "integral")[0]:
            assert strokes.wish(wish) is None
        witness = Matching(strokes, list(hint))
        assert witness.complete()
        for bond, value in enumerate(strokes.value):
            if value < 0 and bond not in witness.loose:
                assert witness.value(bond) == hint[bond]
    assert found > 1


_TREES = (
    "1:b -> 0:a; 1:c -> a; a -> R:r; b -> R:s; c -> R:t; b -> R:v; c -> R:w",
    "1:b -> 0:a; a -> R:r; a -> R:x; b -> R:s; b -> R:v",
    "1:a -> 0:b -> 1:c; a -> R:r; b -> R:p; c -> R:s; c -> R:q",
)


@pytest.mark.parametrize("text", _TREES)
@pytest.mark.parametrize("value", [0, 1])
def test_in_a_tree_with_losses_any_choice_leads_to_an_assignment(text: str, value: int) -> None:
    """Each junction has a bond of its own that may take whatever is left."""
    graph = build(text)
    net, _ = network(graph)
    for bond in range(net.bonds):
        strokes = Strokes(net)
        assert strokes.put(bond, value, Reason("chosen", 0)) is None
        assert _greedy(strokes, [])
        assert all(end >= 0 for end in strokes.taken)
        assert strokes.value[bond] == value and -1 not in strokes.value
        assert broken_rules(graph, tuple(strokes.value), set()) == []


@pytest.mark.parametrize("text", [*_TREES, *_RINGS[1:]])
def test_the_exact_search_grants_the_wishes_of_what_is_free(text: str) -> None:
    """Beside a bond of two resistances, of which the first has its way: it gives the effort."""
    graph = build(f"{text}; R:one -> R:two")
    net, at = network(graph)
    musts, wishes = demands(graph, at, "integral")
    free = _free_choices(graph, at)
    strokes = _exact(net, musts, wishes, free, [-1] * net.bonds)
    assert strokes is not None and -1 not in strokes.value
    assert broken_rules(graph, tuple(strokes.value), set()) == []
    assert strokes.value[-1] == 1  # at the other one
    reason = strokes.reason[-1]
    assert reason is not None and graph.nodes[reason.node].path == "one"


def test_nothing_heavy_is_imported() -> None:
    code = (
        "import sys, bondgraph.passes.causality.assign\n"
        "print([m for m in ('dataclasses', 'inspect', 'sympy', 'networkx', 'numpy', 'jinja2')"
        " if m in sys.modules])"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"
