"""`bondgraph man`: the manual pages, made of the help of the commands."""

from __future__ import annotations

import argparse
from argparse import ArgumentParser, Namespace
from pathlib import Path

from bondgraph import __version__
from bondgraph.cli import console
from bondgraph.cli.usage import COMMANDS, parser_for, subparsers
from bondgraph.text.whole_file import write_whole


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `man`."""
    parser.add_argument(
        "name", metavar="COMMAND", nargs="?", help="the page of a command (default: of all)"
    )
    parser.add_argument(
        "-o", "--output", metavar="DIR", help="write all pages into a folder, as bondgraph-check.1"
    )


def run(args: Namespace) -> int:
    """Print one page, or write all of them."""
    if args.name is not None and args.name not in COMMANDS:
        raise console.Unknown(args.name, "no command", list(COMMANDS))
    pages = manual_pages()
    if args.output is None:
        print(pages[f"bondgraph-{args.name}.1" if args.name else "bondgraph.1"], end="")
        return 0
    folder = Path(args.output)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in pages.items():
        write_whole(folder / name, text)
    print(f"{len(pages)} pages in {folder}")
    return 0


def manual_pages() -> dict[str, str]:
    """The text of each page in roff, by the name of its file.

    >>> manual_pages()["bondgraph-man.1"].splitlines()[2:4]
    ['.SH NAME', 'bondgraph\\\\-man \\\\- print or write the manual pages']
    """
    whole = parser_for(None)
    found = {"bondgraph.1": _page(whole, "bondgraph", "compile bond graphs into residuals")}
    for name, parser in subparsers(whole).items():
        found[f"bondgraph-{name}.1"] = _page(parser, f"bondgraph-{name}", COMMANDS[name])
    return found


def _page(parser: ArgumentParser, name: str, line: str) -> str:
    """One page: name, synopsis, description, arguments, options, what else there is to say."""
    usage = " ".join(parser.format_usage().removeprefix("usage: ").split())
    rows = [
        f".TH {_roff(name.upper())} 1 \"\" {_quoted(f'bondgraph {__version__}')}",
        ".nh",
        ".SH NAME",
        f"{_roff(name)} \\- {_roff(line)}",
        ".SH SYNOPSIS",
        _roff(usage),
        ".SH DESCRIPTION",
        _roff(parser.description or line),
    ]
    given = [a for a in parser._actions if not a.option_strings]
    options = [a for a in parser._actions if a.option_strings]
    listed = [(n, t) for a in given for n, t in _arguments(a)]
    if listed:
        rows += [".SH " + ("COMMANDS" if name == "bondgraph" else "ARGUMENTS")]
        rows += [row for entry in listed for row in _entry(*entry)]
    rows.append(".SH OPTIONS")
    for action in options:
        names = ", ".join(action.option_strings)
        value = "" if action.nargs == 0 else f" {_metavar(action)}"
        rows += _entry(names + value, _help(parser, action))
    if parser.epilog:
        rows += [".SH NOTES", *[_roff(text) + "\n.br" for text in parser.epilog.splitlines()]]
    if name == "bondgraph":
        rows += [".SH SEE ALSO", ", ".join(f"\\fBbondgraph\\-{c}\\fR(1)" for c in COMMANDS)]
    else:
        rows += [".SH SEE ALSO", "\\fBbondgraph\\fR(1)"]
    return "\n".join(rows) + "\n"


def _arguments(action: argparse.Action) -> list[tuple[str, str]]:
    """A positional argument, or each command."""
    if isinstance(action, argparse._SubParsersAction):
        return [(own.dest, own.help or "") for own in action._choices_actions]
    return [(_metavar(action), action.help or "")]


def _metavar(action: argparse.Action) -> str:
    if isinstance(action.metavar, tuple):
        return " ".join(action.metavar)
    return action.metavar or (
        "|".join(map(str, action.choices)) if action.choices else action.dest.upper()
    )


def _help(parser: ArgumentParser, action: argparse.Action) -> str:
    """The help of an option, its holes filled."""
    return parser._get_formatter()._expand_help(action) if action.help else ""


def _entry(head: str, text: str) -> list[str]:
    return [".TP", f"\\fB{_roff(head)}\\fR", _roff(text)]


def _roff(text: str) -> str:
    """A text in which nothing is a request or an escape of roff."""
    safe = text.replace("\\", "\\e").replace("-", "\\-")
    return "\n".join(f"\\&{line}" if line[:1] in (".", "'") else line for line in safe.split("\n"))


def _quoted(text: str) -> str:
    return f'"{_roff(text)}"'
