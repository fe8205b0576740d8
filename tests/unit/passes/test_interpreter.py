"""The realisable residual on samples, against exact linear simulation and analytic signals."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import signal as sig

from bondgraph.backends.forty_digits import Evaluation, value
from bondgraph.ir.expr import Expr
from bondgraph.ir.program import Program, Ref
from bondgraph.passes.lowering.lower import LowerOptions
from bondgraph.runtime.batch import Lanes
from tests.sampled import Sampled
from tests.unit.passes.lowering_models import Bench, drive


def run(
    program: Program,
    samples: dict[str, np.ndarray],
    *modes: str,
    **options: object,
) -> np.ndarray:
    """The first residual of every sample, with all `modes` off."""
    machine = Sampled(program, **options)  # type: ignore[arg-type]
    name = program.residuals[0].name
    rows = (dict(zip(samples, row, strict=True)) for row in zip(*samples.values(), strict=True))
    off = dict.fromkeys(modes, False)
    return np.array([machine.step(row, off).residuals[name] for row in rows])


def smooth_start(t: np.ndarray) -> np.ndarray:
    """From 0 to 1 in one second, with many derivatives zero at the start."""
    x = np.clip(t, 0.0, 1.0)
    return np.asarray(x**5 * (126 - 420 * x + 540 * x**2 - 315 * x**3 + 70 * x**4))


def third_order(bench: Bench) -> Expr:
    p = bench.pool
    y, u = bench.sensor("y"), bench.input("u")
    a, b, c = bench.param("a", "0.3"), bench.param("b", "0.02"), bench.param("c", "0.001")
    d = p.der
    return p.add(
        (2, y),
        (1, p.mul(a, d(y))),
        (1, p.mul(b, d(d(y)))),
        (1, p.mul(c, d(d(d(y))))),
        (-3, u),
        (-1, p.mul(a, b, d(u))),
        (5, p.one),
    )


def third_order_signals(noise: float) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    t = np.arange(0, 1.5, 1e-3)
    random = np.random.default_rng(1).standard_normal(len(t))
    y = smooth_start(t) * (np.sin(9 * t) + noise * random)
    return t, {"y": y, "u": smooth_start(t) * np.cos(4 * t)}


@pytest.mark.parametrize("bandwidth", [5.0, 20.0, 150.0])
def test_smooth_signals_give_the_filtered_residual(bandwidth: float) -> None:
    """Same as r(p) over (1 + p/wc)^4 in continuous time."""
    bench = Bench()
    program = bench.program(third_order(bench))
    assert program.residuals[0].stages == 4
    t, samples = third_order_signals(0.0)
    found = run(program, samples, bandwidth=bandwidth)
    lag = np.poly1d([1 / bandwidth, 1.0]) ** 4
    expected = np.full(len(t), 5.0)
    for name, numerator in (("y", [0.001, 0.02, 0.3, 2.0]), ("u", [-0.006, -3.0])):
        system = sig.TransferFunction(numerator, lag.coeffs)
        expected += sig.lsim(system, samples[name], t, interp=True)[1]
    assert np.max(np.abs(found - expected)) < 5e-5 * np.max(np.abs(expected))


@pytest.mark.parametrize("bandwidth", [5.0, 20.0, 150.0])
def test_noisy_signals_give_the_sum_of_cascades(bandwidth: float) -> None:
    """Term by term: D^k (1 - (3-k) (D T)^2/12) / (1 + D/wc)^4, D the bilinear one of SciPy."""
    bench = Bench()
    program = bench.program(third_order(bench))
    t, samples = third_order_signals(0.1)
    found = run(program, samples, bandwidth=bandwidth)

    def through(x: np.ndarray, derivatives: int) -> np.ndarray:
        """D^k x/(1 + D/wc)^4."""
        for stage in range(4):
            above = [bandwidth, 0.0] if stage < derivatives else [bandwidth]
            up, down = sig.bilinear(above, [1.0, bandwidth], 1e3)
            state = sig.lfilter_zi(up, down) * x[0]
            x = sig.lfilter(up, down, x, zi=state)[0]
        return x

    expected = np.full(len(t), 5.0)
    for name, terms in (("y", [2.0, 0.3, 0.02, 0.001]), ("u", [-3.0, -0.006])):
        for k, c in enumerate(terms):
            expected += c * through(samples[name], k)
            if k < 3:
                expected -= c * (3 - k) * 1e-6 / 12 * through(samples[name], k + 2)
    assert np.max(np.abs(found - expected)) < 1e-9 * np.max(np.abs(expected))


def test_constant_signals_are_at_rest_from_the_first_sample() -> None:
    bench = Bench()
    program = bench.program(third_order(bench))
    found = run(program, {"y": np.full(50, 7.0), "u": np.full(50, -2.0)})
    assert found == pytest.approx(np.full(50, 2 * 7.0 + 6.0 + 5.0), rel=1e-10)


def healthy_drive(t: np.ndarray, params: dict[str, float]) -> dict[str, np.ndarray]:
    """Samples of a drive that obeys r1, for speeds chosen freely."""
    import sympy

    time = sympy.Symbol("t")
    start = time**5 * (126 - 420 * time + 540 * time**2 - 315 * time**3 + 70 * time**4)
    we = 60 * start * sympy.cos(2 * time)
    ws = 2.4 * start * sympy.cos(2 * time + sympy.Rational(1, 10))
    fx = sympy.Rational(6, 100) * start
    v = params
    load = v["Js"] * ws.diff(time) + v["fs"] * ws + v["R"] * fx
    torque = v["Je"] * we.diff(time) + v["fe"] * we + load / v["N"]
    u0 = v["k"] * we + v["Re"] / v["k"] * torque + v["L"] / v["k"] * torque.diff(time)
    found = {}
    for name, wave in {"We": we, "Ws": ws, "Fx": fx, "U0": u0}.items():
        found[name] = sympy.lambdify(time, wave, "numpy")(np.minimum(t, 1.0)) * np.ones(len(t))
    return found


def test_healthy_drive_gives_nothing_and_a_fault_its_share() -> None:
    bench = Bench()
    r1, _ = drive(bench)
    program = bench.program(r1)
    params = {f.name: float(f.default or 0) for f in program.params}
    t = np.arange(0, 1, 1e-3)
    samples = healthy_drive(t, params)
    healthy = run(program, samples)
    assert np.max(np.abs(healthy)) < 1e-5 * np.max(np.abs(samples["U0"]))
    faulty = run(program, healthy_drive(t, params | {"fe": 1.1 * params["fe"]}))
    gain = -0.1 * params["fe"] * params["Re"] / params["k"]
    slope = -0.1 * params["fe"] * params["L"] / params["k"]
    lag = np.poly1d([1 / program.bandwidth, 1.0]) ** 3
    filtered = sig.lsim(sig.TransferFunction([slope, gain], lag.coeffs), samples["We"], t)[1]
    assert np.max(np.abs(faulty - filtered)) < 1e-5 * np.max(np.abs(samples["U0"]))
    assert np.max(np.abs(faulty)) > 1000 * np.max(np.abs(healthy))


def test_integral_residual_of_the_drive() -> None:
    """r2i with tanh of an integral: filtered exactly, from the declared initial twist."""
    bench = Bench()
    _, r2 = drive(bench)
    program = bench.program(r2)
    v = {f.name: float(f.default or 0) for f in program.params}
    t = np.arange(0, 2, 1e-3)
    fine = np.arange(0, 2, 1e-5)
    rates = 0.05 * smooth_start(fine) * np.sin(6 * fine)  # of the twist
    twist = 0.01 + np.concatenate([[0], np.cumsum((rates[1:] + rates[:-1]) / 2) * 1e-5])
    rate, twist = rates[::100], twist[::100]
    ws = 2 * smooth_start(t)
    we = rate + v["N"] * ws
    torque = v["K"] * (v["A"] * v["tau0"] * np.tanh(twist / (4 * v["tau0"])) + twist)
    lag = np.poly1d([1 / program.bandwidth, 1.0]) ** 2
    expected = sig.lsim(sig.TransferFunction([v["Js"], v["fs"]], lag.coeffs), ws, t)[1]
    torque_lag = sig.TransferFunction([1.0], lag.coeffs)
    expected -= v["N"] * (sig.lsim(torque_lag, torque - torque[0], t)[1] + torque[0])
    found = run(program, {"We": we, "Ws": ws, "Fx": np.zeros(len(t))})
    assert np.max(np.abs(found - expected)) < 2e-5 * np.max(np.abs(expected))


def test_tank() -> None:
    """A p' / (rho g) + k ssqrt(p) - q, emptying through an orifice in closed form."""
    bench = Bench()
    p = bench.pool
    level, q = bench.sensor("p"), bench.input("q")
    area, k = bench.param("A", "0.01"), bench.param("k", "0.2")
    flow = p.mul(k, p.fn("ssqrt", level))
    program = bench.program(p.add((1, p.der(p.mul(area, level))), (1, flow), (-1, q)))
    assert program.residuals[0].approximate == ""
    t = np.arange(0, 1.0, 1e-3)
    height = (8 - 0.2 / (2 * 0.01) * t * 0.5) ** 2  # sqrt(p)' = -k/(2A), with q for the rest
    inflow = 0.2 * np.sqrt(height) - 2 * 0.01 * 5.0 * np.sqrt(height)
    found = run(program, {"p": height, "q": inflow})
    settled = found[int(12 / 20 / 1e-3) :]
    assert np.max(np.abs(settled)) < 1e-3 * np.max(np.abs(inflow) + 0.2 * np.sqrt(height))
    leak = run(program, {"p": height, "q": inflow + 0.05})
    assert leak[-1] == pytest.approx(-0.05, rel=2e-2)


