"""An independent simulator and judge: the plant by hand, by power series, against the compiler.

A `Plant` states the physics of a model as equations of its own. Its trajectories are found as
power series in t by Newton's method on all coefficients at once, whatever the index; nothing of
the compiler is used but its JSON. Each residual must vanish on the healthy trajectory, and must
move exactly where its signature says when one parameter, input or sensor is perturbed.
"""

from __future__ import annotations

import itertools
import random
from typing import Any, NamedTuple

import mpmath
import sympy
from mpmath import mpf

from tests.adversary.jets import Evaluator, Jet
from tests.adversary.plant import Plant, Simulator, counts, plain


def judge_all_modes(plant: Plant, answer: dict[str, Any]) -> list[str]:
    """As `judge`; what a residual does not see in one mode it may see in another."""
    modes = plant.modes.split()
    if not modes:
        return judge(plant, answer)
    found = [
        judge(plant, answer, dict(zip(modes, values, strict=True)))
        for values in itertools.product((True, False), repeat=len(modes))
    ]
    weak = ("does not move", "orders", "by ranks")
    return [
        text
        for texts in found
        for text in texts
        if not any(w in text for w in weak) or all(text in other for other in found)
    ]


class Parsed(NamedTuple):
    """A residual as SymPy reads it, and its inner unknowns: expression that vanishes, start."""

    expr: Any
    roots: dict[str, tuple[Any, float]]


def parse(arr: dict[str, Any]) -> Parsed:
    names: dict[str, Any] = {x: sympy.Symbol(x) for x in arr["symbols"]}
    for name, text in arr.get("defs", []):
        names[name] = sympy.parse_expr(text, local_dict=dict(names))
    roots = {
        name: (sympy.parse_expr(text, local_dict=names), arr["guess"][name])
        for name, text in arr.get("implicit", {}).items()
    }
    return Parsed(sympy.parse_expr(arr["expr"], local_dict=names), roots)


def evaluate(parsed: Parsed, signals: dict[str, Any], n: int) -> tuple[Jet, Any]:
    """The residual as a series and the sum of the absolute values of its terms."""
    expr = parsed.expr
    value = Evaluator(signals, n, roots=parsed.roots)
    out = value(expr)
    parts = expr.args if isinstance(expr, sympy.Add) else (expr,)
    # The terms of factors count: (a - b)*c vanishes only by cancellation inside.
    inner = [p for q in parts for p in sympy.preorder_traversal(q) if not p.is_number]
    inner = [p for p in inner if not isinstance(p, sympy.logic.boolalg.Boolean)][:400]
    size = mpf(0)
    for p in [*parts, *inner]:
        try:
            jet = value(p)
        except (NotImplementedError, KeyError, AssertionError, ValueError, IndexError):
            continue
        size = max(size, max(abs(c) for c in jet[:4]))
    return out, max(size, mpf(10) ** -4)


def highest_orders(parsed: Parsed, signals: dict[str, Any], known: list[str]) -> dict[str, int]:
    """By changing one coefficient of one signal at a time, at a point that is no trajectory."""
    n = 14
    rnd = random.Random(5)

    def jet(lead: Any) -> Jet:
        return [lead, *[mpf(rnd.random() - 0.5) for _ in range(n - 1)]]

    # Not a trajectory, but near one in value, so that roots and branches stay where they were.
    base = {k: jet(v[0]) if k in known and isinstance(v, list) else v for k, v in signals.items()}
    every = [parsed.expr, *[zero for zero, _ in parsed.roots.values()]]
    present = {s.name for e in every for s in e.free_symbols}

    def at(values: dict[str, Any]) -> Any:
        return Evaluator(values, n, True, parsed.roots)(parsed.expr)[0]

    here = at(base)
    out = {}
    for name in known:
        if name not in present or isinstance(signals[name], bool):
            continue
        out[name] = -1
        for k in range(8):
            moved = list(base[name])
            moved[k] += mpf(10) ** -8
            if abs(at(base | {name: moved}) - here) > mpf(10) ** -22:
                out[name] = k
    return out


