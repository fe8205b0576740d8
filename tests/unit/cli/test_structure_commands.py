"""`isolate` and `sensors` from the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.unit.cli.conftest import MODELS, Command

TANK = MODELS / "structure" / "three_tank.csv"


def test_isolate_a_table(bondgraph: Command) -> None:
    done = bondgraph("isolate", TANK)
    assert (done.status, done.err) == (0, "")
    assert "three_tank: at best 6 of 6 faults can be detected, in 4 groups" in done.out
    assert "12 equations, 10 unknowns, redundancy 2\n6 MSO sets\n" in done.out
    assert "  fV2, fV3, fT3\n" in done.out
    assert "derivative_p1" not in done.out
    assert "derivative_p1" in bondgraph("isolate", TANK, "--sets").out


def test_isolate_json(bondgraph: Command) -> None:
    found = json.loads(bondgraph("isolate", TANK, "--json", "--sets").out)
    assert (found["n_mso"], found["complete"], found["redundancy"]) == (6, True, 2)
    assert found["groups"] == found["mso_groups"]
    assert len(found["sets"]) == 6 and len(found["chosen"]) == 4 and found["least"]
    for entry in found["chosen"]:
        assert entry["equations"] in found["sets"]
        assert entry["residual"] in entry["equations"]
    cut = json.loads(bondgraph("isolate", TANK, "--json", "--limit", "2").out)
    assert (cut["n_mso"], cut["complete"], cut["least"]) == (2, False, False)
    assert cut["groups"] == found["groups"]


def test_isolate_a_bond_graph(bondgraph: Command) -> None:
    found = json.loads(bondgraph("isolate", MODELS / "dc_motor.bg", "--json").out)
    # two relations in four classes of equations: each set leaves one class out
    assert (found["redundancy"], found["n_mso"]) == (2, 4)
    assert ["R", "L", "U"] in [sorted(g, key="RLU".find) for g in found["groups"]]


def test_no_redundancy_is_an_answer(bondgraph: Command, tmp_path: Path) -> None:
    table = tmp_path / "t.csv"
    table.write_text("e,x:a,f:g\nlaw,1,1\n")
    done = bondgraph("isolate", table)
    assert done.status == 0 and "no fault can be detected" in done.out
    done = bondgraph("sensors", table)
    assert done.status == 0 and "The cheapest that reaches as much as all (cost 1)\n  a" in done.out


@pytest.mark.parametrize("command", ["isolate", "sensors"])
def test_a_wrong_table_is_told(bondgraph: Command, tmp_path: Path, command: str) -> None:
    table = tmp_path / "t.csv"
    table.write_text("e,a\nlaw,1\n")
    done = bondgraph(command, table)
    assert done.status == 1 and "table-column" in done.err and "t.csv:1:3" in done.err
    found = json.loads(bondgraph(command, table, "--json").out)
    assert found["status"] == "error" and found["diagnostics"][0]["code"] == "table-column"
    assert bondgraph(command, tmp_path / "none.csv").status == 1


def test_wrong_usage(bondgraph: Command) -> None:
    assert bondgraph("isolate", TANK, "--limit", "0").status == 2
    assert bondgraph("sensors", TANK, "--cost", "p1").status == 2
    done = bondgraph("sensors", TANK, "--cost", "nothing=2")
    assert done.status == 2 and "nothing" in done.err


def test_sensors_ranks_places(bondgraph: Command) -> None:
    found = json.loads(bondgraph("sensors", TANK, "--json").out)
    assert [c["sensor"] for c in found["candidates"]][:2] == ["q3", "p3"]
    assert found["placement"]["sensors"] == ["q3"] and found["placement"]["least"]
    assert found["n_groups"] == 4 and len(found["groups"]) == 6
    # fV3 and fT3 are in the two equations of q3: only a sensor of q3 keeps them apart
    dear = json.loads(bondgraph("sensors", TANK, "--json", "--cost", "q3=5").out)
    assert dear["placement"]["sensors"] == ["q3"] and dear["placement"]["cost"] == 5


def test_sensors_of_a_bond_graph(bondgraph: Command) -> None:
    done = bondgraph("sensors", MODELS / "chassis.bg")
    assert done.status == 0 and "Df at body.yaw" in done.out
    assert "No choice of these sensors tells apart\n" in done.out
    assert "--elements" in done.out
    done = bondgraph("sensors", MODELS / "dc_motor.bg", "--elements", "--cost", "R=2.5")
    assert done.status == 0 and "--elements" not in done.out
    assert "2.5" in next(line for line in done.out.splitlines() if "De at R" in line)
