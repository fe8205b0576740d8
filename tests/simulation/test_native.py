"""Compiled rates and outputs are those of Python; runs are the same, whoever computes them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import cast

import numpy as np
import pytest

import bondgraph
from bondgraph.backends.rates import rate_file, rate_language
from bondgraph.compilation import Compilation
from bondgraph.compile_options import Options
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation import native_machine
from bondgraph.runtime.simulation.integrate import SimulationError
from bondgraph.runtime.simulation.native_machine import Coding, NativeMachine, Segment
from bondgraph.runtime.simulation.run import Run, _Simulation
from bondgraph.runtime.simulation.scenario import Scenario
from bondgraph.text.source import Source
from tests.simulation.machines import MODELS, example, near, opened, read

CODING = Coding(rate_language(), rate_file)
NAMES = sorted(p.stem for p in MODELS.glob("*.bg"))
ADVERSARY = Path(__file__).parents[1] / "adversary" / "models"
LAWS = ["accumulator", "arrays", "magnetic_core", "planetary", "relativistic", "table_law",
        "tf_ring_1", "three_thermometers"]  # fmt: skip
_DRAWS = 50


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))


def _pair(machine: Compilation, scenario: Scenario, worst: float) -> int:
    """Compares rates and outputs at random states and times; how many there were with a value.

    States are some units of effort or flow. `worst` is the difference of an entry, relative to it.
    """
    simulation = _Simulation(machine.equations, machine.integral, scenario, CODING)
    mode = simulation.mode(0.5)
    plain, native = mode.machine, cast(NativeMachine, mode.native)
    native.begin(Segment(0.0, scenario.duration, mode.inputs, simulation.given.moving(plain, 0.5)))
    native.compile()
    refused: list[float] = []

    def otherwise(t: float, x: Array) -> list[float]:
        refused.append(t)
        native.go_on()
        return [np.nan] * len(x)

    rates = native.rates(otherwise)
    assert rates is not None
    draw = np.random.default_rng(1)
    scale = plain.scale(0.0, [0.0] * len(plain.states), mode.inputs(0.0))
    times = draw.uniform(0.0, scenario.duration, _DRAWS)
    states = scale * draw.normal(size=(_DRAWS, len(scale)))
    found = 0
    for t, x in zip(times.tolist(), states, strict=True):
        expected = np.array(plain.rates(t, x.tolist(), mode.inputs(t)))
        own = np.array(rates(t, x))
        if np.isfinite(own).all():
            found += 1
            np.testing.assert_allclose(own, expected, rtol=worst, atol=0.0)
        else:
            assert refused.pop() == t
    outputs = native.outputs(times, states)
    assert outputs is not None
    for t, x, own, odd in zip(times.tolist(), states, *outputs, strict=True):
        if not odd:
            seen = np.array(plain.observe(t, x.tolist(), mode.inputs(t)))
            np.testing.assert_allclose(own, seen, rtol=worst, atol=0.0)
    return found


def _moving(machine: Compilation) -> Scenario:
    """Every input on a course of its own: expressions of time, and straight lines."""
    lines = []
    for k, item in enumerate(i for i in machine.graph.inputs if not i.mode and not i.of):
        course = f"0.1 + 0.3*sin({k + 2}*t)", f"{{table = [[0, 0], [0.3, {k + 1}], [1, -1]]}}"
        lines.append(f'"{item.name}" = ' + (course[1] if k % 2 else f'"{course[0]}"'))
    return read(machine, "duration = 1\n[inputs]\n" + "\n".join(lines))


@pytest.mark.parametrize("name", NAMES)
def test_rates_and_outputs_are_those_of_python(name: str) -> None:
    machine = example(name)
    assert _pair(machine, _moving(machine), 1e-12) == _DRAWS


@pytest.mark.parametrize("name", LAWS)
def test_so_are_those_of_other_laws(name: str) -> None:
    """Where a law has no value, as a root of what is negative, Python has to say so."""
    machine = bondgraph.compile(ADVERSARY / f"{name}.bg")
    values = [v for v in machine.graph.values if v.value is None]
    numbers = {v.name: 0.7 + 0.1 * k for k, v in enumerate(values)}
    scenario = _moving(machine)._replace(parameters=numbers)
    assert _pair(machine, scenario, 1e-12) > _DRAWS / 4


def test_a_map_is_read_as_in_python(tmp_path: Path) -> None:
    (tmp_path / "map.csv").write_text("0,0,1,2\n0,0,1,3\n1,2,4,5\n2,3,7,9\n")
    text = 'input w\n0:n\nn -> C:b = 2\nn -> R:v { f = table("map.csv", e, w) }\nSf:i -> n'
    machine = Compilation(
        Source(str(tmp_path / "m.bg"), f"bg 1\nmodel M {{\n{text}\n}}\n"), None, Options()
    )
    assert _pair(machine, _moving(machine), 1e-12) == _DRAWS


def test_a_loop_that_has_to_be_iterated_stays_in_python(tmp_path: Path) -> None:
    machine = opened("Se:U -> 1:i\ni -> R:d { e = f + f^3 }\ni -> R:r = 1\ni -> C:c = 1")
    told: list[str] = []
    _run(machine, 'inputs.U = "sin(t)"', tell=told.append)
    assert told == [] and list(tmp_path.glob("**/*.so")) == []


# ------------------------------------------------------------------------------------------- runs

#: q' = U - q from q = 0, where U is the acting input: a scenario, and q by hand.
LAG = "Se:U -> 1:i\ni -> R:r = 1\ni -> C:c = 1\ni -> Df:y"
MOTIONS: dict[str, tuple[str, Callable[[Array], Array]]] = {
    "expression": ('inputs.U = "2*exp(-2*t)"', lambda t: 2 * np.exp(-t) - 2 * np.exp(-2 * t)),
    "straight lines": ("inputs.U = {table = [[0, 0], [9, 9]]}", lambda t: t - 1 + np.exp(-t)),
    "jump": ('inputs.U = "if(t > 1, 5, 0)"', lambda t: 5 * _since(t, 1)),
    "steps": (
        'inputs.U = {table = [[0, 0], [1, 5], [2, 1]], hold = "previous"}',
        lambda t: 5 * _since(t, 1) - 4 * _since(t, 2),
    ),
    "ramp of a fault": (
        'inputs.U = 1\n[[fault]]\nof = "U"\nchange = "+= 4"\nat = 1\nramp = 1',
        lambda t: _since(t, 0) + 4 * (_risen(t, 1) - _risen(t, 2)),
    ),
    "late command": ('inputs.V = "t"', lambda t: _risen(t, 0.5)),
}


def _since(t: Array, jump: float) -> Array:
    """The answer to one that is there from a moment on."""
    return np.where(t > jump, 1 - np.exp(-np.maximum(t - jump, 0)), 0.0)


def _risen(t: Array, bend: float) -> Array:
    """The answer to what rises by one a second from a moment on."""
    s = np.maximum(t - bend, 0)
    return s - 1 + np.exp(-s)


def _run(
    machine: Compilation, scenario: str, *, tell: Callable[[str], None] | None = None,
    native: bool = True,
) -> Run:  # fmt: skip
    text = f"duration = 3\nsampling.rate = 50\ntolerance = 1e-9\n{scenario}"
    return machine.simulate(read(machine, text), tell=tell, native=native)


@pytest.fixture
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Machines are compiled with their first rate."""
    monkeypatch.setattr(native_machine, "WORTH", 1)


