"""What the generated C costs on each core, measured with the compilers that are here."""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from bondgraph.backends.templates import codegen, fill
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.numerals import joined
from bondgraph.text.tuples import NamedTuple

STEPS, _LONGEST = 2000, 1_000_000  # samples of each situation; those to settle in, at most
_SECONDS = 600.0
_OPTIMISED = "-std=gnu99 -O2 -ffunction-sections -fdata-sections".split()
_QEMU = "-icount shift=0 -display none -monitor none -serial none".split()
_HOST = ["-semihosting-config", "enable=on,target=native", "-kernel"]


class Core(NamedTuple):
    """A processor: its compiler with flags, how to link for it, and the machine that runs it."""

    name: str
    real: str
    compiler: str
    flags: tuple[str, ...]
    link: tuple[str, ...]
    machine: tuple[str, ...]


class Cost(NamedTuple):
    """Of one core: bytes, and instructions of a sample.

    `text` and `rodata` are all that step, reset and diagnose take in flash, libraries included,
    `memory` what is kept of one machine, `stack` what a sample takes of it. `step` is the mean of
    settled samples, `worst` that of the first sample or of bad ones, `diagnose` comes on top.
    """

    core: Core
    version: str
    text: int
    rodata: int
    memory: int
    stack: int
    step: float
    worst: float
    diagnose: float


_ARM = ("arm-none-eabi-gcc", "qemu-system-arm", "-M", "mps2-an386")
_THUMB = ("-nostdlib", "-T", "link.ld")


def _arm(name: str, *flags: str) -> Core:
    compiler, *machine = _ARM
    return Core(name, "float", compiler, ("-mthumb", *flags), _THUMB, tuple(machine))


def whole(cores: Sequence[Core]) -> tuple[Core, ...]:
    """The same cores, for code in whole numbers."""
    return tuple(core._replace(real="int32") for core in cores)


#: A Cortex-M4 runs all instructions of the smaller ones: it counts theirs.
CORES = (
    Core("x86-64", "double", "gcc", (), (), ("valgrind",)),
    _arm("Cortex-M4F", "-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"),
    _arm("Cortex-M3", "-mcpu=cortex-m3"),
    _arm("Cortex-M0+", "-mcpu=cortex-m0plus"),
    Core(
        "RV32IMAC", "float", "riscv64-unknown-elf-gcc",
        ("-march=rv32imac", "-mabi=ilp32", "--specs=picolibc.specs"),
        ("-nostdlib", "-T", "riscv.ld"),
        ("qemu-system-riscv32", "-M", "virt", "-bios", "none"),
    ),
)  # fmt: skip


def missing(core: Core) -> list[str]:
    """The programs that measuring on a core takes and that are not installed."""
    return [tool for tool in (core.compiler, core.machine[0]) if shutil.which(tool) is None]


def costs(
    files: Mapping[str, str],
    stem: str,
    file: str,
    holes: Mapping[str, object],
    cores: Sequence[Core] = CORES,
) -> tuple[Cost, ...]:
    """The costs of C whose `files` have samples in tests/golden.h, on the `cores` that are here.

    `holes` are those of the C templates. Raises Trouble where no core can be measured, or one
    cannot with the tools that are here.
    """
    here = [core for core in cores if not missing(core)]
    if not here:
        tools = ", ".join(dict.fromkeys(tool for core in cores for tool in missing(core)))
        raise Trouble(f"costs cannot be measured: {tools} are not installed")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for path, text in files.items():
            (folder / path).parent.mkdir(exist_ok=True)
            (folder / path).write_text(text, encoding="utf-8")
        program = fill("c/costs/main.c.j2", {**holes, "steps": STEPS, "longest": _LONGEST})
        (folder / "main.c").write_text(program, encoding="utf-8")
        (folder / "link.ld").write_text(fill("c/qemu/link.ld.j2", {}), encoding="utf-8")
        for path in ("board.c", "riscv.ld"):
            shutil.copy(codegen() / "c" / "costs" / path, folder)
        return tuple(_cost(folder, core, stem, file) for core in here)


def table(found: Sequence[Cost], samples: str) -> dict[str, object]:
    """The holes of costs.md.j2; `samples` says which ones."""
    rows = []
    for core, _, *sizes, step, worst, diagnose in found:
        words = (*sizes, *(f"{x:.0f}" for x in (step, worst, diagnose)))
        rows.append(f"| {core.name} | {core.real} | {' | '.join(map(str, words))} |")
    here = [cost.core.name for cost in found]
    compilers = dict.fromkeys(f"{cost.core.compiler} {cost.version}" for cost in found)
    return {
        "rows": rows,
        "samples": samples,
        "compilers": joined(compilers),
        "absent": ", ".join(core.name for core in CORES if core.name not in here),
    }


