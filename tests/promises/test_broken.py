"""Each check finds a value that was broken on purpose, and nothing in the value as it was."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import pytest

from bondgraph.compilation import Compilation, compile
from bondgraph.ir.expr import Kind
from bondgraph.ir.program import Assign, Branch, PolynomialTape, Ref
from bondgraph.text.source import Source
from tests.conftest import ROOT
from tests.promises import broken
from tests.promises.check import CHECKS

LADDER = """bg 1
model Cell {
    port l : in electrical
    port r : out electrical
    l -> 1:s -> 0:p -> r
    s -> I:L = 1 uH
    p -> C:C = 1 nF
}
model Ladder {
    Cell:c[20]
    Se:U -> c[1..20] -> 1:e -> R:load = 50 Ohm
    e -> Df:i
}
"""
SAME = """bg 1
model Same {
    param R = 2
    Se:U -> 1:j { -> R:R; -> Df:i }
    j -> Df:again = i
}
"""


@cache
def of(name: str) -> Compilation:
    """A compilation that is shared and never changed."""
    texts = {"ladder": LADDER, "same": SAME}
    if name in texts:
        return Compilation(Source(f"{name}.bg", texts[name]))
    folder = {"dc_motor": "models", "oven": "models", "branch": "tests/cases/program"}.get(
        name, "tests/adversary/models"
    )
    return compile(ROOT / folder / f"{name}.bg")


class Break(NamedTuple):
    """How a value of a stage is broken: the check that finds it, a healthy value, what is done."""

    check: str
    healthy: Callable[[], Any]
    done: Callable[[Any], Any]


def put(items: tuple[Any, ...], place: int, /, **new: Any) -> tuple[Any, ...]:
    """The items, one of them with other fields."""
    own = list(items)
    own[place] = own[place]._replace(**new)
    return tuple(own)


def change(field: str, at: int, **new: Any) -> Callable[[Any], Any]:
    """A stage in which one item of a field has other fields."""
    return lambda value: value._replace(**{field: put(getattr(value, field), at, **new)})


def node(kind: str, **new: Any) -> Callable[[Any], Any]:
    """A graph in which the first node of a kind has other fields."""

    def done(graph: Any) -> Any:
        at = next(n for n, node in enumerate(graph.nodes) if node.kind == kind)
        return graph._replace(nodes=put(graph.nodes, at, **new))

    return done


def turned(kind: str) -> Callable[[Any], Any]:
    """A causality in which the first bond of the first node of a kind has its stroke elsewhere."""

    def done(causal: Any) -> Any:
        graph = causal.graph
        for at, bond in enumerate(graph.bonds):
            if kind in (graph.nodes[bond.tail.node].kind, graph.nodes[bond.head.node].kind):
                other = "tail" if causal.strokes[at].at == "head" else "head"
                return causal._replace(strokes=put(causal.strokes, at, at=other))
        raise AssertionError(kind)

    return done


def equation(kind: str, change: Callable[[Any, Any], dict[str, Any]]) -> Callable[[Any], Any]:
    """A system in which the first equation of a kind has other fields."""

    def done(system: Any) -> Any:
        at = next(n for n, e in enumerate(system.equations) if e.kind == kind)
        new = change(system.graph.pool, system.equations[at])
        return system._replace(equations=put(system.equations, at, **new))

    return done


def step(how: str, change: Callable[[Any, Any], dict[str, Any]]) -> Callable[[Any], Any]:
    """A reduced system in which the last step of a kind has other fields."""

    def done(reduced: Any) -> Any:
        at = max(n for n, s in enumerate(reduced.steps) if s.how == how)
        new = change(reduced, reduced.steps[at])
        return reduced._replace(steps=put(reduced.steps, at, **new))

    return done


def unlike(pool: Any) -> Any:
    """A symbol that is in no model."""
    return pool.symbol("stranger", Kind.FLOW)


def mirrored(field: str) -> Callable[[Any], Any]:
    """A value with the items of a field in the other order."""
    return lambda value: value._replace(**{field: getattr(value, field)[::-1]})


def first_of(field: str, keep: slice) -> Callable[[Any], Any]:
    """A value with some of the items of a field."""
    return lambda value: value._replace(**{field: getattr(value, field)[keep]})


def circle(graph: Any) -> Any:
    """A graph with a parameter that follows from itself."""
    return change("values", 0, value=graph.values[0].symbol)(graph)


def foreign_law(graph: Any) -> Any:
    """A graph with a law in a symbol that the model does not declare."""
    at = next(n for n, node in enumerate(graph.nodes) if node.kind == "R")
    laws = put(graph.nodes[at].laws, 0, zero=unlike(graph.pool))
    return graph._replace(nodes=put(graph.nodes, at, laws=laws))


def graph(name: str = "dc_motor") -> Callable[[], Any]:
    return lambda: of(name).graph


def integral() -> Any:
    return of("dc_motor").integral


def equations() -> Any:
    return of("dc_motor").equations


def reduced(name: str = "dc_motor") -> Callable[[], Any]:
    return lambda: of(name).reduced


def residuals() -> Any:
    return of("dc_motor").residuals.residual_set


def analysis() -> Any:
    return residuals(), of("dc_motor").signatures


def program(name: str = "dc_motor") -> Callable[[], Any]:
    return lambda: of(name).program


def matrix(**new: Any) -> Callable[[Any], Any]:
    """The pair of residuals and matrix, with other fields of the matrix."""
    return lambda pair: (pair[0], pair[1]._replace(**new))


def tape(program: Any) -> Any:
    """A program with a tape that adds a row to itself."""
    at = next(n for n, s in enumerate(program.configure) if isinstance(s, PolynomialTape))
    ops = put(program.configure[at].ops, 0, source=program.configure[at].ops[0].target)
    return program._replace(configure=put(program.configure, at, ops=ops))


def branched(instead: Callable[[Branch], tuple[Any, ...]]) -> Callable[[Any], Any]:
    """A program with other statements in place of its first branch."""

    def broken(program: Any) -> Any:
        at = next(n for n, s in enumerate(program.step) if isinstance(s, Branch))
        made = instead(program.step[at])
        return program._replace(step=(*program.step[:at], *made, *program.step[at + 1 :]))

    return broken


def stray() -> Assign:
    """An assignment to a local that nothing reads, of one that nothing gives."""
    return Assign(Ref("local", "somewhere"), Ref("local", "nowhere"), "", None)


BREAKS = [
    # bond graph
    Break("bonds_are_numbered_in_order", graph(), change("bonds", 0, number=7)),
    Break("bonds_end_at_ports", graph(), lambda g: change(
        "bonds", 0, tail=g.bonds[0].tail._replace(port=5))(g)),
    Break("bonds_end_at_ports", graph(), lambda g: change(
        "bonds", 0, head=g.bonds[0].head._replace(effort=0))(g)),
    Break("bonds_end_at_ports", graph(), lambda g: change("bonds", 0, head=g.bonds[0].tail)(g)),
    Break("ports_have_one_bond", graph(), first_of("bonds", slice(1, None))),
    Break("names_are_unique", graph(), lambda g: change("nodes", 0, path=g.nodes[1].path)(g)),
    Break("names_are_unique", graph(), lambda g: change("values", 0, name=g.sensors[0].name)(g)),
    Break("nodes_have_what_their_kind_has", graph(), node("R", laws=())),
    Break("nodes_have_what_their_kind_has", graph(), node("1", common=None)),
    Break("nodes_have_what_their_kind_has", graph(), node("Df", sensor=None)),
    Break("laws_hold_declared_symbols", graph(), foreign_law),
    Break("laws_hold_declared_symbols", graph(), first_of("values", slice(0))),
    Break("values_are_constants_without_a_circle", graph(), circle),
    Break("second_instruments_exist", graph("same"), change("sensors", 1, same_as="nobody")),
    Break("all_is_from_somewhere", graph(), change("bonds", 0, origin=None)),
    # causality
    Break("every_bond_has_a_stroke", integral, first_of("strokes", slice(1, None))),
    Break("junctions_have_one_strong_bond", integral, turned("1")),
    Break("two_ports_turn_or_pass_the_stroke", integral, turned("GY")),
    Break("sources_and_sensors_have_their_way", integral, turned("Se")),
    Break("sources_and_sensors_have_their_way", integral, turned("Df")),
    Break("detectors_are_dualised_in_derivative_preference",
          lambda: of("dc_motor").derivative, first_of("dualised", slice(1))),
    Break("storages_are_told_as_their_strokes_stand", integral,
          change("storages", 0, integral=False)),
    Break("storages_are_told_as_their_strokes_stand", integral, first_of("storages", slice(1))),
    Break("reasons_fit_their_nodes", integral, mirrored("strokes")),
    Break("loops_have_nodes", lambda: of("bicycle").integral,
          lambda causal: causal._replace(loops=((0, 0),))),
    # equations
    Break("unknowns_are_what_the_equations_hold", equations, first_of("unknowns", slice(1, None))),
    Break("variables_are_those_of_the_expression", equations,
          equation("balance", lambda pool, e: {"variables": e.variables[::-1]})),
    Break("equations_are_counted", equations, first_of("equations", slice(1, None))),
    Break("shared_variables_are_gone", equations,
          lambda s: s._replace(shared={s.unknowns[0]: s.unknowns[1]})),
    Break("bonds_have_their_two_variables", equations, first_of("efforts", slice(1, None))),
    Break("bonds_have_their_two_variables", equations, lambda s: s._replace(
        efforts=(s.graph.pool.mul(*s.efforts[:2]), *s.efforts[1:]))),
    Break("states_integrate_their_rates", equations,
          equation("state", lambda pool, e: {"rate": pool.neg(e.rate)})),
    Break("states_integrate_their_rates", equations,
          equation("law", lambda pool, e: {"state": e.variables[0]})),
    Break("equations_hold_signals_constants_and_unknowns", equations,
          equation("law", lambda pool, e: {"zero": pool.symbol("x?", Kind.TEAR)})),
    # elimination
    Break("unknowns_follow_once_or_not_at_all", reduced(), first_of("steps", slice(1, None))),
    Break("unknowns_follow_once_or_not_at_all", reduced(),
          lambda r: r._replace(unsolved=(r.steps[0].variable,))),
    Break("steps_use_what_is_computed_before", reduced(), mirrored("steps")),
    Break("steps_hold_their_equation", reduced(),
          step("solved", lambda r, s: {"equation": r.steps[0].equation})),
    Break("steps_hold_their_equation", reduced(),
          step("solved", lambda r, s: {"equation": s.equation._replace(name="copy")})),
    Break("equations_give_one_variable", reduced(),
          step("solved", lambda r, s: {"equation": r.steps[0].equation})),
    Break("equations_give_one_variable", reduced(),
          lambda r: r._replace(unmonitored=(r.steps[0].equation,))),
    Break("values_solve_their_equation", reduced(),
          step("solved", lambda r, s: {"value": r.system.graph.pool.neg(s.value)})),
    Break("values_solve_their_equation", reduced("rl_parallel"),
          step("integrated", lambda r, s: {"value": r.system.graph.pool.integral(
              r.system.unknowns[0], r.system.graph.pool.symbol("start", Kind.FREE))})),
    Break("kinds_of_steps_fit", reduced(), step("differentiated", lambda r, s: {"how": "solved"})),
    Break("kinds_of_steps_fit", reduced(), step("solved", lambda r, s: {"how": "loop"})),
    Break("closed_values_are_the_values_put_in", reduced(),
          step("solved", lambda r, s: {"closed": r.steps[0].closed})),
    Break("closed_values_are_the_values_put_in", reduced(),
          step("solved", lambda r, s: {"closed": s.variable})),
    Break("relations_hold_known_signals_only", reduced(),
          lambda r: change("closings", 0, expr=r.system.unknowns[0])(r)),
    Break("relations_hold_known_signals_only", reduced(),
          lambda r: change("closings", 0, expr=r.system.graph.pool.zero)(r)),
    Break("relations_are_raw_where_nothing_was_differentiated", reduced("rl_parallel"),
          change("closings", 0, differentiated=0, raw=of("rl_parallel").graph.pool.one)),
    Break("relations_are_raw_where_nothing_was_differentiated", reduced(),
          change("closings", 0, differentiated=9)),
    Break("paths_are_complete", reduced(),
          lambda r: change("closings", 0, steps=r.closings[0].steps[1:])(r)),
    Break("paths_are_complete", reduced(),
          lambda r: change("closings", 0, steps=r.closings[0].steps[::-1])(r)),
    Break("relations_are_as_many_as_theory_gives", reduced(),
          lambda r: r._replace(closings=(*r.closings, r.closings[0]))),
    Break("relations_are_as_many_as_theory_gives", reduced(), first_of("steps", slice(1, None))),
    Break("what_is_missing_says_why", reduced("partly_known"), change("missing", 0, elements=())),
    Break("what_is_missing_says_why", reduced("partly_known"), lambda r: change(
        "missing", 0, finding=r.missing[0].finding._replace(help=""))(r)),
    Break("what_no_sensor_reaches_is_in_what_is_not_monitored", reduced("dc_unknown_all"),
          first_of("unmonitored", slice(0))),
    Break("what_no_sensor_reaches_is_in_what_is_not_monitored", reduced(),
          lambda r: r._replace(unmonitored=(r.steps[0].equation,))),
    # residuals and signatures
    Break("residuals_are_named_in_order", residuals, mirrored("residuals")),
    Break("residuals_hold_known_signals_only", residuals,
          lambda s: change("residuals", 0, expr=s.system.unknowns[0])(s)),
    Break("residuals_hold_known_signals_only", residuals,
          lambda s: change("residuals", 0, expr=s.system.graph.pool.one)(s)),
    Break("residuals_stay_in_the_system", residuals, lambda s: change(
        "residuals", 0, closing=s.residuals[0].closing._replace(name="copy"))(s)),
    Break("matrix_is_over_residuals_and_faults", analysis, matrix(faults=("k",))),
    Break("matrix_is_over_residuals_and_faults", analysis, matrix(rows=((True,),))),
    Break("what_is_seen_is_behind", analysis, lambda p: matrix(
        rows=tuple((True,) * len(row) for row in p[1].rows))(p)),
    Break("orders_are_of_signals_that_occur", analysis, matrix(orders=({"speed": 5}, {}))),
    Break("orders_are_of_signals_that_occur", analysis, matrix(orders=({"stranger": 0}, {}))),
    Break("what_is_seen_elsewhere_is_not_seen_here", analysis, lambda p: matrix(
        apart={("r1", p[1].signature("r1")[0]): ()})(p)),
    Break("what_is_seen_elsewhere_is_not_seen_here", analysis, matrix(unconfirmed={"r9": "why"})),
    # program
    Break("locals_are_given_before_they_are_read", program("ladder"), mirrored("configure")),
    Break("locals_are_given_before_they_are_read", program(),
          lambda p: p._replace(step=(stray(), *p.step))),
    Break("locals_are_given_before_they_are_read", program("two_tanh"),
          change("roots", 0, value=Ref("local", "nowhere"))),
    Break("sides_of_branches_keep_their_locals", program("branch"),
          branched(lambda b: (b, stray()._replace(value=b.yes[0].target)))),
    Break("sides_of_branches_keep_their_locals", program("branch"),
          branched(lambda b: (b._replace(yes=(), no=()),))),
    Break("locals_are_read", program(), lambda p: p._replace(step=(stray(), *p.step))),
    Break("procedures_read_what_is_theirs", program(),
          lambda p: change("step", 0, value=Ref("param", p.params[0].name))(p)),
    Break("procedures_read_what_is_theirs", program(),
          lambda p: change("step", 0, value=Ref("known", p.knowns[0].name, 1))(p)),
    Break("what_is_read_is_declared", program(), first_of("params", slice(1, None))),
    Break("what_is_read_is_declared", program("oven"), first_of("knowns", slice(0))),
    Break("what_is_read_is_declared", program("two_tanh"), first_of("roots", slice(0))),
    Break("what_is_declared_is_used", program(), first_of("configure", slice(0))),
    Break("what_is_declared_is_used", program(), first_of("step", slice(0))),
    Break("what_is_declared_is_used", program(), first_of("first", slice(0))),
    Break("coefficients_are_given_once", program(),
          lambda p: p._replace(configure=(*p.configure, p.configure[-1]))),
    Break("residuals_have_values", program(), first_of("exact", slice(0))),
    Break("residuals_have_values", program(), first_of("step", slice(0))),
    Break("derivatives_are_asked_for", program(),
          lambda p: p._replace(knowns=tuple(k._replace(highest=0) for k in p.knowns))),
    Break("names_are_unique_in_a_program", program(),
          lambda p: p._replace(params=(*p.params, p.params[0]))),
    Break("tapes_stay_in_their_rows", program("ladder"), tape),
    Break("openings_are_of_residuals_states_and_modes", program("oven"),
          change("openings", 0, modes=("nothing",))),
    Break("openings_are_of_residuals_states_and_modes", program("oven"),
          change("openings", 0, progress="nothing")),
]  # fmt: skip

_FOUND = {check.__name__: (stage, check) for stage, own in CHECKS.items() for check in own}


@pytest.mark.parametrize("case", BREAKS, ids=lambda case: case.check)
def test_a_broken_value_is_found(case: Break) -> None:
    stage, check = _FOUND[case.check]
    value = case.healthy()
    assert broken(stage, value) == []
    assert list(check(case.done(value))) != []


def test_every_check_is_shown_to_find_something() -> None:
    assert {case.check for case in BREAKS} == _FOUND.keys()
