"""`bondgraph complete`: what makes a shell complete commands, options and files."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from importlib.util import find_spec

from bondgraph.cli.usage import parser_for, subparsers
from bondgraph.text.diagnostic import Trouble

_SHELLS = ("bash", "zsh", "tcsh")
_PLACES = ("FILE", "MODEL", "LOG", "SCENARIO")


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `complete`."""
    parser.add_argument("shell", metavar="SHELL", choices=_SHELLS, help=", ".join(_SHELLS))


def run(args: Namespace) -> int:
    """Print the script of a shell."""
    if find_spec("shtab") is None:
        raise Trouble("completion needs shtab: pip install 'bondgraph-arr[shell]'")
    import shtab

    whole = parser_for(None)
    for parser in (whole, *subparsers(whole).values()):
        for action in parser._actions:
            named = str(action.metavar or "")
            if any(word in named for word in _PLACES):
                action.complete = shtab.FILE  # type: ignore[attr-defined]
            elif "DIR" in named:
                action.complete = shtab.DIRECTORY  # type: ignore[attr-defined]
    print(shtab.complete(whole, args.shell))
    return 0
