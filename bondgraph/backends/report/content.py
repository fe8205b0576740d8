"""What a report says, as plain data; only what is named `html` or `svg` is finished markup."""

from __future__ import annotations

from bondgraph.backends.report.episode import Episode
from bondgraph.text.diagnostic import Diagnostic
from bondgraph.text.tuples import NamedTuple


class Drawing(NamedTuple):
    """One drawing of the bond graph, as bare SVG."""

    title: str
    caption: str
    svg: str


class PathLine(NamedTuple):
    """One step of a causal path; `leaves`: it runs against the strokes of the drawing.

    `node` is the element or junction whose equation it uses, "" for none.
    """

    html: str
    why: str
    place: str
    leaves: bool
    node: str


class DerivedStep(NamedTuple):
    """A step of a derivation: what is done, its equations, what cancels or must not be zero.

    `node` is the path of the node whose equation it begins with, or empty.
    """

    words: str
    html: tuple[str, ...]
    remark: str
    node: str


class RelationPart(NamedTuple):
    """One relation: formulas, path, what it sees. `notes` are sentences on its limits."""

    name: str
    closed_by: str
    html: tuple[str, ...]
    too_long: str
    path: tuple[PathLine, ...]
    closing_html: str
    longer: int  # steps that are not listed
    lasting: tuple[str, ...]
    weak: tuple[str, ...]
    orders: tuple[tuple[str, tuple[str, ...]], ...]  # highest derivative, html of the signals
    notes: tuple[str, ...]
    derivation: tuple[tuple[str, tuple[DerivedStep, ...], str], ...] = ()  # title, steps, ending


class MatrixRow(NamedTuple):
    """A fault: per residual "", strong, weak or unsaid, with " unseen" where `step` is blind."""

    fault: str
    cells: tuple[str, ...]
    detected: bool
    alone: bool


class Group(NamedTuple):
    """Faults of one signature; `parts` are what combined residuals could divide them into."""

    number: int
    residuals: tuple[str, ...]
    rows: tuple[MatrixRow, ...]
    parts: tuple[tuple[str, ...], ...]


class Mode(NamedTuple):
    """What is different while a machine stays in one mode."""

    name: str
    reason: str
    groups: tuple[tuple[tuple[str, ...], tuple[str, ...]], ...]  # residuals, faults
    lost: tuple[str, ...]
    blind: tuple[str, ...]
    same: bool
    stuck: tuple[tuple[str, str], ...]  # a switch that is in the other position, and what shows


class Signatures(NamedTuple):
    """The fault signature matrix and what follows from it."""

    residuals: tuple[str, ...]
    groups: tuple[Group, ...]
    undetectable: tuple[tuple[str, tuple[str, ...]], ...]  # reason, faults
    best: tuple[tuple[str, ...], ...] | None
    modes: tuple[Mode, ...]
    more_modes: int


class Effect(NamedTuple):
    """How a residual changes with a fault, and the smallest change of it that shows."""

    fault: str
    residual: str
    html: str
    too_long: str
    change: str
    relative: str
    why: str  # there is no smallest change


class Pairs(NamedTuple):
    """How large each fault has to be to be told from the others, a column for each group."""

    groups: tuple[tuple[str, ...], ...]
    rows: tuple[tuple[str, tuple[str, ...]], ...]  # a fault, and a size or "" for each group


class Seen(NamedTuple):
    """The sensitivities, and under which assumptions the smallest changes hold.

    `answers` says for a fault how residuals answer as it grows.
    """

    effects: tuple[Effect, ...]
    assumed: tuple[str, ...]
    noise: tuple[tuple[str, str], ...]
    missing: str  # why there are no numbers
    pairs: Pairs | None = None
    answers: tuple[tuple[str, str], ...] = ()


class Quantity(NamedTuple):
    """A line of the list of symbols."""

    html: str
    name: str
    kind: str
    value: str
    unit: str
    doc: str


class Content(NamedTuple):
    """All of a report. `status` is ok, no_arr, refused or error."""

    title: str
    doc: str
    source: str
    status: str
    message: str
    facts: tuple[tuple[str, str], ...]
    drawings: tuple[Drawing, ...]
    links: dict[str, tuple[str, ...]]  # element -> its faults
    relations: tuple[RelationPart, ...]
    signatures: Signatures | None
    seen: Seen | None
    quantities: tuple[Quantity, ...]
    findings: tuple[Diagnostic, ...]
    episodes: tuple[Episode, ...] = ()
    missing: tuple[tuple[str, str], ...] = ()  # relation, why it could not be had
