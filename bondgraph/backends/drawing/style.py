"""How a drawing looks: colours that the colour-blind can tell apart, text sizes, the legend."""

from __future__ import annotations

from typing import Literal

FONT = 13.0  # px, element labels
BIG = 17.0  # px, junctions
SMALL = 10.0  # px, bond labels, names of junctions, titles of submodels
NOTE = 12.0  # px, what is said below the figure
HEIGHT = 18.0  # of a label box, px
SEPARATOR = "  ·  "
GAP = 3.0  # between a label and the end of a bond, px

#: Colours after Okabe and Ito (2008), darkened on white and lightened on black until the contrast
#: of text is at least 4.5.
_LIGHT = {
    "ink": "#1b1b1b",
    "source": "#8a3384",
    "inertia": "#0063a8",
    "capacity": "#00735a",
    "resistor": "#a84300",
    "detector": "#666666",
    "faint": "#6f6f6f",
    "box": "#c9ced6",
    "paper": "#ffffff",
}
_DARK = {
    "ink": "#ececec",
    "source": "#e6a3cf",
    "inertia": "#74bdf0",
    "capacity": "#4fd1a5",
    "resistor": "#f2a35e",
    "detector": "#a6a6a6",
    "faint": "#9b9b9b",
    "box": "#4a515c",
    "paper": "#16181c",
}
_CLASH = {"clash": "#b8004e"}, {"clash": "#ff8fb3"}  # on white, on black
KINDS = {
    "0": "ink",
    "1": "ink",
    "TF": "ink",
    "GY": "ink",
    "Se": "source",
    "Sf": "source",
    "De": "detector",
    "Df": "detector",
    "I": "inertia",
    "IC": "inertia",
    "C": "capacity",
    "R": "resistor",
}
_NARROW = {
    **dict.fromkeys("ijl'|", 0.29),
    **dict.fromkeys(" .,:;!", 0.34),
    **dict.fromkeys("frt()[]-/", 0.41),
    **dict.fromkeys("mMWw@", 0.93),
}


def width(text: str, size: float = FONT, bold: bool = False) -> float:
    """About how wide the text is in px, for DejaVu Sans or a narrower face."""
    em = sum(_NARROW.get(c, 0.69 if c.isupper() else 0.63) for c in text)
    return em * size * (1.1 if bold else 1.0)


def style(conflict: bool = False) -> str:
    """The style sheet, with a second set of colours for dark surroundings.

    `conflict` adds what stands out where strokes cannot be placed.
    """
    light, dark = ({**_LIGHT, **_CLASH[0]}, {**_DARK, **_CLASH[1]}) if conflict else (_LIGHT, _DARK)
    return (
        f"{_rules(light)}\n{_SHAPES}\n"
        f"{_conflict() if conflict else ''}"
        f"@media (prefers-color-scheme:dark){{\n{_rules(dark)}\n}}"
    )


_SHAPES = (
    "text{font-family:'DejaVu Sans',Verdana,Arial,sans-serif;text-anchor:middle}\n"
    f".label{{font-size:{FONT:g}px}}.junction{{font-size:{BIG:g}px;font-weight:bold}}"
    f".small{{font-size:{SMALL:g}px}}.kind{{font-weight:bold}}"
    ".start{text-anchor:start}.head{font-size:14px;font-weight:bold}\n"
    ".bond{fill:none;stroke-width:1.3;stroke-linejoin:round}.stroke{stroke-width:2.2}"
    ".hit{fill:none;stroke:transparent;stroke-width:12}"
    ".signal{fill:none;stroke-width:1}.block{stroke-width:1}.told{font-size:11px;font-style:italic}"
    ".frame{fill:none;stroke-width:1}.derived{fill:none;stroke-dasharray:3 2}"
)


def inside(scope: str) -> str:
    """The rules for drawings inside a page, below the selector `scope`.

    The page defines the colours, as `colours` gives them.
    """
    names = dict.fromkeys([*_LIGHT, *_CLASH[0]])
    rules = _rules({name: f"var(--{name})" for name in names}) + _SHAPES + _conflict()
    rows = [f"{scope} {rule.strip()}}}" for rule in rules.split("}") if rule.strip()]
    return "\n".join(rows)


def colours(dark: bool) -> str:
    """The colours of drawings as CSS variables, for light or dark surroundings."""
    found = {**_DARK, **_CLASH[1]} if dark else {**_LIGHT, **_CLASH[0]}
    return ";".join(f"--{name}:{value}" for name, value in found.items())


def _conflict() -> str:
    return (
        f".note{{font-size:{NOTE:g}px}}.core{{fill:none;stroke-width:1.6}}"
        ".thick{stroke-width:2.8}.badge{font-weight:bold}\n"
    )


def _rules(colours: dict[str, str]) -> str:
    return "\n".join(
        f".{name}{{fill:{value}}}.line-{name}{{stroke:{value}}}" for name, value in colours.items()
    )


def legend(
    preference: Literal["integral", "derivative"],
    derived: bool,
    sensors: bool,
    signals: bool = False,
) -> str:
    """What the signs mean; `derived`, `sensors` and `signals` say which rarer ones occur."""
    signs = [
        f"preferred {preference} causality",
        "half arrow: positive power",
        "bar: this end receives the effort",
    ]
    if preference == "derivative":
        signs.append("SSe, SSf: sensor dualised to a source")
    if derived:
        signs.append("dashed outline: storage in derivative causality")
    if sensors:
        signs.append("grey arrow: ideal sensor")
    if signals:
        signs.append("thin arrow: signal")
    return SEPARATOR.join(signs)


def palette() -> dict[str, str]:
    """The colours by name, for light surroundings."""
    return {**_LIGHT, **_CLASH[0]}
