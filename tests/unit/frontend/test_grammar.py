"""The parser accepts what a second, independent grammar accepts, and nothing else."""

from __future__ import annotations

import random
import re
from functools import cache
from pathlib import Path

import pytest

from tests.unit.frontend import corpus, trees

lark = pytest.importorskip("lark")

_PIECE = re.compile(r'"[^"\n]*"?|#[^\n]*|\n|<-\[\w+\]-|-\[\w+\]->|->|<-|[<>=!+*]=|\+-|\w+|.', re.S)
_GOES_ON = re.compile(r"(->|<-|\]-|[-+*/^,=(<>{]|\+-|±|\b(?:and|or|not))$")


@cache
def _oracle() -> lark.Lark:
    text = (Path(__file__).parent / "grammar.lark").read_text(encoding="utf-8")
    return lark.Lark(text, parser="earley", lexer="dynamic")


def _line_ends(text: str) -> str:
    """The text with comments gone and each line end made a `;`, or blanks where it means nothing.

    Two blanks, since one blank could make a unit of what follows a number.
    """
    out = ""
    depth = 0
    for piece in _PIECE.findall(text):
        if piece.startswith("#"):
            continue
        if piece == "\n":
            out += "  " if depth or _GOES_ON.search(out.rstrip()) else ";"
            continue
        if piece == "else":
            out = re.sub(r"\}[;\s]*$", "} ", out)
        depth += (piece in "([") - (piece in ")]")
        out += piece
    return out


def accepted(text: str) -> bool:
    """Whether the grammar accepts the text."""
    try:
        _oracle().parse(_line_ends(text))
    except lark.exceptions.UnexpectedInput:
        return False
    return True


def _parsed(text: str) -> bool:
    return not trees.read(text)[1].diagnostics


@pytest.mark.parametrize("body", corpus.RIGHT)
def test_right_statements(body: str) -> None:
    trees.inside(body)
    assert accepted(corpus.whole(body))


@pytest.mark.parametrize("body", corpus.WRONG)
def test_wrong_statements(body: str) -> None:
    text = corpus.whole(body)
    assert [d.code for d in trees.read(text)[1].diagnostics] != []
    assert not accepted(text)


@pytest.mark.parametrize("text", corpus.FILES_RIGHT)
def test_right_files(text: str) -> None:
    trees.good(text)
    assert accepted(text)


@pytest.mark.parametrize("text", corpus.FILES_WRONG)
def test_wrong_files(text: str) -> None:
    assert not _parsed(text)
    assert not accepted(text)


def test_the_sample_model() -> None:
    assert [m.name for m in trees.good(corpus.sample()).models] == [
        "Electrical", "Mechanical", "Gear", "Wheel", "Drive", "Cell", "Cable", "Khepera"
    ]  # fmt: skip
    for model in re.split(r"\n(?=model)", corpus.sample())[1:]:
        assert accepted("bg 1\n" + model)


def test_mutations() -> None:
    """Right statements with one word left out, doubled or exchanged: the same verdict."""
    chance = random.Random(1)
    for _ in range(150):
        body = chance.choice(corpus.RIGHT)
        pieces = [p for p in _PIECE.findall(body) if not p.startswith("#")]
        if not pieces:
            continue
        at = chance.randrange(len(pieces))
        match chance.randrange(3):
            case 0:
                del pieces[at]
            case 1:
                pieces.insert(at, pieces[at])
            case _:
                other = chance.randrange(len(pieces))
                pieces[at], pieces[other] = pieces[other], pieces[at]
        text = corpus.whole("".join(pieces))
        if not re.search(r"= ?[^;(]*<-", text):  # in the value of a node, `<-` is always an arrow
            assert _parsed(text) == accepted(text), text
