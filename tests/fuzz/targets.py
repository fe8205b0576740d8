"""What reads texts from outside, each as a function that a hostile text is given to.

A target answers with a few words on what became of the text: by new ones a text is worth keeping.
Anything that it raises is a finding, but for what says in one message what is wrong.
"""

from __future__ import annotations

import json
import math
import re
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from bondgraph.cli.console import _some
from bondgraph.compilation import Compilation
from bondgraph.compile_options import Options
from bondgraph.frontend.incidence import read_table
from bondgraph.frontend.read import decode
from bondgraph.passes.elaboration import instantiate
from bondgraph.runtime.diagnosis.calibration import tune
from bondgraph.runtime.diagnosis.tuning import Tuning
from bondgraph.runtime.live.follower import Follower
from bondgraph.runtime.live.messages import Messages
from bondgraph.runtime.live.server import _wish
from bondgraph.runtime.live.setup import Setup, Target
from bondgraph.runtime.log import Array, LogError
from bondgraph.runtime.log_file import read_log
from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.columns import Columns, read_map, read_time
from bondgraph.runtime.monitoring.journal import Journal, JournalError
from bondgraph.runtime.monitoring.sources.lines import Decoder
from bondgraph.runtime.monitoring.verdict import Verdict, to_json, to_text
from bondgraph.runtime.monitoring.watch_settings import watching
from bondgraph.runtime.simulation.read_scenario import read_scenario
from bondgraph.runtime.simulation.scenario import Scenario
from bondgraph.text.diagnostic import CompileError, Report, Trouble
from bondgraph.text.render import as_json, render
from bondgraph.text.source import Source
from tests.fuzz.attempt import Kind
from tests.fuzz.mutate import BYTES, ENCODING, LANGUAGE, ROOT, corpus
from tests.unit.runtime.live.rover import SCENARIO, rover

_PARTS = 5_000  # of a model, names and statements; three million are the limit


@cache
def _folder() -> Path:
    return Path(tempfile.mkdtemp(prefix="fuzz-"))


def _shape(text: str) -> str:
    """A message without names and numbers."""
    return re.sub(r"`[^`]*`|\"[^\"]*\"|[\d.]+", "", text.split("\n")[0])[:80]


def _told(report: Report) -> str:
    render(_some(tuple(report.diagnostics)), color=True).encode()
    for d in report.diagnostics:
        if d.severity == "error":
            assert d.labels and d.help, f"`{d.code}` has no place or no remedy"
    said = {f"{d.code} {_shape(d.message)}" for d in report.diagnostics}
    return ", ".join(sorted(said)) or "sound"


def _source(name: str, data: bytes) -> tuple[Source | None, Report]:
    report = Report()
    return decode(name, data, report), report


# ------------------------------------------------------------------------ models as a whole


@contextmanager
def _few_parts() -> Iterator[None]:
    """Arrays of submodels may take their time (docs/limits.md), but not here, a million times."""
    usual, instantiate.PARTS = instantiate.PARTS, _PARTS
    try:
        yield
    finally:
        instantiate.PARTS = usual


def checked(data: bytes) -> str:
    """What `bondgraph check` does with a model; says the code of the first error."""
    path = str(ROOT / "models" / "fuzz.bg")
    report = Report()
    source = decode(path, data, report)
    compilation = Compilation(source or Source(path, ""), options=Options(open_ports=True))
    answer = "sound"
    try:
        report.stop_on_error()
        with _few_parts():
            assert compilation.integral.graph is not None
        diagnostics = tuple(compilation.report.diagnostics)
    except CompileError as error:
        diagnostics = error.diagnostics
        errors = [d for d in diagnostics if d.severity == "error"]
        assert errors, "a failure without an error"
        answer = errors[0].code
    for diagnostic in diagnostics:
        assert diagnostic.message and diagnostic.code, "an empty diagnostic"
        if diagnostic.severity == "error":
            assert diagnostic.labels, f"`{diagnostic.code}` names no place"
            assert diagnostic.help, f"`{diagnostic.code}` gives no remedy"
    render(_some(diagnostics), color=True).encode()
    json.dumps(as_json(diagnostics))
    return answer


def compiled(data: bytes) -> str:
    """A model through all stages and onto the disk; no file where one stage refuses it."""
    report = Report()
    source = decode(str(ROOT / "models" / "fuzz.bg"), data, report)
    out = Path(tempfile.mkdtemp(dir=_folder())) / "out"
    try:
        report.stop_on_error()
        assert source is not None
        compilation = Compilation(source, options=Options())
        with _few_parts():
            paths = compilation.write(out, targets=["c", "python"])
    except CompileError as error:
        render(_some(error.diagnostics), color=True).encode()
        assert not out.exists() or not any(out.iterdir()), "half written"
        return f"refused {error.diagnostics[0].code}" if error.diagnostics else _shape(str(error))
    assert all(Path(p).stat().st_size for p in paths)
    return f"compiled to {len(paths)} files"


# ------------------------------------------------------------------------ files beside models