def test_derivatives_inside_products_are_marked_and_close() -> None:
    bench = Bench()
    p = bench.pool
    x, y, u = bench.sensor("x"), bench.sensor("y"), bench.input("u")
    program = bench.program(p.sub(p.mul(x, p.der(p.der(y))), u))
    info = program.residuals[0]
    assert info.approximate
    assert info.stages == 3
    t = np.arange(0, 4, 1e-3)
    slow, fast = 2 + 0.1 * np.sin(0.3 * t), np.sin(2 * t)
    found = run(program, {"x": slow, "y": fast, "u": -4 * slow * fast}, bandwidth=60.0)
    assert np.max(np.abs(found[1000:])) < 0.02 * 8
    assert np.max(np.abs(run(program, {"x": slow, "y": fast, "u": -3 * slow * fast})[1000:])) > 1


def encoder(counts: int | None, position: bool) -> Program:
    bench = Bench()
    p = bench.pool
    th, torque = bench.sensor("th", counts), bench.input("T")
    j, f, k = bench.param("J", "0.002"), bench.param("f", "0.01"), bench.param("k", "0.3")
    terms = [(1, p.mul(j, p.der(p.der(th)))), (1, p.mul(f, p.der(th))), (-1, torque)]
    if position:
        terms += [(1, p.mul(k, th)), (1, p.mul(k, p.fn("sin", th)))]
    return bench.program(p.add(*terms))


