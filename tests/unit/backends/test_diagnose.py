"""`diagnose` of the generated code: what it decides, in C and in Python, and beside the monitor."""

from __future__ import annotations

import math
import sys
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import bondgraph
from bondgraph import Fault
from bondgraph.backends.decision import ANY, NO_SIZE, fault_classes
from bondgraph.backends.write import write
from bondgraph.compilation import Compilation
from bondgraph.ir.residual_limit import ResidualLimit, ShownSize
from bondgraph.runtime.diagnosis.calibration import tune
from bondgraph.runtime.diagnosis.cusum import on_board
from bondgraph.runtime.diagnosis.tuning import Limit, Tuning
from bondgraph.runtime.log_file import write_log
from tests.unit.backends.compilers import WARNINGS, compiler, python_module, run
from tests.unit.backends.motor_errand import errand

_MODEL = "models/dc_motor.bg"

# what the residuals of the motor see, read off its equations: r1 is the armature, r2 the rotor
_MOTOR = {
    ("L", "R", "U"): (True, False),
    ("k", "current", "speed"): (True, True),
    ("J", "f", "load"): (False, True),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("motor")
    write(bondgraph.compile(_MODEL).artifacts, found)
    return found


@pytest.fixture(scope="module")
def motor(folder: Path) -> ModuleType:
    return python_module(folder, "motor")


def _found(motor: ModuleType, *limits: ResidualLimit, latch: bool = False) -> Any:
    return motor.Diagnosis([motor.Limit(*limit) for limit in limits], latch=latch)


def _residuals(motor: ModuleType, *values: float | None) -> Any:
    names = motor.RESIDUALS
    known = frozenset(n for n, v in zip(names, values, strict=True) if v is not None)
    numbers = {n: v or 0.0 for n, v in zip(names, values, strict=True)}
    return motor.Residuals(**numbers, valid=known)


_LEVEL = ResidualLimit(0.0, 1.0, 0.0, 0.0, 0.5, 1e30, 0.0)  # of samples alone


def test_classes_are_the_rows_of_the_signature_matrix(motor: ModuleType) -> None:
    rows = [tuple(k in seen for k in range(2)) for seen in motor._SEEN_BY]
    assert dict(zip(motor.CLASSES, rows, strict=True)) == _MOTOR
    for table, code in ((motor._LEAST_SIZES, 1), (motor._SURE_SIZES, ANY)):  # of any size
        assert [len(own) for own in table] == [len(own) for own in motor._SEEN_BY]
        assert {size for own in table for size in own} == {code}


def test_a_switched_machine_exonerates_nobody() -> None:
    classes = fault_classes(bondgraph.compile("models/oven.bg").program)
    assert classes and all(set(c.sure) == {NO_SIZE} for c in classes)
    assert all(c.seen_by and all(c.least) for c in classes)


def test_an_alarm_takes_samples_in_a_row_and_ends_with_hysteresis(motor: ModuleType) -> None:
    found = _found(motor, _LEVEL, _LEVEL)
    least, hold = found.least, found.hold
    for _ in range(least - 1):
        assert not found.update(_residuals(motor, 1.1, 0.0))
    assert not found.update(_residuals(motor, 0.9, 0.0)), "the row is broken"
    said = [found.update(_residuals(motor, -1.1, 0.0)) for _ in range(least)]
    assert said == [False] * (least - 1) + [True]
    assert found.state == [motor.ALARM, motor.HEALTHY]
    for _ in range(3 * hold):
        assert found.update(_residuals(motor, 0.6, 0.0)), "nearer than the level, not quiet"
    said = [found.update(_residuals(motor, 0.4, 0.0)) for _ in range(hold)]
    assert said == [True] * (hold - 1) + [False]
    assert found.state == [motor.HEALTHY, motor.HEALTHY]


def test_an_alarm_that_is_latched_stays_until_it_is_cleared(motor: ModuleType) -> None:
    found = _found(motor, _LEVEL, _LEVEL, latch=True)
    for _ in range(found.least):
        found.update(_residuals(motor, 2.0, 0.0))
    assert all(found.update(_residuals(motor, 0.0, 0.0)) for _ in range(3 * found.hold))
    found.clear()
    assert not found.update(_residuals(motor, 0.0, 0.0))


def _candidates(motor: ModuleType, first: float | None, second: float | None) -> dict[Any, int]:
    found = _found(motor, _LEVEL, _LEVEL)
    for _ in range(4 * found.row):
        found.update(_residuals(motor, first, second))
    kinds = dict(zip(motor.CLASSES, found.candidate, strict=True))
    one = found.fault_class
    return kinds | {"one": None if one is None else motor.CLASSES[one]}


def test_who_is_quiet_speaks_against_a_fault_and_who_is_blind_does_not(motor: ModuleType) -> None:
    armature, both, rotor = _MOTOR
    out, small, likely = motor.RULED_OUT, motor.SMALL, motor.LIKELY
    told = {
        (2.0, 0.0): {armature: likely, both: small, rotor: out, "one": armature},
        (2.0, 2.0): {armature: out, both: likely, rotor: out, "one": both},
        (0.0, -2.0): {armature: out, both: small, rotor: likely, "one": rotor},
        (2.0, None): {armature: likely, both: likely, rotor: out, "one": None},
        (None, None): {armature: out, both: out, rotor: out, "one": None},
    }
    for values, expected in told.items():
        assert _candidates(motor, *values) == expected


@pytest.mark.parametrize(("least", "sure"), [(1.0, 4.0), (0.3, 1.0), (2.0, 40.0)])
def test_who_is_quiet_speaks_against_a_fault_only_from_the_size_on_that_it_shows(
    tmp_path: Path, least: float, sure: float
) -> None:
    """The first residual is out by x times what makes it sure to be: the fault is `least` x."""
    c = bondgraph.compile(_MODEL)
    limit = Limit(sigma=1.0, crossings=1.0, kappa=4.0, height=9.0)
    both = {f: (ShownSize(least, 1.0), ShownSize(1.0, sure)) for f in ("k", "current", "speed")}
    shows = {name: {f: pair[k] for f, pair in both.items()} for k, name in enumerate(("r1", "r2"))}
    window = 0.5  # s
    program = c.program
    tuning = Tuning(program.digest, program.rate, program.bandwidth, 1.0, 60.0,
                    {"r1": limit, "r2": limit}, {"r1": 0.5}, shows, window)  # fmt: skip
    c.tuned(tuning).write(tmp_path, targets=["python"])
    module = python_module(tmp_path, "motor")
    place = module.CLASSES.index(("k", "current", "speed"))
    turn = sure / least  # what x is where the second residual has to show it
    for factor in (0.5, 0.83, 1.2, 3.0):  # two roundings to eighths of an octave are 19 %
        found = module.Diagnosis()
        value = factor * turn * (4.0 + 2.0 * 0.5) + 4.0 + 0.5  # beyond bound and noise
        told = []
        for _ in range(round(1.2 * window * program.rate) + found.row):
            found.update(_residuals(module, value, 0.0))
            told.append(found.candidate[place])
        quiet = module.SMALL if factor > 1.0 else module.LIKELY
        assert told[-1] == quiet
        assert set(told[: round(window * program.rate)]) == {module.RULED_OUT, module.LIKELY}
        assert found.candidate[module.CLASSES.index(("L", "R", "U"))] == module.LIKELY
        assert (found.fault_class is None) == (quiet == module.LIKELY)


def test_a_class_waits_for_residuals_that_come_later(motor: ModuleType) -> None:
    found = _found(motor, _LEVEL, _LEVEL)
    for _ in range(found.row):
        found.update(_residuals(motor, 2.0, 0.0))
    assert found.fault_class is None
    for _ in range(4 * found.row):
        found.update(_residuals(motor, 2.0, 2.0))
    assert motor.CLASSES[found.fault_class] == ("k", "current", "speed")


@pytest.mark.parametrize(("shift", "loud"), [(1.5, 0.0), (-1.5, 0.0), (0.0, 3.0)])
def test_sums_see_in_rows_what_no_sample_shows(
    motor: ModuleType, shift: float, loud: float
) -> None:
    """By hand: a mean of 1.5 deviations adds 1.0 a row; noise +-3 the logarithm of likelihoods."""
    height = 9.5
    limit = on_board(Limit(sigma=0.1, crossings=1.0, kappa=50.0, height=height))
    found = _found(motor, limit, limit)
    if loud:
        # of N(0, 4) to N(0, 1), at most a third of the height a row
        gain = min(0.5 * (loud**2 * 0.75 - math.log(4.0)), (height + 1.166) / 3.0)
        rows = math.floor((height + 1.166) / gain) + 1
    else:
        rows = math.floor(height / (abs(shift) - 0.5)) + 1
    for k in range(1, rows * found.row + 1):
        sign = 1.0 if (k // found.row) % 2 else -1.0
        said = found.update(_residuals(motor, 0.1 * (shift + sign * loud), 0.0))
        assert said == (k == rows * found.row)


def test_bounds_are_beside_the_level(motor: ModuleType) -> None:
    found = _found(motor, _LEVEL, _LEVEL)
    for _ in range(5 * found.least):
        assert not found.update(_residuals(motor, 3.0, -3.0), [2.1, 2.1])
    assert any(found.update(_residuals(motor, 3.2, 0.0), [2.1, 2.1]) for _ in range(found.least))


# -------------------------------------------------------------------------------- C and Python

_DRIVER = """
#include <stdio.h>
#include <string.h>
#include "motor.h"

int main(int count, char **words)
{
    motor_limit limits[MOTOR_RESIDUALS];
    motor_diagnosis found;
    motor_residuals r;
    double value[2], bound[2], number[7];
    motor_real bounds[MOTOR_RESIDUALS];
    int valid[2], latch, k;

    if (count != 2 || freopen(words[1], "r", stdin) == NULL) return 1;
    if (scanf("%d", &latch) != 1) return 1;
    for (k = 0; k < MOTOR_RESIDUALS; ++k) {
        int j;
        for (j = 0; j < 7; ++j) {
            if (scanf("%la", &number[j]) != 1) return 1;
        }
        limits[k].mean = number[0]; limits[k].level = number[1]; limits[k].unit = number[2];
        limits[k].loud = number[3]; limits[k].drift = number[4]; limits[k].height = number[5];
        limits[k].bound = number[6];
    }
    memset(&found, 0xAA, sizeof found);
    motor_diagnosis_reset(&found);
    found.latch = latch != 0;
    while (scanf("%la %la %d %d %la %la", &value[0], &value[1], &valid[0], &valid[1], &bound[0],
            &bound[1]) == 6) {
        bool alarm;
        for (k = 0; k < MOTOR_RESIDUALS; ++k) {
            r.value[k] = value[k]; r.valid[k] = valid[k] != 0; bounds[k] = bound[k];
        }
        alarm = motor_diagnose(&found, limits, bounds, &r);
        printf("%d %d", alarm, found.fault_class);
        for (k = 0; k < MOTOR_RESIDUALS; ++k) {
            printf(" %d %u %a %a %a %a", found.state[k], (unsigned)found.since[k], found.above[k],
                found.below[k], found.louder[k], found.peak[k]);
        }
        for (k = 0; k < MOTOR_CLASSES; ++k) printf(" %d", found.candidate[k]);
        printf("\\n");
    }
    return 0;
}
"""


def _course(seed: int, rows: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Residuals that are well, off, far out, loud, without a value; bounds that move."""
    draw = np.random.default_rng(seed)
    value = draw.normal(size=(rows, 2))
    valid = np.ones((rows, 2), dtype=bool)
    for _ in range(12):
        a = int(draw.integers(rows))
        part = slice(a, a + int(draw.integers(20, 4000)))
        k = int(draw.integers(2))
        match int(draw.integers(4)):
            case 0:
                value[part, k] += draw.choice([-12.0, 12.0])
            case 1:
                value[part, k] += draw.choice([-1.2, 1.2])
            case 2:
                value[part, k] *= 4.0
            case _:
                valid[part, k] = False
    return value, valid, np.abs(0.3 * np.cumsum(draw.normal(size=(rows, 2)), axis=0) / 100.0)


def _in_python(motor: ModuleType, found: Any, course: tuple[np.ndarray, ...]) -> list[str]:
    lines = []
    for value, valid, bound in zip(*course, strict=True):
        given = [float(x) if ok else None for x, ok in zip(value, valid, strict=True)]
        alarm = found.update(_residuals(motor, *given), bound.tolist())
        one = -1 if found.fault_class is None else found.fault_class
        words = [int(alarm), one]
        for k, sums in enumerate(found._sums):
            words += [found.state[k], found.since[k], *sums, found._peak[k]]
        lines.append(" ".join(map(_exact, [*words, *found.candidate])))
    return lines


def _exact(word: float) -> str:
    return word.hex() if isinstance(word, float) else str(word)


@pytest.mark.parametrize(("seed", "latch"), [(1, False), (2, False), (3, True)])
def test_c_decides_as_python_does_digit_for_digit(
    motor: ModuleType, folder: Path, tmp_path: Path, seed: int, latch: bool
) -> None:
    (tmp_path / "driver.c").write_text(_DRIVER)
    program = str(tmp_path / "driver")
    sources = (str(tmp_path / "driver.c"), str(folder / "motor.c"))
    run(*compiler("gcc"), *WARNINGS, "-Wno-conversion", "-Wno-float-conversion", "-I", str(folder),
        "-O2", "-ffp-contract=off", *sources, "-o", program, cwd=tmp_path)  # fmt: skip
    limits = [
        on_board(Limit(sigma=1.0, crossings=1.0, kappa=4.5, height=9.0, mean=m, memory=1.7))
        for m in (0.0, 0.1)
    ]
    course = _course(seed, 20_000)
    lines = [str(int(latch)), *[" ".join(map(float.hex, one)) for one in limits]]
    for value, valid, bound in zip(*course, strict=True):
        numbers = [*map(float.hex, map(float, value)), *(str(int(v)) for v in valid)]
        lines.append(" ".join([*numbers, *map(float.hex, map(float, bound))]))
    (tmp_path / "in.txt").write_text("\n".join(lines) + "\n")
    told = run(program, "in.txt", cwd=tmp_path).splitlines()
    mine = _in_python(motor, _found(motor, *limits, latch=latch), course)
    assert len(told) == len(mine) and {line[0] for line in mine} == {"0", "1"}
    for c, python in zip(told, mine, strict=True):
        own = [float.fromhex(x) if "x" in x else int(x) for x in c.split()]
        other = [float.fromhex(x) if "x" in x else int(x) for x in python.split()]
        assert own == other


# ---------------------------------------------------------------------------- with a tuning


@cache
def _compiled() -> Compilation:
    return bondgraph.compile(_MODEL)


@cache
def _tuning() -> Tuning:
    c = _compiled()
    engine = c.engine()
    logs = [c.simulate(errand(40.0, seed)).log for seed in (1, 2)]
    samples = [np.column_stack([log.columns[k.path] for k in engine.signals]) for log in logs]
    return tune(engine, c.diagnosis_model, samples, c.program.digest, 1.0, 2.0).tuning


@pytest.fixture(scope="module")
def tuned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("tuned")
    _compiled().tuned(_tuning()).write(found, extras=["example"])
    return found


def test_a_healthy_log_gives_no_alarm_and_a_stuck_sensor_its_class(tuned: Path) -> None:
    stuck = Fault("current", "stuck", math.nan, at=20.0)
    for name, faults in (("healthy", ()), ("stuck", (stuck,))):
        write_log(_compiled().simulate(errand(40.0, 9, *faults)).log, tuned / f"{name}.csv")
    files = ("example/example.c", "motor.c", "-lm")
    run(*compiler("gcc"), "-O2", "-I.", *files, "-o", "watch", cwd=tuned)
    for command in (("./watch",), (sys.executable, "example/example.py")):
        assert run(*command, "healthy.csv", cwd=tuned).endswith(", 0 alarms\n")
        *_, last, count = run(*command, "stuck.csv", cwd=tuned).splitlines()
        assert last.endswith("r1, r2 in alarm; one of k, current, speed")
        assert count.endswith(", 1 alarms")


@pytest.mark.parametrize(
    ("of", "change", "value", "own", "large", "named"),
    [
        ("R", "*=", 1.4, "L", True, False),  # or a current that is off, as far as levels tell
        ("f", "*=", 2.0, "J", True, False),
        ("current", "+=", 0.1, "k", True, True),
        ("R", "*=", 1.03, "L", False, False),  # the monitor learns this machine, code does not
        ("f", "*=", 1.0, "J", False, False),
    ],
)
def test_alarms_are_those_of_the_monitor(
    tuned: Path, of: str, change: Any, value: float, own: str, large: bool, named: bool
) -> None:
    c, tuning = _compiled(), _tuning()
    log = c.simulate(errand(40.0, 11, Fault(of, change, value, at=20.0))).log
    engine = c.engine().configured(bandwidth=tuning.bandwidth)
    samples = np.column_stack([log.columns[k.path] for k in engine.signals])
    batch = engine.run(samples)
    said = c.diagnosis(engine.configured(), tuning).update(log.time, batch, samples)
    alarms = [v for v in said if v.event == "fault"]
    module = python_module(tuned, "motor")
    monitor, found = module.Monitor(), module.Diagnosis()
    fired = []
    for k in range(log.rows):
        one = module.Samples(**{n: float(column[k]) for n, column in log.columns.items()})
        fired.append(found.update(monitor.step(one), batch.bound[k].tolist()))
    assert any(fired) == large and not any(fired[:20_000])
    if not large:
        return
    assert abs(fired.index(True) - 1000.0 * alarms[0].time) <= 2 * found.row
    out = {n for n, s in zip(module.RESIDUALS, found.state, strict=True) if s == module.ALARM}
    assert set(alarms[0].residuals) <= out
    true = next(k for k, faults in enumerate(module.CLASSES) if own in faults)
    assert found.candidate[true] == module.LIKELY
    assert found.fault_class == (true if named else None)


def test_a_tuning_of_another_model_is_refused() -> None:
    with pytest.raises(ValueError, match="of another model"):
        bondgraph.compile("models/two_tanks.bg").tuned(_tuning())
