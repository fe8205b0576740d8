"""From residuals to a residual program: what configure, exact and step have to do."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping

from bondgraph.algebra.derivative import TooManyOperations
from bondgraph.algebra.normalise import LIMIT, normalise
from bondgraph.algebra.present import closed_form
from bondgraph.ir.expr import Expr, Kind, Pool, Symbol, symbols, topological
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.normal import NormalForm, Term
from bondgraph.ir.program import (
    Assign,
    Assignment,
    Const,
    Dropped,
    Expression,
    Field,
    Function,
    Opening,
    PolynomialTape,
    Program,
    Ref,
    ResidualInfo,
    Statement,
    flat,
)
from bondgraph.ir.residuals import Observer, Residual, ResidualSet
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.notation.walk import nodes
from bondgraph.passes.lowering.builder import Builder, Signal
from bondgraph.passes.lowering.exactly import LARGEST, Exactly
from bondgraph.passes.lowering.filter import Filter, settle
from bondgraph.passes.lowering.law_chain import law_stages, order
from bondgraph.passes.lowering.luenberger import Luenberger
from bondgraph.passes.lowering.near_functions import near_functions
from bondgraph.passes.lowering.newton import newton_blocks
from bondgraph.passes.lowering.procedure import ZERO
from bondgraph.passes.lowering.program_names import brief, identifier, short
from bondgraph.passes.lowering.prune import pruned
from bondgraph.passes.lowering.switched import Switched
from bondgraph.passes.lowering.tape import Large, filled, large
from bondgraph.passes.lowering.visible import Seen, seen, unseen_faults
from bondgraph.text.tuples import NamedTuple

#: Stages a chain may have; a residual of higher order has no step.
HIGHEST = 12

_TOO_LONG = f"written out it takes more than {LARGEST} operations"
_TEXT_NODES = 150
_TEXT_LENGTH = 600


class LowerOptions(NamedTuple):
    """How the realisable residual is made.

    `rate` in samples a second. `bandwidth` of the filter in rad/s, by default rate/50: at 1 kHz
    20 rad/s, where a residual of order 2 to 3 is 0.15 to 0.2 s late. That is the delay at which
    METHOD 4.3 finds a state-variable filter best against noise, 50 samples a time constant leave
    no trace of the sampling, and the highest visible frequency (rate/10 in Hz) is well above.
    `extra_order` stages more than the highest derivative; `resolution` is the relative size below
    which a term cannot be seen (12 bits). `time_unit` in s is what exact counts derivatives in,
    by default 1 s, or what keeps the coefficients of very long residuals near one. With `libm` step
    calls the functions of the library, else some that are near them (`algebra.near`).
    `tolerances` are those that take the place of what the text says: the digest has them.
    """

    rate: float = 1000.0
    bandwidth: float | None = None
    extra_order: int = 1
    resolution: float = 2.0**-12
    time_unit: float | None = None
    libm: bool = False
    tolerances: tuple[tuple[str, float], ...] = ()


DEFAULT = LowerOptions()
_MOST = 1e6  # samples of a signal that are remembered
_NOT_REMEMBERED = "a switch or an encoder in it would have to be remembered"


class _Lowered(NamedTuple):
    info: ResidualInfo
    first: list[Assignment]
    step: list[Assignment]
    states: list[Field]
    dropped: list[Dropped]
    opening: Opening | None = None


def lower(
    graph: BondGraph,
    residuals: ResidualSet,
    signatures: SignatureMatrix,
    options: LowerOptions = DEFAULT,
    received: bool = False,
    observers: Mapping[str, Observer] = {},
) -> Program:
    """The residual program of a model: coefficients, exact residuals, realisable residuals.

    What a law received of a sensor is the signal of the sensor; with `received` it is a known
    signal of its own, and all else is the same: the terms that are kept, the stages of the filter.

    Of the residuals with an observer among `observers` (by name) step is that observer.
    A residual whose visible order exceeds `HIGHEST` stages, or that has no numbers to tell what
    is visible, gets no step (`ResidualInfo.unavailable`); one of more than `LARGEST` operations no
    exact (`ResidualInfo.unwritten`). See METHOD 4.1, 4.2, 4.5 for the theory.
    """
    builder = Builder(graph)
    apart = [r.expr for r in residuals.residuals]
    joined = graph.pool.logged(apart)
    exprs, others = (apart, joined) if received else (joined, apart)
    forms = [normalise(graph.pool, e, LIMIT, builder.initials) for e in exprs]
    builder.scaled = any(f.tape is not None for f in forms)
    exactly = Exactly(builder)
    filter = Filter(builder)
    switched = Switched(builder, filter, residuals.system)
    time_unit = options.time_unit
    tapes = [
        None if form.tape is None else large(builder, residual, form.tape, options.rate, HIGHEST)
        for residual, form in zip(residuals.residuals, forms, strict=True)
    ]
    if time_unit is None:
        time_unit = max([t.time_unit for t in tapes if t is not None], default=1.0)
    lowered: list[_Lowered] = []
    sees, starts = signatures.sees, graph.initial_values()
    own_and_other = zip(exprs, others, strict=True)
    for residual, form, tape, (expr, other) in zip(
        residuals.residuals, forms, tapes, own_and_other, strict=True
    ):
        text = _text(graph, residual, starts)
        builder.origin = residual.closing.origin
        arrays = {} if tape is None else tape.arrays
        order = exactly.residual(residual, form, arrays, text)
        twin: NormalForm | None = None
        if other is not expr:
            twin = switched.form(other, normalise(builder.pool, other, LIMIT, builder.initials))
        if tape is None:
            form = switched.form(expr, form)
        visible = _visible(builder, form, tape, options)
        found = _terms(builder, visible, twin, options, received)
        faults = sees[residual.name]
        low = _realise(builder, filter, residual, faults, found, options, text, switched)
        own = observers.get(residual.name)
        low = low if own is None else _followed(builder, filter, residual, own, text, low)
        if order is None:
            info = low.info._replace(order=_highest(form), unwritten=_TOO_LONG)
        else:
            info = low.info._replace(order=order)
        lowered.append(low._replace(info=info))
    configure = filled(builder, [tape for tape in tapes if tape is not None])
    coefs = builder.configure()
    wanted = builder.used
    for tape in tapes:
        wanted += [] if tape is None else tape.scales
    asked = [*exprs, *(e for one in observers.values() for e in one.exprs)]
    program = Program(
        name=graph.name,
        title=graph.doc.split("\n\n")[0].replace("\n", " ").strip(),
        source=graph.source.path.replace("\\", "/").rpartition("/")[2],
        digest="",
        params=builder.param_fields(wanted),
        knowns=builder.known_fields([*asked, *switched.read]),
        delayed=builder.delayed_fields([*asked, *switched.read]),
        coefs=tuple(builder.fields),
        states=tuple(s for low in lowered for s in low.states),
        residuals=tuple(low.info for low in lowered),
        configure=(*configure, *coefs),
        exact=tuple(exactly.statements),
        first=tuple(s for low in lowered for s in low.first),
        step=tuple(s for low in lowered for s in low.step),
        dropped=tuple(d for low in lowered for d in low.dropped),
        rate=options.rate,
        bandwidth=options.bandwidth or options.rate / 50,
        warmup=max([_warmup(low.info) for low in lowered], default=0.0),
        tables=(),
        roots=newton_blocks(graph.pool, asked),
        integrals=tuple(builder.integrals.values()),
        time_unit=time_unit,
        openings=tuple(low.opening for low in lowered if low.opening is not None),
    )
    program = with_tables(pruned(program), graph.pool)
    program = program if options.libm else near_functions(program)
    return program._replace(digest=digest(program, graph.source.text, options.tolerances))


def _realise(
    builder: Builder,
    filter: Filter,
    residual: Residual,
    faults: tuple[str, ...],
    found: _Terms | str,
    options: LowerOptions,
    text: str,
    switched: Switched,
) -> _Lowered:
    """One residual of `step`, or the reason why it has none."""
    name = identifier(residual.name)
    origin = residual.closing.origin
    info = ResidualInfo(name, residual.name, text, 0, 0, faults, (), origin)
    inside = [builder.signals[s] for s in symbols(residual.expr) if s in builder.signals]
    longest = max([float(s.declared.delay) for s in inside if s.declared.of], default=0.0)
    if any(map(_whole, inside)):
        found = _NOT_REMEMBERED
    elif longest * options.rate > _MOST:
        found = f"{longest * options.rate:.2g} samples would have to be remembered"
    if not isinstance(found, str):
        kept = (*found.joined.kept, *found.apart.kept)
        stages = max([order(t) for t in kept], default=0) + options.extra_order
        if stages > HIGHEST + options.extra_order:
            found = f"its order {stages - options.extra_order} is above {HIGHEST}"
    if not isinstance(found, str):
        stages = max(stages, 1)
        laws = law_stages(kept)
        window = switched.window(residual, found.joined.kept, stages, laws)
        chain = switched.chain(residual, stages, laws, window)
        try:
            chain.run(found.own.kept, text)
        except TooManyOperations:
            found = _TOO_LONG
        if window is not None and window.opening.modes and any(map(_late, inside)):
            found = _NOT_REMEMBERED  # it would start anew before the switch shows
    if isinstance(found, str):
        nothing = Assign(Ref("residual", name), ZERO, f"{residual.name}: {found}", origin)
        info = info._replace(invisible=faults, unavailable=found)
        return _Lowered(info, [nothing], [nothing], [], [])
    moving = [t for t in found.own.kept if not t.static]
    info = info._replace(
        stages=stages,
        laws=laws,
        invisible=unseen_faults(builder, faults, found.apart, options.rate, options.resolution),
        settle=settle(stages) if window is None else window.over,
        held=chain.held,
        begins=chain.begins,
        approximate=_reason(moving),
    )
    dropped = [Dropped(name, brief(t.atom), t.order, share) for t, share in found.own.dropped]
    if window is None:
        return _Lowered(info, chain.first, chain.step, chain.states, dropped)
    return _Lowered(
        info,
        [*window.first, *chain.first],
        [*window.step, *chain.step],
        [*window.states, *chain.states],
        dropped,
        window.opening,
    )


def _followed(
    builder: Builder,
    filter: Filter,
    residual: Residual,
    observer: Observer,
    text: str,
    low: _Lowered,
) -> _Lowered:
    """One residual of `step` as an observer, or as it is where that takes too many operations."""
    chain = Luenberger(builder, filter, residual, len(observer.states))
    try:
        chain.follow(observer, text)
    except TooManyOperations:
        return low
    info = low.info._replace(
        stages=chain.stages,
        invisible=() if low.info.unavailable else low.info.invisible,
        settle=settle(chain.stages),
        laws=0,
        held=0.0,
        begins="",
        approximate="",
        unavailable="",
        follows=observer.sensor,
    )
    return _Lowered(info, chain.first, chain.step, chain.states, [])


def _whole(signal: Signal) -> bool:
    """Whether a signal is a past value of what nothing lies between: a mode, a count."""
    whole = signal.symbol.kind is Kind.MODE or signal.scale is not None
    return signal.declared.of is not None and whole


def _late(signal: Signal) -> bool:
    """Whether a relation with this signal is one of an earlier time: that of a late sensor."""
    late = signal.symbol.kind is Kind.SENSOR and signal.declared.delay > 0
    return late and signal.declared.of is None


def _warmup(info: ResidualInfo) -> float:
    """Time constants after which nothing in step is left of a start."""
    return 0.0 if info.unavailable else max(info.settle, settle(info.stages))


def _visible(
    builder: Builder, form: NormalForm, tape: Large | None, options: LowerOptions
) -> Seen | str:
    if tape is not None:
        return tape.seen(builder, options.rate, options.resolution)
    return seen(builder, form.terms, options.rate, options.resolution)


class _Terms(NamedTuple):
    """The visible terms of a relation: those that are lowered, and those of both its forms.

    `apart` have what laws received of sensors as signals of their own, `joined` have not. What
    cannot be seen of a signal is left out of both.
    """

    own: Seen
    apart: Seen
    joined: Seen


def _terms(
    builder: Builder,
    found: Seen | str,
    other: NormalForm | None,
    options: LowerOptions,
    received: bool,
) -> _Terms | str:
    """The terms of a relation; `other` is it in the other form, None where both are the same."""
    if isinstance(found, str):
        return found
    if other is None or other.tape is not None:
        return _Terms(found, found, found)
    also = seen(builder, other.terms, options.rate, options.resolution)
    apart, joined = (found, also) if received else (also, found)
    every = [*((t, 0.0) for t in apart.kept), *apart.dropped]
    ones = builder.pool.logged([t.atom for t, _ in every])
    gone = {(t.atom, t.order): share for t, share in joined.dropped}
    keys = [(one, t.order) for one, (t, _) in zip(ones, every, strict=True)]
    apart = apart._replace(
        kept=tuple(t for key, (t, _) in zip(keys, every, strict=True) if key not in gone),
        dropped=tuple((t, gone[k]) for k, (t, _) in zip(keys, every, strict=True) if k in gone),
    )
    return _Terms(apart if received else joined, apart, joined)


def _highest(form: NormalForm) -> int:
    """The highest derivative in a residual that exact does not have."""
    terms = list(form.terms)
    if form.tape is not None:
        terms = [Term(f.atom, f.degree, f.atom, f.static) for f in form.tape.leaves]
    return max(map(order, terms), default=0)


def _reason(moving: list[Term]) -> str:
    if not moving:
        return ""
    return f"a nonlinear term holds a derivative: {short(moving[0].atom)}"


def _text(graph: BondGraph, residual: Residual, starts: Mapping[Symbol, Expr]) -> str:
    """The residual as a person writes it, where that is short enough to be read."""
    if len(topological([residual.expr])) <= _TEXT_NODES:
        text = str(closed_form(graph, residual, starts))
        if len(text) <= _TEXT_LENGTH:
            return f"{residual.name} = {text}"
    return f"{residual.name}: {residual.closing.name} with everything else inserted"


def with_tables(program: Program, pool: Pool) -> Program:
    """The program with the tables that it looks something up in."""
    run: list[Statement] = [*program.configure, *program.exact, *program.first, *program.step]
    values: list[Expression] = []
    for block in program.roots:
        run += [*block.body, *block.further]
        values += [block.value, block.slope]
    for statement in flat(run):
        if isinstance(statement, PolynomialTape):
            values += statement.scales
        elif isinstance(statement, Assign):
            values.append(statement.value)
    called = [node.name for node in nodes(values) if isinstance(node, Function)]
    found = dict.fromkeys(n.removeprefix("table:") for n in called if n.startswith("table:"))
    return program._replace(tables=tuple((name, pool.rows(name)) for name in found))


#: What a program without is the same as it was before there was such a field.
_ADDED = ("openings", "follows", "delayed", "offset", "laws", "held", "begins")


def digest(program: Program, text: str, tolerances: Iterable[tuple[str, float]]) -> str:
    """A hash of the model and of everything that the program computes, in hexadecimal.

    Tolerances in place of those in the text change no residual, but what is known of it.
    """
    lines = [text.replace("\r\n", "\n"), *map(repr, sorted(tolerances))]
    for name in program._fields:
        if name in _ADDED and not getattr(program, name):
            continue
        if name not in ("source", "digest", "bounds"):
            lines.append(f"{name}: {_plain(getattr(program, name))!r}")
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16]


def _plain(value: object) -> object:
    """The value without places, which name files of the machine."""
    if not isinstance(value, tuple):
        return value
    kind = type(value)
    if kind is Ref or kind is Const:
        return (kind.__name__, *value)
    if kind is tuple:
        return tuple([_plain(v) if isinstance(v, tuple) else v for v in value])
    kept = [
        _plain(own) if isinstance(own, tuple) else own
        for name, own in zip(value._fields, value, strict=True)  # type: ignore[attr-defined]
        if name != "origin" and (own or name not in _ADDED)
    ]
    return (kind.__name__, *kept)
