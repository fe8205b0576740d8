"""Random edits through the language server: `python -m tests.editor_edits`.

After each edit of a model, what the server publishes is compared with what `check` prints about the
same text in a file, and some questions are asked at random places: no answer may be a failure.
`--times` types into the robot instead and tells how long findings take, from the message of the
editor to the message of the server, and how long each question takes.
"""

from __future__ import annotations

import argparse
import asyncio
import io
import json
import random
import statistics
import tempfile
import time
from collections import Counter
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any, NamedTuple

from bondgraph.cli.main import main as command_line
from bondgraph.editor.language_server import connect, language_server
from tests.measured import write

MODELS = sorted((Path(__file__).parents[1] / "models").glob("*.bg"))
PAGE = Path(__file__).parents[1] / "docs" / "editor.md"
#: Edits of one text, before another one is taken.
EPISODE = 6
PIECES = (
    "{ } ( ) [ ] ; : , . = -> <- -[7]-> + - * / ^ < # ## \" 0: 1: R: C: I: TF: GY: Se: Sf: De: Df:"
    " param const input sensor let port fault for if else model import from in out when unknown"
    " bool counts turn true false and or not 1 2.5 3e-4 1..2 Ohm mH N.m/A +- ± % bg e f q p e1 int"
    " der delay table"
).split() + [
    "\n", " ", "\t", "\r\n", "\r", "\0", "\x0b", "\x0c", "\u2028", "𝛺", "é", "\ud800", "\ufeff",
    "→", "model A {", "\nparam x = 1\n", "import B from \"parts.bg\"\n", "R:x { 0 = e }",
]  # fmt: skip
#: Refusing a request is an answer.
_REFUSED = -32602


class Took(NamedTuple):
    """How long an answer took, in s, and how long the processor worked for it."""

    seconds: float
    worked: float


class Clock:
    """Both times since it was made."""

    def __init__(self) -> None:
        self.start = time.perf_counter(), time.process_time()

    def took(self) -> Took:
        return Took(time.perf_counter() - self.start[0], time.process_time() - self.start[1])


class Asked(NamedTuple):
    """A question of the editor, and how long the answer took."""

    method: str
    took: Took


class Client:
    """An editor in the same process: messages go to the server as texts, as over a transport."""

    def __init__(self) -> None:
        self.answers: dict[int, dict[str, Any]] = {}
        self.published: dict[str, dict[str, Any]] = {}
        self.number = 0
        self.asked: list[Asked] = []
        self.server = language_server()
        self.receive = connect(self.server, self._take)

    def _take(self, text: str) -> None:
        message = json.loads(text)
        if "id" in message and "method" not in message:
            self.answers[message["id"]] = message
        elif message.get("method") == "textDocument/publishDiagnostics":
            self.published[message["params"]["uri"]] = message["params"]
        elif message.get("method") == "window/showMessage":
            raise AssertionError(f"the server failed: {message['params']}")

    def tell(self, method: str, params: dict[str, Any]) -> None:
        """Send a notification."""
        self.receive(json.dumps({"jsonrpc": "2.0", "method": method, "params": params}))

    async def ask(self, method: str, params: dict[str, Any]) -> dict[str, Any]:
        """Send a request and wait for the answer."""
        self.number += 1
        own = self.number
        message = {"jsonrpc": "2.0", "id": own, "method": method, "params": params}
        clock = Clock()
        self.receive(json.dumps(message))
        while own not in self.answers:
            await asyncio.sleep(0)
        self.asked.append(Asked(method, clock.took()))
        return self.answers.pop(own)

    async def start(self) -> None:
        """Say hello."""
        await self.ask("initialize", {"processId": None, "rootUri": None, "capabilities": {}})
        self.tell("initialized", {})

    async def change(self, uri: str, version: int, text: str) -> Took:
        """Send a text, and wait until its findings are published."""
        clock = Clock()
        if version == 0:
            item = {"uri": uri, "languageId": "bondgraph", "version": 0, "text": text}
            self.tell("textDocument/didOpen", {"textDocument": item})
        else:
            document = {"uri": uri, "version": version}
            changes = {"textDocument": document, "contentChanges": [{"text": text}]}
            self.tell("textDocument/didChange", changes)
        while self.published.get(uri, {}).get("version") != version:
            await asyncio.sleep(0)
        return clock.took()


