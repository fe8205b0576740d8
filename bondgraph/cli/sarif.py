"""Diagnostics as SARIF 2.1.0 (OASIS 2020), the format that code review tools read."""

from __future__ import annotations

from collections.abc import Iterable
from urllib.parse import quote

from bondgraph import __version__
from bondgraph.errors import page
from bondgraph.text.diagnostic import Diagnostic, Edit, Label
from bondgraph.text.render import place
from bondgraph.text.source import Span

_LEVELS = {"error": "error", "warning": "warning", "info": "note"}


def sarif(diagnostics: Iterable[Diagnostic]) -> dict[str, object]:
    """A log with one run: a rule for each code, a result for each finding.

    Columns count characters. The first label is the location, the others are related locations,
    and a remedy that is a change of the text is a fix.
    """
    found = list(diagnostics)
    codes = list(dict.fromkeys(d.code for d in found))
    driver = {
        "name": "bondgraph",
        "version": __version__,
        "rules": [_rule(code) for code in codes],
    }
    return {
        "version": "2.1.0",
        "runs": [
            {
                "tool": {"driver": driver},
                "columnKind": "unicodeCodePoints",
                "results": [_result(d, codes.index(d.code)) for d in found],
            }
        ],
    }


def _rule(code: str) -> dict[str, object]:
    rule: dict[str, object] = {"id": code}
    text = page(code)
    if text is not None:
        first = text.split("\n\n")[1]
        rule["fullDescription"] = {"text": " ".join(first.split())}
        rule["help"] = {"text": text, "markdown": text}
    return rule


def _result(diagnostic: Diagnostic, rule: int) -> dict[str, object]:
    help = f"\n{diagnostic.help}" if diagnostic.help else ""
    result: dict[str, object] = {
        "ruleId": diagnostic.code,
        "ruleIndex": rule,
        "level": _LEVELS[diagnostic.severity],
        "message": {"text": diagnostic.message + help},
        "locations": [_location(label) for label in diagnostic.labels[:1]],
    }
    if diagnostic.labels[1:]:
        related = diagnostic.labels[1:]
        result["relatedLocations"] = [{"id": n, **_location(x)} for n, x in enumerate(related)]
    if diagnostic.edits:
        result["fixes"] = [_fix(edit) for edit in diagnostic.edits]
    return result


def _location(label: Label) -> dict[str, object]:
    where = {"artifactLocation": _file(label.span), "region": _region(label.span)}
    location: dict[str, object] = {"physicalLocation": where}
    if label.text:
        location["message"] = {"text": label.text}
    return location


def _file(span: Span) -> dict[str, object]:
    return {"uri": quote(span.source.path.replace("\\", "/"), safe="/:~")}


def _region(span: Span) -> dict[str, object]:
    found = place(span)
    return {
        "startLine": found["line"],
        "startColumn": found["column"],
        "endLine": found["end_line"],
        "endColumn": found["end_column"],
    }


def _fix(edit: Edit) -> dict[str, object]:
    return {
        "description": {"text": edit.title},
        "artifactChanges": [
            {
                "artifactLocation": _file(span),
                "replacements": [
                    {"deletedRegion": _region(span), "insertedContent": {"text": text}}
                ],
            }
            for span, text in edit.changes
        ],
    }
