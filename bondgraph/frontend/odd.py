"""Words that are wrong wherever they stand, and what their author probably meant."""

from __future__ import annotations

import re
from typing import Final

from bondgraph.frontend.words import NOT_UNITS, say
from bondgraph.text.limits import NAME_LETTERS
from bondgraph.text.tuples import NamedTuple


class Odd(NamedTuple):
    """What is wrong with the word number `at`, and the remedy.

    `change` is the remedy as a change of the text: from a place to a place, and what to write.
    """

    code: str
    message: str
    at: int
    label: str
    help: str
    change: tuple[int, int, str] | None = None


#: What to write instead of a character, or of two, that the language does not have.
_INSTEAD: Final = {
    "&": "`and`", "&&": "`and`", "!": "`not`", "**": "`^`",
    "|": "`abs(x)` for an absolute value, `or` between conditions", "||": "`or`",
    "'": 'double quotes, `"file.bg"`', "−": "a plain minus, `-`", "–": "a plain minus, `-`",
    "—": "a plain minus, `-`", "→": "`->`", "⇀": "`->`", "←": "`<-`", "↼": "`<-`", "×": "`*`",
    "·": "`*` (`.` in a unit)", "⋅": "`*` (`.` in a unit)", "÷": "`/`", "≤": "`<=`", "≥": "`>=`",
    "≠": "`!=`", "“": '`"`', "”": '`"`', "„": '`"`', "\u00a0": "a plain space",
    "\u200b": "nothing: it is an invisible space", "\u2009": "a plain space",
    "\u202f": "a plain space", "//": "`#` for a comment", "/*": "`#` for a comment",
    "=>": "`->` for a bond, `>=` for a comparison", "-->": "`->`", "<--": "`<-`",
    "?": "`if(condition, a, b)` to choose", "\x0c": "a line end", "+/-": "`+-`", "+/−": "`+-`",
}  # fmt: skip
_PLAIN: Final = frozenset('+-*/^<>=(){}[],;:.%"±')
_GREEK: Final = dict(
    zip(
        "αβγδεζηθικλμνξοπρστυφχψωΓΔΘΛΞΠΣΦΨΩϕϑϵ",
        "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi omicron pi rho "
        "sigma tau upsilon phi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega "
        "phi theta epsilon".split(),
        strict=True,
    )
)


def odd(text: str, words: list[str], starts: list[int], at: int) -> Odd | None:
    """What is wrong with word `at` in itself, or None if it is only in the wrong place."""
    word = words[at]
    if not word:
        return None
    if word[0] == '"' and (len(word) == 1 or word[-1] != '"'):
        return Odd(
            "syntax-unclosed", "This string is not closed on its line.", at, "opened here",
            'Close it with `"`.',
        )  # fmt: skip
    return _odd_number(text, words, starts, at) or _odd_sign(text, words, starts, at)


def _odd_number(text: str, words: list[str], starts: list[int], at: int) -> Odd | None:
    word, before = words[at], words[at - 1] if at else ""
    if word == "." and re.match(r"\.[0-9]", text[starts[at] :][:2]):
        digits = words[at + 1]
        return Odd(
            "number-form", f"A number begins with a digit: I found `.{digits}`.", at,
            "a digit is missing before this point", f"Write `0.{digits}`.",
            (starts[at], starts[at] + 1, "0."),
        )  # fmt: skip
    if not before[:1].isdigit():
        return None
    gap = text[starts[at - 1] + len(before) : starts[at]]
    if word == "." and not gap:
        return Odd(
            "number-form", f"A number ends with a digit: I found `{before}.`.", at,
            "a digit is missing after this point", f"Write `{before}` or `{before}.0`.",
            (starts[at], starts[at] + 1, ".0"),
        )  # fmt: skip
    if (word[0].isalpha() or word[0] == "°") and gap != " " and "\n" not in gap:
        if word in NOT_UNITS:
            what = f"A space is missing in {say(before + word)}."
            help = f"Write `{before} {word}`."
            change = (starts[at - 1], starts[at] + len(word), f"{before} {word}")
            return None if gap else Odd("unit-space", what, at, "before this word", help, change)
        return Odd(
            "unit-space",
            f"A unit follows its number after exactly one space: I found {say(before + gap + word)}"
            ".", at, "is this the unit?",
            f"Write `{before} {word}` for a unit, `{before}*{word}` for a product.",
            (starts[at - 1], starts[at] + len(word), f"{before} {word}"),
        )  # fmt: skip
    return None


