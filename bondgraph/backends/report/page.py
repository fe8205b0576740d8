"""The report as one HTML page: sections, tables, style and script filled into the templates."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from functools import cache
from typing import TYPE_CHECKING, Any

from bondgraph.backends.drawing.style import colours, inside
from bondgraph.backends.report.confusion import isolability
from bondgraph.backends.report.content import Content, Group, Signatures
from bondgraph.backends.report.episode import Episode
from bondgraph.backends.templates import codegen, fill

if TYPE_CHECKING:
    from markupsafe import Markup

_COLUMNS = 24  # residuals beside each other in one matrix
_CELLS = 30_000  # of a matrix that is still written out
_WIDE = 900.0  # px, a drawing that is printed across
_SHEETS = ("page.css", "formulas.css", "tables.css", "figures.css", "print.css")
_SAID = {"strong": "lasting", "weak": "only while signals change", "unsaid": "seen"}
_SEVERITY = {"error": "Error", "warning": "Warning", "info": "Note"}
_LIGHT = "--mark:#fff0b8"
_DARK = "--mark:#4d4212"


def page(content: Content) -> str:
    """The whole page as text. The same content gives the same bytes."""
    graph = _graph(content)
    wide = any(drawing["wide"] for drawing in graph["content"]["drawings"])
    sections = [
        {"id": name, "title": title, "wide": wide and name == "graph"}
        for name, title in _sections(content)
    ]
    holes: dict[str, Any] = {
        "content": content,
        "sections": sections,
        "style": markup(style_sheet()),
        "script": markup(_text("page.js").rstrip()),
        "links": markup(_links(content)),
        "names": _names,
        "prose": _prose,
        **graph,
        **_signatures(content),
        **_seen(content),
        "episodes": [_episode(e, f"e{k}") for k, e in enumerate(content.episodes, 1)],
        "words": _SEVERITY,
    }
    return fill("report/page.html.j2", holes, html=True)


def _sections(content: Content) -> list[tuple[str, str]]:
    """The sections that this model has, in order."""
    found = [("findings", "Why there are no relations")] if _failed(content) else []
    if content.drawings:
        found.append(("graph", "Bond graph"))
    if not _failed(content):
        found.append(("relations", "Analytical redundancy relations"))
    if content.signatures is not None and content.signatures.residuals:
        found.append(("signatures", "Fault signatures"))
        found.append(("isolability", "What cannot be told apart"))
    elif content.signatures is not None and content.signatures.undetectable:
        found.append(("signatures", "Faults"))
    if content.seen is not None:
        found.append(("sensitivities", "What can be seen"))
    if content.episodes:
        found.append(("scenarios", "Scenarios"))
    if content.findings and not _failed(content):
        found.append(("findings", "Findings"))
    if content.quantities:
        found.append(("symbols", "Symbols"))
    return found


def _failed(content: Content) -> bool:
    return content.status in ("error", "refused")


# -------------------------------------------------------------------- what templates need


def _graph(content: Content) -> dict[str, Any]:
    drawings = []
    for drawing in content.drawings:
        wide = float(drawing.svg.partition('width="')[2].partition('"')[0])
        svg = drawing.svg.replace("<svg ", f'<svg style="--wide:{wide:g}px" ', 1)
        drawings.append({**drawing._asdict(), "svg": markup(svg.rstrip()), "wide": wide > _WIDE})
    relations = [
        {
            **r._asdict(),
            "html": [markup(line) for line in r.html],
            "path": [{**line._asdict(), "html": markup(line.html)} for line in r.path],
            "closing_html": markup(r.closing_html),
            "orders": [(order, [markup(s) for s in signals]) for order, signals in r.orders],
            "against": any(line.leaves for line in r.path),
        }
        for r in content.relations
    ]
    quantities = [{**q._asdict(), "html": markup(q.html)} for q in content.quantities]
    findings = [
        {**f._asdict(), "places": [_place(span, text) for span, text in f.labels]}
        for f in content.findings
    ]
    formulas = "".join(line for r in content.relations for line in r.html)
    return {
        "signed": "<mi>ssq" in formulas,
        "content": {
            **content._asdict(),
            "drawings": drawings,
            "relations": relations,
            "quantities": quantities,
            "findings": findings,
        },
    }


def _place(span: Any, text: str) -> str:
    where = f"{span.source.path.replace(chr(92), '/').rpartition('/')[2]}, line {span.line}"
    return f"{where}: {text}" if text else where


def _signatures(content: Content) -> dict[str, Any]:
    found = content.signatures
    if found is None:
        return {}
    rows = [row for group in found.groups for row in group.rows]
    kinds = {kind for row in rows for cell in row.cells for kind in cell.split()}
    said = {k: text for k, text in _SAID.items()}
    said |= {f"{k} unseen": f"{text}; not at this rate" for k, text in _SAID.items()}
    whole = len(rows) * len(found.residuals) <= _CELLS
    return {
        "signatures": found,
        "marks": {"unsaid": "unsaid" in kinds, "unseen": "unseen" in kinds},
        "said": said,
        "tables": _tables(found) if whole else [],
        "isolability": markup(isolability(found)) if found.residuals else "",
        "meanings": _meanings(content),
    }


def _tables(found: Signatures) -> list[dict[str, Any]]:
    """The matrix in parts of so many residuals; a part shows the faults that it is about."""
    tables = []
    for start in range(0, len(found.residuals), _COLUMNS):
        columns = slice(start, start + _COLUMNS)
        groups = [_cut(group, columns) for group in found.groups]
        shown = [g for g in groups if any(any(row.cells) for row in g.rows)]
        tables.append({"residuals": found.residuals[columns], "groups": shown})
    return tables


def _cut(group: Group, columns: slice) -> Group:
    return group._replace(rows=tuple(r._replace(cells=r.cells[columns]) for r in group.rows))


def _seen(content: Content) -> dict[str, Any]:
    if content.seen is None:
        return {}
    by_fault: dict[str, list[dict[str, Any]]] = {}
    for effect in content.seen.effects:
        row = {**effect._asdict(), "html": markup(effect.html)}
        by_fault.setdefault(effect.fault, []).append(row)
    return {"seen": content.seen, "by_fault": list(by_fault.items())}


def _episode(episode: Episode, key: str) -> dict[str, Any]:
    """The figures of an episode and the words beside them."""
    from bondgraph.backends.report.plots import plane, signals, strips

    planes = [
        {"title": p.title, "svg": markup(plane(p, f"{key}-p{k}"))}
        for k, p in enumerate(episode.planes, 1)
    ]
    return {
        **episode._asdict(),
        "planes": planes,
        "strips": [markup(figure) for figure in strips(episode, f"{key}-r")],
        "signals": markup(signals(episode, f"{key}-s")) if episode.panels else "",
    }


def _links(content: Content) -> str:
    """What the script lights up, as JSON that is safe inside of a script element."""
    residuals: dict[str, tuple[str, ...]] = {}
    for group in _groups(content):
        residuals |= {row.fault: group.residuals for row in group.rows}
    meanings = _meanings(content)
    unseen = [] if content.signatures is None else content.signatures.undetectable
    found = {
        "elements": content.links,
        "residuals": residuals,
        "unseen": [fault for _, faults in unseen for fault in faults],
        "meanings": meanings,
    }
    text = json.dumps(found, ensure_ascii=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace("&", "\\u0026")


def _meanings(content: Content) -> dict[str, str]:
    """What a name is, in a few words: value, unit, and what the model says about it."""
    found = {row.fault: "" for group in _groups(content) for row in group.rows}
    for q in content.quantities:
        unit = "" if q.unit == "1" else q.unit
        size = f"{q.value} {unit}" if q.value else f"{q.kind} in {unit}" if unit else q.kind
        found[q.name] = ": ".join(word for word in (size.strip(), q.doc.rstrip(".")) if word)
    return found


def _groups(content: Content) -> tuple[Group, ...]:
    return () if content.signatures is None else content.signatures.groups


# ----------------------------------------------------------------------------- the looks


def style_sheet() -> str:
    """The style sheet; dark where that is asked for, on screens only."""
    light, dark = f"{colours(False)};{_LIGHT}", f"{colours(True)};{_DARK}"
    themes = (
        f":root{{{light}}}\n"
        f"@media screen{{@media (prefers-color-scheme:dark){{:root:not([data-theme=light])"
        f"{{{dark}}}}}\n:root[data-theme=dark]{{{dark};color-scheme:dark}}}}"
    )
    sheets = [_text(name).rstrip() for name in _SHEETS]
    return "\n".join([themes, *sheets[:-1], inside(".bondgraph"), sheets[-1]])


@cache
def _text(name: str) -> str:
    return (codegen() / "report" / name).read_text(encoding="utf-8")


def markup(text: str) -> Markup:
    """A text that is HTML already."""
    from markupsafe import Markup

    return Markup(text)


def _prose(text: str) -> Markup:
    """A sentence of the compiler; what it has in backticks is code."""
    from markupsafe import Markup, escape

    return Markup(re.sub(r"`([^`]*)`", r"<code>\1</code>", str(escape(text))))


def _names(items: Iterable[str]) -> Markup:
    """Names of the model with commas; they may break behind a dot."""
    from markupsafe import Markup, escape

    found = []
    for item in items:
        text = Markup("<wbr>").join(
            escape(part + ("." if more else "")) for part, more in _dotted(item)
        )
        found.append(Markup('<span class="name" data-fault="{}">{}</span>').format(item, text))
    return Markup(", ").join(found)


def _dotted(name: str) -> list[tuple[str, bool]]:
    parts = name.split(".")
    return [(part, at < len(parts) - 1) for at, part in enumerate(parts)]
