"""`bondgraph detect`: what it prints, and what it says to wrong words."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from bondgraph.cli.main import main

_MODEL = str(Path(__file__).resolve().parents[3] / "models" / "dc_motor.bg")


def test_the_table_has_every_fault_with_its_unit(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--at", "speed=1000", "--at", "current=0.03", "--form", "derivative"]
    assert main(["detect", _MODEL, *words]) == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    # (2 (0.0264 + 0.0702) - 0.0264)/0.03 Ohm of 17.6
    assert ["R", "r1", "5.56", "Ohm", "31.6", "%"] in [line[:6] for line in lines]
    assert ["J", "r2", "-", "not", "moved", "by", "these", "signals"] in lines


def test_json_has_the_same_with_all_digits(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["detect", _MODEL, "--json", "--noise", "speed=1", "--kappa", "4"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["status"] == "ok" and found["rate"] == 1000
    sigma = {row["residual"]: row["sigma"] for row in found["noise"]}
    row = next(r for r in found["faults"] if (r["fault"], r["residual"]) == ("U", "r1"))
    assert row["change"] == pytest.approx(4 * sigma["r1"]) and row["unit"] == "V"
    assert row["relative"] is None and row["reason"] is None


def test_zero_signals_are_said_to_be_the_reason(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["detect", _MODEL]) == 0
    assert "give --at" in capsys.readouterr().out


def test_pairs_are_a_table_with_a_column_for_each_group(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """r1 = U - R i - k w and r2 = k i - f w - load: load is told from R by r2, from f never."""
    words = ["--at", "speed=1000", "--at", "current=0.03", "--noise", "load=1e-4"]
    assert main(["detect", _MODEL, "--pairs", *words, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    told = next(row for row in found["pairs"] if row["fault"] == "load")
    assert told["unit"] == "N.m" and told["from"]["f"] is None and "load" not in told["from"]
    # 5 standard deviations: of the noise, k off by 2 % and f by 10 %, both evenly
    sigma = next(row["sigma"] for row in found["noise"] if row["residual"] == "r2")
    k, f = 0.02 * 3.51e-3 * 0.03, 0.1 * 1.19e-5 * 1000
    expected = 5 * (sigma**2 + (f**2 + k**2) / 3) ** 0.5
    assert told["from"]["R"] == pytest.approx(expected, rel=0.01)
    assert main(["detect", _MODEL, "--pairs", *words]) == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["R", "+1", "k", "current", "speed", "f", "+1"] in lines
    assert next(x for x in lines if x[:2] == ["load", "(N.m)"])[2] == f"{told['from']['R']:.3g}"
    assert main(["detect", _MODEL, *words, "--json"]) == 0
    assert "pairs" not in json.loads(capsys.readouterr().out)


def test_both_forms_stand_beside_each_other(capsys: pytest.CaptureFixture[str]) -> None:
    """The observer of r1 follows the current, at R/L far above the filter: earlier, with noise."""
    words = ["detect", _MODEL, "--at", "speed=1000", "--noise", "current=1e-3"]
    assert main(words) == 0
    out = capsys.readouterr().out
    lines = [line.split() for line in out.splitlines()]
    assert [line[2] for line in lines if line[:2] == ["U", "r1"]] == ["derivative", "observer"]
    assert "earlier, 0 of them smaller: --form observer:r1" in out
    assert main([*words, "--json"]) == 0
    both = json.loads(capsys.readouterr().out)
    found = {form: {(r["fault"], r["residual"]): r for r in part["faults"]}
             for form, part in (("derivative", both), ("observer", both["observers"]))}  # fmt: skip
    slow, fast = (found[form]["U", "r1"] for form in found)
    assert slow["form"] == "derivative" and fast["form"] == "observer"
    assert slow["delay_size"] == fast["delay_size"] == 2 * max(slow["change"], fast["change"])
    assert fast["delay"] < slow["delay"]
    # one form alone has the same numbers, and nothing beside it
    for asked, form in (("derivative", "derivative"), ("observer:r1", "observer")):
        assert main([*words, "--json", "--form", asked]) == 0
        alone = json.loads(capsys.readouterr().out)
        row = next(r for r in alone["faults"] if (r["fault"], r["residual"]) == ("U", "r1"))
        assert row["change"] == pytest.approx(found[form]["U", "r1"]["change"])
        assert "observers" not in alone
        assert row["delay_size"] == 2 * row["change"]


def test_residuals_rise_and_fall_in_an_order(capsys: pytest.CaptureFixture[str]) -> None:
    """r1 = U - R i - k w - L i', r2 = load + f w + J w' - k i, with what the machine was before.

    With a larger R there is less current than U - k w is good for: R i is too small by so much, and
    r1 rises. A current that is told too large takes R of that off r1, and k of that off r2. All
    that r2 shows is late: a change that it is sure of is a hundred times what r1 needs.
    """
    words = ["--at", "speed=1000", "--at", "current=0.03", "--noise", "speed=1"]
    words += ["--noise", "current=1e-3", "--form", "derivative"]
    assert main(["detect", _MODEL, *words, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    signs = {o["fault"]: [[(a["residual"], a["sign"]) for a in part] for part in o["answers"]]
             for o in found["order"]}  # fmt: skip
    assert signs == {
        "R": [[("r1", 1)]],
        "k": [[("r1", 1)], [("r2", 1)]],
        "U": [[("r1", -1)]],
        "current": [[("r1", -1)], [("r2", -1)]],
        "speed": [[("r1", -1)], [("r2", 1)]],
        "f": [[("r2", -1)]],
        "load": [[("r2", -1)]],
    }
    assert main(["detect", _MODEL, *words]) == 0
    assert "r1 falls, then r2 rises" in capsys.readouterr().out


@pytest.mark.parametrize("form", ["observer:r9", "observers", "observer:r1,q"])
def test_a_form_that_nothing_has_is_wrong_usage(
    form: str, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        status = main(["detect", _MODEL, "--form", form])
    except SystemExit as left:
        status = int(left.code or 0)
    assert status == 2
    assert ("no residual of the model" in (err := capsys.readouterr().err)) == (":" in form)
    assert "Traceback" not in err


@pytest.mark.parametrize(
    "words", [["--at", "sped=1"], ["--noise", "x=1"], ["--noise", "-1"], ["--swing", "speed"]]
)
def test_wrong_words_are_wrong_usage(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    try:
        status = main(["detect", _MODEL, *words])
    except SystemExit as left:
        status = int(left.code or 0)
    assert status == 2
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [
        ["detect", "--at", "V=1"],
        ["detect", "--noise", "V=1"],
        ["report", "-o", "r.html", "--swing", "V=1"],
        ["compile", "-o", "c", "--real", "fixed", "--range", "V=0..1"],
    ],
)
def test_a_signal_of_another_part_is_not_said_to_be_unknown(
    words: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Nothing is measured of the second circuit: no residual has V, though the model does."""
    monkeypatch.chdir(tmp_path)
    text = "Se:U -> 1:a\na -> R:R = 2\na -> Df:i\nSe:V -> 1:b\nb -> R:r = 3\nb -> I:L = 1"
    (tmp_path / "two.bg").write_text(f"bg 1\nmodel M {{\n{text}\n}}\n", encoding="utf-8")
    assert main([words[0], "two.bg", *words[1:]]) == 1
    assert "error: no residual reads `V`\n" in capsys.readouterr().err


