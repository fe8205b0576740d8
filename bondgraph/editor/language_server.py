"""The language server: what `bondgraph.editor` knows, in the words of the protocol (LSP 3.17).

`language_server()` is a pygls server that is bound to no transport: `start_io()` runs it over
standard streams, `connect` over anything that carries texts, as a WebSocket does.
"""

from __future__ import annotations

import asyncio
import gc
import json
import logging
import sys
from collections.abc import Callable, Iterable
from time import perf_counter
from typing import Any

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcInvalidParams
from pygls.lsp.server import LanguageServer
from pygls.uris import from_fs_path, to_fs_path

from bondgraph import __version__
from bondgraph.compile_options import Options
from bondgraph.editor import semantic_tokens
from bondgraph.editor.code_lenses import lenses
from bondgraph.editor.completion import Proposal, complete
from bondgraph.editor.hover import hover
from bondgraph.editor.inlay_hints import hints
from bondgraph.editor.occurrences import Occurrence, Symbol
from bondgraph.editor.outline_tree import Entry, outline
from bondgraph.editor.renaming import CannotRename, renamed
from bondgraph.editor.residual_facts import ResidualFacts
from bondgraph.editor.soundness import Edited, check_text
from bondgraph.editor.text_positions import Encoding, Place, extent, offset_of
from bondgraph.editor.workspace import Document, Workspace
from bondgraph.frontend.formatter import format_text
from bondgraph.text.diagnostic import CompileError, Diagnostic, Edit, Report
from bondgraph.text.source import Source, Span

_log = logging.getLogger(__name__)

#: Texts that have most parts of `check` at work: a sound one, and mistakes of some kinds.
_FIRST = (
    "bg 1\nmodel M { param R = 2 Ohm; 1:j { <- Se:U; -> R:R; -> C:c = 1; -> Df:i } }\n",
    "bg 1\nmodel M { parm R = 2 Ohm; 1:j { <- Se:U; -> R:R } }\n",
    "bg 1\nmodel M { param R = 2 H; port p : in electrical; p -> R:R; Re -> R }\n",
    "bg 1\nmodel M { Se:A -> 0:j; Se:B -> j; j -> R:r = 2 }\n",
)

#: Seconds without a key before residuals are computed.
_QUIET = 0.8
#: A check that takes longer than this, in s, waits for a pause as long as itself.
_QUICK = 0.1

_SEVERITY = {
    "error": lsp.DiagnosticSeverity.Error,
    "warning": lsp.DiagnosticSeverity.Warning,
    "info": lsp.DiagnosticSeverity.Information,
}
_COMPLETED = {
    "keyword": lsp.CompletionItemKind.Keyword, "type": lsp.CompletionItemKind.Class,
    "model": lsp.CompletionItemKind.Module, "unit": lsp.CompletionItemKind.Unit,
    "function": lsp.CompletionItemKind.Function, "signal": lsp.CompletionItemKind.Property,
    "port": lsp.CompletionItemKind.Interface, "param": lsp.CompletionItemKind.Variable,
    "const": lsp.CompletionItemKind.Constant, "input": lsp.CompletionItemKind.Event,
    "instance": lsp.CompletionItemKind.Struct, "let": lsp.CompletionItemKind.Variable,
}  # fmt: skip
_OUTLINED = {
    "model": lsp.SymbolKind.Class, "port": lsp.SymbolKind.Interface,
    "instance": lsp.SymbolKind.Struct, "param": lsp.SymbolKind.Variable,
    "const": lsp.SymbolKind.Constant, "input": lsp.SymbolKind.Event,
    "let": lsp.SymbolKind.Variable, "sensor": lsp.SymbolKind.Field,
    "argument": lsp.SymbolKind.TypeParameter, "fault": lsp.SymbolKind.Event,
    "0": lsp.SymbolKind.Namespace, "1": lsp.SymbolKind.Namespace,
}  # fmt: skip


