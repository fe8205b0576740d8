"""Words and forms of other languages, and what this one has instead: for messages only."""

from __future__ import annotations

import re
from decimal import Decimal
from itertools import pairwise
from typing import Final

from bondgraph.frontend.cursor import Cursor
from bondgraph.frontend.words import NOT_UNITS, is_arrow, say
from bondgraph.ir.functions import FUNCTIONS
from bondgraph.text.diagnostic import Edit, Remedy, replacing
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple


class _Instead(NamedTuple):
    """What is said of a word, and the keyword that may stand in its place."""

    help: str
    keyword: str = ""


_SENSOR = _Instead(
    "What is measured is a `sensor`, `sensor {name} = shaft.f`, or a detector at a junction: "
    "`De:{name}` of its effort, `Df:{name}` of its flow.", "sensor",
)  # fmt: skip
_LET = _Instead("A value that is made of others is a `let`: `let {name} = ...`.", "let")
_PARAM = _Instead("A number of the model is a `param`, or a `const` if it cannot fail.", "param")
_STATE = _Instead(
    "States need no declaration: the law of a C has its `q`, that of an I its `p`, and `int(x)` "
    "is the integral of a signal."
)
_START = _Instead("A storage begins with what is in its brackets: `C:{name}(q0 = 0)`, p0 of an I.")
_BOND = _Instead("A bond is an arrow between two nodes: `a -> b`.")
_LAW = _Instead("A law stands in the braces of its element: `R:{name} {{ e = 2*f }}`.")
_IMPORT = _Instead('Models of another file: `import Motor from "motor.bg"`, before all models.')
_SOURCE = _Instead("A source is a node: `Se:{name} -> j` fixes an effort, `Sf:{name} -> j` a flow.")
_INPUT = _Instead("A signal that is known from outside is an `input`.", "input")
_JUNCTION = _Instead(
    "Junctions are `1:{name}`, of a common flow, and `0:{name}`, of a common effort."
)
_MODEL = _Instead(
    "A model is `model Name {{ ... }}`; a part of another one is `Name:part`.", "model"
)


def _element(kind: str, what: str) -> _Instead:
    return _Instead(f"{what} is a node `{kind}:{{name}}` at the end of an arrow.")


_MEANT: Final = {
    word: meant
    for words, meant in (
        ("output outputs out measure measurement measured observe probe monitor meter", _SENSOR),
        ("var variable variables real double float auto def define function local signal", _LET),
        ("parameter parameters number integer", _PARAM),
        ("state states der", _STATE),
        ("initial init start", _START),
        ("connect connection bond bonds wire link join", _BOND),
        ("equation equations law constitutive assert", _LAW),
        ("include use using require from", _IMPORT),
        ("source supply", _SOURCE),
        ("inputs control command disturbance", _INPUT),
        ("junction node", _JUNCTION),
        ("module class block component submodel system subsystem package entity", _MODEL),
        ("resistor damper friction", _element("R", "What dissipates")),
        ("capacitor spring tank compliance", _element("C", "What stores displacement or charge")),
        ("inductor mass inertia coil", _element("I", "What stores momentum or flux")),
        ("transformer gear lever", _element("TF", "A transformer")),
        ("gyrator", _element("GY", "A gyrator")),
        ("detector", _element("De", "What measures an effort")),
    )
    for word in words.split()
}  # fmt: skip
#: Which of them are written as calls.
_CALLED: Final = frozenset("connect bond link der init initial assert include require".split())
#: Statements of one name each, which other languages let one write several of.
_SINGLE: Final = frozenset("param const let sensor input".split())


