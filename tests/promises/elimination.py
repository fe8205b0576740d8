"""What the reduced system, the residuals and the signature matrix promise."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from bondgraph.algebra.zero import is_zero
from bondgraph.exact.outline import highest_order
from bondgraph.ir.expr import (
    CONSTANTS,
    KNOWN_SIGNALS,
    VARIABLES,
    Expr,
    Kind,
    Op,
    Pool,
    below,
    symbols,
)
from bondgraph.ir.residuals import Missing, ReducedSystem, ResidualSet, Step
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.structural.rank import relations
from tests.promises.check import promise
from tests.promises.graphs import twice

_FINAL = KNOWN_SIGNALS | CONSTANTS - {Kind.FREE}
_SMALL = 400  # equations of which the rank is taken, nodes of which an equation is tried


def _other_kinds(exprs: Iterable[Expr], allowed: frozenset[Kind]) -> list[str]:
    """What an expression holds of other kinds, the starts of its integrals included."""
    own = [n.symbol for n in below(exprs) if n.op in (Op.SYM, Op.INT)]
    return sorted({s.name for s in own if s.kind not in allowed})


def _each_mode(reduced: ReducedSystem) -> bool:
    """Whether the steps are those of eliminations in each mode, joined by the mode.

    They choose by a mode where their equation does not, or take two variables from one equation.
    """
    if not any(n.kind is Kind.MODE for n in below(e.zero for e in reduced.system.equations)):
        return False
    if twice(id(s.equation) for s in reduced.steps if s.how != "loop"):
        return True
    return any(
        node.op is Op.IF
        and any(s.kind is Kind.MODE for s in symbols(node.args[0]))
        and node not in below([step.equation.zero])
        for step in reduced.steps
        for node in below([step.value])
    )


# --------------------------------------------------------------------- reduced system


@promise("ReducedSystem")
def unknowns_follow_once_or_not_at_all(reduced: ReducedSystem) -> Iterator[str]:
    """A variable has one step, or no sensor reaches it."""
    told = [*(s.variable for s in reduced.steps), *reduced.unsolved]
    yield from (f"{v} is told twice" for v in twice(told))
    lost = set(told).symmetric_difference(reduced.system.unknowns)
    if not _each_mode(reduced):  # some variables are in no equation of any mode
        yield from (v.symbol.name for v in sorted(lost, key=lambda v: v.id))


@promise("ReducedSystem")
def steps_use_what_is_computed_before(reduced: ReducedSystem) -> Iterator[str]:
    """The value of a step holds known signals, constants and variables of earlier steps."""
    if not _each_mode(reduced):
        yield from _out_of_order(reduced.steps)


def _out_of_order(steps: Iterable[Step]) -> Iterator[str]:
    done: set[Expr] = set()
    for step in steps:
        for symbol in symbols(step.value):
            if symbol.kind in VARIABLES - {Kind.TEAR} and symbol not in done:
                yield f"{step.variable} needs {symbol}"
        done.add(step.variable)


@promise("ReducedSystem")
def steps_hold_their_equation(reduced: ReducedSystem) -> Iterator[str]:
    """The equation of a step is one of the system, and holds the variable that it gives."""
    rows = {id(e) for e in reduced.system.equations}
    for step in reduced.steps:
        if id(step.equation) not in rows:
            yield f"{step.variable} follows from an equation of another system"
        elif step.variable not in step.equation.variables:
            yield f"{step.variable} is not in {step.equation.kind} {step.equation.name}"


@promise("ReducedSystem")
def equations_give_one_variable(reduced: ReducedSystem) -> Iterator[str]:
    """No equation gives two variables, and none that gave one is left over."""
    used = [id(s.equation) for s in reduced.steps if s.how != "loop"]
    names = {id(e): f"{e.kind} {e.name}" for e in reduced.system.equations}
    if not _each_mode(reduced):
        yield from (f"{names[i]} gives two" for i in twice(used) if isinstance(i, int))
        idle = {*used}.intersection(id(e) for e in reduced.unmonitored)
        yield from (f"{names[i]} is used and not monitored" for i in sorted(idle))


@promise("ReducedSystem")
def values_solve_their_equation(reduced: ReducedSystem) -> Iterator[str]:
    """With its value in the place of the variable, the equation of a step holds identically."""
    pool = reduced.system.graph.pool
    if _each_mode(reduced):
        return
    for step in reduced.steps:
        block = step.value is step.closed and len(step.equation.variables) > 1
        if step.how != "loop" and not block and not _solves(pool, step):
            yield f"{step.variable} = {step.value} in 0 = {step.equation.zero}"


def _solves(pool: Pool, step: Step) -> bool:
    """Whether a value solves its equation: of a state, whether its derivative is the rate."""
    equation = step.equation
    if step.how == "integrated":
        assert equation.rate is not None
        return pool.der(step.value) is equation.rate or step.value.op is not Op.INT
    nodes = below([equation.zero, step.value])
    if len(nodes) > _SMALL or any(n.op in (Op.ROOT, Op.FN, Op.IF, Op.INT) for n in nodes):
        return True  # inverse only where it is defined
    put = pool.substitute([equation.zero], {step.variable: step.value})[0]
    return is_zero(put)


@promise("ReducedSystem")
def kinds_of_steps_fit(reduced: ReducedSystem) -> Iterator[str]:
    """A state is integrated, a rate is differentiated, what is torn stands for itself."""
    for step in reduced.steps:
        state = step.equation.state
        expected = {
            "integrated": state is step.variable,
            "differentiated": state is not None and state is not step.variable,
            "loop": True,
        }.get(step.how, state is None)
        if not expected and not _each_mode(reduced):
            yield f"{step.variable}: {step.how} by {step.equation.kind} {step.equation.name}"
        if step.how == "loop" and not _each_mode(reduced) and step.value.kind is not Kind.TEAR:
            yield f"{step.variable} is torn, but is {step.value}"


@promise("ReducedSystem")
def closed_values_are_the_values_put_in(reduced: ReducedSystem) -> Iterator[str]:
    """`closed` is the value with what was computed before put in: known signals are left."""
    pool = reduced.system.graph.pool
    names = _other_kinds([s.closed for s in reduced.steps], _FINAL | {Kind.FREE, Kind.TEAR})
    yield from (f"{name} is left" for name in names)
    if _each_mode(reduced):
        return
    known: dict[Expr, Expr] = {}
    for step in reduced.steps:
        put = pool.substitute([step.value], known)[0]
        if put is not step.closed and not is_zero(pool.sub(put, step.closed)):
            yield f"{step.variable}: {step.closed} is not {put}"
        known[step.variable] = step.closed


@promise("ReducedSystem")
def relations_hold_known_signals_only(reduced: ReducedSystem) -> Iterator[str]:
    """A relation is in known signals and constants, and rests on declared initial values."""
    for closing in reduced.closings:
        yield from (f"{closing.equation.name} holds {name}"
                    for name in _other_kinds([closing.expr], _FINAL))  # fmt: skip
        raw = _other_kinds([closing.raw], _FINAL | {Kind.FREE})
        yield from (f"raw {closing.equation.name} holds {name}" for name in raw)
        if closing.expr is reduced.system.graph.pool.zero:
            yield f"{closing.equation.name} says nothing"


@promise("ReducedSystem")
def relations_are_raw_where_nothing_was_differentiated(reduced: ReducedSystem) -> Iterator[str]:
    """A relation is another than its raw form only where it was differentiated or freed of a start.

    Nor is it of a higher order than the raw form says. One that was integrated is what it is.
    """
    for closing in reduced.closings:
        free = _other_kinds([closing.raw], _FINAL)
        if closing.expr is not closing.raw and not (closing.differentiated or free):
            yield f"{closing.equation.name}"
        integrated = closing.differentiated == -1 and closing.expr is closing.raw
        if not integrated and not 0 <= closing.differentiated <= highest_order([closing.expr]):
            yield f"{closing.equation.name} is differentiated {closing.differentiated} times"


@promise("ReducedSystem")
def paths_are_complete(reduced: ReducedSystem) -> Iterator[str]:
    """The steps of a relation give all that it rests on, in the order of the elimination.

    What is left of a torn variable in them is torn in one of them.
    """
    place = {s.variable: n for n, s in enumerate(reduced.steps)}
    for closing in reduced.closings:
        name = closing.equation.name
        own = [s.variable for s in closing.steps]
        yield from (f"{name}: {v} twice" for v in twice(own))
        if _each_mode(reduced):
            continue
        lost = set(closing.equation.variables).difference(own)
        yield from (f"{name} needs {v}" for v in sorted(lost, key=lambda v: v.id))
        yield from (f"{name}: {line}" for line in _out_of_order(closing.steps))
        places = [place[v] for v in own]
        if places != sorted(places):
            yield f"{name}: steps in another order"
        torn = {s.value for s in closing.steps if s.how == "loop"}
        for symbol in symbols(*[s.closed for s in closing.steps]):
            if symbol.kind is Kind.TEAR and symbol not in torn:
                yield f"{name}: {symbol} is not torn on the way"


@promise("ReducedSystem")
def relations_are_as_many_as_theory_gives(reduced: ReducedSystem) -> Iterator[str]:
    """Equations minus their rank is the number of relations, those missing and identities included.

    Each is an equation that gave no variable, or that was left by a variable around a ring, which
    nothing determines. One that says nothing is an identity.
    """
    system = reduced.system
    if len(system.equations) > _SMALL or _each_mode(reduced):
        return
    told = len(reduced.closings) + len(reduced.missing)
    left = len(system.equations) - len(reduced.steps) - len(reduced.unmonitored)
    theory = relations(system)
    if told > theory:
        yield f"{told} relations, by rank {theory}"
    around = sum(s.how == "loop" for s in reduced.steps)  # torn variables that nothing determines
    if not reduced.unmonitored and not left <= theory <= left + around:
        yield f"{left} equations are left over, by rank {theory}"


@promise("ReducedSystem")
def what_is_missing_says_why(reduced: ReducedSystem) -> Iterator[str]:
    """A missing relation has an equation of the system, a reason, a place and a remedy."""
    rows = {id(e) for e in reduced.system.equations}
    for missing in reduced.missing:
        yield from _without_reason(missing, rows)


def _without_reason(missing: Missing, rows: set[int]) -> Iterator[str]:
    finding = missing.finding
    if any(id(e) not in rows for e in (missing.about, *missing.equations)):
        yield f"{missing.about.name} is of another system"
    if not (finding.message and finding.labels and finding.help):
        yield f"{missing.about.name}: {finding.code} without words"
    if missing.explained and not missing.elements:
        yield f"{missing.about.name}: {finding.code} names no element"


@promise("ReducedSystem")
def what_no_sensor_reaches_is_in_what_is_not_monitored(reduced: ReducedSystem) -> Iterator[str]:
    """An equation is not monitored where it holds a variable that no sensor reaches."""
    unsolved = set(reduced.unsolved)
    held = {v for e in reduced.unmonitored for v in e.variables}
    yield from (f"{v} is in a monitored part" for v in reduced.unsolved if v not in held)
    for equation in reduced.unmonitored:
        if not unsolved.intersection(equation.variables):
            yield f"{equation.kind} {equation.name} could be a relation"


# -------------------------------------------------------------- residuals, signatures


@promise("ResidualSet")
def residuals_are_named_in_order(found: ResidualSet) -> Iterator[str]:
    """r1, r2, ..., no two alike."""
    names = [r.name for r in found.residuals]
    if names != [f"r{n + 1}" for n in range(len(names))]:
        yield f"{names}"
    yield from (f"{expr} twice" for expr in twice(r.expr for r in found.residuals))


@promise("ResidualSet")
def residuals_hold_known_signals_only(found: ResidualSet) -> Iterator[str]:
    """A residual is in known signals and constants, and at least one signal is in it."""
    for residual in found.residuals:
        others = _other_kinds([residual.expr], _FINAL)
        yield from (f"{residual.name} holds {name}" for name in others)
        if not any(s.kind is not Kind.CONST for s in symbols(residual.expr)):
            yield f"{residual.name} says nothing of the machine"


@promise("ResidualSet")
def residuals_stay_in_the_system(found: ResidualSet) -> Iterator[str]:
    """Closing equations and those of the steps are equations of the system."""
    rows = {id(e) for e in found.system.equations}
    for residual in found.residuals:
        for equation in (residual.closing, *[s.equation for s in residual.steps]):
            if id(equation) not in rows:
                yield f"{residual.name}: {equation.name}"


Analysis = tuple[ResidualSet, SignatureMatrix]


@promise("Analysis")
def matrix_is_over_residuals_and_faults(pair: Analysis) -> Iterator[str]:
    """A row for each fault candidate of the graph, a column for each residual."""
    found, matrix = pair
    if matrix.faults != found.system.graph.faults:
        yield f"faults {matrix.faults}"
    if matrix.residuals != tuple(r.name for r in found.residuals):
        yield f"residuals {matrix.residuals}"
    if [len(row) for row in matrix.rows] != [len(matrix.residuals)] * len(matrix.faults):
        yield "not a rectangle"
    if len(matrix.orders) != len(matrix.residuals):
        yield f"{len(matrix.orders)} orders"


@promise("Analysis")
def what_is_seen_is_behind(pair: Analysis) -> Iterator[str]:
    """A residual sees only faults in its expression or in the equations that it rests on."""
    found, matrix = pair
    symbol = found.system.graph.fault_symbols()
    for residual in found.residuals:
        behind = [residual.closing.zero, *[s.equation.zero for s in residual.steps]]
        held = set(symbols(residual.expr, *behind))
        for fault in matrix.signature(residual.name):
            if fault in symbol and symbol[fault] not in held:
                yield f"{residual.name} sees {fault}"


@promise("Analysis")
def orders_are_of_signals_that_occur(pair: Analysis) -> Iterator[str]:
    """Orders are given for signals of the expression, as far as it differentiates them."""
    found, matrix = pair
    for residual, orders in zip(found.residuals, matrix.orders, strict=False):
        held = {s.symbol.name for s in symbols(residual.expr) if s.kind in KNOWN_SIGNALS}
        most = highest_order([residual.expr])
        for name, order in orders.items():
            if name not in held or not -2 <= order <= most:
                yield f"{residual.name}: {name} {order}, highest {most}"


@promise("Analysis")
def what_is_seen_elsewhere_is_not_seen_here(pair: Analysis) -> Iterator[str]:
    """`apart` has entries that are not in the matrix, by names that exist; so has `unconfirmed`."""
    found, matrix = pair
    values = {s.symbol.name for s in (v.symbol for v in found.system.graph.values)}
    values |= {s.name for s in found.system.graph.initial_values()}
    for (residual, fault), names in matrix.apart.items():
        if residual not in matrix.residuals or fault not in matrix.faults:
            yield f"no entry {residual}, {fault}"
        elif fault in matrix.signature(residual):
            yield f"{residual} sees {fault} here"
        yield from (f"no value {name}" for name in names if name not in values)
    yield from (f"no residual {r}" for r in matrix.unconfirmed if r not in matrix.residuals)