class BondGraphServer(LanguageServer):
    """A server for one editor; its documents, and what is being computed for them."""

    def __init__(self) -> None:
        super().__init__(
            "bondgraph", __version__, text_document_sync_kind=lsp.TextDocumentSyncKind.Full
        )
        self.models = Workspace()
        self.residuals: dict[str, ResidualFacts] = {}
        self._uris: dict[str, str] = {}  # as the editor writes them, by path
        self._versions: dict[str, int | None] = {}
        self._waiting: dict[str, asyncio.TimerHandle] = {}
        self._working: dict[str, asyncio.Task[None]] = {}
        self._took = 0.0

    # ---------------------------------------------------------------- places

    @property
    def encoding(self) -> Encoding:
        """The units in which this editor counts columns."""
        found = self.workspace.position_encoding
        name = str(getattr(found, "value", found))
        return name if name in ("utf-8", "utf-32") else "utf-16"  # type: ignore[return-value]

    def document(self, uri: str) -> Document | None:
        """The open document of a URI."""
        return self.models.documents.get(real_path(uri))

    def uri(self, path: str) -> str:
        """The URI of a path, as the editor wrote it where it did."""
        return self._uris.get(path) or from_fs_path(path) or path

    def offset(self, document: Document, position: lsp.Position) -> int:
        """The character of a document at a position."""
        place = Place(position.line, position.character)
        return offset_of(document.source, place, self.encoding)

    def range(self, span: Span) -> lsp.Range:
        """A span as a range of the editor."""
        start, end = extent(span, self.encoding)
        return lsp.Range(lsp.Position(*start), lsp.Position(*end))

    def location(self, span: Span, path: str) -> lsp.Location:
        """A span in a file."""
        return lsp.Location(self.uri(path), self.range(span))

    # ------------------------------------------------------------- documents

    def take(self, uri: str, text: str, version: int | None) -> None:
        """A text is opened or changed: check it, and what its residuals are when there is time."""
        path = real_path(uri)
        self._uris[path] = uri
        self._versions[path] = version
        self.models.open(path, text)
        self._stop(path)
        if self._took <= _QUICK:
            self.publish(path)
        else:
            loop = asyncio.get_running_loop()
            self._waiting[path] = loop.call_later(self._took, self.publish, path)

    def forget(self, uri: str) -> None:
        """A document is closed."""
        path = real_path(uri)
        self._stop(path)
        self.models.close(path)
        self.residuals.pop(path, None)
        nothing = lsp.PublishDiagnosticsParams(uri, [])
        self.text_document_publish_diagnostics(nothing)

    def _stop(self, path: str) -> None:
        timer, task = self._waiting.pop(path, None), self._working.pop(path, None)
        if timer is not None:
            timer.cancel()
        if task is not None:
            task.cancel()

    def publish(self, path: str) -> None:
        """Send what `check` says of a document, and of those that take models from it."""
        document = self.models.documents.get(path)
        if document is None:
            return
        start = perf_counter()
        for other in list(self.models.documents.values()):
            if other is document or "checked" not in vars(other):
                params = lsp.PublishDiagnosticsParams(
                    self.uri(other.path), self.diagnostics(other), self._versions.get(other.path)
                )
                self.text_document_publish_diagnostics(params)
        self._took = perf_counter() - start
        loop = asyncio.get_running_loop()
        self._waiting[path] = loop.call_later(_QUIET, self._begin, path)

    def _begin(self, path: str) -> None:
        document = self.models.documents.get(path)
        if document is not None and document.sound:
            self._working[path] = asyncio.ensure_future(self._compute(document))

    async def _compute(self, document: Document) -> None:
        """Find the residuals in another process; killed when the text changes."""
        asked = json.dumps(
            {"path": document.path, "text": document.text, "texts": self.models.texts}
        )
        pipe = asyncio.subprocess.PIPE
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "bondgraph.editor.residual_facts",
            stdin=pipe, stdout=pipe, stderr=asyncio.subprocess.DEVNULL,
        )  # fmt: skip
        try:
            answer, _ = await process.communicate(asked.encode())
            if process.returncode == 0:
                self.residuals[document.path] = ResidualFacts.from_json(answer)
                self._refresh()
        finally:
            if process.returncode is None:
                process.kill()

    def _refresh(self) -> None:
        """Residuals are known now: code lenses that show them are asked for again."""
        workspace = self.client_capabilities.workspace
        if workspace and workspace.code_lens and workspace.code_lens.refresh_support:
            self.workspace_code_lens_refresh(None)

    # ------------------------------------------------------------ diagnostics

    def diagnostics(self, document: Document) -> list[lsp.Diagnostic]:
        """What `check` says of a document."""
        source, found = document.checked
        return [self._diagnostic(document, source, d) for d in found.diagnostics]

    def fixes(self, document: Document, place: lsp.Range) -> list[lsp.CodeAction]:
        """The changes of the text that mend what is found in a part of it."""
        source, found = document.checked
        actions = []
        for diagnostic in found.diagnostics:
            shown = self._diagnostic(document, source, diagnostic)
            if shown.range.start <= place.end and place.start <= shown.range.end:
                actions += [self._fix(edit, shown) for edit in diagnostic.edits]
        return actions

    def _fix(self, edit: Edit, shown: lsp.Diagnostic) -> lsp.CodeAction:
        changes: dict[str, list[lsp.TextEdit]] = {}
        for span, text in edit.changes:
            uri = self.uri(real_path(span.source.path))
            changes.setdefault(uri, []).append(lsp.TextEdit(self.range(span), text))
        return lsp.CodeAction(
            title=edit.title[0].upper() + edit.title[1:],
            kind=lsp.CodeActionKind.QuickFix,
            diagnostics=[shown],
            edit=lsp.WorkspaceEdit(changes),
        )

    def _diagnostic(
        self, document: Document, source: Source, diagnostic: Diagnostic
    ) -> lsp.Diagnostic:
        labels = diagnostic.labels
        if labels and real_path(labels[0].span.source.path) == document.path:
            own, related = labels[0].span, labels[1:]
        else:  # it is about an imported file
            here = [label.span for label in labels if label.span.source is source]
            own = here[0] if here else _import_of(document, labels[0].span if labels else None)
            related = labels
        said = (diagnostic.message, diagnostic.help)
        return lsp.Diagnostic(
            range=self.range(own),
            message="\n".join(filter(None, said)),
            severity=_SEVERITY[diagnostic.severity],
            code=diagnostic.code,
            source="bondgraph",
            related_information=[
                lsp.DiagnosticRelatedInformation(
                    self.location(label.span, real_path(label.span.source.path)),
                    label.text or "here",
                )
                for label in related
            ],
        )