@pytest.mark.parametrize("position", [False, True])
@pytest.mark.parametrize("start", [0, 2**31 - 40, -(2**31) + 3])
def test_encoder_counts_give_what_the_angle_gives(position: bool, start: int) -> None:
    t = np.arange(0, 2, 1e-3)
    counts = np.round(3 * smooth_start(t / 2) * np.sin(5 * t) * 96 / (2 * np.pi) * 10).astype(int)
    angle = (counts - counts[0]) * 2 * np.pi / 96
    torque = np.cos(3 * t)
    wrapped = (counts + start + 2**31) % 2**32 - 2**31
    by_counts = run(encoder(96, position), {"th": wrapped, "T": torque})
    by_angle = run(encoder(None, position), {"th": angle, "T": torque})
    assert np.max(np.abs(by_counts - by_angle)) < 1e-10 * np.max(np.abs(by_angle))


def test_encoder_counts_in_a_product_give_what_the_angle_gives() -> None:
    t = np.arange(0, 2, 1e-3)
    counts = np.round(3 * smooth_start(t / 2) * np.sin(5 * t) * 96 / (2 * np.pi) * 10).astype(int)
    angle, load = (counts - counts[0]) * 2 * np.pi / 96, 1 + 0.1 * np.sin(3 * t)
    found = []
    for coded, th in ((96, counts), (None, angle)):
        bench = Bench()
        p = bench.pool
        turns, x = bench.sensor("th", coded), bench.sensor("x")
        speed = p.der(turns)
        terms = [p.mul(x, p.der(speed)), p.mul(x, speed, p.der(x)), p.fn("sin", turns)]
        program = bench.program(p.add(*[(1, term) for term in terms]))
        assert program.residuals[0].approximate
        found.append(run(program, {"th": th, "x": load}))
    assert np.max(np.abs(found[0] - found[1])) < 1e-10 * np.max(np.abs(found[1]))


def test_encoder_far_from_its_start_keeps_single_precision() -> None:
    """A million turns in float32: the speed residual is as good as in double precision."""
    t = np.arange(0, 20, 1e-2)
    counts = (t * 5e7).astype(np.int64)
    wrapped = (counts + 2**31) % 2**32 - 2**31
    program = encoder(96, False)
    samples = {"th": wrapped, "T": np.zeros(len(t))}
    double = run(program, samples, sample_time=0.01, bandwidth=2.0)
    single = run(program, samples, **single_precision(0.01, 2.0))
    assert double[-1] == pytest.approx(0.01 * 5e7 * 2 * np.pi / 96, rel=1e-4)
    assert abs(single[-1] - double[-1]) < 1e-5 * double[-1]


