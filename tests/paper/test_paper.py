"""The robot's relations and signatures against a derivation of the paper that is not ours."""

from __future__ import annotations

from pathlib import Path

import pytest
import sympy as sp

import bondgraph
from bondgraph.views import Relation
from tests.paper import plant
from tests.paper.plant import NUMBERS, t

MODELS = Path(__file__).parents[2] / "models"
AT = sp.Rational(3, 7)  # the moment at which everything is evaluated
DIGITS = 60

#: Motions to choose from: nothing in them is special.
MOTIONS = [
    (2 - 3 * t + t**2 / 2 + t**3, 1 + t / 3 - 2 * t**2 + t**4 / 5),
    (1 + t**2 - t**4 / 7 + t / 5, 3 - t + t**3 / 4),
    (t - t**3 + t**5 / 9 + 4, t / 2 + t**2 - t**5 / 3 - 1),
]
FREE = [1 + t - t**3 / 3, 2 - t**2 + t**4 / 6, 3 * t + t**2 / 7 - t**5]


def number(expr: sp.Expr) -> sp.Expr:
    """A value to many digits at the chosen moment."""
    return sp.N(expr.subs(NUMBERS).subs(t, AT), DIGITS)


def ours(relation: Relation, signals: dict[str, sp.Expr], params: dict[str, sp.Symbol]) -> sp.Expr:
    """Our relation on given signals; names are the model's, the parameters those of the paper."""
    expr = relation.expr
    known = {f: signals[f.func.__name__] for f in expr.atoms(sp.core.function.AppliedUndef)}
    named = {s: params[s.name] for s in expr.free_symbols if s != t}
    return number(expr.subs(named).subs(known).doit())


def drive_names(j: int) -> dict[str, sp.Symbol]:
    m = f"m[{j}]"
    own = {f"{m}.el.{n}": getattr(plant, n) for n in ("L", "Re", "k")}
    own |= {f"{m}.me.{n}": getattr(plant, n) for n in ("Je", "fe", "K")}
    own |= {f"{m}.wh.{n}": getattr(plant, n) for n in ("Js", "fs", "R")}
    return own | {f"{m}.ge.N": plant.N, f"{m}.tau0": plant.tau0, f"{m}.A": plant.A}


def drive_signals(j: int, s: dict[str, sp.Expr]) -> dict[str, sp.Expr]:
    m = f"m[{j}]"
    return {
        f"U0[{j}]": s["U0"],
        f"Fx[{j}]": s["Fx"],
        f"{m}.me.we": s["We"],
        f"{m}.wh.ws": s["Ws"],
    }


CABLE = {"line.R": plant.RL, "line.L": plant.LL, "line.C": plant.CL}


@pytest.fixture(scope="module")
def robot() -> bondgraph.Compilation:
    return bondgraph.compile(MODELS / "khepera.bg")


def ratio(values: list[tuple[sp.Expr, sp.Expr]]) -> sp.Expr:
    """The common ratio of pairs; fails if it is not one and the same number, not zero."""
    ratios = [a / b for a, b in values]
    assert all(abs(r - ratios[0]) < 1e-40 * abs(ratios[0]) for r in ratios)
    assert abs(ratios[0]) > 1e-20
    return ratios[0]


@pytest.mark.parametrize("j", [1, 2])
@pytest.mark.parametrize(("which", "by_hand"), [(0, plant.r1), (1, plant.r2)])
def test_drive_relations_equal_the_derivation(robot, j, which, by_hand) -> None:
    relation = robot.residuals[2 * (j - 1) + which]
    pairs = []
    for (We, Ws), U0, Fx in zip(MOTIONS, FREE, FREE[1:] + FREE[:1], strict=True):
        s = {"We": We, "Ws": Ws, "U0": U0, "Fx": Fx}  # no solution of (10): nothing vanishes
        pairs.append((ours(relation, drive_signals(j, s), drive_names(j)), number(by_hand(s))))
    ratio(pairs)


def test_cable_relation_equals_the_derivation(robot) -> None:
    pairs = []
    for Us, Uin in zip(FREE, FREE[1:] + FREE[:1], strict=True):
        s = {"Us": Us, "Uin": Uin}
        pairs.append((ours(robot.residuals[4], s, CABLE), number(plant.r3(s))))
    ratio(pairs)


