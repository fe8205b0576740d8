"""What can be counted about how the package is built: `python -m tests.house`.

Circles of imports, module names that serve twice, functions that ask for three or more kinds of
node, files that know a function of the language, words that are defined twice, statements.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import networkx as nx

ROOT = Path(__file__).parents[1]

#: Functions of the language whose names nothing else has.
_OWN_NAMES = frozenset({"acosh", "asinh", "atanh", "cbrt", "ssq", "ssqrt"})

#: Questions about expressions, and things that every layer needs: each is defined once.
WORDS = (
    "affine constant first_degree has holding linear_terms occurs rebuilt symbols topological"
    " variables Groups"
).split()


class Module(NamedTuple):
    """A file of the package: its dotted name, its syntax tree and how many lines it has."""

    name: str
    tree: ast.Module
    lines: int


@cache
def modules() -> list[Module]:
    """All files of the package, read at the first call."""
    found = []
    for file in sorted((ROOT / "bondgraph").rglob("*.py")):
        parts = file.relative_to(ROOT).with_suffix("").parts
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        text = file.read_text()
        found.append(Module(name, ast.parse(text), text.count("\n")))
    return found


def circles(files: list[Module]) -> list[list[str]]:
    """Modules that import each other, wherever in the file the import stands."""
    names = {m.name for m in files}
    graph: nx.DiGraph[str] = nx.DiGraph()
    for module in files:
        for node in ast.walk(module.tree):
            if isinstance(node, ast.ImportFrom) and node.module:
                for alias in node.names:
                    whole = f"{node.module}.{alias.name}"
                    graph.add_edge(module.name, whole if whole in names else node.module)
    return sorted(sorted(c) for c in nx.strongly_connected_components(graph) if len(c) > 1)


def names_met_twice(files: list[Module]) -> list[str]:
    """Last parts of module names that more than one module has."""
    packages = {m.name.rpartition(".")[0] for m in files}
    count = Counter(m.name.rpartition(".")[2] for m in files if m.name not in packages)
    return sorted(name for name, times in count.items() if times > 1)


def dispatchers(files: list[Module]) -> list[str]:
    """Functions that compare with, or match, three or more kinds of node."""
    found = []
    for module in files:
        for function in ast.walk(module.tree):
            if isinstance(function, ast.FunctionDef) and len(set(_kinds(function))) > 2:
                found.append(f"{module.name}.{function.name}")
    return found


def _kinds(function: ast.FunctionDef) -> Iterator[str]:
    """The members of `Op` that a function compares with or matches."""
    for node in ast.walk(function):
        asked = node if isinstance(node, ast.Compare) else getattr(node, "pattern", None)
        for part in ast.walk(asked) if asked is not None else ():
            if isinstance(part, ast.Attribute) and ast.unparse(part.value) == "Op":
                yield part.attr


def knowing_functions(files: list[Module]) -> list[str]:
    """Modules in which a function of the language stands by its name."""
    found = []
    for module in files:
        texts = {
            word
            for node in ast.walk(module.tree)
            if isinstance(node, ast.Constant) and isinstance(node.value, str)
            for word in node.value.split()
            if not _is_prose(node.value)
        }
        if texts & _OWN_NAMES:
            found.append(module.name)
    return found


def _is_prose(text: str) -> bool:
    """Whether a text is a docstring or a message, and no list of names."""
    return any(c in text for c in ".,`:") or "\n" in text


def definitions(files: list[Module], word: str) -> list[str]:
    """The modules that define a function or class of that name, a leading underscore aside.

    The oracle has words of its own: it shares nothing but arithmetic.
    """
    return [
        module.name
        for module in files
        if not module.name.startswith("bondgraph.exact.")
        for node in module.tree.body
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and node.name.strip("_") == word
    ]


def statements(files: list[Module]) -> int:
    """Statements without docstrings."""
    every = [n for m in files for n in ast.walk(m.tree) if isinstance(n, ast.stmt)]
    return sum(not _is_docstring(n) for n in every)


def _is_docstring(node: ast.stmt) -> bool:
    value = node.value if isinstance(node, ast.Expr) else None
    return isinstance(value, ast.Constant) and isinstance(value.value, str)


def main() -> None:
    """Print what is counted."""
    files = modules()
    print(f"{len(files)} modules, {statements(files)} statements")
    for title, found in (
        ("circles of imports", [" <-> ".join(c) for c in circles(files)]),
        ("module names met twice", names_met_twice(files)),
        ("functions that ask for three or more kinds of node", dispatchers(files)),
        ("modules that know functions of the language by name", knowing_functions(files)),
        ("words defined twice", [w for w in WORDS if len(definitions(files, w)) > 1]),
    ):
        print(f"\n{len(found)} {title}")
        print("".join(f"    {line}\n" for line in found), end="")


if __name__ == "__main__":
    main()
