"""Compilers for the generated code, and a monitor in C driven from Python."""

from __future__ import annotations

import ctypes
import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from bondgraph.backends.emit import emit
from bondgraph.backends.identifiers import snake
from bondgraph.backends.members import derivatives, samples
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import load
from bondgraph.backends.write import write
from bondgraph.ir.program import Program

WARNINGS = (
    "-Wall -Wextra -Wpedantic -Wconversion -Wdouble-promotion -Wshadow -Wfloat-equal -Werror"
).split()

COMPILERS = {
    "gcc": ("gcc", "-std=c99"),
    "clang": ("clang", "-std=c99"),
    "g++": ("g++", "-x", "c++"),
    "clang++": ("clang++", "-x", "c++"),
}


def compiler(name: str) -> tuple[str, ...]:
    """The command line of a compiler; skips the test where it is missing."""
    command = COMPILERS[name]
    if shutil.which(command[0]) is None:
        pytest.skip(f"{command[0]} is not installed")
    return command


def generate(program: Program, folder: Path) -> str:
    """All files of a program in `folder`; the stem of their names."""
    write(emit(program, ("c", "python")), folder)
    return snake(program.name)


def run(*command: str | Path, cwd: Path | None = None) -> str:
    """The output of a command that must end with 0."""
    done = subprocess.run(
        [str(c) for c in command], cwd=cwd, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def python_module(folder: Path, stem: str) -> ModuleType:
    """The generated Python module."""
    path = folder / f"{stem}_residuals.py"
    name = f"{stem}_residuals_{abs(hash(str(folder)))}"
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


class InC:
    """The generated C code as a shared library, with the interface of the Python module."""

    def __init__(self, program: Program, folder: Path, stem: str) -> None:
        self.program, self.stem = program, stem
        library = folder / "residuals.so"
        source = folder / f"{stem}_residuals.c"
        options = ("-O2", "-ffp-contract=off", "-shared", "-fPIC", "-o", library, source, "-lm")
        run(*compiler("gcc"), *options)
        self.library = ctypes.CDLL(str(library))
        spelling = Spelling(program, load("c"))
        kinds: dict[str, Any] = {
            "real": ctypes.c_double,
            "bool": ctypes.c_bool,
            "count": ctypes.c_int32,
        }

        def struct(name: str, fields: list[tuple[str, Any]]) -> Any:
            return type(name, (ctypes.Structure,), {"_fields_": fields})

        def members(found: Any) -> list[tuple[str, Any]]:
            return [
                (m.name, kinds[m.type] * m.size if m.size else kinds[m.type]) for m in found
            ] or [("unused", ctypes.c_char)]

        count = len(program.residuals)
        params = [(spelling.params[f.name], ctypes.c_double) for f in program.params]
        self.Parameters = struct("Parameters", params or [("unused", ctypes.c_char)])
        self.Samples = struct("Samples", members(samples(program, spelling)))
        self.Derivatives = struct("Derivatives", members(derivatives(program, spelling)))
        self.Residuals = struct(
            "Residuals", [("value", ctypes.c_double * count), ("valid", ctypes.c_bool * count)]
        )
        self.monitor = ctypes.create_string_buffer(1 << 20)
        self.configure_status = 0

    def configure(self, *options: float, **params: float) -> int:
        """The status of configure with sample_time, bandwidth and time_unit."""
        given = self.Parameters()
        getattr(self.library, f"{self.stem}_nominal")(ctypes.byref(given))
        for name, value in params.items():
            setattr(given, name, value)
        function = getattr(self.library, f"{self.stem}_configure")
        reals = [ctypes.c_double(x) for x in options]
        return int(function(self.monitor, ctypes.byref(given), *reals))

    def step(self, **signals: Any) -> tuple[list[float], list[bool]]:
        """Values and validity after one sample."""
        given, found = self.Samples(**signals), self.Residuals()
        function = getattr(self.library, f"{self.stem}_step")
        function(self.monitor, ctypes.byref(given), ctypes.byref(found))
        return list(found.value), list(found.valid)

    def exact(self, **signals: Any) -> list[float]:
        """The residuals from exact derivatives."""
        given = self.Derivatives()
        for name, value in signals.items():
            member = getattr(given, name)
            if isinstance(value, tuple):
                member[:] = value
            else:
                setattr(given, name, value)
        found = (ctypes.c_double * len(self.program.residuals))()
        getattr(self.library, f"{self.stem}_exact")(self.monitor, ctypes.byref(given), found)
        return list(found)
