"""Frama-C's EVA on `step` and `diagnose`: can anything undefined happen, whatever is sampled?

    python -m tests.generated.eva [--fixed] dc_motor two_tanks [--write]

With `--fixed` it is `diagnose` in whole numbers, of any residuals and any limits that the header
allows; its own proof is what `step` of whole numbers has (docs/firmware.md). Needs `frama-c` (Debian: frama-c-base). Samples are any numbers from -1e6 to 1e6, any counts, any
modes, for any time; coefficients are those of the model. What is printed is EVA's own count of
alarms, and each one; with `--write` the table goes into docs/firmware.md.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import tempfile
from pathlib import Path

import bondgraph
from tests.measured import ROOT, write
from tests.unit.backends.fixed_models import RANGES

_SAMPLE = {
    "real": "Frama_C_double_interval(-1e6, 1e6)",
    "bool": "Frama_C_nondet(0, 1)",
    "int32_t": "Frama_C_interval(INT32_MIN, INT32_MAX)",
}
_MAIN = """#include "{file}.h"
#include "__fc_builtin.h"
#include <stdint.h>

int main(void)
{{
    {stem}_memory memory;
    {stem}_samples samples;
    {stem}_residuals residuals;
    {stem}_diagnosis found;
    {stem}_limit limits[{upper}_RESIDUALS];
    int k;

    for (k = 0; k < {upper}_RESIDUALS; ++k) {{
        limits[k] = {stem}_limit_of(0.001);
    }}
    {stem}_reset(&memory);
    {stem}_diagnosis_reset(&found);
    while (Frama_C_nondet(0, 1)) {{
{samples}
        {stem}_step(&{stem}_nominal_coefficients, &memory, &samples, &residuals);
        {stem}_diagnose(&found, limits, 0, &residuals);
    }}
    return 0;
}}
"""
_FIXED = """#include "{file}.h"
#include "__fc_builtin.h"
#include <stdint.h>

int main(void)
{{
    {stem}_residuals residuals;
    {stem}_diagnosis found;
    {stem}_limit limits[{upper}_RESIDUALS];
    int k;

    for (k = 0; k < {upper}_RESIDUALS; ++k) {{
        limits[k].mean = Frama_C_interval(INT32_MIN, INT32_MAX);
        limits[k].level = Frama_C_unsigned_int_interval(0, UINT32_MAX);
        limits[k].bound = Frama_C_unsigned_int_interval(0, UINT32_MAX);
        limits[k].unit = Frama_C_interval(0, 1 << 30);
        limits[k].loud = Frama_C_interval(0, 1 << 30);
        limits[k].drift = Frama_C_interval(0, INT32_MAX);
        limits[k].height = Frama_C_interval(0, INT32_MAX);
        limits[k].unit_shift = (uint8_t)Frama_C_interval(0, 62);
        limits[k].loud_shift = (uint8_t)Frama_C_interval(0, 62);
    }}
    {stem}_diagnosis_reset(&found);
    while (Frama_C_nondet(0, 1)) {{
        for (k = 0; k < {upper}_RESIDUALS; ++k) {{
            residuals.value[k] = Frama_C_interval(INT32_MIN, INT32_MAX);
            residuals.valid[k] = Frama_C_nondet(0, 1);
        }}
        {stem}_diagnose(&found, limits, &residuals);
    }}
    return 0;
}}
"""


def alarms(model: str, fixed: bool = False) -> tuple[int, list[str]]:
    """How many alarms EVA has of a model, and their first lines."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        c = bondgraph.compile(ROOT / "models" / f"{model}.bg", targets=("c",))
        if fixed:
            c = c.with_options(real="fixed", ranges=RANGES[model])
        c.write(folder)
        (header,) = folder.glob("*.h")
        stem = re.findall(r"^void (\w+)_reset\(", header.read_text(), re.MULTILINE)[0]
        body = header.read_text().split(f"typedef struct {stem}_samples {{")[1].split("}")[0]
        members = re.findall(rf"^    (?:{stem}_)?(\w+) (\w+);", body, re.MULTILINE)
        lines = [f"        samples.{member} = {_SAMPLE[kind]};" for kind, member in members]
        main = (_FIXED if fixed else _MAIN).format(
            file=header.stem, stem=stem, upper=stem.upper(), samples="\n".join(lines)
        )
        (folder / "main.c").write_text(main)
        command = ["frama-c", "-eva", "-eva-precision", "3", "-cpp-extra-args=-I.", "main.c"]
        done = subprocess.run(
            [*command, f"{header.stem}.c"], cwd=folder, capture_output=True, text=True,
            check=False, env={**os.environ, "PWD": str(folder)},
        )  # fmt: skip
    count = re.search(r"^  (\d+) alarms? generated", done.stdout, re.MULTILINE)
    assert count is not None, done.stdout[-3000:] + done.stderr
    return int(count[1]), re.findall(r"^\[eva:alarm\] (.*)$", done.stdout, re.MULTILINE)


def main() -> None:
    """A row for each model."""
    parser = argparse.ArgumentParser(prog="python -m tests.generated.eva")
    parser.add_argument("models", nargs="+", metavar="MODEL")
    parser.add_argument("--fixed", action="store_true")
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    rows = ["| model | alarms |", "|---|---|"]
    for model in args.models:
        count, said = alarms(model, args.fixed)
        rows.append(f"| `{model}` | {count} |")
        print("\n".join([rows[-1], *said]), flush=True)
    if args.write:
        words = ["--fixed"] * args.fixed + args.models
        command = f"python -m tests.generated.eva {' '.join(words)}"
        write(ROOT / "docs" / "firmware.md", command, "\n".join(rows))


if __name__ == "__main__":
    main()