def test_a_parameter_without_a_number_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "m.bg"
    path.write_text("bg 1\nmodel M { param R : Ohm; Se:U -> 1:j -> R:R; j -> Df:i }\n", "utf-8")
    assert main(["detect", str(path)]) != 0
    assert "R has no value" in capsys.readouterr().err
    (tmp_path / "s.toml").write_text("duration = 1\nparameters.R = 2\ninputs.U = 3\n", "utf-8")
    log = tmp_path / "s.csv"
    assert main(["simulate", str(path), str(tmp_path / "s.toml"), "-o", str(log)]) == 0
    for words in (
        ["fit", str(path), str(log), "-o", str(tmp_path / "p.toml")],
        ["tune", str(path), str(log), "-o", str(tmp_path / "t.json")],
        ["monitor", str(path), str(log)],
        ["report", str(path), "--scenario", str(tmp_path / "s.toml"), "-o", str(tmp_path / "r")],
    ):
        assert main(words) == 1
        assert capsys.readouterr().err == "error: the model has no value for R: give one\n"


def test_a_model_without_redundancy_has_nothing_to_detect(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "m.bg"
    path.write_text("bg 1\nmodel M { param R = 1 Ohm; Se:U -> 1:j -> R:R }\n", "utf-8")
    assert main(["detect", str(path)]) == 0
    assert capsys.readouterr().out == (
        "M: no residual: the model has no sensor, so no fault can be detected\n"
    )
    assert main(["detect", str(path), "--at", "U=1", "--pairs", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["faults"] == found["noise"] == found["pairs"] == []


def test_tolerances_that_are_left_out_are_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cells = ["Se:U -> 1:a1 -> R:r1 = 1 +- 5%", "a1 -> 0:n1 -> C:c1 = 0.1 +- 5%"]
    for k in range(2, 7):
        cells.append(f"n{k - 1} -> 1:a{k} -> R:r{k} = 2 +- 5%")
        cells.append(f"a{k} -> 0:n{k} -> C:c{k} = 0.{k} +- 5%")
    path = tmp_path / "ladder.bg"
    text = "\n".join([*cells, "n6 -> De:y"])
    path.write_text(f"bg 1\nmodel Ladder {{\n{text}\n}}\n", encoding="utf-8")
    assert main(["detect", str(path)]) == 0
    assert "only noise counts: its uncertain signals need" in capsys.readouterr().out
    assert main(["detect", str(path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["noise"][0]["no_threshold"]
