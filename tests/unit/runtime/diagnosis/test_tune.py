"""Limits and smallest faults of a resistor, where all of them follow from its law by hand.

U - R i = 0 behind one lag of bandwidth b, signals being straight between samples: noise x reaches
the residual as y[k] = p y[k-1] + (1 - p) (x[k] + x[k-1])/2, nearly, with p = exp(-b T). Its
variance is (1 - p)/2 of that of x, and neighbours are correlated by (1 + p)/2.
"""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from scipy.signal import lfilter

from bondgraph.compilation import Compilation
from bondgraph.compile_options import Options
from bondgraph.ir.residual_limit import ShownSize
from bondgraph.runtime.diagnosis.calibration import Tuned, _Work, tune
from bondgraph.runtime.diagnosis.history import HEALTHY
from bondgraph.runtime.diagnosis.hypotheses import Bank, Hypothesis, rows_apart
from bondgraph.runtime.diagnosis.rows import to_row_ends
from bondgraph.runtime.diagnosis.shown_sizes import _by_fault, _Seen, _shown
from bondgraph.runtime.diagnosis.standing import followed
from bondgraph.runtime.diagnosis.tuning import Limit, height, kappa
from bondgraph.runtime.log import Array
from bondgraph.text.source import Source

_R, _I, _NOISE = 2.0, 3.0, 0.01
_STEP, _COUNT, _WINDOW = 1e-3, 10_000, 0.5
_TEXT = """bg 1
model M {
    param R = 2 Ohm
    1:s { <- Se:U; -> R:r = R; -> Df:i }
}
"""


@cache
def model() -> Compilation:
    return Compilation(Source(str(Path("m.bg")), _TEXT), None, Options(rate=1 / _STEP))


