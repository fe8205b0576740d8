"""Residuals where switches turn, on exact samples: silent while healthy, awake to every fault."""

from __future__ import annotations

import math
from functools import cache
from math import factorial

import numpy as np
import numpy.typing as npt
import pytest
from scipy.stats import gamma

from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.doubt import Doubt
from bondgraph.runtime.monitoring.engine import Batch
from bondgraph.text.source import Source
from tests.switched.plants import BOOST, BUCK, CAPACITORS, CARRIAGE, COIL, Log, log

_RATE = 1000.0
_TOLERATED = 1e-6  # of the sum of the terms, for a healthy residual
_SEEN = 1e-3  # of the same, for a faulty one
_PLANTS = {"boost": BOOST, "capacitors": CAPACITORS, "coil": COIL, "carriage": CARRIAGE}
#: Ten time constants of the filter, and no whole number of samples.
_LASTS = 10 / 20.0 + 0.00037

Signals = dict[str, npt.NDArray[np.float64]]


@cache
def _compiled(name: str) -> Compilation:
    return Compilation(Source(f"{name}.bg", _PLANTS[name].text))


def _run(name: str, signals: Signals, native: bool) -> Batch:
    engine = _compiled(name).engine(native=native)
    return engine.run(np.column_stack([signals[k.path] for k in engine.signals]))


@cache
def _healthy(name: str, lasts: float = _LASTS) -> Log:
    return log(_PLANTS[name], lasts, _RATE)


def _worst(batch: Batch, found: Log, k: int, residual: str) -> float:
    """The largest valid residual; where all its terms are zero it has to be zero itself."""
    valid, size = batch.valid[:, k], found.sizes[residual]
    value = np.abs(batch.value[:, k])
    floor = 1e-9 * size.max()  # what is left when a coil has no current
    return float((value / np.maximum(size, floor))[valid].max())


@pytest.mark.parametrize("lasts", [_LASTS, 0.5], ids=["between samples", "at a sample"])
@pytest.mark.parametrize("name", _PLANTS)
def test_healthy_residuals_stay_silent_and_are_seldom_invalid(name: str, lasts: float) -> None:
    """Modes of ten time constants: below 1e-6 of the terms, and valid in 70 % of the samples."""
    found = _healthy(name, lasts)
    batch = _run(name, found.signals, native=True)
    for k, residual in enumerate(_compiled(name).program.residuals):
        assert _worst(batch, found, k, residual.name) < _TOLERATED
        assert batch.valid[:, k].mean() >= 0.7


@pytest.mark.parametrize("name", _PLANTS)
def test_a_mode_may_be_logged_a_sample_early(name: str) -> None:
    found = _healthy(name)
    signals = dict(found.signals)
    for mode in _PLANTS[name].modes:
        signals[mode] = np.append(signals[mode][1:], signals[mode][-1])
    batch = _run(name, signals, native=True)
    for k, residual in enumerate(_compiled(name).program.residuals):
        assert _worst(batch, found, k, residual.name) < _TOLERATED


@pytest.mark.parametrize("name", _PLANTS)
def test_c_and_python_agree(name: str) -> None:
    found = _healthy(name)
    signals = {s: v[:2000] for s, v in found.signals.items()}
    c, python = (_run(name, signals, native) for native in (True, False))
    assert np.array_equal(c.valid, python.valid)
    for k, residual in enumerate(_compiled(name).program.residuals):
        size = found.sizes[residual.name][:2000].max()
        assert np.abs(c.value[:, k] - python.value[:, k]).max() <= 1e-12 * size


def _faulty(name: str, fault: str) -> Log:
    plant = _PLANTS[name]
    if fault in plant.values:
        return log(plant, _LASTS, _RATE, {fault: 1.2 * plant.values[fault]})
    found = _healthy(name)
    signal = found.signals[fault]
    offset = 0.05 * np.abs(signal).max()
    return found._replace(signals={**found.signals, fault: signal + offset})


