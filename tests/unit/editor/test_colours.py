"""Colours: Pygments has them from the language's own words, VS Code from a grammar that agrees."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from bondgraph.editor.word_kinds import word_kinds
from bondgraph.frontend.parser import Parser
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source
from tests.unit.editor.conftest import MODELS

VSCODE = MODELS.parent / "editors" / "vscode"
TEXTS = sorted([*MODELS.glob("**/*.bg"), *(MODELS.parent / "tests/cases").glob("**/*.bg")])

npm = pytest.mark.skipif(
    shutil.which("npm") is None or not (VSCODE / "node_modules").exists(),
    reason="npm ci in editors/vscode has not been run",
)

#: Scopes of the grammar that say the same as a kind of the words.
SCOPES = {
    "comment": "comment.line", "doc": "comment.block", "string": "string", "unit": "support.type",
    "number": "constant.numeric", "type": "entity.name.type.bondgraph", "arrow":
    "keyword.operator.arrow", "function": "entity.name.function", "signal": "variable.language",
    "constant": "constant.language", "operator word": "keyword.operator.word",
}  # fmt: skip


def test_units_and_words_are_those_that_the_parser_reads() -> None:
    read = 0
    for path in TEXTS:
        text = path.read_text(encoding="utf-8")
        parser = Parser(Source(path.name, text), Report())
        if parser.file() is not None and not parser.errors:
            compare(text, parser)
            read += 1
    assert read > 50


def compare(text: str, parser: Parser) -> None:
    ends = [*parser.starts[1:], len(text)]
    units = {
        text[parser.starts[a] : ends[b - 1]].split()[0].split("#")[0].rstrip(",;)]}")
        for a, b in parser.notes.units
    }
    found = list(word_kinds(text))
    assert {w.text for w in found if w.kind == "unit"} == units
    assert not [w for w in found if w.kind == "wrong"]
    starts = {parser.starts[at] for at in parser.notes.begins}
    keywords = [w for w in found if w.kind == "keyword" and w.text in ("param", "let", "port")]
    assert all(w.start in starts for w in keywords)


def test_pygments_knows_the_language() -> None:
    pygments = pytest.importorskip("pygments")
    from pygments.formatters import HtmlFormatter
    from pygments.lexers import get_lexer_by_name

    from bondgraph.editor.pygments_lexer import BondGraphLexer

    html = pygments.highlight("-> R:Re = 17.6 Ohm # wire", BondGraphLexer(), HtmlFormatter())
    assert re.findall(r'<span class="(\w+)">([^<]+)</span>', html) == [
        ("o", "-&gt;"), ("nc", "R"), ("p", ":"), ("nv", "Re"), ("o", "="), ("m", "17.6"),
        ("kt", "Ohm"), ("c1", "# wire"),
    ]  # fmt: skip
    assert isinstance(get_lexer_by_name("bondgraph"), BondGraphLexer)
    for path in TEXTS:
        text = path.read_text(encoding="utf-8")
        pieces = list(BondGraphLexer().get_tokens_unprocessed(text))
        assert "".join(piece for _, _, piece in pieces) == text


@npm
def test_the_grammar_of_vs_code_agrees_word_by_word() -> None:
    words = ["node", "test/tokens.mjs", *map(str, TEXTS)]
    done = subprocess.run(words, cwd=VSCODE, capture_output=True, text=True, check=True)
    every = json.loads(done.stdout)
    compared = 0
    for path in TEXTS:
        source = Source(path.name, path.read_text(encoding="utf-8"))
        own = {
            (*source.position(w.start), w.text): SCOPES[w.kind]
            for w in word_kinds(source.text)
            if w.kind in SCOPES
        }
        theirs = {}
        for token in every[str(path)]:
            units = len(source.line(token["line"] + 1).encode("utf-16-le")) // 2
            assert token["column"] <= units
            place = (token["line"] + 1, token["column"] + 1, token["text"])
            scope = next((s for s in SCOPES.values() if token["scope"].startswith(s)), None)
            if scope is not None:
                theirs[place] = scope
        assert theirs == own, path.name
        compared += len(own)
    assert compared > 1500


@npm
def test_the_extension_in_node() -> None:
    command = json.dumps([sys.executable, "-m", "bondgraph", "lsp"])
    done = subprocess.run(
        ["npm", "test"], cwd=VSCODE, capture_output=True, text=True, check=False,
        env={**os.environ, "BONDGRAPH_COMMAND": command},
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert "# skipped 0" in done.stdout


@npm
def test_the_extension_is_packed_without_a_network(tmp_path: Path) -> None:
    offline = {**os.environ, "npm_config_offline": "true", "HTTPS_PROXY": "http://127.0.0.1:9"}
    done = subprocess.run(
        ["npm", "run", "pack"], cwd=VSCODE, capture_output=True, text=True, check=False, env=offline
    )
    assert done.returncode == 0, done.stdout + done.stderr
    with zipfile.ZipFile(VSCODE / "dist" / "bondgraph.vsix") as packed:
        names = set(packed.namelist())
        assert b"bondgraph/drawing" in packed.read("extension/dist/extension.js")
        manifest = json.loads(packed.read("extension/package.json"))
    for own in ("main", *[f"contributes/{x}" for x in ("grammars", "snippets", "languages")]):
        part = manifest
        for key in own.split("/"):
            part = part[key]
        for item in part if isinstance(part, list) else [{"path": part}]:
            path = item.get("path") or item["configuration"]
            assert f"extension/{path.removeprefix('./')}" in names
    assert not [n for n in names if "node_modules" in n or "/test/" in n]


def test_snippets_are_models_that_can_be_read() -> None:
    snippets = json.loads((VSCODE / "snippets" / "bondgraph.json").read_text(encoding="utf-8"))
    for name, snippet in snippets.items():
        body = snippet["body"]
        text = body if isinstance(body, str) else "\n".join(body)
        text = re.sub(r"\$\{\d+\|([^,|]*)[^}]*\}", r"\1", text)
        text = re.sub(r"\$\{\d+:([^}]*)\}", r"\1", text).replace("$0", "")
        text = re.sub(r"\$\{(\d+)\}", "x", text)
        if not text.startswith("bg 1"):
            text = f"bg 1\n{text}" if "model " in text else f"bg 1\nmodel M {{\n{text}\n}}\n"
        report = Report()
        file = Parser(Source(name, text), report).file()
        assert file is not None and file.models and not report.failed, (name, text)
