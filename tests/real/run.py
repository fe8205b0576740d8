"""Judges the answers on random real plants: python -m tests.real.run --count 2000 --seed 0."""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # small matrices: threads would only wait for each other

import argparse
import re
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Mapping
from multiprocessing import get_context
from pathlib import Path
from typing import Any, NamedTuple

from tests.real.answer import Slow, answer, limited, unverified
from tests.real.build import Model
from tests.real.draw import of_seed
from tests.real.judge import Entry, Judgement, judge

PAGE = Path(__file__).resolve().parents[2] / "docs" / "real_trajectories.md"
_PATIENCE = 120  # seconds of a processor for one model
_FAILED = "the judge failed"
_BEGIN, _END = "<!-- campaign begins -->", "<!-- campaign ends -->"


class Outcome(NamedTuple):
    """What came of one model."""

    seed: int
    status: str
    judged: Judgement
    note: str = ""
    compiling: float = 0.0
    judging: float = 0.0


def outcome(seed: int) -> Outcome:
    """Draws, compiles and judges the model with a number."""
    model = of_seed(seed)
    begin = time.process_time()
    found = answer(model)
    compiled = time.process_time()
    status = found["status"]
    if status not in ("ok", "no_arr"):
        errors = [d for d in found.get("diagnostics", []) if d["severity"] == "error"]
        note = "; ".join(f"{d['code']}: {d['message']}" for d in errors)
        codes = ", ".join(sorted({d["code"] for d in errors}))
        named = f"{status}: {codes}" if codes else status
        return Outcome(seed, named, Judgement(), note or found.get("message", ""), compiled - begin)
    judged = judgement(model, found, seed) if found["arrs"] else Judgement()
    spent = time.process_time() - compiled
    return Outcome(seed, status, judged, "", compiled - begin, spent)


def judgement(model: Model, found: Mapping[str, Any], seed: int) -> Judgement:
    """What the judge says; a failure of its own is one of what is wrong."""
    try:
        with limited(_PATIENCE):
            return judge(model.plant, found, seed)
    except Slow:
        return Judgement(unjudged=f"not done in {_PATIENCE} s")
    except Exception as failure:
        told = f"the judge failed: {type(failure).__name__}: {failure}"
        return Judgement(broken=(told,), unjudged=_FAILED)


def refused(model: Model) -> str:
    """What the judge says of residuals that the compiler took for a mistake of its own."""
    found = unverified(model)
    if not found["arrs"]:
        return f"nothing can be said: {found['status']}"
    judged = judgement(model, found, 0)
    wrong = [f"{e.residual} and {e.fault}: {e.detail}" for e in judged.entries if _bad(e)]
    said = [*judged.broken, *wrong] or [judged.unjudged or "all residuals and signatures are right"]
    return "; ".join(said)


def _bad(entry: Entry) -> bool:
    return entry.verdict == "wrong"


def show(seed: int) -> None:
    """A model, what the compiler says of it, and every entry that is not right."""
    model = of_seed(seed)
    print(model.text)
    for name, text in model.files.items():
        print(f"{name}:\n{text}")
    for arr in answer(model).get("arrs", []):
        for name, text in arr.get("defs", []):
            print(f"  {name} = {text}")
        for name, text in arr.get("implicit", {}).items():
            print(f"  0 = {text}  for {name}")
        print(f"{arr['name']} = {arr['expr']}\n    {' '.join(arr['signature'])}")


def table(outcomes: list[Outcome]) -> list[str]:
    """The counts as rows of a table."""
    statuses = Counter(o.status for o in outcomes)
    verdicts = Counter(e.verdict for o in outcomes for e in o.judged.entries)
    details = Counter(
        f"{e.verdict}: {e.detail.split(' with other')[0]}"
        for o in outcomes
        for e in o.judged.entries
        if e.verdict in ("wrong", "not a candidate") and e.detail
    )
    unjudged = Counter(o.judged.unjudged for o in outcomes if o.judged.unjudged)
    broken = sum(len(o.judged.broken) for o in outcomes if o.judged.unjudged != _FAILED)
    rows = [("models", len(outcomes)), ("compiled, with residuals", statuses.pop("ok", 0))]
    rows.append(("compiled, without redundancy", statuses.pop("no_arr", 0)))
    rows += [(f"not compiled: {name}", n) for name, n in statuses.most_common()]
    rows += [(f"models not judged: {name}", n) for name, n in unjudged.most_common()]
    rows.append(("residuals that do not vanish on a healthy plant", broken))
    judged = ("right", "wrong", "off nominal", "unconfirmed")
    rows.append(("entries judged", sum(verdicts[v] for v in judged)))
    rows += [(f"entries {v}", verdicts.pop(v, 0)) for v in judged]
    rows += [(f"entries {name}", n) for name, n in verdicts.most_common()]
    rows += [(f"of these {name}", n) for name, n in sorted(details.items())]
    return ["| | |", "|---|---:|", *[f"| {name} | {n} |" for name, n in rows]]


def commit() -> str:
    """The commit that was judged, with a mark where files differ from it."""
    words = ["git", "describe", "--always", "--dirty", "--exclude", "*"]
    return subprocess.run(words, capture_output=True, text=True, check=False).stdout.strip()


def write_page(judged: str, first: int, rows: list[str], count: int) -> None:
    """Puts the table of this run into the page."""
    told = [
        f"`python -m tests.real.run --seed {first} --count {count}` at commit {judged}:",
        "",
        *rows,
        "",
    ]
    text = PAGE.read_text(encoding="utf-8")
    new = "\n".join([_BEGIN, "", *told, _END])
    text = re.sub(f"{_BEGIN}.*?{_END}", lambda _: new, text, flags=re.DOTALL)
    PAGE.write_text(text, encoding="utf-8")


def problems(found: Outcome) -> list[str]:
    """What is wrong, a line each."""
    bad = ("verification-failed", "exception")
    out = [f"{found.seed}: {text}" for text in found.judged.broken]
    if any(word in found.status for word in bad):
        out.append(f"{found.seed}: {found.status}: {found.note.strip()[-600:]}")
    for e in found.judged.entries:
        if _bad(e):
            out.append(f"{found.seed}: {e.residual} and {e.fault}: {e.detail}")
    return out


def main() -> int:
    """Status 1 if something is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0, help="number of the first model")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", type=int, help="judge one model")
    parser.add_argument("--show", action="store_true", help="print the model that --only names")
    parser.add_argument("--page", action="store_true", help="write the table into the page")
    options = parser.parse_args()
    if options.only is not None:
        if options.show:
            show(options.only)
        seeds = range(options.only, options.only + 1)
    else:
        seeds = range(options.seed, options.seed + options.count)
    begin = time.monotonic()
    judged = commit()
    outcomes: list[Outcome] = []
    wrong: list[str] = []
    with get_context("spawn").Pool(options.jobs) as pool:
        for found in pool.imap(outcome, seeds, chunksize=5):
            outcomes.append(found)
            wrong += problems(found)
            for line in problems(found):
                print(line, flush=True)
    rows = table(outcomes)
    print("\n".join(rows))
    compiling, judging = (sum(getattr(o, x) for o in outcomes) for x in ("compiling", "judging"))
    print(
        f"{time.monotonic() - begin:.0f} s, of processors {compiling:.0f} s for compiling and"
        f" {judging:.0f} s for judging"
    )
    if options.page:
        write_page(judged, seeds.start, rows, len(outcomes))
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
