"""Each line of the table of elements: its C sees what the signature says, and nothing else."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.adversary.test_adversary import PLANTS
from tests.adversary.verdicts import VERDICTS
from tests.elements.answers import ROOT, answer, path
from tests.elements.rows import ROWS, Row
from tests.elements.running import run
from tests.elements.simulated import MACHINES
from tests.elements.test_closed_forms import FORMS

PAGE = ROOT / "docs" / "elements.md"
COUNTS = {form.model: len(form.relations) for form in FORMS}
SEEN = 5  # a fault adds this many times the healthy level
UNSEEN = 0.5  # less of the healthy level where it does not
ROUNDING = 2e-7  # of a third derivative at 400 rad/s; faults add 2e-6 at least where they are seen

INTRODUCTION = """# Elements, sensors and loops: the model that shows each

Every model stands before an independent judge: its physics are written by hand beside it
(`tests/adversary/plants_*.py`), the trajectories are power series of 40 digits. Each residual
vanishes on them, moves with exactly the faults of its signature, and the number of residuals and
the faults that nothing sees are those of a rank computed from the plant. Where the last column
says `series`, the generated C was compiled and run on samples of such a trajectory, healthy and
with every fault in turn; where it says `scipy`, on seconds to minutes of a simulation by Radau's
method, with faults of a fifth (`tests/elements`). `scipy` takes models that a series cannot show:
counts of an encoder, a thermostat that switches on the way.

The relations themselves, derived by hand, are on [a page of their own](closed_forms.md).

This page is made from `tests/elements/rows.py` by `pytest tests/elements --update`.
"""

SAID = """
## Answers, refusals and what is said of them

An `ok` has relations, a `no_arr` is an answer without any. An `error` is a mistake of the model, a
`refused` a sound model of which the compiler can solve no relation with certainty; both name the
elements. An `ok` with relations that are missing names them and their elements in a warning.

| Situation | Model | Status | Residuals | Said |
|---|---|---|---|---|
"""


def page() -> str:
    """The text of the page."""
    parts = [INTRODUCTION]
    for group in dict.fromkeys(r.group for r in ROWS):
        parts.append(f"\n## {group}\n\n| Situation | Domain | Model | Residuals | C run |\n")
        parts.append("|---|---|---|---|---|\n")
        for r in ROWS:
            if r.group == group:
                link = f"[{r.model}]({Path('..') / path(r.model).relative_to(ROOT)})"
                n = PLANTS[r.model].n_arr if r.model in PLANTS else COUNTS[r.model]
                parts.append(f"| {r.situation} | {r.domain} | {link} | {n} | {ran(r)} |\n")
    parts.append(SAID)
    for v in VERDICTS:
        link = f"[{v.name}]({Path('..') / path(v.name).relative_to(ROOT)})"
        page = f"[{v.code}](../bondgraph/errors/{v.code}.md)" if v.code else ""
        situation = v.situation[0].upper() + v.situation[1:]
        parts.append(f"| {situation} | {link} | {v.status} | {v.n_arr} | {page} |\n")
    return "".join(parts)


def ran(row: Row) -> str:
    """Which simulations its code was run on."""
    on = ["series"] if not row.why and row.model in PLANTS else []
    on += ["scipy"] if row.model in MACHINES else []
    return " and ".join(on) or f"no: {row.why}"


def test_the_page_is_what_the_rows_say(update: bool) -> None:
    if update:
        PAGE.write_text(page(), encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == page()


def test_the_rows_show_many_models_of_many_domains() -> None:
    assert len({r.model for r in ROWS}) == len(ROWS) >= 40
    assert len({d for r in ROWS for d in r.domain.split(", ")}) >= 6


@pytest.mark.parametrize(
    "row", [r for r in ROWS if not r.why and r.model in PLANTS], ids=lambda r: r.model
)
def test_the_code_sees_what_the_signature_says(row: Row, tmp_path: Path) -> None:
    plant = PLANTS[row.model]
    assert answer(row.model)["n_arr"] == plant.n_arr
    moves = run(plant, tmp_path, row)
    for k, (level, signature) in enumerate(zip(moves.healthy, moves.signatures, strict=True)):
        assert abs(level) < 1e-4, f"r{k + 1} is {level} on a healthy plant"
        for fault, added in moves.faults.items():
            if fault not in signature:
                assert abs(added[k]) <= UNSEEN * abs(level) + ROUNDING, f"r{k + 1} sees {fault}"
    for fault, added in moves.faults.items():
        ratios = [
            abs(added[k]) / (abs(level) + ROUNDING)
            for k, (level, signature) in enumerate(
                zip(moves.healthy, moves.signatures, strict=True)
            )
            if fault in signature
        ]
        assert not ratios or max(ratios) > SEEN, f"nothing sees {fault}: {ratios}"