@pytest.mark.usefixtures("at_once")
@pytest.mark.parametrize("name", MOTIONS)
def test_motions_by_hand(name: str, tmp_path: Path) -> None:
    scenario, expected = MOTIONS[name]
    late = LAG.replace("Se:U", "input V\nSe:U = delay(V, 0.5)")
    found = _run(opened(late if "V" in scenario else LAG), scenario).truth
    assert list(tmp_path.glob("**/*.so"))
    assert near(found.columns["c.q"], expected(found.time), 1e-6)


@pytest.mark.usefixtures("at_once")
@pytest.mark.parametrize("method", ["LSODA", "Radau", "BDF", "DOP853", "RK45", "RK23"])
def test_every_method_runs_on_compiled_rates(method: str) -> None:
    scenario, expected = MOTIONS["straight lines"]
    found = _run(opened(LAG), f'method = "{method}"\n{scenario}').truth
    assert near(found.columns["c.q"], expected(found.time), 1e-6)


@pytest.mark.usefixtures("at_once")
@pytest.mark.parametrize("law", ["f = sqrt(c.q)*3", "f = -e^2"])
def test_where_a_machine_cannot_go_on_both_say_the_same(law: str) -> None:
    machine = opened(f"0:n\nn -> C:c(q0 = 1) = 1\nn -> R:out {{ {law} }}\nn -> De:y")
    messages = []
    for native in (True, False):
        with pytest.raises(SimulationError) as caught:
            _run(machine, "", native=native)
        messages.append(str(caught.value))
    assert messages[0] == messages[1]


@pytest.mark.usefixtures("at_once")
@pytest.mark.parametrize(
    ("compiler", "why"), [("no-such-compiler", "no C compiler"), ("false", "does not compile")]
)
def test_python_goes_on_where_nothing_compiles(
    compiler: str, why: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CC", compiler)
    told: list[str] = []
    machine, (scenario, _) = opened(LAG), MOTIONS["expression"]
    found = _run(machine, scenario, tell=told.append).truth.columns
    plain = _run(machine, scenario, native=False).truth.columns
    assert len(told) == 1 and why in told[0] and "Python" in told[0] and "\n" not in told[0]
    assert all(np.array_equal(found[n], plain[n]) for n in plain)
    with pytest.warns(RuntimeWarning, match=why):
        _run(machine, scenario)


def test_short_runs_are_not_compiled(tmp_path: Path) -> None:
    _run(opened(LAG), "inputs.U = 1")
    assert list(tmp_path.glob("**/*.so")) == []


@pytest.mark.usefixtures("at_once")
def test_machines_with_other_numbers_share_a_library(tmp_path: Path) -> None:
    machine = opened("param r = 1 +- 20%\nSe:U -> 1:i\ni -> R:r\ni -> C:c = 1\ni -> Df:y")
    ends = []
    for seed in (1, 2, 3):
        found = _run(machine, f'spread = "uniform"\nseed = {seed}\ninputs.U = "t"')
        r, t = found.parameters["r"], found.truth.time
        expected = t - r + r * np.exp(-t / r)
        assert near(found.truth.columns["c.q"], expected, 1e-6)
        ends.append(r)
    assert len(set(ends)) == 3 and len(list(tmp_path.glob("**/*.so"))) == 1
