"""The monitor as an FMU: what `step` says, whoever asks, and refusals in words."""

from __future__ import annotations

import subprocess
import zipfile
from collections.abc import Callable

import numpy as np
import pytest

import bondgraph
from tests.fmu.instances import BANDWIDTH, MODELS, RATE, VERSIONS, Folder, Instance, fmpy

ROWS = 400
Of = Callable[[str], Folder]


def samples(of: Folder, rows: int = ROWS, seed: int = 1) -> np.ndarray:
    """Samples that mean nothing, of every signal of the monitor."""
    draw = np.random.default_rng(seed)
    return draw.standard_normal((rows, len(of.compilation.engine().signals)))


def signals(of: Folder) -> list[str]:
    return [known.path for known in of.compilation.engine().signals]


def run(instance: Instance, names: list[str], rows: np.ndarray, at: int = 0) -> np.ndarray:
    """The outputs after each sample."""
    outputs = instance.names("output")
    found = []
    for k, row in enumerate(rows, at):
        instance.set(**dict(zip(names, row.tolist(), strict=True)))
        instance.step(k / RATE)
        found.append(instance.get(*outputs))
    return np.array(found)


def parts(found: np.ndarray) -> list[np.ndarray]:
    """Residuals, valid, thresholds, fired."""
    return np.split(found, 4, axis=1)


@pytest.mark.parametrize("version", VERSIONS)
def test_fmpy_simulates_what_the_engine_runs(folder: Of, version: str) -> None:
    of = folder("khepera")
    rows, names = samples(of), signals(of)
    given = np.zeros(ROWS, dtype=[("time", float), *[(name, float) for name in names]])
    given["time"] = np.arange(ROWS) * (1 / RATE)  # as FMPy counts
    for name, column in zip(names, rows.T, strict=True):
        given[name] = column
    found = fmpy.simulate_fmu(
        str(of.path("monitor", version)), stop_time=ROWS / RATE, output_interval=1 / RATE,
        input=given,
    )  # fmt: skip
    expected = of.compilation.engine().run(rows)
    assert expected.valid[-1].any() and not expected.valid[0].any()
    for k in range(expected.value.shape[1]):
        own = f"r{k + 1}"
        valid = found[f"valid.{own}"][1:].astype(bool)  # the sample of a row is in the next one
        assert np.array_equal(valid, expected.valid[:, k])
        residual, threshold = found[f"residual.{own}"][1:], found[f"threshold.{own}"][1:]
        assert np.array_equal(residual[valid], expected.value[valid, k])
        assert np.array_equal(threshold[valid], expected.bound[valid, k])
        fired = found[f"fired.{own}"][1:].astype(bool)
        beyond = (np.abs(expected.value[:, k]) > expected.bound[:, k]) & (expected.bound[:, k] > 0)
        assert np.array_equal(fired, valid & beyond)


@pytest.mark.parametrize("version", VERSIONS)
def test_a_hundred_instances_know_nothing_of_each_other(folder: Of, version: str) -> None:
    of = folder("quarter_car")
    engine, names = of.compilation.engine(), signals(of)
    masses = [300.0 + k for k in range(100)]
    tables = [samples(of, 60, seed=k) for k in range(100)]
    every = [Instance(of, "monitor", version) for _ in masses]
    for instance, mass in zip(every, masses, strict=True):
        instance.start(ms=mass)
    found: list[list[list[float]]] = [[] for _ in every]
    outputs = every[0].names("output")
    for k in range(60):  # all of them at one time
        for own, instance, rows in zip(found, every, tables, strict=True):
            instance.set(**dict(zip(names, rows[k].tolist(), strict=True)))
            instance.step(k / RATE)
            own.append(instance.get(*outputs))
    last = set()
    for own, mass, rows in zip(found, masses, tables, strict=True):
        residual, valid = parts(np.array(own))[:2]
        expected = engine.configured({"ms": mass}).run(rows)
        good = valid.astype(bool)
        assert np.array_equal(good, expected.valid) and good[-1].any()
        assert np.array_equal(residual[good], expected.value[good])
        last.add(tuple(residual[-1]))
    assert len(last) == 100
    for instance in every:
        instance.close()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_saved_state_goes_on_as_the_first_time(folder: Of, version: str) -> None:
    of = folder("khepera")
    rows, names = samples(of), signals(of)
    one = Instance(of, "monitor", version)
    one.start()
    run(one, names, rows[:200])
    kept = one.state("get")()
    bytes_ = one.state("serialize")(kept)
    first = run(one, names, rows[200:], 200)
    one.state("set")(kept)
    assert np.array_equal(run(one, names, rows[200:], 200), first)
    other = Instance(of, "monitor", version)
    other.start()
    other.state("set")(other.state("deserialize")(bytes_))
    assert np.array_equal(run(other, names, rows[200:], 200), first)
    one.state("free")(kept)
    with pytest.raises(fmpy.fmi1.FMICallException):
        other.state("deserialize")(b"\0" * len(bytes_))
    assert "are no state of khepera_monitor" in other.said[-1]
    one.close(), other.close()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_changed_parameter_configures_anew(folder: Of, version: str) -> None:
    of = folder("quarter_car")
    rows, names = samples(of), signals(of)
    one = Instance(of, "monitor", version)
    one.start()
    run(one, names, rows[:100])
    one.set(cs=2000.0)
    residual, valid = parts(run(one, names, rows[100:], 100))[:2]
    expected = of.compilation.engine().configured({"cs": 2000.0}).run(rows[100:])
    good = valid.astype(bool)
    assert np.array_equal(good, expected.valid) and not good[0].any() and good[-1].any()
    assert np.array_equal(residual[good], expected.value[good])
    one.close()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_margin_is_added_and_starts_nothing_anew(folder: Of, version: str) -> None:
    of = folder("quarter_car")
    rows, names = samples(of), signals(of)
    bound, value = of.compilation.engine().run(rows)[2], of.compilation.engine().run(rows)[0]
    one = Instance(of, "monitor", version)
    one.start()
    run(one, names, rows[:200])
    margin = float(np.median(np.abs(value[200:, 0]) - bound[200:, 0]))
    one.set(**{"margin.r1": margin})
    found = parts(run(one, names, rows[200:], 200))
    assert found[1][:, 0].all()
    assert np.array_equal(found[2][:, 0], margin + bound[200:, 0])
    fired = found[3][:, 0].astype(bool)
    assert np.array_equal(fired, np.abs(value[200:, 0]) > margin + bound[200:, 0])
    assert fired.any() and not fired.all()
    one.close()


