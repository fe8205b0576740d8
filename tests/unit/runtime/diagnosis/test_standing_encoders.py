"""Encoders that stick, against shafts whose motion is written down."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.standing_encoders import StandingEncoders
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.verdict import Verdict
from tests.simulation.machines import opened, read

_ROW = 150
_BOTH = ("motor", "wheel")


def turns(angle: Array, counts: float = 500.0, ratio: float = 7.3) -> Array:
    """The counts of both ends of a gear, and a signal that is none."""
    return np.column_stack([
        np.floor(angle * ratio * counts / (2 * math.pi)),
        np.zeros(len(angle)),
        np.floor(angle * counts / (2 * math.pi)),
    ])  # fmt: skip


def known(angle: Array, **of: float) -> tuple[StandingEncoders, Array]:
    """What has watched the first half of a motion, and the samples of the second."""
    encoders, samples = StandingEncoders({"motor": 0, "wheel": 2}), turns(angle, **of)
    half = len(samples) // 2 // _ROW * _ROW
    for begin in range(0, half, _ROW):
        assert not encoders.row(samples[begin : begin + _ROW], True, _BOTH)
    return encoders, samples[half:]


def seen(encoders: StandingEncoders, samples: Array) -> list[dict[str, tuple[int, str]]]:
    """Row by row what stands still of what is suspect."""
    whole = range(0, len(samples) // _ROW * _ROW, _ROW)
    return [
        {n: tuple(s) for n, s in encoders.row(samples[k : k + _ROW], False, _BOTH).items()}
        for k in whole
    ]


def swing(count: int = 12_000, speed: float = 20.0) -> Array:
    """An angle (rad) at 1 kHz that goes forth and back."""
    return np.asarray(speed / 3.0 * np.sin(3.0 * np.arange(count) / 1000.0))


@pytest.mark.parametrize("column", [0, 2])
def test_one_that_sticks_is_told_in_the_row_in_which_the_other_has_gone_on(column: int) -> None:
    name, other = _BOTH if column == 0 else _BOTH[::-1]
    encoders, samples = known(swing())
    samples[1000:, column] = samples[1000, column]
    found = seen(encoders, samples)
    first = 1000 // _ROW
    begun = int(np.flatnonzero(np.diff(samples[:, column]))[-1]) + 1
    assert not any(found[:first])
    assert found[first] == {name: ((first + 1) * _ROW - 1 - begun, other)}
    assert found[-1] == {name: (len(found) * _ROW - 1 - begun, other)}


def test_rows_before_an_alarm_are_not_taken_for_healthy_ones() -> None:
    encoders, samples = known(swing())
    samples[:, 0] = samples[0, 0]
    late = 3 * _ROW
    for begin in range(0, late, _ROW):
        assert not encoders.row(samples[begin : begin + _ROW], True, ())
    assert seen(encoders, samples[late:])[0].keys() == {"motor"}


def test_a_machine_at_rest_has_no_encoder_that_sticks() -> None:
    encoders, samples = known(swing())
    samples[1000:] = samples[1000]
    assert not any(seen(encoders, samples))


def test_one_that_counts_alone_while_the_machine_is_at_rest_does_not_make_the_other_stick() -> None:
    encoders, samples = known(swing())
    samples[1000:] = samples[1000]
    samples[2000:, 0] += np.arange(len(samples) - 2000) // 3
    assert not any(seen(encoders, samples))


def test_few_counts_a_turn_are_not_taken_for_standing_still() -> None:
    """A wheel of 12 counts a turn rests for long between two, while the motor counts thousands."""
    slow = np.concatenate([swing(), swing()[-1] + 0.2 * np.arange(12_000) / 1000.0])
    encoders, samples = known(slow, counts=12.0, ratio=300.0)
    assert np.diff(np.flatnonzero(np.diff(samples[:, 2]))).max() > 1000
    assert not any(seen(encoders, samples))


def test_what_is_no_suspect_or_has_never_moved_is_not_told() -> None:
    encoders, samples = known(swing())
    samples[1000:, 0] = samples[1000, 0]
    assert not encoders.row(samples, False, ["wheel"])
    fresh = StandingEncoders({"motor": 0, "wheel": 2})
    assert not fresh.row(samples[1000:], False, _BOTH)


def test_samples_that_are_missing_and_gaps_begin_anew() -> None:
    encoders, samples = known(swing())
    samples[1000:, 0] = samples[1000, 0]
    samples[1010:, 0] = math.nan
    assert not any(seen(encoders, samples))
    encoders, samples = known(swing())
    encoders.restart()
    samples[:, 0] = 17.0  # for how long before the gap, nobody knows
    assert seen(encoders, samples)[0] == {"motor": (_ROW - 1, "wheel")}


def test_a_state_has_what_is_known() -> None:
    encoders, samples = known(swing())
    other = StandingEncoders({"motor": 0, "wheel": 2})
    other.resume(encoders.state())
    samples[1000:, 2] = samples[1000, 2]
    assert seen(other, samples)[-1].keys() == {"wheel"}


DRIVE = """
    input U : V
    param Ra = 2 Ohm
    param k = 0.1 N.m/A
    param J = 1e-3 kg.m^2
    param N = 5
    param K = 40 N.m/rad
    param D = 0.2 N.m.s/rad
    param Jl = 0.02 kg.m^2
    param f = 0.05 N.m.s/rad
    1:a { <- Se:U; -> R:Ra; -> GY:k -> 1:m; -> Df:i }
    m { -> I:J; -> TF:gear { f1 = N*f2 } -> 0:t }
    t { -> 1:s { -> C:spring = 1/K; -> R:D }; -> 1:load }
    load { -> I:Jl; -> R:f }
    sensor motor : rad = int(m.f) counts 2000/turn
    sensor wheel : rad = int(load.f) counts 2000/turn
"""


def watched(machine: Compilation, fault: str) -> list[Verdict]:
    """What is said of 20 s, in which something becomes wrong after 12."""
    drive = 'duration = 20\ninputs.U = "8*sin(2*t) + 4*sin(0.7*t)"\n[sensors.i]\nnoise = 5e-3\n'
    run = machine.simulate(read(machine, drive + fault)).log
    engine = machine.engine()
    samples = np.column_stack([run.columns[k.path] for k in engine.signals])
    return machine.diagnosis(engine).update(run.time, engine.run(samples), samples)


@pytest.mark.parametrize("name", _BOTH)
def test_an_encoder_of_a_drive_that_sticks_is_named_and_nothing_else(name: str) -> None:
    said = watched(
        opened(DRIVE), f"[[fault]]\nof = '{name}'\nchange = 'stuck'\nat = 12\nuntil = 16"
    )
    named = [v for v in said if v.group]
    other = _BOTH[1 - _BOTH.index(name)]
    assert {v.group for v in named} == {(name,)}
    assert named[0].time < 12.5
    assert f"{name} stands still while {other} goes on" in named[0].message


def test_a_drive_that_is_held_has_no_encoder_that_sticks() -> None:
    said = watched(
        opened(DRIVE), "[[fault]]\nof = 'f'\nchange = '*= 1000'\nat = 12"
    )
    assert [v for v in said if v.event == "fault"]
    assert not [v for v in said if "stands still" in v.message]
