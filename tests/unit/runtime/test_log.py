"""Logs come back as they were written; what is not a log is told with file and line."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bondgraph.runtime import log_numbers
from bondgraph.runtime.log import Log, LogError, joined
from bondgraph.runtime.log_file import CsvReader, read_log, write_log
from bondgraph.runtime.log_numbers import Form

_TEXT = st.text(st.characters(exclude_categories=("Cs",)), max_size=12)
_NAME = st.text(st.characters(exclude_categories=("Cs",), exclude_characters="\r\n"), min_size=1)
_KEY = st.from_regex(r"[A-Za-z_][A-Za-z0-9_.-]{0,8}", fullmatch=True)


@st.composite
def _logs(draw: st.DrawFn) -> Log:
    rows = draw(st.integers(0, 6))
    column = st.lists(st.floats(), min_size=rows, max_size=rows).map(np.array)
    names = draw(st.lists(_NAME, max_size=4, unique=True))
    return Log(
        np.asarray(draw(column), dtype=float),
        {name: np.asarray(draw(column), dtype=float) for name in names},
        {name: draw(_TEXT.filter(bool)) for name in names if draw(st.booleans())},
        draw(st.dictionaries(_KEY, _TEXT, max_size=3)),
    )


def _bits(array: np.ndarray) -> list[int]:
    plain = np.where(np.isnan(array), math.nan, array)  # one NaN is like another
    return plain.view(np.int64).tolist()


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
@given(log=_logs())
def test_what_is_read_back_has_the_same_bits(suffix: str, log: Log) -> None:
    path = Path(f"{_FOLDER}/log{suffix}")
    write_log(log, path)
    back = read_log(path)
    assert back.units == log.units and back.meta == log.meta
    assert list(back.columns) == list(log.columns)
    assert _bits(back.time) == _bits(log.time)
    assert [_bits(c) for c in back.columns.values()] == [_bits(c) for c in log.columns.values()]
    assert [p.name for p in path.parent.iterdir() if "tmp" in p.name] == []


@pytest.fixture(autouse=True, scope="module")
def _folder(tmp_path_factory: pytest.TempPathFactory) -> None:
    global _FOLDER
    _FOLDER = tmp_path_factory.mktemp("logs")


def _read(tmp_path: Path, text: str | bytes, **options: object) -> Log:
    path = tmp_path / "a.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_log(path, **options)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("", None, "empty"),
        ("# only a comment\n", None, "nothing but comments"),
        ("t,a\n0,1\n1,2,3\n", 3, "3 cells where the header names 2"),
        ("t,a\n0,1\n\n# note\n1\n", 5, "1 cells where the header names 2"),
        ("t,a\n0,1\n1,x\n", 3, "`x` in the column a is not a number"),
        ("t;a\n0;1.5\n1;2,5\n", 3, "decimal commas and points are mixed"),
        ("t,a\n0,1\n1,1_000\n", 3, "not a number"),
        ("0,1\n1,2\n", 1, "no header"),
        ("t,a,a\n0,1,2\n", 1, "two columns are called `a`"),
        ("t,,a\n0,1,2\n", 1, "column 2 has no name"),
        ("a,b\n0,1\n", 1, "no column of time"),
        (b"t,a\n0,1\n1,\xff\n", 3, "not UTF-8"),
        ("# bondgraph log 7\nt,a\n0,1\n", 1, "edition 7"),
        ("t,a\nnow,1\n", 2, "`now` in the column t"),
    ],
)
def test_a_wrong_file_is_told_with_its_line(
    tmp_path: Path, text: str | bytes, line: int | None, message: str
) -> None:
    with pytest.raises(LogError) as error:
        _read(tmp_path, text)
    assert error.value.line == line
    assert message in str(error.value) and "a.csv" in str(error.value)


def test_a_wrong_line_far_behind_is_told(tmp_path: Path) -> None:
    rows = "".join(f"{k},{k}.5,3\n" for k in range(400_000))
    with pytest.raises(LogError, match=r"a\.csv:300002: 2 cells"):
        _read(tmp_path, "t,a,b\n" + rows.replace("300000,300000.5,3\n", "300000,3\n"))


@pytest.mark.parametrize(
    "text",
    [
        "t;a;b\n0;1;\n0.1;;true\n",
        "Time\ta\tb\n0\t1\tNA\n0.1\tnan\t1\n",
        "# t, a, b\n0,1,nan\n.1, null ,1e0\n",
        "\ufefft,a,b,\r\n0,1,,\r\n.1,,1,\r\n",
    ],
)
def test_logs_of_other_people(tmp_path: Path, text: str) -> None:
    log = _read(tmp_path, text)
    assert log.time.tolist() == [0.0, 0.1]
    np.testing.assert_array_equal(log.columns["a"], [1.0, math.nan])
    np.testing.assert_array_equal(log.columns["b"], [math.nan, 1.0])


def test_time_by_name_unit_or_rate(tmp_path: Path) -> None:
    assert _read(tmp_path, "time_ms,a\n1500,1\n").time.tolist() == [1.5]
    assert _read(tmp_path, "t [us],a\n1500,1\n").time.tolist() == [0.0015]
    assert _read(tmp_path, "stamp,a\n1500,1\n", time="stamp").time.tolist() == [1500.0]
    assert _read(tmp_path, "a\n1\n2\n3\n", rate=4.0).time.tolist() == [0.0, 0.25, 0.5]
    with pytest.raises(LogError, match="no column `when`; there is t, a"):
        _read(tmp_path, "t,a\n0,1\n", time="when")


def test_a_column_of_words_is_left_out_and_told(tmp_path: Path) -> None:
    log = _read(tmp_path, "t,state,a\n0,idle,1\n1,drive,2\n")
    assert list(log.columns) == ["a"] and log.columns["a"].tolist() == [1.0, 2.0]
    assert log.meta["left-out"] == "state (`idle`)"


@given(st.lists(st.integers(1, 9), max_size=6), st.booleans())
def test_lines_may_come_in_any_pieces(pieces: list[int], named: bool) -> None:
    lines = ["# note\n", "t,a\n" if named else "# t,a\n", *[f"{k},{k * k}\n" for k in range(9)]]
    reader, parts = CsvReader(Form("x.csv")), []
    for length in [*pieces, len(lines)]:
        parts.append(reader.feed(lines[:length]))
        del lines[:length]
    log = joined([p for p in parts if p is not None])
    assert log.time.tolist() == list(range(9)) and log.columns["a"].tolist()[8] == 64.0


def test_parquet_of_other_people(tmp_path: Path) -> None:
    import pyarrow
    import pyarrow.parquet

    path = tmp_path / "a.parquet"
    stamps = pyarrow.array([10_500, 11_000], pyarrow.timestamp("ms"))
    table = pyarrow.table(
        {"timestamp": stamps, "a": [None, 2], "on": [True, False], "word": ["x", "y"]}
    )
    pyarrow.parquet.write_table(table, path)
    log = read_log(path)
    assert log.time.tolist() == [10.5, 11.0] and log.columns["on"].tolist() == [1.0, 0.0]
    np.testing.assert_array_equal(log.columns["a"], [math.nan, 2.0])
    assert log.meta == {"left-out": "word (string)", "time": "the column `timestamp`, as ISO 8601"}
    path.write_bytes(b"no parquet at all")
    with pytest.raises(LogError, match="not a Parquet file"):
        read_log(path)


def test_without_pyarrow_one_line_says_what_to_install(tmp_path: Path) -> None:
    code = (
        "import sys; sys.modules['pyarrow'] = None\n"
        "from bondgraph.runtime.log import LogError\n"
        "from bondgraph.runtime.log_file import read_log\n"
        f"try: read_log({str(tmp_path / 'a.parquet')!r})\n"
        "except LogError as error: print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "bondgraph-arr[robot]" in done.stdout and done.stdout.count("\n") == 1


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_a_log_is_read_without_pandas(tmp_path: Path, suffix: str) -> None:
    """It takes longer to load than most logs to read."""
    path = tmp_path / f"log.{suffix}"
    columns = {"u": np.where(np.arange(5000) % 7, 1.5, np.nan), "n": np.arange(5000.0)}
    write_log(Log(np.arange(5000) / 1000, columns, {}, {}), path)
    script = (
        "import sys; from bondgraph.runtime.log_file import read_log\n"
        f"log = read_log({str(path)!r})\n"
        "print(len(log.time), float(log.columns['n'].sum()))\n"
        "print('pyarrow' in sys.modules, 'pandas' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.stdout.split() == ["5000", "12497500.0", "True", "False"], done.stderr
    assert read_log(path).columns["u"] == pytest.approx(columns["u"], nan_ok=True)


def test_files_that_cannot_be_read_or_written(tmp_path: Path) -> None:
    log = Log(np.zeros(2), {"a": np.ones(2)}, {}, {})
    with pytest.raises(LogError, match="cannot be read"):
        read_log(tmp_path / "none.csv")
    with pytest.raises(LogError, match="cannot be written"):
        write_log(log, tmp_path / "none" / "a.csv")
    with pytest.raises(LogError, match="written as"):
        write_log(log, tmp_path / "a.xls")
    with pytest.raises(ValueError, match="a has 3 samples"):
        write_log(log._replace(columns={"a": np.ones(3)}), tmp_path / "a.csv")
    with pytest.raises(ValueError, match="a key"):
        write_log(log._replace(meta={"unit a": "V"}), tmp_path / "a.csv")
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_fails_half_way_leaves_the_old_one(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("old")
    log = Log(np.zeros(1), {"\ud800": np.ones(1)}, {}, {})  # no UTF-8 for half a pair
    with pytest.raises(UnicodeEncodeError):
        write_log(log, path)
    assert path.read_text() == "old" and [p.name for p in tmp_path.iterdir()] == ["a.csv"]


_CELLS = st.sampled_from(
    "1 -0.0 1e-320 4.9e-324 1e400 +5 1. .5 1e5 nan NaN -nan inf -inf Infinity NA null None 0x1 1_0"
    " 1d5 true x 1e 1e+ 123456789012345678901234567890 0.1000000000000000055511151231257827".split()
) | st.sampled_from(["", " 2", "3 ", " ", "#", "-"]) | st.floats().map(repr)  # fmt: skip


@pytest.mark.parametrize("arrow", [True, False])
@given(rows=st.lists(st.lists(_CELLS, min_size=2, max_size=2), min_size=1, max_size=3))
def test_what_c_reads_is_what_python_reads(arrow: bool, rows: list[list[str]]) -> None:
    """Where C finds numbers, looking at each cell finds the same ones."""
    lines = [";".join(row) + "\n" for row in rows]
    joined_lines = "".join(lines)
    by_arrow, by_numpy = log_numbers._by_arrow, log_numbers._by_numpy
    found = by_arrow(joined_lines, ";", 2) if arrow else by_numpy(lines, ";", 2)
    if found is None:
        return
    reader = CsvReader(Form("x.csv"))
    slow = reader.feed(["# bondgraph log 1\n", "t;a\n", "0;0\n", *lines])
    assert slow is not None
    assert _bits(slow.time[1:]) == _bits(found[:, 0])
    assert _bits(slow.columns["a"][1:]) == _bits(found[:, 1])


@pytest.mark.parametrize("holes", [True, False])
def test_c_reads_numbers_at_all(holes: bool) -> None:
    bits = np.random.default_rng(4).integers(0, 2**64, 5000, dtype=np.uint64)
    values = bits.view(np.float64)[np.isfinite(bits.view(np.float64))]
    lines = [f"{x!r},{'' if holes else repr(x)}\n" for x in values.tolist()]
    found = log_numbers.by_c(lines, ",", 2)
    assert found is not None and _bits(found[:, 0]) == _bits(values)
    assert np.isnan(found[:, 1]).all() == holes
    plain = log_numbers._by_numpy(lines, ",", 2)
    assert plain is not None and _bits(plain[:, 0]) == _bits(values)
    assert np.isnan(plain[:, 1]).all() if holes else _bits(plain[:, 1]) == _bits(values)
    assert log_numbers.by_c([*lines, "1\n"], ",", 2) is None


_PIECES = st.lists(
    st.sampled_from(
        [b"# bondgraph log 1\n", b"# unit a: V\n", b"t,a\n", b"t;a\n", b"0,1\n", b"0;1\n", b"\n",
         b'"', b",", b"\x00", b"\xff", b"\r", b"#", b"a,b\n", b"nan", b"-1e9", b"\xef\xbb\xbf",
         b"2024-05-01T12:00:00Z", b'{"t": 1}\n', b"0,5;", b"T [degC];t\n",
         b"PAR1"]
    ) | st.binary(max_size=3),
    max_size=12,
)  # fmt: skip


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".jsonl"])
@given(pieces=_PIECES)
def test_any_bytes_are_a_log_or_told_not_to_be(suffix: str, pieces: list[bytes]) -> None:
    path = Path(f"{_FOLDER}/any{suffix}")
    path.write_bytes(b"".join(pieces))
    try:
        log = read_log(path)
    except LogError as error:
        assert str(path) in str(error) and "\n" not in str(error)
    else:
        assert all(len(c) == log.rows for c in log.columns.values())
