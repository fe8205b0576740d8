"""The derivation of a residual as a person works with it: text, Markdown, LaTeX, a script."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, overload

from bondgraph.ir.derivation import Derivation
from bondgraph.notation.derivation_script import cells, notebook, script
from bondgraph.notation.derivation_words import (
    LatexLines,
    ending,
    headline,
    lines,
    remark,
    title,
)
from bondgraph.notation.line import show
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.whole_file import write_whole

if TYPE_CHECKING:
    from bondgraph.ir.graph import BondGraph


class UnknownForm(ValueError, Trouble):
    """A file of a suffix in which no derivation is written."""


class Derivations(Sequence[Derivation]):
    """How a residual came about: one derivation, or one for each position of its switches.

    >>> import bondgraph
    >>> d = bondgraph.compile("models/dc_motor.bg").derivation("r1")
    >>> print(d.text[-153:])
          0 = U.e - k.e1 - R.e - L.e
          0 = U - k*speed - R*current - L*D(current)  (with 1, 4, 6, 7)
    <BLANKLINE>
    SymPy agrees: what it derived is the compiler's r1.
    """

    def __init__(self, graph: BondGraph, found: Sequence[Derivation]) -> None:
        self._graph = graph
        self._all = tuple(found)

    @overload
    def __getitem__(self, key: int) -> Derivation: ...
    @overload
    def __getitem__(self, key: slice) -> tuple[Derivation, ...]: ...
    def __getitem__(self, key: int | slice) -> Derivation | tuple[Derivation, ...]:
        """The derivation at a position."""
        return self._all[key]

    def __len__(self) -> int:
        return len(self._all)

    def __iter__(self) -> Iterator[Derivation]:
        return iter(self._all)

    @property
    def complete(self) -> bool:
        """Whether every step could be shown, and the end is the residual."""
        return not any(d.stopped for d in self._all)

    @property
    def ending(self) -> str:
        """What is shown in the end, or why the replay stops."""
        return " ".join(ending(d) for d in self._all)

    @property
    def text(self) -> str:
        """All steps as lines of text."""
        found: list[str] = []
        for own in self._all:
            found += [*([""] if found else []), title(own, self._graph.name)]
            for step in own.steps:
                head = headline(own, step, self._graph.source, show)
                found += ["", f"{step.number:2}  {head}"]
                for left, right, note in lines(step, own.pool.zero):
                    told = show(right, starts=own.starts)
                    lead = "    " if left is None else show(left)
                    found.append(f"      {lead} = {told}" + (f"  ({note})" if note else ""))
                if note := remark(step, show):
                    found.append(f"      {note}")
            found += ["", ending(own)]
        return "\n".join(found)

    @property
    def markdown(self) -> str:
        """All steps as Markdown with formulas in LaTeX."""
        found = cells(self._all, self._graph.name, self._graph.source)
        return "\n\n".join(cell.text for cell in found if cell.kind == "markdown")

    @property
    def latex(self) -> str:
        """All steps in LaTeX, as text and aligned equations of amsmath."""
        found: list[str] = []
        for own in self._all:
            spelled = LatexLines(own)
            found.append(f"\\paragraph{{{spelled.plain(title(own, self._graph.name))}}}")
            for step in own.steps:
                head = headline(own, step, self._graph.source, spelled.inline)
                note = remark(step, spelled.inline)
                found.append(f"{step.number}. {spelled.plain(head)}")
                found.append(f"\\[\n{spelled.aligned(lines(step, own.pool.zero))}\n\\]")
                if note:
                    found.append(spelled.plain(note))
            found.append(spelled.plain(ending(own)))
        return "\n".join(found)

    @property
    def script(self) -> str:
        """A Python file that does all steps with SymPy alone, and compares the end."""
        return script(cells(self._all, self._graph.name, self._graph.source))

    @property
    def notebook(self) -> str:
        """The same as a Jupyter notebook."""
        return notebook(cells(self._all, self._graph.name, self._graph.source))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write a file: `.ipynb`, `.py`, `.md`, `.tex` or `.txt`; `UnknownForm` for any other."""
        write_whole(path, self.written(os.fspath(path)))

    def written(self, path: str) -> str:
        """What `write` writes into a file of this name."""
        suffix = os.path.splitext(path)[1].lower()
        match suffix:
            case ".ipynb":
                text = self.notebook
            case ".py":
                text = self.script
            case ".md":
                text = self.markdown
            case ".tex":
                text = self.latex
            case ".txt":
                text = self.text
            case _:
                raise UnknownForm(
                    f"{path}: a derivation is written as .ipynb, .py, .md, .tex or .txt"
                )
        return text if text.endswith("\n") else text + "\n"

    def __repr__(self) -> str:
        return self.text

    def _repr_markdown_(self) -> str:
        return self.markdown
