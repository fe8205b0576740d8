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


async def actions(editor: Editor, uri: str) -> list[lsp.CodeAction]:
    """All changes that the server offers for a document."""
    whole = lsp.Range(lsp.Position(0, 0), lsp.Position(1000, 0))
    offered = await editor.client.text_document_code_action_async(
        lsp.CodeActionParams(
            lsp.TextDocumentIdentifier(uri), whole, lsp.CodeActionContext(diagnostics=[])
        )
    )
    return [a for a in offered or () if isinstance(a, lsp.CodeAction)]


def test_a_stiffness_in_the_place_of_a_compliance_is_mended_by_a_quick_fix(tmp_path: Path) -> None:
    text = (
        "bg 1\nmodel M {\n    param k = 2 N/m\n    param m = 1 kg\n"
        "    1:j { <- Se:F; -> C:k; -> I:m; -> Df:v }\n}\n"
    )

    async def session(editor: Editor) -> None:
        uri = await editor.open(tmp_path / "spring.bg", text)
        (found,) = editor.found[uri].diagnostics
        assert found.code == "unit-mismatch" and "write `C:k = 1/k`" in found.message
        assert [editor.piece(uri, r.location.range) for r in found.related_information or ()] == [
            "2 N/m", "1 kg",
        ]  # fmt: skip
        (action,) = await actions(editor, uri)
        assert action.edit is not None and action.edit.changes is not None
        (edit,) = action.edit.changes[uri]
        assert (edit.new_text, edit.range.start) == (" = 1/k", editor.at(uri, "C:k|")["position"])
        assert await editor.type(uri, text.replace("C:k", "C:k = 1/k")) == []

    with_editor(session)


def test_renaming_over_files_and_what_may_not_be(tmp_path: Path) -> None:
    parts, top = tmp_path / "parts.bg", tmp_path / "top.bg"
    parts.write_text(LIBRARY, encoding="utf-8")
    text = TOP.replace("Motor:𝛺 # a", "# 𝛺 a")

    async def session(editor: Editor) -> None:
        uri = await editor.open(top, text)
        place = editor.at(uri, "m.R|*")
        found = await editor.client.text_document_rename_async(
            lsp.RenameParams(new_name="Ra", **place)
        )
        assert found is not None and found.changes is not None
        assert {Path(u).name: len(edits) for u, edits in found.changes.items()} == {
            "parts.bg": 2, "top.bg": 2,
        }  # fmt: skip
        for path, expected in (
            (parts, LIBRARY.replace("param R ", "param Ra ").replace("R:R", "R:Ra")),
            (top, text.replace("(R = ", "(Ra = ").replace("m.R*", "m.Ra*")),
        ):
            lines = (text if path == top else LIBRARY).split("\n")
            for edit in found.changes[path.as_uri()]:
                line, start, end = edit.range.start.line, edit.range.start, edit.range.end
                old = lines[line]
                lines[line] = old[: start.character] + edit.new_text + old[end.character :]
            assert "\n".join(lines) == expected
        for wrong, why in (("x__y", "two underscores"), ("and", "no name"), ("current", "already")):
            with pytest.raises(Exception, match=why):
                await editor.client.text_document_rename_async(
                    lsp.RenameParams(new_name=wrong, **place)
                )

    with_editor(session)


def test_units_strokes_and_residuals_are_shown_in_the_text() -> None:
    async def session(editor: Editor) -> None:
        client = editor.client
        uri = await editor.open(MODELS / "khepera.bg")
        whole = lsp.Range(lsp.Position(0, 0), lsp.Position(1000, 0))
        document = lsp.TextDocumentIdentifier(uri)
        hints = await client.text_document_inlay_hint_async(lsp.InlayHintParams(document, whole))
        lines = editor.texts[uri].split("\n")
        for hint in reversed(hints or ()):
            line, column = hint.position.line, hint.position.character
            lines[line] = lines[line][:column] + str(hint.label) + lines[line][column:]
        shown_text = "\n".join(lines)
        assert "let w : N.m = A*me.K" in shown_text and "let u : m/s = (v1 + v2)/2" in shown_text
        assert "-[1]->| I:L" in shown_text  # the inertia gets the effort: the stroke is at its end
        assert "|-[2]-> R:Re" in shown_text  # the resistor gets the flow and gives the effort

        await editor.refreshed.wait()
        lenses = await client.text_document_code_lens_async(lsp.CodeLensParams(document))
        shown = {editor.piece(uri, lens.range): lens.command for lens in lenses or ()}
        assert shown["Khepera"] is not None
        assert shown["Khepera"].title == "5 residuals detect 37 of 42 faults, in 7 groups"
        assert shown["Us"] is not None and shown["Us"].title.endswith("moves r5")

        found = await client.text_document_semantic_tokens_full_async(
            lsp.SemanticTokensParams(document)
        )
        assert found is not None and len(found.data) % 5 == 0
        line = column = 0
        names = []
        for k in range(0, len(found.data), 5):
            down, right, length = found.data[k : k + 3]
            line, column = line + down, right + (0 if down else column)
            names.append(editor.texts[uri].split("\n")[line][column : column + length])
        assert all(name.isidentifier() for name in names) and names[0] == "Electrical"

        outline = await client.text_document_document_symbol_async(
            lsp.DocumentSymbolParams(document)
        )
        models = [s for s in outline or () if isinstance(s, lsp.DocumentSymbol)]
        assert [s.name for s in models][:3] == ["Electrical", "Mechanical", "Gear"]
        assert [c.name for c in models[0].children or ()] == [
            "supply", "shaft", "L", "Re", "k", "i", "L", "Re", "k",
        ]  # fmt: skip

    with_editor(session)


def test_a_mistake_in_an_imported_file_is_shown_at_the_import(tmp_path: Path) -> None:
    parts, top = tmp_path / "parts.bg", tmp_path / "top.bg"
    parts.write_text(LIBRARY, encoding="utf-8")

    async def session(editor: Editor) -> None:
        text = TOP.replace("Motor:𝛺 # a", "# 𝛺 a")
        uri = await editor.open(top, text)
        # the text of parts.bg that is open counts, not the one on the disk
        other = await editor.open(parts, LIBRARY.replace("param R = 2 Ohm", "parm R = 2 Ohm"))
        assert [d.code for d in editor.found[other].diagnostics] == ["unknown-statement"]
        await editor.type(uri, text + "\n")
        (found,) = editor.found[uri].diagnostics
        assert found.code == "unknown-statement"
        assert editor.piece(uri, found.range) == 'import Motor from "parts.bg"'
        assert [r.location.uri for r in found.related_information or ()] == [other]
        await editor.type(other, LIBRARY)
        assert not [d for d in await editor.type(uri, text) if d.severity == 1]

    with_editor(session)


def test_a_name_that_a_law_would_take_for_its_own_variable_is_refused(tmp_path: Path) -> None:
    text = "bg 1\nmodel M {\n    param a = 2\n    1:j { <- Se:U; -> R:r { e = a*f }; -> Df:y }\n}\n"

    async def session(editor: Editor) -> None:
        uri = await editor.open(tmp_path / "law.bg", text)
        assert not editor.found[uri].diagnostics
        place = editor.at(uri, "param a|")
        with pytest.raises(Exception, match="means something else"):
            await editor.client.text_document_rename_async(
                lsp.RenameParams(new_name="f", **place)  # e = f*f is a law as well
            )
        done = await editor.client.text_document_rename_async(
            lsp.RenameParams(new_name="drag", **place)
        )
        assert done is not None and done.changes is not None and len(done.changes[uri]) == 2

    with_editor(session)
