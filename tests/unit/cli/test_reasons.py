"""The words for what cannot be detected, in situations whose cause is plain to see."""

from __future__ import annotations

import pytest

from bondgraph.cli.reasons import message, reason
from tests.unit.passes.relations import compiled

#: Body of a model; words of its one-line message; for some faults words of the reason.
SITUATIONS: dict[str, tuple[str, str, dict[str, str]]] = {
    "no sensor": (
        "param R=1; Se:U -> 1:a; a { -> R:R; -> I:L=2 }",
        "no residual: the model has no sensor",
        {"R": "no sensor around a could", "U": "no sensor around a could"},
    ),
    "the only sensor tells an unknown source": (
        """param R=1; input d : V unknown
        Se:U = d -> 1:a; a { -> R:R; -> Df:i }""",
        "no residual: `i` is needed to tell the unknown `d`",
        {"R": "needed to tell the unknown d", "i": "needed to tell the unknown d"},
    ),
    "two sensors tell two unknown sources": (
        """param R=1; param C=2; input d unknown; input q unknown
        Se:U = d -> 1:a; a { -> R:R; -> Df:i; -> n }
        0:n { -> C:C; <- Sf:leak = q; -> De:v }""",
        "no residual: `i` and `v` are all needed to tell the unknown `d` and `q`",
        {"R": "unknown d", "C": "unknown"},
    ),
    "one of two sensors tells an unknown leak": (
        """param R=1; param C=2; input q unknown
        Se:U -> 1:a; a { -> R:R; -> Df:i; -> n }
        0:n { -> C:C; <- Sf:leak = q; -> De:v }""",
        "1 residual detects 4 of 5 faults",
        {"C": "around n is needed to tell the unknown q"},
    ),
    "a part without sensor beside one that has one": (
        """param R=1; param R2=2
        Se:U -> 1:a; a { -> R:R; -> Df:i }
        Se:V -> 1:b; b { -> R:R2; -> I:L=3 }""",
        "1 residual detects 3 of 5 faults",
        {"R2": "no sensor around b could", "V": "no sensor around b could"},
    ),
    "an unknown input in a part without sensor is not the reason": (
        """param R=1; param R2=2; input d unknown
        Se:U -> 1:a; a { -> R:R; -> Df:i }
        Se:V = d -> 1:b; b { -> R:R2; -> I:L=3 }""",
        "1 residual detects 3 of 4 faults",
        {"R2": "no sensor around b could"},
    ),
    "a load on a source that is measured": (
        "param R=1; Se:U -> 0:a; a { -> R:R; -> De:v }",
        "1 residual detects 2 of 3 faults",
        {"R": "the sensors around a show nothing that depends on it"},
    ),
    "the same where the source is unknown": (
        "param R=1; input d unknown; Se:U = d -> 0:a; a { -> R:R; -> De:v; -> De:v2 }",
        "1 residual detects 2 of 3 faults",
        {"R": "the sensors around a show nothing that depends on it"},
    ),
    "an unknown force behind a mass": (
        """param m=1; input F unknown
        Se:T = F -> 1:v; v { -> I:m; -> Df:s }
        sensor x = int(v.f)""",
        "1 residual detects 2 of 3 faults",
        {"m": "needed to tell the unknown F"},
    ),
    "one instrument behind two detectors": (
        """param R=1; input d unknown
        Se:U = d -> 1:a; a { -> R:R; -> Df:y; -> Df:y2 = y }""",
        "no residual: `y` is needed to tell the unknown `d`",
        {"R": "unknown d", "y": "unknown d"},
    ),
    "a coefficient that cancels": (
        """param R=1; param c=2
        Se:U -> 1:a; a { -> R:R; -> Df:i; <- MSe:p = c*i; -> MSe:n = c*i }""",
        "1 residual detects 5 of 6 faults",  # U, R, i and what p and n deliver
        {"c": "it cancels out of every residual"},
    ),
}


@pytest.mark.parametrize("name", SITUATIONS)
def test_words(name: str) -> None:
    body, line, because = SITUATIONS[name]
    c = compiled(f"model M {{\n{body}\n}}")
    assert line in message(c)
    for fault, words in because.items():
        assert fault in c.signatures.undetectable
        assert words in reason(c, fault), fault


def test_one_instrument_behind_two_detectors_is_told() -> None:
    c = compiled("model M { param R=1; Se:U -> 1:a; a { -> R:R; -> Df:y; -> Df:y2 = y } }")
    assert len(c.residuals) == 1
    (told,) = [d for d in c.report.diagnostics if d.code == "same-instrument"]
    assert "`y2` reads the instrument `y`" in told.message
    assert told.labels[0].span.text == "Df:y2 = y"


def test_two_instruments_are_two_sensors() -> None:
    c = compiled("model M { param R=1; Se:U -> 1:a; a { -> R:R; -> Df:y; -> Df:y2 } }")
    assert len(c.residuals) == 2
    assert [d for d in c.report.diagnostics if d.code == "same-instrument"] == []
