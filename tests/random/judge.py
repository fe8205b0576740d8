"""What the compiler says about a random graph, and what is wrong with it."""

from __future__ import annotations

import signal
import traceback
from pathlib import Path
from typing import NamedTuple

from bondgraph.compilation import Compilation
from bondgraph.text.diagnostic import CompileError, Diagnostic
from bondgraph.text.source import Source
from tests.random.graphs import Graph

#: Of processor time: whoever takes longer than that goes on for ever. No test asks for less, for
#: what a machine needs is no answer; the campaign does, and counts.
ENDLESS = 600

#: Outcomes that are no code of a refusal and not `ok` or `no_arr`.
PART = "a part, and says what is missing"
UNEXPLAINED = f"{PART}, some without a reason"
OTHER_COUNT = "other count than by rank, with products or switches"


class Verdict(NamedTuple):
    """`outcome` in a word or the code of the refusal; `notes` are codes worth counting;
    `wrong` is empty or says what must not be."""

    outcome: str
    notes: tuple[str, ...]
    wrong: str


class Slow(Exception):
    """The compiler did not answer in time."""


def judge(graph: Graph, seconds: float = ENDLESS) -> Verdict:
    """Compile a graph as far as the residual program, under a limit of processor time."""
    signal.signal(signal.SIGPROF, _too_slow)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    compilation = Compilation(Source("random.bg", graph.text))
    try:
        return _answered(graph, compilation)
    except CompileError as error:
        return _refused(error.diagnostics)
    except Slow:
        frame = traceback.format_exc().splitlines()[-3].strip()
        return Verdict("time-out", (), f"no answer within {seconds} s: {frame}")
    except Exception as error:
        ours = traceback.extract_tb(error.__traceback__)[-1]
        where = f"{Path(ours.filename).name}:{ours.lineno}"
        return Verdict("exception", (), f"{type(error).__name__}: {error} ({where})")
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def _answered(graph: Graph, compilation: Compilation) -> Verdict:
    count = len(compilation.residuals)
    method = compilation.verification.method
    if count:
        assert compilation.program.residuals
    codes = {d.code for d in compilation.report.diagnostics if d.severity == "warning"}
    notes = tuple(sorted(codes))
    wrong = ""
    if not (method.startswith("exact") or not count or "verification-unavailable" in codes):
        wrong = f"neither verified nor said why not: {method}"
    expected = graph.relations()
    missing = compilation.residuals.missing
    explained = all(m.explained for m in missing)
    # a law of quotients may have more relations than the random rows that stand for it
    agreed = expected == count + len(missing) or (not explained and expected == count)
    if not agreed and not graph.generic:
        return Verdict(OTHER_COUNT, notes, wrong)
    if not agreed:
        wrong = f"{count} relations and {len(missing)} missing, by rank there are {expected}"
    if missing:
        return Verdict(PART if explained else UNEXPLAINED, notes, wrong)
    return Verdict("ok" if count else "no_arr", notes, wrong)


def _refused(diagnostics: tuple[Diagnostic, ...]) -> Verdict:
    errors = [d for d in diagnostics if d.severity == "error"]
    if not errors:
        return Verdict("error", (), "a failure without an error")
    wrong = ""
    for found in errors:
        if found.code == "verification-failed":
            wrong = found.message
        elif not (found.message and found.labels and found.help):
            wrong = f"`{found.code}` without message, place or remedy"
    return Verdict(f"refused: {errors[0].code}", (), wrong)


def _too_slow(*_: object) -> None:
    raise Slow