def _cost(folder: Path, core: Core, stem: str, file: str) -> Cost:
    real = [f"-D{stem.upper()}_FLOAT"] if core.real == "float" else []
    compile_ = [core.compiler, *_OPTIMISED, *core.flags, *real, f"-D{stem.upper()}_NO_THRESHOLDS"]
    _run(folder, *compile_, "-c", f"{file}.c", "-o", "code.o")
    sources = ["-I.", "main.c", "board.c", "code.o", *core.link, "-Wl,--gc-sections"]
    _run(folder, *compile_, *sources, "-lm", "-lc", "-lgcc", "-o", "image")
    counted = _counted_here if core.machine == ("valgrind",) else _counted_in_qemu
    nothing, restarted, first, spoilt, settled, diagnosed, stack = counted(folder, core)
    held = _sizes(folder, core, "image")
    sizes = _sections(folder, core, stem, ("step", "reset", "diagnose", "diagnosis_reset"))
    kept = ("memory", "found", "configured")
    return Cost(
        core,
        _run(folder, core.compiler, "-dumpfullversion").strip(),
        sizes.get(".text", 0),
        sizes.get(".rodata", 0) + held.get(f"{stem}_nominal_coefficients", 0),
        sum(held.get(name, 0) for name in kept),
        stack,
        (settled - nothing) / STEPS,
        max(first - restarted, spoilt - nothing, settled - nothing) / STEPS,
        (diagnosed - nothing) / STEPS,
    )


def _counted_in_qemu(folder: Path, core: Core) -> list[int]:
    """What the program on the board says."""
    return [int(w) for w in _run(folder, *core.machine, *_QEMU, *_HOST, "image").split()]


_SITUATIONS = "nothing restarted first spoilt settled diagnosed".split()
_CALL = re.compile(r"^cfn=\((\d+)\)(?: \S+)?\ncalls=\d+ .*\n\S+ (\d+)", re.MULTILINE)


def _counted_here(folder: Path, core: Core) -> list[int]:
    """The same of a computer, whose instructions callgrind counts."""
    profile = ("--tool=callgrind", "--callgrind-out-file=profile", "--compress-pos=no")
    *_, stack = _run(folder, *core.machine, *profile, "./image").split()
    text = (folder / "profile").read_text(encoding="utf-8", errors="replace")
    names = dict(re.findall(r"^c?fn=\((\d+)\) (\S+)", text, re.MULTILINE))
    found = {names[number]: int(many) for number, many in _CALL.findall(text)}
    return [*(found[name] for name in _SITUATIONS), int(stack)]


def _sizes(folder: Path, core: Core, image: str) -> dict[str, int]:
    """The sizes of what is in an image, by name."""
    lines = _run(folder, core.compiler.replace("gcc", "nm"), "-S", image).splitlines()
    return {words[3]: int(words[1], 16) for words in map(str.split, lines) if len(words) == 4}


def _sections(folder: Path, core: Core, stem: str, roots: Sequence[str]) -> dict[str, int]:
    """The sections of an image that has nothing but these functions and all that they call."""
    wanted = [f"-Wl,-u,{stem}_{name}" for name in roots]
    libraries = ["-lm", "-lc", "-lgcc"] if core.link else ["-Wl,--unresolved-symbols=ignore-all"]
    link = [*(core.link or ("-nostdlib", "-static")), "-Wl,--gc-sections", *wanted]
    start = f"-Wl,-e,{stem}_step"
    _run(folder, core.compiler, *core.flags, *link, start, "code.o", *libraries, "-o", "alone")
    lines = _run(folder, core.compiler.replace("gcc", "size"), "-A", "alone").splitlines()
    return {words[0]: int(words[1]) for words in map(str.split, lines) if len(words) == 3
            and words[1].isdigit()}  # fmt: skip


def _run(folder: Path, *command: str) -> str:
    """What a command prints; qemu prints what its machine says among its errors."""
    try:
        done = subprocess.run(
            command, cwd=folder, capture_output=True, text=True, timeout=_SECONDS, check=False
        )
    except subprocess.TimeoutExpired as late:
        raise Trouble(f"costs cannot be measured: {command[0]} takes too long") from late
    if done.returncode:
        why = (done.stderr.strip().splitlines() or ["no reason"])[-1]
        raise Trouble(f"costs cannot be measured: {command[0]}: {why}")
    return done.stdout + (done.stderr if command[0].startswith("qemu") else "")
