"""Recognises files that are not written in the language: empty, binary, YAML, JSON, Modelica."""

from __future__ import annotations

import re

from bondgraph.text.diagnostic import Diagnostic, Label
from bondgraph.text.source import Source, Span

_BLANK = re.compile(r"(?:\s|\ufeff|#[^\n]*)*")
_YAML = re.compile(r"^(?:---|%YAML)|^[ ]*(?:version|root|models|components|netlist)[ ]*:", re.M)
_BOND_GRAPH_TOOLS = re.compile(r"^[ ]*(?:models|netlist|components)[ ]*:", re.M)
_MODELICA = re.compile(
    r"^\s*(?:end\s+\w+\s*;|equation\b|within\b[^\n]*;|annotation\s*\(|extends\s+[\w.]+)", re.M
)
#: Enough of a file to know what it is.
_LOOK = 20_000


def not_bondgraph(source: Source) -> Diagnostic | None:
    """What `source` is, if it is plainly no `.bg` file; it is known not to begin with `bg 1`.

    The BondGraphTools package also uses the ending `.bg`, for YAML.
    """
    text = source.text
    if "\0" in text[:_LOOK]:
        return _foreign(
            source, "not-text", text.index("\0"), "The file is not text: it contains zero bytes.",
            "Give the command a model file; a compiled or packed file is none.",
        )  # fmt: skip
    blank = _BLANK.match(text)
    begin = blank.end() if blank else 0
    if begin == len(text):
        return _foreign(
            source, "empty-file", 0, "The file is empty: there is no model in it.",
            "A smallest file is `bg 1`, then `model Name { ... }` in the next line.",
        )  # fmt: skip
    head = text[begin : begin + _LOOK]
    if head[0] in "{[":
        return _foreign(
            source, "not-bondgraph-json", begin, "The file looks like JSON, not like a bond graph.",
            "Give the command the `.bg` file that describes the model.",
        )  # fmt: skip
    yaml = _YAML.search(head)
    if yaml is not None:
        tools = _BOND_GRAPH_TOOLS.search(head) is not None
        what = "a BondGraphTools model, which is YAML" if tools else "YAML"
        return _foreign(
            source, "not-bondgraph-yaml", begin + yaml.start(),
            f"The file looks like {what}; the ending `.bg` is used by both programs.",
            "Write the components and bonds of its netlist in the bond graph language: "
            "`bg 1`, then `model Name { 1:j { <- Se:U; -> R:R; -> C:C } }`.",
        )  # fmt: skip
    modelica = _MODELICA.search(head)
    if modelica is not None:
        return _foreign(
            source, "not-bondgraph-modelica", begin + modelica.start(),
            "The file looks like Modelica, not like a bond graph.",
            "Write the elements and bonds in the bond graph language: `bg 1`, then "
            "`model Name { 1:j { <- Se:U; -> R:R; -> C:C } }`.",
        )  # fmt: skip
    return None


def _foreign(source: Source, code: str, at: int, message: str, help: str) -> Diagnostic:
    end = source.text.find("\n", at)
    end = len(source.text) if end < 0 else end
    return Diagnostic(code, message, (Label(Span(source, at, max(at, end)), "here"),), help)