def statement_meant(cursor: Cursor, at: int) -> str | Remedy | None:
    """What to write for the statement at word `at`, which begins with a word of elsewhere."""
    word = cursor.words[at].lower()
    meant = _MEANT.get(word) or _MEANT.get(word.removesuffix("s"))
    after = cursor.words[at + 1]
    called = after == "(" and word in _CALLED  # other words may be names of nodes
    if meant is None or cursor.fresh[at + 1] or not (after.isidentifier() or called):
        return None
    help = meant.help.format(name="x" if called else after)
    if not meant.keyword or called:
        return help
    return replacing(cursor.word_span(at), meant.keyword, help)


def several(cursor: Cursor, at: int) -> Remedy | None:
    """That each statement declares one name, where another one follows at word `at`."""
    words, begin = cursor.words, _begin(cursor, at)
    keyword = words[begin]
    if keyword not in _SINGLE or at == begin:
        return None
    if not (_another(cursor, at) or (words[at] in _SINGLE and words[at + 1].isidentifier())):
        return None
    changes: list[tuple[Span, str]] = []
    depth = 0
    while words[at] and not cursor.fresh[at] and words[at] not in (";", "}"):
        depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(words[at], 0)
        before, place = cursor.end_of(at - 1), cursor.word_span(at)
        if depth == 0 and words[at] in _SINGLE and words[at + 1].isidentifier():
            changes.append((Span(cursor.source, before.start, place.start), "; "))
        elif depth == 0 and _another(cursor, at) and words[at - 1] not in (",", *_SINGLE):
            end = cursor.starts[at + 1] if words[at] == "," else place.start
            changes.append((Span(cursor.source, before.start, end), f"; {keyword} "))
        at += 1
    edit = Edit("make a statement of each", tuple(changes))
    return Remedy(f"Each name needs its own `{keyword}`, on a line of its own or after `;`.",
                  (edit,))  # fmt: skip


def _another(cursor: Cursor, at: int) -> bool:
    """Whether another name is declared from word `at` on: `, b = 2`, or `b = 2` without comma."""
    words = cursor.words
    if words[at] == ",":
        at += 1
        return words[at].isidentifier() and words[at + 1] not in (".", "(")
    if not words[at].isidentifier() or words[at] in NOT_UNITS:
        return False
    follows = words[at - 1] not in (":", ".", "/")  # else it is of a unit
    return words[at + 1] in ("=", ":") or (words[_begin(cursor, at)] == "input" and follows)


def _begin(cursor: Cursor, at: int) -> int:
    """The first word of the statement that word `at` is in."""
    return max((b for b in cursor.notes.begins[-2:] if b <= at), default=at)


def factor(cursor: Cursor, at: int) -> Remedy | None:
    """That a product needs its sign, where word `at` follows an operand of an expression."""
    words, begin = cursor.words, _begin(cursor, at)
    word, before = words[at], words[at - 1]
    begins = word[:1].isalnum() or word == "("
    if cursor.fresh[at] or not begins or word in NOT_UNITS or word in ("then", "turn"):
        return None
    if not (before[:1].isalnum() or before in (")", "]")) or before in NOT_UNITS:
        return None
    if word == "(" and not (before[:1].isdigit() or before == ")"):
        return None
    marks = [w for w in words[begin:at] if w == "=" or is_arrow(w)]
    if marks[-1:] != ["="]:
        return None  # not in an expression
    gap = Span(cursor.source, cursor.end_of(at - 1).start, cursor.starts[at])
    if before in FUNCTIONS:
        change = Span(cursor.source, gap.start, cursor.end_of(at).start), f"({word})"
        help = f"A function has its argument in brackets: `{before}({word})`."
        return Remedy(help, (Edit(f"write `({word})`", (change,)),) if word != "(" else ())
    if words[begin] == "fault":
        return Remedy('A `fault` has no time: a scenario of `simulate` says when, `at = "2 s"`.')
    shown = say(f"{before}*{word}") if word != "(" and before != ")" else "`*`"
    return replacing(gap, "*", f"A product needs its sign: write {shown}.")


