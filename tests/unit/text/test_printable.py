"""What may be printed: every control, mark of direction and half surrogate is kept out, no more."""

from __future__ import annotations

import json
import sys
import unicodedata

from bondgraph.text.printable import json_text, printable, printable_values

#: Format characters that change no direction and end nothing: joiners, soft hyphens, signs of
#: scripts and of music, operators of MathML that are not seen, a mark of byte order.
_HARMLESS = {0xAD, 0x200B, 0x200C, 0x200D, *range(0x2060, 0x2065), 0xFEFF}


def test_what_is_kept_out() -> None:
    raw = {c for c in range(sys.maxunicode + 1) if printable(chr(c)) != chr(c)}
    for c in range(sys.maxunicode + 1):
        kind, bidi = unicodedata.category(chr(c)), unicodedata.bidirectional(chr(c))
        turns = bidi in {"LRE", "RLE", "LRO", "RLO", "PDF", "LRI", "RLI", "FSI", "PDI"}
        marks = chr(c) in "\u200e\u200f\u061c"
        if kind == "Cc" and chr(c) not in "\n\t":
            assert c in raw
        if kind in ("Cs", "Zl", "Zp") or turns or marks:
            assert c in raw, hex(c)
        if kind[0] in "LMNPS" or c in _HARMLESS or kind == "Zs":
            assert c not in raw or unicodedata.name(chr(c), "").startswith("VARIATION"), hex(c)


def test_line_ends_and_tabs_stay() -> None:
    assert printable("a\tb\nc\r\n\x0b") == "a\tb\nc\ufffd\n\ufffd"


def test_names_inside_of_data() -> None:
    found = printable_values({"\x1b": [("\u202e", 1.5, None)]})
    assert found == {"\ufffd": [["\ufffd", 1.5, None]]}


def test_json_says_each_character_and_shows_none() -> None:
    value = {"é\x1b\u2066\udcff\U000e0001": ["\x7f\x85\n", 1.5]}
    text = json_text(value)
    assert printable(text) == text and "é" in text
    assert json.loads(text) == value
