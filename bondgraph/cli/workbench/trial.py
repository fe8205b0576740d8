"""A run that a page asks for: a scenario of its settings, simulated, watched, as curves."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from bondgraph import Compilation
from bondgraph.backends.report.episode import Array, Episode, Trace, envelope
from bondgraph.cli.live import targets
from bondgraph.cli.reporting.scenarios import Watched, at_rate, episode, watched
from bondgraph.cli.workbench.derived import helping
from bondgraph.runtime.live.messages import short
from bondgraph.runtime.live.setup import wish
from bondgraph.runtime.monitoring.verdict import described
from bondgraph.runtime.simulation.integrate import SimulationError
from bondgraph.runtime.simulation.read_scenario import read_scenario
from bondgraph.runtime.simulation.run import Run
from bondgraph.runtime.simulation.scenario import Fault, Scenario
from bondgraph.text.diagnostic import CompileError, Report, Trouble
from bondgraph.text.source import Source

_BINS = 600  # of a curve on a page, each with its least and its largest
_FAULTS = 30  # of a run that a page asks for


def trial(
    compilation: Compilation, settings: Mapping[str, Any], progress: Callable[[float], None]
) -> dict[str, Any]:
    """The message for the page: signals, residuals with thresholds, verdicts; or what is wrong.

    `settings` are `scenario`, the text of one, `faults`, each {target, change, value, at} in the
    unit of the target and s, and `noise`, a share of the largest reading of each sensor. `progress`
    may raise to end it.
    """
    found: dict[str, Any] = {"type": "run", "id": settings.get("id"), "message": ""}
    try:
        scenario = _scenario(compilation, settings)
        run = compilation.simulate(scenario, progress, tell=lambda _: None)
        noise = _noise(compilation, run, settings.get("noise"))
        rated = at_rate(compilation, scenario)
        seen = watched(rated, run)
    except CompileError as error:
        return found | {"message": f"{error} {helping(error)}".rstrip()}
    except KeyError as error:
        return found | {"message": f"`{error.args[0]}` has no value: give it one beside its slider"}
    except (Trouble, SimulationError) as error:
        return found | {"message": str(error)}
    shown = episode(rated, run, seen)
    return found | {
        "signals": list(_panels(shown)),
        "residuals": [_curve(shown.time, trace) for trace in shown.residuals],
        "marks": [[m.time, m.text] for m in shown.marks],
        "said": [s._asdict() for s in shown.said],
        "verdicts": [] if seen is None else list(_verdicts(seen)),
        "fired": [] if seen is None else _fired(rated, seen),
        "noise": noise,
        "facts": [list(pair) for pair in shown.facts],
    }


def _scenario(compilation: Compilation, settings: Mapping[str, Any]) -> Scenario:
    """The scenario of a page; raises CompileError or Trouble where it is none."""
    report = Report()
    source = Source("scenario", str(settings.get("scenario", "")))
    found = read_scenario(source, compilation.graph, report)
    report.stop_on_error()
    assert found is not None
    return found._replace(faults=(*found.faults, *_faults(compilation, settings)))


def _noise(compilation: Compilation, run: Run, share: object) -> dict[str, float]:
    """Make the readings noisy, by a share of the largest of each sensor; how much, in its unit."""
    if isinstance(share, bool) or not isinstance(share, int | float) or not 0 < share <= 1:
        return {}
    draw, found = np.random.default_rng(run.scenario.seed), {}
    for sensor in compilation.graph.sensors:
        column = run.log.columns.get(sensor.name)
        if column is not None and sensor.counts is None and np.isfinite(column).any():
            found[sensor.name] = float(share * np.nanmax(np.abs(column)))
            run.log.columns[sensor.name] = column + found[sensor.name] * draw.standard_normal(
                len(column)
            )
    return found


def _faults(compilation: Compilation, settings: Mapping[str, Any]) -> Iterator[Fault]:
    known = {t.name: t for t in targets(compilation.graph)}
    asked = settings.get("faults", [])
    if not isinstance(asked, list) or len(asked) > _FAULTS:
        raise Trouble(f"a run has at most {_FAULTS} faults")
    for one in asked:
        fault = wish(one, (), known) if isinstance(one, dict) else "that is no fault"
        if isinstance(fault, str):
            raise Trouble(fault)
        at = one.get("at", 0.0)
        if isinstance(at, bool) or not isinstance(at, int | float) or not 0 <= at < 1e9:
            raise Trouble(f"{fault.label}: the time is no number of seconds")
        yield fault._replace(at=float(at))


def _panels(shown: Episode) -> Iterator[dict[str, Any]]:
    for panel in shown.panels:
        lines = [_curve(shown.time, trace) for trace in panel.traces]
        yield {"unit": panel.unit, "lines": lines}


def _curve(time: Array, trace: Trace) -> dict[str, Any]:
    """A curve as few points that keep its spikes; where it says nothing there is none."""
    value = trace.value
    if trace.valid is not None:
        value = np.where(trace.valid, value, math.nan)
    t, v = envelope(time, value, _BINS)
    found = {"name": trace.name, "unit": trace.unit, "t": _short(t), "v": _short(v)}
    if trace.bound is not None:
        bound = np.interp(t, time, np.where(np.isfinite(trace.bound), trace.bound, np.nan))
        found["bound"] = _short(bound)
    return found


def _short(values: Array) -> list[float | None]:
    return [short(v) for v in values.tolist()]


def _verdicts(seen: Watched) -> Iterator[dict[str, Any]]:
    for verdict in seen.verdicts:
        if verdict.event in ("fault", "update", "cleared"):
            yield {
                "event": verdict.event,
                "time": verdict.time,
                "fired": list(verdict.residuals),
                "group": list(verdict.group),
                "message": verdict.message or described(verdict),
                "candidates": [[c.fault, c.probability] for c in verdict.candidates],
            }


def _fired(compilation: Compilation, seen: Watched) -> list[str]:
    """The residuals that were beyond their thresholds at some sample."""
    out = np.any(seen.valid & (np.abs(seen.value) > seen.bound), axis=0)
    return [r.path for k, r in enumerate(compilation.program.residuals) if out[k]]