def decimal(cursor: Cursor, at: int) -> Remedy | None:
    """That a number has a point, where a comma stands between two digits."""
    text, start = cursor.source.text, cursor.starts[at]
    if cursor.words[at] != "," or not (text[start - 1] + text[start + 1 : start + 2]).isdigit():
        return None
    point = f"{cursor.words[at - 1]}.{cursor.words[at + 1]}"
    return replacing(cursor.word_span(at), ".", f"A number has a point: `{point}`.")


def percent(cursor: Cursor, at: int) -> Remedy | None:
    """That a share is a plain number: `80 %`."""
    number, start = cursor.words[at - 1], cursor.starts[at - 1]
    if cursor.words[at] != "%" or not re.fullmatch(r"\d{1,9}(\.\d{1,9})?", number):
        return None
    share = f"{(Decimal(number) / 100).normalize():f}"
    place = Span(cursor.source, start, cursor.end_of(at).start)
    help = f"A share is a plain number, `{share}`; `%` is for tolerances, as in `2 Ohm +- 5%`."
    return replacing(place, share, help) if cursor.fresh[at + 1] else Remedy(help)


def bracketed_unit(cursor: Cursor, at: int) -> Remedy | None:
    """That a unit has no brackets: `3 [Ohm]`."""
    words = cursor.words
    end = next((i for i in range(at, len(words)) if words[i] in ("]", "") or cursor.fresh[i]), at)
    if words[at] != "[" or words[end] != "]" or not words[at - 1][:1].isdigit():
        return None
    unit = cursor.source.text[cursor.end_of(at).start : cursor.starts[end]].strip()
    place = Span(cursor.source, cursor.end_of(at - 1).start, cursor.end_of(end).start)
    return replacing(place, f" {unit}", f"A unit has no brackets: `{words[at - 1]} {unit}`.")


def arrow(cursor: Cursor, at: int) -> Remedy | None:
    """That a bond is an arrow, where another sign stands between two nodes."""
    words, begin = cursor.words, _begin(cursor, at)
    if words[at] not in ("-", ">", "<", "=", "~") or "=" in words[begin:at]:
        return None
    end = at
    while words[end + 1] in ("-", ">", "=") and not cursor.fresh[end + 1]:
        end += 1
    node = words[end + 1].isidentifier() or words[end + 2] == ":"
    if not node or cursor.fresh[end + 1] or words[begin] in _SINGLE:
        return None
    back = words[at] == "<"
    place = Span(cursor.source, cursor.starts[at], cursor.starts[end] + 1)
    return replacing(place, "<-" if back else "->", "A bond is an arrow, without a space in it: "
                     "`->` or `<-`.")  # fmt: skip


def choice(cursor: Cursor, at: int) -> str | Remedy | None:
    """How an expression chooses, where word `at` is of `if ... then ... else`."""
    words = cursor.words
    if words[at] not in ("if", "then", "else", "elseif", "elif"):
        return None
    help = "An expression chooses with a function: `if(condition, a, b)`."
    begin = _begin(cursor, at)
    first = next((i for i in range(at, begin - 1, -1) if words[i] == "if"), -1)
    found = {"then": 0, "else": 0}
    end, depth = first + 1, 0
    while first >= 0 and words[end] and not cursor.fresh[end]:
        depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(words[end], 0)
        if depth < 0 or (depth == 0 and words[end] in (";", "}", ",")):
            break
        if depth == 0 and words[end] in ("if", "elseif", "elif"):
            return help
        if depth == 0 and words[end] in found:
            found[words[end]] = end
        end += 1
    if not 0 < found["then"] < found["else"] < end - 1:
        return help
    marks = (first, found["then"], found["else"], end)
    parts = [
        cursor.source.text[cursor.end_of(i).start : cursor.end_of(j - 1).start].strip()
        for i, j in pairwise(marks)
    ]
    place = Span(cursor.source, cursor.starts[first], cursor.end_of(end - 1).start)
    return replacing(place, f"if({', '.join(parts)})", help)
