"""Whatever samples come, the C does nothing undefined, and what it calls valid is a number."""

from __future__ import annotations

from pathlib import Path

import pytest

import bondgraph
from bondgraph.backends.identifiers import snake
from bondgraph.backends.members import Member, samples
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import load
from bondgraph.compilation import Compilation
from bondgraph.text.diagnostic import CompileError
from tests.conftest import ROOT
from tests.unit.backends.compilers import compiler, run

_MODELS = [p.stem for p in sorted((ROOT / "models").glob("*.bg"))]
_SANITIZED = ("-fsanitize=address,undefined,float-cast-overflow", "-fno-sanitize-recover=all")

#: Quiet samples until filters have settled, then some wild ones, again and again.
_DRIVER = """
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include "{stem}.h"

#define ROUNDS 40
#define QUIET 700
#define WILD 60

static uint32_t state = 1u;

static uint32_t any(void)
{{
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}}

static {stem}_real even(void)
{{
    return ({stem}_real)any() / ({stem}_real)2147483648.0 - ({stem}_real)1.0;
}}

static {stem}_real wild(void)
{{
    static const {stem}_real odd[] = {{
        ({stem}_real)NAN, ({stem}_real)INFINITY, -({stem}_real)INFINITY, MOST, -MOST, LEAST, -LEAST,
        ({stem}_real)0.0, -({stem}_real)0.0, ({stem}_real)1e30, -({stem}_real)1e-30
    }};
    const uint32_t which = any() % 22u;

    return which < 11u ? odd[which] : even() * ({stem}_real)(1u << which);
}}

static int32_t any_count(void)
{{
    static const int32_t odd[] = {{INT32_MAX, INT32_MIN, 0, -1, 1}};
    const uint32_t which = any() % 10u;

    return which < 5u ? odd[which] : (int32_t)(any() & 0x7fffffffu) - 0x40000000;
}}

static int wrong(const {stem}_residuals *r)
{{
    int k, found = 0;

    for (k = 0; k < {PREFIX}_RESIDUALS; ++k) {{
        found += !isfinite((double)r->value[k]);
    }}
    return found;
}}

int main(void)
{{
    static {stem}_memory memory;
    static {stem}_diagnosis diagnosis;
    {stem}_limit limits[{PREFIX}_RESIDUALS];
    {stem}_samples s;
    {stem}_residuals r;
    int k, bad = 0, alarms = 0, valid = 0;
{bounds}
    {stem}_reset(&memory);
    {stem}_diagnosis_reset(&diagnosis);
    for (k = 0; k < {PREFIX}_RESIDUALS; ++k) {{
        limits[k] = {stem}_limit_of(({stem}_real)0.5);
    }}
    for (k = 0; k < ROUNDS * (QUIET + WILD); ++k) {{
        const int is_wild = k % (QUIET + WILD) >= QUIET;

{given}
        {stem}_step(&{stem}_nominal_coefficients, &memory, &s, &r);
        valid += r.valid[0];
        bad += wrong(&r);
{judged}
    }}
    printf("%d wrong, %d alarms, %d valid\\n", bad, alarms, valid);
    return bad;
}}
"""

_BOUNDS = """    static {stem}_threshold_memory uncertain;
    {stem}_residuals b;

    {stem}_threshold_reset(&uncertain);
"""
_WITH = """        {stem}_threshold_step(
            &{stem}_threshold_nominal_coefficients, &uncertain, &s, &b);
        bad += wrong(&b);
        alarms += {stem}_diagnose(&diagnosis, limits, b.value, &r);"""
_WITHOUT = """        alarms += {stem}_diagnose(&diagnosis, limits, NULL, &r);"""


def _given(member: Member) -> str:
    """How a driver makes a sample."""
    if member.type == "bool":
        return f"        s.{member.name} = is_wild || k == 0 ? any() % 2u == 0u : s.{member.name};"
    quiet, wild = ("k", "any_count()") if member.type == "count" else ("even()", "wild()")
    return f"        s.{member.name} = is_wild && any() % 4u == 0u ? {wild} : {quiet};"


def _driver(c: Compilation, stem: str) -> str:
    names = {"stem": stem, "PREFIX": stem.upper()}
    given = "\n".join(map(_given, samples(c.program, Spelling(c.program, load("c")))))
    uncertain = c.thresholds is not None
    return _DRIVER.format(
        **names,
        given=given,
        bounds=_BOUNDS.format(**names) if uncertain else "",
        judged=(_WITH if uncertain else _WITHOUT).format(**names),
    )


@pytest.mark.parametrize("model", _MODELS)
def test_any_samples_are_harmless(model: str, tmp_path: Path) -> None:
    c = bondgraph.compile(ROOT / "models" / f"{model}.bg")
    try:
        stem = snake(c.program.name)
    except CompileError:
        return  # a model that shows a refusal
    c.write(tmp_path, targets=["c"])
    (tmp_path / "driver.c").write_text(_driver(c, stem), encoding="utf-8")
    for own in (
        ("-DMOST=DBL_MAX", "-DLEAST=DBL_MIN"),
        (f"-D{stem.upper()}_FLOAT", "-DMOST=FLT_MAX", "-DLEAST=FLT_MIN"),
    ):
        gcc = (*compiler("gcc"), "-O1", *_SANITIZED, *own)
        run(*gcc, "driver.c", f"{stem}.c", "-o", "driver", "-lm", cwd=tmp_path)
        told = run("./driver", cwd=tmp_path)
        assert told.startswith("0 wrong")
        assert int(told.split()[4]) > 1000, "hardly anything was valid"
