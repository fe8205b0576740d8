"""Which commands there are, and what each of them takes."""

from __future__ import annotations

import argparse
import sys
from importlib import import_module
from typing import Any

from bondgraph import __version__

#: Every command with its one line; the module of the same name has `arguments` and `run`.
COMMANDS = {
    "new": "make a model to begin with, a log of it, and a page with the commands for both",
    "check": "say whether models are sound: syntax, names, units, causality",
    "format": "write models in the one style they are all written in",
    "compile": "derive ARRs (residuals), fault signatures and code from a model",
    "dump": "print what the compiler knows about a model at one of its stages",
    "explain": "explain an error code, or a bond, element, residual, fault or switch of a model",
    "isolate": "structural analysis: count the MSO sets, and tell the isolability that they allow",
    "sensors": "sensor placement: rank the places where one more sensor would help",
    "detect": "detectability: tell the smallest change of each fault that the residuals show",
    "simulate": "run a model as a virtual machine, with faults if the scenario has some",
    "monitor": "detect and isolate faults of a machine by its samples",
    "fit": "identify the parameters of a machine from logs of its healthy operation",
    "tune": "set thresholds for a false-alarm rate from healthy samples; tell what shows then",
    "live": "show a machine beside its virtual twin on a page, and let faults happen to the twin",
    "edit": "write a model on a page that draws and derives it while you type",
    "draw": "draw a bond graph with half arrows and causal strokes",
    "lsp": "answer an editor: findings, completion, hover and more while a model is written",
    "report": "write all that is known of a model as one HTML page",
    "complete": "print what makes a shell complete commands, options and files",
    "man": "print or write the manual pages",
}

_EPILOG = """\
MODEL is a file, or file.bg:Name for one of the models in it.
Exit status: 0 done, 1 the model is wrong or cannot be solved at all, 2 wrong usage, 3 an alarm
(`monitor --fail-on-fault`).
`bondgraph COMMAND --help` says more; docs/cli.md says all.
"""


class _Heard(argparse.ArgumentParser):
    """A parser whose help is printed, or raises OSError."""

    def _print_message(self, message: str, file: Any = None) -> None:
        stream = file or sys.stderr
        stream.write(message)
        stream.flush()


class Parser(_Heard):
    """A parser of one command: its options may stand between the other words too."""

    _inside = False

    def parse_known_args(self, args=None, namespace=None):  # type: ignore[no-untyped-def]
        """What the words mean, and those that nobody knows."""
        if self._inside:
            return super().parse_known_args(args, namespace)
        self._inside = True
        try:
            return self.parse_known_intermixed_args(args, namespace)
        finally:
            self._inside = False


def parser_for(command: str | None) -> argparse.ArgumentParser:
    """The parser with all commands; only `command` gets its arguments (None: every one)."""
    parser = _Heard(
        prog="bondgraph",
        description="Compile bond graphs into residuals that detect and isolate faults.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    version = f"bondgraph {__version__}"
    parser.add_argument("--version", action="version", version=version, help="print the version")
    commands = parser.add_subparsers(
        prog=parser.prog, dest="command", metavar="COMMAND", required=True, parser_class=Parser
    )
    for name, line in COMMANDS.items():
        sub = commands.add_parser(
            name,
            help=line,
            description=f"{line[0].upper()}{line[1:]}.",
            formatter_class=argparse.RawDescriptionHelpFormatter,
            allow_abbrev=False,
        )
        if command in (None, name):
            import_module(f"bondgraph.cli.{name}").arguments(sub)
    return parser


def subparsers(whole: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    """The parser of each command."""
    groups = [a for a in whole._actions if isinstance(a, argparse._SubParsersAction)]
    return {name: parser for group in groups for name, parser in group.choices.items()}
