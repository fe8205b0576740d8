"""Signatures of each mode, against models in which the switch is hard-wired, and by hand."""

from __future__ import annotations

import json
import re

import pytest

from bondgraph.cli.main import main
from bondgraph.compilation import Compilation
from bondgraph.ir.signature_matrix import ModeSignature, SignatureMatrix
from tests.unit.passes.relations import compiled

SWITCHED = {
    "junction in a circuit": """model M { param R=1; param L=2; param C=3; param R2=4; param Rl=5
        input on : bool
        Se:U -> 1:a; a { -> I:L; -> R:R; -> Df:i; -> b }
        0:b { -> sw }
        1:sw when on { -> R:R2; -> c }
        0:c { -> C:C; -> R:Rl; -> De:v } }""",
    "ideal switch as a resistor": """model M { param R=1; param L=2; param R2=4
        input on : bool
        Se:U -> 1:a; a { -> I:L; -> R:R; -> R:s { 0 = if(on, e, f) }; -> Df:i } }""",
    "step-down converter": """model M { param L=2; param C=3; param Rl=4; param Rd=1
        input on : bool
        Se:U -> 1:sw when on { -> b }
        0:b { -> R:d = Rd; -> 1:l }
        l { -> I:L; -> Df:i; -> o }
        0:o { -> C:C; -> R:Rl; -> De:v } }""",
    "clutch": """model M { param Ja=1; param fa=2; param c=3; param Jb=4; param fb=5
        input on : bool
        Se:T -> 1:a; a { -> I:Ja; -> R:fa; -> Df:wa; -> slip }
        0:slip { -> m; -> b }
        1:m { -> R:plate { 0 = if(on, e - c*f, e) } }
        1:b { -> I:Jb; -> R:fb; -> Df:wb } }""",
    "valve of a tank": """model M { param A=1; param k=2; param k2=3
        input on : bool
        Sf:Q -> 0:t; t { -> C:A; -> De:h; -> v; -> R:leak = k2 }
        1:v when on { -> R:k; -> Df:q } }""",
    "shorted load": """model M { param R=1; param L=2; param Rl=4; param C=3
        input on : bool
        Se:U -> 1:a; a { -> I:L; -> R:R; -> Df:i; -> o }
        0:o { -> R:Rl; -> De:v; -> s }
        1:s { -> R:short { 0 = if(on, e - 1/10*f, f) } } }""",
}


def hard_wired(text: str, on: bool) -> str:
    """The model with the switch built in: no boolean input, no `when`, no `if`."""
    text = text.replace("input on : bool", "")
    text = re.sub(r"if\(on, (.*?), (.*?)\)", r"\1" if on else r"\2", text)
    if on:
        return text.replace(" when on", "")
    # an open switch lets no flow through: as if a source of no flow stood in its place
    return re.sub(r"(1:\w+) when on \{", r"\1 { -> Sf:open = 0;", text)


def verdict(matrix: SignatureMatrix) -> tuple[set[str], set[frozenset[str]]]:
    """What the signatures tell, whatever the residuals are."""
    return set(matrix.undetectable), {frozenset(g) for g in matrix.groups}


@pytest.mark.parametrize("name", SWITCHED)
@pytest.mark.parametrize("on", [False, True])
def test_as_if_the_switch_were_built_in(name: str, on: bool) -> None:
    c = compiled(SWITCHED[name])
    mode = next(m for m in c.mode_signatures.modes if m.modes == {"on": on})
    assert mode.matrix is not None
    assert c.verification.residuals == len(c.residuals)
    wired = compiled(hard_wired(SWITCHED[name], on)).signatures
    own = without_switches(mode)
    alien = set(own.faults) - set(wired.faults)  # stood in the other branch only
    assert alien <= set(own.undetectable)
    undetectable, groups = verdict(own)
    assert (undetectable - alien, groups) == verdict(wired)


