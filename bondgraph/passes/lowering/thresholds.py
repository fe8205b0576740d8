"""From the tolerances of a model to a program of adaptive thresholds, one for each residual."""

from __future__ import annotations

from collections.abc import Mapping

from bondgraph.algebra.derivative import TooManyOperations
from bondgraph.algebra.normalise import LIMIT, normalise
from bondgraph.ir.expr import Expr
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.program import (
    Assign,
    Assignment,
    Expression,
    Field,
    Function,
    Opening,
    PolynomialTape,
    Program,
    Ref,
    ResidualInfo,
    Sum,
)
from bondgraph.ir.residuals import Observer, Residual, ResidualSet
from bondgraph.passes.lowering.builder import Builder
from bondgraph.passes.lowering.exactly import LARGEST
from bondgraph.passes.lowering.filter import Filter
from bondgraph.passes.lowering.law_chain import law_stages
from bondgraph.passes.lowering.lower import LowerOptions, digest, with_tables
from bondgraph.passes.lowering.luenberger import Luenberger
from bondgraph.passes.lowering.near_functions import near_functions
from bondgraph.passes.lowering.newton import newton_blocks
from bondgraph.passes.lowering.procedure import ZERO
from bondgraph.passes.lowering.prune import pruned
from bondgraph.passes.lowering.switched import Switched
from bondgraph.passes.lowering.uncertain import Share, shares
from bondgraph.passes.lowering.visible import seen

#: First-order stages that the signals of one threshold may have together.
_STAGES = 300

_UNWRITTEN = "a threshold is made of filtered signals, only step has it"


class _Threshold:
    """What is written for one residual."""

    def __init__(self, info: ResidualInfo) -> None:
        self.info = info
        self.first: list[Assignment] = []
        self.step: list[Assignment] = []
        self.states: list[Field] = []
        self.exprs: list[Expr] = []
        self.opening: Opening | None = None


def thresholds(
    graph: BondGraph,
    residuals: ResidualSet,
    program: Program,
    options: LowerOptions,
    observers: Mapping[str, Observer] = {},
) -> Program | None:
    """A program whose `step` gives a(t) >= |r(t)| of the healthy machine, for each residual.

    a(t) is the sum of the amounts of theta dr/dtheta delta over all parameters with a tolerance
    delta, each through the filter of its residual in `program` (Djeziri, Merzouki and Ould
    Bouamama, 2007), and of what is of second order where parameters multiply each other. In units
    of the residual. Noise, starts away from rest and invisible terms are not in it. None for a
    model in which no tolerance reaches a step; a residual that has no step has no threshold either.
    """
    if not any(v.tolerance for v in graph.values):
        return None
    builder = Builder(graph)
    filter = Filter(builder)
    switched = Switched(builder, filter, residuals.system)
    large = {s.residual for s in program.configure if isinstance(s, PolynomialTape)}
    found = [
        _followed(builder, filter, residual, info, observers[residual.name])
        if info.follows
        else _threshold(builder, switched, residual, info, options, info.name in large)
        for residual, info in zip(residuals.residuals, program.residuals, strict=True)
    ]
    configure = builder.configure()
    exprs = [e for one in found for e in one.exprs]
    made = program._replace(
        name=f"{program.name}_threshold",
        title=f"Adaptive thresholds of {program.name}: how far each residual of the healthy machine"
        " can be from zero if every parameter is within its tolerance.",
        params=builder.param_fields(builder.used),
        knowns=builder.known_fields([*exprs, *switched.read]),
        delayed=builder.delayed_fields([*exprs, *switched.read]),
        coefs=tuple(builder.fields),
        states=tuple(s for one in found for s in one.states),
        residuals=tuple(one.info for one in found),
        configure=tuple(configure),
        exact=(),
        first=tuple(s for one in found for s in one.first),
        step=tuple(s for one in found for s in one.step),
        roots=newton_blocks(graph.pool, exprs),
        integrals=(),
        time_unit=1.0,
        bounds=program.name,
        openings=tuple(one.opening for one in found if one.opening is not None),
    )
    refused = [one.info.unavailable for one in found if one.info.unavailable]
    if not any(one.exprs for one in found) and set(refused) <= {
        r.unavailable for r in program.residuals
    }:
        return None
    made = with_tables(pruned(made), graph.pool)
    made = made if options.libm else near_functions(made)
    return made._replace(digest=digest(made, graph.source.text, options.tolerances))


