"""How a command is found and run, and what a failure looks like to the user."""

from __future__ import annotations

import atexit
import errno
import gc
import os
import sys
import warnings

from bondgraph import __version__
from bondgraph.cli.terminal import printable_streams

TYPE_CHECKING = False
if TYPE_CHECKING:
    from argparse import Namespace
    from collections.abc import Sequence
    from types import SimpleNamespace

# What a command makes is kept to its end: looking for garbage is in vain, then too.
gc.set_threshold(100_000, 20, 20)
atexit.register(gc.freeze)

_WATCHES = ("monitor", "fit", "tune", "live")  # commands of many small matrices


def plain_check(words: list[str]) -> SimpleNamespace | None:
    """What the parser makes of `check MODEL ...`, if that is what the words are.

    Editors run this at every change of a model; reading it without argparse saves a tenth.
    """
    models = [word for word in words[1:] if word != "--json"]
    if words[:1] != ["check"] or not models or any(word.startswith("-") for word in models):
        return None
    from types import SimpleNamespace

    return SimpleNamespace(
        command="check", models=models, json="--json" in words, format="text", strict=False,
        quiet=False, watch=False,
    )  # fmt: skip


def parsed(words: list[str]) -> SimpleNamespace | Namespace:
    """The words of the command line, understood; leaves with help or usage if they are not."""
    plain = plain_check(words)
    if plain is not None:
        return plain
    from bondgraph.cli.usage import COMMANDS, parser_for

    named = next((w for w in words if not w.startswith("-")), "")
    if named and named not in COMMANDS:
        from bondgraph.cli.console import hint

        print(f"error: there is no command `{named}`{hint(named, COMMANDS)}", file=sys.stderr)
        sys.exit(2)
    return parser_for(named).parse_args(words)


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; the exit status is 0 (done), 1 (wrong model) or 2 (wrong usage)."""
    words = list(sys.argv[1:] if argv is None else argv)
    if argv is None and words[:1] == ["compile"]:  # what it makes is kept until it ends
        gc.disable()
    if argv is None and not sys.warnoptions:  # numbers beyond all bounds are told as such
        warnings.filterwarnings("ignore", category=RuntimeWarning)
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # closed by who started us
            setattr(sys, name, open(os.devnull, "w"))  # noqa: SIM115 (until the end)
    with printable_streams():
        return _guarded(words)


def _guarded(words: list[str]) -> int:
    try:
        if words == ["--version"]:  # before anything is loaded
            print("bondgraph", __version__, flush=True)
            return 0
        return _run(parsed(words))
    except BrokenPipeError:
        # The reader has gone (`bondgraph dump ... | head`): not an error of anybody.
        _silence()
        return 0
    except OSError as error:  # to tell it was in vain
        print(f"error: {_reason(error)}", file=sys.stderr)
        _silence()
        return 1


#: What only files without a name can say here: the output stream.
_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}


def _reason(error: OSError) -> str:
    """What has failed, in one line."""
    why = error.strerror or str(error)
    if error.filename:
        return f"{why}: {error.filename}"
    return f"the output cannot be written: {why}" if error.errno in _FULL else why


def _silence() -> None:
    """What is left of the output goes nowhere, so that the interpreter can end in peace."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _run(args: SimpleNamespace | Namespace) -> int:
    from importlib import import_module

    from bondgraph.cli import console
    from bondgraph.runtime import threads
    from bondgraph.text.diagnostic import CompileError, Trouble

    if args.command in _WATCHES:
        threads.one()
    command = import_module(f"bondgraph.cli.{args.command}")
    as_json = bool(getattr(args, "json", False))
    try:
        status = int(command.run(args))
        sys.stdout.flush()
        return status
    except CompileError as error:
        status = console.failed(error, as_json)
        sys.stdout.flush()
        return status
    except BrokenPipeError:
        raise
    except KeyboardInterrupt:
        print("interrupted, nothing half written", file=sys.stderr)
        return 130
    except console.Unknown as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except Trouble as error:
        return console.broken(str(error), as_json)
    except OSError as error:
        if error.errno in _FULL and not error.filename:
            raise
        return console.broken(_reason(error), as_json)
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
