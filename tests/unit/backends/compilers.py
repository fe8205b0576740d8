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

from bondgraph.backends.emit import EXTRAS, emit
from bondgraph.backends.identifiers import snake
from bondgraph.backends.members import derivatives, samples
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import load
from bondgraph.backends.write import write
from bondgraph.ir.program import Program

WARNINGS = (
    "-Wall -Wextra -Wpedantic -Wconversion -Wdouble-promotion -Wshadow -Wfloat-equal -Werror"
).split()

COMPILERS: dict[str, tuple[str, ...]] = {
    "gcc": ("gcc", "-std=c99"),
    "clang": ("clang", "-std=c99"),
    "g++": ("g++", "-x", "c++"),
    "clang++": ("clang++", "-x", "c++"),
    "arm": ("arm-none-eabi-gcc", "-std=c99", "-mcpu=cortex-m4", "-mthumb"),
    "riscv": ("riscv64-unknown-elf-gcc", "-std=c99", "-march=rv32imac", "-mabi=ilp32",
              "--specs=picolibc.specs"),
}  # fmt: skip


def compiler(name: str) -> tuple[str, ...]:
    """The command line of a compiler; skips the test where it is missing."""
    command = COMPILERS[name]
    if shutil.which(command[0]) is None:
        pytest.skip(f"{command[0]} is not installed")
    return command


#: Where the headers are, and the files that are compiled beside a self-test with `exact`.
INCLUDES = ("-I.", "-Iexact")


def sources(stem: str) -> tuple[str, str]:
    """The files of C of a program, `exact` included."""
    return f"{stem}.c", f"exact/{stem}_exact.c"


def generate(program: Program, folder: Path) -> str:
    """All files of a program in `folder`; the stem of their names."""
    write(emit(program, ("c", "python"), extras=EXTRAS), folder)
    return snake(program.name)


def self_test(folder: Path, stem: str, *options: str, of: str = "") -> str:
    """What the self-test in C says, compiled with gcc and the options; `of` is `_thresholds`."""
    compiled = (f"{stem}.c",) if of else sources(stem)
    files = (f"tests/selftest{of}.c", *compiled, "-lm", "-o", "selftest")
    run(*compiler("gcc"), *INCLUDES, *options, *files, cwd=folder)
    return run(folder / "selftest")


def python_self_test(folder: Path, of: str = "") -> str:
    """What the self-test in Python says."""
    return run(sys.executable, f"tests/selftest{of}.py", cwd=folder)


def run(*command: str | Path, cwd: Path | None = None) -> str:
    """The output of a command that must end with 0."""
    done = subprocess.run(
        [str(c) for c in command], cwd=cwd, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def _module(path: Path, name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def python_module(folder: Path, stem: str) -> ModuleType:
    """The generated Python module."""
    return _module(folder / f"{stem}.py", f"{stem}_{abs(hash(str(folder)))}")


def exact_module(folder: Path, stem: str, module: ModuleType) -> ModuleType:
    """The generated module of exact residuals, beside that of the residuals."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, stem, module)
        path = folder / "exact" / f"{stem}_exact.py"
        return _module(path, f"{stem}_exact_{abs(hash(str(folder)))}")


class InC:
    """The generated C code as a shared library, with the interface of the Python module."""

    def __init__(self, program: Program, folder: Path, stem: str) -> None:
        self.program, self.stem = program, stem
        library = folder / "residuals.so"
        options = ("-O2", "-ffp-contract=off", "-shared", "-fPIC", "-o", library, *INCLUDES)
        run(*compiler("gcc"), *options, *sources(stem), "-lm", cwd=folder)
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
        self.coefficients = ctypes.create_string_buffer(1 << 20)
        self.factors = ctypes.create_string_buffer(1 << 20)
        self.memory = ctypes.create_string_buffer(1 << 20)

    def configure(self, *options: float, **params: float) -> int:
        """The status of configure with sample_time and bandwidth, and of exact with time_unit."""
        given = self.Parameters()
        getattr(self.library, f"{self.stem}_nominal")(ctypes.byref(given))
        for name, value in params.items():
            setattr(given, name, value)
        *numbers, unit = [ctypes.c_double(x) for x in options]
        configure = getattr(self.library, f"{self.stem}_configure")
        status = int(configure(self.coefficients, ctypes.byref(given), *numbers))
        self.reset()
        exact = getattr(self.library, f"{self.stem}_exact_configure")
        return status or int(exact(self.factors, ctypes.byref(given), unit))

    def reset(self) -> None:
        """Forget all samples."""
        getattr(self.library, f"{self.stem}_reset")(self.memory)

    def step(self, **signals: Any) -> tuple[list[float], list[bool]]:
        """Values and validity after one sample."""
        given, found = self.Samples(**signals), self.Residuals()
        function = getattr(self.library, f"{self.stem}_step")
        function(self.coefficients, self.memory, ctypes.byref(given), ctypes.byref(found))
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
        getattr(self.library, f"{self.stem}_exact")(self.factors, ctypes.byref(given), found)
        return list(found)