@pytest.mark.parametrize("motion", MOTIONS)
def test_ours_vanish_on_10_and_the_printed_24_25_do_not(robot, motion) -> None:
    s = plant.drive(*motion)
    for j in (1, 2):
        for relation in robot.residuals[2 * j - 2 : 2 * j]:
            assert abs(ours(relation, drive_signals(j, s), drive_names(j))) < 1e-45
    assert abs(number(s["Fx"])) > 1e-3
    assert abs(number(plant.backlash(*motion)[1])) > 1e-3
    assert abs(number(plant.printed_24(s))) > 1e-3
    assert abs(number(plant.printed_25(s))) > 1e-3


@pytest.mark.parametrize("Us", FREE)
@pytest.mark.parametrize("output", [True, False])
def test_ours_vanishes_on_23_and_the_printed_26_does_not(robot, Us, output) -> None:
    s = plant.cable(Us, output)
    if output:
        relation = robot.residuals[4]
    else:
        relation = bondgraph.compile(MODELS / "cable_open.bg").residuals[0]
    assert abs(ours(relation, s, CABLE)) < 1e-45
    assert abs(number(plant.printed_26(s))) > 1e-3


def test_open_cable_gives_r3a() -> None:
    relation = bondgraph.compile(MODELS / "cable_open.bg").residuals[0]
    pairs = []
    for Us, Uin in zip(FREE, FREE[1:] + FREE[:1], strict=True):
        s = {"Us": Us, "Uin": Uin}
        pairs.append((ours(relation, s, CABLE), number(plant.r3a(s))))
    ratio(pairs)


def test_drawn_as_fig_6_the_motor_carries_minus_two_w() -> None:
    compiled = bondgraph.compile(MODELS / "drive_fig6.bg")
    names = {n.removeprefix("m[1]."): s for n, s in drive_names(1).items()}
    pairs = []
    for (We, Ws), U0, Fx in zip(MOTIONS, FREE, FREE[1:] + FREE[:1], strict=True):
        s = {"We": We, "Ws": Ws, "U0": U0, "Fx": Fx}
        _, w = plant.backlash(We, Ws)
        signals = {"U0": U0, "Fx": Fx, "me.we": We, "wh.ws": Ws}
        value = ours(compiled.residuals[0], signals, names)
        pairs.append((value, number(plant.r1(s, extra=-2 * w))))
    ratio(pairs)


def test_signatures_are_those_of_the_paper_checked(robot) -> None:
    found = {f: robot.signatures.row(f) for f in robot.signatures.faults}
    expected: dict[str, tuple[bool, ...]] = {}
    for j in (1, 2):
        m = f"m[{j}]"
        first = [f"U0[{j}]", *[f"{m}.el.{n}" for n in ("Re", "L", "k")]]
        first += [f"{m}.me.Je", f"{m}.me.fe"]
        second = [f"{m}.me.K", f"{m}.A", f"{m}.tau0"]
        both = [f"{m}.ge.N", f"{m}.wh.Js", f"{m}.wh.fs", f"{m}.wh.R", f"Fx[{j}]"]
        both += [f"{m}.me.we", f"{m}.wh.ws"]
        for names, own in ((first, (True, False)), (second, (False, True)), (both, (True, True))):
            row = [False] * 5
            row[2 * j - 2], row[2 * j - 1] = own
            expected |= dict.fromkeys(names, tuple(row))
    cable = (False, False, False, False, True)
    expected |= dict.fromkeys(["Uin", "line.R", "line.L", "line.C", "Us"], cable)
    chassis = [f"body.{n}" for n in ("m", "fm", "d", "Iz", "fz")]
    expected |= dict.fromkeys(chassis, (False,) * 5)
    assert found == expected
    assert set(robot.signatures.undetectable) == set(chassis)
    assert len(robot.signatures.groups) == 7
    assert all(len(group) > 1 for group in robot.signatures.groups)


def test_number_of_relations_is_the_number_of_sensors(robot) -> None:
    assert [r.name for r in robot.residuals] == ["r1", "r2", "r3", "r4", "r5"]
    assert len(robot.residuals) == len(robot.graph.sensors)
