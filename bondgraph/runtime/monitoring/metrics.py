"""How a watch stands, for Prometheus: its text format, and a server that gives it.

Format: https://prometheus.io/docs/instrumenting/exposition_formats/, version 0.0.4.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread

from bondgraph.runtime.monitoring.clock import THROWN
from bondgraph.runtime.monitoring.residual_states import STATES
from bondgraph.runtime.monitoring.snapshot import Snapshot
from bondgraph.runtime.monitoring.verdict import EVENTS
from bondgraph.text.diagnostic import Trouble

_TYPE = "text/plain; version=0.0.4; charset=utf-8"
_PATIENCE = 10.0  # s for a request
_ESCAPED = str.maketrans({"\\": "\\\\", '"': '\\"', "\n": "\\n"})
_Sample = tuple[Mapping[str, str], float]


def exposition(snapshot: Snapshot, now: float, turn: float) -> str:
    """All metrics; `now` and when the monitor was at work last (`turn`), on the monotonic clock."""
    return "".join(_metrics(snapshot, now, turn))


def _metrics(snapshot: Snapshot, now: float, turn: float) -> Iterator[str]:
    account = snapshot.account
    samples, lines = account["samples"], account["lines"]
    what = {"watch": snapshot.model, "source": snapshot.source}
    yield _family("monitor_info", "gauge", "What is watched, and where samples come from.",
                  [(what, 1.0)])  # fmt: skip
    yield _family("monitor_turn_age_seconds", "gauge",
                  "Time since the monitor was at work last; more than a second: it is stuck.",
                  [({}, max(0.0, now - turn))])  # fmt: skip
    yield _family("samples_read_total", "counter", "Samples that came.", [({}, samples["read"])])
    yield _family("samples_used_total", "counter", "Samples that were used.",
                  [({}, samples["used"])])  # fmt: skip
    causes = (*THROWN, "unmatched")
    yield _family("samples_dropped_total", "counter", "Samples that were thrown away, by cause.",
                  [({"cause": c}, samples[c]) for c in causes])  # fmt: skip
    yield _family("samples_off_total", "counter", "Samples while the machine was off.",
                  [({}, samples["off"])])  # fmt: skip
    yield _family("lines_dropped_total", "counter",
                  "Lines that are no samples, and lines that nobody read in time.",
                  [({"cause": c}, lines[c]) for c in ("garbage", "overflow")])  # fmt: skip
    yield _family("gaps_total", "counter", "How often the filters began anew.",
                  [({}, lines["gaps"])])  # fmt: skip
    yield _family("samples_lost_total", "counter", "Samples that are missing in gaps.",
                  [({}, lines["lost"])])  # fmt: skip
    yield _family("stream_time_seconds", "gauge", "Time of the newest sample, of the stream.",
                  [({}, snapshot.time)])  # fmt: skip
    age = snapshot.age(now)
    yield _family("last_sample_age_seconds", "gauge",
                  "Time since the newest sample came, on the clock of the monitor.",
                  [({}, age)] if age is not None else [])  # fmt: skip
    yield _family("fault_latched", "gauge", "Whether there is an alarm.",
                  [({}, float(snapshot.fault))])  # fmt: skip
    yield _family("residual_state", "gauge", "1 for the state that a residual is in, else 0.", [
        ({"residual": name, "state": state}, float(state == own))
        for name, (own, _) in snapshot.residuals.items() for state in STATES
    ])  # fmt: skip
    yield _family("residual_samples_total", "counter", "Samples by the state of the residual.", [
        ({"residual": name, "state": state}, counts[state])
        for name, counts in account["residuals"].items() for state in STATES
    ])  # fmt: skip
    yield _family("verdicts_total", "counter", "Verdicts by kind.", [
        ({"event": event}, account["verdicts"].get(event, 0)) for event in EVENTS
    ])  # fmt: skip


def _family(name: str, kind: str, help: str, samples: Iterable[_Sample]) -> str:
    """One metric with its samples; without any there is nothing to say of it."""
    lines = [f"bondgraph_{name}{_labels(labels)} {_number(value)}\n" for labels, value in samples]
    if not lines:
        return ""
    return f"# HELP bondgraph_{name} {help}\n# TYPE bondgraph_{name} {kind}\n" + "".join(lines)


def _labels(labels: Mapping[str, str]) -> str:
    """
    >>> print(_labels({"source": 'a "b"'}))
    {source="a \\"b\\""}
    """
    pairs = [f'{name}="{text.translate(_ESCAPED)}"' for name, text in labels.items()]
    return "{" + ",".join(pairs) + "}" if pairs else ""


def _number(value: float) -> str:
    return str(value) if isinstance(value, int) else repr(float(value))


class MetricsServer:
    """Serves what was observed last at `http://HOST:PORT/metrics`, in threads of its own.

    Raises Trouble where nobody can listen there. Port 0 is any that is free.
    """

    def __init__(self, host: str, port: int) -> None:
        self._newest: tuple[Snapshot, float] | None = None

        class Handler(_Handler):
            page = self.page

        try:
            self._server = ThreadingHTTPServer((host, port), Handler)
        except (OSError, OverflowError) as error:
            why = getattr(error, "strerror", None) or error
            message = f"metrics at {host}:{port}: {why}; give another --metrics"
            raise Trouble(message) from error
        self._server.daemon_threads = True
        self.url = f"http://{host}:{self._server.server_address[1]}/metrics"
        self._thread = Thread(target=self._server.serve_forever, args=(0.2,), daemon=True)
        self._thread.start()

    def observe(self, snapshot: Snapshot) -> None:
        """Serve this from now on."""
        self._newest = snapshot, time.monotonic()

    def page(self) -> str | None:
        """What is served, None before anything was observed."""
        newest = self._newest
        return None if newest is None else exposition(newest[0], time.monotonic(), newest[1])

    def close(self) -> None:
        """End it."""
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()


class _Handler(BaseHTTPRequestHandler):
    timeout = _PATIENCE
    server_version = "bondgraph"
    sys_version = ""

    @staticmethod
    def page() -> str | None:
        """See `MetricsServer.page`."""

    def do_GET(self) -> None:
        """Answer."""
        if self.path.partition("?")[0] != "/metrics":
            self.send_error(404, "there is only /metrics")
            return
        text = self.page()
        if text is None:
            self.send_error(503, "the watch has not begun")
            return
        data = text.encode()
        self.send_response(200)
        self.send_header("Content-Type", _TYPE)
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        self.wfile.write(data)

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing: the output is for verdicts."""
