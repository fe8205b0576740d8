"""A real client of the language server: pygls', over the standard streams of `bondgraph lsp`."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("pygls", reason="the extra `editor` is not installed")

from lsprotocol import types as lsp
from pygls.lsp.client import LanguageClient

MODELS = Path(__file__).resolve().parents[3] / "models"


class Editor:
    """What an editor does, in a few words; places are given by a piece of the text."""

    def __init__(self, client: LanguageClient) -> None:
        self.client = client
        self.texts: dict[str, str] = {}
        self.found: dict[str, lsp.PublishDiagnosticsParams] = {}
        self.news = asyncio.Event()
        self.refreshed = asyncio.Event()

        @client.feature(lsp.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
        def published(params: lsp.PublishDiagnosticsParams) -> None:
            self.found[params.uri] = params
            self.news.set()

        @client.feature(lsp.WORKSPACE_CODE_LENS_REFRESH)
        def refreshed(*_: object) -> None:
            self.refreshed.set()

    async def open(self, path: Path, text: str | None = None) -> str:
        """Open a file; its URI, once the server has said what it finds."""
        uri = path.as_uri()
        text = path.read_text(encoding="utf-8") if text is None else text
        self.texts[uri] = text
        item = lsp.TextDocumentItem(uri, "bondgraph", 1, text)
        self.client.text_document_did_open(lsp.DidOpenTextDocumentParams(item))
        await self._until(lambda: uri in self.found)
        return uri

    async def _until(self, holds: Callable[[], bool]) -> None:
        while not holds():
            self.news.clear()
            await asyncio.wait_for(self.news.wait(), 60)

    async def type(self, uri: str, text: str) -> list[lsp.Diagnostic]:
        """Change the whole text; what the server finds then."""
        version = (self.found[uri].version or 0) + 1
        self.texts[uri] = text
        self.client.text_document_did_change(
            lsp.DidChangeTextDocumentParams(
                lsp.VersionedTextDocumentIdentifier(version, uri),
                [lsp.TextDocumentContentChangeWholeDocument(text)],
            )
        )
        await self._until(lambda: self.found[uri].version == version)
        return list(self.found[uri].diagnostics)

    def at(self, uri: str, mark: str) -> dict[str, Any]:
        """Document and position of the `|` in a piece of the text, which is there once."""
        piece = mark.replace("|", "")
        text = self.texts[uri]
        assert text.count(piece) == 1, f"{piece!r} is there {text.count(piece)} times"
        before = text[: text.index(piece) + mark.index("|")]
        column = len(before.rpartition("\n")[2].encode("utf-16-le")) // 2
        position = lsp.Position(before.count("\n"), column)
        return {"text_document": lsp.TextDocumentIdentifier(uri), "position": position}

    def piece(self, uri: str, place: lsp.Range) -> str:
        """The text in a range of one line."""
        line = self.texts[uri].split("\n")[place.start.line].encode("utf-16-le")
        assert place.start.line == place.end.line
        return line[2 * place.start.character : 2 * place.end.character].decode("utf-16-le")


async def _session(told: Callable[[Editor], Awaitable[None]]) -> None:
    client = LanguageClient("test", "1")
    editor = Editor(client)
    await client.start_io(sys.executable, "-m", "bondgraph", "lsp")
    try:
        refresh = lsp.CodeLensWorkspaceClientCapabilities(refresh_support=True)
        capabilities = lsp.ClientCapabilities(
            workspace=lsp.WorkspaceClientCapabilities(code_lens=refresh)
        )
        await client.initialize_async(lsp.InitializeParams(capabilities))
        client.initialized(lsp.InitializedParams())
        await told(editor)
        await client.shutdown_async(None)
        client.exit(None)
    except BaseException:
        if client._server is not None:  # it was not told goodbye
            client._server.kill()
        raise
    finally:
        await client.stop()


def with_editor(told: Callable[[Editor], Awaitable[None]]) -> None:
    """Run what an editor does against a new server."""
    asyncio.run(asyncio.wait_for(_session(told), 120))