@pytest.mark.parametrize("name", _PLANTS)
def test_every_fault_of_a_mode_is_seen_in_that_mode(name: str) -> None:
    """A parameter 20 % off, a reading or an input 5 % of its largest value off."""
    compilation, plant = _compiled(name), _PLANTS[name]
    residuals = [r.name for r in compilation.program.residuals]
    tried = 0
    for fault in compilation.signatures.faults:
        found = _faulty(name, fault)
        batch = _run(name, found.signals, native=True)
        for told in compilation.mode_signatures.modes:
            if told.matrix is None:
                continue
            at = [told.modes[m] for m in plant.modes]
            there = np.array([list(m) == at for m in found.modes])
            if not there.any():
                continue
            for k, residual in enumerate(residuals):
                if not told.matrix.row(fault)[k]:
                    continue
                size = np.maximum(found.sizes[residual], 1e-9 * found.sizes[residual].max())
                rel = (np.abs(batch.value[:, k]) / size)[there & batch.valid[:, k]]
                assert rel.max() > _SEEN, f"{residual} does not see {fault} in mode {at}"
                tried += 1
    assert tried >= len(residuals)


@pytest.mark.parametrize("name", [*_PLANTS, "buck"])
def test_a_stuck_switch_shows_where_its_signature_says_so(name: str) -> None:
    """The plant moves in one mode throughout, the residuals are told another: seen, or zero."""
    plant = {**_PLANTS, "buck": BUCK}[name]
    compilation = Compilation(Source(f"{name}.bg", plant.text))
    engine = compilation.engine(native=True)
    order = [k.path for k in engine.signals]
    tried = 0
    for told in compilation.mode_signatures.modes:
        assert told.matrix is not None
        for switch in told.modes:
            true = tuple(on is not (mode == switch) for mode, on in told.modes.items())
            if true not in plant.plan:
                continue
            found = log(plant._replace(plan=(true,) * 4), _LASTS, _RATE)
            wrong = {m: np.full(len(found.modes), float(on)) for m, on in told.modes.items()}
            signals = {**found.signals, **wrong}
            engine.reset()
            batch = engine.run(np.column_stack([signals[path] for path in order]))
            size = max(s.max() for s in found.sizes.values())
            for k, residual in enumerate(engine.residuals):
                most = np.abs(batch.value[:, k])[batch.valid[:, k]].max() / size
                sees = residual in told.matrix.seen_by(switch)
                assert (most > _SEEN) if sees else (most < _TOLERATED), (told.modes, residual)
                tried += 1
    assert tried >= 4 or len(engine.residuals) == 1


@pytest.mark.parametrize("lasts", [_LASTS, 0.5], ids=["between samples", "at a sample"])
def test_behind_a_coil_only_slopes_jump_and_the_residual_goes_on(lasts: float) -> None:
    """Of a buck converter nothing jumps that is differentiated: both residuals are always valid.

    The current gains or loses 56 A/s at a switch. That puts the charge off by
    (bandwidth T)(T/tau)/8 of the terms at most, with tau the size of the terms over that change of
    slope. The voltage at the coil jumps, half a sample away from where straight lines between
    samples have it at most: two stages make no more of that pulse than bandwidth/e of its area.
    """
    compilation = Compilation(Source("buck.bg", BUCK.text))
    found = log(BUCK, lasts, _RATE)
    engine = compilation.engine(native=True)
    batch = engine.run(np.column_stack([found.signals[k.path] for k in engine.signals]))
    sees = {r.name: r.faults for r in compilation.program.residuals}
    (out,) = [k for k, name in enumerate(engine.residuals) if "C" in sees[name]]
    (coil,) = [k for k, name in enumerate(engine.residuals) if "L" in sees[name]]
    assert compilation.program.residuals[coil].stages == 2
    assert batch.valid[100:].all()
    jump = 24.0 + 4.0
    kink = jump / 0.5 * 20.0 / _RATE**2 / 8
    assert np.abs(batch.value[:, out][batch.valid[:, out]]).max() < kink
    pulse = jump * 0.5 / _RATE * 20.0 / math.e
    # the pulse before that is ten time constants old, and the trapezoid rule is right to 1e-4
    assert np.abs(batch.value[:, coil][batch.valid[:, coil]]).max() < 1.002 * pulse


