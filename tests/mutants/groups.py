"""The modules that are mutated, in groups of the same weight, and the tests that may be asked."""

from __future__ import annotations

from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

#: Patterns below bondgraph/.
GROUPS: dict[str, tuple[str, ...]] = {
    "causality": ("passes/causality/*.py",),
    "elimination": ("passes/elimination/*.py", "structural/*.py"),
    "algebra": ("algebra/*.py",),
    "signatures": ("passes/analysis/*.py", "passes/relation/*.py"),
    "lowering": ("passes/lowering/*.py",),
    "oracle": ("exact/*.py", "field/*.py"),
    "diagnosis": ("runtime/diagnosis/*.py",),
    "monitoring": ("runtime/monitoring/*.py", "runtime/monitoring/sources/*.py"),
    "code generation": tuple(
        f"backends/{name}.py"
        for name in (
            "blocks c emit forty_digits golden identifiers members procedure_lines python"
            " runnable spelling target vectors"
        ).split()
    )
    + ("notation/*.py",),
}

#: Tests that take minutes, wait for a clock or a browser, or look at nothing that is mutated.
_NOT_ASKED = tuple(
    f"tests/{place}/"
    for place in "adversary bench docs fuzz mutants random robots unit/runtime/live".split()
)
_DOCTESTS = "tests/unit/test_doctests.py"


def modules(group: str) -> list[str]:
    """The modules of a group; an error for a pattern without any."""
    found: list[str] = []
    for pattern in GROUPS[group]:
        files = sorted((ROOT / "bondgraph").glob(pattern))
        if not files:
            raise FileNotFoundError(f"{group}: no module bondgraph/{pattern}")
        found += [str(f.relative_to(ROOT)) for f in files if f.name != "__init__.py"]
    return found


def asked() -> list[str]:
    """The test files that may be asked about a mutant."""
    files = sorted(str(f.relative_to(ROOT)) for f in (ROOT / "tests").rglob("test_*.py"))
    return [f for f in files if not f.startswith(_NOT_ASKED) and f != _DOCTESTS]


def examples(module: str) -> str:
    """The test of the examples in the docstrings of a module."""
    return f"{_DOCTESTS}::test_examples[{module.removesuffix('.py').replace('/', '.')}]"


@cache
def _text(test: str) -> str:
    return (ROOT / test).read_text(encoding="utf-8") if (ROOT / test).is_file() else ""


def _imports(test: str, module: str) -> bool:
    return f"from {module.removesuffix('.py').replace('/', '.')} import" in _text(test)


def mirror(test: str, module: str) -> bool:
    """Whether a test file belongs to a module: by its name, that of its folder, or an import.

    >>> mirror("tests/unit/structural/test_choose.py", "bondgraph/structural/placement.py")
    True
    >>> mirror("tests/unit/passes/test_lower_jets.py", "bondgraph/passes/lowering/filter.py")
    True
    >>> mirror("tests/unit/passes/test_lower_jets.py", "bondgraph/passes/elimination/chaining.py")
    False
    """
    place = Path(module)
    names = (f"test_{place.stem}", f"test_{place.parent.name[:5]}")
    return _imports(test, module) or Path(test).stem.startswith(names)


def own(test: str, module: str) -> bool:
    """Whether a test is of the room of tests/unit that belongs to the folder of a module.

    >>> own("tests/unit/runtime/monitoring/test_clock.py", "bondgraph/runtime/monitoring/clock.py")
    True
    >>> own("tests/unit/passes/test_lower.py", "bondgraph/passes/lowering/filter.py")
    True
    >>> own("tests/paper/test_paper.py", "bondgraph/passes/lowering/filter.py")
    False
    """
    rooms = [Path("tests/unit", p.relative_to("bondgraph")) for p in Path(module).parents[:-2]]
    return Path(test).parent == next((r for r in rooms if (ROOT / r).is_dir()), None)
