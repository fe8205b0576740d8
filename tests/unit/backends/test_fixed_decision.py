"""`diagnose` in whole numbers: as its own arithmetic says, as double decides, or refused."""

from __future__ import annotations

import math
import random
import re
import shutil
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import bondgraph
from bondgraph import Fault
from bondgraph.backends.costs import CORES, Core, missing
from bondgraph.backends.decision import fault_classes
from bondgraph.backends.fixed_decision import HIGHEST, ROUGH, whole_limit
from bondgraph.backends.templates import codegen, fill
from bondgraph.cli.main import main
from bondgraph.compilation import Compilation
from bondgraph.ir.fixed_program import SUM_BITS, FixedProgram, WholeLimit
from bondgraph.ir.residual_limit import ResidualLimit, ShownSize
from bondgraph.runtime.diagnosis.calibration import tune
from bondgraph.runtime.diagnosis.tuning import Limit, Tuning
from bondgraph.text.diagnostic import CompileError
from tests.unit.backends.compilers import python_module, run
from tests.unit.backends.fixed_models import RANGES
from tests.unit.backends.motor_errand import errand
from tests.unit.backends.whole_decision import ALARM, Decision, DiagnoseInC
from tests.unit.backends.whole_numbers import WORD
from tests.unit.backends.whole_numbers import InC as StepInC

_MODEL = "models/dc_motor.bg"
_SIGMA = {"r1": 1e-3, "r2": 4e-7}
_BOUND = {"r1": 2e-3, "r2": 3e-7}
_WINDOW = 0.5  # s


def _tuning(**changes: float) -> Tuning:
    """A tuning of the motor; its residuals show some faults from smaller sizes on than others."""
    program = bondgraph.compile(_MODEL).program
    limits = {
        name: Limit(sigma=sigma, crossings=3.0, kappa=4.5, height=9.0, mean=0.1 * sigma, memory=1.7)
        for name, sigma in _SIGMA.items()
    }
    limits = {name: own._replace(**changes) for name, own in limits.items()}
    shows = {r.name: {f: ShownSize(1.0, 1.5 + len(f)) for f in r.faults} for r in program.residuals}
    rest = limits, _BOUND, shows, _WINDOW
    return Tuning(program.digest, program.rate, program.bandwidth, 1.0, 60.0, *rest)


def _whole(tuning: Tuning) -> Compilation:
    c = bondgraph.compile(_MODEL).tuned(tuning)
    return c.with_options(real="fixed", ranges=RANGES["dc_motor"], targets=["c"])


@cache
def _compiled() -> Compilation:
    return _whole(_tuning())


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("whole")
    _compiled().write(found)
    return found


@pytest.fixture(scope="module")
def in_c(folder: Path) -> DiagnoseInC:
    return DiagnoseInC(folder, "motor", 2, 3)


