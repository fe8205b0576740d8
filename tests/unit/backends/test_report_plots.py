"""Figures of episodes: thinned without losing a spike, in colours of the page, one id once."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bondgraph.backends.drawing.style import colours
from bondgraph.backends.report.episode import Episode, coarse, envelope, stretches
from bondgraph.backends.report.plots import plane, signals, strips
from tests.unit.backends.episodes import episode

FLOATS = st.floats(-5, 5) | st.just(float("nan"))


@given(st.lists(FLOATS, min_size=1, max_size=300), st.integers(1, 20))
def test_an_envelope_keeps_extremes_and_gaps(values: list[float], bins: int) -> None:
    value = np.array(values)
    time = np.arange(len(values)) / 10
    t, v = envelope(time, value, bins)
    assert len(t) <= max(3 * bins, 2 * bins) or len(t) == len(values)
    assert (np.diff(t) > 0).all()
    assert set(zip(t.tolist(), map(repr, v.tolist()), strict=True)) <= set(
        zip(time.tolist(), map(repr, value.tolist()), strict=True)
    )
    assert np.isnan(v).any() == np.isnan(value).any()
    if not np.isnan(value).all():
        assert (np.nanmin(v), np.nanmax(v)) == (np.nanmin(value), np.nanmax(value))


@given(st.lists(st.booleans(), min_size=2, max_size=60), st.integers(1, 10))
def test_stretches_hold_every_moment_at_which_something_holds(
    inside: list[bool], bins: int
) -> None:
    flags, time = np.array(inside), np.arange(float(len(inside)))
    exact = stretches(flags, time)
    for t, flag in zip(time[:-1], flags[:-1], strict=True):
        assert any(a <= t < b for a, b in exact) == flag
    rough = stretches(*coarse(flags, time, bins))
    for t, flag in zip(time[:-1], flags[:-1], strict=True):
        assert not flag or any(a <= t <= b for a, b in rough)


def figures(found: Episode) -> list[str]:
    return [*strips(found, "a"), signals(found, "b"), *[plane(p, "c") for p in found.planes]]


def test_a_figure_is_plain_svg_in_the_colours_of_the_page() -> None:
    found = episode("Run", residuals=10)
    drawn = figures(found)
    assert len(drawn) == 4  # ten residuals are more than fit one page
    ids: list[str] = []
    for svg in drawn:
        tree = ElementTree.fromstring(svg)
        ids += [e.attrib["id"] for e in tree.iter() if "id" in e.attrib]
        assert not re.search(r"#[0-9a-f]{6}\b|<style|http|font-family", svg)
        used = set(re.findall(r"var\(--([\w-]+)\)", svg))
        assert used <= set(re.findall(r"--([\w-]+):", colours(True)))
        assert svg.startswith("<svg") and "<title" in svg and "<desc>" in svg
        for reference in re.findall(r'(?:url\(|href=")#([^)"]+)', svg):
            assert f'id="{reference}"' in svg
    assert len(ids) == len(set(ids))
    words = " ".join("".join(e.itertext()) for e in ElementTree.fromstring(drawn[0]).iter()
                     if e.tag.endswith("text"))  # fmt: skip
    for text in ("r1 in V", "time in s", "m[1].el.Re or m[1].el.k", "m[1].el.Re +30 %"):
        assert text in words
    assert "No samples &amp; nothing &lt; said." in drawn[0]


def test_a_long_run_makes_no_long_figure_and_the_same_one_twice() -> None:
    short, long = episode("Run", 4000), episode("Run", 200_000)
    one, other = sum(map(len, figures(short))), sum(map(len, figures(long)))
    assert other < 2 * one < 400_000
    assert figures(short) == figures(short)


@pytest.mark.parametrize("samples", [0, 1, 2])
def test_a_run_of_hardly_a_sample_is_drawn(samples: int) -> None:
    found = episode("Run", 100)
    cut = found._replace(
        time=found.time[:samples],
        residuals=tuple(
            r._replace(value=r.value[:samples], valid=None,
                       bound=None if r.bound is None else r.bound[:samples])
            for r in found.residuals
        ),
        panels=(), marks=(), said=(),
        planes=tuple(p._replace(curves=tuple(c._replace(x=c.x[:samples], y=c.y[:samples])
                                             for c in p.curves)) for p in found.planes),
    )  # fmt: skip
    for svg in [*strips(cut, "a"), *[plane(p, "c") for p in cut.planes]]:
        ElementTree.fromstring(svg)
