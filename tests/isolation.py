"""How far faults are told apart: by default, with `--isolate`, and at best.

    python -m tests.isolation models [--write]     # the shipped models
    python -m tests.isolation tests [--write]      # the models of the tests

With `--write` the table goes into `docs/isolability.md`.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import bondgraph
from bondgraph import CompileError
from tests.measured import ROOT, write

PAGE = ROOT / "docs" / "isolability.md"


class Row(NamedTuple):
    """Groups of one model: of the default residuals, with the further ones, at best.

    `together` are the faults that could be told apart and are not, group by group.
    """

    model: str
    residuals: int
    further: int
    default: int
    isolated: int
    best: int
    together: tuple[tuple[str, ...], ...]


def measured(path: Path) -> Row | None:
    """The row of a model; None for one that is wrong, or whose best groups are not known."""
    try:
        plain = bondgraph.compile(path)
        best = plain.maximum_isolability
        sharp = plain.with_options(isolate=True)
        if best is None or not sharp.verification:
            return None
    except CompileError:
        return None
    part = {fault: group[0] for group in best for fault in group}
    together = (tuple(dict.fromkeys(part[f] for f in group)) for group in sharp.signatures.groups)
    return Row(
        str(path.relative_to(ROOT)),
        len(plain.residuals),
        len(sharp.residuals) - len(plain.residuals),
        len(plain.signatures.groups),
        len(sharp.signatures.groups),
        len(best),
        tuple(t for t in together if len(t) > 1),
    )


def rows(folder: str) -> Iterator[Row]:
    """The models of a folder that have residuals."""
    for path in sorted((ROOT / folder).rglob("*.bg")):
        row = None if "broken" in path.parts else measured(path)
        if row is not None and row.residuals:
            yield row


def table(found: list[Row]) -> str:
    """The models whose residuals could tell more apart than by default, and all together."""
    lines = [
        "| Model | Residuals | Groups | with `--isolate` | at best | Not told apart |",
        "|---|---|---|---|---|---|",
    ]
    for row in found:
        if row.default < row.best:
            names = "; ".join(", ".join(f"`{n}`" for n in group) for group in row.together)
            lines.append(
                f"| `{row.model}` | {row.residuals} + {row.further} | {row.default} |"
                f" {row.isolated} | {row.best} | {names} |"
            )
    total = [sum(row[k] for row in found) for k in range(1, 6)]
    lines.append(
        f"| all {len(found)} | {total[0]} + {total[1]} | {total[2]} | {total[3]} | {total[4]} | |"
    )
    return "\n".join(lines)


def main() -> int:
    """The command."""
    folder, *options = sys.argv[1:]
    text = table(list(rows(folder)))
    print(text)
    if "--write" in options:
        write(PAGE, f"python -m tests.isolation {folder}", text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