def edited(text: str, chance: random.Random) -> str:
    """The text after one edit, of those that people make and of others."""
    lines = text.split("\n")
    at = chance.randint(0, len(text))
    match chance.randint(0, 7):
        case 0:
            return text[:at] + chance.choice(PIECES) + text[at:]
        case 1:
            return text[:at] + text[at + 1 :]
        case 2:
            return text[:at] + text[at + chance.randint(1, 30) :]
        case 3:  # a word becomes another one
            words = [w for w in text.split() if w.isidentifier()] or ["x"]
            return text.replace(chance.choice(words), chance.choice(words), 1)
        case 4:  # a line twice
            line = chance.randrange(len(lines))
            return "\n".join(lines[:line] + [lines[line]] + lines[line:])
        case 5:  # a line leaves
            line = chance.randrange(len(lines))
            return "\n".join(lines[:line] + lines[line + 1 :])
        case 6:
            return text[:at] + " " + chance.choice(PIECES) + " " + text[at:]
        case _:  # a piece of it moves
            piece = text[at : at + chance.randint(1, 40)]
            rest = text[:at] + text[at + len(piece) :]
            to = chance.randint(0, len(rest))
            return rest[:to] + piece + rest[to:]


def printed(path: Path) -> list[dict[str, Any]]:
    """What `check --json` prints about a file."""
    out = io.StringIO()
    with redirect_stdout(out), redirect_stderr(io.StringIO()):
        command_line(["check", "--json", str(path)])
    return list(json.loads(out.getvalue())["diagnostics"])


def expected(path: Path, text: str) -> list[tuple[object, ...]]:
    """Findings of `check` as an editor shows them: lines from 0, columns in UTF-16."""
    lines = text.replace("\r\n", "\n").replace("\r", "\n").removeprefix("\ufeff").split("\n")
    found = []
    for finding in printed(path):
        where: tuple[object, ...] = ()
        first = finding["labels"][0]
        if Path(first["path"]) == path:
            line = lines[first["line"] - 1] if first["line"] <= len(lines) else ""
            before = line[: first["column"] - 1]
            column = len(before.encode("utf-16-le", "surrogatepass")) // 2
            where = (first["line"] - 1, column)
        said = finding["message"] + ("\n" + finding["help"] if finding["help"] else "")
        found.append((finding["code"], said, len(finding["labels"]), *where))
    return found


def shown(params: dict[str, Any], wanted: list[tuple[object, ...]]) -> list[tuple[object, ...]]:
    """What the server has published, with places where `wanted` has some."""
    found = []
    for number, item in enumerate(params["diagnostics"]):
        start = item["range"]["start"]
        own = number < len(wanted) and len(wanted[number]) > 3
        where = (start["line"], start["character"]) if own else ()
        related = len(item.get("relatedInformation") or ())
        found.append((item["code"], item["message"], related + (1 if own else 0), *where))
    return found


QUESTIONS = (
    "hover completion definition references documentHighlight prepareRename rename documentSymbol"
    " formatting semanticTokens/full inlayHint codeLens codeAction"
).split()


def question(name: str, uri: str, text: str, chance: random.Random) -> dict[str, Any]:
    """The parameters of a request at a random place."""
    at = chance.randint(0, len(text))
    line = text.count("\n", 0, at)
    position = {"line": line, "character": at - text.rfind("\n", 0, at) - 1}
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": line + 1, "character": 0}}
    params: dict[str, Any] = {"textDocument": {"uri": uri}}
    if name in ("documentSymbol", "semanticTokens/full", "codeLens"):
        return params
    if name == "formatting":
        return params | {"options": {"tabSize": 4, "insertSpaces": True}}
    if name in ("inlayHint", "codeAction"):
        return params | {"range": whole, "context": {"diagnostics": []}}
    params["position"] = position
    if name == "references":
        params["context"] = {"includeDeclaration": True}
    if name == "rename":
        params["newName"] = chance.choice(["renamed", "e", "R", "x__y", "", "model"])
    return params