_BEYOND = """bg 1
model Beyond {
    input closed : bool
    input U : V
    param R = 2 Ohm
    param L = 0.3 H
    param Rs = 5 Ohm
    param C = 0.02 F
    param Ld = 0.4 H
    param Rd = 3 Ohm
    param C2 = 0.1 F
    param G2 = 0.2 S
    input I : A
    Se:U -> 1:feed { -> R:Rs }
    feed -> 0:bus { -> C:C; -> De:v }
    bus -> 1:coil when closed { -> I:L; -> R:R; -> Df:i }
    bus -> 1:lamp { -> I:Ld; -> R:Rd; -> Df:j }
    Sf:I -> 0:apart { -> C:C2; -> R:leak = 1/G2; -> De:w; -> De:again }
}
"""


def test_what_cannot_jump_stays_valid() -> None:
    """The lamp has the voltage of a capacitor; the circuit apart does not know of the switch."""
    compilation = Compilation(Source("beyond.bg", _BEYOND))
    openings = {o.residual: o.modes for o in compilation.program.openings}
    sees = {r.name: set(r.faults) for r in compilation.program.residuals}
    lamp = next(r for r, faults in sees.items() if {"Ld", "Rd"} <= faults and "Rs" not in faults)
    apart = next(r for r, faults in sees.items() if "C2" in faults)
    twice = next(r for r, faults in sees.items() if faults == {"w", "again"})
    bus = next(r for r, faults in sees.items() if "Rs" in faults)
    coil = next(r for r, faults in sees.items() if "L" in faults)
    assert openings[lamp] == openings[apart] == ()
    assert twice not in openings  # without a derivative it holds at each sample by itself
    assert openings[bus] == openings[coil] == ("closed",)
    engine = compilation.engine(native=False)
    rows = np.zeros((600, len(engine.signals)))
    rows[:, [k.path for k in engine.signals].index("closed")] = np.arange(600) // 60 % 2
    valid = engine.run(rows).valid[500:]
    for name in (lamp, apart, twice):
        assert valid[:, engine.residuals.index(name)].all()
    for name in (bus, coil):
        assert not valid[:, engine.residuals.index(name)].any()  # 60 samples are less than 100


def test_a_start_comes_with_the_sample_of_the_change() -> None:
    """Not valid from the sample at which the mode is another one, for two time constants."""
    engine = _compiled("coil").engine(native=True)
    rows = np.zeros((1000, len(engine.signals)))
    rows[300:, [k.path for k in engine.signals].index("closed")] = 1.0
    valid = engine.run(rows).valid[:, 0]
    assert np.flatnonzero(np.diff(valid.astype(int))).tolist() == [99, 299, 399]


_PLATE = """bg 1
model Plate {
    input P : W
    input flow : m^3/s
    input Ta : K
    input Tr : K
    input fan%s
    const rc = 3.6e6 J/m^3.K^-1
    param Cm = 20 kJ/K +- 1%%
    param G = 45 W/K
    param Gm = 25 W/K
    param Gf = 60 W/K
    0:body { <- Sf:P; -> C:Cm; -> De:T; -> plate; -> air }
    1:plate { -> R:G = 1/G; -> water }
    0:water { <- Sf:in = rc*flow*Tr; -> Sf:out = rc*flow*water.e }
    1:air { -> R:fins { f = (Gm + %s)*e }; -> Se:Ta }
}
"""