@cache
def tuned(window: float = _WINDOW) -> Tuned:
    """Of two logs of different length, and one that is too short to count."""
    engine = model().engine()
    assert [k.path for k in engine.signals] == ["U", "i"]
    logs = []
    for seed, count in ((1, _COUNT), (2, _COUNT // 2), (3, 5)):
        current = _I + np.random.default_rng(seed).normal(0.0, _NOISE, count)
        logs.append(np.column_stack([np.full(count, _R * _I), current]))
    return tune(engine, model().diagnosis_model, logs, "digest", 2.0, window)


def _seen(*sizes: float) -> _Seen:
    """Of a window in which each residual shows such a size, twice that at half of the time."""
    least = np.array(sizes)
    return _Seen(min(sizes), 1.0, 0, least, least, np.array([2.0, 1.0]) * min(sizes))


def _sigma() -> float:
    """Of white noise behind the lag."""
    pole = math.exp(-tuned().tuning.bandwidth * _STEP)
    return _R * _NOISE * math.sqrt((1.0 - pole) / 2.0)


def _wider(limit: Limit, samples: int) -> float:
    """What so few rows ask for: Student's t in place of the normal distribution.

    Of rows that are white noise behind a filter, four of five are independent, and the variance of
    their mean is twice that of white ones.
    """
    rows = samples / math.ceil(3.0 / tuned().tuning.bandwidth / _STEP)
    tail = stats.norm.sf(limit.kappa)
    freedom = rows / 1.25 - 1.0
    return float(stats.t.isf(tail, freedom) / limit.kappa * math.sqrt(1.0 + 2.0 / rows))


def test_the_noise_is_that_of_the_lag() -> None:
    limit = tuned().tuning.limits["r1"]
    wider = _wider(limit, round(tuned().tuning.seconds / _STEP))
    assert 1.05 < wider < 1.4
    assert limit.sigma == pytest.approx(wider * _sigma(), rel=0.2)  # ninety rows: 8 %
    assert limit.memory == pytest.approx(2.0, rel=0.3)
    assert limit.mean == pytest.approx(0.0, abs=0.3 * _sigma())
    # normal neighbours with a correlation c are of opposite sign acos(c)/pi of the time, half of
    # that on the way up
    pole = math.exp(-tuned().tuning.bandwidth * _STEP)
    crossings = math.acos((1.0 + pole) / 2.0) / (2.0 * math.pi) / _STEP
    assert limit.crossings == pytest.approx(crossings, rel=0.15)
    alarms = 2.0 / 3600.0 / 4  # one residual, four tests
    assert limit.kappa == pytest.approx(kappa(limit.crossings, alarms), rel=1e-6)
    row = math.ceil(3.0 / tuned().tuning.bandwidth / _STEP) * _STEP
    assert limit.height == pytest.approx(height(1.0 / row, alarms), rel=1e-6)


def test_what_was_learned_from_is_told() -> None:
    found = tuned().tuning
    assert (found.model, found.false_alarms) == ("digest", 2.0)
    assert found.rate == pytest.approx(1.0 / _STEP)
    warm = 2 * model().engine().warm_up
    assert found.seconds == pytest.approx(1.5 * _COUNT * _STEP - warm, abs=4 * _STEP)


def test_the_smallest_fault_is_the_limit_over_the_slope_at_the_end_of_a_window() -> None:
    """Behind one lag a step is larger the longer it lasts: it shows last, at 1 - exp(-b t)."""
    limit = tuned().tuning.limits["r1"]
    top = limit.kappa * limit.sigma / (1.0 - math.exp(-tuned().tuning.bandwidth * _WINDOW))
    slopes = {
        ("R", "value"): _I,
        ("i", "offset"): _R,
        ("i", "gain"): _R * _I,
        ("U", "offset"): 1.0,
        ("U", "gain"): _R * _I,
    }
    found = {(s.hypothesis.fault, s.hypothesis.kind): s for s in tuned().shown}
    assert set(found) == set(slopes)
    for key, slope in slopes.items():
        size, delay = found[key].size, found[key].delay
        assert size is not None and delay is not None
        # the current is noisy: so are the slopes of what it multiplies
        assert size == pytest.approx(top / slope, rel=5e-3), key
        assert delay == pytest.approx(_WINDOW, rel=0.1), key
        assert found[key].residual == "r1"


def test_what_shows_so_far_is_what_a_sample_tells_or_a_sum_of_rows() -> None:
    """Behind one lag an offset of U, a ramp from the sample before on and a step from then on,
    comes as 1 - exp(-b t) but for that ramp; a sum of n averages of it passes its height with the
    mean excess of height/n + 1/2 deviations, and once in ten times noise is against it by the root
    of n times 1.28 of them. Both are beside a level that is known as well as the filter of Kalman
    knows it in the end, of a walk of such a step beside such noise, and may be off against it."""
    found = tuned(4.0 * _WINDOW)
    limit, pole = found.tuning.limits["r1"], found.tuning.bandwidth
    every = math.ceil(3.0 / pole / _STEP)
    count = round(4.0 * _WINDOW / _STEP)
    ramp = (1.0 - math.exp(-pole * _STEP)) / (pole * _STEP)
    slopes = 1.0 - ramp * np.exp(-pole * _STEP * np.arange(count))
    half = limit.step**2 / 2.0
    level = math.sqrt(half + math.sqrt(half**2 + (limit.step * limit.unit) ** 2))
    _, left = followed(np.array([limit]), count // every + 1, HEALTHY)  # of a fault that stays
    slopes = slopes * np.repeat(left[:, 0], every)[:count]
    samples = limit.kappa * math.hypot(limit.sigma, level) / slopes
    sizes = samples.copy()
    for n in range(1, count // every + 1):
        reached = slopes[: n * every].sum() / every
        noise = limit.unit * (limit.height + 0.5 * n + 1.28 * math.sqrt(n))
        sizes[n * every - 1] = min(sizes[n * every - 1], (noise + 4.0 * level * n) / reached)
    course = next(s.course for s in found.shown if s.hypothesis[:2] == ("U", "offset"))
    ends = count * np.arange(1, len(course) + 1) // len(course) - 1
    assert list(course) == pytest.approx(np.minimum.accumulate(sizes)[ends].tolist(), rel=1e-3)
    assert course[-1] < 0.95 * samples.min()  # here a sum tells most


def test_from_which_size_on_each_residual_shows_a_fault() -> None:
    """Two loops share R: their slopes are i and 5 j, and the smaller of the sizes is the unit."""
    text = """bg 1
model M {
    param R = 2 Ohm
    1:s { <- Se:U; -> R:r = R; -> Df:i }
    1:t { <- Se:V; -> R:q = 5*R; -> Df:j }
}
"""
    engine = Compilation(Source("m.bg", text), None, Options(rate=1 / _STEP))
    own = engine.engine()
    assert [k.path for k in own.signals] == ["U", "V", "i", "j"]
    first, second, big = 3.0, 0.5, 20.0  # of U and i, and of V and j; the window is long: 20/b
    draw = np.random.default_rng(5)
    noise = draw.normal(0.0, _NOISE, (_COUNT, 2)) * [1.0, big]
    columns = [np.full(_COUNT, 2.0 * first), np.full(_COUNT, 10.0 * second)]
    log = np.column_stack([*columns, first + noise[:, 0], second + noise[:, 1]])
    known = tune(own, engine.diagnosis_model, [log], "digest", 2.0, 1.0).tuning
    assert known.window == 1.0 + own.lags[-1]
    by_fault = {f: r.name for r in engine.program.residuals for f in ("U", "V") if f in r.faults}
    slopes = {by_fault["U"]: first, by_fault["V"]: 5.0 * second}
    tops = {n: known.limits[n].kappa * known.limits[n].sigma for n in slopes}
    sizes = {n: tops[n] / slope for n, slope in slopes.items()}
    assert 5.0 < sizes[by_fault["V"]] / sizes[by_fault["U"]] < 200.0
    for name, size in sizes.items():
        shown = known.shows[name]["R"]
        for number in shown:  # a slope is as noisy as the current: at the peak of a window more
            assert number == pytest.approx(size / min(sizes.values()), rel=0.15)
        assert shown.least <= shown.sure
    assert set(known.shows[by_fault["U"]]) == {"R", "U", "i"}


def test_a_storage_that_changes_without_a_jump_shows_by_what_flows_into_it() -> None:
    """i - C D(v) with v on a ramp of s: a change d makes d s, once the filter has settled.

    Where the charge stays v jumps by v d/C, of which the filter shows the derivative at once.
    """
    text = """bg 1
    model Charged {
        param C = 1 F
        0:n { <- Sf:i; -> C:c = C; -> De:v }
    }
    """
    made = Compilation(Source("m.bg", text), None, Options(rate=1.0 / _STEP))
    engine = made.engine()
    assert [k.path for k in engine.signals] == ["i", "v"]
    slope, window, count = 0.5, 1.0, 20_000
    volts = 5.0 + slope * np.arange(count) * _STEP
    noise = np.random.default_rng(8).normal(0.0, 1e-3, count)
    log = np.column_stack([slope + noise, volts])
    found = tune(engine, made.diagnosis_model, [log], "digest", 1.0, window)
    (own,) = [one for one in found.shown if one.hypothesis.fault == "C"]
    limit = found.tuning.limits["r1"]
    assert own.size is not None and own.smooth is not None
    assert own.smooth == pytest.approx(limit.kappa * limit.sigma / slope, rel=0.03)
    # v d/C behind p/(1 + p/b)^2 is at most v d b/e, at 1/b; v is that of the worst window of ten
    assert made.diagnosis_model.natures["r1"].stages == 2
    top = float(np.quantile(volts, 0.1)) * engine.bandwidth / math.e
    assert own.size == pytest.approx(limit.kappa * limit.sigma / top, rel=0.1)
    assert own.size < 0.1 * own.smooth


def test_a_way_that_does_not_move_a_residual_is_not_ruled_out_by_its_silence() -> None:
    """A sensor's offset moves both residuals, its gain the first only, a reading of zero none."""
    ways = [Hypothesis("i", kind, "A", 1.0, False) for kind in ("offset", "gain", "drift")]
    inf = math.inf
    sizes = ([2.0, 6.0], [5.0, inf], [inf, inf])
    windows = [[_seen(*s)] for s in sizes]
    found = _by_fault(ways, windows, ["r1", "r2"])
    assert found == {"r1": {"i": ShownSize(1.0, 1.0)}, "r2": {"i": ShownSize(3.0, inf)}}


@pytest.mark.parametrize("first", [True, False])
def test_a_limit_stays_above_what_a_healthy_machine_has_reached(first: bool) -> None:
    engine = model().engine().configured(bandwidth=300.0)
    noise = np.random.default_rng(4).normal(0.0, _NOISE, 6000)
    quiet = np.column_stack([np.full(6000, _R * _I), _I + noise])
    pulse = quiet.copy()
    pulse[3000, 1] += 1.0  # of too few samples to count as noise
    logs = [pulse, quiet] if first else [quiet, pulse]
    limit = tune(engine, model().diagnosis_model, logs, "digest", 2.0, _WINDOW).tuning.limits["r1"]
    reached = np.abs(engine.configured().run(pulse).value - limit.mean).max()
    # each log is beside where it stands itself, which is not known for sure
    assert limit.kappa * limit.sigma == pytest.approx(1.2 * reached, rel=1e-2)


def test_what_is_watched_before_all_are_warm_counts() -> None:
    """r1 has one stage less than r2, and is watched sooner: it may not fire on what it learned."""
    text = """bg 1
model M {
    param R = 2 Ohm
    param L = 1 H
    1:s { <- Se:U; -> R:r = R; -> Df:i }
    1:t { <- Se:V; -> I:l = L; -> Df:j }
}
"""
    made = Compilation(Source("m.bg", text), None, Options(rate=1 / _STEP))
    engine = made.engine()
    assert [k.path for k in engine.signals] == ["U", "V", "i", "j"]
    draw = np.random.default_rng(7)
    log = draw.normal(0.0, 1e-5, (_COUNT, 4)) + [_R * _I, 0.0, _I, 1.0]
    log[:, 0] = _R * _I  # steps of a command, as of its noise, widen a threshold
    log[0, 2] += 5.0
    batch = engine.configured().run(log)
    first = np.argmax(batch.valid, axis=0)
    assert first[0] < first[1] == round(engine.warm_up / _STEP)
    jump, none = np.zeros((_COUNT, 4)), np.zeros((1, 4))
    jump[0, 2] = 5.0
    limit, usual = (
        tune(engine, made.diagnosis_model, [log - less], "digest", 2.0, _WINDOW).tuning.limits["r1"]
        for less in (none, jump)
    )
    reached = np.abs(batch.value[:, 0] - limit.mean)[batch.valid[:, 0]].max()
    assert reached > 10.0 * np.abs(batch.value[first[1] :, 0]).max()
    # beside where its level stands, which is not known for sure
    assert limit.kappa * limit.sigma == pytest.approx(1.2 * reached, rel=1e-2)
    # beside that the averages of rows are what they are without the jump
    assert limit.unit / limit.sigma == pytest.approx(usual.unit / usual.sigma, rel=0.1)


def test_noise_is_not_taken_for_less_than_the_digits_that_a_log_has() -> None:
    """A log without noise: U adds 6 V to the residual and R i takes them away."""
    engine = model().engine()
    exact = np.tile([_R * _I, _I], (_COUNT, 1))
    limit = tune(engine, model().diagnosis_model, [exact], "digest", 2.0).tuning.limits["r1"]
    assert limit.sigma == pytest.approx(1e-7 * _R * _I)


@pytest.mark.parametrize("begin", [5000, 9000])  # the sums are at zero again in the end, or not
def test_sums_of_a_healthy_machine_count_however_high_they_are(begin: int) -> None:
    """It is off for a second, by less than single samples tell, and no monitor may say so."""
    draw = np.random.default_rng(8)
    log = np.column_stack([np.full(_COUNT, _R * _I), _I + draw.normal(0.0, _NOISE, _COUNT)])
    log[begin : begin + 1000, 1] += 0.6 * _NOISE
    engine = model().engine()
    tuning = tune(engine, model().diagnosis_model, [log], model().program.digest, 2.0).tuning
    usual = tuned().tuning.limits["r1"].height
    assert tuning.limits["r1"].height > 2.0 * 1.2 * usual
    watching = model().tuned(tuning)
    own = watching.engine()
    watch = watching.diagnosis(own, tuning)
    said = watch.update(np.arange(_COUNT) * _STEP, own.run(log), log)
    assert [v for v in said if v.event == "warm-up"]
    assert not [v for v in said if v.event == "fault"]


def _wandering(seed: int, fault: float = 0.0) -> Array:
    """A current that wanders by as much as its noise, for seconds; behind 6 s it is off."""
    draw, kept = np.random.default_rng(seed), math.exp(-_STEP / 3.0)
    current = _I + draw.normal(0.0, _NOISE, _COUNT)
    steps = draw.normal(0.0, _NOISE * math.sqrt(1.0 - kept**2), _COUNT)
    current += lfilter([1.0], [1.0, -kept], steps, zi=[kept * _NOISE * draw.normal()])[0]
    current[6000:] += fault
    return np.column_stack([np.full(_COUNT, _R * _I), current])


def test_where_a_level_wanders_noise_is_beside_that_in_a_tuning_too() -> None:
    """Behind the filter noise has 0.002 V, and what wanders ten times that: a fault has 0.1 V."""
    engine, digest = model().engine(), model().program.digest
    logs = [_wandering(seed) for seed in range(3)]
    tuning = tune(engine, model().diagnosis_model, logs, digest, 2.0, _WINDOW).tuning
    limit = tuning.limits["r1"]
    assert limit.kappa * limit.sigma < 2.5 * _R * _NOISE
    assert limit.goes > 0.5 * _R * _NOISE  # there is room for that where nobody follows
    watching = model().tuned(tuning)
    for fault, seeds in ((0.0, range(3, 7)), (5.0 * _NOISE, range(10, 13))):
        for seed in seeds:
            own, log = watching.engine(), _wandering(seed, fault)
            watch = watching.diagnosis(own, tuning)
            said = watch.update(np.arange(_COUNT) * _STEP, own.run(log), log)
            alarms = [v.time for v in said if v.event == "fault"]
            assert [6.0 < at < 6.2 for at in alarms] == [True] * bool(fault)


def test_no_tolerance_explains_noise_by_more_than_it_allows() -> None:
    """What a capacity holds is noise alone here, as its voltage rests: a capacity of zero has none.

    Within 20 % of 10 F the residual of 8 F is the quietest, whose noise is 0.8 times that of 10 F.
    """
    draw = np.random.default_rng(4)
    samples = {"i": np.zeros(20_000), "u": 5.0 + 1e-3 * draw.standard_normal(20_000)}

    def sigma(capacity: str) -> float:
        text = (
            f"bg 1\nmodel M {{ param C = {capacity}\n"
            "0:n { <- Sf:i; -> C:c = C; -> De:u } }\n"
        )
        c = Compilation(Source("m.bg", text), None, Options(rate=1000.0))
        engine = c.engine()
        log = np.column_stack([samples[k.path] for k in engine.signals])
        found = tune(engine, c.diagnosis_model, [log], "digest", 1.0, 2.0).tuning
        return found.limits["r1"].sigma

    plain = sigma("10 F")
    assert sigma("8 F") == pytest.approx(0.8 * plain, rel=1e-6)
    assert 0.8 * plain <= sigma("10 F +- 20%") * 1.01 and sigma("10 F +- 20%") <= plain


def test_logs_do_not_stand_apart_by_parameters_that_make_up_for_each_other() -> None:
    """A current of 3 A +- 0.05 A hardly tells E from R: what a law leaves out takes both far out.

    In three logs the voltage follows the current by 0, 2 and 4 Ohm more. For that R would have to
    be 4 Ohm less, and E 12 V: within its tolerance R is 0.2 Ohm less, which takes 0.6 V of E, and
    so every log stands at zero in the mean. At both tolerances one would stand 3.4 V off.
    """
    text = (
        "bg 1\nmodel M { param E = 100 V +- 4%\nparam R = 2 Ohm +- 10%\ninput u : V\n"
        "1:s { <- Se:pump = E; -> R:r = R; -> Df:i; -> Se:load = u } }\n"
    )
    c = Compilation(Source("m.bg", text), None, Options(rate=1 / _STEP))
    engine, draw = c.engine(), np.random.default_rng(5)
    logs = []
    for more in (0.0, 2.0, 4.0):
        turns = 0.05 * np.sin(2.0 * np.pi * np.arange(2 * _COUNT) / _COUNT)
        noise = 1e-3 * draw.standard_normal(2 * _COUNT)
        signals = {"i": 3.0 + turns, "u": 94.0 - (2.0 + more) * turns + noise}
        logs.append(np.column_stack([signals[k.path] for k in engine.signals]))
    limit = tune(engine, c.diagnosis_model, logs, "digest", 2.0, _WINDOW).tuning.limits["r1"]
    assert limit.apart < 0.1 * limit.sigma


@pytest.mark.parametrize("tunes", [True, False])
def test_what_adds_up_readings_walks_away(tunes: bool) -> None:
    """F - K (q + c q^3) with q = int(v), of a spring that moves little: it walks by K times noise.

    A walk adds up its steps by their squares: in a row of n samples of noise s it goes
    K (1 + 3 c q^2) T s sqrt(n). The log is ten times as long as that of the tuning; at its end the
    force is off by fifteen times what it has walked by then.
    """
    text = """bg 1
    model Spring {
        param K = 100 N/m
        const c = 20 1/m^2
        0:s { <- Sf:v; -> C:k(q0 = 0 m) { e = K*q*(1 + c*q^2) }; -> De:F }
    }
    """
    made = Compilation(Source("m.bg", text), None, Options(rate=100.0))

    def log(seed: int, count: int) -> np.ndarray:
        draw, time = np.random.default_rng(seed), np.arange(count) * 0.01
        place = 0.05 * np.sin(2.0 * time)
        speed = 0.1 * np.cos(2.0 * time) + draw.normal(0.0, 0.01, count)
        force = 100.0 * place * (1.0 + 20.0 * place**2)
        return np.column_stack([speed, force + draw.normal(0.0, 0.005, count)])

    engine = made.engine()
    assert [k.path for k in engine.signals] == ["v", "F"]
    tuning = None
    if tunes:
        logs = [log(1, 20_000)]
        tuning = tune(engine, made.diagnosis_model, logs, made.program.digest, 1.0).tuning
        steep = 100.0 * (1.0 + 60.0 * 0.05**2 / 2.0)
        walk = steep * 0.01 * 0.01 * math.sqrt(rows_apart(engine))
        assert tuning.limits["r1"].walk == pytest.approx(walk, rel=0.2)
        made = made.tuned(tuning)
    samples, time, begin = log(4, 200_000), np.arange(200_000) * 0.01, 198_000
    samples[begin:, 1] += 15.0 * 0.13 * math.sqrt(begin / rows_apart(engine))
    own = made.engine()
    said = made.diagnosis(own, tuning).update(time, own.run(samples), samples)
    fired = [v.time for v in said if v.event == "fault"]
    assert fired and fired[0] == pytest.approx(time[begin], abs=2.0)


def test_rows_are_those_of_a_watch_of_the_same_log() -> None:
    """What falls off within a row is another sum of rows that end elsewhere."""
    engine = model().engine().configured(bandwidth=100.0)
    every = rows_apart(engine)
    start = math.ceil(engine.warm_up / engine.sample_time) + 1
    assert start % every  # not by chance
    log = np.tile([_R * _I, _I], (_COUNT, 1))
    log[:, 1] += np.random.default_rng(5).normal(0.0, _NOISE, _COUNT)
    found = _Work(engine, model().diagnosis_model, [log]).noise(0, log)
    assert found is not None and found.rows == pytest.approx(_COUNT - start, abs=1)
    time = np.arange(_COUNT) * _STEP
    rows = [own for own in to_row_ends(time, _STEP, every) if own.stop - own.start == every]
    value, valid, *_ = engine.configured().run(log)
    assert len(found.every) == len(rows)
    for row, own in zip(found.every, rows, strict=True):
        assert row.value == pytest.approx(value[own.stop - 1]) and row.average is not None
        assert row.average.valid.tolist() == valid[own].all(axis=0).tolist()
        if row.average.valid.all():
            assert row.average.value == pytest.approx(value[own].mean(axis=0))


def test_a_log_that_ends_with_the_first_row_behind_the_warm_up_teaches_nothing() -> None:
    engine = model().engine()
    short = math.ceil(engine.warm_up / engine.sample_time) + 1 + rows_apart(engine)
    logs = [np.tile([_R * _I, _I], (short, 1))]
    logs[0][:, 1] += np.random.default_rng(6).normal(0.0, _NOISE, short)
    with pytest.raises(ValueError, match="nothing can be learned"):
        tune(engine, model().diagnosis_model, logs, "digest", 2.0)


def test_samples_that_are_missing_do_not_count_as_noise() -> None:
    engine = model().engine()
    current = _I + np.random.default_rng(1).normal(0.0, _NOISE, _COUNT)
    whole = np.column_stack([np.full(_COUNT, _R * _I), current])
    holes = whole.copy()
    holes[6000:6020] = math.nan
    found = tune(engine, model().diagnosis_model, [holes], "digest", 2.0, _WINDOW).tuning
    wider = _wider(found.limits["r1"], round(found.seconds / _STEP))
    assert found.limits["r1"].sigma == pytest.approx(wider * _sigma(), rel=0.1)


@pytest.mark.parametrize(
    ("sizes", "size"),
    [
        ([3.0], 3.0),
        ([2.0, 1.0], 2.0),  # nine of ten windows, that is both of them
        ([float(k) for k in range(10)], 9.0),
        ([float(k) for k in range(20)], 18.0),  # 0 to 17 are nine of ten, less than 18 all of them
    ],
)
def test_what_is_sure_to_show_shows_in_nine_windows_of_ten(sizes: list[float], size: float) -> None:
    windows = [_seen(s) for s in sizes]
    shown = _shown(Hypothesis("R", "value", "", 0.1, False), windows, ["r1"])
    assert shown.size == size
    assert sum(s <= size for s in sizes) >= 0.9 * len(sizes)
    assert shown.residual == "r1"
    assert shown.course == (2.0 * size, size)


def test_logs_that_are_too_short_teach_nothing() -> None:
    engine = model().engine()
    with pytest.raises(ValueError, match="nothing can be learned"):
        tune(engine, model().diagnosis_model, [np.zeros((4, 2))], "digest", 2.0)


def test_slopes_are_what_a_change_makes_of_the_residual() -> None:
    """dr/dR = -i, dr/di = -R and -R i, dr/dU = 1, each behind the lag, from the first sample on."""
    engine = model().engine()
    ways = (
        ("R", "value", True),
        ("i", "offset", False),
        ("i", "gain", False),
        ("U", "offset", True),
    )
    hypotheses = tuple(Hypothesis(f, kind, "", 0.1, turned) for f, kind, turned in ways)
    bank = Bank(engine.configured(bounds=False), hypotheses, {"R": _R})
    samples = np.tile([_R * _I, _I], (3000, 1))
    found = np.concatenate([bank.run(samples[:1000]), bank.run(samples[1000:])])
    sign = np.sign(found[-1, 3, 0])  # whether the relation is U - R i or its negative
    assert sign * found[-1, :, 0] == pytest.approx([-_I, -_R, -_R * _I, 1.0], rel=1e-6)


def test_what_adds_up_readings_has_no_noise_behind_a_gap() -> None:
    """There the charge is not that of the start any more: what that makes is none of its noise."""
    text = """bg 1
model Cell {
    param R = 0.5 Ohm
    0:t { <- Sf:I; -> De:V; -> 1:c }
    c { -> C:s(q0 = 10 C) { e = 0.2*q + 0.01*q^2 }; -> R:R }
}"""
    time = np.arange(6000) / 100.0
    current = 0.3 + np.sin(0.9 * time)
    q = 10.0 + 0.3 * time + (1 - np.cos(0.9 * time)) / 0.9
    volt = 0.5 * current + 0.2 * q + 0.01 * q**2
    volt += _NOISE * np.random.default_rng(1).standard_normal(len(time))
    made = Compilation(Source("cell.bg", text), None, Options(rate=100.0))
    engine = made.engine()
    samples = np.column_stack([{"I": current, "V": volt}[k.path] for k in engine.signals])
    parts = [samples[:3500], samples[4000:]]
    alone = tune(engine, made.diagnosis_model, parts[:1], "digest", 2.0, 1.0)
    both = tune(engine, made.diagnosis_model, parts, "digest", 2.0, 1.0, later=[False, True])
    wrong = tune(engine, made.diagnosis_model, parts, "digest", 2.0, 1.0)
    assert both.tuning.limits["r1"].sigma == pytest.approx(alone.tuning.limits["r1"].sigma)
    assert both.tuning.limits["r1"].sigma < _NOISE  # the filter takes some off
    assert wrong.tuning.limits["r1"].sigma > 10.0 * _NOISE
    assert not alone.lost and both.lost == {"r1": pytest.approx(20.0)}
    with pytest.raises(ValueError, match="r1 counts up to the first gap of each log only"):
        tune(engine, made.diagnosis_model, parts[1:], "digest", 2.0, 1.0, later=[True])