def scenario(data: bytes) -> str:
    """A scenario for the rover."""
    source, report = _source("s.toml", data)
    if source is not None:
        read_scenario(source, rover().graph, report)
    return _told(report)


def mapped(data: bytes) -> str:
    """A map file for the rover, and a log read by it."""
    path = _folder() / "map.toml"
    path.write_bytes(data)
    signals = rover().program.read
    try:
        mapping, time = read_map(path, signals), read_time(path)
        log = read_log(
            _recorded(), time=time.column if time else None, unit=time.unit if time else None
        )
        Columns(signals, mapping, "log")(log)
        return f"samples by {len(mapping)} signals"
    except LogError as error:
        return _shape(error.message)


@cache
def _recorded() -> Path:
    """A log of the rover by somebody who gave other names and units."""
    path = _folder() / "recorded.csv"
    path.write_text(
        "stamp,left,right,enc l,enc r,speed l [mm/s],speed r,state\n"
        + "".join(f"{5 * k},1,{k},{2 * k},0,500,1e-3,on\n" for k in range(8))
    )
    return path


def logged(data: bytes) -> str:
    """A log as CSV and as JSON lines, its columns found."""
    said = []
    for suffix in (".csv", ".jsonl"):
        path = _folder() / f"log{suffix}"
        path.write_bytes(data)
        try:
            log = read_log(path)
            Columns(rover().program.read, {}, "log")(log)
            said.append("samples")
        except LogError as error:
            said.append(_shape(error.message))
    return ", ".join(said)


def incidence(data: bytes) -> str:
    """An incidence table."""
    source, report = _source("table.csv", data)
    if source is not None:
        read_table(source, report)
    return _told(report)


def tuning(data: bytes) -> str:
    """A tuning for the rover, then a second of samples watched with it."""
    try:
        found = Tuning.from_json(data.decode(ENCODING, BYTES))
        rate = found.rate
        assert rate > 0 and math.isfinite(rate) and found.to_json()
        engine, decided = watching(rover(), found, lambda _: None)
    except (ValueError, Trouble) as error:
        return _shape(str(error))
    time, samples = _second(len(engine.signals))
    said = decided(engine).update(time, engine.run(samples), samples)
    for number, verdict in enumerate(said):
        json.loads(to_json(verdict, number), parse_constant=_none)
        to_text(verdict)
    return "sound " + ", ".join(v.event for v in said[:3])


def _none(name: str) -> None:
    raise AssertionError(f"{name} in a verdict, which is no JSON")


def _second(signals: int) -> tuple[Array, Array]:
    """The times of a second at 200 Hz, and samples of as many signals that move, then jump."""
    time = np.arange(200) / 200
    samples = np.sin(np.outer(time, np.arange(1, signals + 1)))
    samples[150:] += 5.0
    return time, samples


def _tunings() -> list[bytes]:
    """What `tune` writes of the rover."""
    compilation = rover()
    engine = compilation.engine(native=False)
    rng = np.random.default_rng(1)
    log = rng.normal(0.0, 1e-3, (4000, len(engine.signals)))
    tuned = tune(engine, compilation.diagnosis_model, [log], compilation.program.digest, 1.0)
    return [tuned.tuning.to_json().encode()]


def journal(data: bytes) -> str:
    """A journal, opened and written to."""
    path = _folder() / "j"
    path.write_bytes(data)
    for old in _folder().glob("j.damaged*"):
        old.unlink()
    try:
        made = Journal(str(path), "Motor", "abc", "here", 250.0)
    except JournalError as error:
        return _shape(str(error))
    try:
        made.write({"time": 1.0}, {})
        return _shape(made.past.damage) if made.past is not None else "begun"
    finally:
        made.close()


# ------------------------------------------------------------------------ devices and pages


@cache
def _decoder() -> Decoder:
    return Decoder(Form("a topic"))


def payload(data: bytes) -> str:
    """A message of a broker, behind others: its lines as samples."""
    decoder = _decoder()
    before = decoder.garbage
    try:
        logs = decoder.feed(data + b"\n", whole=len(data) % 7 != 0)
    except LogError as error:
        _decoder.cache_clear()
        return _shape(error.message)
    columns = Columns(rover().program.read, {}, "a topic")
    said = []
    for log in logs:
        try:
            columns(log)
            said.append("samples")
        except LogError as error:
            said.append(_shape(error.message))
    return ", ".join(said[:3]) or (_shape(decoder.why) if decoder.garbage > before else "nothing")


@cache
def _follower() -> tuple[Follower, list[dict[str, Any]]]:
    from bondgraph.cli import live, usage

    args = usage.parser_for("live").parse_args(["live", "rover.bg", "--log", "-"])
    made: Setup = live.setup_of(args, rover(), Scenario("none"))
    targets: dict[str, Target] = {t.name: t for t in live.targets(rover().graph)}
    said: list[dict[str, Any]] = []
    return Follower(made, targets, Messages(said.append), lambda what: what == "reset"), said