async def campaign(edits: int, seed: int, folder: Path, questions: int = 2) -> Counter[str]:
    """Make edits and compare; the codes of what was found, counted. Raises AssertionError."""
    chance = random.Random(seed)
    client = Client()
    await client.start()
    counted: Counter[str] = Counter()
    for model in MODELS:
        (folder / model.name).write_bytes(model.read_bytes())
    for number in range(edits):
        if number % EPISODE == 0:
            model = chance.choice(MODELS)
            path = folder / f"edited_{number}.bg"
            uri = path.as_uri()
            text = model.read_text(encoding="utf-8")
            await client.change(uri, 0, text)
        text = edited(text, chance)
        path.write_bytes(text.encode(errors="surrogatepass"))
        await client.change(uri, number + 1, text)
        wanted = expected(path, text)
        seen = shown(client.published[uri], wanted)
        assert seen == wanted, f"edit {number} of seed {seed}: {seen} is not {wanted} of {text!r}"
        counted.update(str(code) for code, *_ in wanted)
        for name in chance.sample(QUESTIONS, questions):
            params = question(name, uri, text, chance)
            answer = await client.ask(f"textDocument/{name}", params)
            refused = name == "rename" and answer.get("error", {}).get("code") == _REFUSED
            if "error" in answer and not refused:
                raise AssertionError(f"edit {number} of seed {seed}: {name}: {answer['error']}")
        if number % EPISODE == EPISODE - 1:
            client.tell("textDocument/didClose", {"textDocument": {"uri": uri}})
            path.unlink()
    return counted


async def typing(edits: int, seed: int) -> tuple[list[Took], list[Asked]]:
    """Type single letters into the robot; what each took, and what questions took."""
    chance = random.Random(seed)
    client = Client()
    await client.start()
    path = next(m for m in MODELS if m.name == "khepera.bg")
    uri, original = path.as_uri(), path.read_text(encoding="utf-8")
    await client.change(uri, 0, original)
    text, times = original, []
    for number in range(edits):
        if number % 10 == 0:
            text, at = original, chance.randrange(len(original))
            text = text[:at] + text[at + chance.randint(0, 12) :]
        else:
            text = text[:at] + chance.choice("abcRLm=:.[]{}(0123 \n") + text[at:]
            at += 1
        times.append(await client.change(uri, number + 1, text))
        for name in chance.sample(QUESTIONS, 3):
            await client.ask(f"textDocument/{name}", question(name, uri, text, chance))
    return times, client.asked


def main() -> None:
    """Run the campaign, or measure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--edits", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--times", action="store_true", help="type into the robot and measure")
    parser.add_argument("--write", action="store_true", help="write the table into its page")
    args = parser.parse_args()
    command = f"python -m tests.editor_edits --edits {args.edits}"
    command += f" --seed {args.seed}" if args.seed != 1 else ""
    if not args.times:
        with tempfile.TemporaryDirectory() as folder:
            found = asyncio.run(campaign(args.edits, args.seed, Path(folder).resolve()))
        lines = [
            "| edits | failures | differences from `check` | findings | of kinds |",
            "|---|---|---|---|---|",
            f"| {args.edits} | 0 | 0 | {sum(found.values())} | {len(found)} |",
        ]
    else:
        command += " --times"
        times, asked = asyncio.run(typing(args.edits, args.seed))
        lines = [
            "| | how many | median, ms | worst, ms | median of the processor, ms | worst, ms |",
            "|---|---|---|---|---|---|",
            row("findings after a key", times),
        ]
        for name in QUESTIONS:
            lines.append(row(name, [a.took for a in asked if a.method == f"textDocument/{name}"]))
    print("\n".join(lines))
    if args.write:
        write(PAGE, command, "\n".join(lines))


def row(name: str, times: list[Took]) -> str:
    """One line of the table: how many, median and worst in ms, then of the processor alone."""
    cells = [f"{1e3 * f(t[k] for t in times):.1f}" for k in (0, 1)
             for f in (statistics.median, max)]  # fmt: skip
    return f"| {name} | {len(times)} | {' | '.join(cells)} |"


if __name__ == "__main__":
    main()
