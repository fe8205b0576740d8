"""Whatever a scenario says: a run, or diagnostics that stand at their places."""

from __future__ import annotations

import pytest

from bondgraph.runtime.simulation.integrate import SimulationError
from bondgraph.runtime.simulation.read_scenario import read_scenario
from bondgraph.text.diagnostic import CompileError, Report
from bondgraph.text.source import Source
from tests.simulation.broken_texts import MOTOR, OVEN, broken
from tests.simulation.machines import example, read, run

MACHINES = {MOTOR: example("dc_motor"), OVEN: example("oven")}
_SAMPLES = 500  # longer runs are read, but not run


@pytest.mark.parametrize("text", MACHINES, ids=["motor", "oven"])
def test_what_is_to_be_broken_is_sound(text: str) -> None:
    assert run(MACHINES[text], text).log.rows > 30


@pytest.mark.parametrize("part", range(8))
def test_no_scenario_gives_a_traceback(part: int) -> None:
    refused = 0
    for seed in range(part * 100, part * 100 + 100):
        sound = (MOTOR, OVEN)[seed % 2]
        machine, text = MACHINES[sound], broken(seed, sound)
        report = Report()
        found = read_scenario(Source("s.toml", text), machine.graph, report)
        assert (found is None) == report.failed
        refused += found is None
        for diagnostic in report.diagnostics:
            assert diagnostic.help and diagnostic.labels
            for label in diagnostic.labels:
                assert label.span.source.path == "s.toml"
                assert label.span.end <= len(text)
        if found is not None and found.duration * found.sampling.rate < _SAMPLES:
            try:
                machine.simulate(found)
            except (CompileError, SimulationError) as error:
                assert str(error)
    assert 40 < refused < 95


