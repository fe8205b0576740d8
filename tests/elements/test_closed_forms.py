"""Relations written down by hand, each from a balance of its model, against those compiled."""

from __future__ import annotations

import random
from itertools import product
from pathlib import Path
from textwrap import indent
from typing import Any

import pytest
import sympy
from mpmath import mpf

from tests.adversary.jets import Evaluator, Jet
from tests.adversary.judge import parse
from tests.elements import (
    forms_circuits,
    forms_devices,
    forms_domains,
    forms_machines,
    forms_mechanical,
    forms_plants,
    forms_processes,
)
from tests.elements.answers import ROOT, answer, path
from tests.elements.forms import Form

FILES = (
    forms_circuits,
    forms_devices,
    forms_machines,
    forms_mechanical,
    forms_processes,
    forms_domains,
    forms_plants,
)
FORMS = [form for file in FILES for form in file.FORMS]
PAGE = ROOT / "docs" / "closed_forms.md"
SAME = mpf(10) ** -28
SPOILED = 12  # of the terms of a relation are turned round, to see that the comparison is not blind
LATER = "_later"  # the symbol of what is added to the start of every integral

INTRODUCTION = """# Relations by hand: what is expected of each model, and from which law

Each relation here was derived by hand from a balance law, with the book that teaches the law. The
compiled relation must be the same up to a constant factor, at random points that are no solutions
of the model, so that a wrong sign or a lost term is seen: the test turns terms round and looks. The
number of relations, the faults that each sees and the faults that nothing sees are compared too.
`D(x, k)` is the derivative of order k, `Int(x, a)` the integral that starts at a, `ssqrt(x)` is
sign(x)*sqrt(|x|); a step `x = ...;` names what the next ones use.

This page is made from `tests/elements/forms_*.py` by `pytest tests/elements --update`.
"""


def page() -> str:
    """The text of the page."""
    parts = [INTRODUCTION]
    for file in FILES:
        parts.append(f"\n## {str(file.__doc__).partition(';')[0]}\n")
        for form in file.FORMS:
            link = Path("..") / path(form.model).relative_to(ROOT)
            parts.append(f"\n### [{form.model}]({link})\n\n{form.domain}. Law: {form.source}.")
            hidden = ", ".join(form.undetectable.split())
            parts.append(f" No residual can see {hidden}.\n" if hidden else "\n")
            for k, (words, text, signature) in enumerate(form.relations, 1):
                lines = "\n".join(step.strip() for step in text.split(";"))
                parts.append(f"\n{k}. {words[0].upper()}{words[1:]}.\n")
                parts.append("\n   ```\n" + indent(f"{lines} = 0", "   ") + "\n   ```\n")
                parts.append(f"   It sees {', '.join(signature.split())}.\n")
    return "".join(parts)


def test_the_page_is_what_the_forms_say(update: bool) -> None:
    if update:
        PAGE.write_text(page(), encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == page()


def read(text: str, symbols: list[str]) -> Any:
    """The last expression, with the steps before it put in."""
    names: dict[str, Any] = {x: sympy.Symbol(x) for x in symbols}
    *steps, last = text.split(";")
    for step in steps:
        name, _, value = step.partition("=")
        assert name.strip() not in names, f"{name} is a signal of the model or a step already"
        names[name.strip()] = sympy.parse_expr(value, local_dict=names)
    return sympy.parse_expr(last, local_dict=names)


def later(e: Any) -> Any:
    """The same with integrals that have run for a while."""
    integral = sympy.Function("Int")
    return e.replace(integral, lambda x, start: integral(x, start + sympy.Symbol(LATER)))


def points(form: Form, found: dict[str, Any], n: int) -> list[list[dict[str, Any]]]:
    """Random series for all signals; for each draw of the parameters and modes, some points."""
    draw = random.Random(3)
    told = {path for arr in found["arrs"] for path in arr["orders"]}
    moving = [x for x, path in found["names"].items() if path in told - set(form.modes.split())]
    sets = []
    for modes in product([True, False], repeat=len(form.modes.split())):
        fixed: dict[str, Any] = {x: mpf(draw.random()) + 1 for x in found["symbols"]}
        fixed |= form.values | dict(zip(form.modes.split(), modes, strict=True))
        some = []
        for since in form.starts:
            signals = fixed | {LATER: mpf(since)}
            for x in moving:
                lead = mpf(draw.random() * 2 + 0.1)
                below = x not in form.positive.split() and draw.random() < 0.5
                tail = [mpf(draw.random() - 0.5) for _ in range(n - 1)]
                signals[x] = [-lead if below else lead, *tail]
            some.append(signals)
        sets.append(some)
    return sets


def agree(one: list[Jet], other: list[Jet]) -> bool:
    """Whether one is a constant times the other, at all points and in all coefficients."""
    pairs = [p for a, b in zip(one, other, strict=True) for p in zip(a, b, strict=False)]
    a0, b0 = max(pairs, key=lambda p: abs(p[0]))
    scale = abs(a0) + abs(b0)
    return abs(b0) > 0 and all(abs(a * b0 - b * a0) <= SAME * scale * scale for a, b in pairs)


def holds(arr: dict[str, Any], by_hand: Any, sets: list[list[dict[str, Any]]], n: int) -> bool:
    """Whether the compiled relation is the one by hand, in each mode up to a constant."""
    parsed = parse(arr)
    for some in sets:
        ours = [Evaluator(x, n, roots=parsed.roots)(later(parsed.expr)) for x in some]
        try:
            if not agree(ours, [Evaluator(x, n)(later(by_hand)) for x in some]):
                return False
        except (TypeError, ValueError, ZeroDivisionError):  # a root of a negative number, as a rule
            return False
    return True


def spoiled(by_hand: Any, seen: set[str]) -> list[Any]:
    """The relation with one term of one of its sums turned round, for each of them."""
    out = []
    for node in sympy.preorder_traversal(by_hand):
        if isinstance(node, sympy.Add) and {s.name for s in node.free_symbols} & seen:
            out += [by_hand.xreplace({node: node - 2 * term}) for term in node.args]
    return list(dict.fromkeys(out))


@pytest.mark.parametrize("form", FORMS, ids=lambda f: f.model)
def test_the_relations_are_those_by_hand(form: Form) -> None:
    found = answer(form.model)
    assert found["n_arr"] == len(form.relations)
    assert sorted(found["undetectable"]) == sorted(form.undetectable.split())
    left = list(found["arrs"])
    n = 2 + max(o for a in found["arrs"] for o in a["orders"].values())
    sets = points(form, found, n)
    for relation in form.relations:
        by_hand = read(relation.form, found["symbols"])
        told = set(relation.signature.split())
        for arr in left:
            if set(arr["signature"]) == told and holds(arr, by_hand, sets, n):
                break
        else:
            said = [f"{a['expr']} with {a['signature']}" for a in left]
            pytest.fail(f"{relation.form} with {sorted(told)} is none of {said}")
        left.remove(arr)
        seen = {x for x, fault in found["names"].items() if fault in told}
        wrongs = spoiled(by_hand, seen)
        for wrong in wrongs[:: 1 + len(wrongs) // SPOILED]:
            assert not holds(arr, wrong, sets, n), f"{wrong} would do as well"


def test_there_are_many_models_of_many_domains() -> None:
    assert len({f.model for f in FORMS}) == len(FORMS) >= 40
    assert len({d for f in FORMS for d in f.domain.split(", ")}) >= 6
