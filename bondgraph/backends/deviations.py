"""Where the generated C deviates from MISRA C:2012 and the Power of 10, and why."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from functools import cache

from bondgraph.backends.templates import codegen
from bondgraph.text.numerals import joined
from bondgraph.text.tuples import NamedTuple

#: Lines of a function at most (Holzmann, The power of 10, 2006, rule 4).
LONGEST = 60
_FUNCTION = re.compile(
    r"^[a-z][\w ]*?[ *](\w+)\([^;{}()]*\)\n\{\n(.*?)^\}$", re.MULTILINE | re.DOTALL
)


class Deviation(NamedTuple):
    """A rule, its category, why, and a pattern of lines (none: every expression), or one for what
    is `shared` by several files. A loop that does not count has no rule and no category."""

    rule: str
    category: str
    why: str
    lines: str
    shared: str


@cache
def deviations(kind: str = "deviation") -> tuple[Deviation, ...]:
    """All that are known of the templates, by rule; or each `loop` that does not count."""
    with (codegen() / "c" / "misra.toml").open("rb") as file:
        found = tomllib.load(file)[kind]
    return tuple(Deviation(*(d.get(name, "") for name in Deviation._fields)) for d in found)


def places(deviation: Deviation, files: Mapping[str, str]) -> Iterator[tuple[str, int]]:
    """The files and lines in which a rule is not kept; line 0 stands for every expression."""
    pattern = re.compile(deviation.lines or deviation.shared)
    sources = [text for path, text in files.items() if path.endswith(".c")]
    for path, text in files.items():
        if not pattern.pattern and path.endswith(".c"):
            yield path, 0
        for at, line in enumerate(text.split("\n") if pattern.pattern else (), 1):
            hit = pattern.search(line)
            if hit and (not deviation.shared or _several(hit[0], sources)):
                yield path, at


def _where(deviation: Deviation, files: Mapping[str, str]) -> str:
    """The places as text: lines by file."""
    found: dict[str, list[str]] = {}
    for path, line in places(deviation, files):
        found.setdefault(path, []).append(str(line) if line else "every expression")
    return "; ".join(f"`{path}`: {', '.join(lines)}" for path, lines in found.items())


def _several(line: str, sources: Sequence[str]) -> bool:
    """Whether more than one file has a line that begins so."""
    return sum(f"\n{line}" in text for text in sources) > 1


def long_functions(files: Mapping[str, str]) -> Iterator[tuple[str, str, int]]:
    """The functions with more than 60 lines: the file, the name, how many."""
    for path, text in files.items():
        for name, body in _FUNCTION.findall(text):
            if body.count("\n") > LONGEST:
                yield path, name, body.count("\n")


def record(files: Mapping[str, str]) -> dict[str, object]:
    """The holes of misra.md.j2 for the files of C by path: without tests, example and boards."""
    beside = ("tests/", "example/", "qemu/")
    code = {
        path: text
        for path, text in files.items()
        if path.endswith((".c", ".h")) and not path.startswith(beside)
    }
    rows, loops = (
        [(one, where) for one in deviations(kind) if (where := _where(one, code))]
        for kind in ("deviation", "loop")
    )
    long = long_functions(code)
    return {
        "code": joined(f"`{path}`" for path in code),
        "misra": [f"| {d.rule} | {d.category} | {where} | {d.why} |" for d, where in rows],
        "loops": [f"| {where} | {loop.why} |" for loop, where in loops],
        "long": [f"| `{path}` | `{name}` | {count} |" for path, name, count in long],
    }
