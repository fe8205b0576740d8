"""Whether all that a file declares is sound: what `check` says, and an editor after every key."""

from __future__ import annotations

import os
from collections.abc import Mapping

from bondgraph.compilation import Compilation
from bondgraph.compile_options import Options
from bondgraph.frontend.read import decode
from bondgraph.passes.elaboration.files import unused
from bondgraph.text.diagnostic import CompileError, Diagnostic, Report
from bondgraph.text.source import Source, Span
from bondgraph.text.tuples import NamedTuple


class Soundness(NamedTuple):
    """What is found about a file: every diagnostic once, and the models that it is checked by.

    `sound` are those of which strokes can be placed, `failures` what the others ended with.
    """

    diagnostics: tuple[Diagnostic, ...]
    sound: tuple[Compilation, ...]
    failures: tuple[CompileError, ...]


def soundness(compilation: Compilation) -> Soundness:
    """Check the model of a compilation; where a file is a library, each that no other one uses.

    >>> import bondgraph
    >>> text = "bg 1\\nmodel A { Se:U -> R:r = 1 }\\nmodel B { Sf:Q -> R:r = 1 }"
    >>> found = soundness(bondgraph.compile(text=text, open_ports=True))
    >>> [c.model for c in found.sound]
    ['A', 'B']
    """
    report = Report()
    sound: list[Compilation] = []
    failures: list[CompileError] = []
    for part in _parts(compilation):
        try:
            assert part.integral
            sound.append(part)
            found = tuple(part.report.diagnostics)
        except CompileError as error:
            failures.append(error.with_traceback(None))  # its frames would keep all that was made
            found = error.diagnostics
        for diagnostic in found:
            report.add(diagnostic)
    return Soundness(tuple(report.diagnostics), tuple(sound), tuple(failures))


def _parts(compilation: Compilation) -> list[Compilation]:
    """The compilation itself, or one for each model of a library."""
    if compilation.model is not None:
        return [compilation]
    try:
        names = unused(compilation.syntax.models)
    except CompileError:
        return [compilation]  # it says what is wrong
    return [compilation.of(name) for name in names] if len(names) > 1 else [compilation]


class Edited(Compilation):
    """A compilation that takes texts which are open in an editor for files of their paths."""

    texts: Mapping[str, str]

    def __init__(
        self, source: Source, model: str | None, options: Options, texts: Mapping[str, str]
    ) -> None:
        super().__init__(source, model, options)
        vars(self).update(texts=texts)

    def _with(self, model: str | None, options: Options) -> Edited:
        return Edited(self.source, model, options, self.texts)

    def _read(self, path: str, origin: Span) -> Source | None:
        text = self.texts.get(os.path.realpath(path))
        if text is None:
            return super()._read(path, origin)
        return decode(path, text.encode(errors="surrogatepass"), self.report, origin)


def check_text(path: str, text: str, texts: Mapping[str, str]) -> tuple[Source, Soundness]:
    """Check a text that is to be saved at `path`; `texts` are all that are open, by real path."""
    report = Report()
    source = decode(path, text.encode(errors="surrogatepass"), report)
    if source is None:
        found = Soundness(tuple(report.diagnostics), (), (CompileError(tuple(report.diagnostics)),))
        return Source(path, text), found
    return source, soundness(Edited(source, None, Options(open_ports=True), texts))
