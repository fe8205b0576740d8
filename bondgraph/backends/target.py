"""A target language as its `target.toml` describes it."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import cache

from bondgraph.backends.templates import codegen
from bondgraph.notation.dialect import Dialect
from bondgraph.text.tuples import NamedTuple


class Statements(NamedTuple):
    """How statements and comments are written.

    `comment` is what opens it, begins its further lines and closes it, `brackets` stand around a
    value that needs several lines, `unforeseen` may not occur in a comment: each with what
    replaces it. `declared` goes before a `branch` that assigns it: its lines before either side
    and at the end, those that the language needs.
    """

    comment: tuple[str, str, str]
    brackets: tuple[str, str]
    local: str
    assign: str
    declared: str
    branch: tuple[str, str, str]
    dot: str
    unforeseen: tuple[tuple[str, str], ...]


class Target(NamedTuple):
    """One folder of codegen/: which template makes which file, and how values are written.

    `configure` is the dialect of `configure`, which brings its own exponential function. A member
    of a struct may not be one of `words`, a local variable not one of `reserved`. `extras` are
    files for who asks for them, `fixed` those in whole numbers, none where a language has no need.
    """

    folder: str
    name: str
    width: int
    tab: int
    files: tuple[tuple[str, str], ...]
    extras: Mapping[str, tuple[tuple[str, str], ...]]
    fixed: tuple[tuple[str, str], ...]
    statements: Statements
    reference: Mapping[str, str]
    dialect: Dialect
    configure: Dialect
    words: frozenset[str]
    reserved: frozenset[str]


def targets() -> tuple[str, ...]:
    """The languages there are: the folders of codegen/ with a target.toml, in order."""
    return tuple(sorted(p.parent.name for p in codegen().glob("*/target.toml")))


@cache
def load(folder: str) -> Target:
    """The target `folder`; raises ValueError for a language that is not there."""
    if folder not in targets():
        raise ValueError(f"no target {folder!r}; there are {', '.join(targets())}")
    with (codegen() / folder / "target.toml").open("rb") as file:
        data = tomllib.load(file)
    functions = dict(data["functions"])
    own_exp = {"exp": functions.pop("configure_exp")}
    statement = data["statement"]
    opening, closing = statement["brackets"]
    begin, go_on, end = statement["comment"]
    if_, else_, done = statement["branch"]
    return Target(
        folder,
        data["name"],
        data["width"],
        data["tab"],
        _paths(folder, data["files"]),
        {name: _paths(folder, files) for name, files in data["extras"].items()},
        _paths(folder, data.get("fixed", {})),
        Statements(
            (begin, go_on, end),
            (opening, closing),
            statement["local"],
            statement["assign"],
            statement["declared"],
            (if_, else_, done),
            statement["dot"],
            tuple((bad, good) for bad, good in statement["unforeseen"]),
        ),
        data["reference"],
        Dialect(functions=functions, **data["expression"]),
        Dialect(functions=functions | own_exp, **data["expression"]),
        frozenset(data["names"]["words"].split()),
        frozenset((data["names"]["templates"] + data["names"]["words"]).split()),
    )


def _paths(folder: str, files: Mapping[str, str]) -> tuple[tuple[str, str], ...]:
    return tuple((f"{folder}/{template}", path) for template, path in files.items())
