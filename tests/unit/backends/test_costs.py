"""Costs are counted as other tools count them, and what cannot be measured is said."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import bondgraph
from bondgraph.backends import costs
from bondgraph.text.diagnostic import Trouble
from tests.bench import cortex
from tests.unit.backends.fixed_models import RANGES

_MODELS = Path(__file__).parents[3] / "models"


def _readme(model: str) -> str:
    c = bondgraph.compile(_MODELS / f"{model}.bg", targets=("c",), costs=True)
    return {a.path: a.text for a in c.artifacts}["README.md"]


def _row(text: str, core: str) -> list[str]:
    line = next(line for line in text.splitlines() if line.startswith(f"| {core} |"))
    return [word.strip() for word in line.strip("|").split("|")]


def _only(monkeypatch: pytest.MonkeyPatch, *tools: str) -> None:
    monkeypatch.setattr(costs.shutil, "which", lambda name: name if name in tools else None)


def test_what_is_not_installed_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    _only(monkeypatch)
    with pytest.raises(Trouble, match=r"measured: gcc, valgrind, arm-none-eabi-gcc, .* not inst"):
        _readme("rc_loop")


@pytest.mark.skipif(
    shutil.which("gcc") is None or shutil.which("valgrind") is None, reason="needs gcc, valgrind"
)
def test_a_parameter_without_a_value_is_kept_in_ram(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Then there are no constant coefficients: they are configured, and counted as memory."""
    _only(monkeypatch, "gcc", "valgrind")
    sizes = []
    for value in (": Ohm", "= 2 Ohm"):
        model = tmp_path / "one.bg"
        model.write_text(
            f"bg 1\nmodel One {{ param R {value}\n 1:j {{ <- Se:U; -> R:R; -> Df:i }} }}\n"
        )
        c = bondgraph.compile(model, targets=("c",), costs=True)
        text = {a.path: a.text for a in c.artifacts}["README.md"]
        assert "Not measured, as its tools are not installed: Cortex-M4F, Cortex-M3" in text
        sizes.append([int(word) for word in _row(text, "x86-64")[2:]])
    (_, _, open_ram, *open_rest), (_, rodata, ram, *rest) = sizes
    header = {a.path: a.text for a in c.artifacts}["one.h"]
    assert "one_nominal_coefficients" in header and rodata > 0
    assert open_ram > ram and open_rest == rest


@pytest.mark.skipif(bool(cortex.missing()), reason="needs gcc and qemu for Cortex-M")
def test_whole_numbers_cost_what_another_program_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """`step` with other samples, in a loop of its own; `diagnose` at most what issue 16 allows."""
    _only(monkeypatch, "arm-none-eabi-gcc", "qemu-system-arm")
    c = bondgraph.compile(
        cortex.ROBOT, real="fixed", ranges=RANGES["khepera"], targets=("c",), costs=True
    )
    text = {a.path: a.text for a in c.artifacts}["README.md"]
    core, kind, *numbers = _row(text, "Cortex-M3")
    _, _, ram, _, step, worst, diagnose = map(int, numbers)
    found = cortex.measured_fixed()
    assert (core, kind) == ("Cortex-M3", "int32")
    assert step == pytest.approx(found.instructions, rel=0.02) and worst > step
    assert diagnose <= 120 and ram > found.memory
