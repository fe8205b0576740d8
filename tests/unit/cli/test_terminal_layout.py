"""Long formulas and tables in a terminal."""

from __future__ import annotations

import re

from hypothesis import given
from hypothesis import strategies as st

from bondgraph.cli.terminal_layout import formula, names, signature_table
from bondgraph.ir.signature_matrix import SignatureMatrix


def test_a_short_formula_stays_on_its_line() -> None:
    assert formula("a + b", 40, "0 = ", "    ") == ["0 = a + b"]


def test_the_outermost_sign_is_where_a_formula_breaks() -> None:
    text = "alpha*(beta + gamma + delta) - epsilon*(zeta + eta)"
    assert formula(text, 40) == ["alpha*(beta + gamma + delta)", "- epsilon*(zeta + eta)"]


def test_a_break_in_parentheses_is_indented() -> None:
    text = "K*(first_term + second_term + third_term)"
    first, second = formula(text, 30, "", "    ")
    assert first == "K*(first_term + second_term"
    assert second == "      + third_term)"


texts = st.recursive(
    st.sampled_from(["x", "m[1].el.Re", "D(y, 2)", "3.5"]),
    lambda inner: st.builds(
        lambda parts, sign: "(" + f" {sign} ".join(parts) + ")",
        st.lists(inner, min_size=1, max_size=5),
        st.sampled_from(["+", "-"]),
    ),
    max_leaves=40,
)


@given(texts, st.integers(1, 120))
def test_breaking_loses_nothing_and_ends(text: str, columns: int) -> None:
    lines = formula(text, columns, "0 = ", "    ")
    joined = "".join(lines).removeprefix("0 = ")
    assert re.sub(" ", "", joined) == re.sub(" ", "", text)


def test_names_fill_their_lines() -> None:
    assert names(["aa", "bb", "cc"], 10, "  ") == ["  aa, bb,", "  cc"]
    assert names([], 10, "  ") == ["  "]


def test_equal_signatures_stand_together() -> None:
    matrix = SignatureMatrix(
        ("r1", "r2"),
        ("R", "K", "L", "m"),
        ((True, False), (False, True), (True, False), (False, False)),
        ({}, {}),
    )
    assert signature_table(matrix, 100) == [
        "          r1   r2   Mb  Ib",
        "  R        1    .    1   0",
        "  L        1    .    1   0",
        "",
        "  K        .    1    1   1",
        "",
        "  m        .    .    0   0",
    ]


def test_signatures_too_wide_for_a_table_are_listed() -> None:
    residuals = tuple(f"r{k}" for k in range(1, 7))
    rows = ((True, *[False] * 4, True), (True, *[False] * 4, True), (False,) * 6)
    matrix = SignatureMatrix(residuals, ("R", "K", "m"), rows, ({},) * 6)
    assert len(signature_table(matrix, 20)[0]) > 20  # two lines of output hold it
    assert signature_table(matrix, 15) == ["  R, K", "      seen by r1,", "              r6"]
