"""Which commands there are, how they are found, and what a failure looks like to the user."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from importlib import import_module

from bondgraph.cli import console
from bondgraph.text.diagnostic import CompileError

#: Every command with its one line; the module of the same name has `arguments` and `run`.
COMMANDS = {
    "check": "say whether models are sound: syntax, names, units, causality",
    "format": "write models in the one style they are all written in",
    "compile": "make residuals, fault signatures and code from a model",
    "dump": "print what the compiler knows about a model at one of its stages",
    "explain": "explain an error code, or a bond, element, residual or fault of a model",
    "draw": "draw a bond graph with half arrows and causal strokes",
}

_EPILOG = """\
MODEL is a file, or file.bg:Name for one of the models in it.
Exit status: 0 done, 1 the model is wrong or cannot be solved, 2 wrong usage.
`bondgraph COMMAND --help` says more; docs/cli.md says all.
"""


class Version(argparse.Action):
    """Print the version; looked up only when asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object, **__: object) -> None:
        """Print and leave."""
        from importlib.metadata import PackageNotFoundError, version

        try:
            print("bondgraph", version("bondgraph-arr"))
        except PackageNotFoundError:
            print("bondgraph (from a checkout that is not installed)")
        parser.exit(0)


def parser_for(command: str | None) -> argparse.ArgumentParser:
    """The parser with all commands; only `command` gets its arguments (None: every one)."""
    parser = argparse.ArgumentParser(
        prog="bondgraph",
        description="Compile bond graphs into residuals that detect and isolate faults.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument(
        "--version", action=Version, nargs=0, default=argparse.SUPPRESS, help="print the version"
    )
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
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


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; the exit status is 0 (done), 1 (wrong model) or 2 (wrong usage)."""
    words = list(sys.argv[1:] if argv is None else argv)
    named = next((w for w in words if not w.startswith("-")), "")
    args = parser_for(named).parse_args(words)
    command = import_module(f"bondgraph.cli.{args.command}")
    as_json = bool(getattr(args, "json", False))
    try:
        status = int(command.run(args))
        sys.stdout.flush()
        return status
    except CompileError as error:
        return console.failed(error, as_json)
    except BrokenPipeError:
        # The reader has gone (`bondgraph dump ... | head`): not an error of anybody.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except KeyboardInterrupt:
        print("interrupted, nothing half written", file=sys.stderr)
        return 130
    except console.Trouble as error:
        return console.broken(str(error), as_json)
    except OSError as error:
        return console.broken(f"{error.strerror}: {error.filename}", as_json)
    except Exception as error:
        if os.environ.get("BONDGRAPH_TRACEBACK"):
            raise
        return console.broken(
            f"the compiler failed: {type(error).__name__}: {error}\n"
            "this is a bug in bondgraph, not in your model; please report it with the model and"
            " the traceback that BONDGRAPH_TRACEBACK=1 prints",
            as_json,
        )


if __name__ == "__main__":
    sys.exit(main())
