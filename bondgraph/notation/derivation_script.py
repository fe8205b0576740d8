"""A derivation as cells of SymPy code that run by themselves, with what each does above it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence

from bondgraph.ir.derivation import Derivation, DerivationStep
from bondgraph.ir.expr import KNOWN_SIGNALS, VARIABLES, Expr, Kind, symbols
from bondgraph.notation.derivation_words import (
    LatexLines,
    ending,
    headline,
    lines,
    remark,
    title,
)
from bondgraph.notation.parsable import CALLED, UNKNOWN_TO_SYMPY, Names, parsable
from bondgraph.text.source import Source
from bondgraph.text.tuples import NamedTuple

_BEGIN = '''t = sp.Symbol("t", real=True)


def signal(name):
    """A quantity that changes with time."""
    return sp.Function(name, real=True)(t)


def D(x, order=1):
    """The time derivative."""
    return sp.diff(x, t, order)


def Int(x, start=0):
    """The integral from the start, and what it begins with."""
    return sp.Integral(x, (t, 0, t)) + start


def solve(zero, unknown):
    """The one value of an unknown at which an equation holds."""
    (value,) = sp.solve(zero, unknown, simplify=False)
    return value


def put_in(x):
    """What is known for the unknowns, with the derivatives taken."""
    return x.xreplace(known).doit(integrals=False)


def vanishes(x):
    """Whether something is zero: the numerator of a quotient of polynomials in all that moves."""
    x = x.doit(integrals=False)
    names, roots = {}, {}

    def name(part):
        flat = sp.expand(part)
        if flat.is_Mul and flat.args[0] == -1:
            return -name(-flat)
        return names.setdefault(flat, sp.Dummy())

    def root(part):
        base = sp.expand(part.base)
        return roots.setdefault(base, sp.Dummy()) ** (2 * part.exp)

    parts = x.atoms(sp.Function, sp.Derivative, sp.Integral)
    plain = x.xreplace({part: name(part) for part in sorted(parts, key=str)})
    plain = plain.replace(lambda p: p.is_Pow and p.exp.is_Rational and p.exp.q == 2, root)
    above = sp.numer(sp.together(plain))
    for base, unknown in roots.items():
        above = sp.rem(above, unknown**2 - base, unknown)
    return sp.expand(above) == 0'''

_CHECK = '''def check(zero, unknown, value):
    """A value of an unknown at which an equation that is turned around holds."""
    assert vanishes(sp.piecewise_fold(zero.xreplace({unknown: value})))
    return value'''

_LOOP = '''def order(x, unknown):
    """The highest derivative of an unknown."""
    found = [d.derivative_count for d in x.atoms(sp.Derivative) if d.expr == unknown]
    return max(found, default=0)


def numerator(x):
    """The numerator of a relation, as one sum."""
    return sp.expand(sp.numer(sp.cancel(sp.together(x.doit(integrals=False)))))


def lower(row, by, unknown):
    """A row without the highest derivative of an unknown, which another row gives."""
    high, low = order(row, unknown), order(by, unknown)
    value = solve(by, D(unknown, low))
    return numerator(row.xreplace({D(unknown, high): D(value, high - low)}))'''

_LATE = '''def delay(x, seconds):
    """What a signal was some seconds ago."""
    return x.subs(t, t - seconds)'''


#: What a script calls its own things, and what it uses of Python: no value may be called so.
_RESERVED = frozenset(
    "sp t signal D Int solve put_in known vanishes check order numerator lower delay relation kept"
    " factor Rational any classmethod isinstance max print sorted str".split()
)


class Cell(NamedTuple):
    """A cell of a notebook: `kind` is markdown or code."""

    kind: str
    text: str


def cells(derivations: Sequence[Derivation], model: str, source: Source) -> list[Cell]:
    """A notebook: what is derived, all steps as formulas and code, and the comparison."""
    found: list[Cell] = []
    for derivation in derivations:
        found += _Script(derivation, model, source).cells()
    return found


class _Script:
    def __init__(self, derivation: Derivation, model: str, source: Source) -> None:
        self.derivation = derivation
        self.model = model
        self.source = source
        self.zero = derivation.pool.zero
        used = [e for s in derivation.steps for e in (s.zero, s.unknown, s.value, s.factor) if e]
        self.symbols = symbols(*used, derivation.arr, *derivation.starts.values())
        rows = [f"row_{step.number}" for step in derivation.steps]
        self.names = Names((s.symbol.name for s in self.symbols), _RESERVED.union(rows))
        self.functions: dict[str, str] = {}
        self.used: dict[str, None] = {}
        self.roots: dict[str, None] = {}

    def cells(self) -> list[Cell]:
        """The cells of one derivation."""
        derivation = self.derivation
        latex = LatexLines(derivation)
        steps: list[Cell] = []
        for step in derivation.steps:
            words = headline(derivation, step, self.source, latex.inline)
            note = remark(step, latex.inline)
            body = latex.aligned(lines(step, self.zero))
            told = [f"**{step.number}.** {words}", f"$$\n{body}\n$$", *([note] if note else [])]
            steps.append(Cell("markdown", "\n\n".join(told)))
            if own := self._code(step):
                steps.append(Cell("code", own))
        last = [Cell("markdown", ending(derivation))]
        if not derivation.stopped:
            last.insert(0, Cell("code", self._compared()))
        top = Cell("markdown", f"# {title(derivation, self.model)}")
        code = [cell.text for cell in (*steps, *last) if cell.kind == "code"]
        return [top, Cell("code", self._begin(_imported(code))), *steps, *last]

    def _text(self, expr: Expr | None) -> str:
        """An expression as Python; parts of a long one are put into brackets, not into names."""
        assert expr is not None
        own = self.derivation
        found = parsable(own.pool, expr, self.names, own.starts, self.functions)
        self.used.update(dict.fromkeys(found.symbols))
        self.roots.update(dict.fromkeys(name for name, _, _ in found.implicit))
        text = found.expr
        for name, part in reversed(found.defs):
            text = re.sub(rf"\b{name}\b", f"({part})", text)  # `t1`, but not inside `port1`
        return text

    def _code(self, step: DerivationStep) -> str:
        number, used = step.number, step.uses[0] if step.uses else 0
        match step.move:
            case "solve" | "differentiate":
                unknown = self._text(step.unknown)
                return self._known(unknown, f"solve({self._text(step.zero)}, {unknown})")
            case "invert":
                unknown, value = self._text(step.unknown), self._text(step.value)
                checked = f"check({self._text(step.zero)}, {unknown}, {value})"
                return self._known(unknown, checked)
            case "integrate" | "iterate":
                return self._known(self._text(step.unknown), self._text(step.value))
            case "tear":
                return ""
            case "row":
                return f"row_{number} = put_in({self._text(step.zero)})\nrow_{number}"
            case "rise":
                return f"row_{number} = D(row_{used})\nrow_{number}"
            case "untear":
                unknown = self._text(step.unknown)
                return f"row_{number} = solve(row_{used}, {unknown})\nrow_{number}"
            case "put":
                put = f"{{{self._text(step.unknown)}: row_{step.row}}}"
                return f"row_{number} = numerator(row_{used}.xreplace({put}))\nrow_{number}"
            case "lower":
                unknown = self._text(step.unknown)
                return f"row_{number} = lower(row_{used}, row_{step.row}, {unknown})\nrow_{number}"
            case "close":
                return f"relation = put_in({self._text(step.zero)})\nrelation"
            case "free":
                by = f" / ({self._text(step.factor)})" if step.factor else ""
                return f"{self._row(step)}relation = D(sp.expand(relation{by}))\nrelation"
            case "since":
                kept = f"kept = {self._text(step.value)}\nassert vanishes(D(kept) - relation)\n"
                return f"{self._row(step)}{kept}relation = kept\nrelation"
            case "cancel":
                return f"{self._row(step)}relation = sp.expand(relation)\nrelation"
            case "scale" | "shift":
                return self._row(step).strip()

    def _known(self, unknown: str, value: str) -> str:
        return f"known[{unknown}] = put_in({value})\nknown[{unknown}]"

    def _row(self, step: DerivationStep) -> str:
        """The row of a loop that the relation is, where it is one."""
        before = self.derivation.steps[step.uses[0] - 1]
        rows = ("row", "rise", "put", "lower")
        return f"relation = row_{before.number}\n" if before.move in rows else ""

    def _compared(self) -> str:
        own = self.derivation
        name = self.names.add(f"{own.residual}??")  # r1, and r1_ beside a value that is called r1
        return (
            f"# what the compiler says\n{name} = {self._text(own.arr)}\n"
            f"factor = sp.sympify({self._text(own.factor)})\n\n"
            f"assert vanishes(relation - factor*{name})\n"
            f'print("the derived relation is {own.residual} times", factor)'
        )

    def _begin(self, imported: str) -> str:
        """Definitions, and the names that the cells use."""
        moves = {step.move for step in self.derivation.steps}
        parts = [f"import sympy as sp\n{imported}\n{_BEGIN}"]
        if "invert" in moves:
            parts.append(_CHECK)
        if "row" in moves:
            parts.append(_LOOP)
        if any("delay(" in name for name in self.names.by_model):
            parts.append(_LATE)
        undoing = [UNKNOWN_TO_SYMPY[name][2] for name in self.functions if name in UNKNOWN_TO_SYMPY]
        self.functions |= {name: name for name in undoing if name}
        parts += [self._function(name, plain) for name, plain in self.functions.items()]
        groups = {"parameters": "", "commands and measurements": "", "unknowns": ""}
        for kinds, what, make in (
            (KNOWN_SIGNALS - {Kind.MODE}, "commands and measurements", "signal({})"),
            (VARIABLES, "unknowns", "signal({})"),
            ({Kind.MODE}, "switches", "sp.Symbol({})"),
            (None, "parameters and initial values", "sp.Symbol({}, real=True)"),
        ):
            own = [s for s in self.symbols if self._is(s, kinds)]
            rows = [(self.names.by_model[s.symbol.name], s.symbol.name) for s in own]
            if what == "unknowns":
                rows += [(name, self.names.known_as.get(name, name)) for name in self.roots]
            # a constant `t` is not the time, which SymPy would take for the same symbol
            spelled = [(p, json.dumps("constant t" if n == "t" else n)) for p, n in rows]
            told = [f"{p} = {make.format(n)}" for p, n in spelled if p in self.used]
            if told:
                groups[what] = "\n".join([f"# {what}", *told])
        return "\n\n\n".join(parts) + "\n\n\n" + "\n".join(
            [*filter(None, groups.values()), "", "known = {}"]
        )

    def _is(self, symbol: Expr, kinds: frozenset[Kind] | set[Kind] | None) -> bool:
        if kinds is not None:
            return symbol.kind in kinds
        return symbol.kind not in KNOWN_SIGNALS | VARIABLES

    def _function(self, name: str, plain: str) -> str:
        """A function that SymPy does not have: its slope, and what it undoes."""
        doc, slope, inverse = UNKNOWN_TO_SYMPY.get(name, (f"The {name.replace(':', ' ')}", "", ""))
        if not inverse and name.startswith("table:"):
            other = name[:-1] if name.endswith("'") else name + "'"
            inverse = self.functions.get(other, "")
        text = f'class {plain}(sp.Function):\n    """{doc}."""'
        if slope:
            text += f"\n\n    def fdiff(self, argindex=1):\n        return {slope}"
        if inverse:
            text += (
                "\n\n    @classmethod\n    def eval(cls, x):\n"
                f"        return x.args[0] if isinstance(x, {inverse}) else None"
            )
        if slope:
            text += "\n\n    def _eval_is_extended_real(self):\n        return True"
        return text


def _imported(code: Iterable[str]) -> str:
    """The functions of SymPy that code calls, as the line that imports them."""
    words = re.findall(r"(?<![.\w])[A-Za-z]\w*(?=\()", "\n".join(code))
    known = sorted({word for word in words if word in CALLED})
    return f"from sympy import {', '.join(known)}\n" if known else ""


def script(found: Sequence[Cell]) -> str:
    """The cells as one Python file, in the percent format of editors that show cells."""
    parts = []
    for cell in found:
        if cell.kind == "code":
            kept = cell.text.splitlines()
            if len(kept) > 1 and kept[-1].replace("[", "").replace("]", "").isidentifier():
                kept.pop()  # what a notebook shows below a cell
            parts.append("\n".join(["# %%", *kept]))
        else:
            told = [f"# {line}".rstrip() for line in cell.text.splitlines()]
            parts.append("\n".join(["# %% [markdown]", *told]))
    return "\n\n".join(parts) + "\n"


def notebook(found: Sequence[Cell]) -> str:
    """The cells as a Jupyter notebook (format 4.5), not executed."""
    rows = []
    for number, cell in enumerate(found, 1):
        own: dict[str, object] = {"cell_type": cell.kind, "id": f"step-{number}", "metadata": {}}
        if cell.kind == "code":
            own |= {"execution_count": None, "outputs": []}
        rows.append(own | {"source": cell.text.splitlines(keepends=True)})
    about = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    whole = {"cells": rows, "metadata": about, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(whole, indent=1, ensure_ascii=False) + "\n"
