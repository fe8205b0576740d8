"""The observer form is not later than a plain simulation from the right start, nor the filter."""

from __future__ import annotations

from statistics import median

import numpy as np
import pytest

import bondgraph
from tests.forms import __main__ as campaign


@pytest.mark.parametrize("fault", ["leak1", "k2"])
def test_an_observer_sees_first(fault: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(campaign, "SEEDS", 5)
    programs = {
        form: bondgraph.compile(campaign.MODEL, rate=campaign.RATE, form=form).program
        for form in ("derivative", "observer")
    }
    healthy = campaign.residuals(programs, lambda name, t: campaign.HEALTHY[name], 101)
    begin = round(2000 * campaign.RATE)
    limits = {form: float(np.std(r[begin:])) for form, r in healthy.items()}

    def value(name: str, t: float) -> float:
        wrong = name == fault and t > campaign.ONSET
        return (campaign.FAULTS if wrong else campaign.HEALTHY)[name]

    delay = {
        form: median(campaign.late(r[:, k], limits[form]) for k in range(5))
        for form, r in campaign.residuals(programs, value, 102).items()
    }
    one_sample = 1 / campaign.RATE
    assert delay["observer"] <= 1.2 * min(delay["derivative"], delay["simulation"]) + one_sample
    assert delay["observer"] < delay["derivative"] / 3