def single_precision(sample_time: float, bandwidth: float) -> dict[str, object]:
    """Options for an interpreter that computes as a float build does."""
    functions = {
        name: (lambda f: lambda *a: np.float32(f(*a)))(getattr(np, name)) for name in ("exp", "sin")
    }
    return {
        "real": np.float32,
        "functions": functions,
        "sample_time": np.float32(sample_time),
        "bandwidth": np.float32(bandwidth),
    }


@pytest.mark.parametrize("bandwidth", [0.5, 20.0])
def test_chain_of_four_stages_is_stable_in_single_precision(bandwidth: float) -> None:
    bench = Bench()
    program = bench.program(third_order(bench))
    t = np.arange(0, 3, 1e-3)
    samples = {"y": np.sin(3 * t), "u": np.cos(t)}
    double = run(program, samples, bandwidth=bandwidth)
    real = {n: v.astype(np.float32) for n, v in samples.items()}
    single = run(program, real, **single_precision(1e-3, bandwidth))
    assert np.max(np.abs(single - double)) < 2e-4 * np.max(np.abs(double))


def test_a_bad_sample_restarts_and_does_no_lasting_harm() -> None:
    bench = Bench()
    program = bench.program(third_order(bench))
    machine = Sampled(program)
    settle = math.ceil(program.residuals[0].settle / (1e-3 * program.bandwidth))
    for i in range(settle + 1):
        outcome = machine.step({"y": 1.0, "u": 2.0})
        assert outcome.valid["r1"] is (i >= settle)
    assert machine.step({"y": math.nan, "u": 2.0}) == ({"r1": 0.0}, {"r1": False})
    assert machine.step({"y": 1.0, "u": math.inf}).valid == {"r1": False}
    outcome = machine.step({"y": 1.0, "u": 2.0})
    assert outcome.residuals["r1"] == pytest.approx(2 - 6 + 5)
    assert not outcome.valid["r1"]
    for _ in range(settle):
        outcome = machine.step({"y": 1.0, "u": 2.0})
    assert outcome.valid["r1"]


def test_the_stage_is_the_bilinear_transform_up_to_the_mean_of_two_samples() -> None:
    bench = Bench()
    program = bench.program(bench.sensor("y"), options=LowerOptions())
    for x in (1e-6, 0.02, 0.4, 1.9, 2.0, 3.0):
        coefs = Sampled(program, sample_time=x, bandwidth=1.0).coefs
        a, b = coefs["a"], coefs["b"]
        up, down = sig.bilinear([1.0], [1.0, 1.0], 1 / min(x, 2.0))
        assert [1.0, -a] == pytest.approx(down, rel=1e-12, abs=1e-15)
        assert [b, b] == pytest.approx(up, rel=1e-9)
        assert a + 2 * b == pytest.approx(1.0, rel=1e-15)  # a constant passes with factor 1


M, D, K, C = 5.4e-6, 2.2e-4, 1.0, 3.9  # an electronic oscillator: 68 Hz, a quality factor of 11


def swing(time: np.ndarray, hardens: bool) -> dict[str, np.ndarray]:
    """An oscillator that comes into motion, m y'' + d y' + k y + c y^3 = u, in closed form.

    After a second it swings at 70 Hz and half of that, and u has the three harmonics that a spring
    which `hardens` makes of them.
    """
    import sympy

    t = sympy.Symbol("t")
    start = t**5 * (126 - 420 * t + 540 * t**2 - 315 * t**3 + 70 * t**4)
    found = []
    for course in (start, sympy.Integer(1)):
        y = course * (sympy.sin(440 * t) + sympy.cos(220 * t)) / 5
        u = M * y.diff(t, 2) + D * y.diff(t) + K * y + (C * y**3 if hardens else 0)
        waves = {"y": y, "v": y.diff(t), "u": u}
        found.append({n: sympy.lambdify(t, wave, "numpy")(time) for n, wave in waves.items()})
    before, after = found
    return {n: np.where(time < 1, before[n], after[n]) for n in before}


def oscillator(velocity: bool, hardens: bool, brakes: bool = False) -> Program:
    """Its relation, with the position measured or the `velocity`; what `brakes` is a mode."""
    bench = Bench()
    p = bench.pool
    m, d, k, c = (bench.param(n, str(x)) for n, x in (("m", M), ("d", D), ("k", K), ("c", C)))
    u, measured = bench.input("u"), bench.sensor("v" if velocity else "y")
    y = p.integral(measured, bench.initial("y0", p.num(0))) if velocity else measured
    v = measured if velocity else p.der(measured)
    terms = [p.mul(m, p.der(v)), p.mul(d, v), p.mul(k, y)]
    if hardens:
        terms.append(p.mul(c, p.power(y, 3)))
    if brakes:
        on, b = bench.input("on", mode=True), bench.param("b", "1")
        terms.append(p.choose(on, p.mul(b, v), p.zero))
    return bench.program(p.add(*[(1, term) for term in terms], (-1, u)))


