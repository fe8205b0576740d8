"""The golden vectors and the examples as lines of C and of Python."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence

from bondgraph.backends import listing
from bondgraph.backends.blocks import Block
from bondgraph.backends.golden import Golden, Vector
from bondgraph.backends.members import Member, derivatives, samples
from bondgraph.backends.spelling import Spelling
from bondgraph.ir.program import Program
from bondgraph.notation.dialect import digits

_SMALLEST = 1e-37  # below this single precision has nothing but zero


def _number(value: float) -> str:
    return digits(value if abs(value) > _SMALLEST else 0.0)


class Vectors:
    """What the self-test and the example of one program need, in one language."""

    def __init__(
        self,
        program: Program,
        spelling: Spelling,
        golden: Golden,
        base: tuple[Program, Golden] | None = None,
    ) -> None:
        """With a `base` the program takes the parameters and samples of that one."""
        self.program = program
        self.spelling = spelling
        self.golden = golden
        self.base, base_golden = base or (program, golden)
        self.parameters = base_golden.parameters | golden.parameters
        self.samples = samples(self.base, spelling)
        self.derivatives = list(derivatives(program, spelling))

    def spoilt(self) -> list[bool]:
        """For each residual, whether a sample that it reads can be other than a number."""
        known = {k.name: k for k in self.program.read}

        def measured(block: Block) -> bool:
            signals = (known[name] for name in block.knowns)
            return any(k.kind != "mode" and k.counts is None for k in signals)

        found = {r for b in self.spelling.blocks if measured(b) for r in b.residuals}
        return [r.name in found for r in self.program.residuals]

    def unset(self) -> list[tuple[str, str, float]]:
        """Parameters without a value in the model: identifier, unit, value in the self-test."""
        return [
            (self.spelling.params[f.name], f.unit, self.parameters[f.name])
            for f in {f.name: f for p in (self.base, self.program) for f in p.params}.values()
            if f.default is None
        ]

    # ---------------------------------------------------------------------------- C

    def c(self) -> dict[str, object]:
        """The holes of golden.h.j2, selftest.c.j2 and example.c.j2."""
        count = len(self.program.residuals)
        target = self.spelling.target
        stem = self.spelling.prefix.lower()
        spoilt = [f"{str(s).lower()}," for s in self.spoilt()]
        reals = [m.name for m in self.samples if m.type == "real"]
        return {
            "spoilt": listing.table_lines(spoilt, target, 4),
            "spoil": [f"    bad.{name} = ({stem}real)NAN;" for name in reals],
            "thresholds": [
                f"    {stem.upper()}CONSTANT(0.001), /* {r.name} */" for r in self.program.residuals
            ],
            "readings": self._readings("    samples->{0} = {1};", _C_ZERO),
            "from_log": self._from_log(f"    samples->{{0}} = {_C_READ};", stem),
            "from_list": [
                f"        samples.{m.name} = {_C_LIST[m.type].format(stem, k)};"
                for k, m in enumerate(self.samples)
            ],
            "to_set": [
                f"    parameters.{name} = {stem.upper()}CONSTANT(1.0); "
                f"/* {unit or '-'}: the model has no value, put yours */"
                for name, unit, _ in self.unset()
            ],
            "golden_parameters": [
                f"    parameters->{name} = N({_number(x)});" for name, _, x in self.unset()
            ],
            "remembers": bool(self.spelling.lines),
            "golden_exact_count": len(self.golden.exact),
            "golden_step_count": len(self.golden.step),
            "golden_tables": [
                self._c_signals("derivatives", self.derivatives, self.golden.exact),
                self._c_results("exact", self.golden.exact, count),
                self._c_signals("samples", self.samples, self.golden.step),
                self._c_results("step", self.golden.step, count),
            ],
        }

    def _readings(self, pattern: str, zero: dict[str, str]) -> list[str]:
        target = self.spelling.target
        pairs = [(pattern.format(m.name, zero[m.type]), m.text) for m in self.samples]
        indent = len(pattern) - len(pattern.lstrip())
        short = [(d.strip(), text.partition(" (")[0]) for d, text in pairs]
        return listing.members(short, target, indent)

    def _from_log(self, pattern: str, stem: str = "") -> list[str]:
        """How the example reads the samples that `step` needs from the columns of a log."""
        around = _FROM_LOG[self.spelling.target.name]
        found = []
        for member, known in zip(self.samples, self.base.knowns, strict=True):
            if known.sampled:
                before, behind = around[member.type]
                found.append(pattern.format(member.name, before.format(stem), known.path, behind))
            elif not stem:  # in Python a sample is whole
                found.append(f"                {member.name}={_PYTHON_ZERO[member.type]},")
        return found

    def _c_signals(
        self, name: str, members: Sequence[Member], vectors: Sequence[Vector]
    ) -> dict[str, object]:
        rows = [_row(members, v, lambda x: f"N({_number(x)})", "{}") for v in vectors]
        lines = _rows(rows or ["{0}"], self.spelling)
        kind = f"{self.spelling.prefix.lower()}{name}"
        return {"type": kind, "name": f"golden_{name}[]", "lines": lines,
                "exact": name == "derivatives"}  # fmt: skip

    def _c_results(self, name: str, vectors: Sequence[Vector], count: int) -> dict[str, object]:
        nan = f"({self.spelling.prefix.lower()}real)NAN"

        def number(x: float) -> str:
            return nan if math.isnan(x) else f"N({_number(x)})"

        rows = [
            f"{{{', '.join(f'{{{number(v)}, {number(s)}}}' for v, s in v.results)}}}"
            for v in vectors
        ]
        lines = _rows(rows or ["{{0}}"], self.spelling)
        return {
            "type": "golden_result",
            "name": f"golden_{name}[][{count}]",
            "lines": lines,
            "exact": name == "exact",
        }

    # ----------------------------------------------------------------------- Python

    def python(self) -> dict[str, object]:
        """The holes of selftest.py.j2 and example.py.j2."""
        target = self.spelling.target
        reals = [m.name for m in self.samples if m.type == "real"]
        spoilt = zip(self.program.residuals, self.spoilt(), strict=True)
        names = [self.spelling.residuals[r.name] for r in self.program.residuals]
        return {
            "names": listing.table_lines([f'"{n}",' for n in names], target, 4),
            "spoilt": listing.table_lines([f'"{r.name}",' for r, s in spoilt if s], target, 4),
            "reals": listing.table_lines([f'"{name}",' for name in reals], target, 4),
            "thresholds": [f'    "{n}": 0.001,' for n in names],
            "readings": self._readings("        {0}={1},", _PYTHON_ZERO),
            "residual_total": len(self.program.residuals),
            "from_log": self._from_log(f"                {{0}}={_PYTHON_READ},"),
            "reads_log": any(k.sampled for k in self.program.knowns),
            "to_set": [
                f"    {name}=1.0,  # {unit or '-'}: the model has no value, put yours"
                for name, unit, _ in self.unset()
            ],
            "golden_parameters": [f"    {name}={_number(x)}," for name, _, x in self.unset()],
            "golden_exact": self._python_rows("e.Derivatives", self.derivatives, self.golden.exact),
            "golden_step": self._python_rows("m.Samples", self.samples, self.golden.step),
        }

    def _python_rows(
        self, kind: str, members: Sequence[Member], vectors: Iterable[Vector]
    ) -> list[str]:
        rows = []
        for vector in vectors:
            values = _row(members, vector, _number, "()", named=True)
            results = ", ".join(
                f"({'math.nan' if math.isnan(v) else _number(v)}, {_number(s)})"
                for v, s in vector.results
            )
            rows.append(f"({kind}{values}, ({results},))")
        return _rows(rows, self.spelling)


_C_ZERO = {"real": "0", "bool": "false", "count": "0"}
_PYTHON_ZERO = {"real": "0.0", "bool": "False", "count": "0"}
_C_READ = '{1}column(names, line, "{2}"){3}'
_C_LIST = {"real": "({0}real)data[{1}]", "bool": "data[{1}] > 0.5", "count": "(int32_t)data[{1}]"}
_PYTHON_READ = '{1}float(row["{2}"]){3}'
#: What goes before and behind a value of a log, in C and in Python.
_FROM_LOG = {
    "C": {"real": ("({0}real)", ""), "bool": ("", " > 0.5"), "count": ("(int32_t)", "")},
    "Python": {"real": ("", ""), "bool": ("", " > 0.5"), "count": ("int(", ")")},
}


def _row(
    members: Iterable[Member],
    vector: Vector,
    number: Callable[[float], str],
    brackets: str,
    named: bool = False,
) -> str:
    """One vector as the value of a struct."""
    found = []
    for member in members:
        name = member.refs[0].name
        if member.type == "bool":
            held = vector.modes.get(name, False)
            text = str(held) if named else str(held).lower()
        elif member.type == "count":
            text = str(vector.counts.get(name, 0))
        else:
            values = [number(vector.values.get(ref, 0.0)) for ref in member.refs]
            text = ", ".join(values)
            if member.size:
                text = f"({text})" if named else f"{{{text}}}"
        found.append(f"{member.name}={text}" if named else text)
    return f"{brackets[0]}{', '.join(found)}{brackets[1]}"


def _rows(rows: Iterable[str], spelling: Spelling) -> list[str]:
    """Each row on lines of its own."""
    return [line for row in rows for line in listing.table_lines([f"{row},"], spelling.target, 4)]
