"""The emitted C, compiled as C++ over a prime field, is the residual of the compiler, exactly."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

import bondgraph
from bondgraph.backends.members import derivatives
from bondgraph.backends.identifiers import snake
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import load
from bondgraph.exact.signal_algebra import Taylor
from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.outline import highest_order
from bondgraph.field.prime import PrimeField
from bondgraph.exact.free import FreeSample
from bondgraph.ir.expr import Expr, Kind, Op, symbols, topological
from bondgraph.ir.program import Ref

_MODELS = (
    "cable", "cable_open", "chassis", "dc_motor", "drive", "drive_fig6", "khepera",
    "khepera_plausible", "quarter_car", "rc_loop", "rigid_gear",
)  # fmt: skip

_DRIVER = """
#include "field.hpp"
#define {PREFIX}_REAL Field
#define {PREFIX}_CONSTANT(x) Field::decimal(#x)
field_function field_lookup;
#include "{stem}_exact.c"
extern "C" int run(field_function lookup, const uint64_t *params, const uint64_t *inputs,
                   uint64_t *outputs)
{{
    {stem}_parameters p;
    {stem}_exact_coefficients m;
    {stem}_derivatives d;
    Field r[{PREFIX}_RESIDUALS];
    field_lookup = lookup;
{body}
    int status = 1;
    /* what is positive, and what lies between two bounds, is a matter of luck here */
    for (int k = 1; status && k < 10000; ++k) {{
        status = {stem}_exact_configure(&m, &p, Field(k));
    }}
    {stem}_exact(&m, &d, r);
    for (int k = 0; k < {PREFIX}_RESIDUALS; ++k) outputs[k] = r[k].v;
    return status;
}}
"""


def _without_definitions(c: Any) -> list[Expr]:
    """The residuals in parameters and signals only, without constants defined by others."""
    graph = c.graph
    defined = {
        v.symbol: v.value
        for v in graph.values
        if v.value is not None and not v.fault and symbols(v.value)
    }
    exprs: list[Expr] = [r.residual.expr for r in c.residuals]
    while True:
        replaced: list[Expr] = graph.pool.substitute(exprs, defined)
        if replaced == exprs:
            return exprs
        exprs = replaced


def _inputs(c: Any, exprs: list[Expr], sample: FreeSample) -> dict[Ref, int]:
    """The value of everything that exact takes, from the power series of the signals."""
    pool = c.graph.pool
    known = {k.name: k for k in c.program.knowns}
    symbol_of = {k.path: k.name for k in c.program.knowns}
    found: dict[Ref, int] = {}
    for name, k in known.items():
        kind = {"input": Kind.INPUT, "sensor": Kind.SENSOR, "mode": Kind.MODE}[k.kind]
        series = sample.value(pool.symbol(k.path, kind))
        factorial = 1
        for order, x in enumerate(series):
            factorial *= max(order, 1)
            found[Ref("known", name, order)] = int(x * factorial)
    for node in topological(exprs):
        if node.op is Op.INT:
            assert node.args[0].op is Op.SYM, "choose a model that integrates plain signals"
            name = symbol_of[node.args[0].symbol.name]
            found[Ref("known", name, -1)] = int(sample.start(node.symbol))
    return found


@pytest.mark.parametrize("model", _MODELS)
def test_exact_over_a_prime_field(model: str, tmp_path: Path, root: Path) -> None:
    if shutil.which("g++") is None:
        pytest.skip("g++ is not installed")
    c = bondgraph.compile(root / "models" / f"{model}.bg")
    program, exprs = c.program, _without_definitions(c)
    c.write(tmp_path, extras=["exact"])
    stem, spelling = snake(program.name), Spelling(program, load("c"))
    params = [spelling.params[f.name] for f in program.params]
    body = [f"    p.{name}.v = params[{k}];" for k, name in enumerate(params)]
    refs: list[Ref] = []
    for member in derivatives(program, spelling):
        for at, ref in enumerate(member.refs):
            where = f"{member.name}[{at}]" if member.size else member.name
            target = where if member.type == "bool" else f"{where}.v"
            body.append(f"    d.{target} = inputs[{len(refs)}];")
            refs.append(ref)
    source = _DRIVER.format(stem=stem, PREFIX=stem.upper(), body="\n".join(body))
    (tmp_path / "driver.cpp").write_text(source)
    include = ("-I", str(Path(__file__).parent), "-I", str(tmp_path), "-I", str(tmp_path / "exact"))
    options = ("-std=c++17", "-O1", "-shared", "-fPIC", *include)
    command = ["g++", *options, "driver.cpp", "-o", "run.so"]
    subprocess.run(command, cwd=tmp_path, check=True)
    library = ctypes.CDLL(str(tmp_path / "run.so"))
    callback = ctypes.CFUNCTYPE(ctypes.c_uint64, ctypes.c_char_p, ctypes.c_uint64, ctypes.c_uint64)
    for seed in (1, 2):
        functions = PrimeField(seed)
        sample = FreeSample(Taylor(functions), highest_order(exprs), seed)
        wanted = [int(v[0]) for v in evaluate(exprs, sample)]
        given = _inputs(c, exprs, sample)
        values = [
            int(sample.value(next(s for s in symbols(*exprs) if s.symbol.name == f.path))[0])
            for f in program.params
        ]
        lookup = callback(lambda name, x, _, f=functions: int(f.value(name.decode(), x)))  # type: ignore[misc]
        outputs = (ctypes.c_uint64 * len(program.residuals))()
        prime = (1 << 61) - 2373
        numbers = [given[ref] % prime for ref in refs]
        status = library.run(
            lookup,
            (ctypes.c_uint64 * max(1, len(values)))(*values),
            (ctypes.c_uint64 * len(numbers))(*numbers),
            outputs,
        )
        assert status == 0
        assert list(outputs) == wanted