WRONG = {
    '[inputs]\nU = "~5 N~"': "unit-mismatch",
    '[inputs]\nU = ~5 V': "scenario-syntax",
    "[inputs]\nUU = ~5~": "scenario-name",
    '[inputs]\nU = "~5 Volts~"': "unknown-unit",
    '[inputs]\nU = "12*sin(~RR~*t)"': "unknown-name",
    '[inputs]\nU = "12*~sn(t)~"': "unknown-function",
    '[inputs]\nU = "12*(1 + ~"': "syntax-unexpected",
    '[inputs]\nU = { table = ~[[1, 0], [0, 1]]~ }': "scenario-value",
    '[inputs]\nU = { table = [[0, 0], [1, "1 N"]] }': "unit-mismatch",
    '[inputs]\nU = { file = "~none.csv~", column = "U" }': "scenario-value",
    "[inputs]\nU = ~true~": "scenario-value",
    "durration = ~3~": "scenario-key",
    "duration = ~-3~": "scenario-value",
    'duration = "~3 V~"': "unit-mismatch",
    "duration = ~nan~": "scenario-value",
    "duration = ~[1]~": "scenario-value",
    "seed = ~1.5~": "scenario-value",
    'method = "~Euler~"': "scenario-value",
    'spread = "~normal~"': "scenario-value",
    "tolerance = ~0~": "scenario-value",
    "record = ~3~": "scenario-value",
    'record = ["~x.e~"]': "scenario-name",
    'quasi_static = ["~line~"]': "scenario-name",
    "[parameters]\nRR = ~3~": "scenario-name",
    '[parameters]\nR = "~3 H~"': "unit-mismatch",
    '[initial]\n"x.q" = ~3~': "scenario-name",
    '[initial]\n"L.p" = "~3 A~"': "unit-mismatch",
    '[sampling]\nrate = "~1 s~"': "unit-mismatch",
    "[sampling]\nrate = ~0~": "scenario-value",
    "[sampling]\njitter = ~2~": "scenario-value",
    "[sampling]\njiter = ~0~": "scenario-key",
    "[~sensors.torque~]\nnoise = 1": "scenario-name",
    '[sensors.speed]\nnoise = "~1 A~"': "unit-mismatch",
    "[sensors.speed]\nnoise = ~-1~": "scenario-value",
    '[[controller]]\ninput = "~V~"\nmeasures = "speed"\nsetpoint = 1': "scenario-name",
    '[[controller]]\ninput = "U"\nmeasures = "~sped~"\nsetpoint = 1': "scenario-name",
    '[[~controller~]]\ninput = "U"\nmeasures = "speed"': "scenario-key",
    '[[controller]]\ninput = "U"\nmeasures = "speed"\nsetpoint = "~1 A~"': "unit-mismatch",
    '[[controller]]\ninput = "U"\nmeasures = "speed"\nsetpoint = 1\nkp = "~1 Ohm~"':
        "unit-mismatch",
    '[[controller]]\ninput = "U"\nmeasures = "speed"\nsetpoint = 1\nperiod = ~0.0015~':
        "scenario-value",
    '[[controller]]\ninput = "U"\nmeasures = "speed"\nsetpoint = 1\nperiod = ~1e-300~':
        "scenario-value",
    '[[controller]]\ninput = "U"\nmeasures = "speed"\nsetpoint = 1\nlimits = ~[5, -5]~':
        "scenario-value",
    '[inputs]\nU = 1\n[[controller]]\ninput = "~U~"\nmeasures = "speed"\nsetpoint = 1':
        "scenario-value",
    '[[fault]]\nof = "~Q~"\nchange = "+= 1"': "scenario-name",
    '[[fault]]\nof = "R"\nchange = "+= ~1 V~"': "unit-mismatch",
    '[[fault]]\nof = "R"\nchange = "~more~"': "scenario-value",
    '[[~fault~]]\nof = "R"': "scenario-value",
    '[[fault]]\nof = "R"\nchange = "~missing~"': "scenario-value",
    '[[fault]]\nof = "R"\nchange = "*= 2"\nat = 1\nuntil = ~0.5~': "scenario-value",
    '[[fault]]\nof = "R"\nchange = "*= 2"\nperiod = "1 s"\nduty = ~1.5~': "scenario-value",
    '[[fault]]\nof = "R"\nchange = "*= 2"\nwhen = ~1~': "scenario-key",
    'duration = 9\n[[fault]]\nof = "R"\nchange = "*= 2"\nperiod = "~1 us~"': "scenario-value",
    '[[fault]]\nevent = "~fire~"': "scenario-name",
    '[plane]\nx = "~x~"\ny = "y"': "scenario-name",
    "[desired]\nspeeed = ~1~": "scenario-name",
    "[~fault~]\nof = 3": "scenario-value",
    '[inputs]\nU = ~"int(t)"~': "scenario-value",
}  # fmt: skip


SWITCHES = {
    '[[fault]]\nof = "on"\nchange = "~+= 1~"': "scenario-value",
    '[[fault]]\nof = "on"\nchange = "~= 1 V~"': "scenario-value",
    '[[fault]]\nof = "on"\nchange = "~missing~"': "scenario-value",
    '[[~fault~]]\nof = "on"': "scenario-value",
    '[[fault]]\nof = "on"\nchange = "stuck"\nramp = ~1~': "scenario-value",
}


@pytest.mark.parametrize(("marked", "code"), [*WRONG.items(), *SWITCHES.items()])
def test_what_is_wrong_is_told_at_its_place(marked: str, code: str) -> None:
    """The place is between the two `~`."""
    text = marked.replace("~", "")
    report = Report()
    machine = MACHINES[OVEN if marked in SWITCHES else MOTOR]
    assert read_scenario(Source("s.toml", text), machine.graph, report) is None
    found = next(d for d in report.diagnostics if d.code == code)
    if marked.count("~") == 2:
        start = marked.index("~")
        end = marked.rindex("~") - 1
        span = found.labels[0].span
        assert (span.start, span.end) == (start, end) or text[start:end].strip('"') == span.text


def test_the_same_scenario_is_read_the_same() -> None:
    one, other = (read(MACHINES[MOTOR], MOTOR) for _ in range(2))
    assert one._replace(faults=()) == other._replace(faults=())
    assert [f._replace(origin=None) for f in one.faults] == [
        f._replace(origin=None) for f in other.faults
    ]
