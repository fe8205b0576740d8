"""Names of the model as identifiers of a target language."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache

_INDEX = re.compile(r"\[(\d+)\]")
_FOREIGN = re.compile(r"[^A-Za-z0-9_]")


@lru_cache(maxsize=1 << 14)  # each language, and each part of its code, asks for the same names
def identifier(path: str) -> str:
    """A name of the model as an identifier: `.` and `[i]` become `__`, other letters their code.

    Different names of a model stay different, because a name in a model contains no `__`.

    >>> identifier("m[1].wh.ws")
    'm__1__wh__ws'
    >>> identifier("2x"), identifier("θ")
    ('_2x', 'u3b8')
    """
    text = _INDEX.sub(r"__\1", path).replace(".", "__")
    text = _FOREIGN.sub(lambda found: f"u{ord(found.group()):x}", text)
    return f"_{text}" if not text or text[0].isdigit() else text


def spellings(names: Iterable[str], reserved: frozenset[str]) -> dict[str, str]:
    """Each name with the identifier it gets: no reserved word, no identifier twice.

    A name that is free as it is keeps itself; the others get a trailing `_`, in the order given.

    >>> spellings(["int", "int_", "a[1]"], frozenset({"int"}))
    {'int': 'int__', 'int_': 'int_', 'a[1]': 'a__1'}
    """
    wanted = {name: identifier(name) for name in names}
    found: dict[str, str] = {}
    taken: set[str] = set()
    for name, own in wanted.items():
        if own not in reserved and own not in taken:
            found[name] = own
            taken.add(own)
    for name, own in wanted.items():
        if name not in found:
            while own in reserved or own in taken:
                own += "_"
            found[name] = own
            taken.add(own)
    return {name: found[name] for name in wanted}


def snake(name: str) -> str:
    """The name of a model as the stem of files and functions.

    >>> snake("Khepera"), snake("TwoTanks"), snake("RC"), snake("2-mass")
    ('khepera', 'two_tanks', 'rc', '_2_mass')
    """
    text = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
    text = re.sub(r"[^a-z0-9]+", "_", text).strip("_") or "model"
    return f"_{text}" if text[0].isdigit() else text
