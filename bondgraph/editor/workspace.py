"""The files that an editor has open, and what is known of each of them for its present text."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from functools import cached_property

from bondgraph.compilation import Compilation
from bondgraph.editor.flat_facts import FlatFacts
from bondgraph.editor.occurrences import Declaration, FileNames, Occurrence, Symbol
from bondgraph.editor.soundness import Soundness, check_text
from bondgraph.frontend.parser import parse
from bondgraph.frontend.read import decode, read
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source

#: Files of a folder that are looked through for uses of a name.
_FILES = 500
#: Letters of a file that are read to look for uses of a name.
_LETTERS = 2_000_000


class Document:
    """One text that is open: what `check` says of it, and what its names mean.

    All is found when it is asked for and holds for one text; another text is another document.
    `sound_one` is the last one before it without mistakes, for what a text with some cannot say.
    """

    def __init__(
        self, path: str, text: str, workspace: Workspace, before: Document | None
    ) -> None:
        self.path = path
        self.text = text
        self.workspace = workspace
        self.sound_one: Document | None = None
        if before is not None:
            checked = "checked" in vars(before)
            self.sound_one = before if checked and before.checked[1].sound else before.sound_one
        if self.sound_one is not None:
            self.sound_one.sound_one = None

    @cached_property
    def checked(self) -> tuple[Source, Soundness]:
        """The text as the compiler has it, and what `check` says of it."""
        return check_text(self.path, self.text, self.workspace.texts)

    @property
    def source(self) -> Source:
        """The text with plain line ends."""
        return self.names.source

    @cached_property
    def names(self) -> FileNames:
        """What its names mean, as far as it can be read."""
        return _names(self.path, self.text, self.workspace)

    @cached_property
    def facts(self) -> FlatFacts:
        """What is known of the models of the text; of an earlier one where this has mistakes."""
        sound = self.checked[1].sound
        if not sound and self.sound_one is not None:
            return self.sound_one.facts
        return FlatFacts(sound, self.names)

    @property
    def sound(self) -> tuple[Compilation, ...]:
        """The models of the text, where it has no mistakes."""
        found = self.checked[1]
        return () if found.failures else found.sound


class Workspace:
    """The open documents by real path; files that are not open are read from the disk."""

    def __init__(self, folders: Iterable[str] = ()) -> None:
        self.folders = list(folders)
        self.documents: dict[str, Document] = {}
        self._kept: dict[str, tuple[tuple[int, int], FileNames | None]] = {}

    @property
    def texts(self) -> dict[str, str]:
        """All open texts."""
        return {path: document.text for path, document in self.documents.items()}

    def open(self, path: str, text: str) -> Document:
        """Take a text as the present one of a file, opened or changed."""
        path = os.path.realpath(path)
        before = self.documents.get(path)
        if before is not None and before.text == text:
            return before
        found = self.documents[path] = Document(path, text, self, before)
        for other in self.documents.values():  # what is imported may have changed
            if other is not found and found.path in _imported(other):
                self.documents[other.path] = Document(other.path, other.text, self, other)
        return found

    def close(self, path: str) -> None:
        """Forget the text of a file: from now on it is what stands on the disk."""
        self.documents.pop(os.path.realpath(path), None)

    def names(self, path: str) -> FileNames | None:
        """What the names of a file mean, open or not; None where there is no such model file."""
        document = self.documents.get(path)
        if document is not None:
            return document.names
        try:
            status = os.stat(path)
        except (OSError, ValueError):
            return None
        key = (status.st_mtime_ns, status.st_size)
        if path not in self._kept or self._kept[path][0] != key:
            source = read(path, Report())
            found = None if source is None else _names(path, source.text, self)
            self._kept[path] = (key, found)
        return self._kept[path][1]

    def declaration(self, symbol: Symbol) -> Declaration | None:
        """Where a symbol is declared, in whatever file."""
        names = self.names(symbol.path)
        return None if names is None else names.declaration(symbol)

    def uses(self, symbol: Symbol) -> Iterator[Occurrence]:
        """Every place where a symbol is meant, in open files and in those beside its own."""
        for path in self._near(symbol.path):
            names = self.names(path)
            for found in names.occurrences if names is not None else ():
                if found.symbol == symbol:
                    yield found

    def _near(self, path: str) -> list[str]:
        """Files that may mean something that a file declares: that file, open ones, its folder."""
        found = dict.fromkeys([path, *self.documents])
        letters = 0
        for folder in dict.fromkeys([os.path.dirname(path), *self.folders]):
            for name in _models_in(folder):
                if len(found) >= _FILES or letters > _LETTERS:
                    return list(found)
                found.setdefault(name)
                letters += _size(name)
        return list(found)


def _names(path: str, text: str, workspace: Workspace) -> FileNames:
    source = decode(path, text.encode(errors="surrogatepass"), Report()) or Source(path, text)
    file = parse(source, Report())
    return FileNames(file, source, path, workspace.names)


def _imported(document: Document) -> set[str]:
    """All files that a document takes models from, also through others."""
    found: set[str] = set()
    waiting = [document.path]
    while waiting:
        names = document.workspace.names(waiting.pop())
        fresh = set(names.imports.values()) - found if names is not None else set()
        found |= fresh
        waiting += sorted(fresh)
    return found


def _models_in(folder: str) -> list[str]:
    try:
        names = sorted(n for n in os.listdir(folder) if n.endswith(".bg"))
    except (OSError, ValueError):
        return []
    return [os.path.realpath(os.path.join(folder, name)) for name in names]


def _size(path: str) -> int:
    try:
        return os.path.getsize(path)
    except (OSError, ValueError):
        return 0

