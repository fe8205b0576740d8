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


class Diagnostic(NamedTuple):
    """A finding about the user's model; `labels[0]` is the primary place."""

    code: str
    message: str
    labels: tuple[Label, ...] = ()
    help: str = ""
    severity: Severity = "error"


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

    def error(self, code: str, message: str, *labels: Label | Span, help: str) -> None:
        """Something wrong that stops the compilation after this stage."""
        self.add(Diagnostic(code, message, _labels(labels), help, "error"))

    def warning(self, code: str, message: str, *labels: Label | Span, help: str) -> None:
        """Something that is probably not what the author meant."""
        self.add(Diagnostic(code, message, _labels(labels), help, "warning"))

    def info(self, code: str, message: str, *labels: Label | Span, help: str = "") -> None:
        """Something worth knowing that needs no action."""
        self.add(Diagnostic(code, message, _labels(labels), help, "info"))

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
