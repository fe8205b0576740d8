"""What every value of a residual program is called in one target language."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from functools import cached_property

from bondgraph.backends.blocks import Block, blocks, lines
from bondgraph.backends.identifiers import identifier, snake, spellings
from bondgraph.backends.target import Target
from bondgraph.ir.program import (
    Known,
    Mode,
    PolynomialTape,
    Program,
    Ref,
    ResidualInfo,
    Statement,
    flat,
)
from bondgraph.ir.tables import backwards, is_map

#: Suffixes of the further members that exact takes for one signal.
INTEGRAL, DOUBLE_INTEGRAL, START = "integral", "double_integral", "start"

#: Names that the code uses with the prefix of the model; a residual's number may not be one.
CONSTANTS = frozenset(
    "ABI ALARM BAD_BANDWIDTH BAD_COEFFICIENT BAD_PARAMETER BAD_SAMPLE_TIME BAD_TIME_UNIT BANDWIDTH "
    "BLIND CLASSES CONSTANT DIGEST FAULTS FLOAT GOLDEN_H HEALTHY LIKELY OK REAL RESIDUALS "
    "RESIDUALS_H ROW RULED_OUT SAMPLE_TIME SMALL TIME_UNIT UNKNOWN".split()
)


class Spelling:
    """The names of one program in one language.

    `params`, `coefs`, `knowns`, `states`, `locals`, `tables` map names of the program to
    identifiers (a root by `root:<name>` in `tables`); `inputs` maps (signal, suffix or "") to
    members of the struct of derivatives. With a `base` the code stands beside that of another
    program, and takes the same parameters and samples.
    """

    def __init__(self, program: Program, target: Target, base: Spelling | None = None) -> None:
        self.target = target
        self.prefix = f"{snake(program.name).upper()}_"
        self._known = {k.name: k for k in program.read}
        self._infos = {r.name: r for r in program.residuals}
        self._arrays = {f.name for f in program.coefs if f.size}
        words = target.words
        self.params = spellings((f.name for f in program.params), words)
        self._base = base
        self.coefs = spellings((f.name for f in program.coefs), words)
        self.knowns = spellings((k.name for k in program.read), words)
        self.states = spellings((f.name for f in program.states), words)
        self.residuals = spellings((r.name for r in program.residuals), words | {"valid"})
        #: the names of the numbers of the residuals: `R1`
        self.numbers = self._numbers(program)
        if base is not None:
            self.params |= base.params
            self.knowns |= base.knowns
            self.prefix, self.residuals, self.numbers = base.prefix, base.residuals, base.numbers
        called = {name: _wish(name, is_map(rows)) for name, rows in program.tables}
        called |= {f"root:{b.name}": f"root_{b.name}" for b in program.roots}
        free = spellings(called.values(), target.reserved)
        self.tables = {name: free[wish] for name, wish in called.items()}
        self.locals = spellings(_locals(program), target.reserved)
        self.inputs = self._inputs(program)
        self.blocks = blocks(program)
        #: the samples that step remembers, by the signal: how many at most, and for what
        self.lines = lines(program)
        self._openings = program.openings
        self.encoders = self._encoders()
        self._inside = {block.name: self._of_block(block) for block in self.blocks}

    def _of_block(self, block: Block) -> dict[str, str]:
        """The local variables of a block: what one residual alone computes needs not say whose."""
        names = dict.fromkeys(
            s.target.name for s in flat((*block.first, *block.step)) if s.target.space == "local"
        )
        own = f"{block.residuals[0]}_" if len(block.residuals) == 1 else ""
        wishes = {name: name.removeprefix(own) for name in names}
        if len(set(wishes.values())) < len(wishes):
            return {name: self.locals[name] for name in names}
        free = spellings(wishes.values(), self.target.reserved)
        return {name: free[wish] for name, wish in wishes.items()}

    def _numbers(self, program: Program) -> dict[str, str]:
        upper = {r.name: identifier(r.name).upper() for r in program.residuals}
        taken = set(CONSTANTS)
        free: dict[str, str] = {}
        for name, own in upper.items():
            while own in taken:
                own += "_"
            taken.add(own)
            free[name] = own
        return free

    @cached_property
    def progress(self) -> dict[str, str]:
        """The memory that has to be 1 before a residual is valid, by residual."""
        return {o.residual: self.states[o.progress] for o in self._openings}

    def _encoders(self) -> dict[tuple[str, str], str]:
        """The memory of an encoder by (block, signal): each block starts anew on its own."""
        pairs = [
            (block.name, name)
            for block in self.blocks
            for name in block.knowns
            if self._known[name].counts is not None
        ]
        users = Counter(name for _, name in pairs)
        wanted = {
            (block, name): name if users[name] == 1 else f"{name}_{block}" for block, name in pairs
        }
        free = spellings(wanted.values(), self.target.words)
        return {key: free[name] for key, name in wanted.items()}

    def _inputs(self, program: Program) -> dict[tuple[str, str], str]:
        wanted: dict[tuple[str, str], str] = {(k.name, ""): k.name for k in program.read}
        wanted |= {("", f.name): f.name for f in program.integrals}
        for known in program.read:
            for suffix in suffixes(known):
                wanted[known.name, suffix] = f"{known.name}_{suffix}"
        taken = set(self.target.words) | {"time"}
        found: dict[tuple[str, str], str] = {}
        for key, name in wanted.items():
            own = identifier(name)
            while own in taken:
                own += "_"
            taken.add(own)
            found[key] = own
        return found

    def infos(self, block: Block) -> list[ResidualInfo]:
        """What there is to say of the residuals of a block."""
        return [self._infos[name] for name in block.residuals]

    def unheard(self, block: Block) -> list[str]:
        """The members of a sample that can be NaN and no residual of the block need be so then."""
        plain = (self._known[name] for name in block.knowns if name not in block.heard)
        return [self.knowns[k.name] for k in plain if k.kind != "mode" and k.counts is None]

    def counted(self, block: Block) -> list[tuple[str, str]]:
        """The encoders of a block: the memory of each and its member of a sample."""
        memories = ((self.encoders.get((block.name, name)), name) for name in block.knowns)
        return [(memory, self.knowns[name]) for memory, name in memories if memory is not None]

    def has_derivatives(self, known: str) -> bool:
        """Whether exact takes the signal as an array: itself and its derivatives."""
        return self._known[known].highest >= 1

    def derivative(self, known: str, order: int) -> str:
        """How exact reads a derivative (0 and up) or an integral (-1, -2) of a signal."""
        pattern = self.target.reference
        if order < 0:
            suffix = INTEGRAL if order == -1 else DOUBLE_INTEGRAL
            return pattern["derivative"].format(self.inputs[known, suffix])
        member = pattern["derivative"].format(self.inputs[known, ""])
        if not self.has_derivatives(known):
            return member
        return pattern["element"].format(member, order)

    def exact(self, ref: Ref | Mode) -> str:
        """The name of a value in exact."""
        pattern = self.target.reference["derivative"]
        if isinstance(ref, Mode):
            return pattern.format(self.inputs[ref.name, ""])
        if ref.space == "known":
            return self.derivative(ref.name, ref.order)
        if ref.space == "start":
            return pattern.format(self.inputs[ref.name, START])
        if ref.space == "integral":
            return pattern.format(self.inputs["", ref.name])
        if ref.space == "time":
            return pattern.format("time")
        return self.value(ref)

    def value(self, ref: Ref | Mode, block: str = "") -> str:
        """The name of a value in configure, and in first and step of a block."""
        pattern = self.target.reference
        if isinstance(ref, Mode):
            return pattern["known"].format(self.knowns[ref.name])
        match ref.space:
            case "param":
                return pattern["param"].format(self.params[ref.name])
            case "option":
                return pattern["option"].format(ref.name)
            case "coef":
                name = pattern["coef"].format(self.coefs[ref.name])
                array = ref.name in self._arrays
                return pattern["element"].format(name, ref.order) if array else name
            case "known":
                return pattern["known"].format(self.knowns[ref.name])
            case "increment" | "total":
                return pattern[ref.space].format(self.encoders[block, ref.name])
            case "state":
                return pattern["state"].format(self.states[ref.name])
            case "local":
                return self._inside[block][ref.name] if block else self.locals[ref.name]
            case "residual":
                return pattern["residual"].format(
                    self.residuals[ref.name], self.prefix + self.numbers[ref.name]
                )
            case _:
                raise ValueError(f"{ref.space} of {ref.name} outside exact")


def suffixes(known: Known) -> tuple[str, ...]:
    """The further members of a signal in the struct of derivatives."""
    found: list[str] = []
    if known.lowest <= -1 or known.integral:
        found.append(INTEGRAL)
    if known.lowest <= -2:
        found.append(DOUBLE_INTEGRAL)
    if known.start:
        found.append(START)
    return tuple(found)


def _wish(name: str, is_map: bool) -> str:
    """What a table would like to be called; the readings of a map share its rows where they can."""
    own = name.rstrip("'")
    if is_map:
        return f"{own}_turned" if name == f"{own}''" else own
    return f"{own}_inverse" if backwards(name) else own


def _locals(program: Program) -> Iterable[str]:
    statements: list[Statement] = [
        *(s for block in program.roots for s in (*block.body, *block.further)),
        *program.configure,
        *program.exact,
        *program.first,
        *program.step,
    ]
    names = [
        s.target.name
        for s in flat(statements)
        if not isinstance(s, PolynomialTape) and s.target.space == "local"
    ]
    names += [name for block in program.roots for name in ("x", *block.arguments)]
    return dict.fromkeys(names)