def real_path(uri: str) -> str:
    """The path of a URI; itself where it has none, as a text that was never saved."""
    from os.path import realpath

    path = to_fs_path(uri) if uri.startswith("file:") else None
    return realpath(path or uri)


def _import_of(document: Document, span: Span | None) -> Span:
    """The import through which a place in another file is reached; else the first line."""
    from os.path import dirname, join, realpath

    names = document.names
    if span is not None:
        wanted = real_path(span.source.path)
        for item in names.file.imports:
            if realpath(join(dirname(document.path), item.path)) == wanted:
                return item.origin
        if names.file.imports:
            return names.file.imports[0].origin
    return Span(names.source, 0, 0)


def connect(
    server: BondGraphServer, send: Callable[[str], None]
) -> Callable[[str | bytes], None]:
    """Bind a server to a transport of whole messages: `send` gets what it says.

    Returns what takes a message of the editor. Both must be called in one event loop.
    """

    class Writer:
        def write(self, data: bytes) -> None:
            send(data.decode())

        def close(self) -> None:
            pass

    server.protocol.set_writer(Writer(), include_headers=False)

    def receive(message: str | bytes) -> None:
        try:
            found = json.loads(message, object_hook=server.protocol.structure_message)
        except (ValueError, RecursionError, UnicodeDecodeError) as error:
            _log.warning("not a message: %s", error)
            return
        server.protocol.handle_message(found)

    return receive


def language_server() -> BondGraphServer:
    """A new server with everything that it answers."""
    server = BondGraphServer()
    for part in (_documents, _questions, _names, _renaming, _shown, _pictures):
        part(server)
    return server


def _documents(server: BondGraphServer) -> None:
    @server.feature(lsp.TEXT_DOCUMENT_DID_OPEN)
    def opened(ls: BondGraphServer, params: lsp.DidOpenTextDocumentParams) -> None:
        item = params.text_document
        ls.take(item.uri, item.text, item.version)

    @server.feature(lsp.TEXT_DOCUMENT_DID_CHANGE)
    def changed(ls: BondGraphServer, params: lsp.DidChangeTextDocumentParams) -> None:
        uri = params.text_document.uri
        text = ls.workspace.get_text_document(uri).source
        ls.take(uri, text, params.text_document.version)

    @server.feature(lsp.TEXT_DOCUMENT_DID_CLOSE)
    def closed(ls: BondGraphServer, params: lsp.DidCloseTextDocumentParams) -> None:
        ls.forget(params.text_document.uri)

    @server.feature(lsp.INITIALIZED)
    def started(ls: BondGraphServer, params: lsp.InitializedParams) -> None:
        folders = ls.workspace.folders.values()
        ls.models.folders = [real_path(folder.uri) for folder in folders]
        for text in _FIRST:  # what checks load is loaded before the first key
            check_text("first.bg", text, {})
        # Garbage in small portions, and none looked for in what stays: else some key waits 0.1 s.
        gc.collect()
        gc.freeze()
        gc.set_threshold(5_000, 3, 50)

    @server.feature(lsp.TEXT_DOCUMENT_FORMATTING)
    def formatted(
        ls: BondGraphServer, params: lsp.DocumentFormattingParams
    ) -> list[lsp.TextEdit] | None:
        document = ls.document(params.text_document.uri)
        if document is None:
            return None
        source = document.source
        text = format_text(source, Report())
        if text is None or text == document.text:
            return []
        whole = Span(source, 0, len(source.text))
        return [lsp.TextEdit(ls.range(whole), text)]


