"""MCAP: JSON, ROS 2, ROS 1 and protobuf by their own writers; damage; a watch of a recording."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from google.protobuf.timestamp_pb2 import Timestamp
from google.protobuf.wrappers_pb2 import DoubleValue
from mcap.writer import Writer
from mcap_protobuf.writer import Writer as ProtobufWriter
from mcap_ros1.writer import Writer as Ros1Writer
from mcap_ros2.writer import Writer as Ros2Writer

from bondgraph.cli.main import main
from bondgraph.runtime.fleet.log_paths import log_files
from bondgraph.runtime.log import Log, LogError
from bondgraph.runtime.log_file import read_log, write_log

_START = 1_700_000_000_000_000_000  # ns since 1970
_MS = 1_000_000
_DRIVE = """std_msgs/Header header
float64[] velocity
int32 count
bool on
string name
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""


def _json(path: Path, messages: Sequence[tuple[str, int, object]]) -> Path:
    """A recording of JSON: topic, time in ns after the start, message."""
    with open(path, "wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("any", "jsonschema", b"{}")
        topics = dict.fromkeys(topic for topic, _, _ in messages)
        channel = {t: writer.register_channel(t, "json", schema) for t in topics}
        for topic, time, message in messages:
            data = message if isinstance(message, bytes) else json.dumps(message).encode()
            at = _START + time
            writer.add_message(channel[topic], log_time=at, data=data, publish_time=at - 7 * _MS)
        writer.finish()
    return path


def _seconds(log: Log) -> list[float]:
    return [round(t, 6) for t in (log.time - _START / 1e9).tolist()]


def test_messages_of_topics_are_rows_and_numbers_in_them_columns(tmp_path: Path) -> None:
    path = _json(tmp_path / "run.mcap", [
        ("/motor", 0, {"i": 1.5, "w": [2, 3], "on": True, "name": "left", "none": None}),
        ("/pump", 4 * _MS, {"state": {"p": 1e5}}),
        ("/motor", 10 * _MS, {"i": 2.5, "w": [4, 5], "on": False}),
        ("/pump", 10 * _MS, {"state": {"p": 2e5}, "image": list(range(5000))}),
    ])  # fmt: skip
    log = read_log(path)
    assert _seconds(log) == [0.0, 0.004, 0.01]
    assert {n: [None if x != x else x for x in c] for n, c in log.columns.items()} == {
        "/motor.i": [1.5, None, 2.5], "/motor.w[0]": [2, None, 4], "/motor.w[1]": [3, None, 5],
        "/motor.on": [1, None, 0], "/pump.state.p": [None, 1e5, 2e5],
    }  # fmt: skip
    assert log.meta["time"] == "the column `log_time`, in ns as the file says"


def test_the_time_may_be_that_of_the_publisher_or_in_the_messages(tmp_path: Path) -> None:
    def stamped(ms: int) -> dict[str, object]:
        time = _START + ms * _MS
        return {"header": {"stamp": {"sec": time // 10**9, "nanosec": time % 10**9}}, "x": ms}

    path = _json(tmp_path / "run.mcap", [
        ("/late", 30 * _MS, stamped(5)), ("/b", 31 * _MS, {"y": 1.0}), ("/c", 40 * _MS, stamped(2)),
    ])  # fmt: skip
    assert _seconds(read_log(path, time="publish_time")) == [0.023, 0.024, 0.033]
    log = read_log(path, time="header.stamp")
    assert _seconds(log) == [0.002, 0.005]
    assert log.columns["/late.x"][1] == 5 and math.isnan(log.columns["/late.x"][0])
    assert log.meta["left-out"] == "/b (messages without header.stamp)"
    assert _seconds(read_log(path, time="/late.header.stamp")) == [0.005]
    numbers = _json(tmp_path / "n.mcap", [("/a", 0, {"ms": 5.0}), ("/a", 9, {"ms": 7.0})])
    assert read_log(numbers, time="ms", unit="ms").time.tolist() == [0.005, 0.007]


def test_messages_of_ros_2(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    with open(path, "wb") as file:
        writer = Ros2Writer(file)
        schema = writer.register_msgdef("robot_msgs/Drive", _DRIVE)
        for k in range(3):
            stamp = {"sec": _START // 10**9, "nanosec": k * _MS}
            message = {
                "header": {"stamp": stamp, "frame_id": "base"}, "velocity": [0.25 * k, -0.5 * k],
                "count": -k, "on": k > 1, "name": "left",
            }  # fmt: skip
            at = _START + (k + 3) * _MS
            writer.write_message("/drive", schema, message, log_time=at, publish_time=at)
        writer.finish()
    log = read_log(path, time="header.stamp")
    assert _seconds(log) == [0.0, 0.001, 0.002]
    columns = {name: column.tolist() for name, column in log.columns.items()}
    assert columns.pop("/drive.header.stamp") == log.time.tolist()
    assert columns == {
        "/drive.velocity[0]": [0.0, 0.25, 0.5], "/drive.velocity[1]": [0.0, -0.5, -1.0],
        "/drive.count": [0, -1, -2], "/drive.on": [0, 0, 1],
    }  # fmt: skip
    assert _seconds(read_log(path)) == [0.003, 0.004, 0.005]


def test_messages_of_ros_1_and_protobuf(tmp_path: Path) -> None:
    class Volts:
        """A message as the generator of ROS 1 makes them."""

        _type, _full_text, _md5sum = "std_msgs/Float64", "float64 data", "0"

        def __init__(self, data: float) -> None:
            self.data = data

        def serialize(self, buffer: object) -> None:
            buffer.write(np.float64(self.data).tobytes())  # type: ignore[attr-defined]

    one = tmp_path / "one.mcap"
    with open(one, "wb") as file:
        writer = Ros1Writer(file)
        for k in range(2):
            writer.write_message("/volts", Volts(1.5 * k), _START + k * _MS, _START)
        writer.finish()
    log = read_log(one)
    assert (_seconds(log), log.columns["/volts.data"].tolist()) == ([0.0, 0.001], [0.0, 1.5])
    other = tmp_path / "other.mcap"
    with open(other, "wb") as file, ProtobufWriter(file) as protobuf:
        for k in range(2):
            at = _START + k * _MS
            protobuf.write_message("/volts", DoubleValue(value=2.5 * k), at, at)
            protobuf.write_message("/clock", Timestamp(seconds=7, nanos=k * _MS), at, at)
    log = read_log(other)
    assert {name: column.tolist() for name, column in log.columns.items()} == {
        "/volts.value": [0.0, 2.5], "/clock": [7.0, 7.001],
    }  # fmt: skip


def test_without_the_package_that_decodes_them_topics_are_left_out_and_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "run.mcap"
    with open(path, "wb") as file:
        writer = Ros2Writer(file)
        schema = writer.register_msgdef("std_msgs/Float64", "float64 data")
        writer.write_message("/volts", schema, {"data": 1.0}, _START, _START)
        writer.finish()
    monkeypatch.setitem(sys.modules, "mcap_ros2.decoder", None)
    with pytest.raises(LogError, match=r"but /volts \(cdr, pip install mcap-ros2-support\)"):
        read_log(path)
    monkeypatch.setitem(sys.modules, "mcap.reader", None)
    with pytest.raises(LogError, match=r"MCAP needs the package mcap; install it"):
        read_log(path)


@pytest.mark.parametrize(
    ("messages", "options", "said"),
    [
        ([("/a", 0, b"{")], {}, "a message of /a is no json: JSONDecodeError"),
        ([("/a", 0, {"x": 10**400})], {}, "a message of /a is no json: OverflowError"),
        ([("/a", 0, b"[" * 900 + b"]" * 900)], {}, "is no json|no message with numbers"),
        ([("/a", 0, {"name": "x"})], {}, "no message with numbers"),
        ([("/a", 0, {"x": 1.0})], {"time": "stamp"}, r"without stamp\); --time is log_time or"),
        ([("/a", 0, {f"x{k}": 1.0 for k in range(100_001)})], {}, "more than .*; name in a map"),
    ],
)
def test_what_is_no_log_is_an_error_with_a_remedy(
    tmp_path: Path, messages: list[tuple[str, int, object]], options: dict[str, str], said: str
) -> None:
    with pytest.raises(LogError, match=said):
        read_log(_json(tmp_path / "run.mcap", messages), **options)  # type: ignore[arg-type]


def test_damage_is_an_error_that_names_the_file(tmp_path: Path) -> None:
    messages = [("/a", k * _MS, {"x": float(k), "y": [1, k]}) for k in range(400)]
    whole = _json(tmp_path / "run.mcap", messages).read_bytes()
    draw = np.random.default_rng(4)
    broken = tmp_path / "broken.mcap"
    cut = [whole[: int(n)] for n in draw.integers(0, len(whole), 20)]
    flipped = []
    for at in draw.integers(0, len(whole), 150):
        data = bytearray(whole)
        data[at] ^= 1 << int(draw.integers(8))
        flipped.append(bytes(data))
    wrong = 0
    for data in [*cut, *flipped, b"", b"t,U\n0,1\n"]:
        broken.write_bytes(data)
        try:
            read_log(broken)
        except LogError as error:
            wrong += 1
            assert error.path == str(broken) and error.help
    assert wrong >= len(cut) + 2  # a file that was cut has no end


def _recorded(log: Log, path: Path, late: Mapping[str, int]) -> Path:
    """Each signal in a topic of its own, so many ns behind the time of its sample."""
    messages = [
        (f"/{name}", round(t * 1e9) + late[name], {"value": value})
        for name, column in log.columns.items()
        for t, value in zip(log.time, column.tolist(), strict=True)
    ]
    return _json(path, sorted(messages, key=lambda m: m[1]))


def _watched(path: Path, *options: str, capsys: pytest.CaptureFixture[str]) -> list[dict[str, Any]]:
    capsys.readouterr()
    assert main(["monitor", "models/dc_motor.bg", str(path), "--json", *options]) == 0
    return [json.loads(line) for line in capsys.readouterr().out.splitlines()]


def test_a_recording_is_watched_as_the_table_of_its_samples_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = tmp_path / "run.csv"
    text = Path("models/scenarios/motor_two_faults.toml").read_text()
    for times in (('"24 s"', '"13 s"'), ('"8 s"', '"5 s"'), ('"16 s"', '"9 s"')):
        text = text.replace(*times)
    scenario = tmp_path / "sooner.toml"
    scenario.write_text(text)
    assert main(["simulate", "models/dc_motor.bg", str(scenario), "-o", str(table)]) == 0
    log = read_log(table)
    write_log(log._replace(time=log.time + _START / 1e9), table)
    columns = tmp_path / "map.toml"
    columns.write_text("".join(f'{name} = "/{name}.value"\n' for name in log.columns))
    first = _watched(table, capsys=capsys)
    assert [v["event"] for v in first][2:] == ["warm-up", "fault", "update", "update", "stop"]
    together = _recorded(log, tmp_path / "run.mcap", dict.fromkeys(log.columns, 0))
    again = _watched(together, "--map", str(columns), capsys=capsys)
    assert again[1:-1] == first[1:-1]  # the others name the file

    # each topic at moments of its own between those of the others: the rate is that of each
    late = {name: 210_000 * k for k, name in enumerate(log.columns)}
    apart = _recorded(log, tmp_path / "apart.mcap", late)
    assert read_log(apart).rows == len(log.columns) * log.rows
    said = _watched(apart, "--map", str(columns), capsys=capsys)
    assert " at 1000 samples a second" in said[0]["message"]
    named = [next(v["group"] for v in watch if v.get("group")) for watch in (first, said)]
    assert named[0] == named[1]


def test_only_topics_that_the_map_names_are_read(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    slow = [("arm.motor", k * 2 * _MS, dict.fromkeys("abcd", 0.0)) for k in range(3000)]
    fast = [("/imu", k * _MS // 4, {"x": 1.0}) for k in range(24_000)]
    path = _json(tmp_path / "run.mcap", sorted(slow + fast, key=lambda m: m[1]))
    columns = tmp_path / "map.toml"
    names = zip(("U", "load", "current", "speed"), "abcd", strict=True)
    columns.write_text("".join(f'{signal} = "arm.motor.{name}"\n' for signal, name in names))
    said = _watched(path, "--map", str(columns), capsys=capsys)
    assert " at 500 samples a second" in said[0]["message"]
    assert "after 3000 samples" in said[-1]["message"]


def test_a_recording_is_not_followed_and_a_folder_of_them_is_a_fleet(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = _json(tmp_path / "run.mcap", [("/a", k * _MS, {"x": 1.0}) for k in range(9)])
    assert main(["monitor", "models/dc_motor.bg", str(path), "--follow"]) == 1
    assert "an MCAP file cannot be followed; follow a CSV file" in capsys.readouterr().err
    assert [one.path for one in log_files([str(tmp_path)], print)] == [str(path)]
