"""What fills the holes of the C templates for a program in whole numbers."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from functools import partial
from typing import assert_never

from bondgraph.algebra import cubic_tanh
from bondgraph.backends import fixed_decision, listing
from bondgraph.backends.c_functions import Functions, Unit, Written
from bondgraph.backends.decision import Tuned
from bondgraph.backends.facts import ABI, about_known, about_residual, facts
from bondgraph.backends.identifiers import spellings
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import Target
from bondgraph.ir.fixed_program import (
    SAMPLE_BITS,
    Accumulate,
    Count,
    Divide,
    Explained,
    Factor,
    FixedBlock,
    FixedProgram,
    Instruction,
    Limits,
    Multiply,
    Sigmoid,
    SignedRoot,
    Window,
)
from bondgraph.ir.program import Field, Known, Ref
from bondgraph.notation.walk import references
from bondgraph.text.numerals import joined

#: What the templates call their functions, beside the names of `target.toml`.
_NAMES = frozenset(
    """held hold upper times within bounded window tanh_of cubics turned scaled distance loudness
    eighth eighths""".split()
)

_TRIALS = 16  # samples


def files(fixed: FixedProgram, target: Target, tuned: Tuned) -> dict[str, object]:
    """The holes of the templates of C in whole numbers; `tuned` has the sizes of faults."""
    return _Code(fixed, target).holes() | fixed_decision.c_holes(fixed, tuned, target)


def trials(fixed: FixedProgram, target: Target) -> dict[str, object]:
    """The holes for measuring `step`: samples about zero, to either side, and one that is bad."""
    spelling = Spelling(fixed.program, target)
    rows = [[_trial(k, fixed.samples.get(known.name), known) for known in fixed.program.knowns]
            for k in range(_TRIALS)]  # fmt: skip
    return {
        "trial_count": _TRIALS,
        "trials": listing.table([f"{{{', '.join(map(str, row))}}}" for row in rows], target, 4),
        "spoil": [
            f"    bad.{spelling.knowns[k.name]} = INT32_MIN;"
            for k in fixed.program.knowns
            if k.counts is None
        ],
    }


def _trial(at: int, limits: Limits | None, known: Known) -> int:
    """A sample; an encoder is turned to and fro."""
    if limits is None:
        return 0
    if known.counts is not None:
        return at % 2 if limits.least < 0 < limits.most else 0
    off = (limits.most - limits.least) // 64 * (-1 if at % 2 else 1)
    return min(max(off, limits.least), limits.most)


class _Code:
    """Writes a program in whole numbers."""

    def __init__(self, fixed: FixedProgram, target: Target) -> None:
        self.fixed, self.target = fixed, target
        self.program = fixed.program
        self.spelling = Spelling(self.program, target)
        self.about = facts(self.program)
        self.prefix = self.about.stem.upper()
        self.factors: dict[tuple[int, int, str], str] = {}
        self.taken: set[str] = set(target.words) | {"settle", "longest"}
        states = frozenset(self.spelling.states.values()) | {"age", "youngest"}
        names = spellings(self.spelling.encoders.values(), target.words | states)
        self.encoders = {key: names[own] for key, own in self.spelling.encoders.items()}
        self.counted = {k.name for k in self.program.knowns if k.counts is not None}
        self.wide = {g.state for b in fixed.blocks for g in b.guards if g.wide}

    def holes(self) -> dict[str, object]:
        """All of them."""
        blocks = [self._block(k, block) for k, block in enumerate(self.fixed.blocks)]
        kinds = {
            type(e.instruction) for b in self.fixed.blocks for e in (*b.first, *b.step)
        }
        return {
            "stem": self.about.stem,
            "own": "",
            "file": self.about.file,
            "PREFIX": self.prefix,
            "guard": f"{self.prefix}_H",
            "abi": ABI,
            "model": listing.harmless(self.program.name, self.target),
            "digest": self.program.digest,
            "about": self._about(),
            "blocks": blocks,
            "block_count": max(1, len(blocks)),
            "block_names": listing.comment(
                "samples since the start of "
                + ("; ".join(joined(b.residuals) for b in self.fixed.blocks) or "nothing"),
                self.target,
                4,
            ),
            "coefficients": self._coefficients(),
            "constants": self._constants(),
            "memory": self._memory(),
            "within": self._within(),
            "bits": self._bits(),
            "fixed": True,
            "lines": [],
            "bounded": False,
            "needs_functions": False,
            "encoders": self._encoders(),
            "has_high": self._has_high(),
            "bounds": any(b.guards for b in self.fixed.blocks),
            "windows": Window in kinds,
            "roots": SignedRoot in kinds,
            "cubics": self._cubics() if Sigmoid in kinds else [],
            "end": cubic_tanh.END,
            "one": 1 << cubic_tanh.BITS,
            "tanh_bound": f"{cubic_tanh.BOUND:g}",
            **self._signals(),
            **self._counting(),
        }

    def _about(self) -> list[str]:
        name = listing.harmless(self.program.name, self.target)
        source = listing.harmless(self.program.source, self.target)
        paragraphs = [
            f"{self.about.file}.h: residuals of the model {name} in whole numbers of 32 bits, near "
            "zero while the machine is well.",
            listing.harmless(self.program.title, self.target),
            f"Generated by bondgraph from {source}: change the model, not this file. No floating "
            "point, no heap, no globals: everything lives in structs that you own. A number x is "
            "kept as x times a power of two, and nothing overflows while samples are within their "
            "limits; others are held at them, and what sees them is not valid.",
            f"Made for a sample each {1.0 / self.program.rate:g} s, and a filter of "
            f"{self.program.bandwidth:g} rad/s.",
        ]
        lines: list[str] = []
        for paragraph in filter(None, paragraphs):
            lines += ([" *"] if lines else []) + [
                f" * {line}" for line in textwrap.wrap(paragraph, self.target.width - 3)
            ]
        return lines

    # ----------------------------------------------------------------------- structs

    def _signals(self) -> dict[str, object]:
        spelling, residuals = self.spelling, self.fixed.residuals
        numbers = []
        for k, info in enumerate(self.program.residuals):
            text = about_residual(info)
            if info.name in residuals:
                text += f"\n{about_deviation(self.fixed, info.name)}"
            numbers.append((f"{spelling.prefix}{spelling.numbers[info.name]} = {k},", text))
        members = [
            (f"int32_t {spelling.knowns[k.name]};", self._about_sample(k))
            for k in self.program.knowns
        ]
        return {
            "residual_numbers": self._members(numbers),
            "residual_count": len(self.program.residuals),
            "samples": self._members(members),
        }

    def _about_sample(self, known: Known) -> str:
        limits = self.fixed.samples.get(known.name)
        if limits is None:
            return f"{about_known(known)}; step does not read it"
        if known.counts is not None:
            turn = f", {known.counts:g} a turn" if known.counts else ""
            far = f"{limits.least} to {limits.most} from one sample to the next"
            return f"counts{turn}, may run over, {far}: {known.path}"
        return f"times 2^{limits.bits}, from {limits.low:g} to {limits.high:g} {about_known(known)}"

    def _bits(self) -> list[str]:
        """How each signal and residual is scaled, as members of an enum."""
        prefix, spelling = self.prefix, self.spelling
        rows = [
            (f"{prefix}_BITS_{spelling.knowns[name]} = {limits.bits},", f"of {name}")
            for name, limits in self.fixed.samples.items()
            if name not in self.counted
        ]
        rows += [
            (f"{prefix}_RESIDUAL_BITS_{spelling.numbers[name]} = {own.bits},", f"of {name}")
            for name, own in self.fixed.residuals.items()
        ]
        rows[-1] = rows[-1][0].rstrip(","), rows[-1][1]
        return self._members(rows)

    def _members(self, pairs: Sequence[tuple[str, str]]) -> list[str]:
        return listing.members(pairs, self.target, 4)

    def _coefficients(self) -> list[str]:
        docs = {f.name: f.doc for f in self.program.coefs}
        return self._members(
            [
                (f"int32_t {own};", f"{_doc(docs, name)}, times 2^{bits}")
                for (_, bits, name), own in self.factors.items()
            ]
        )

    def _constants(self) -> list[str]:
        pairs = [(f"{value},", own) for (value, _, _), own in self.factors.items()]
        ages = ", ".join("UINT32_MAX" if n is None else f"{n}u" for n in self.fixed.settle)
        known = [n for n in self.fixed.settle if n is not None]
        pairs.append((f"{{{ages}}},", "samples until each is valid"))
        pairs.append((f"{max(known)}u" if known else "UINT32_MAX", "the longest of these"))
        return self._members(pairs)

    def _memory(self) -> list[str]:
        return self._members([self._state(field) for field in self.program.states])

    def _state(self, field: Field) -> tuple[str, str]:
        ref = Ref("state", field.name)
        kind = "int64_t" if ref in self.wide else "int32_t"
        bits = self.fixed.bits[ref]
        return f"{kind} {self.spelling.states[field.name]};", f"{field.doc}, times 2^{bits}"

    # ------------------------------------------------------------------------ samples

    def _within(self) -> dict[str, object]:
        """How step sees that a sample is within its limits, and holds it there."""
        pairs = [
            (self.spelling.knowns[name], limits)
            for name, limits in self.fixed.samples.items()
            if name not in self.counted
        ]
        both = [name for name, limits in pairs if _has_both_signs(limits)]
        others = [
            f"s->{name} >= {limits.least} && s->{name} <= {limits.most}"
            for name, limits in pairs
            if not _has_both_signs(limits)
        ]
        conditions = list(others)
        if both:
            summed = " | ".join(f"within(s->{name})" for name in both)
            conditions.insert(0, f"({summed}) < {1 << (SAMPLE_BITS + 1)}u")
        return {
            "all": listing.statement(
                "return {0};", " && ".join(conditions) or "true", self.target, 4
            ),
            "both": bool(both),
            "offset": f"{1 << SAMPLE_BITS}u",
            "held": [
                f"out->{name} = held(s->{name}, {limits.least}, {limits.most});"
                for name, limits in pairs
            ],
        }

    def _counting(self) -> dict[str, object]:
        places = {r: at for at, b in enumerate(self.fixed.blocks) for r in b.residuals}
        order = {r.name: at for at, r in enumerate(self.program.residuals)}
        computed = [name for name in order if name in places]
        good: list[str] = []
        for at, block in enumerate(self.fixed.blocks):
            parts = [self._is_good(name) for name in block.knowns if name not in self.counted]
            parts += self._guards(block)
            value = " && ".join(parts) or "true"
            good += listing.statement(f"good[{at}] = {{0}};", value, self.target, 4)
        return {
            "index_type": "uint8_t" if len(order) < 256 else "uint16_t",
            "numbers": listing.table([str(order[r]) for r in computed], self.target, 8),
            "block_of": listing.table([str(places[r]) for r in computed], self.target, 8),
            "computed": len(computed),
            "good": good,
            "guards": [g for b in self.fixed.blocks for g in self._guards(b)],
            "all_settled": len(computed) == len(order),
            "unavailable": [
                self.spelling.prefix + self.spelling.numbers[name]
                for name in order
                if name not in places
            ],
        }

    def _is_good(self, known: str) -> str:
        limits, name = self.fixed.samples[known], self.spelling.knowns[known]
        return f"s->{name} == held(s->{name}, {limits.least}, {limits.most})"

    def _guards(self, block: FixedBlock) -> list[str]:
        return [
            f"bounded(x->{self.spelling.states[g.state.name]}, {_wide(g.limit)})"
            for g in block.guards
        ] + [
            f"x->{memory}.turned == held(x->{memory}.turned, {own.least}, {own.most})"
            for memory, _, own in self._counters(block)
        ]

    def _counters(self, block: FixedBlock) -> list[tuple[str, str, Limits]]:
        """The encoders of a block: the memory of each, its signal, and how far it may turn."""
        return [
            (self.encoders[block.name, name], name, self.fixed.samples[name])
            for name in block.knowns
            if name in self.counted
        ]

    def _encoders(self) -> list[str]:
        """The encoders, as members of the memory."""
        return self._members(
            [
                (f"{self.about.stem}_encoder {memory};", f"{name}, read by {joined(b.residuals)}")
                for b in self.fixed.blocks
                for memory, name, _ in self._counters(b)
            ]
        )

    # ----------------------------------------------------------------------- statements

    def _block(self, number: int, block: FixedBlock) -> dict[str, object]:
        infos = [r for r in self.program.residuals if r.name in block.residuals]
        text = [listing.words(listing.place(r.origin), r.text or r.name) for r in infos]
        whose = joined(block.residuals)
        first, step = (
            self._written(block, name, procedure)
            for name, procedure in (("first", block.first), ("run", block.step))
        )
        return {
            "name": block.name,
            "number": number,
            "comment": listing.comment("\n".join([f"{whose} on a sample.", *text]), self.target, 0),
            "comment_first": listing.comment(
                f"{whose} on a first sample, as if all had always been so.", self.target, 0
            ),
            "step": step.body,
            "first": first.body,
            "pieces": [*first.functions, *step.functions],
        }

    def _written(self, block: FixedBlock, verb: str, procedure: Sequence[Explained]) -> Written:
        locals_ = dict.fromkeys(
            e.instruction.target.name for e in procedure if e.instruction.target.space == "local"
        )
        own = f"{block.residuals[0]}_" if len(block.residuals) == 1 else "\0"
        wishes = {name: name.rstrip("'").replace(own, "") for name in locals_}
        free: dict[str, str] = {}
        for name, wish in wishes.items():
            taken = self.target.reserved | _NAMES | set(free.values())
            free[name] = spellings([wish], taken)[wish]
        for memory, name, _ in self._counters(block):
            taken = self.target.reserved | _NAMES | set(free.values())
            free[f"turned {name}"] = spellings([memory], taken)[memory]
        spell = partial(self._spelled, free)
        head = self._turned(block, free, procedure is block.first)
        about = block.residuals[0] + ": "
        said = {r.text for r in self.program.residuals}  # above the function

        def write(numbers: Sequence[int], indent: int) -> list[list[str]]:
            found: list[list[str]] = []
            last = ""
            for explained in (procedure[k] for k in numbers):
                comment, own = explained.comment.removeprefix(about), list[str]()
                if comment and comment != last and explained.comment not in said:
                    own = [""] * bool(found) + listing.comment(comment, self.target, indent)
                last = comment or last
                found.append(own + self._statement(explained.instruction, spell, indent))
            return found

        units = [self._unit(e, spell, about) for e in procedure]
        text = " ".join(head)
        used = {use for unit in units for use in unit.uses}
        unused = [n for n in ("c", "x", "s") if n not in used and f"{n}->" not in text]
        head = [*(f"    (void){n};" for n in unused), *[""] * bool(unused and head), *head]
        arguments = {
            "c": f"const {self.about.stem}_coefficients *c",
            "x": f"{self.about.stem}_memory *x",
            "s": f"const {self.about.stem}_samples *s",
            "r": "int32_t *r",
        }
        names = {f"{v}_{b.name}" for v in ("first", "run") for b in self.fixed.blocks}
        functions = Functions(self.target, "int32_t", arguments, _NAMES | names)
        around = len(head) + bool(head)
        written = functions.procedure(f"{verb}_{block.name}", units, write, around)
        between = [""] if head and written.body else []
        return written._replace(body=[*head, *between, *written.body])

    def _unit(self, explained: Explained, spell: partial[str], prefix: str) -> Unit:
        """What an instruction needs of the function that it stands in."""
        instruction = explained.instruction
        text = " ".join(self._statement(instruction, spell))
        own = instruction.target
        read = references(instruction)
        marks = {"c": "c->", "x": "x->", "s": "s->", "r": "r["}
        return Unit(
            (spell(own),) if own.space == "local" else (),
            frozenset(spell(r) for r in read if r.space in ("local", "increment") and r != own),
            frozenset(name for name, mark in marks.items() if mark in text),
            "",
            explained.comment.removeprefix(prefix),
        )

    def _spelled(self, free: dict[str, str], ref: Ref) -> str:
        if ref.space == "increment":
            return free[f"turned {ref.name}"]
        return free[ref.name] if ref.space == "local" else self.spelling.value(ref)

    def _turned(self, block: FixedBlock, free: dict[str, str], is_first: bool) -> list[str]:
        """How far each encoder has turned since the sample before."""
        found = []
        for memory, name, own in self._counters(block):
            place = f"&x->{memory}, s->{self.spelling.knowns[name]}"
            if is_first:
                known = self.spelling.knowns[name]
                found.append(f"    x->{memory}.count = (uint32_t)s->{known};")
                found.append(f"    x->{memory}.turned = 0;")
            else:
                value = f"held(turn({place}), {own.least}, {own.most}) * {1 << own.bits}"
                found.append(f"    const int32_t {free[f'turned {name}']} = {value};")
        return found

    def _statement(
        self, instruction: Instruction, spell: partial[str], indent: int = 4
    ) -> list[str]:
        target = instruction.target
        left = spell(target)
        prefix = f"const int32_t {left} = {{0}};" if target.space == "local" else f"{left} = {{0}};"
        return listing.statement(prefix, self._value(instruction, spell), self.target, indent)

    def _value(self, instruction: Instruction, spell: partial[str]) -> str:
        match instruction:
            case Accumulate():
                return self._accumulated(instruction, spell)
            case Count(_, terms):
                return self._counted(terms, spell)
            case Window(_, terms, limit, shift):
                return f"window({self._counted(terms, spell)}, {_wide(limit)}, {shift})"
            case Multiply(_, left, right, shift):
                product = f"(int64_t){spell(left)} * {spell(right)}"
                return f"(int32_t)({product} >> {shift})" if shift else f"(int32_t)({product})"
            case Divide(_, above, below, shift):
                scaled = f"(int64_t){spell(above)} * {_wide(1 << shift)}"
                return f"(int32_t)({scaled} / {spell(below)})"
            case SignedRoot(_, argument, shift):
                return f"signed_root({spell(argument)}, {shift})"
            case Sigmoid(_, argument, bits):
                return f"tanh_of({spell(argument)}, {bits})"
        assert_never(instruction)

    def _accumulated(self, instruction: Accumulate, spell: partial[str]) -> str:
        parts: list[tuple[bool, str]] = []
        products, offset, shift = instruction.products, instruction.offset, instruction.shift
        if len(products) == 1 and shift == 32 and not offset:
            [one] = products
            parts.append((True, f"times({self._factor(one)}, {spell(one.variable)})"))
        elif products:
            total = " + ".join(
                f"(int64_t){self._factor(p)} * {spell(p.variable)}" for p in products
            )
            if offset:
                total += f" + {_wide(offset)}"
            whole = f"({total}) >> {shift}" if shift else total
            parts.append((True, f"upper({total})" if shift == 32 else f"(int32_t)({whole})"))
        parts += [(positive, spell(ref)) for positive, ref in instruction.plain]
        if instruction.constant or not parts:
            parts.append((instruction.constant >= 0, str(abs(instruction.constant))))
        parts.sort(key=lambda part: not part[0])  # none begins with a minus
        (positive, first), *rest = parts
        text = first if positive else f"-{first}"
        return text + "".join(f" {'+' if sign else '-'} {part}" for sign, part in rest)

    def _counted(self, terms: Iterable[tuple[int, Ref]], spell: partial[str]) -> str:
        """Small whole numbers times variables, in 64 bits."""
        found = ""
        for number, ref in terms:
            cast = "" if ref in self.wide else "(int64_t)"
            size = abs(number)
            part = f"{cast}{spell(ref)}" if size == 1 else f"{_wide(size)} * {spell(ref)}"
            sign = "-" if number < 0 else "+"
            found += f" {sign} {part}" if found else (part if number > 0 else f"-{part}")
        return found or "0"

    def _factor(self, factor: Factor) -> str:
        """A power of two as it is, anything else from the table of coefficients."""
        if factor.value > 0 and not factor.value & (factor.value - 1):
            return str(factor.value)
        key = factor.value, factor.bits, factor.name or "factor"
        if key not in self.factors:
            same = sum(own == key[2] for _, _, own in self.factors)
            wish = f"{key[2]}_{same + 1}" if same else key[2]
            name = spellings([wish], frozenset(self.taken))[wish]
            self.taken.add(name)
            self.factors[key] = name
        return f"c->{self.factors[key]}"

    def _has_high(self) -> bool:
        return any(
            isinstance(e.instruction, Accumulate) and e.instruction.shift == 32
            for b in self.fixed.blocks
            for e in (*b.first, *b.step)
        )

    def _cubics(self) -> list[str]:
        return listing.table(
            [f"{{{', '.join(map(str, row))}}}" for row in cubic_tanh.cubics()], self.target, 4
        )


def about_deviation(fixed: FixedProgram, residual: str) -> str:
    """The scale and the error of a residual, in a sentence."""
    own = fixed.residuals[residual]
    text = f"times 2^{own.bits}, within {own.fixed:.2g} of double"
    return text + (f", and {own.hourly:.2g} more each hour since the start" if own.hourly else "")


def _has_both_signs(limits: Limits) -> bool:
    return limits.least < 0 < limits.most


def _doc(docs: dict[str, str], name: str) -> str:
    base = name.removesuffix("_rest")
    doc = docs.get(base, base)
    return f"{doc}, less 1" if base != name else doc


def _wide(value: int) -> str:
    return f"INT64_C({value})"