def _questions(server: BondGraphServer) -> None:
    @server.feature(lsp.TEXT_DOCUMENT_HOVER)
    def hovered(ls: BondGraphServer, params: lsp.HoverParams) -> lsp.Hover | None:
        document = ls.document(params.text_document.uri)
        if document is None:
            return None
        residuals = ls.residuals.get(document.path)
        found = hover(document, ls.offset(document, params.position), residuals)
        if found is None:
            return None
        return lsp.Hover(
            lsp.MarkupContent(lsp.MarkupKind.Markdown, found.text), ls.range(found.span)
        )

    @server.feature(
        lsp.TEXT_DOCUMENT_COMPLETION, lsp.CompletionOptions(trigger_characters=list(".: >-"))
    )
    def completed(ls: BondGraphServer, params: lsp.CompletionParams) -> lsp.CompletionList | None:
        document = ls.document(params.text_document.uri)
        if document is None:
            return None
        offset = ls.offset(document, params.position)
        start, proposals = complete(document, offset)
        place = ls.range(Span(document.source, start, offset))
        items = [_completion(number, p, place) for number, p in enumerate(proposals)]
        return lsp.CompletionList(is_incomplete=False, items=items)

    @server.feature(lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def outlined(
        ls: BondGraphServer, params: lsp.DocumentSymbolParams
    ) -> list[lsp.DocumentSymbol] | None:
        document = ls.document(params.text_document.uri)
        return None if document is None else _outlined_symbols(ls, outline(document.names))


def _completion(number: int, proposal: Proposal, place: lsp.Range) -> lsp.CompletionItem:
    doc = lsp.MarkupContent(lsp.MarkupKind.Markdown, proposal.doc) if proposal.doc else None
    return lsp.CompletionItem(
        label=proposal.label,
        kind=_COMPLETED.get(proposal.kind, lsp.CompletionItemKind.Value),
        detail=proposal.detail or None,
        documentation=doc,
        sort_text=f"{number:05}",
        text_edit=lsp.TextEdit(place, proposal.insert or proposal.label),
    )


def _outlined_symbols(ls: BondGraphServer, entries: Iterable[Entry]) -> list[lsp.DocumentSymbol]:
    return [
        lsp.DocumentSymbol(
            name=entry.name,
            kind=_OUTLINED.get(entry.kind, lsp.SymbolKind.Object),
            range=ls.range(entry.whole),
            selection_range=ls.range(entry.own),
            detail=entry.detail or None,
            children=_outlined_symbols(ls, entry.inner),
        )
        for entry in entries
    ]


def _at(
    ls: BondGraphServer, uri: str, position: lsp.Position
) -> tuple[Occurrence, Symbol] | None:
    """The name at a position, and what it means."""
    document = ls.document(uri)
    if document is None:
        return None
    found = document.names.at(ls.offset(document, position))
    return None if found is None or found.symbol is None else (found, found.symbol)


def _names(server: BondGraphServer) -> None:
    @server.feature(lsp.TEXT_DOCUMENT_DEFINITION)
    def defined(ls: BondGraphServer, params: lsp.DefinitionParams) -> list[lsp.Location] | None:
        found = _at(ls, params.text_document.uri, params.position)
        if found is None:
            return None
        declared = ls.models.declaration(found[1])
        if declared is not None:
            return [ls.location(declared.span, found[1].path)]
        loops = [use.span for use in ls.models.uses(found[1]) if use.declares]
        return [ls.location(span, found[1].path) for span in loops]

    @server.feature(lsp.TEXT_DOCUMENT_REFERENCES)
    def used(ls: BondGraphServer, params: lsp.ReferenceParams) -> list[lsp.Location] | None:
        found = _at(ls, params.text_document.uri, params.position)
        if found is None:
            return None
        return [
            ls.location(use.span, real_path(use.span.source.path))
            for use in ls.models.uses(found[1])
            if params.context.include_declaration or not use.declares
        ]

    @server.feature(lsp.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    def highlighted(
        ls: BondGraphServer, params: lsp.DocumentHighlightParams
    ) -> list[lsp.DocumentHighlight] | None:
        document = ls.document(params.text_document.uri)
        found = _at(ls, params.text_document.uri, params.position)
        if found is None or document is None:
            return None
        return [
            lsp.DocumentHighlight(ls.range(use.span))
            for use in document.names.occurrences
            if use.symbol == found[1]
        ]


def _renaming(server: BondGraphServer) -> None:
    @server.feature(lsp.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepared(ls: BondGraphServer, params: lsp.PrepareRenameParams) -> lsp.Range | None:
        found = _at(ls, params.text_document.uri, params.position)
        return None if found is None else ls.range(found[0].span)

    @server.feature(lsp.TEXT_DOCUMENT_RENAME, lsp.RenameOptions(prepare_provider=True))
    def rename(ls: BondGraphServer, params: lsp.RenameParams) -> lsp.WorkspaceEdit | None:
        found = _at(ls, params.text_document.uri, params.position)
        if found is None:
            return None
        try:
            places = renamed(ls.models, found[1], params.new_name)
        except CannotRename as error:
            raise JsonRpcInvalidParams(str(error)) from error
        return lsp.WorkspaceEdit(
            {
                ls.uri(real_path(path)): [lsp.TextEdit(ls.range(s), params.new_name) for s in spans]
                for path, spans in places.items()
            }
        )

    @server.feature(
        lsp.TEXT_DOCUMENT_CODE_ACTION,
        lsp.CodeActionOptions(code_action_kinds=[lsp.CodeActionKind.QuickFix]),
    )
    def mended(ls: BondGraphServer, params: lsp.CodeActionParams) -> list[lsp.CodeAction] | None:
        document = ls.document(params.text_document.uri)
        return None if document is None else ls.fixes(document, params.range)


def _shown(server: BondGraphServer) -> None:
    """What an editor shows without being asked: colours, hints in the text, lines above it."""
    legend = lsp.SemanticTokensLegend(
        list(semantic_tokens.TYPES), list(semantic_tokens.MODIFIERS)
    )

    @server.feature(lsp.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, legend)
    def coloured(ls: BondGraphServer, params: lsp.SemanticTokensParams) -> lsp.SemanticTokens:
        document = ls.document(params.text_document.uri)
        data: list[int] = []
        line = column = 0
        for token in semantic_tokens.tokens(document.names) if document else ():
            start, end = extent(token.span, ls.encoding)
            bits = [1 << semantic_tokens.MODIFIERS.index(m) for m in token.modifiers]
            step = start.column if start.line > line else start.column - column
            kind = semantic_tokens.TYPES.index(token.type)
            data += [start.line - line, step, end.column - start.column, kind, sum(bits)]
            line, column = start
        return lsp.SemanticTokens(data)

    @server.feature(lsp.TEXT_DOCUMENT_INLAY_HINT)
    def hinted(ls: BondGraphServer, params: lsp.InlayHintParams) -> list[lsp.InlayHint] | None:
        document = ls.document(params.text_document.uri)
        if document is None:
            return None
        start = ls.offset(document, params.range.start)
        found = hints(document, start, ls.offset(document, params.range.end))
        return [
            lsp.InlayHint(
                position=ls.range(Span(document.source, hint.offset, hint.offset)).start,
                label=hint.text,
                tooltip=lsp.MarkupContent(lsp.MarkupKind.Markdown, hint.why),
            )
            for hint in found
        ]

    @server.feature(lsp.TEXT_DOCUMENT_CODE_LENS)
    def lensed(ls: BondGraphServer, params: lsp.CodeLensParams) -> list[lsp.CodeLens] | None:
        document = ls.document(params.text_document.uri)
        if document is None:
            return None
        found = lenses(document, ls.residuals.get(document.path))
        return [lsp.CodeLens(ls.range(lens.span), lsp.Command(lens.text, "")) for lens in found]


def _pictures(server: BondGraphServer) -> None:
    @server.feature("bondgraph/drawing")
    async def drawn(ls: BondGraphServer, params: Any) -> dict[str, str | None]:
        """The drawing of a document, {uri}, as {svg}; null with {problem} where there is none."""
        document = ls.document(str(getattr(params, "uri", "")))
        if document is None:
            return {"svg": None, "problem": "the document is not open"}
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(None, drawing, document)


def drawing(document: Document) -> dict[str, str | None]:
    """The picture of the first model that has one, with strokes or with what keeps them away."""
    problem = "the text has mistakes"
    for model in (None, *document.names.models):
        texts = document.workspace.texts
        own = Edited(document.source, model, Options(open_ports=True), texts)
        try:
            return {"svg": own.drawing(), "problem": None}
        except CompileError as error:
            problem = str(error)
            if own.report.diagnostics[-1:] and own.report.diagnostics[-1].code != "several-models":
                break
    return {"svg": None, "problem": problem}
