"""What all tests share: `--update`, no skip where none is allowed, reproducible properties."""

from __future__ import annotations

import os
from collections.abc import Generator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

import bondgraph.notation.line  # noqa: F401  # nodes in messages are written as formulas

# The matrices here are small: threads of a numeric library would only wait for each other. Set
# before any test imports it.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

ROOT = Path(__file__).resolve().parent.parent
NO_SKIP = os.environ.get("BONDGRAPH_NO_SKIP") == "1"

# The same examples on every machine; no deadline, because a busy machine is not a wrong program.
settings.register_profile(
    "repeatable", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("repeatable")


def pytest_addoption(parser: pytest.Parser) -> None:
    """`--update` writes the expected files anew instead of comparing with them."""
    parser.addoption("--update", action="store_true", help="write the expected files anew")


#: Folders of tests that take minutes begin first: none is alone on one core at the end.
_LONG = ("docs", "adversary", "generated", "elements", "file_faults", "random", "kills", "promises")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Which file is first; tests of a file stay together and in their order."""

    def rank(item: pytest.Item) -> int:
        folder = item.path.relative_to(ROOT / "tests").parts[0]
        return _LONG.index(folder) if folder in _LONG else len(_LONG)

    items.sort(key=rank)


@pytest.fixture(scope="session")
def update(pytestconfig: pytest.Config) -> bool:
    """Whether expected files are to be written anew."""
    return bool(pytestconfig.getoption("--update"))


@pytest.fixture(scope="session")
def root() -> Path:
    """The top of the checkout."""
    return ROOT


@pytest.fixture(scope="session", autouse=True)
def _cache(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Compiled residuals are kept for this run of the tests, not in the developer's home."""
    os.environ["XDG_CACHE_HOME"] = str(tmp_path_factory.mktemp("cache"))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Where everything is installed (BONDGRAPH_NO_SKIP=1), a skipped test is a failed one."""
    report = yield
    if NO_SKIP and report.skipped and not hasattr(report, "wasxfail"):
        reason = call.excinfo.value if call.excinfo is not None else ""
        report.outcome = "failed"
        report.longrepr = f"{item.nodeid} was skipped, but no skip is allowed here: {reason}"
    return report