@pytest.fixture(scope="module")
def double(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    found = tmp_path_factory.mktemp("double")
    bondgraph.compile(_MODEL).tuned(_tuning()).write(found, targets=["python"])
    return python_module(found, "motor")


def _decision(fixed: FixedProgram, limits: tuple[WholeLimit, ...], latch: bool) -> Decision:
    row = math.ceil(3.0 / fixed.program.bandwidth * fixed.program.rate)
    window = max(2 * row, math.ceil(_WINDOW * fixed.program.rate))
    classes = fault_classes(fixed.program, _compiled()._tuned)
    return Decision(limits, classes, row, window, latch)


def _course(fixed: FixedProgram, seed: int, rows: int) -> Iterator[list[int | None]]:
    """Residuals that are well, off a little or far, loud, at their ends, without a value."""
    draw = np.random.default_rng(seed)
    sigma = np.array([math.ldexp(_SIGMA[n], own.bits) for n, own in fixed.residuals.items()])
    value = sigma * draw.normal(size=(rows, 2))
    valid = np.ones((rows, 2), dtype=bool)
    for _ in range(rows // 1500):
        a = int(draw.integers(rows))
        part, k = slice(a, a + int(draw.integers(20, 4000))), int(draw.integers(2))
        match int(draw.integers(5)):
            case 0:
                value[part, k] += sigma[k] * draw.choice([-1.0, 1.0]) * 2.0 ** draw.integers(2, 14)
            case 1:
                value[part, k] += sigma[k] * draw.choice([-3.2, 3.2])
            case 2:
                value[part, k] *= 4.0
            case 3:
                value[part, k] = draw.choice([1 - WORD, WORD - 1])
            case _:
                valid[part, k] = False
    whole = np.clip(np.round(value), 1 - WORD, WORD - 1).astype(np.int64)
    for numbers, known in zip(whole.tolist(), valid.tolist(), strict=True):
        yield [x if ok else None for x, ok in zip(numbers, known, strict=True)]


# ------------------------------------------------------------------------ C and whole numbers


@pytest.mark.parametrize(("seed", "latch"), [(1, False), (2, False), (3, True)])
def test_c_decides_as_whole_numbers_say(in_c: DiagnoseInC, seed: int, latch: bool) -> None:
    fixed = _compiled().fixed_program
    expected = _decision(fixed, fixed.limits, latch)
    in_c.reset()
    in_c.found.latch = latch
    told = set()
    for values in _course(fixed, seed, 25_000):
        words = expected.words(expected.update(values))
        assert in_c.update(in_c.tuned(), values) == words
        told.add((words[0], words[1]))
    assert {alarm for alarm, _ in told} == {False, True} and len(told) > 2


@pytest.mark.parametrize("seed", range(6))
def test_nothing_overflows_whatever_limits_and_residuals_are(in_c: DiagnoseInC, seed: int) -> None:
    """All at their ends and at limits: the sanitizer sees it, and the asserts of `Decision`."""
    fixed, draw = _compiled().fixed_program, random.Random(seed)
    ends = (-WORD, 1 - WORD, -1, 0, 1, WORD - 1)
    sizes = (0, 1, 16, 96, WORD, 2 * WORD - 1)
    factors, shifts = (0, 1, 2**29 + 1, 2**30), (0, 1, 30, 62)
    heights = (0, 2**18, 2**29 + 7, 2**30 - 1, 2**30, WORD - 9, WORD - 1)
    parts = (ends, sizes, sizes, factors, factors, (0, 2**17, WORD - 1), heights, shifts, shifts)
    for _ in range(60):
        limits = tuple(WholeLimit(*map(draw.choice, parts)) for _ in range(2))
        expected = _decision(fixed, limits, False)
        in_c.reset()
        in_c.found.row = expected.row = 3
        in_c.found.least = expected.least = draw.randint(1, 3)
        in_c.found.hold = expected.hold = 8
        given = in_c.limits(limits)
        places = [[*ends, *_edges(own)] for own in limits]
        for _ in range(60):
            values = [None if draw.random() < 0.1 else draw.choice(own) for own in places]
            assert in_c.update(given, values) == expected.words(expected.update(values))


def _edges(limit: WholeLimit) -> list[int]:
    """Residuals that come to a limit, or to a whole octave of peaks, and those beside them."""
    sure = limit.level + 2 * limit.bound
    out = [limit.level, limit.level // 2, *(limit.level + sure * 2**n // 16 for n in range(8))]
    far = [limit.bound + x + more for x in out for more in (-1, 0, 1)]
    own = [limit.mean + sign * x for x in far for sign in (-1, 1)]
    return [x for x in own if -WORD <= x < WORD]


# ---------------------------------------------------------------------------- beside double


@pytest.mark.parametrize("seed", [11, 12, 13])
def test_double_decides_the_same_of_the_same_residuals(double: ModuleType, seed: int) -> None:
    """All samples of these courses: none is within the rounding of a limit."""
    fixed = _compiled().fixed_program
    whole, real = _decision(fixed, fixed.limits, False), double.Diagnosis()
    assert (real.row, real.least, real.hold) == (whole.row, whole.least, whole.hold)
    assert real.window == whole.window
    assert [c.faults for c in whole.classes] == list(double.CLASSES)
    bits = {n: own.bits for n, own in fixed.residuals.items()}
    alarms = 0
    for values in _course(fixed, seed, 25_000):
        own = dict(zip(bits, values, strict=True))
        numbers = {n: math.ldexp(v or 0, -bits[n]) for n, v in own.items()}
        known = frozenset(n for n, v in own.items() if v is not None)
        said = real.update(double.Residuals(**numbers, valid=known))
        assert whole.update(values) == said
        assert whole.state == real.state and whole.candidate == real.candidate
        assert whole.one == (-1 if real.fault_class is None else real.fault_class)
        alarms += said
        sums = [math.ldexp(x, -SUM_BITS) for own in whole.sums for x in own]
        assert sums == pytest.approx([x for own in real._sums for x in own], abs=1e-3)
    assert alarms > 1000


def test_a_healthy_log_gives_no_alarm_and_a_stuck_sensor_its_class(tmp_path: Path) -> None:
    """The whole way: a tuning of a log, C in whole numbers, samples as whole numbers."""
    c = bondgraph.compile(_MODEL)
    engine = c.engine()
    log = c.simulate(errand(20.0, 1)).log
    samples = [np.column_stack([log.columns[k.path] for k in engine.signals])]
    tuning = tune(engine, c.diagnosis_model, samples, c.program.digest, 1.0, 2.0).tuning
    whole = _whole(tuning)
    whole.write(tmp_path)
    fixed = whole.fixed_program
    step, found = StepInC(fixed, tmp_path, "motor"), DiagnoseInC(tmp_path, "motor", 2, 3)
    stuck = Fault("current", "stuck", math.nan, at=10.0)
    for faults, named in (((), set()), ((stuck,), {("k", "current", "speed")})):
        log = c.simulate(errand(20.0, 9, *faults)).log
        step.reset()
        found.reset()
        alarms, ones = [], set()
        for k in range(log.rows):
            row = {n: round(math.ldexp(float(log.columns[n][k]), own.bits))
                   for n, own in fixed.samples.items()}  # fmt: skip
            values = [v if ok else None for v, ok in step.step(row).values()]
            alarm, one, *_ = found.update(found.tuned(), values)
            alarms.append(alarm)
            ones.add(one)
        classes = fault_classes(fixed.program, whole._tuned)
        assert {classes[one].faults for one in ones - {-1}} == named
        assert any(alarms) == bool(faults) and not any(alarms[:10_000])
        assert (ALARM in found.found.state) == bool(faults)


# ------------------------------------------------------------------------ limits


@pytest.mark.parametrize("bits", [-3, 0, 11, 25, 37, 55])
@pytest.mark.parametrize("sigma", [0.4, 3.0, 2e4])
def test_factors_are_right_to_the_last_of_their_bits(sigma: float, bits: int) -> None:
    """What a row adds that is x off, by hand; 30 bits, or what 2^62 leaves."""
    own = math.ldexp(sigma, 9 - bits)  # the deviation, of some hundred of the smallest numbers
    limit = ResidualLimit(0.0, 5.0 * own, 1.0 / own, 0.3 / own**2, 0.5, 9.0, 0.0)
    whole = whole_limit(limit, bits)
    for x in (1, 777, 1 << 20):
        real = math.ldexp(x, -bits)
        added = math.ldexp(x * whole.unit, -whole.unit_shift - SUM_BITS)
        assert added == pytest.approx(real / own, rel=2e-9)
        root = math.ldexp(x * whole.loud, -whole.loud_shift - 24)
        assert root**2 == pytest.approx(0.3 * (real / own) ** 2, rel=4e-9)


def test_what_nothing_exceeds_nothing_exceeds() -> None:
    never = whole_limit(ResidualLimit(0.0, 1e30, 0.0, 0.0, 0.5, 1e30, 0.0), 20)
    assert (never.level, never.height) == (2 * WORD - 1, WORD - 1)
    off = 2 * WORD - 1  # the farthest that two numbers of 32 bits are apart
    assert not off > never.level


def _refused(**changes: float) -> list[tuple[str, str, str]]:
    with pytest.raises(CompileError) as caught:
        _ = _whole(_tuning(**changes)).fixed_program
    found = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert {d.code for d in found} == {"no-fixed-point"}
    return [(d.message, d.labels[0].span.source.path, d.help) for d in found]


def test_limits_that_whole_numbers_cannot_keep_are_refused() -> None:
    """Of each residual: the place, the cause, what to do."""
    for changes, cause, remedy in (
        ({"kappa": 1e-4}, "is right to .* its level in the tuning is", "Narrower ranges"),
        ({"mean": 1e3}, "stands at 1e\\+03 .* at most", "have to hold the log"),
        ({"height": HIGHEST + 1.0}, "sums up to", "as loud all the time"),
    ):
        told = _refused(**changes)
        assert [message.split()[2] for message, _, _ in told] == ["`r1`", "`r2`"]
        for message, path, help in told:
            assert re.search(cause, message) and path.endswith("dc_motor.bg")
            assert remedy in help and "--real fixed" in help


def test_a_level_is_refused_where_it_is_sixteen_times_what_is_rounded() -> None:
    rough = {n: own.fixed for n, own in _compiled().fixed_program.residuals.items()}
    least = max(rough[n] / ROUGH / sigma for n, sigma in _SIGMA.items())
    assert _whole(_tuning(kappa=1.01 * least)).fixed_program.limits
    assert len(_refused(kappa=0.99 * least)) == 1


def test_the_command_takes_a_tuning(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = tmp_path / "tuning.json", tmp_path / "out"
    path.write_text(_tuning().to_json())
    ranges = [w for n, (a, b) in RANGES["dc_motor"].items() for w in ("--range", f"{n}={a}..{b}")]
    common = ["compile", _MODEL, "--tuning", str(path), *ranges, "-o", str(out)]
    assert main([*common, "--real", "fixed", "--with", "misra"]) == 0
    text = (out / "motor.c").read_text()
    rows = re.findall(r"^    \{(.*)\},$", text.partition("motor_limits[")[2], re.MULTILINE)[:2]
    limits = [WholeLimit(*(int(x.rstrip("u")) for x in row.split(","))) for row in rows]
    assert limits == list(_compiled().fixed_program.limits)
    assert (out / "MISRA.md").exists()
    capsys.readouterr()


def test_a_residual_that_has_no_value_has_no_limit() -> None:
    """And no tuning, no limits."""
    tuning = _tuning()
    one = tuning._replace(limits={"r1": tuning.limits["r1"]})
    limits: Any = _whole(one).fixed_program.limits
    assert limits[0].level < 2 * WORD - 1 == limits[1].level
    c = bondgraph.compile(_MODEL, real="fixed", ranges=RANGES["dc_motor"], targets=["c"])
    text = {a.path: a.text for a in c.artifacts}["motor.h"]
    assert "motor_diagnose(" in text and "motor_limits[" not in text


# ------------------------------------------------------------------------ on other machines

_BOARD = """
#include "motor.h"

extern uint32_t instructions(void);
extern void print(uint32_t number);
extern void finish(void);

static motor_diagnosis found;
static motor_residuals residuals;
static uint32_t seed = 1u, sum = 2166136261u;

static uint32_t draw(void)
{
    seed = seed * 1664525u + 1013904223u;
    return seed >> 8;
}

static void add(uint32_t word)
{
    sum = (sum ^ word) * 16777619u;
}

/* Quiet or loud for a while, each by itself, and a word now and then. */
int main(void)
{
    int at, k, size[MOTOR_RESIDUALS] = {0};
    uint32_t alarms = 0u;
    bool alarm;

    motor_diagnosis_reset(&found);
    found.hold = 300u;
    for (at = 0; at < 20000; ++at) {
        for (k = 0; k < MOTOR_RESIDUALS; ++k) {
            if (draw() % 1500u == 0u) size[k] = draw() % 3u != 0u ? 0 : (int)(draw() % 24u);
            residuals.value[k] = ((int32_t)(draw() & 0xFFFFu) - 32768) * (1 << size[k] / 2);
            residuals.value[k] += draw() % 7u == 0u ? (1 << size[k]) * 64 : 0;
            residuals.valid[k] = draw() % 900u != 0u;
        }
        alarm = motor_diagnose(&found, motor_limits, &residuals);
        alarms += alarm ? 1u : 0u;
        add((uint32_t)found.fault_class);
        for (k = 0; k < MOTOR_RESIDUALS; ++k) {
            add(found.state[k]); add(found.since[k]); add(found.peak[k]);
            add((uint32_t)found.above[k]); add((uint32_t)found.below[k]);
            add((uint32_t)found.louder[k]);
        }
        for (k = 0; k < MOTOR_CLASSES; ++k) add(found.candidate[k]);
        if (at % 1000 == 999) print(sum);
    }
    print(alarms);
    finish();
    return 0;
}
"""


def _told(folder: Path, core: Core) -> list[str]:
    """What the program prints on a core."""
    files = ("board_main.c", "board.c", "motor.c")
    flags = ("-std=gnu99", "-O2", *core.flags, "-I.", *core.link)
    run(core.compiler, *flags, *files, "-lc", "-lgcc", "-o", core.name, cwd=folder)
    if core.machine == ("valgrind",):
        return run(folder / core.name).split()
    host = ("-semihosting-config", "enable=on,target=native", "-kernel", core.name)
    quiet = ("-display", "none", "-monitor", "none", "-serial", "none")
    return run("sh", "-c", '"$@" 2>&1', "sh", *core.machine, *quiet, *host, cwd=folder).split()


def test_a_cortex_m_and_a_risc_v_decide_as_this_computer_does(folder: Path) -> None:
    """Of 20 000 samples all that diagnose says and remembers, as a checksum every 1000."""
    here = [core for core in CORES if not missing(core)]
    if len(here) < len(CORES):
        pytest.skip("needs qemu and gcc for Cortex-M and RISC-V")
    (folder / "board_main.c").write_text(_BOARD)
    (folder / "link.ld").write_text(fill("c/qemu/link.ld.j2", {}))
    for name in ("board.c", "riscv.ld"):
        shutil.copy(codegen() / "c" / "costs" / name, folder)
    told = {core.name: _told(folder, core) for core in here}
    (one,) = {tuple(words) for words in told.values()}
    assert len(set(one)) == 21 and 1000 < int(one[-1]) < 19_000
