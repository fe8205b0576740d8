"""The observer form is not later than a plain simulation from the right start, nor the filter."""

from __future__ import annotations

from collections.abc import Iterator
from statistics import median

import numpy as np
import pytest

import bondgraph
from bondgraph.ir.program import Program
from tests.forms import __main__ as campaign

Programs = dict[str, Program]


@pytest.fixture(scope="module")
def forms() -> Programs:
    """The residuals of the model in two forms."""
    return {form: bondgraph.compile(campaign.MODEL, rate=campaign.RATE, form=form).program
            for form in ("derivative", "observer")}  # fmt: skip


@pytest.fixture(scope="module")
def limits(forms: Programs) -> dict[str, float]:
    """The noise of a healthy machine, by form."""
    healthy = campaign.residuals(forms, lambda name, t: campaign.HEALTHY[name], 101)
    begin = round(2000 * campaign.RATE)
    return {form: float(np.std(r[begin:])) for form, r in healthy.items()}


@pytest.fixture(scope="module", autouse=True)
def _few() -> Iterator[None]:
    """Fewer runs than the campaign."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(campaign, "SEEDS", 5)
        yield


@pytest.mark.parametrize("fault", ["leak1", "k2"])
def test_an_observer_sees_first(fault: str, forms: Programs, limits: dict[str, float]) -> None:
    def value(name: str, t: float) -> float:
        wrong = name == fault and t > campaign.ONSET
        return (campaign.FAULTS if wrong else campaign.HEALTHY)[name]

    delay = {
        form: median(campaign.late(r[:, k], limits[form]) for k in range(5))
        for form, r in campaign.residuals(forms, value, 102).items()
    }
    one_sample = 1 / campaign.RATE
    assert delay["observer"] <= 1.2 * min(delay["derivative"], delay["simulation"]) + one_sample
    assert delay["observer"] < delay["derivative"] / 3
