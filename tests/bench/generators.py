"""The robot's step as CasADi and SymForce write it in C, given the very chain (chain.py)."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tests.bench import chain, instructions
from tests.bench.peers import Peer, interpreter

_CASADI = """
import sys
import casadi
from tests.bench import chain
def symbols(names):
    vector = casadi.SX.sym(names[0], len(names))
    return vector, {name: vector[k] for k, name in enumerate(names)}
(cs, c), (xs, x), (ss, s) = map(symbols, (chain.NAMES, chain.STATES, chain.SAMPLES))
bounded = lambda value, limit: casadi.fmax(casadi.fmin(value, limit), -limit)
r, after = chain.step(c, x, s, bounded)
outputs = [casadi.vertcat(*(after[name] for name in chain.STATES)), casadi.vertcat(*r)]
function = casadi.Function("chain", [cs, xs, ss], outputs)
function.generate("chain.c")
open("peer.cpp", "w").write('''
extern "C" int chain(const double **, double **, long long *, double *, int);
extern "C" void peer_step(
    const double *c, const double *x, double *next, const double *s, double *r)
{
    const double *given[] = {c, x, s};
    double *found[] = {next, r};
    chain(given, found, 0, 0, 0);
}
''')
"""

_SYMFORCE = """
import symforce
symforce.set_epsilon_to_number()
import symforce.symbolic as sf
from symforce.codegen import Codegen, CppConfig
from symforce.values import Values
from tests.bench import chain
def symbols(kind, names):
    return {name: sf.Symbol(f"{kind}_{name}") for name in names}
c, x, s = symbols("c", chain.NAMES), symbols("x", chain.STATES), symbols("s", chain.SAMPLES)
bounded = lambda value, limit: sf.Max(sf.Min(value, limit), -limit)
r, after = chain.step(c, x, s, bounded)
inputs = Values(**{str(v): v for part in (c, x, s) for v in part.values()})
outputs = Values(**{f"next_{name}": after[name] for name in chain.STATES},
                 **{f"r_{k}": value for k, value in enumerate(r)})
Codegen(inputs=inputs, outputs=outputs, config=CppConfig(), name="chain").generate_function(
    output_dir=".", skip_directory_nesting=True)
headers = "#include <algorithm>\\n#include <cmath>"
text = open("chain.h").read().replace("#pragma once", "").replace("#include <Eigen/Core>", headers)
given = [f"{part}[{k}]" for part, names in zip("cxs", (chain.NAMES, chain.STATES, chain.SAMPLES))
         for k in range(len(names))]
found = [f"next + {k}" for k in range(len(chain.STATES))] + [f"r + {k}" for k in range(5)]
open("peer.cpp", "w").write(text + f'''
extern "C" void peer_step(
    const double *c, const double *x, double *next, const double *s, double *r)
{{
    sym::Chain<double>({", ".join(given + found)});
}}
''')
"""


class Generator(NamedTuple):
    """Another generator, and the function whose instructions are those of its step."""

    peer: Peer
    function: str


GENERATORS = (
    Generator(Peer("CasADi", "casadi", _CASADI), "chain"),
    Generator(Peer("SymForce", "symforce", _SYMFORCE), "peer_step"),
)


def build(python: str, one: Generator, folder: Path, *options: str) -> Path:
    """The program that runs the step of another generator on the samples of hand/main.c."""
    environment = {"PYTHONPATH": str(instructions.ROOT), "PATH": f"{Path(python).parent}:/usr/bin"}
    command = [python, "-W", "ignore", "-c", one.peer.program]
    subprocess.run(command, check=True, capture_output=True, cwd=folder, env=environment)
    (folder / "numbers.h").write_text(_numbers(), encoding="utf-8")
    program = folder / "peer"
    sources = [instructions.HAND / "peer.c", *folder.glob("chain.c")]
    for source in sources:
        subprocess.run(
            ["gcc", "-std=c99", "-O2", *options, f"-I{folder}", "-c", str(source), "-o",
             str(folder / f"{source.stem}.o")], check=True, cwd=folder,
        )  # fmt: skip
    objects = [str(folder / f"{source.stem}.o") for source in sources]
    compile_adapter = ["g++", "-O2", *options, str(folder / "peer.cpp"), *objects]
    subprocess.run([*compile_adapter, "-o", str(program), "-lm"], check=True)
    return program


def _numbers() -> str:
    """The coefficients, as an array in C."""
    values = chain.named(chain.coefficients(0.001, 20.0)).values()
    return f"static const double coefficients[] = {{{', '.join(map(repr, values))}}};\n"


def counted(one: Generator, python: str, *options: str) -> float:
    """Instructions of its step, without what tells first samples and validity."""
    with tempfile.TemporaryDirectory() as folder:
        program = build(python, one, Path(folder), *options)
        done = subprocess.run([program, "100"], check=True, capture_output=True, text=True)
        found = np.array(done.stdout.split(), dtype=float)
        np.testing.assert_allclose(found, chain.last(100), rtol=1e-9, err_msg=one.peer.name)
        return instructions.each(one.function, program)


def report() -> None:
    """One line for each generator."""
    for one in GENERATORS:
        python = interpreter(one.peer)
        if python is None:
            print(f"{one.peer.name}: not compared, it is not installed (make bench tries)")
        elif all(map(shutil.which, ("gcc", "g++", "valgrind"))):
            plain, fused = (counted(one, python, *o) for o in ((), instructions.FUSED))
            print(
                f"The same chain by {one.peer.name}, without first samples and validity:"
                f" -O2 {plain:.0f} instructions, {' '.join(instructions.FUSED)} {fused:.0f}"
            )
