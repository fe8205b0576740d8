"""A residual program as files, in every language asked for."""

from __future__ import annotations

from collections.abc import Iterable

from bondgraph.backends import c, fixed_c, python
from bondgraph.backends.costs import CORES, costs, table, whole
from bondgraph.backends.decision import UNTUNED, Tuned
from bondgraph.backends.deviations import record
from bondgraph.backends.facts import facts
from bondgraph.backends.golden import Golden, golden
from bondgraph.backends.readme import readme
from bondgraph.backends.target import Target, load
from bondgraph.backends.templates import fill
from bondgraph.ir.artifact import Artifact
from bondgraph.ir.fixed_program import FixedProgram
from bondgraph.ir.program import Program
from bondgraph.text.diagnostic import Trouble

_LANGUAGES = {"c": c, "python": python}

#: What there is beside the code, where it is asked for.
EXTRAS = ("tests", "exact", "example", "qemu", "zephyr", "espidf", "arduino", "ros2", "misra")


def emit(
    program: Program,
    targets: tuple[str, ...],
    thresholds: Program | None = None,
    tuned: Tuned = UNTUNED,
    extras: Iterable[str] = (),
    fixed: FixedProgram | None = None,
    measured: bool = False,
) -> tuple[Artifact, ...]:
    """The files of `program` in the `targets` (`c`, `python`), and a README about them.

    Adaptive `thresholds` are in the same files, limits that were `tuned` go with `diagnose`.
    `extras` are `tests` with golden vectors, `exact` residuals of derivatives, an `example`,
    what a board of `qemu` needs to run it, what makes the folder a module of `zephyr`, a
    component of ESP-IDF, a library for `arduino`, a node of `ros2`, and a record of deviations from
    the rules of `misra`. With `fixed`, C is in whole numbers: residuals and `diagnose`, without
    thresholds, and `misra` is the one extra. The same program gives the same bytes, but for the
    costs of the C, which are `measured` with the tools that are here. Raises ValueError for a
    target or an extra that is not there, Trouble for an extra that none of the targets has, and
    where there is nothing to measure with.
    """
    wanted = tuple(name for name in EXTRAS if name in extras)
    if unknown := [name for name in extras if name not in EXTRAS]:
        raise ValueError(f"nothing extra is called {unknown[0]!r}; there are {', '.join(EXTRAS)}")
    for name in wanted:
        if not any(name in load(target).extras for target in targets):
            raise Trouble(f"{name} goes with code in C: ask for the target c, too")
    about = facts(program)
    found: dict[str, str] = {}
    examples: dict[str, str] = {}
    for name in dict.fromkeys(targets):
        target = load(name)
        if fixed is not None and target.fixed:
            found |= _whole_numbers(fixed, target, tuned, wanted)
            continue
        files = _files(program, target, thresholds, tuned, wanted)
        found |= files
        if "example" in wanted:
            examples[name] = files[load(name).extras["example"][0][1]]
    holes = readme(
        program, about, tuple(dict.fromkeys(targets)), examples, thresholds, wanted, fixed
    )
    holes["costs"] = _costs(program, tuned, fixed) if measured and "c" in targets else {}
    found["README.md"] = fill("README.md.j2", holes)
    return tuple(Artifact(path, text) for path, text in found.items())


def _whole_numbers(
    fixed: FixedProgram, target: Target, tuned: Tuned, extras: tuple[str, ...]
) -> dict[str, str]:
    """The code of a program in one language, in whole numbers."""
    holes = fixed_c.files(fixed, target, tuned) | {f"has_{name}": False for name in EXTRAS}
    file = facts(fixed.program).file
    found = {path.format(file=file, of=""): fill(name, holes) for name, path in target.fixed}
    if "misra" in extras:
        own = holes | record(found)
        found |= {path: fill(name, own) for name, path in target.extras["misra"]}
    return found


def _files(
    program: Program,
    target: Target,
    thresholds: Program | None,
    tuned: Tuned,
    extras: tuple[str, ...],
) -> dict[str, str]:
    """The code of a program in one language."""
    language, found, file = _LANGUAGES[target.folder], dict[str, str](), facts(program).file
    holes = language.files(program, target, tuned, thresholds)
    holes |= {f"has_{name}": name in extras for name in EXTRAS}

    def add(files: Iterable[tuple[str, str]], holes: dict[str, object], of: str) -> None:
        for template, path in files:
            found[path.format(file=file, of=of)] = fill(template, holes)

    add(target.files, holes, "")
    if not extras:
        return found
    vectors = golden(program) if "tests" in extras else _untested(program)
    holes = language.vectors(program, target, vectors) | holes
    for name in extras:
        own = holes | language.exact(program, target) if name == "exact" else holes
        if name == "misra" and name in target.extras:
            own = holes | record(found)
        add(target.extras.get(name, ()), own, "")
    if "tests" in extras and thresholds is not None:
        own = language.tests(thresholds, program, target, golden(thresholds), vectors)
        add(target.extras["tests"], holes | own | {"has_exact": False}, "_thresholds")
    return found


def _costs(program: Program, tuned: Tuned, fixed: FixedProgram | None) -> dict[str, object]:
    """What the C without thresholds costs here, as the holes of its table."""
    target, about = load("c"), facts(program)
    if fixed is not None:
        holes = fixed_c.files(fixed, target, tuned) | fixed_c.trials(fixed, target)
        files = _whole_numbers(fixed, target, tuned, ())
        files["tests/golden.h"] = fill("c/costs/fixed_samples.h.j2", holes)
        found = costs(files, about.stem, about.file, holes, whole(CORES))
        return table(found, "samples about zero within their ranges")
    files = _files(program, target, None, tuned, ("tests",))
    holes = c.files(program, target, tuned) | c.vectors(program, target, golden(program))
    return table(costs(files, about.stem, about.file, holes), "the samples of the self-test")


def _untested(program: Program) -> Golden:
    """No vectors: only the parameters that the example sets."""
    return Golden({f.name: 1.0 if f.default is None else f.default for f in program.params}, (), ())
