"""The table of element kinds agrees with what bond graph theory says of each."""

from __future__ import annotations

import pytest

from bondgraph.library.elements import JUNCTIONS, KINDS, SIGNALS


@pytest.mark.parametrize("keyword", KINDS)
def test_keyword_is_kind_with_or_without_the_sign_of_modulation(keyword: str) -> None:
    kind = KINDS[keyword]
    assert keyword in (kind.kind, f"M{kind.kind}")
    assert kind.modulated == keyword.startswith("M")
    assert keyword not in JUNCTIONS


def test_storages_keep_what_they_integrate_and_give_the_other() -> None:
    # a C integrates its flow to q and gives an effort; an I integrates its effort and gives a flow
    assert (KINDS["C"].state, KINDS["C"].output) == ("q", "e")
    assert (KINDS["I"].state, KINDS["I"].output) == ("p", "f")
    assert [k for k, v in KINDS.items() if v.state is not None] == ["C", "I"]


def test_ports_and_variables_of_laws() -> None:
    for kind in KINDS.values():
        assert len(kind.ports) == (2 if kind.kind in ("TF", "GY") else 1)
        for name in kind.variables:
            assert name in SIGNALS
            assert name[1:] in kind.ports
        if kind.state is not None:
            assert kind.state in kind.variables


def test_a_transformer_has_no_default() -> None:
    assert [k for k, v in KINDS.items() if not v.coefficient] == ["TF", "MTF"]
