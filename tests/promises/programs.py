"""What a residual program promises: whatever is read was given, whatever is declared has a use."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import assert_never

from bondgraph.ir.program import (
    Assign,
    Branch,
    Choice,
    Compare,
    Condition,
    Const,
    Dot,
    Expression,
    Function,
    Logic,
    Mode,
    NewtonBlock,
    PolynomialTape,
    Product,
    Program,
    Ref,
    Statement,
    Sum,
    flat,
)
from tests.promises.check import promise
from tests.promises.graphs import twice

#: What each procedure may read beside its own locals.
_SPACES = {
    "configure": {"param", "option", "coef"},
    "exact": {"coef", "known", "start", "integral", "time"},
    "first": {"coef", "known", "state", "increment", "total"},
    "step": {"coef", "known", "state", "increment", "total"},
}


def leaves(node: Expression | Condition) -> Iterator[Ref | Function | Mode]:
    """The values, functions and modes that an expression reads."""
    parts: Iterable[Expression | Condition]
    match node:
        case Const():
            parts = ()
        case Ref() | Mode():
            yield node
            parts = ()
        case Sum():
            parts = [term for _, term in node.terms]
        case Product():
            parts = (*node.factors, *node.divisors)
        case Function():
            yield node
            parts = node.args
        case Choice():
            parts = (node.condition, node.yes, node.no)
        case Compare():
            parts = (node.left, node.right)
        case Logic():
            parts = node.args
        case _:
            assert_never(node)
    for part in parts:
        yield from leaves(part)


def _read(statement: Assign | PolynomialTape | Dot) -> Iterator[Ref | Function | Mode]:
    match statement:
        case Assign():
            yield from leaves(statement.value)
        case PolynomialTape():
            for scale in statement.scales:
                yield from leaves(scale)
        case Dot():
            for term in statement.terms:
                yield from (Ref("coef", term.array, k) for k in range(term.length))
                yield from (Ref("known", term.signal, k) for k in range(term.length))
        case _:
            assert_never(statement)


def _given(statement: Assign | PolynomialTape | Dot) -> list[Ref]:
    if isinstance(statement, PolynomialTape):
        return [Ref("coef", o.array, k) for o in statement.outputs for k in range(o.length)]
    return [statement.target]


def _procedures(
    program: Program,
) -> dict[str, tuple[Assign | PolynomialTape | Dot, ...]]:
    return {name: tuple(flat(getattr(program, name))) for name in _SPACES}


def _blocks(program: Program) -> Iterator[tuple[NewtonBlock, list[Ref | Function | Mode]]]:
    for block in program.roots:
        own = [leaf for s in flat((*block.body, *block.further)) for leaf in leaves(s.value)]
        yield block, [*own, *leaves(block.value), *leaves(block.slope)]


def _all_read(program: Program) -> Iterator[Ref | Function | Mode]:
    for statements in _procedures(program).values():
        for statement in statements:
            yield from _read(statement)
    for _, own in _blocks(program):
        yield from own


@promise("Program")
def locals_are_given_before_they_are_read(program: Program) -> Iterator[str]:
    """Every local is assigned once, before it is read; so is a coefficient that another needs."""
    for name, statements in _procedures(program).items():
        given: set[tuple[str, str]] = set()
        for statement in statements:
            for ref in _read(statement):
                own = isinstance(ref, Ref) and (
                    ref.space == "local" or (ref.space == "coef" and name == "configure")
                )
                if own and isinstance(ref, Ref) and (ref.space, ref.name) not in given:
                    yield f"{name} reads {ref.space} {ref.name}"
            for target in _given(statement):
                if target.space == "local" and ("local", target.name) in given:
                    yield f"{name} assigns {target.name} twice"
                given.add((target.space, target.name))
    for block in program.roots:
        known = {"x", *block.arguments}
        for assign in flat((*block.body, *block.further)):
            yield from _unknown_in(block, assign.value, known)
            known.add(assign.target.name)
        yield from _unknown_in(block, block.value, known)
        yield from _unknown_in(block, block.slope, known)


def _unknown_in(block: NewtonBlock, value: Expression, known: set[str]) -> Iterator[str]:
    for ref in leaves(value):
        if isinstance(ref, Ref) and ref.space == "local" and ref.name not in known:
            yield f"root {block.name} reads {ref.name}"


def _branches(statements: Iterable[Statement]) -> Iterator[Branch]:
    for statement in statements:
        if isinstance(statement, Branch):
            yield statement
            yield from _branches((*statement.yes, *statement.no))


@promise("Program")
def sides_of_branches_keep_their_locals(program: Program) -> Iterator[str]:
    """A branch has statements, and what they give is read on the same side and nowhere else."""
    whole = [getattr(program, name) for name in _SPACES]
    for statements in [*whole, *((*b.body, *b.further) for b in program.roots)]:
        for branch in _branches(statements):
            if not branch.yes and not branch.no:
                yield f"{branch.target.name} needs no branch"
            for side, value in (branch.yes, branch.value.yes), (branch.no, branch.value.no):
                own = {s.target for s in flat(side)}
                here = Counter(r for s in flat(side) for r in _read(s) if r in own)
                here.update(r for r in leaves(value) if r in own)
                if here != Counter(r for s in flat(statements) for r in _read(s) if r in own):
                    yield f"{branch.target.name}: a local of one side is read elsewhere"


@promise("Program")
def locals_are_read(program: Program) -> Iterator[str]:
    """No local is assigned in vain."""
    for name, statements in _procedures(program).items():
        read = {r for s in statements for r in _read(s) if isinstance(r, Ref)}
        for statement in statements:
            for target in _given(statement):
                if target.space == "local" and target not in read:
                    yield f"{name} has no use for {target.name}"


@promise("Program")
def procedures_read_what_is_theirs(program: Program) -> Iterator[str]:
    """Parameters are read by configure only, samples by step, derivatives by exact."""
    for name, statements in _procedures(program).items():
        for statement in statements:
            for ref in _read(statement):
                if isinstance(ref, Ref) and ref.space not in _SPACES[name] | {"local"}:
                    yield f"{name} reads {ref.space} {ref.name}"
                if isinstance(ref, Ref) and ref.space == "known" and ref.order and name != "exact":
                    yield f"{name} reads a derivative of {ref.name}"


@promise("Program")
def what_is_read_is_declared(program: Program) -> Iterator[str]:
    """Parameters, coefficients, signals, states, modes, tables and roots that are read exist."""
    sizes = {("coef", f.name): max(f.size, 1) for f in program.coefs}
    names = {
        "param": {f.name for f in program.params},
        "option": {"sample_time", "bandwidth", "time_unit"},
        "known": {k.name for k in program.read},
        "state": {f.name for f in program.states},
        "integral": {f.name for f in program.integrals},
    }
    names |= {space: names["known"] for space in ("start", "increment", "total")}
    modes = {k.name for k in program.knowns if k.kind == "mode"}
    tables = {f"table:{name}" for name, _ in program.tables}
    roots = {f"root:{block.name}" for block in program.roots}
    for ref in _all_read(program):
        match ref:
            case Mode():
                known = ref.name in modes
            case Function():
                known = ":" not in ref.name or ref.name in tables | roots
            case Ref(space="coef"):
                known = 0 <= ref.order < sizes.get(("coef", ref.name), 0)
            case _:
                known = ref.space in ("local", "time") or ref.name in names[ref.space]
        if not known:
            yield f"{ref}"


@promise("Program")
def what_is_declared_is_used(program: Program) -> Iterator[str]:
    """Each parameter is read, each coefficient given and read, each state begun by first."""
    read = {(r.space, r.name) for r in _all_read(program) if isinstance(r, Ref)}
    given = {
        (name, target.space, target.name)
        for name, statements in _procedures(program).items()
        for s in statements
        for target in _given(s)
    }
    for field in program.params:
        if ("param", field.name) not in read:
            yield f"parameter {field.name} has no use"
    for field in program.coefs:
        if ("configure", "coef", field.name) not in given:
            yield f"coefficient {field.name} has no value"
        if ("coef", field.name) not in read:
            yield f"coefficient {field.name} has no use"
    for field in program.states:
        if ("first", "state", field.name) not in given:
            yield f"state {field.name} is not set by first"
        if ("state", field.name) not in read:
            yield f"state {field.name} has no use"
    used = {r.name for r in _all_read(program) if isinstance(r, Function)}
    yield from (f"table {n} has no use" for n, _ in program.tables if f"table:{n}" not in used)
    yield from (f"root {b.name} has no use" for b in program.roots if f"root:{b.name}" not in used)


@promise("Program")
def coefficients_are_given_once(program: Program) -> Iterator[str]:
    """Configure gives every element of a coefficient once, within its size."""
    statements = _procedures(program)["configure"]
    given = [ref for s in statements for ref in _given(s) if ref.space == "coef"]
    yield from (f"{ref} twice" for ref in twice(given))
    sizes = {f.name: max(f.size, 1) for f in program.coefs}
    for ref in given:
        if ref.order >= sizes.get(ref.name, 0):
            yield f"{ref.name} has no element {ref.order}"


@promise("Program")
def residuals_have_values(program: Program) -> Iterator[str]:
    """Step, first and exact give each residual once, unless it is said why they do not."""
    for name in ("exact", "first", "step"):
        statements = _procedures(program)[name]
        given = [t.name for s in statements for t in _given(s) if t.space == "residual"]
        silent = [r.name for r in program.residuals
                  if (r.unwritten if name == "exact" else r.unavailable)]  # fmt: skip
        wanted = sorted(r.name for r in program.residuals if r.name not in silent)
        if sorted(set(given) - set(silent)) != wanted or twice(given):
            yield f"{name} gives {given}, not {wanted}"


@promise("Program")
def derivatives_are_asked_for(program: Program) -> Iterator[str]:
    """Exact reads no derivative or integral of a signal beyond what `knowns` declare."""
    range_of = {k.name: (k.lowest, k.highest, k.start) for k in program.knowns}
    for statement in _procedures(program)["exact"]:
        for ref in _read(statement):
            if isinstance(ref, Ref) and ref.name in range_of:
                low, high, start = range_of[ref.name]
                if ref.space == "known" and not low <= ref.order <= max(high, 0):
                    yield f"D({ref.name}, {ref.order}) outside {low}..{high}"
                if ref.space == "start" and not start:
                    yield f"start of {ref.name}"


@promise("Program")
def names_are_unique_in_a_program(program: Program) -> Iterator[str]:
    """Fields, signals, residuals and roots have names of their own."""
    for group in (
        program.params, program.knowns, program.coefs, program.states, program.residuals,
        program.integrals, program.roots,
    ):  # fmt: skip
        yield from (f"{name} twice" for name in twice(item.name for item in group))


@promise("Program")
def tapes_stay_in_their_rows(program: Program) -> Iterator[str]:
    """A tape adds rows that were written to other ones, with scales that exist."""
    for tape in program.configure:
        if isinstance(tape, PolynomialTape):
            written = {0}
            for op in tape.ops:
                if op.target == op.source or op.source not in written or op.target >= tape.rows:
                    yield f"tape of {tape.residual}: row {op.target} from {op.source}"
                if not 0 <= op.scale < len(tape.scales) or op.shift + op.length > tape.length:
                    yield f"tape of {tape.residual}: scale {op.scale}, shift {op.shift}"
                written.add(op.target)
            for out in tape.outputs:
                if out.row not in written or out.length > tape.length:
                    yield f"tape of {tape.residual}: output {out.array}"


@promise("Program")
def openings_are_of_residuals_states_and_modes(program: Program) -> Iterator[str]:
    """What starts a residual anew is a state that step sets and modes that are known."""
    residuals = {r.name for r in program.residuals}
    states = {f.name for f in program.states}
    modes = {k.name for k in program.knowns if k.kind == "mode"}
    for opening in program.openings:
        if opening.residual not in residuals or opening.progress not in states:
            yield f"{opening.residual}: {opening.progress}"
        yield from (f"{opening.residual}: no mode {m}" for m in opening.modes if m not in modes)