def wished(data: bytes) -> str:
    """A message of a page."""
    found = _wish(data.decode(ENCODING, BYTES))
    if found is None:
        return "no wish"
    follower, said = _follower()
    why = follower._do(found)
    if len(follower.twin.fed.faults) > 20:
        follower.twin.clear()
    for message in said:
        json.dumps(message, allow_nan=False)
    said.clear()
    return _shape(why) or f"done {found.get('do')}"


def _journals() -> list[bytes]:
    path = _folder() / "seed"
    path.unlink(missing_ok=True)
    made = Journal(str(path), "Motor", "abc", "here", 250.0)
    for k in range(3):
        made.write({"time": k / 2, "samples": k}, {"a": [1.5]}, [(k + 1, Verdict("gap", k / 2))])
    made.sent(2)
    made.close()
    return [path.read_bytes()]


def _files(*patterns: str) -> Callable[[], list[bytes]]:
    return lambda: [p.read_bytes() for pattern in patterns for p in sorted(ROOT.glob(pattern))]


def _models() -> list[bytes]:
    return [t.encode() for t in corpus()]


_MAP = """time = { column = "stamp", unit = "ms" }
"F[1]" = "left"
"F[2]" = "right"
"turn[1]" = { column = "enc l", scale = 1.0, offset = 0 }
"turn[2]" = "enc r"
"v[1]" = { column = "speed l", unit = "mm/s" }
"v[2]" = { column = "speed r", scale = 0.5 }
"""
_ROWS = "t,F[1],F[2],turn[1],turn[2],v[1],v[2]\n" + "".join(
    f"{k / 200},1,{k},{2 * k},0,0.5,1e-3\n" for k in range(8)
)
_LOGS = [
    _ROWS.encode(),
    _ROWS.replace(",", ";").encode(),
    b'{"t": 0.1, "F[1]": 1, "F[2]": null, "turn[1]": 1, "turn[2]": 2, "v[1]": 0, "v[2]": 1}\n',
    b'[{"t": 1, "v[1]": 2}, {"t": 2, "v[1]": 3}]\n',
    b"# bondgraph log 1\n# unit v[1]: m/s\n" + _ROWS.encode(),
    b"time [ms],v[1] (km/h)\n2024-05-01T12:00:00Z,1\n2024-05-01T12:00:01+02:00,2\n",
]
_NUMBERS = ("1e999", "-0", "nan", "inf", "null", "true", "9" * 500, "1e-400", "0x1", "1_0", "1,5")
_MARKS = ("\x1b[2J", "\u202e", "\ufeff", "\0", "\r", "\x0b", "\x85", "\u2028", '"', "[" * 60, "\\u")

KINDS: dict[str, Kind] = {
    "check": Kind(checked, _models, LANGUAGE, models=True),
    "compile": Kind(compiled, _models, LANGUAGE, models=True),
    "scenario": Kind(
        scenario,
        lambda: [SCENARIO.encode(), *_files("models/scenarios/*.toml")()],
        tuple("of change at until ramp period duty label stuck missing noise bias file column hold"
              " fault controller sampling rate jitter lost sensors inputs modes parameters offsets"
              " plane desired initial solver record".split()),
    ),
    "map": Kind(mapped, lambda: [
        _MAP.encode(),
        _MAP.replace('"turn[1]"', "turn__1").replace('"right"', '{ column = "state" }').encode(),
        b'time = { column = "stamp", unit = "ms" }\nv = { "1" = "x" }\n',
    ], ("column", "scale", "offset", "unit", "time", "F[1]", "turn[2]", "stamp", "left", "right",
        "enc l", "enc r", "speed r", "state", "ms", "km/h", "counts", "rad", "{", "= ", '"')),
    "log": Kind(logged, lambda: _LOGS, ("t,", "# unit ", "time (ms)", "[s]", "m^-999", "°C")),
    "incidence": Kind(incidence, lambda: [
        b"equation,x:q,x:dq,z:y,f:a\nlaw,,1,1,x\nder,I,D,,\nsensor,1,,1,.\n",
        b"e\tx:a\tz:b\n1\tx\tX\n",
    ], ("x:", "z:", "f:", "I", "D", "1", ".", "\t", ";")),
    "tuning": Kind(tuning, _tunings, (
        "bondgraph tuning", "model", "rate", "bandwidth", "false_alarms", "seconds", "limits", "r1",
        "sigma", "crossings", "kappa", "height", "mean", "memory", "NaN", "Infinity", "{}", "0.0",
    )),
    "journal": Kind(journal, _journals, ('"crc"', '"n"', '"verdicts"', '"position"', '"sent"')),
    "payload": Kind(payload, lambda: _LOGS, ("t,", "# unit ", "{", "[{", "}]")),
    "wish": Kind(wished, lambda: [
        b'{"do": "inject", "target": "f[1]", "change": "*=", "value": 3}', b'{"do": "clear"}',
        b'{"do": "inject", "fault": 0}', b'{"do": "reset"}', b'{"do": "go"}',
        b'{"do": "inject", "target": "v[1]", "change": "stuck"}',
    ], ("do", "inject", "target", "turn[1]", "missing", "+=", "value", "fault")),
}

WORDS = (*_NUMBERS, *_MARKS)