def _odd_sign(text: str, words: list[str], starts: list[int], at: int) -> Odd | None:
    word, start = words[at], starts[at]
    if word[0].isalpha() and not word.isidentifier():
        name = odd_name(word)
        change = name.change and (start, start + len(word), name.change[2])
        return name._replace(at=at, change=change)
    for there in (start, start - 1):
        for length in (3, 2):
            found = text[there : there + length]
            if there >= 0 and there + length > start and found in _INSTEAD:
                return _character(text, found, at, there)
    if word == "+-":
        return Odd(
            "tolerance-misplaced",
            "`+-` is the sign of a tolerance, which follows the value of a `param`, `const` or "
            "element.", at, "no tolerance can stand here",
            "Write `a - b`, or `a + (-b)` with a space, if a sum is meant.",
        )  # fmt: skip
    if len(word) > 1 or word.isalnum() or word in _PLAIN or word == "_":
        return None
    return _character(text, word, at, start)


def _character(text: str, found: str, at: int, start: int) -> Odd:
    own = re.search(r"(?:[a-zA-Z][\w.\[\]]*|\))\Z", text[max(0, start - 40) : start])
    if found == "'" and own is not None:
        place = (start - len(own[0]), start + 1, f"der({own[0]})")
        return Odd(
            "syntax-character", "The language has no `'`.", at, "here",
            f"Write `der({'...' if own[0] == ')' else own[0]})` for a derivative in time.",
            None if own[0] == ")" else place,
        )  # fmt: skip
    shown = say(found) if found.isprintable() and found.strip() else f"U+{ord(found[0]):04X}"
    instead = _INSTEAD.get(found)
    plain = re.match("`([^`]+)`", instead or "")
    new = plain[1] if plain else {"a plain space": " ", "a line end": "\n"}.get(instead or "", "")
    if instead is not None and instead.startswith("a plain minus"):
        new = "-"
    return Odd(
        "syntax-character",
        f"The language has no {shown}.",
        at,
        "here",
        f"Write {instead}." if instead else "Remove it; in a comment, after `#`, it may stay.",
        None if found in "'?|" else (start, start + len(found), new),
    )


def odd_name(word: str) -> Odd:
    """Why the generated code could not spell this name."""
    if len(word) > NAME_LETTERS:
        return Odd(
            "name-letters",
            f"The name {say(word[:20])}... has {len(word)} letters: {NAME_LETTERS} are the most,"
            " since files are called by it.", 0, "this name",
            "Say in a comment, after `#` or `##`, what a name cannot say.",
        )  # fmt: skip
    if "__" in word and word.isascii():
        shorter = re.sub("_+", "_", word).strip("_") or "x"
        return Odd(
            "name-double-underscore",
            f"The name {say(word)} contains two underscores in a row, which the generated code "
            "uses for the points of a path (`m[1].el` becomes `m__1__el`).", 0, "this name",
            f"Write `{shorter}`.", (0, len(word), shorter),
        )  # fmt: skip
    plain = "".join(_GREEK.get(c, c if c.isascii() and c.isalnum() else "_") for c in word)
    plain = re.sub("_+", "_", plain).strip("_") or "x"
    plain = plain if plain[0].isalpha() else "x" + plain
    return Odd(
        "name-letters",
        f"The name {say(word)} cannot be spelled in the generated code: a name begins with a "
        "letter and has the letters a to z, digits and `_`.", 0, "this name",
        f"Write, for instance, `{plain}`.", (0, len(word), plain),
    )  # fmt: skip