@pytest.mark.parametrize("version", VERSIONS)
def test_what_cannot_be_is_an_error_with_a_message(folder: Of, version: str) -> None:
    error = fmpy.fmi1.FMICallException
    one = Instance(folder("quarter_car"), "monitor", version)
    with pytest.raises(error):
        one.step(0.0)
    assert one.said == ["doStep is called before initialization, and belongs after it was"
                        " initialized"]  # fmt: skip
    one.start()
    with pytest.raises(error):
        one.set(ms=float("nan"))
    assert one.said[-1].startswith("the parameter `ms` takes no ")
    with pytest.raises(error):
        one.set(**{"residual.r1": 1.0})
    assert one.said[-1] == "`residual.r1` is computed here and cannot be set"
    with pytest.raises(error):
        one.step(0.0, 0.002)
    assert one.said[-1] == (
        "the communication step is 0.002 s; the monitor takes samples every 0.001 s"
    )
    one.step(0.0)
    with pytest.raises(error):
        one.step(0.5)
    assert one.said[-1] == "doStep begins at 0.5 s; the last one ended at 0.001 s"
    one.close()


@pytest.mark.parametrize("version", VERSIONS)
def test_parameters_without_a_finite_coefficient_are_refused(folder: Of, version: str) -> None:
    one = Instance(folder("two_tanks"), "monitor", version)
    with pytest.raises(fmpy.fmi1.FMICallException):
        one.start(rho=0.0)
    assert one.said[-1].startswith("the monitor cannot be configured: the parameters make")
    one.set(rho=998.0)
    one.fmu.exitInitializationMode()
    one.step(0.0)
    one.close()


def test_the_same_model_gives_the_same_bytes(folder: Of) -> None:
    of = folder("quarter_car")
    again = bondgraph.compile(MODELS / "quarter_car.bg", targets=["fmu"], bandwidth=BANDWIDTH)
    made = {artifact.path: artifact.data for artifact in again.artifacts}
    assert len(made) == len(of.paths)
    for path, data in made.items():
        assert (of.home / path).read_bytes() == data


@pytest.mark.parametrize("version", VERSIONS)
def test_the_sources_are_whole(folder: Of, version: str, tmp_path) -> None:
    """A compiler that is strict takes what the description lists, and nothing else."""
    with zipfile.ZipFile(folder("khepera").path("monitor", version)) as archive:
        archive.extractall(tmp_path)
    sources = tmp_path / "sources"
    (build,) = fmpy.read_model_description(str(tmp_path)).buildConfigurations
    (listed,) = [files.sourceFiles for files in build.sourceFileSets]
    assert {p.name for p in sources.glob("*.c")} == set(listed)
    flags = "-std=c99 -O0 -Wall -Wextra -Wpedantic -Werror -fPIC -shared".split()
    done = subprocess.run(
        ["cc", *flags, *listed, "-lm", "-o", "whole.so"], cwd=sources, capture_output=True
    )
    assert done.returncode == 0, done.stderr.decode()