def judge(plant: Plant, answer: dict[str, Any], modes: dict[str, bool] | None = None) -> list[str]:
    """What is wrong with the compiler's answer; empty when nothing is."""
    wrong: list[str] = []
    if answer.get("status") != plant.status:
        diagnostics = [d["message"] for d in answer.get("diagnostics", [])]
        return [f"status {answer.get('status')} for {plant.status}: {diagnostics}"]
    if plant.status in ("error", "refused") or plant.equations == "1":
        n = 0 if plant.status in ("error", "refused") else plant.n_arr
        return [] if answer["n_arr"] == n else [f"n_arr {answer['n_arr']} for {n}"]
    if answer["n_arr"] != plant.n_arr or len(answer["arrs"]) != plant.n_arr:
        wrong.append(f"n_arr {answer['n_arr']} for {plant.n_arr}")
    highest = max([o for a in answer["arrs"] for o in a["orders"].values()], default=0)
    sim = Simulator(plant, highest + 10, modes=modes)
    healthy = sim.solve()
    seen_by_ranks = counts(sim)
    missing = len(answer["missing"])
    if seen_by_ranks.n_arr != plant.n_arr + missing:
        wrong.append(f"(by hand {plant.n_arr} + {missing}, by ranks {seen_by_ranks.n_arr})")
    back = {v: k for k, v in plant.alias.items()}
    by_plain = {plain(f): f for g in [answer["undetectable"], *answer["groups"]] for f in g}
    hidden = {by_plain.get(back.get(x, x), back.get(x, x)) for x in seen_by_ranks.undetectable}
    # A trajectory that starts at a declared value may start where nothing can be seen yet.
    blind = hidden != set(answer["undetectable"])
    more = not set(answer["undetectable"]) <= hidden
    if (more or (blind and not plant.starts)) and not missing:
        wrong.append(f"undetectable {answer['undetectable']}, by ranks {sorted(hidden)}")
    rename = answer["names"]
    to_plain = {v: k for k, v in rename.items()}

    def own(name: str) -> str:
        """The name that the plant has for a name of the model."""
        return plant.alias.get(name, plain(name))

    def known_signals(y: dict[str, Jet]) -> dict[str, Any]:
        return sim.nominal | {x: sim.signals[x] for x in sim.inputs} | y | sim.modes

    def named(values: dict[str, Any]) -> dict[str, Any]:
        return {to_plain[m]: values[own(m)] for m in rename.values() if own(m) in values}

    exprs = [(a, parse(a)) for a in answer["arrs"]]
    base = named(known_signals(healthy))
    measured = [to_plain[m] for m in rename.values() if own(m) in {*sim.inputs, *sim.sensors}]
    for arr, expr in exprs:
        strange = {s.name for s in expr.expr.free_symbols} - {*base, *expr.roots}
        if strange:
            wrong.append(f"{arr['name']}: symbols {sorted(strange)} are not of the model")
            continue
        r, size = evaluate(expr, base, sim.n)
        if max(abs(c) for c in r[:4]) > size * mpf(10) ** -18:
            wrong.append(
                f"{arr['name']} does not vanish: {mpmath.nstr(r[:3], 5)} of {mpmath.nstr(size, 3)}:"
                f" {arr['expr'][:300]}"
            )
        orders = {rename[k]: v for k, v in highest_orders(expr, base, measured).items()}
        said = {k: v for k, v in arr["orders"].items() if k not in plant.modes.split()}
        for name in arr.get("only_off_nominal", {}):  # the code holds it, for other numbers
            orders.pop(name, None)
            said.pop(name, None)
        if orders != said:
            wrong.append(f"{arr['name']}: orders {said} for {orders}: {arr['expr'][:300]}")
    faults = _faults(plant, answer, sim)
    seen: dict[str, list[bool]] = {}
    for fault in faults:
        y = sim.perturbed(own(fault))
        if y is None:
            wrong.append(f"(judge cannot perturb {fault})")
            continue
        signals = named(known_signals(y))
        for arr, expr in exprs:
            if {s.name for s in expr.expr.free_symbols} - {*base, *expr.roots}:
                continue
            r, size = evaluate(expr, signals, sim.n)
            moved = max(abs(c) for c in r[:4]) > size * mpf(10) ** -16
            seen.setdefault(fault, []).append(moved)
            if moved != (fault in arr["signature"]):
                wrong.append(
                    f"{arr['name']} {'moves' if moved else 'does not move'} with {fault},"
                    f" signature {arr['signature']}: {arr['expr'][:200]}"
                )
    wrong += _partition(plant, answer, faults)
    return wrong


def _faults(plant: Plant, answer: dict[str, Any], sim: Simulator) -> list[str]:
    said = [*answer["undetectable"], *[f for g in answer["groups"] for f in g]]
    expected = {*sim.params, *sim.inputs, *sim.sensors}
    by_plain = {plant.alias.get(f, plain(f)): f for f in said}
    return [by_plain.get(x, x) for x in sorted(expected)]


def _partition(plant: Plant, answer: dict[str, Any], faults: list[str]) -> list[str]:
    wrong = []
    said = [*answer["undetectable"], *[f for g in answer["groups"] for f in g]]
    if len(set(said)) != len(said):
        wrong.append(f"a fault stands twice in {said}")
    extra, missing = set(said) - set(faults), set(faults) - set(said)
    if extra or missing:
        wrong.append(f"faults: {sorted(extra)} too many, {sorted(missing)} missing")
    columns: dict[tuple[bool, ...], set[str]] = {}
    for f in said:
        columns.setdefault(tuple(f in a["signature"] for a in answer["arrs"]), set()).add(f)
    none = columns.pop(tuple(False for _ in answer["arrs"]), set())
    if none != set(answer["undetectable"]):
        wrong.append(f"undetectable {answer['undetectable']} for {sorted(none)}")
    if {frozenset(v) for v in columns.values()} != {frozenset(g) for g in answer["groups"]}:
        wrong.append(f"groups {answer['groups']} for {sorted(map(sorted, columns.values()))}")
    if plant.undetectable is not None and set(plant.undetectable.split()) != none:
        wrong.append(f"undetectable {sorted(none)}, by hand {plant.undetectable.split()}")
    if plant.groups is not None and plant.groups != len(answer["groups"]):
        wrong.append(f"{len(answer['groups'])} groups, by hand {plant.groups}: {answer['groups']}")
    return wrong
