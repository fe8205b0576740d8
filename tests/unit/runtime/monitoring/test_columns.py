"""Columns find their signals by path, by C name or by a map; what is missing is all named."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from bondgraph.ir.program import Known
from bondgraph.runtime.log import Log, LogError
from bondgraph.runtime.log_file import read_log
from bondgraph.runtime.monitoring.columns import (
    Columns,
    Mapped,
    _close,
    read_columns,
    read_map,
    read_time,
)


def _known(path: str, unit: str = "V", **more: object) -> Known:
    name = path.replace("[", "__").replace("]", "").replace(".", "__")
    made = Known(name, path, unit, "", "input", 0, False, None, None)
    return made._replace(**more)  # type: ignore[arg-type]


_SIGNALS = (
    _known("U0[1]"),
    _known("m[1].me.we", "rad/s", kind="sensor"),
    _known("angle", "rad", kind="sensor", counts=24.0),
    _known("on", "", kind="mode"),
)


def _log(units: dict[str, str] | None = None, **columns: float) -> Log:
    named = {name.replace("·", "."): np.array([value, value]) for name, value in columns.items()}
    return Log(np.arange(2.0), named, units or {}, {})


def test_by_path_before_the_name_in_c() -> None:
    log = Log(
        np.zeros(1),
        {
            "x": np.array([9.0]), "on": np.array([1.0]), "U0__1": np.array([1.0]),
            "U0[1]": np.array([2.0]), "angle": np.array([7.4]), "m__1__me__we": np.array([3.0]),
        },
        {}, {},
    )  # fmt: skip
    assert Columns(_SIGNALS)(log).tolist() == [[2.0, 3.0, 7.0, 1.0]]
    assert Columns(_SIGNALS).used(log)["m[1].me.we"] == "m__1__me__we"


def test_all_that_is_missing_is_named_with_what_is_close() -> None:
    log = _log(**{"u0 1": 1.0, "Angle": 2.0, "other": 3.0})
    with pytest.raises(LogError) as error:
        Columns(_SIGNALS, name="run.csv")(log)
    text = str(error.value)
    assert text.startswith("run.csv: no column for U0[1] (V, perhaps `u0 1`), m[1].me.we (rad/s), ")
    assert "angle (counts, perhaps `Angle`), on;" in text
    assert "there is u0 1, Angle, other" in text


def test_a_signal_that_no_step_reads_may_be_missing() -> None:
    samples = Columns([_known("U"), _known("T", sampled=False)])(_log(U=4.0))
    np.testing.assert_array_equal(samples, [[4.0, math.nan]] * 2)


def test_a_column_of_words_is_named_among_the_reasons(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("t,U,V\n0,off,1\n")
    with pytest.raises(LogError, match=r"no column for U .*columns without numbers: U \(`off`\)"):
        Columns([_known("U")])(read_log(tmp_path / "a.csv"))


@pytest.mark.parametrize(
    ("own", "unit", "given", "expected"),
    [
        ("V", "mV", 1500.0, 1.5),
        ("V", "V", 1.5, 1.5),
        ("V", "", 1.5, 1.5),
        ("V", "W/A", 1.5, 1.5),
        ("rad/s", "rpm", 60.0, 2 * math.pi),
        ("rad", "deg", 180.0, math.pi),
        ("Pa", "bar", 2.0, 2e5),
        ("K", "degC", 26.85, 300.0),
        ("K", "°C", -273.15, 0.0),
        ("K", "degF", 212.0, 373.15),
        ("degC", "degF", 212.0, 100.0),
        ("degC", "K", 300.0, 26.85),
        ("W/K", "W/degC", 2.0, 2.0),  # a difference of temperatures has no zero
        ("", "mV", 3.0, 3.0),  # nothing fixes the unit of the model
    ],
)
def test_units_of_one_dimension_are_converted(
    own: str, unit: str, given: float, expected: float
) -> None:
    samples = Columns([_known("x", own)])(_log({"x": unit}, x=given))
    np.testing.assert_allclose(samples, [[expected]] * 2, rtol=1e-14, atol=1e-12)


@pytest.mark.parametrize(
    ("known", "unit", "message"),
    [
        (_known("x", "V"), "A", "x is in V, its column x is in A"),
        (_known("x", "rad/s"), "m/s", "x is in rad/s, its column x is in m/s"),
        (_known("x", "V"), "blip", "unknown unit"),
        (_known("x", "K"), "bar", "x is in K, its column x is in bar"),
        (_known("x", "rad", counts=24.0), "rad", "read in counts"),
    ],
)
def test_other_units_are_refused(known: Known, unit: str, message: str) -> None:
    with pytest.raises(LogError, match=message):
        Columns([known])(_log({"x": unit}, x=1.0))
    scaled = Columns([known], {"x": Mapped("x", 2.0, 1.0)})(_log({"x": unit}, x=3.0))
    assert scaled.tolist() == [[7.0], [7.0]]  # who gives a scale knows


def test_a_map_file(tmp_path: Path) -> None:
    path = tmp_path / "map.toml"
    path.write_text(
        '"U0[1]" = { column = "volts", unit = "mV" }\n'
        'm__1__me__we = { column = "rpm", scale = 0.5, offset = -1 }\n'
        'on = "switch"\n'
    )
    mapping = read_map(path, _SIGNALS)
    log = _log(volts=3000.0, rpm=8.0, switch=1.0, angle=5.0, on=0.0)
    assert Columns(_SIGNALS, mapping)(log).tolist() == [[3.0, 3.0, 5.0, 1.0]] * 2
    with pytest.raises(LogError, match=r"U0\[1\] \(V, `volts` in the map file, perhaps `volt`\)"):
        Columns(_SIGNALS, mapping)(_log(volt=1.0, rpm=1.0, switch=1.0, angle=1.0))
    path.write_text('coil.i = "a"\nrotor = { w = { column = "b" } }\n')
    assert read_map(path, [_known("coil.i"), _known("rotor.w")]) == {
        "coil.i": Mapped("a"),
        "rotor.w": Mapped("b"),
    }


def test_a_map_file_may_say_where_the_time_is(tmp_path: Path) -> None:
    """Unless a signal is called so: then it is that."""
    path = tmp_path / "map.toml"
    path.write_text('time = { column = "stamp", unit = "ms" }\non = "switch"\n')
    assert read_map(path, _SIGNALS) == {"on": Mapped("switch")}
    assert read_map(path, [_known("time"), _known("on")]).keys() == {"time", "on"}
    clock = read_time(path)
    assert clock is not None and (clock.column, clock.unit) == ("stamp", "ms")
    assert read_columns(path) == {"stamp", "switch"}
    path.write_text('on = "switch"\n')
    assert read_time(path) is None
    for more in ("scale = 2.0", "offset = 1.0"):
        path.write_text(f'time = {{ column = "stamp", {more} }}\n')
        with pytest.raises(LogError, match="a scale or an offset"):
            read_time(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("\nU0[1] = 3\n", r"map\.toml:2: not TOML"),
        ('"U0(1)" = "a"\n', r"no signal `U0\(1\)`; perhaps U0\[1\]"),
        ('"on" = 3\n', "on is no name of a column"),
        ('"on" = { column = "a", sale = 2 }\n', "unknown `sale`"),
        ('"on" = { column = "a", scale = "2" }\n', "must be numbers"),
        ('"on" = { column = "a", scale = nan }\n', "must be numbers"),
        ('"on" = { column = "a", scale = true }\n', "must be numbers"),
        (f'"on" = {{ column = "a", scale = 1{"0" * 301} }}\n', r"must be numbers, up to 1e\+300"),
        ('"on" = { column = "a", scale = 2, unit = "V" }\n', "a unit and a scale"),
        ('"on" = { column = "a", unit = 2 }\n', "must be a text"),
        ('"on" = {}\n', "no column"),
        ('"on" = { scale = 2 }\n', "no signal `on.scale`|no column"),
    ],
)
def test_a_wrong_map_file_is_told(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "map.toml"
    path.write_text(text)
    with pytest.raises(LogError, match=message):
        read_map(path, _SIGNALS)


def test_a_map_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="cannot be read"):
        read_map(tmp_path / "none.toml", _SIGNALS)


def test_chunks_with_other_columns_are_matched_anew() -> None:
    columns = Columns([_known("U")])
    assert columns(_log(U=1.0)).tolist() == [[1.0], [1.0]]
    assert columns(_log({"U": "mV"}, U=1.0)).tolist() == [[1e-3], [1e-3]]
    with pytest.raises(LogError, match="no column for U"):
        columns(_log(V=1.0))


@pytest.mark.parametrize(
    ("wanted", "names", "close"),
    [
        # alike are twice the letters in common over all: 8/13, 18/20 and, but for signs, all
        ("volt left", ["volt", "volt left a", "VOLT_LEFT"], ["volt left a", "VOLT_LEFT"]),
        ("volt left", ["volt", "amps"], ["volt"]),
        ("volt left", ["vol", "amps"], []),  # 6/12
        ("Volt-Left!", ["volt left", "VOLT_LEFT", "volt.left"], ["volt left", "VOLT_LEFT"]),
        ("volt_left", [], []),
    ],
)
def test_the_two_names_that_are_closest_may_be_meant(
    wanted: str, names: list[str], close: list[str]
) -> None:
    assert _close(wanted, names) == close
