"""What the compiler has to say about a model: code, message, places, remedy."""

from __future__ import annotations

from typing import Literal

from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

Severity = Literal["error", "warning", "info"]


class Label(NamedTuple):
    """One place of a diagnostic, and what is to be seen there."""

    span: Span
    text: str = ""


class Edit(NamedTuple):
    """A change of the text that mends a finding: each span becomes the text beside it.

    The spans do not overlap. `title` says in a few words what it does, as in "write `param`".
    """

    title: str
    changes: tuple[tuple[Span, str], ...]


class Remedy(NamedTuple):
    """What to do about a finding, in words and, where it is a change of the text, as that."""

    text: str
    edits: tuple[Edit, ...] = ()


class Diagnostic(NamedTuple):
    """A finding about the user's model; `labels[0]` is the primary place.

    `help` says what to do, and `edits` are the changes of the text among what it says.
    """

    code: str
    message: str
    labels: tuple[Label, ...] = ()
    help: str = ""
    severity: Severity = "error"
    edits: tuple[Edit, ...] = ()


class Report:
    """Collects diagnostics while passes run; the pipeline stops between stages on an error."""

    def __init__(self) -> None:
        self.diagnostics: list[Diagnostic] = []
        self._seen: set[tuple[str, str, tuple[tuple[str, int, int], ...]]] = set()

    def add(self, diagnostic: Diagnostic) -> None:
        """Add a finding once, however many instances of a submodel repeat it."""
        places = tuple((s.source.path, s.start, s.end) for s, _ in diagnostic.labels)
        key = (diagnostic.code, diagnostic.message, places)
        if key not in self._seen:
            self._seen.add(key)
            self.diagnostics.append(diagnostic)

    def error(
        self, code: str, message: str, *labels: Label | Span, help: str | Remedy
    ) -> None:
        """Something wrong that stops the compilation after this stage."""
        self.add(Diagnostic(code, message, _labels(labels), *_said(help, "error")))

    def warning(
        self, code: str, message: str, *labels: Label | Span, help: str | Remedy
    ) -> None:
        """Something that is probably not what the author meant."""
        self.add(Diagnostic(code, message, _labels(labels), *_said(help, "warning")))

    def info(
        self, code: str, message: str, *labels: Label | Span, help: str | Remedy = ""
    ) -> None:
        """Something worth knowing that needs no action."""
        self.add(Diagnostic(code, message, _labels(labels), *_said(help, "info")))

    @property
    def failed(self) -> bool:
        """Whether an error was reported."""
        return any(d.severity == "error" for d in self.diagnostics)

    def stop_on_error(self) -> None:
        """Raise `CompileError` if an error was reported."""
        if self.failed:
            raise CompileError(tuple(self.diagnostics))


class Trouble(Exception):
    """Something that is wrong neither with the model nor with the compiler: a full message."""


class CompileError(Exception):
    """The model is wrong (`status` error) or cannot be solved (`status` refused)."""

    def __init__(
        self, diagnostics: tuple[Diagnostic, ...], status: Literal["error", "refused"] = "error"
    ) -> None:
        self.diagnostics = diagnostics
        self.status = status
        first = next((d for d in diagnostics if d.severity == "error"), None)
        super().__init__(first.message if first else "the model could not be compiled")

    def __reduce__(self) -> tuple[object, ...]:
        """So that it comes back whole from another process."""
        return type(self), (self.diagnostics, self.status)


def _labels(places: tuple[Label | Span, ...]) -> tuple[Label, ...]:
    return tuple(p if isinstance(p, Label) else Label(p) for p in places)


def _said(
    help: str | Remedy, severity: Severity
) -> tuple[str, Severity, tuple[Edit, ...]]:
    """The last fields of a diagnostic."""
    return (help, severity, ()) if isinstance(help, str) else (help.text, severity, help.edits)


def replacing(span: Span, text: str, words: str = "") -> Remedy:
    """To write something else at a place; `words` say so where "Did you mean ...?" does not.

    >>> from bondgraph.text.source import Source
    >>> replacing(Span(Source("a.bg", "parm"), 0, 4), "param").text
    'Did you mean `param`?'
    """
    edit = Edit(f"write `{text.strip()}`", ((span, text),))
    return Remedy(words or f"Did you mean `{text}`?", (edit,))


def removing(span: Span, words: str) -> Remedy:
    """To leave out what stands at a place."""
    return Remedy(words, (Edit("leave it out", ((span, ""),)),))
