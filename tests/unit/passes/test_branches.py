"""Laws that have a value on one side of a condition only, against values by hand, in every engine.

The residual of the model is F - e(v), and where F and v stand still so does what step gives.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import log, sin, sqrt, tanh
from pathlib import Path

import numpy as np
import pytest

from bondgraph.backends.forty_digits import Evaluation, value
from bondgraph.compilation import Compilation
from bondgraph.ir.program import Branch, Program, Ref, flat
from bondgraph.runtime.batch import Lanes
from bondgraph.text.source import Source
from tests.sampled import Sampled
from tests.unit.backends.compilers import (
    WARNINGS,
    InC,
    compiler,
    exact_module,
    generate,
    python_module,
    run,
)

_LAW = Callable[[float], float]


def compiled(law: str) -> Compilation:
    text = """bg 1
    model M {
        input F
        param a = 2 +- 10%
        param b = -4
        1:slide { <- Se:F; -> R:drag { LAW }; -> Df:v }
    }"""
    return Compilation(Source("m.bg", text.replace("LAW", law)))


def in_all_engines(
    program: Program, folder: Path, signals: Mapping[str, float], params: Mapping[str, float]
) -> list[float]:
    """The only residual: exact and step of C, Python, the interpreter, arrays and 40 digits."""
    stem = generate(program, folder)
    module, in_c = python_module(folder, stem), InC(program, folder, stem)
    assert in_c.configure(1.0 / program.rate, program.bandwidth, 1.0, **params) == 0
    monitor = module.Monitor(module.Parameters(**params))
    apart = exact_module(folder, stem, module)
    exactly = apart.Exact(module.Parameters(**params))
    numbers, name = Sampled(program, params), program.residuals[0].name
    found = []
    if not program.residuals[0].unwritten:
        found += in_c.exact(**signals)
        found.append(getattr(exactly.residuals(apart.Derivatives(**signals)), name))
        found.append(numbers.exact({n: {0: x} for n, x in signals.items()})[name])
    states = None
    lanes = Lanes(program, dict(params))
    for _ in range(2 + int(program.residuals[0].settle * program.rate / program.bandwidth)):
        in_samples, valid = in_c.step(**signals)
        sample = monitor.step(module.Samples(**signals))
        outcome = numbers.step(signals)
        residuals, states = lanes.sample(
            {n: np.array([x, 2 * x]) for n, x in signals.items()}, {}, {}, {}, states
        )
    assert valid == [True] and sample.valid == {name} and outcome.valid[name]
    found += [*in_samples, getattr(sample, name), outcome.residuals[name]]
    found.append(float(residuals[name][0]))
    sharp = Evaluation(program)
    sharp.configure({n: value(x) for n, x in params.items()})
    sharp.values |= {Ref("known", n): value(x) for n, x in signals.items()}
    sharp.run(program.first)
    return [*found, float(sharp.values[Ref("residual", name)])]


def nested(v: float) -> float:
    if v <= 0:
        return sqrt(1 - v) / (2 + sqrt(1 - v))
    return 1 / v + 1 / (1 / v + 1) if v < 1 else log(v) + log(v) ** 2


#: The law, what it is by hand, and whether it needs a branch.
_LAWS: dict[str, _LAW] = {
    "e = if(f > 0, a*(sqrt(f) + 1/(1 + sqrt(f))), -a)":
        lambda v: 2 * (sqrt(v) + 1 / (1 + sqrt(v))) if v > 0 else -2.0,
    "e = if(f <= 0, -1, 1/f + a/(1 + 1/f))":
        lambda v: -1.0 if v <= 0 else 1 / v + 2 / (1 + 1 / v),
    "e = if(f > 0, if(f < 1, 1/f + 1/(1/f + 1), log(f) + log(f)^2), sqrt(1 - f)/(2 + sqrt(1 - f)))":
        nested,
    "e = if(f > 0 and 1/sqrt(f) + sqrt(f) < 3, a, 1)":
        lambda v: 2.0 if v > 0 and 1 / sqrt(v) + sqrt(v) < 3 else 1.0,
    "e = if(f <= 0 or log(f) + log(f)^2 < 1 or f > 5, a, 1)":
        lambda v: 2.0 if v <= 0 or log(v) + log(v) ** 2 < 1 or v > 5 else 1.0,
    "e = if(f > 0, sqrt(f) + sin(2*f), sin(2*f)*f) + if(f > 0, 1/sqrt(f), 0)":
        lambda v: sqrt(v) + sin(2 * v) + 1 / sqrt(v) if v > 0 else sin(2 * v) * v,
}  # fmt: skip


@pytest.mark.parametrize("law", _LAWS)
def test_a_side_that_is_not_taken_need_have_no_value(law: str, tmp_path: Path) -> None:
    program = compiled(law).program
    assert any(isinstance(s, Branch) for s in program.step) == ("sin" not in law)
    for at, v in enumerate((-3.0, 0.0, 0.25, 2.5, 7.0)):
        found = in_all_engines(program, tmp_path / str(at), {"F": 5.0, "v": v}, {})
        assert found == pytest.approx([5.0 - _LAWS[law](v)] * len(found), rel=1e-12)
        assert found[0] == found[1] and found[3] == found[4]  # C and Python, bit for bit


@pytest.mark.parametrize("b", [-4.0, 9.0])
def test_a_parameter_decides_what_configure_computes(b: float, tmp_path: Path) -> None:
    program = compiled("e = if(b > 0, f*sqrt(b) + sin(f)/(1 + sqrt(b)), b*f)").program
    expected = 5.0 - (7 * sqrt(b) + sin(7) / (1 + sqrt(b)) if b > 0 else 7 * b)
    found = in_all_engines(program, tmp_path, {"F": 5.0, "v": 7.0}, {"b": b})
    assert found == pytest.approx([expected] * len(found), rel=1e-12)


def test_thresholds_follow_the_side_that_is_taken(tmp_path: Path) -> None:
    made = compiled("e = if(f > 0, a*(sqrt(f) + 1/(1 + sqrt(f))), -a)").thresholds
    assert made is not None and any(isinstance(s, Branch) for s in made.step)
    for v, expected in ((-3.0, 0.2), (4.0, 0.2 * (2 + 1 / 3))):
        alone = made._replace(bounds="")  # without the residuals that it is for
        found = in_all_engines(alone, tmp_path / str(v), {"v": v}, {"a": 2.0})
        assert found == pytest.approx([expected] * len(found), rel=1e-12)


def test_newton_looks_on_one_side_at_a_time(tmp_path: Path) -> None:
    """Two resistors share the flow F at the effort v: f is that of one, and r = v - e(F - f)."""

    def law(f: float) -> float:
        return f + sqrt(f) + tanh(sqrt(f)) if f > 0 else 2 * f + tanh(f)

    text = """bg 1
    model M {
        0:n { <- Sf:F; -> R:r1 { LAW }; -> R:r2 { LAW }; -> De:v }
    }"""
    text = text.replace("LAW", "e = if(f > 0, f + sqrt(f) + tanh(sqrt(f)), 2*f + tanh(f))")
    program = Compilation(Source("m.bg", text)).program
    (block,) = program.roots
    assert any(isinstance(s, Branch) for s in block.body)
    for at, f in enumerate((-3.0, 0.5, 4.0)):
        found = in_all_engines(program, tmp_path / str(at), {"F": 2.0, "v": law(f)}, {})
        assert found == pytest.approx([law(f) - law(2.0 - f)] * len(found), rel=1e-9)


@pytest.mark.parametrize("name", ["gcc", "g++", "clang"])
@pytest.mark.parametrize("law", _LAWS)
def test_branches_compile_without_a_warning(law: str, name: str, tmp_path: Path) -> None:
    stem = generate(compiled(law).program, tmp_path)
    for real in ("-O2", f"-D{stem.upper()}_FLOAT"):
        given = (*WARNINGS, real, "-c", "-o", "x.o")
        run(*compiler(name), *given, f"{stem}.c", cwd=tmp_path)


def test_what_both_sides_need_is_computed_once_and_before() -> None:
    program = compiled("e = if(f > 0, exp(f) + exp(f)^2*a, 1/exp(f) + sin(exp(f)))").program
    assert not any(isinstance(s, Branch) for s in program.step)
    assert repr(tuple(flat(program.step))).count("'exp'") == 1


def test_text_ends_where_every_part_is_on_a_side_of_its_own() -> None:
    """y_k = if(v < k, y_(k-1), z_(k-1)) and z_k crosswise: 2^40 ways lead to 1/v."""
    parts = ["let y0 = 1/drag.f; let z0 = sqrt(drag.f)"]
    for k in range(1, 41):
        parts.append(
            f"let y{k} = if(drag.f < {k}, y{k - 1}, z{k - 1}); "
            f"let z{k} = if(drag.f < {k} + 1/2, 1 + z{k - 1}, 2*y{k - 1})"
        )
    text = """bg 1
    model M {
        LETS
        1:slide { <- Se:F; -> R:drag { e = y40 }; -> Df:v }
    }"""
    program = Compilation(Source("m.bg", text.replace("LETS", "\n".join(parts)))).program
    assert len(list(flat(program.step))) < 1000
