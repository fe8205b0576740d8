"""The machine as an FMU: the motion that `simulate` finds, faults by parameters, refusals."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.linalg import expm

import bondgraph
from bondgraph.runtime.log import Log
from tests.fmu.instances import RATE, VERSIONS, Folder, Instance, fmpy

validate_fmu = pytest.importorskip("fmpy.validation").validate_fmu
Of = Callable[[str], Folder]

#: Of the largest value of a sensor: how far apart the two integrators may be, whose steps have
#: relative tolerances of 1e-7 both.
NEAR = 2e-6


def simulated(
    of: Folder, inputs: dict[str, tuple[tuple[float, float], ...]], duration: float, rate: float,
    faults: tuple[bondgraph.Fault, ...] = (),
) -> Log:  # fmt: skip
    """True values of a run in which inputs jump from point to point."""
    courses = {n: bondgraph.Course(None, points, hold=True) for n, points in inputs.items()}
    sampling = bondgraph.Sampling(rate)
    scenario = bondgraph.Scenario(
        "run", duration=duration, inputs=courses, sampling=sampling, faults=faults
    )
    return of.compilation.simulate(scenario).truth


def stepped(
    instance: Instance, inputs: dict[str, tuple[tuple[float, float], ...]], duration: float,
    rate: float, changes: dict[float, dict[str, float]] | None = None,
) -> dict[str, np.ndarray]:  # fmt: skip
    """The outputs of an instance at the same times, parameters changed at some of them."""
    names, rows = instance.names("output"), []
    for k in range(round(duration * rate) + 1):
        t = k / rate
        now = {n: next(v for at, v in reversed(p) if at <= t) for n, p in inputs.items()}
        if k == 0:
            instance.start(**now)
        else:
            instance.step((k - 1) / rate, 1 / rate)
            instance.set(**now)
        instance.set(**(changes or {}).get(t, {}))
        rows.append(instance.get(*names))
    return dict(zip(names, np.array(rows).T, strict=True))


RUNS = {
    "khepera": (
        {"U0[1]": ((0.0, 3.0), (0.1, -1.0)), "U0[2]": ((0.0, 2.0),), "Uin": ((0.0, 5.0),),
         "Fx[1]": ((0.0, 0.0), (0.05, 0.02)), "Fx[2]": ((0.0, 0.0),)}, 0.2, 1000.0),
    "two_tanks": ({"Q": ((0.0, 1e-4), (200.0, 3e-5))}, 400.0, 1.0),
    "quarter_car": ({"road": ((0.0, 0.0), (0.5, 0.2), (0.7, -0.1), (1.0, 0.0))}, 1.5, 200.0),
}  # fmt: skip


@pytest.mark.parametrize("kind", ["monitor", "machine"])
@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("model", RUNS)
def test_fmpy_finds_nothing_to_say(folder: Of, model: str, version: str, kind: str) -> None:
    assert validate_fmu(str(folder(model).path(kind, version))) == []


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("model", RUNS)
def test_it_moves_as_in_the_simulator(folder: Of, model: str, version: str) -> None:
    of, run = folder(model), RUNS[model]
    instance = Instance(of, "machine", version)
    found, expected = stepped(instance, *run), simulated(of, *run).columns
    assert set(found) == {s.name for s in of.compilation.graph.sensors}
    for name, column in found.items():
        size = np.abs(expected[name]).max()
        assert size > 0 and np.abs(column - expected[name]).max() < NEAR * size, name
    instance.close()


@pytest.mark.parametrize("version", VERSIONS)
def test_fmpy_runs_it_with_steps_of_its_own(folder: Of, version: str) -> None:
    """A motor at 12 V, against the exponential of its matrix."""
    R, k, J, f = 17.6, 3.51e-3, 1.4e-8, 1.19e-5
    matrix = np.array([[-R, -k], [k, -f]]) / [[3e-4], [J]]
    source = np.array([12.0 / 3e-4, -1e-3 / J])
    rest = -np.linalg.solve(matrix, source)
    found = fmpy.simulate_fmu(
        str(folder("dc_motor").path("machine", version)), start_values={"U": 12.0, "load": 1e-3},
        stop_time=0.05, output_interval=0.004, relative_tolerance=1e-9,
    )  # fmt: skip
    assert len(found) == 14  # 0.05 s is no multiple of 4 ms
    for row in found:
        exact = rest - expm(matrix * row["time"]) @ rest
        assert abs(row["current"] - exact[0]) < 1e-7 * abs(rest[0])
        assert abs(row["speed"] - exact[1]) < 1e-7 * abs(rest[1])


@pytest.mark.parametrize("version", VERSIONS)
def test_a_hundred_motors_at_once(folder: Of, version: str) -> None:
    of = folder("dc_motor")
    resistances = [10.0 + k / 7 for k in range(100)]
    every = [Instance(of, "machine", version) for _ in resistances]
    for instance, resistance in zip(every, resistances, strict=True):
        instance.start(R=resistance, U=6.0)
    for k in range(20):
        for instance in every:
            instance.step(k / RATE)
    for instance, R in zip(every, resistances, strict=True):
        matrix = np.array([[-R, -3.51e-3], [3.51e-3, -1.19e-5]]) / [[3e-4], [1.4e-8]]
        rest = -np.linalg.solve(matrix, [6.0 / 3e-4, 0.0])
        exact = rest - expm(matrix * 0.02) @ rest
        assert instance.get("current", "speed") == pytest.approx(exact, rel=NEAR)
        instance.close()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_leak_that_opens_is_that_of_the_simulator(folder: Of, version: str) -> None:
    """The leak is zero in the model: it has to be in the equations all the same."""
    of, (inputs, duration, rate) = folder("two_tanks"), RUNS["two_tanks"]
    leak = bondgraph.Fault("leak", "=", 4e-7, at=100.0)
    expected = simulated(of, inputs, duration, rate, (leak,)).columns
    healthy = simulated(of, inputs, duration, rate).columns
    instance = Instance(of, "machine", version)
    found = stepped(instance, inputs, duration, rate, {100.0: {"leak": 4e-7}})
    for name in ("p1", "p2"):
        size = np.abs(expected[name]).max()
        assert np.abs(found[name] - expected[name]).max() < NEAR * size
        assert np.abs(expected[name] - healthy[name]).max() > 0.05 * size
    instance.close()


#: By model a fault, what it makes of the parameter, and the margins of the residuals in their
#: units: what sampling makes of a jump is less, what the fault does is more.
FAULTS = {
    "khepera": ("m[1].el.Re", 1.5, (0.05, 0.5, 0.05, 0.5, 0.05)),  # V, rad/s, V, rad/s, V
    "quarter_car": ("cs", 0.5, (1.0, 1e-3)),  # N, m/s
    "two_tanks": ("k12", 0.7, (1e-6, 1e-6)),  # m^3/s
}


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("model", FAULTS)
def test_the_monitor_tells_what_is_changed_in_the_machine(
    folder: Of, model: str, version: str
) -> None:
    of, rows = folder(model), 800
    fault, factor, margins = FAULTS[model]
    machine, monitor = (Instance(of, kind, version) for kind in ("machine", "monitor"))
    taken = monitor.names("input")
    own = [name for name in taken if name in machine.variables]
    residuals = of.compilation.signatures.residuals
    names = [f"fired.{r}" for r in residuals]

    def run(first: int, count: int) -> np.ndarray:
        found = []
        for k in range(first, first + count):
            t = k / RATE
            machine.set(**{n: driven(n, t) for n in machine.names("input")})
            now = dict(zip(own, machine.get(*own), strict=True))
            monitor.set(**now)
            machine.step(t)
            monitor.step(t)
            found.append(monitor.get(*names))
        return np.array(found)

    def driven(name: str, t: float) -> float:
        if name == "Uin":
            return 5.0
        size = {"Q": 1e-4, "road": 0.3}.get(name, 3.0 if name.startswith("U0") else 0.0)
        return size * (1.5 + math.sin(8.0 * t))

    assert set(own) == set(taken)
    machine.start()
    monitor.start(**{f"margin.{r}": m for r, m in zip(residuals, margins, strict=True)})
    assert not run(0, rows).any()
    machine.set(**{fault: factor * machine.get(fault)[0]})
    fired = run(rows, rows).any(axis=0)
    assert dict(zip(residuals, fired.tolist(), strict=True)) == {
        r: fault in of.compilation.signatures.signature(r) for r in residuals
    }
    machine.close(), monitor.close()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_saved_machine_goes_on_as_the_first_time(folder: Of, version: str) -> None:
    of = folder("quarter_car")
    one = Instance(of, "machine", version)
    one.start(road=0.2)
    for k in range(50):
        one.step(k / RATE)
    kept = one.state("get")()
    before, first = one.get(*one.names("output")), []
    for k in range(50, 80):
        one.step(k / RATE)
        first.append(one.get(*one.names("output")))
    one.set(cs=100.0)  # a state has the parameters too
    one.state("set")(kept)
    assert one.get(*one.names("output")) == before and one.get("cs") == [1000.0]
    for k, row in enumerate(first, 50):
        one.step(k / RATE)
        assert one.get(*one.names("output")) == row
    one.state("free")(kept)
    one.close()


DISC = """bg 1
model Disc {
    param J = 0.01 kg.m^2
    param d = 0.02 N.m.s/rad
    Se:M -> 1:w
    w -> I:J
    w -> R:d
    w -> Df:speed
    sensor angle : rad = int(w.f) counts 500/turn
}
"""


@pytest.mark.parametrize("version", VERSIONS)
def test_an_encoder_counts(folder: Of, version: str) -> None:
    """Backwards, under a constant torque, by the solution on paper."""
    one = Instance(folder(DISC), "machine", version)
    found = stepped(one, {"M": ((0.0, -0.05),)}, 2.0, 100.0)
    t = np.arange(201) / 100.0
    turned = -2.5 * (t - 0.5 * (1 - np.exp(-2.0 * t))) * 500 / (2 * math.pi)
    assert turned[-1] < -200
    clear = np.abs(turned - np.round(turned)) > 1e-3  # from where the next count begins
    assert clear.sum() > 190
    assert np.array_equal(found["angle"][clear], np.floor(turned[clear]))
    one.close()


@pytest.mark.parametrize("version", VERSIONS)
def test_what_a_machine_cannot_do_is_an_error_with_a_message(folder: Of, version: str) -> None:
    error = fmpy.fmi1.FMICallException
    one = Instance(folder("dc_motor"), "machine", version)
    with pytest.raises(error):
        one.start(L=0.0)
    assert one.said[-1].startswith("at 0 s a law or a loop of the machine has no value")
    one.set(L=3e-4)
    one.fmu.exitInitializationMode()
    with pytest.raises(error):
        one.set(**{"start.J.p": 1.0})
    assert one.said[-1] == "`start.J.p` can only be set before the end of initialization"
    with pytest.raises(error):
        one.set(R=float("inf"))
    assert one.said[-1] == "the parameter `R` takes no inf: give it a finite number"
    one.set(f=-1e9)  # what drives itself
    with pytest.raises(error):
        for k in range(100):
            one.set(U=1.0)
            one.step(k / RATE)
    assert one.said[-1].startswith("the machine cannot go on at ")
    one.close()


RESISTOR = "bg 1\nmodel Resistor { param R = 2 Ohm; Se:U -> 1:i; i -> R:R; i -> Df:y }"


@pytest.mark.parametrize("version", VERSIONS)
def test_outputs_follow_what_is_set(folder: Of, version: str) -> None:
    """A machine without states shows at once what inputs and parameters make of its sensors."""
    one = Instance(folder(RESISTOR), "machine", version)
    one.start(U=3.0)
    assert one.get("y") == [1.5]
    one.set(U=5.0)
    assert one.get("y") == [2.5]
    one.step(0.0, 0.25)
    one.set(R=4.0)
    assert one.get("y") == [1.25]
    one.close()


REFUSED = {
    "switch": ("input on : bool\nparam C = 1 mF; param R = 1 Ohm\n"
               "Se:U -> 1:k when on { -> u }\n0:u { -> C:C; -> R:R; -> De:y }",
               "`on` turns a switch"),
    "late": ("param C = 1 mF; param R = 1 Ohm\nSe:U -> 1:i -> 0:u -> C:C; i -> R:R\n"
             "sensor y = delay(u.e, 1 ms)", "`y` is delayed"),
    "imposed": ("param J = 1 kg.m^2\nSf:w -> 1:j\nj -> I:J\nj -> Df:y\nsensor z = J.e",
                "derivative of `w`"),
    "iterated": ("param R = 2 Ohm; param a = 1 V.A^-5\n"
                 "Se:U -> 1:i -> R:R { e = R*f + a*f^5 }\ni -> Df:y",
                 "has to be iterated"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_has_no_machine_fmu_is_told_with_its_place(name: str) -> None:
    text, why = REFUSED[name]
    of = bondgraph.compile(text=f"bg 1\nmodel M {{\n{text}\n}}", targets=["fmu"])
    paths = [artifact.path for artifact in of.artifacts]
    assert paths == ["fmi2/m_monitor.fmu", "fmi3/m_monitor.fmu"]
    (told,) = [d for d in of.report.diagnostics if d.code == "no-machine-fmu"]
    assert why in told.message and told.severity == "warning" and told.help
    assert told.labels and told.labels[0].span.line > 2
