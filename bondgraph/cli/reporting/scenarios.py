"""Scenarios for a report: simulated, watched, and brought to what the page shows."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import numpy.typing as npt

from bondgraph import Compilation
from bondgraph.backends.report.episode import (
    Array,
    Curve,
    Episode,
    Mark,
    Panel,
    Plane,
    Said,
    Trace,
)
from bondgraph.runtime.monitoring.verdict import Verdict, described
from bondgraph.runtime.monitoring.watch_settings import engine_of
from bondgraph.runtime.monitoring.whole_logs import on_grid
from bondgraph.runtime.simulation.dead_reckoning import Desired, Reckoning
from bondgraph.runtime.simulation.integrate import SimulationError
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.runtime.simulation.run import Run
from bondgraph.runtime.simulation.scenario import Course, Sampling, Scenario
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.moment import often
from bondgraph.text.numerals import listed
from bondgraph.text.tuples import NamedTuple

_TOGETHER = 4  # signals of one unit in one panel
_PANELS = 8  # of an episode


class Watched(NamedTuple):
    """What the residuals of a run were, on the grid of their code: (n,), and (n, columns)."""

    time: Array
    samples: Array
    value: Array
    valid: npt.NDArray[np.bool_]
    bound: Array
    verdicts: tuple[Verdict, ...]


def simulated(
    compilation: Compilation, path: str, progress: Callable[[float], None] = lambda _: None
) -> Run:
    """The scenario of a file as it goes.

    Raises `CompileError` where the scenario is wrong, Trouble where it cannot be run.
    """
    scenario = compilation.scenario(path)
    try:
        return compilation.simulate(scenario, progress)
    except SimulationError as error:
        raise Trouble(f"{path}: {error}") from error
    except KeyError as error:
        raise Trouble(f"{path}: `{error.args[0]}` has no value") from error


def played(compilation: Compilation, run: Run) -> Episode:
    """A run with a monitor at the rate of its samples."""
    rated = at_rate(compilation, run.scenario)
    return episode(rated, run, watched(rated, run))


def at_rate(compilation: Compilation, scenario: Scenario) -> Compilation:
    """The compilation at the rate of the samples of a scenario."""
    rate = scenario.sampling.rate
    return compilation if rate == compilation.options.rate else compilation.with_options(rate=rate)


def episode(compilation: Compilation, run: Run, seen: Watched | None) -> Episode:
    """A run, and what the monitor of a compilation at its rate saw of it, for people."""
    scenario = run.scenario
    time = run.log.time if seen is None else seen.time
    return Episode(
        scenario.name,
        scenario.doc,
        time,
        () if seen is None else tuple(_traces(compilation, seen)),
        tuple(_panels(compilation, run, seen)),
        tuple(_planes(compilation, run)),
        tuple(sorted(_marks(scenario))),
        () if seen is None else tuple(_said(seen)),
        tuple(_facts(run)),
    )


def watched(compilation: Compilation, run: Run) -> Watched | None:
    """The run through the monitor's clock, engine and decision; None without any residual."""
    if not compilation.residuals:
        return None
    engine = engine_of(compilation)
    decision = compilation.diagnosis(engine)
    parts, verdicts = [], []
    for piece in on_grid(engine, run.log):
        if piece.anew:
            engine.reset()
            decision.restart()
        verdicts += decision.update(piece.time, engine.run(piece.samples), piece.samples)
        parts.append((piece.time, piece.samples, *decision.decided()))
    if not parts:
        return None
    time, samples, value, valid, bound = map(np.concatenate, zip(*parts, strict=True))
    return Watched(time, samples, value, valid, bound, tuple(verdicts))


def _traces(compilation: Compilation, seen: Watched) -> Iterator[Trace]:
    """The residuals, each with the whole threshold that it is decided by."""
    units = compilation.residual_units
    for k, info in enumerate(compilation.program.residuals):
        if not info.unavailable:
            unit = units.get(info.path, "")
            yield Trace(info.path, seen.value[:, k], unit, seen.bound[:, k], seen.valid[:, k])