def _threshold(
    builder: Builder,
    switched: Switched,
    residual: Residual,
    info: ResidualInfo,
    options: LowerOptions,
    large: bool,
) -> _Threshold:
    """The statements for one residual: its uncertain signals, and the sum of their amounts."""
    out = _Threshold(info._replace(order=0, unwritten=_UNWRITTEN, approximate=""))
    if info.unavailable:
        return _none(out, info.unavailable)
    if large:
        return _none(out, "its residual is too long to be differentiated")
    builder.origin = residual.closing.origin
    pool = builder.graph.pool
    joined = pool.logged([residual.expr])[0]
    form = switched.form(joined, normalise(pool, joined, LIMIT, builder.initials))
    kept = seen(builder, form.terms, options.rate, options.resolution).kept
    amounts: list[tuple[bool, Expression]] = []
    words: list[str] = []
    found = shares(builder, kept, _STAGES // max(info.stages, 1))
    if found is None:
        return _none(out, f"its uncertain signals need more than {_STAGES} stages of the filter")
    window = switched.window(residual, kept, info.stages, info.laws)
    if window is not None:
        out.first, out.step, out.states = [*window.first], [*window.step], [*window.states]
        out.opening = window.opening
    gains: dict[str, Ref] = {}  # of all stages
    held, begins = 0.0, ""
    for number, share in enumerate(found, 1):
        form = normalise(builder.graph.pool, share.expr, LIMIT, builder.initials)
        if form.tape is not None:
            return _none(out, "its uncertain signals are too long")
        form = switched.form(share.expr, form)
        if not form.terms:
            continue
        name = f"{info.name}_w{number}"
        laws = max(info.laws, law_stages(form.terms))
        chain = switched.chain(residual._replace(name=name), info.stages, laws, window)
        chain.gains = gains
        try:
            chain.run(form.terms, f"{info.path}: {_named(share)}")
        except TooManyOperations:
            return _none(out, f"written out it takes more than {LARGEST} operations")
        held, begins = chain.held, chain.begins
        out.first += [_local(s, name) for s in chain.first]
        out.step += [_local(s, name) for s in chain.step]
        out.states += chain.states
        out.exprs.append(share.expr)
        amounts.append((True, Function("abs", (Ref("local", name),))))
        words += [p for p in share.parameters if p not in words]
    total = Sum(tuple(amounts)) if amounts else ZERO
    text = f"{info.name}: how far {info.path} can be from zero if no parameter is out of tolerance"
    statement = Assign(Ref("residual", info.name), total, text, residual.closing.origin)
    out.first.append(statement)
    out.step.append(statement)
    out.info = out.info._replace(
        text=text, faults=tuple(words), invisible=(), held=held, begins=begins
    )
    return out


def _followed(
    builder: Builder, filter: Filter, residual: Residual, info: ResidualInfo, observer: Observer
) -> _Threshold:
    """The statements for a residual that is an observer: it carries the slopes of its states."""
    out = _Threshold(info._replace(order=0, unwritten=_UNWRITTEN))
    builder.origin = residual.closing.origin
    chain = Luenberger(builder, filter, residual, info.stages)
    text = f"{info.name}: how far {info.path} can be from zero if no parameter is out of tolerance"
    try:
        words = chain.bound(observer, text)
    except TooManyOperations:
        return _none(out, f"written out it takes more than {LARGEST} operations")
    out.first, out.step, out.states = chain.first, chain.step, chain.states
    out.exprs = list(observer.exprs)
    out.info = out.info._replace(text=text, faults=words, invisible=())
    return out


def _none(out: _Threshold, why: str) -> _Threshold:
    """A threshold that step never has."""
    nothing = Assign(Ref("residual", out.info.name), ZERO, f"{out.info.path}: {why}", None)
    info = out.info._replace(text="", faults=(), invisible=(), unavailable=why, begins="")
    none = _Threshold(info)
    none.first, none.step = [nothing], [nothing]
    return none


def _named(share: Share) -> str:
    if len(share.parameters) == 1:
        return f"what the tolerance of {share.parameters[0]} can do"
    first, second = share.parameters
    if first == second:
        return f"second order of what the tolerance of {first} can do"
    return f"what the tolerances of {first} and {second} can do together"


def _local(statement: Assignment, name: str) -> Assignment:
    """The output of a chain as a local of the threshold."""
    if statement.target == Ref("residual", name):
        return statement._replace(target=Ref("local", name))
    return statement
