"""A process that has imported all that a monitor needs, and forks one whenever it is asked to.

Started by `watch.Nursery`; a monitor of its own takes ten times as long to start. The requests come
by a socket, each with the descriptors of the monitor: input, output, errors, exit status.
"""

from __future__ import annotations

import json
import os
import signal
import socket
import sys

import paho.mqtt.client  # noqa: F401
import serial  # noqa: F401

import bondgraph
from bondgraph.cli.main import main
from tests.unit.runtime.monitoring.watch import MOTOR


def serve(asking: socket.socket) -> None:
    """Fork a monitor for each request; answer with its number."""
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for them
    while True:
        request, descriptors, _, _ = socket.recv_fds(asking, 1 << 16, 4)
        if not request:
            return
        child = os.fork()
        if child == 0:
            asking.close()
            asked = json.loads(request)
            os.environ.update(asked["environment"])
            run(asked["words"], descriptors)
        for descriptor in descriptors:
            os.close(descriptor)
        asking.sendall(b"%d\n" % child)


def run(words: list[str], descriptors: list[int]) -> None:
    """Be a monitor, and tell with which status it ended."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    for own, given in enumerate(descriptors[:3]):
        os.dup2(given, own)
        os.close(given)
    status = 70
    try:
        status = main(words)
    except SystemExit as left:
        status = int(left.code or 0)
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os.write(descriptors[3], b"%d" % status)
        os._exit(status)


if __name__ == "__main__":
    bondgraph.compile(MOTOR).engine()
    serve(socket.socket(fileno=int(sys.argv[1])))
