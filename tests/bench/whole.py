"""Whole compilations, from text to written files, verified: in processor time of `import sympy`."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from tests.bench import families

MODELS = Path(__file__).parents[2] / "models"


class Case(NamedTuple):
    """A model, the multiple of `import sympy` that is promised, and whether a short run has it."""

    title: str
    text: str
    promised: float
    short: bool = True


def cases() -> list[Case]:
    """What is measured, small models first."""
    return [
        Case("robot", (MODELS / "khepera.bg").read_text(), 0.8),
        Case("Cable(n = 1000)", families.cable(1000), 4),
        Case("chain of 1000 cells", families.chain(1000), 8),
        Case("100 motors", families.bus(100), 3),
        Case("1000 motors", families.bus(1000), 30, short=False),
        Case("grid 8 x 8", families.grid(8), 3),
        Case("grid 16 x 16", families.grid(16), 15, short=False),
        Case("grid 32 x 32", families.grid(32), 120, short=False),
    ]


def processor(*arguments: str) -> float:
    """The seconds of processor time that Python takes for its arguments, in one run.

    Bytecode is kept, whatever the environment says: installed packages bring theirs.
    """
    kept = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    silent = subprocess.DEVNULL
    before = os.times()
    subprocess.run([sys.executable, *arguments], check=True, stdout=silent, stderr=silent, env=kept)
    after = os.times()
    return sum(after[2:4]) - sum(before[2:4])


def compiled(case: Case, *options: str) -> float:
    """The seconds of processor time of one compilation."""
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "model.bg"
        model.write_text(case.text.replace('"khepera.bg"', f'"{MODELS / "khepera.bg"}"'))
        return processor("-m", "bondgraph", "compile", str(model), "-o", f"{folder}/out", *options)


def report(short: bool) -> None:
    """A line a model: its time, the multiple of the yardstick's beside it, what is promised."""
    processor("-c", "import sympy")  # files read once
    for case in cases():
        if short and not case.short:
            continue
        pairs = []
        for _ in range(3 if case.promised < 10 and not short else 1):
            yardstick = processor("-c", "import sympy")
            own = compiled(case)
            pairs.append((own / yardstick, own, yardstick))
        ratio, own, yardstick = sorted(pairs)[len(pairs) // 2]
        print(f"{case.title:24} {own:8.2f} s  import sympy {yardstick:5.2f} s "
              f"{ratio:7.2f}x  <= {case.promised:g}x", flush=True)  # fmt: skip


#: With the relations that tell faults apart it may take so many times as long as without.
_SHARPER = 3
_SHORT = ("khepera", "rc_loop")
_LONG = ("khepera", "dc_motor", "two_tanks", "quarter_car", "rc_loop")


def sharper(short: bool) -> None:
    """A line a model: what `--isolate` takes beside the same without it, in pairs."""
    for stem in _SHORT if short else _LONG:
        case = Case(stem, (MODELS / f"{stem}.bg").read_text(), _SHARPER)
        pairs = [(compiled(case), compiled(case, "--isolate")) for _ in range(1 if short else 3)]
        ratios = sorted((b / a, a, b) for a, b in pairs)
        ratio, plain, own = ratios[len(ratios) // 2]
        print(f"{stem + ' --isolate':24} {own:8.2f} s  without      {plain:5.2f} s "
              f"{ratio:7.2f}x  <= {_SHARPER}x", flush=True)  # fmt: skip


if __name__ == "__main__":
    report("--short" in sys.argv)
    sharper("--short" in sys.argv)
