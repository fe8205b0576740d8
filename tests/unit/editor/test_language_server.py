"""The language server over JSON-RPC, as an editor meets it."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("pygls", reason="the extra `editor` is not installed")

from lsprotocol import types as lsp

from bondgraph.frontend.formatter import format_text
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source
from tests.unit.editor.conftest import MODELS, Editor, with_editor

LIBRARY = """\
bg 1
## A motor that turns an inertia.
model Motor {
    port supply : in electrical
    param R = 2 Ohm
    1:j { <- supply; -> R:R; -> I:L = 1 mH; -> Df:current }
}
"""
TOP = """\
bg 1
import Motor from "parts.bg"
model Top {
    Motor:𝛺 # a name in two units of UTF-16
    Motor:m(R = 3 Ohm)
    Se:U -> 0:node -> m.supply
    let u = m.R*m.current
}
"""


def test_answers_about_a_model_over_two_files(tmp_path: Path) -> None:
    parts, top = tmp_path / "parts.bg", tmp_path / "top.bg"
    parts.write_text(LIBRARY, encoding="utf-8")
    text = TOP.replace("Motor:𝛺 # a", "# 𝛺 a")

    async def session(editor: Editor) -> None:
        client = editor.client
        uri = await editor.open(top, text)
        assert [d.severity for d in editor.found[uri].diagnostics] == [
            lsp.DiagnosticSeverity.Information
        ]  # I:L = 1 mH is no fault candidate

        place = editor.at(uri, "m.R|*")
        defined = await client.text_document_definition_async(lsp.DefinitionParams(**place))
        assert isinstance(defined, list)
        assert [(d.uri, d.range.start) for d in defined] == [(parts.as_uri(), lsp.Position(4, 10))]

        context = lsp.ReferenceContext(include_declaration=True)
        used = await client.text_document_references_async(
            lsp.ReferenceParams(context=context, **place)
        )
        # the parameter, the element that takes its value, the argument, and the expression
        assert [(Path(u.uri).name, u.range.start.line) for u in used or ()] == [
            ("parts.bg", 4), ("parts.bg", 5), ("top.bg", 4), ("top.bg", 6),
        ]  # fmt: skip

        hover = await client.text_document_hover_async(
            lsp.HoverParams(**editor.at(uri, "m.cur|rent"))
        )
        assert hover is not None and isinstance(hover.contents, lsp.MarkupContent)
        assert "flow: current in A" in hover.contents.value
        assert "m.current" in hover.contents.value

        offered = await client.text_document_completion_async(
            lsp.CompletionParams(**editor.at(uri, "-> m.|supply"))
        )
        assert isinstance(offered, lsp.CompletionList)
        assert offered.items[0].label == "supply"
        assert {"R", "j", "current"} <= {i.label for i in offered.items}

        found = await editor.type(uri, text.replace("m.R*", "m.S*"))
        assert [(d.code, editor.piece(uri, d.range)) for d in found] == [("unknown-name", "S")]

    with_editor(session)


def test_units_that_fit_and_the_one_style() -> None:
    async def session(editor: Editor) -> None:
        uri = await editor.open(MODELS / "khepera.bg")
        offered = await editor.client.text_document_completion_async(
            lsp.CompletionParams(**editor.at(uri, "param L = 300 |uH"))
        )
        assert isinstance(offered, lsp.CompletionList)
        assert [i.label for i in offered.items] == ["H", "mH", "uH"]

        messy = editor.texts[uri].replace("param R = 0.005 m\n", "param   R=0.005 m\n")
        await editor.type(uri, messy)
        edits = await editor.client.text_document_formatting_async(
            lsp.DocumentFormattingParams(
                lsp.TextDocumentIdentifier(uri), lsp.FormattingOptions(4, True)
            )
        )
        assert edits is not None and len(edits) == 1
        assert edits[0].new_text == format_text(Source("a.bg", messy), Report())

    with_editor(session)


def test_residuals_come_when_nobody_types() -> None:
    async def session(editor: Editor) -> None:
        uri = await editor.open(MODELS / "dc_motor.bg")
        await editor.refreshed.wait()
        hover = await editor.client.text_document_hover_async(
            lsp.HoverParams(**editor.at(uri, "param L| ="))
        )
        assert hover is not None and isinstance(hover.contents, lsp.MarkupContent)
        assert "a fault of `L` moves r1" in hover.contents.value

    with_editor(session)
