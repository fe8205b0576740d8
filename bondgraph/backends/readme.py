"""The README beside the generated code: what it computes and how to embed it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from bondgraph.backends import listing
from bondgraph.backends.blocks import lines
from bondgraph.backends.c import needs_library
from bondgraph.backends.facts import Facts
from bondgraph.backends.identifiers import identifier, snake
from bondgraph.backends.nominal_coefficients import nominal
from bondgraph.backends.parts import step_part
from bondgraph.backends.target import load
from bondgraph.ir.fixed_program import FixedProgram
from bondgraph.ir.program import Dropped, Field, Known, Program, ResidualInfo
from bondgraph.text.numerals import joined

_ROW_FAULTS = 200  # a longer matrix is left to the list of each residual


def readme(
    program: Program,
    facts: Facts,
    targets: Sequence[str],
    programs: Mapping[str, str],
    thresholds: Program | None = None,
    extras: Sequence[str] = (),
    fixed: FixedProgram | None = None,
) -> dict[str, object]:
    """The holes of README.md.j2; `programs` has the text of the example by target."""
    stem = facts.stem
    return {
        "prefix": stem.upper(),
        "model": _plain(program.name),
        "title": _plain(program.title) if program.title else "",
        "source": _plain(program.source),
        "digest": program.digest,
        "rate": f"{program.rate:g}",
        "residuals": [_residual(r) for r in program.residuals],
        "matrix": _matrix(program.residuals),
        "signals": _table(("signal", "unit", "in `step`", "meaning"), map(_signal, program.knowns)),
        "parameters": _parameters(program.params),
        "files": _file_list(facts.file, targets, extras, fixed is not None),
        "embedded": [_EMBEDDED[name](program, facts) for name in targets],
        "fixed_signals": [] if fixed is None else _fixed_signals(fixed),
        "fixed_digest": "" if fixed is None else fixed.program.digest,
        "fixed_residuals": [] if fixed is None else _fixed_residuals(fixed),
        "examples": [_EXAMPLES[name](text, facts) for name, text in programs.items()],
        "usage": _usage(program, facts, targets, fixed is not None),
        "named": _named(program),
        "dropped": _dropped(program.dropped),
        "thresholds": [] if thresholds is None or fixed is not None else _thresholds(thresholds),
    }


def _fixed_signals(fixed: FixedProgram) -> list[str]:
    """How each sample is scaled, and what it may be."""
    paths = {k.name: k for k in fixed.program.knowns}
    rows = []
    for name, own in fixed.samples.items():
        known, whole = paths[name], f"{own.least} to {own.most}"
        unit, scale = known.unit or "-", f"2^{own.bits}"
        limits = f"{own.low:g} to {own.high:g}"
        if known.counts is not None:
            unit, scale, limits = "counts", "1", "any number; per sample"
        rows.append((f"`{known.path}`", unit, scale, limits, whole))
    return _table(("signal", "unit", "times", "limits", "limits as whole numbers"), rows)


def _fixed_residuals(fixed: FixedProgram) -> list[str]:
    """How each residual is scaled, how large it can be, and how far it is from double."""
    rows = (
        (f"`{name}`", f"2^{own.bits}", f"{own.largest:.3g}", f"{own.fixed:.2g}",
         f"{own.hourly:.2g}" if own.hourly else "none")
        for name, own in fixed.residuals.items()
    )  # fmt: skip
    head = ("residual", "times", "at most", "from double at most", "more for each hour")
    return _table(head, rows)


def _dropped(terms: Sequence[Dropped]) -> list[str]:
    """One row for each signal of a residual."""
    groups: dict[tuple[str, str], list[Dropped]] = {}
    for term in terms:
        groups.setdefault((term.residual, term.signal), []).append(term)
    rows = []
    for (residual, signal), found in groups.items():
        orders = [d.order for d in found]
        run = len(orders) > 2 and orders == list(range(orders[0], orders[-1] + 1))
        text = f"{orders[0]} to {orders[-1]}" if run else ", ".join(map(str, orders))
        share = max(d.share for d in found)
        rows.append((f"`{residual}`", f"`{signal}`", text, f"{share:.1e}"))
    head = ("residual", "signal", "derivatives", "largest share of the leading term")
    return _table(head, rows) if rows else []


def _thresholds(program: Program) -> list[str]:
    """What the threshold of each residual allows for."""
    rows = (
        (f"`{r.name}`", ", ".join(f"`{f}`" for f in r.faults) or "-", r.unavailable or "yes")
        for r in program.residuals
    )
    return _table(("residual", "tolerances in its threshold", "in `step`"), rows)


def _named(program: Program) -> str:
    """How a name of the model looks in the code, if one of them looks different."""
    for path in (*[k.path for k in program.knowns], *[p.path for p in program.params]):
        if identifier(path) != path:
            return f"In the code `.` and `[i]` are `__`: `{path}` is `{identifier(path)}`."
    return ""


def _plain(text: str) -> str:
    return " ".join(text.split())


def _cell(text: str) -> str:
    return _plain(text).replace("|", "\\|")


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    found = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}"]
    return found + [f"| {' | '.join(_cell(c) for c in row)} |" for row in rows]


def _residual(info: ResidualInfo) -> dict[str, object]:
    text = info.text or "(too long to be written here)"
    if info.text and not info.text.startswith((f"{info.name} = ", f"{info.name}: ")):
        text = f"{info.name} = {info.text}"
    facts = []
    if info.order >= 0:
        facts.append(f"highest derivative: {info.order}")
    where = listing.place(info.origin)
    if where:
        facts.append(f"closed by {where}")
    facts.append("sees " + (", ".join(f"`{f}`" for f in info.faults) or "no fault"))
    if info.invisible:
        hidden = ", ".join(f"`{f}`" for f in info.invisible)
        facts.append(f"`step` cannot see at this sample rate: {hidden}")
    if info.follows:
        facts.append(f"`step` is an observer that follows `{info.follows}`")
    if info.approximate:
        facts.append(f"`step` is an approximation: {_plain(info.approximate)}")
    if info.unavailable:
        facts.append(f"`step` never has it: {_plain(info.unavailable)}")
    if info.unwritten:
        facts.append(f"`exact` gives NaN for it: {_plain(info.unwritten)}")
    return {"name": info.name, "text": text.replace("```", "'''"), "facts": facts}


def _matrix(residuals: Sequence[ResidualInfo]) -> list[str]:
    faults = list(dict.fromkeys(f for r in residuals for f in r.faults))
    if len(faults) > _ROW_FAULTS:
        return ["The matrix is long; each residual above names the faults that it sees."]
    rows: dict[tuple[bool, ...], list[str]] = {}
    for fault in faults:
        rows.setdefault(tuple(fault in r.faults for r in residuals), []).append(fault)
    head = (*[f"`{r.name}`" for r in residuals], "faults, not told apart within a row")
    return _table(
        head,
        (
            (*["x" if hit else "" for hit in row], ", ".join(f"`{f}`" for f in group))
            for row, group in rows.items()
        ),
    )


def _signal(known: Known) -> tuple[str, str, str, str]:
    use = "a number"
    if known.kind == "mode":
        use = "a truth value"
    elif known.counts is not None:
        per_turn = f", {known.counts:g} a turn" if known.counts else ""
        use = f"32-bit counts{per_turn}, may run over"
    if not known.sampled:
        use = "not read"
    return f"`{known.path}`", known.unit or "-", use, known.doc or known.kind


def _parameters(params: Sequence[Field]) -> list[str]:
    if not params:
        return ["The code reads no parameters."]
    rows = (
        (f"`{f.path}`", f.unit or "-", "yours" if f.default is None else f"{f.default:g}", f.doc)
        for f in params
    )
    return _table(("parameter", "unit", "value in the model", "meaning"), rows)


#: What there is beside the code, where it was asked for.
_FURTHER = {
    "tests": ("`tests/`", "whether the code gives what it must, on your machine"),
    "exact": ("`exact/`", "the residuals of exact derivatives, for simulators"),
    "example": ("`example/`", "a program to start from"),
    "qemu": ("`qemu/`", "what the example needs to run on a Cortex-M4F in qemu"),
    "zephyr": ("`zephyr/`", "this folder as a module of Zephyr"),
    "espidf": ("`idf_component.yml`, `Kconfig`", "this folder as a component of ESP-IDF"),
    "arduino": (
        "`library.properties`, `library.json`, `examples/`",
        "this folder as a library for Arduino and PlatformIO, with a sketch",
    ),
    "ros2": ("`ros2/`", "a node of ROS 2: samples in, diagnostics out"),
    "misra": ("`MISRA.md`", "which rules of MISRA C:2012 the C does not keep, where and why"),
}


def _file_list(
    file: str, targets: Sequence[str], extras: Sequence[str], fixed: bool
) -> list[str]:
    """What is in the folder."""
    rows = []
    if "c" in targets:
        what = "residuals and verdict in C99, in whole numbers" if fixed else "all of it in C99"
        rows.append((f"`{file}.h`, `{file}.c`", f"{what}: two files to add to a project"))
        rows.append(("`CMakeLists.txt`", "the library, alone or in another project"))
    if "python" in targets:
        digits = "in double" if fixed else "with the same digits"
        rows.append((f"`{file}.py`", f"the same in Python 3.11, {digits}"))
    there = [name for name in _FURTHER if any(name in load(t).extras for t in targets)]
    rows += [_FURTHER[name] for name in there if name in extras]
    found = _table(("file", "what it is"), rows)
    if len(there) > len(extras) and not fixed:
        more = "`bondgraph compile --with` writes more: `bondgraph compile --help` says what."
        found += ["", more]
    return found


def _c_embedded(program: Program, facts: Facts) -> dict[str, str]:
    """The few lines that a controller needs."""
    stem, fixed = facts.stem, nominal(step_part(program)) is not None
    before = [f"static {stem}_memory memory; /* one for each machine */"]
    coefficients = f"&{stem}_nominal_coefficients"
    start = [f"{stem}_reset(&memory);"]
    if not fixed:
        before.append(f"static {stem}_coefficients coefficients;")
        coefficients = "&coefficients"
        upper = stem.upper()
        start.insert(
            0, f"{stem}_configure(&coefficients, &parameters, {upper}_SAMPLE_TIME, "
            f"{upper}_BANDWIDTH);"
        )  # fmt: skip
    code = [
        f'#include "{facts.file}.h"',
        "",
        *before,
        "",
        "/* once */",
        *start,
        "",
        f"/* every {1 / program.rate:g} s */",
        f"{stem}_step({coefficients}, &memory, &samples, &residuals);",
    ]
    return {"title": "In C", "language": "c", "code": "\n".join(code)}


def _python_embedded(program: Program, facts: Facts) -> dict[str, str]:
    unset = any(f.default is None for f in program.params)
    code = [
        f"import {facts.file}",
        "",
        f"monitor = {facts.file}.Monitor({'parameters' if unset else ''})",
        f"residuals = monitor.step(samples)  # every {1 / program.rate:g} s",
    ]
    return {"title": "In Python", "language": "python", "code": "\n".join(code)}


_EMBEDDED = {"c": _c_embedded, "python": _python_embedded}


def _c_example(text: str, facts: Facts) -> dict[str, object]:
    libm = " -lm" if needs_library(facts) else ""
    return {
        "title": "A complete program in C",
        "language": "c",
        "code": text,
        "text": (
            "This is `example/example.c`. Compile it with\n"
            f"`cc -std=c99 -O2 -I. example/example.c {facts.file}.c -o watch{libm}`, or with cmake."
        ),
    }


def _python_example(text: str, facts: Facts) -> dict[str, object]:
    return {
        "title": "A complete program in Python",
        "language": "python",
        "code": text,
        "text": "This is `example/example.py`: `python example/example.py`.",
    }


def _remembered(program: Program) -> list[str]:
    """What `step` keeps of signals that residuals need late."""
    kept = [
        f"{line.length} samples of `{name}` (for {max(p.seconds for p in line.past):g} s)"
        for name, line in lines(program).items()
    ]
    if not kept:
        return []
    return [
        f"- **Delays**: `step` remembers {joined(kept)}, enough for this sample time or a longer "
        "one; a residual that reads them starts when they are there. Between two samples it takes "
        "a straight line.",
    ]


_EXAMPLES = {"c": _c_example, "python": _python_example}


def _switches(program: Program) -> list[str]:
    """What a change of a mode does, for a program in which one does something."""
    path = {k.name: k.path for k in program.knowns}
    pace = program.bandwidth / program.rate
    settle = program.waits(pace)
    when: dict[tuple[str, ...], list[str]] = {}
    for opening in program.openings:
        when.setdefault(tuple(path[m] for m in opening.modes), []).append(opening.residual)
    goes_on = [r.name for r in program.residuals if all(r.name not in own for own in when.values())]
    goes_on += when.pop((), [])
    if not when:
        return []
    told = [
        f"{joined(residuals)} where {' or '.join(f'`{m}`' for m in modes)} changes"
        for modes, residuals in when.items()
    ]
    wait = max(settle[r] for own in when.values() for r in own) / program.bandwidth
    text = (
        "- **Switches**: a change of mode may make something jump that a residual differentiates. "
        f"So there it starts anew, and is not valid for {wait:.2g} s: {'; '.join(told)}. Log the "
        "mode with the samples that it holds for; the sample of the change itself does not count."
    )
    rest = f" {joined(goes_on)} {'go' if len(goes_on) > 1 else 'goes'} on." if goes_on else ""
    return [text + rest]


def _usage(
    program: Program, facts: Facts, targets: Sequence[str], fixed: bool
) -> list[str]:
    pace = program.bandwidth / program.rate
    settle = max(program.waits(pace).values(), default=0.0)
    wait = settle / program.bandwidth
    stem, prefix = facts.stem, snake(program.name).upper()
    found = [
        f"- **`configure`** computes the coefficients. They are made for a sample time of "
        f"{1 / program.rate:g} s and a filter of {program.bandwidth:g} rad/s; a slower filter is "
        "later and quieter. In C they are a struct of their own: constant, in flash if you want, "
        "shared by machines of one kind. Those of the model's own parameters are there already.",
        "- **`step`** takes samples. All signals pass one and the same filter, so that the result "
        "is the residual itself, filtered, without forming a derivative.",
        f"- **Warm-up**: a residual is flagged valid {wait:.2g} s after the first sample "
        f"({settle:g} time constants of the filter). Until then, do not judge it.",
        *_remembered(program),
        *_switches(program),
        "- **Bad samples**: NaN or infinity in a signal, or a law outside its domain, makes the "
        "residuals that see it 0 and invalid, and starts their filter anew at the next good "
        "sample; integrals begin again at their initial values. Other residuals go on. After a "
        "gap in the samples call `reset`.",
        "- **`diagnose`** takes the residuals of `step` and says which are in alarm, since when, "
        "and which classes of faults that leaves: none that a residual in alarm does not see, and "
        "hardly one that a quiet residual would show, were it large enough. Blind residuals say "
        "nothing. A healthy residual is near zero, not zero: `bondgraph compile --tuning` puts the "
        "limits of a log of the healthy machine into the code; or make them of what you see.",
    ]
    if "c" in targets and fixed:
        found.append(
            "- **C** is in whole numbers: no `configure`, since scales and errors are proven for "
            f"the parameters of the model; `{stem}_nominal_coefficients` has "
            "all coefficients. A sample beyond its limits is held at them; residuals that see it "
            "are 0 and not valid, and start anew with the next one within them. One machine is one "
            f"`{stem}_memory`."
        )
    elif "c" in targets:
        found += [
            f"- **C**: C99 or C++, no heap, no globals; one machine is one `{stem}_memory`, and "
            f"several may run side by side. `-D{prefix}_FLOAT` computes in `float`, without any "
            f"`double`. `{stem}_abi()` and `{stem}_digest()` tell what a compiled library is. "
            "`-ffp-contract=off` gives the same digits as Python; `-ffast-math` is refused, "
            "because it cannot tell NaN.",
        ]
    return found
