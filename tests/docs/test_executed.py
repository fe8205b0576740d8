"""Every command, program and file on a page works, in the page's order, and prints what it says."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import pytest

from bondgraph.compilation import Compilation
from bondgraph.compile_options import Options
from bondgraph.text.source import Source
from tests.docs.executed import Wrong, matches, renewed, run, steps
from tests.docs.pages import PAGES, ROOT, named

#: Pages with something to run.
RUN = [p for p in PAGES if steps(p.read_text(encoding="utf-8")) or ">>> " in p.read_text()]

#: A block with the remark before it, and where it stands.
_BLOCK = re.compile(
    r"(?:^<!-- ([^>]*?) -->\n+)?^ *```(\w*)\n(.*?)^ *```$", re.MULTILINE | re.DOTALL
)
#: Languages of blocks that are shown only: what tools print, formulas, what other tests compare.
_SHOWN = {"", "text", "math", "ebnf", "c"}


#: Programs that commands of the pages begin with and that may be missing.
_TOOLS = re.compile(r"^(cc|arm-none-eabi-gcc|qemu-system-arm) ", re.MULTILINE)


@pytest.mark.parametrize("page", RUN, ids=named)
def test_a_page_does_what_it_says(page: Path, tmp_path: Path, update: bool) -> None:
    for tool in _TOOLS.findall(page.read_text(encoding="utf-8")):
        if shutil.which(tool) is None:
            pytest.skip(f"{tool} is not installed")
    assert run(page, tmp_path, update) > 0


def blocks() -> list[tuple[str, str, str, str]]:
    """Every block of every page: the page, the remark before it, its language, its text."""
    return [
        (named(page), *found)
        for page in PAGES
        for found in _BLOCK.findall(page.read_text(encoding="utf-8"))
    ]


def test_no_snippet_is_left_out_without_a_reason() -> None:
    """Each is run, a file that a command of its page reads, a whole model, or says why not."""
    wrong = []
    for page, remark, language, text in blocks():
        kind, _, said = remark.partition(": ")
        if kind == "file":
            commands = [s.text for s in steps((ROOT / page).read_text()) if s.kind != "file"]
            used = any(Path(said).name in command for command in commands)
            fine = used or f'"{Path(said).name}"' in (ROOT / page).read_text()
        elif kind == "not run":
            tests = re.findall(r"[\w/.]+/\w+(?:\.py)?", said)
            fine = len(said) > 20 and any((ROOT / name).exists() for name in tests)
        elif kind == "part of":
            fine = " ".join(text.split()) in " ".join((ROOT / said).read_text().split())
        elif language == "bg":
            fine = text.startswith("bg 1\n") and whole(page, text)
        elif language == "json":
            fine = isinstance(json.loads(text), dict)
        else:
            fine = language in _SHOWN | {"sh", "python"}
        if not fine:
            wrong.append((page, remark, language, text[:80]))
    assert wrong == []


def whole(page: str, text: str) -> bool:
    """Whether a model has verified residuals; of a part, which ends early, whether it is sound."""
    cut_off = text.count("{") - text.count("}")
    compilation = Compilation(Source(page, text + "}" * cut_off), options=Options(open_ports=True))
    if cut_off:
        return bool(compilation.integral)
    return bool(compilation.verification and compilation.signatures.residuals)


def test_every_target_of_make_and_program_that_is_named_exists() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        for name in re.findall(r"(?:^    |`)make ([a-z]+)", text, re.MULTILINE):
            assert re.search(rf"^{name}:", makefile, re.MULTILINE), f"{named(page)}: make {name}"
        for module in re.findall(r"(?:^    |`)python -m (tests[\w.]+)", text, re.MULTILINE):
            place = ROOT / module.replace(".", "/")
            assert place.with_suffix(".py").exists() or (place / "__main__.py").exists(), module


PAGE = """# Page

<!-- file: a.txt -->
```text
one
two
three
```

```sh
cat a.txt
```

```
one
...
three
```

<!-- status: 3 -->
```sh
exit 3
```

<!-- not run: it would end the world -->
```sh
exit 4
```

    bondgraph --version

| `bondgraph check models/dc_motor.bg` | sound? |
| `bondgraph check MODEL` | no command |
"""


def test_a_page_is_read_as_its_reader_does() -> None:
    assert [(s.kind, s.said) for s in steps(PAGE)] == [
        ("file", "a.txt"), ("sh", "0"), ("sh", "3"), ("sh", "0"), ("sh", "0")
    ]  # fmt: skip
    assert [s.printed for s in steps(PAGE)] == [None, "one\n...\nthree\n", None, None, None]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("\ntwo\n", "\ntwo\n", ""),
        ("three\n```\n\n```sh", "four\n```\n\n```sh", "and not"),
        ("exit 3", "exit 2", "status 2"),
        ("cat a.txt", "cat b.txt", "status 1"),
        ("models/dc_motor.bg", "models/none.bg", "status 1"),
    ],
)
def test_a_page_that_is_wrong_is_found(old: str, new: str, said: str, tmp_path: Path) -> None:
    page, folder = tmp_path / "page.md", tmp_path / "work"
    folder.mkdir()
    assert old in PAGE
    page.write_text(PAGE.replace(old, new))
    if not said:
        assert run(page, folder, False) == 5
        return
    with pytest.raises(Wrong, match=said):
        run(page, folder, False)


def test_what_is_printed_is_written_anew() -> None:
    assert matches("a\n...\nc\n", "a\nb\nc\n") and matches("...\n", "")
    assert not matches("a\n", "a\nb\n") and not matches("...\nb\n", "b\nc\n")
    assert renewed("", "a\nb\n") == "a\nb\n"
    assert renewed("1\n...\n2\n3\n", "a\nb\nc\nd\ne\n") == "a\n...\nd\ne\n"
