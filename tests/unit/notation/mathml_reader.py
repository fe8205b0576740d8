"""Reads presentation MathML as a person does, and evaluates it."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from xml.etree import ElementTree

RATE = 1.7  # what a time derivative multiplies by here: any linear operator does
AREA = 0.3  # and an integral

_FUNCTIONS = {
    "tanh": math.tanh, "exp": math.exp, "sgn": lambda x: math.copysign(1, x) if x else 0.0,
    "arctan": math.atan, "sin": math.sin, "ssq": lambda x: x * abs(x),
    "ssqrt": lambda x: math.copysign(math.sqrt(abs(x)), x),
}  # fmt: skip


def evaluate(pieces: list[str], values: Mapping[str, float]) -> float:
    """The value of a formula that is given in pieces."""
    xml = re.sub(r"&#x([0-9a-f]+);", lambda m: chr(int(m[1], 16)), "".join(pieces))
    tokens = [t for e in ElementTree.fromstring(f"<math>{xml}</math>") for t in _tokens(e)]
    text = " ".join(_with_products(tokens))
    return float(eval(text, {**_FUNCTIONS, "abs": abs, "v": values}))


def _tokens(e: ElementTree.Element) -> list[str]:
    parts = [_tokens(child) for child in e]
    inside = [t for part in parts for t in part]
    match e.tag:
        case "mi" | "msub":
            name = e.get("data-name") or "".join(e.itertext())
            return [name] if name in _FUNCTIONS else [f"v[{name!r}]"]
        case "mn":
            return ["".join(e.itertext()).replace("−", "-")]
        case "mo":
            return _operator(e)
        case "mover":
            dots = {"˙": 1, "¨": 2}["".join(e[1].itertext())]
            return ["(", *parts[0], "*", str(RATE**dots), ")"]
        case "mfrac":
            top, bottom = "".join(e[0].itertext()), "".join(e[1].itertext())
            if top.startswith("d") and bottom.startswith("dt"):
                return [str(RATE ** int(top[1:] or 1))]
            return ["(", "(", *parts[0], ")", "/", "(", *parts[1], ")", ")"]
        case "msup":
            if re.fullmatch(r"\(\d\)", "".join(e[1].itertext())):
                return ["(", *parts[0], "*", str(RATE ** int("".join(e[1].itertext())[1])), ")"]
            return [*parts[0], "**", "(", *parts[1], ")"]
        case "msqrt":
            return ["(", "(", *inside, ")", "**0.5", ")"]
        case "mroot":
            return ["(", "(", *parts[0], ")", "**", "(1/3)", ")"]
        case "msubsup":
            assert "∫" in "".join(e[0].itertext())
            return [str(AREA)]
        case "mrow" if [c.tag for c in e] == ["mi", "mi"] and "".join(e.itertext()) == "dt":
            return []
        case "mrow":
            return inside
        case "mspace":
            return []
    raise AssertionError(e.tag)


def _operator(e: ElementTree.Element) -> list[str]:
    text = "".join(e.itertext())
    if text == "|":
        return ["abs("] if e.get("form") == "prefix" else [")"]
    return {"\u2061": [], "−": ["-"], "·": ["*"]}.get(text, [text])


def _with_products(tokens: list[str]) -> list[str]:
    """What stands side by side is multiplied."""
    found: list[str] = []
    for token in tokens:
        before = found[-1] if found else "("
        ends = before[-1].isdigit() or before[-1] in ")]"
        begins = token[0].isalnum() or token[0] == "("
        if ends and begins and before != "**":
            found.append("*")
        found.append(token)
    return found
