"""`bondgraph edit`: a model written in the browser, drawn and derived while one types."""

from __future__ import annotations

import os
import secrets
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bondgraph.cli.options import announced, serving
from bondgraph.text.diagnostic import Trouble

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace

_PORT = 8421


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `edit`."""
    parser.add_argument("file", metavar="FILE.bg", help="the model; it need not be there yet")
    serving(parser, _PORT)


def run(args: Namespace) -> int:
    """Read the file, listen, then serve until somebody stops it."""
    if find_spec("aiohttp") is None or find_spec("pygls") is None:
        raise Trouble("the workbench needs aiohttp and pygls: pip install 'bondgraph-arr[editor]'")
    from bondgraph.runtime.live.server import listening

    if not 0 <= args.port < 65536:
        print(f"error: {args.port} is no port: 0 to 65535", file=sys.stderr)
        return 2
    made = listening(args.host, args.port)
    try:
        return _serve(args, made)
    finally:
        made.close()


def _serve(args: Namespace, made: Any) -> int:
    import asyncio

    from bondgraph.backends.workbench_page import words, workbench
    from bondgraph.cli.workbench.analyst import Processes
    from bondgraph.cli.workbench.bench import Bench, OnDisk
    from bondgraph.cli.workbench.desk import Desk
    from bondgraph.cli.workbench.starts import starts
    from bondgraph.runtime.live.server import POLICY, address_of, serve, token_for

    folder = os.path.dirname(args.file) or "."
    if not os.path.isdir(folder):
        raise Trouble(f"there is no folder {folder}: make it first")
    disk = OnDisk(args.file)
    name = os.path.basename(args.file)
    hello = {
        "file": name,
        "path": args.file,
        "uri": Path(args.file).resolve().as_uri(),
        "words": words(),
        "starts": [s._asdict() for s in starts()],
    }
    nonce = secrets.token_urlsafe(16)
    files = workbench(name, nonce)
    policy = POLICY.replace("style-src 'self'", f"style-src 'self' 'nonce-{nonce}'")
    processes = Processes()
    token = token_for(made)
    address = address_of(made, token)

    def ready() -> None:
        announced(f"editing {args.file}", address, args.no_browser)

    def start() -> Bench:
        return Bench(disk, lambda bench: Desk(bench, processes, hello))

    asyncio.run(serve(made, files, start, ready, token, policy))
    print("stopped")
    return 0