def _panels(compilation: Compilation, run: Run, seen: Watched | None) -> Iterator[Panel]:
    """The known signals, those of one unit together."""
    if seen is None:
        columns, units = run.log.columns, run.log.units
    else:
        knowns = compilation.program.knowns
        columns = {k.path: seen.samples[:, at] for at, k in enumerate(knowns)}
        units = {k.path: "count" if k.counts is not None else k.unit for k in knowns}
    by_unit: dict[str, list[Trace]] = {}
    for name, values in columns.items():
        if not np.isnan(values).all():
            by_unit.setdefault(units.get(name, ""), []).append(Trace(name, values))
    parts = [
        (unit, tuple(traces[k : k + _TOGETHER]))
        for unit, traces in by_unit.items()
        for k in range(0, len(traces), _TOGETHER)
    ]
    for unit, some in parts[:_PANELS]:
        yield Panel(some[0].name if len(some) == 1 else "signals", unit, some)


def _planes(compilation: Compilation, run: Run) -> Iterator[Plane]:
    """The way of a vehicle in the plane: as it should be, by its signals, and a healthy twin's."""
    plane = run.scenario.plane
    if plane is None:
        return
    values = Values(compilation.graph, run.scenario.parameters)
    names = (plane.x, plane.y)
    curves = []
    desired = Desired(compilation.equations, run.scenario, values)
    wanted = Reckoning(compilation.equations, names, values, counts=False)
    if len(wanted.names) == 2 and set(wanted.signals) <= set(desired.names):
        way = wanted.feed(run.log.time, desired.at(run.log.time))
        curves.append(Curve("desired", way[plane.x], way[plane.y]))
    twin = compilation.simulate(healthy_twin(run))
    curves.append(Curve("virtual", twin.truth.columns[plane.x], twin.truth.columns[plane.y]))
    reckoned = Reckoning(compilation.equations, names, values)
    if len(reckoned.names) == 2:
        way = reckoned.feed(run.log.time, run.log.columns)
        curves.append(Curve("real", way[plane.x], way[plane.y]))
    yield Plane("The way in the plane", f"{plane.x} in m", f"{plane.y} in m", tuple(curves))


def healthy_twin(run: Run) -> Scenario:
    """The nominal machine under the same commands, with nothing wrong and perfect instruments."""
    scenario = run.scenario
    driven = {}
    for controller in scenario.controllers:
        column = run.log.columns[controller.input]
        jumps = np.concatenate([[True], np.diff(column) != 0])
        points = zip(run.log.time[jumps].tolist(), column[jumps].tolist(), strict=True)
        driven[controller.input] = Course(None, tuple(points), hold=True)
    return scenario._replace(
        faults=(),
        spread="none",
        controllers=(),
        instruments={},
        inputs={**scenario.inputs, **driven},
        sampling=Sampling(scenario.sampling.rate),
    )


def _marks(scenario: Scenario) -> Iterator[Mark]:
    for fault in scenario.faults:
        yield Mark(fault.at, fault.label)
        if fault.until < scenario.duration:
            yield Mark(fault.until, f"{fault.label}: over")


def _said(seen: Watched) -> Iterator[Said]:
    """A fault is said until something else is said of it, the warm-up from the start."""
    about = [v for v in seen.verdicts if v.event in ("fault", "update", "cleared")]
    for verdict in seen.verdicts:
        text = verdict.message or described(verdict)
        if verdict.event == "warm-up":
            yield Said("warm-up", float(seen.time[0]), verdict.time, "warm-up", text)
        elif verdict.event in ("fault", "update"):
            end = next((v.time for v in about if v.time > verdict.time), None)
            names = [c.fault for c in verdict.candidates] or list(verdict.group)
            short = listed(names, "or", 3) if names else ""  # what it is, the next one says
            yield Said("fault", verdict.time, end, short, text, verdict.since)
        else:
            yield Said(verdict.event, verdict.time, verdict.time, verdict.event, text)


def _facts(run: Run) -> Iterator[tuple[str, str]]:
    scenario = run.scenario
    sampling = f"{scenario.duration:g} s at {often(scenario.sampling.rate)}"
    if scenario.sampling.jitter:
        sampling += f", jitter {100 * scenario.sampling.jitter:g} %"
    if scenario.sampling.lost:
        sampling += f", {100 * scenario.sampling.lost:g} % lost"
    yield "Virtual machine", f"{sampling}, seed {scenario.seed}"
    if run.static:
        yield "At rest", f"{', '.join(run.static)} (quasi-static)"
