"""The table of element kinds agrees with what bond graph theory says of each."""

from __future__ import annotations

import pytest

from bondgraph.library.elements import JUNCTIONS, KINDS, SIGNALS, STORAGES


@pytest.mark.parametrize("keyword", KINDS)
def test_keyword_is_kind_with_or_without_the_sign_of_modulation(keyword: str) -> None:
    kind = KINDS[keyword]
    assert keyword in (kind.kind, f"M{kind.kind}")
    assert kind.modulated == keyword.startswith("M")
    assert keyword not in JUNCTIONS


def test_storages_keep_what_they_integrate() -> None:
    # a C integrates its flow to q, an I its effort to p, a port of an IC either
    stored = {k: v.states for k, v in KINDS.items() if v.states}
    assert stored == {"C": ("q",), "I": ("p",), "IC": ("q", "p")}
    assert tuple(stored) == STORAGES


def test_ports_and_variables_of_laws() -> None:
    for kind in KINDS.values():
        assert len(kind.ports) == (2 if kind.kind in ("TF", "GY") else 1)
        for name in kind.variables:
            assert name in SIGNALS
            assert name[1:] in kind.ports
        assert set(kind.states) <= set(kind.variables)


def test_a_transformer_and_a_mixed_field_have_no_default() -> None:
    assert [k for k, v in KINDS.items() if not v.coefficient] == ["IC", "TF", "MTF"]
