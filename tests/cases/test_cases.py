"""Small models, a folder for each pass, with what `dump` says of them beside: `name.expected`.

`make update` (or `pytest tests/cases --update`) writes the expected texts anew. That they are true,
and not only the same as before, is held by what the stages promise and by the verification of each
compilation. A new case is one file: its first comment says what it teaches.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from bondgraph.cli.dump import text_of
from bondgraph.compilation import compile
from bondgraph.frontend.formatter import format_text
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source
from tests.promises import broken_stages

HERE = Path(__file__).parent

#: The folder of a pass, and the stages that it is seen in.
STAGES = {
    "elaborate": ("graph",),
    "causality": ("causal",),
    "equations": ("equations",),
    "eliminate": ("reduced",),
    "signatures": ("residuals", "signatures"),
    "program": ("program",),
}
CASES = sorted(HERE.glob("*/*.bg"))


@pytest.mark.parametrize("file", CASES, ids=lambda file: f"{file.parent.name}/{file.stem}")
def test_case(file: Path, update: bool) -> None:
    compilation = compile(file)
    found = broken_stages(compilation)
    assert "program" in found and not any(found.values())
    assert compilation.verification.method.startswith("exact")
    text = "\n\n".join(text_of(compilation, stage) for stage in STAGES[file.parent.name]) + "\n"
    expected = file.with_suffix(".expected")
    if update:
        expected.write_text(text, encoding="utf-8")
    assert text == expected.read_text(encoding="utf-8")


def test_every_case_says_what_it_teaches_and_no_expected_text_is_left_over() -> None:
    for file in CASES:
        text = file.read_text(encoding="utf-8")
        assert re.match(r"bg 1\n# .{20,98}\n", text), file.name
        assert format_text(Source(file.name, text), Report()) == text, file.name
    assert {f.with_suffix(".bg") for f in HERE.glob("*/*.expected")} == set(CASES)
    assert {file.parent.name for file in CASES} == STAGES.keys()