def without_switches(mode: ModeSignature) -> SignatureMatrix:
    """The rows of the faults that the model has in all its modes."""
    assert mode.matrix is not None
    rows = zip(mode.matrix.faults, mode.matrix.rows, strict=True)
    kept = {fault: row for fault, row in rows if fault not in mode.modes}
    return mode.matrix._replace(faults=tuple(kept), rows=tuple(kept.values()))


def seen(c: Compilation, **modes: bool) -> set[frozenset[str]]:
    """What each residual sees in a mode, as a set of supports."""
    (found,) = (without_switches(m) for m in c.mode_signatures.modes if m.modes == modes)
    return {frozenset(found.signature(r)) for r in found.residuals}


def test_by_hand() -> None:
    """The converter: b.e = U when on, -Rd i when off; L i' = b.e - v; C v' = i - v/Rl."""
    c = compiled(SWITCHED["step-down converter"])
    tank = frozenset({"C", "Rl", "i", "v"})
    assert seen(c, on=True) == {frozenset({"U", "L", "i", "v"}), tank}
    assert seen(c, on=False) == {frozenset({"Rd", "L", "i", "v"}), tank}
    union = {frozenset(c.signatures.signature(r)) for r in c.signatures.residuals}
    assert union == {frozenset({"U", "Rd", "L", "i", "v"}), tank}


def test_every_mode_is_met() -> None:
    """p5 acts in one mode of 32; the union over the modes must hold it."""
    c = compiled(
        """model M { param R=1; param C=2; param p5=1
        input a : bool; input b : bool; input c : bool; input d : bool; input g : bool
        Se:U -> 1:x; x { -> R:R; -> y }
        0:y { -> C:C; -> De:v; <- MSf:s = if(a and b and c and d and g, p5, 0) } }"""
    )
    assert len(c.mode_signatures.modes) == c.mode_signatures.total == 32
    modes = c.mode_signatures.modes
    sees = [m.modes for m in modes if m.matrix and "p5" not in m.matrix.undetectable]
    assert sees == [dict.fromkeys("abcdg", True)]
    assert "p5" not in c.signatures.undetectable
    assert c.verification.method.startswith("exact")


def test_more_modes_than_are_listed() -> None:
    inputs = "".join(f"input m{k} : bool\n" for k in range(8))
    gain = "".join(f" + if(m{k}, 1, 2)" for k in range(8))
    c = compiled(
        f"""model M {{ param R=1
        {inputs}
        Se:U -> 1:x; x {{ -> R:R; -> Df:i; -> Se:load = 0{gain} }} }}"""
    )
    assert (len(c.mode_signatures.modes), c.mode_signatures.total) == (64, 256)
    assert len({tuple(m.modes.values()) for m in c.mode_signatures.modes}) == 64


def test_no_mode_without_boolean_inputs() -> None:
    c = compiled("model M { param R=1; input on : bool\n Se:U -> 1:x; x { -> R:R; -> Df:i } }")
    assert c.mode_signatures.modes == ()


def test_a_mode_without_behaviour(tmp_path: object, capsys: pytest.CaptureFixture[str]) -> None:
    """On, two sources of effort stand against each other: no current satisfies that."""
    path = f"{tmp_path}/m.bg"
    with open(path, "w") as file:
        file.write(
            """bg 1
            model M { param R=1
            input on : bool
            Se:U -> 0:b; b { -> R:short { 0 = if(on, e - 5, f) }; -> a }
            1:a { -> R:R; -> Df:i } }"""
        )
    assert main(["compile", path, "--json", "-o", f"{tmp_path}/out"]) == 0
    result = json.loads(capsys.readouterr().out)
    off, on = result["modes"]
    assert off["inputs"] == {"on": False} and off["signatures"]["r1"]
    assert on["inputs"] == {"on": True}
    assert "more than the variables" in on["reason"] and "signatures" not in on
    assert main(["compile", path, "-o", f"{tmp_path}/out"]) == 0
    out = capsys.readouterr().out
    assert "on off: the same signatures" in out and "on on: no behaviour" in out
