"""`bondgraph live`: a machine and its virtual twin side by side, on a page in the browser."""

from __future__ import annotations

import sys
from functools import partial
from typing import TYPE_CHECKING, Any

from bondgraph import Options
from bondgraph.cli import monitor
from bondgraph.cli.log_options import note, operating_of
from bondgraph.cli.options import (
    announced,
    fitted_bandwidth,
    isolating,
    numbers_again,
    positive,
    realised,
    realising,
    serving,
    tuning_of,
)
from bondgraph.ir.expr import symbols
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.numerals import plural

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace
    from collections.abc import Callable

    from bondgraph.compilation import Compilation
    from bondgraph.ir.graph import BondGraph
    from bondgraph.runtime.diagnosis.tuning import Tuning
    from bondgraph.runtime.live.session import Session
    from bondgraph.runtime.live.setup import Machine, Setup
    from bondgraph.runtime.simulation.scenario import Scenario

_PORT = 8420


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `live`."""
    add = parser.add_argument
    add("model", metavar="MODEL", help="file.bg or file.bg:Name")
    add("scenario", metavar="SCENARIO", nargs="?",
        help="a .toml file: what happens, and the plane (docs/simulation.md)")  # fmt: skip
    serving(parser, _PORT)
    add("--speed", metavar="X", type=positive, default=1.0,
        help="so many seconds in one, of a simulation or a file (default: 1)")  # fmt: skip
    add("--log", metavar="LOG",
        help="the monitored machine: a .csv or .parquet file, or - for standard input (default:"
        " a simulation of the scenario in a process of its own)")  # fmt: skip
    monitor.sampled(add)
    isolating(parser)
    realised(parser)


def run(args: Namespace) -> int:
    """Compile, listen, then serve until somebody stops it."""
    try:
        from bondgraph.runtime.live.server import listening
    except ImportError as error:
        if error.name != "aiohttp":
            raise
        raise Trouble(
            "the live page needs aiohttp: pip install aiohttp, or install bondgraph-arr[robot]"
        ) from error
    wrong = _wrong(args)
    if wrong:
        print(f"error: {wrong}", file=sys.stderr)
        return 2
    made = listening(args.host, args.port)
    try:
        return _serve(args, made)
    finally:
        made.close()


def _wrong(args: Namespace) -> str:
    """What is wrong with the words together, "" if nothing."""
    named = [
        w for w, v in (("--log", args.log), ("--serial", args.serial), ("--mqtt", args.mqtt)) if v
    ]
    if len(named) > 1:
        return f"samples come from one source, not from {' and '.join(named)}"
    if args.follow and args.log in (None, "-"):
        return "--follow needs --log with a CSV file that grows"
    if not 0 <= args.port < 65536:
        return f"{args.port} is no port: 0 to 65535"
    if not named and not args.scenario:
        return "nothing moves: name a SCENARIO, or --log, --serial or --mqtt"
    return ""


def _serve(args: Namespace, made: Any) -> int:
    import asyncio

    from bondgraph.backends.live_page import live
    from bondgraph.runtime.diagnosis.tuning import FASTEST
    from bondgraph.runtime.live.audience import Audience
    from bondgraph.runtime.live.server import address_of, serve, token_for
    from bondgraph.runtime.live.session import Session
    from bondgraph.runtime.simulation.scenario import Scenario

    rate, tuning = args.rate, tuning_of(args)
    compilation = realising(args)
    scenario = compilation.scenario(args.scenario) if args.scenario else Scenario("live")
    if rate is None:
        rate = scenario.sampling.rate if args.scenario else Options().rate
    fitted = fitted_bandwidth(args, compilation)
    bandwidth = args.bandwidth or (min(fitted, FASTEST * rate) if fitted and not tuning else None)
    compilation = compilation.with_options(rate=rate, bandwidth=bandwidth)
    if args.scenario:  # read for this one: its expressions belong to the graph of the model
        scenario = compilation.scenario(args.scenario)
    try:
        setup = setup_of(args, compilation, scenario, tuning)
    except ValueError as error:
        raise Trouble(str(error)) from error
    machine = _machine(args, compilation)
    sessions: list[Session] = []

    def start(say: Callable[[dict[str, Any]], None]) -> Session:
        try:
            sessions.append(Session(setup, {t.name: t for t in machine.targets}, say))
        except KeyError as error:
            name = error.args[0]
            raise Trouble(
                f"`{name}` has no value: give it under [parameters] of the scenario"
            ) from error
        hello.update(_hello(machine, setup, sessions[0]))
        return sessions[0]

    hello: dict[str, Any] = {"type": "hello"}
    files = live(machine.name, machine.doc, compilation.drawing(bare=True))
    token = token_for(made)
    address = address_of(made, token)

    def ready() -> None:
        announced(f"{machine.name}: {setup.what}", address, args.no_browser)

    asyncio.run(serve(made, files, lambda: Audience(hello, start), ready, token))
    print("stopped")
    return 0


# --------------------------------------------------------------------------- what it is made of


def setup_of(
    args: Namespace, compilation: Compilation, scenario: Scenario, tuning: Tuning | None = None
) -> Setup:
    """What a session of these arguments is made of."""
    from bondgraph.runtime.live.setup import Setup, Wide, further
    from bondgraph.runtime.monitoring.clock import clock_of
    from bondgraph.runtime.monitoring.columns import Columns, read_map
    from bondgraph.runtime.monitoring.mqtt_client import address
    from bondgraph.runtime.monitoring.watch_settings import watching
    from bondgraph.runtime.simulation.parameters import Values

    graph = compilation.graph
    engine, decided = watching(compilation, tuning, note)
    values = Values(graph, scenario.parameters)
    turns = {s.name: values.number(s.counts) for s in graph.sensors if s.counts is not None}
    wide = Wide(engine, further(graph, engine, turns))
    mapping = read_map(args.map, wide.signals) if args.map else None
    samples = address(args.mqtt) if args.mqtt else None
    simulated = not (args.log or args.serial or args.mqtt)
    if simulated:
        source: Callable[[], Any] = partial(_robot, args)
    else:
        args.journal = None
        source = partial(monitor.source, args, samples)
    name = "simulation" if simulated else args.serial or args.mqtt or args.log
    operating_of(args, mapping, name)  # what is wrong with it is told before anybody watches
    replayed = bool(args.log) and args.log != "-" and not args.follow
    return Setup(
        compilation.equations,
        compilation.integral,
        scenario,
        wide,
        len(engine.signals),
        decided,
        lambda: clock_of(wide),
        lambda: Columns(wide.signals, mapping, name),
        source,
        simulated or replayed,
        args.speed if simulated or replayed else None,
        f"{plural(len(engine.residuals), 'residual')} at {1 / wide.sample_time:g} samples"
        " a second",
        lambda: operating_of(args, mapping, name),
    )


def _robot(args: Namespace) -> Any:
    """The monitored machine: the same command that anybody could start, heard through a pipe."""
    from bondgraph.runtime.live.samples import Simulated

    words = [sys.executable, "-m", "bondgraph", "simulate", args.model, args.scenario]
    words += [*numbers_again(args), "--stream", "--speed", "inf"]
    return Simulated(words, "simulated machine")


def _machine(args: Namespace, compilation: Compilation) -> Machine:
    from bondgraph.runtime.live.setup import Machine

    program, graph = compilation.program, compilation.graph
    known = args.serial or args.mqtt or {"-": "standard input"}.get(args.log, args.log)
    units = compilation.residual_units
    return Machine(
        graph.name,
        graph.doc,
        tuple((r.name, units.get(r.name, ""), r.faults) for r in program.residuals),
        tuple((s.name, s.unit or "") for s in graph.sensors if s.same_as is None),
        targets(graph),
        links(graph),
        known or "simulated in another process",
        not known,
    )


def targets(graph: BondGraph) -> tuple[Any, ...]:
    """Everything that can be made faulty, as the model names and measures it."""
    from bondgraph.library.units import parse_unit
    from bondgraph.runtime.live.setup import Target
    from bondgraph.runtime.simulation.parameters import Values

    values = Values(graph)
    items = [(v.name, "param", v.unit, values.constant(v.symbol)) for v in graph.values if v.fault]
    items += [(i.name, "input", i.unit, None) for i in graph.inputs if not i.mode]
    items += [(s.name, "sensor", s.unit, None) for s in graph.sensors if s.same_as is None]
    found = []
    for name, kind, unit, value in items:
        parsed = parse_unit(unit) if unit else None
        factor = float(parsed.factor) if parsed is not None else 1.0
        found.append(Target(name, kind, unit or "", factor,
                            None if value is None else value / factor))  # fmt: skip
    return tuple(found)


def links(graph: BondGraph) -> dict[str, tuple[str, ...]]:
    """The faults of each element: of its laws, and of what measures it directly.

    >>> import bondgraph
    >>> found = links(bondgraph.compile("models/quarter_car.bg").graph)
    >>> found["spring"], found["ms"]
    (('ks', 'stroke'), ('ms',))
    """
    faults = {symbol: name for name, symbol in graph.fault_symbols().items()}
    integrands = {i.symbol: i.integrand for i in graph.integrals}
    found: dict[str, list[str]] = {n.path: [] for n in graph.nodes}
    owner = {p.state: n.path for n in graph.nodes for p in n.ports if p.state is not None}
    owner |= {v: n.path for n in graph.nodes for p in n.ports for v in (p.effort, p.flow)}
    owner |= {n.common: n.path for n in graph.nodes if n.common is not None}
    for node in graph.nodes:
        inside = symbols(*[law.zero for law in node.laws])
        found[node.path] += [faults[s] for s in inside if s in faults]
    for sensor in graph.sensors:
        if sensor.name not in faults.values() or sensor.same_as is not None:
            continue
        if sensor.node is not None:
            found[graph.nodes[sensor.node].path].append(sensor.name)
            continue
        for variable in symbols(integrands.get(sensor.reads, sensor.reads)):
            if variable in owner:
                found[owner[variable]].append(sensor.name)
    return {path: tuple(dict.fromkeys(own)) for path, own in found.items() if own}


def _hello(machine: Machine, setup: Setup, session: Session) -> dict[str, Any]:
    """What a page is told first; the sensors in the order of the samples."""
    sensors = dict(machine.sensors)
    order = [k.path for k in setup.engine.signals if k.path in sensors]
    return {
        "residuals": machine.residuals,
        "sensors": [(name, sensors[name]) for name in order],
        "plane": session.places.names,
        "wanted": bool(session.places.wanted),
        "lacking": session.places.lacking,
        "faults": [f.label for f in setup.scenario.faults],
        "targets": [t._asdict() for t in machine.targets],
        "links": machine.links,
        "monitored": machine.monitored,
        "pace": setup.speed,
    }