@pytest.mark.parametrize(
    ("lasts", "least"), [(400.3, 0.3), (400.0, 0.49)], ids=["between samples", "at a sample"]
)
def test_a_switch_that_scales_a_conductance_does_what_a_number_does(
    lasts: float, least: float
) -> None:
    """Told `fan : bool` or 0 and 1, it is one machine, with the same residual at every sample.

    The slope of the temperature jumps with the fan, in a law: the flow times that slope. A healthy
    residual is off by half as much as it makes to turn a sample later, at most: a fan that turns at
    a sample is half a sample away from where straight lines have it.
    """
    told = [(" : bool", "if(fan, Gf, 0 W/K)"), ("", "fan*Gf")]
    made = [Compilation(Source("plate.bg", _PLATE % own)) for own in told]
    machine, twin = (one.with_options(rate=1.0, bandwidth=0.02) for one in made)
    assert machine.program.residuals[0].approximate
    assert machine.program.openings == ()
    samples = _plate([k.path for k in machine.engine(native=True).signals], lasts)
    assert [k.path for k in twin.engine(native=True).signals] == [
        k.path for k in machine.engine(native=True).signals
    ]
    batch, number = (one.engine(native=True).run(samples) for one in (machine, twin))
    assert np.array_equal(batch.valid, number.valid)
    assert batch.valid[700:].all()
    assert np.abs(batch.value - number.value).max() < 1e-9 * 2000.0  # W, as the terms are

    doubt = Doubt(machine.engine(native=True), machine.diagnosis_model)
    room, valid = doubt.run(samples, batch, 0, np.zeros(1), np.zeros(1))
    off, room = np.abs(batch.value[valid]), room[valid]
    assert least * room.max() < off.max() < 0.51 * room.max()
    assert (off < room + 0.02 * room.max()).all()  # there is no room where it changes its sign


def _plate(signals: list[str], lasts: float) -> npt.NDArray[np.float64]:
    """The plate as its fan turns so often, by the exact solution between these moments."""
    rc, mass, plate, fins, fan = 3.6e6, 20e3, 45.0, 25.0, 60.0
    inputs = {"P": 2000.0, "flow": 2e-5, "Ta": 290.0, "Tr": 305.0}
    through = 1.0 / (1.0 / plate + 1.0 / (rc * inputs["flow"]))
    level, begin, rows = 320.0, 0.0, []
    for turn in range(12):
        on = turn % 2
        lost = through + fins + on * fan
        rest = inputs["P"] + through * inputs["Tr"] + (fins + on * fan) * inputs["Ta"]
        end = begin + lasts
        for t in range(math.ceil(begin), math.ceil(end)):
            now = rest / lost + (level - rest / lost) * math.exp(-lost / mass * (t - begin))
            rows.append({**inputs, "T": now, "fan": float(on)})
        level = rest / lost + (level - rest / lost) * math.exp(-lost / mass * lasts)
        begin = end
    return np.array([[row[path] for path in signals] for row in rows])


_NARROW = """bg 1
model Narrow {
    input open : bool
    input Q
    param A = 0.5
    param kv = 0.02
    param Rp = 8
    Sf:Q -> 0:tank { -> C:volume = A; -> De:p }
    tank -> 1:pipe { -> R:Rp }
    pipe -> 0:end { -> R:valve { f = if(open, kv*ssqrt(e), 0.5*kv*ssqrt(e)) } }
}
"""


def test_an_approximation_waits_until_its_filter_has_forgotten() -> None:
    """Derivatives inside a nonlinear law are not faded in: it takes until 1e-8 is left.

    Of what is in front of laws first, then of what is behind them.
    """
    compilation = Compilation(Source("narrow.bg", _NARROW))
    (residual,) = compilation.program.residuals
    assert residual.approximate
    assert [o.modes for o in compilation.program.openings] == [("open",)]
    engine = compilation.engine(native=True)
    rows = np.ones((4000, len(engine.signals)))
    rows[2000:, [k.path for k in engine.signals].index("open")] = 0.0
    valid = engine.run(rows).valid[:, 0]
    x = residual.settle
    # the step response of n equal stages is short of 1 by so much after x time constants
    left = np.exp(-x) * sum(x**k / factorial(k) for k in range(residual.stages))
    assert left == pytest.approx(1e-8, rel=1e-6)
    assert residual.held == pytest.approx(gamma.isf(1e-8, residual.laws), rel=1e-6)
    wait = round(x * 50 + residual.held / math.sqrt(1 / 50))
    assert np.flatnonzero(~valid[1500:])[[0, -1]] + 1500 == pytest.approx(
        [2000, 1999 + wait], abs=1
    )