@pytest.mark.parametrize("brakes", [False, True])
@pytest.mark.parametrize("hardens", [False, True])
@pytest.mark.parametrize("velocity", [False, True])
def test_coarse_samples_of_a_resonance_leave_little(
    velocity: bool, hardens: bool, brakes: bool
) -> None:
    """At nine samples a period, and sixteen times less at eighteen: an error of fourth order.

    The trapezoid rule alone is off by (w T)^2/12, 4 % of the inertia and the spring that cancel in
    each other: 5 to 8 % of what drives the machine is left then.
    """
    left = []
    for rate in (620.0, 1240.0):
        time = np.arange(0, 3, 1 / rate)
        samples = swing(time, hardens)
        program = oscillator(velocity, hardens, brakes)
        assert bool(program.openings) == brakes  # then it comes from under a window
        options = {"sample_time": 1 / rate, "bandwidth": 400.0}
        own = "v" if velocity else "y"
        found = run(program, {"u": samples["u"], own: samples[own]}, "on", **options)
        drive = run(program, {"u": samples["u"], own: np.zeros(len(time))}, "on", **options)
        calm, all_ = (r[len(time) // 2 :] for r in (found, drive))
        left.append(np.max(np.abs(calm)) / np.max(np.abs(all_)))
    assert left[0] < 0.01
    assert left[1] < left[0] / 12


@pytest.mark.parametrize("levels", [1, 2, 3])
def test_coarse_samples_of_what_is_integrated_leave_little(levels: int) -> None:
    """A position from its rate, acceleration or jerk: the trapezoid rule is off by 4 % a level."""
    import sympy

    bench = Bench()
    p = bench.pool
    y, u, none = bench.sensor("y"), bench.input("u"), bench.initial("none", p.num(0))
    told = u
    for _ in range(levels):
        told = p.integral(told, none)
    program = bench.program(p.sub(y, told))
    t = sympy.Symbol("t")
    wave = sympy.sin(440 * t)
    start = wave * t**5 * (126 - 420 * t + 540 * t**2 - 315 * t**3 + 70 * t**4)
    left = []
    for rate in (620.0, 1240.0):
        time = np.arange(0, 2, 1 / rate)
        found = []
        for order in (0, levels):
            both = (sympy.lambdify(t, x.diff(t, order), "numpy")(time) for x in (start, wave))
            found.append(np.where(time < 1, *both))
        options = {"sample_time": 1 / rate, "bandwidth": 400.0}
        residual = run(program, {"y": found[0], "u": found[1]}, **options)
        size = run(program, {"y": found[0], "u": np.zeros(len(time))}, **options)
        later = slice(len(time) // 2, None)
        left.append(np.max(np.abs(residual[later])) / np.max(np.abs(size[later])))
    assert left[0] < 0.002
    assert left[1] < left[0] / 12


def test_doubles_arrays_and_forty_digits_are_one_program() -> None:
    bench = Bench()
    p = bench.pool
    level, q = bench.sensor("p"), bench.input("q")
    flow = p.mul(bench.param("k", "0.2"), p.fn("ssqrt", p.sub(level, p.num(3))))
    held = p.choose(p.compare("<", level, p.num(4)), flow, p.fn("pow", level, p.num(3)))
    program = bench.program(p.add((1, p.der(level)), (1, held), (-1, q)))
    double, lanes, sharp = Sampled(program), Lanes(program, {}), Evaluation(program)
    sharp.configure({f.name: value(f.default or 0.0) for f in program.params})
    states = None
    for k in range(40):
        given = {"p": 2.5 + 0.1 * k, "q": math.sin(k)}
        found = double.step(given).residuals["r1"]
        wide = {name: np.array([x, 2 * x]) for name, x in given.items()}
        residuals, states = lanes.sample(wide, {}, {}, {}, states)
        sharp.values |= {Ref("known", name): value(x) for name, x in given.items()}
        sharp.run(program.step if k else program.first)
        exact = sharp.values[Ref("residual", "r1")]
        assert residuals["r1"][0] == pytest.approx(found, rel=1e-13)
        assert residuals["r1"][1] != residuals["r1"][0]
        assert abs(found - float(exact)) <= 1e-14 * exact.size
