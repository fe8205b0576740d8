"""Limits against published figures, simulated noise, and each other."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from scipy.signal import lfilter

from bondgraph.ir.residual_limit import ShownSize
from bondgraph.runtime.diagnosis.tuning import (
    Limit,
    Tuning,
    height,
    kappa,
)


@pytest.mark.parametrize(("wanted", "between"), [(4.0, 168.0), (5.0, 465.0)])
def test_the_height_agrees_with_published_run_lengths(wanted: float, between: float) -> None:
    # two-sided CUSUM, drift of half a sigma: Montgomery, Introduction to Statistical Quality
    # Control, 6th edition, table 9.3; Siegmund's formula is good to a few hundredths of a sigma
    assert height(1.0, 1.0 / between) == pytest.approx(wanted, abs=0.03)


def test_noise_crosses_a_level_as_often_as_wanted() -> None:
    # white noise through three equal lags, as a residual filter does it
    rate, pole = 1000.0, np.exp(-20.0 / 1000.0)
    noise = np.random.default_rng(2).standard_normal(3_000_000)
    for _ in range(3):
        noise = lfilter([1 - pole], [1, -pole], noise)
    noise = noise[2000:] / noise[2000:].std()
    seconds = len(noise) / rate
    zero = ((noise[:-1] < 0) & (noise[1:] >= 0)).sum() / seconds
    level = kappa(zero, 0.1)
    size = np.abs(noise)
    found = ((size[:-1] < level) & (size[1:] >= level)).sum()
    assert found == pytest.approx(0.1 * seconds, rel=0.2)


def test_a_tuning_is_read_back_and_other_texts_are_not() -> None:
    tuning = Tuning("abc", 1000.0, 20.0, 2.0, 300.0, {"r1": Limit(0.1, 3.0, 4.5, 10.0)})
    assert Tuning.from_json(tuning.to_json()) == tuning
    sizes = {"r1": {"R": ShownSize(0.5, math.inf), "L": ShownSize(1.0, 3.0)}}
    more = tuning._replace(bounds={"r1": 0.2}, shows=sizes, window=2.0)
    assert Tuning.from_json(more.to_json()) == more
    for form in ("derivative", "observer", ("r1", "r3")):
        own = tuning._replace(isolate=True, form=form)  # type: ignore[arg-type]
        assert Tuning.from_json(own.to_json()) == own
    older = re.sub(r',\s+"isolate": false,\s+"form": "derivative"', "", tuning.to_json())
    assert "isolate" not in older and Tuning.from_json(older) == tuning
    text = re.sub(r"\s+", " ", more.to_json())
    for wrong in ('"isolate": 1', '"isolate": "true"', '"form": null', '"form": [1]', '"form": ""'):
        key = wrong.split(":")[0]
        broken = re.sub(rf'{key}: (false|"derivative")', wrong, text)
        assert broken != text
        with pytest.raises(ValueError, match=f"`{key[1:-1]}` of a tuning is"):
            Tuning.from_json(broken)
    for wrong in ("[ -1, null ]", "[ [1], null ]", '"r1"', "[ 0.5 ]", "[ 1, 2, 3 ]", "3", "null"):
        assert text.count("[ 0.5, null ]") == 1
        with pytest.raises(ValueError, match="tuning"):
            Tuning.from_json(text.replace("[ 0.5, null ]", wrong))
    other = tuning.to_json().replace('"bondgraph tuning": 1', '"bondgraph tuning": 9')
    for text in ("", "{}", "[1]", "3", tuning.to_json().replace("sigma", "sigmo"), other):
        with pytest.raises(ValueError, match=r"tuning|edition"):
            Tuning.from_json(text)


@pytest.mark.parametrize("wrong", ["0", "-1", "NaN", "Infinity", "1e-320", "1" + "0" * 101, '"2"'])
@pytest.mark.parametrize("key", ["rate", "bandwidth", "sigma", "memory"])
def test_numbers_that_no_tuning_has_are_refused(key: str, wrong: str) -> None:
    """A bandwidth of 0 divided by zero, a rate without end was no whole number of samples."""
    text = Tuning("abc", 1000.0, 20.0, 2.0, 300.0, {"r1": Limit(0.1, 3.0, 4.5, 10.0)}).to_json()
    text, number = re.subn(rf'("{key}": )[\d.]+', rf"\g<1>{wrong}", text)
    assert number == 1
    with pytest.raises(ValueError, match=f"`{key}` of a tuning is a number from"):
        Tuning.from_json(text)
