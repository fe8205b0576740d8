"""`bondgraph monitor`: watch a machine by its samples, and say what is faulty."""

from __future__ import annotations

import signal
import sys
from contextlib import closing, contextmanager, nullcontext
from typing import TYPE_CHECKING

from bondgraph import Options
from bondgraph.cli import console, fleet
from bondgraph.cli.log_options import form_of, logged, note
from bondgraph.cli.options import (
    bandwidth,
    count,
    fitted_bandwidth,
    isolating,
    realised,
    realising,
    sample_rate,
    seconds,
    tuning_of,
)
from bondgraph.text.numerals import plural

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace
    from collections.abc import Callable, Iterator

    from bondgraph.compilation import Compilation
    from bondgraph.runtime.monitoring.engine import Engine
    from bondgraph.runtime.monitoring.journal import Journal
    from bondgraph.runtime.monitoring.mqtt_client import Address, Publisher
    from bondgraph.runtime.monitoring.snapshot import Snapshot
    from bondgraph.runtime.monitoring.sources.sample_source import Source
    from bondgraph.runtime.monitoring.verdict import Verdict
    from bondgraph.runtime.monitoring.watch_parts import Stop

FAULT = 3  # the exit status of --fail-on-fault

_COLOURS = {"fault": "1;31", "update": "31", "cleared": "32", "accepted": "36", "refused": "33",
            "invalid": "33", "late": "33", "gap": "33"}  # fmt: skip


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `monitor`."""
    add = parser.add_argument
    add("model", metavar="MODEL", help="file.bg or file.bg:Name")
    add("logs", metavar="LOG", nargs="*",
        help="samples: a .csv, .parquet, .mcap or .jsonl file, or - for standard input (default);"
        " several, a folder or a pattern are a fleet (docs/fleets.md)")  # fmt: skip
    sampled(add)
    isolating(parser)
    realised(parser)
    add("--journal", metavar="FILE", help="keep what was said and go on there after a restart")
    add("--publish", metavar="[HOST[:PORT]/]TOPIC",
        help="publish the verdicts, at the broker of --mqtt if none is named")  # fmt: skip
    add("--json", dest="lines", action="store_true",
        help="print each verdict as a line of JSON (docs/json.md)")  # fmt: skip
    add("--states", metavar="FILE",
        help="a row for each sample: residuals, thresholds, states, class (.csv or"
        " .parquet; of a fleet a folder)")  # fmt: skip
    add("--heartbeat", metavar="S", type=seconds,
        help="tell the state of each residual every S seconds")  # fmt: skip
    add("--metrics", metavar="[HOST:]PORT", type=listening,
        help="serve metrics for Prometheus (default HOST: 127.0.0.1)")  # fmt: skip
    add("--silence", metavar="S", type=seconds,
        help="a live source without a sample for S seconds is told (default: 2)")  # fmt: skip
    add("--accept", metavar="S", type=seconds,
        help="go on with a fault that has been named for S seconds, and tell the next")  # fmt: skip
    add("--fail-on-fault", action="store_true", help="exit status 3 if there was an alarm")
    add("-o", "--output", metavar="FILE", help="of a fleet: write a row for each verdict (.csv or"
        " .parquet), and watch only what is not in it")  # fmt: skip
    add("--jobs", metavar="N", type=count, help="of a fleet: so many processes (default: 1)")
    add("--scheduler", metavar="ADDRESS",
        help="of a fleet: the workers of this Dask scheduler watch")  # fmt: skip


def listening(text: str) -> tuple[str, int]:
    """A host, by default this computer alone, and a port; raises ValueError for any other text."""
    host, _, port = text.rpartition(":")
    if not port.isdigit() or int(port) > 65535:
        raise ValueError
    return host.strip("[]") or "127.0.0.1", int(port)


listening.__name__ = "[HOST:]PORT"


def sampled(add: Callable[..., object]) -> None:
    """The arguments that say where samples come from, and how they are watched."""
    add("--follow", action="store_true", help="wait at the end of a CSV file for more, until ^C")
    add("--serial", metavar="PORT", help="samples from a serial port")
    add("--baud", metavar="N", type=int, default=115200,
        help="its speed (default: 115200)")  # fmt: skip
    add("--mqtt", metavar="HOST[:PORT]/TOPIC", help="samples from a topic of an MQTT broker")
    logged(add)
    add("--rate", metavar="HZ", type=sample_rate,
        help=f"samples a second (default: of a file its own, else {Options().rate:g})")  # fmt: skip
    add("--bandwidth", metavar="RAD/S", type=bandwidth,
        help="bandwidth of the filter (default: by rate and length of the log, or"
        " a faster one that `bondgraph fit` took for the numbers of --parameters)")  # fmt: skip
    add("--tuning", metavar="FILE.json",
        help="limits from `bondgraph tune` (default: learned from the first seconds)")  # fmt: skip


def run(args: Namespace) -> int:
    """Open the source, compile, watch."""
    from bondgraph.runtime.fleet.log_paths import many
    from bondgraph.runtime.monitoring.mqtt_client import address

    several = many(args.logs) or bool(args.output or args.jobs or args.scheduler)
    args.log = args.logs[0] if args.logs else None
    wrong = fleet.wrong(args) if several else _wrong(args)
    if wrong:
        print(f"error: {wrong}", file=sys.stderr)
        return 2
    if several:
        return fleet.run(args, tuning_of(args), FAULT)
    try:
        samples = address(args.mqtt) if args.mqtt else None
        verdicts = _publish_to(args.publish, samples)
    except ValueError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    with closing(source(args, samples)) as found:
        return _watch(args, found, verdicts)


def _wrong(args: Namespace) -> str:
    """What is wrong with the words together, "" if nothing."""
    named = [
        w for w, v in (("LOG", args.log), ("--serial", args.serial), ("--mqtt", args.mqtt)) if v
    ]
    if len(named) > 1:
        return f"samples come from one source, not from {' and '.join(named)}"
    if args.follow and args.log in (None, "-"):
        return "--follow needs a CSV file that grows"
    if not named and sys.stdin.isatty():
        return "no samples: name a file, - for standard input, --serial or --mqtt"
    return ""


def _publish_to(text: str | None, samples: Address | None) -> Address | None:
    """Where verdicts go: a topic of its own broker, or of that of the samples."""
    from bondgraph.runtime.monitoring.mqtt_client import address

    if text is None:
        return None
    host = text.split("/", 1)[0]
    if samples is not None and "://" not in text and ":" not in host and host != samples.host:
        return samples._replace(topic=text)
    return address(text)


def _watch(args: Namespace, source: Source, verdicts: Address | None) -> int:
    from bondgraph.runtime.monitoring.columns import read_map
    from bondgraph.runtime.monitoring.engine import setting
    from bondgraph.runtime.monitoring.journal import known_rate
    from bondgraph.runtime.monitoring.sample_pipeline import Monitor
    from bondgraph.runtime.monitoring.states import states_file
    from bondgraph.runtime.monitoring.watch_parts import SILENCE
    from bondgraph.runtime.monitoring.watch_settings import (
        WatchSettings,
        sample_rate,
        usual_bandwidth,
        watching,
        what_is_watched,
    )

    known = known_rate(args.journal) if args.journal else None
    tuning = tuning_of(args)
    rate = sample_rate(args.rate or known, source, tuning, Options().rate)
    compilation = realising(args, rate=rate, bandwidth=args.bandwidth)
    signals = setting(*compilation.runnable_programs).signals if args.map else ()
    mapping = read_map(args.map, signals) if args.map else None
    if args.bandwidth is None and tuning is None:  # with a journal the log may grow
        grows = bool(args.journal)
        fitted = fitted_bandwidth(args, compilation)
        bandwidth = usual_bandwidth(rate, source, grows, args.operating, mapping, fitted)
        compilation = compilation.with_options(bandwidth=bandwidth)
    engine, decided = watching(compilation, tuning, note, args.accept)
    journal = _journal(args.journal, compilation, source, engine, args.accept is not None)
    form = form_of(args, source.name)
    settings = WatchSettings(compilation, tuning, form, mapping, args.operating, args.accept)
    alarms = Alarms()
    watched = what_is_watched(compilation, engine)
    parts = settings.parts(source, engine, decided(engine))._replace(
        sinks=[_printer(args.lines), alarms],
        journal=journal,
        note=note,
        heartbeat=args.heartbeat,
        silence=args.silence or SILENCE,
    )
    kept = states_file(args.states, engine.residuals) if args.states else nullcontext()
    with kept as states, _metrics(args.metrics) as observe, _stop() as stop:
        publisher = _publisher(verdicts, args.journal, journal, watched)
        listeners = (states,) if states else ()
        parts = parts._replace(listeners=listeners, observe=observe, publisher=publisher)
        untaken = Monitor(parts, watched).run(stop)
    if untaken:
        how = "they are sent after the next start" if args.journal else "--journal would keep them"
        what = plural(untaken, "verdict")
        print(f"note: the broker has not taken {what}; {how}", file=sys.stderr)
    return FAULT if args.fail_on_fault and alarms.any else 0


class Alarms:
    """Hears whether there was an alarm, or one that was latched before a restart."""

    def __init__(self) -> None:
        self.any = False

    def __call__(self, number: int, verdict: Verdict) -> None:
        """One more verdict."""
        self.any |= verdict.event == "fault" or (
            verdict.event == "resumed" and verdict.since is not None
        )


def source(args: Namespace, samples: Address | None) -> Source:
    """The source that the arguments name."""
    from bondgraph.runtime.monitoring.sources.file import file_source
    from bondgraph.runtime.monitoring.sources.streams import Pipe, SerialPort, Topic

    name = args.serial or args.mqtt or args.log or "-"
    form = form_of(args, "standard input" if name == "-" else name)
    if samples is not None:
        return Topic(samples, form, _identity(args.journal, "samples") if args.journal else None)
    if args.serial:
        return SerialPort(args.serial, args.baud, form)
    return Pipe(form) if name == "-" else file_source(name, form, args.follow)


def _journal(
    path: str | None, compilation: Compilation, source: Source, engine: Engine, accepts: bool
) -> Journal | None:
    from bondgraph.runtime.monitoring.journal import Journal

    if path is None:
        return None
    bounds = compilation.thresholds
    digest = compilation.program.digest + ("" if bounds is None else f"-{bounds.digest}")
    if engine.bandwidth != compilation.program.bandwidth:  # of a tuning
        digest += f"-{engine.bandwidth:g}"
    if accepts:  # its state has the faults that were accepted
        digest += "-accept"
    return Journal(path, compilation.graph.name, digest, source.name, compilation.program.rate)


def _publisher(
    at: Address | None, journal: str | None, known: Journal | None, watched: str
) -> Publisher | None:
    from bondgraph.runtime.monitoring.mqtt_client import Publisher
    from bondgraph.runtime.monitoring.snapshot import presence

    if at is None:
        return None
    sent = known.past.sent if known is not None and known.past is not None else 0
    gone = presence("gone", f"the monitor has ended without a word, or is cut off: {watched}")
    return Publisher(at, _identity(journal, "verdicts") if journal else "", sent, gone)


@contextmanager
def _metrics(at: tuple[str, int] | None) -> Iterator[Callable[[Snapshot], None] | None]:
    """What takes how the watch stands, to serve it; None where nobody asked for that."""
    if at is None:
        yield None
        return
    from bondgraph.runtime.monitoring.metrics import MetricsServer

    with closing(MetricsServer(*at)) as server:
        note(f"metrics at {server.url}")
        yield server.observe


def _identity(journal: str, role: str) -> str:
    """By what a broker knows a monitor again: the same for the same journal on the same machine."""
    import hashlib
    import os
    import socket

    text = f"{socket.gethostname()}:{os.path.realpath(journal)}"
    return f"bondgraph-{role}-{hashlib.sha256(text.encode()).hexdigest()[:12]}"


def _printer(lines: bool) -> Callable[[int, Verdict], None]:
    from bondgraph.cli.terminal import styled
    from bondgraph.runtime.monitoring.verdict import to_json, to_text
    from bondgraph.text.printable import printable

    colours = _COLOURS if console.coloured(sys.stdout) else {}

    def say(line: str) -> None:
        # in one piece: without a buffer a line feed is written by itself, and a kill comes between
        print(f"{line}\n", end="", flush=True)

    def text(number: int, verdict: Verdict) -> None:
        line = to_text(verdict)
        colour = colours.get(verdict.event)
        if colour:
            styled(sys.stdout, f"\x1b[{colour}m{printable(line)}\x1b[0m\n")
            sys.stdout.flush()
        else:
            say(line)

    def json(number: int, verdict: Verdict) -> None:
        say(to_json(verdict, number))

    return json if lines else text


@contextmanager
def _stop() -> Iterator[Stop]:
    """What SIGINT and SIGTERM set; a second one ends the program at once."""
    from bondgraph.runtime.monitoring.watch_parts import Stop

    stop = Stop()

    def ask(number: int, frame: object) -> None:
        stop.ask(signal.Signals(number).name)
        signal.signal(number, signal.default_int_handler)

    before = {number: signal.signal(number, ask) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
