"""A signature matrix as a table, line by line."""

from __future__ import annotations

from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.notation.latex_table import latex_table


def test_faults_stand_in_groups_with_what_can_be_told_of_them() -> None:
    """Two with one signature are detectable and not isolable; one that nobody sees is neither."""
    matrix = SignatureMatrix(
        ("r1", "r2"),
        ("R", "C", "u", "v"),
        ((True, False), (True, True), (True, False), (False, False)),
        ({}, {}),
    )
    lines = latex_table(matrix).splitlines()
    assert lines[0] == "\\begin{tabular}{lcccc}" and lines[-1] == "\\end{tabular}"
    line, dot = "\\hline", "$\\cdot$"
    assert lines[1:-1] == [
        line,
        " & $r_{1}$ & $r_{2}$ & $M_b$ & $I_b$ \\\\",
        line,
        f"$R$ & 1 & {dot} & 1 & {dot} \\\\",
        f"$u$ & 1 & {dot} & 1 & {dot} \\\\",
        line,
        "$C$ & 1 & 1 & 1 & 1 \\\\",
        line,
        f"$v$ & {dot} & {dot} & {dot} & {dot} \\\\",
        line,
    ]


def test_where_all_is_seen_no_group_is_empty() -> None:
    lines = latex_table(SignatureMatrix(("r1",), ("R",), ((True,),), ({},))).splitlines()
    assert lines.count("\\hline") == 3
