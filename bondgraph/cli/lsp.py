"""`bondgraph lsp`: the language server, for an editor that starts it."""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING

from bondgraph.text.diagnostic import Trouble

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `lsp`."""
    parser.epilog = "An editor starts it and speaks with it over the standard streams."
    parser.add_argument("--stdio", action="store_true", help="the only way, and so the default")


def run(args: Namespace) -> int:
    """Answer an editor until it says goodbye."""
    if find_spec("pygls") is None:
        raise Trouble("the language server needs pygls: pip install 'bondgraph-arr[editor]'")
    import sys

    from bondgraph.editor.language_server import language_server

    stdin, stdout = sys.stdin.buffer, getattr(sys.stdout, "raw", sys.stdout).buffer
    language_server().start_io(stdin, stdout)
    return 0
