"""The process that atheris drives: one kind of text, guided by the branches of the package.

    python -m tests.fuzz.one_kind MODULE KIND FOLDER OPTION ...

MODULE has `KINDS`, OPTIONs are those of libFuzzer. All that is found is in FOLDER at once, as a
process that hangs, or takes too much memory, is ended by libFuzzer from one moment to the next:
`counts` (see `Counts`), a line in `answers` for each new one, and `findings` with a text and its
trace each. What is too slow may also be found as KeyError('__import__'): where atheris interrupts
the making of a named tuple, it can import nothing. The package is instrumented when it is imported,
so atheris has to come first.
"""

from __future__ import annotations

import random
import resource
import shlex
import sys
import time
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import atheris

from tests.fuzz.attempt import Kind, finding
from tests.fuzz.counts import Counts
from tests.fuzz.mutate import BYTES, ENCODING, LONGEST, Mutator, changed, corpus

_SOUND = ("sound", "compiled", "samples", "done", "begun")
_ADDRESSES = 4 << 30  # bytes; libFuzzer looks at the memory that is used once a second only


class Reader:
    """Gives a text to its kind and keeps what came of it."""

    def __init__(self, kind: Kind, folder: Path) -> None:
        self.kind = kind
        self.findings = folder / "findings"
        self.findings.mkdir(exist_ok=True)
        self.counts = Counts(folder / "counts")
        self.answers = folder / "answers"
        self.answers.touch()
        self.known = set(self.answers.read_text("utf-8").splitlines())
        self.before = resident()

    def __call__(self, text: bytes) -> None:
        """What libFuzzer calls."""
        begun = time.perf_counter()
        try:
            answer = self.kind.read(text)
        except Exception as error:
            found = finding(error, text)
            answer = found.what
            path = self.findings / answer.replace("/", "_")
            if not path.exists() or len(text) < path.stat().st_size:
                path.write_bytes(text)
                path.with_name(path.name + ".trace").write_text(found.trace, "utf-8", "replace")
        taken = time.perf_counter() - begun
        self.counts.add(answer.startswith(_SOUND), taken, resident() - self.before)
        line = ascii(answer)
        if line not in self.known:
            self.known.add(line)
            with self.answers.open("a", encoding="utf-8") as file:
                file.write(line + "\n")


def resident() -> float:
    """The memory (MB) that this process used at most."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def mutator(kind: Kind, words: tuple[str, ...]) -> Callable[[bytes, int, int], bytes]:
    """What makes a text of one of the corpus.

    Of texts that are no models, half are changed as libFuzzer does: by bytes and by what the
    package compared them with. So are some models; most are changed by what models consist of, or
    made anew. The shares are those that reached most branches.
    """
    seeds = kind.seeds()
    grown = Mutator(0, corpus())

    def mutate(data: bytes, most: int, seed: int) -> bytes:
        rng = grown.random = random.Random(seed)
        share = rng.random()
        if share < (0.15 if kind.models else 0.5):
            return bytes(atheris.Mutate(data, most))
        if share < 0.34 or not kind.models:
            return changed(rng, data, seeds, words)[:most]
        text = grown.changed(data.decode(ENCODING, BYTES)) if share < 0.67 else grown.text()
        return text.encode(ENCODING, BYTES)[:most]

    return mutate


def dictionary(words: tuple[str, ...], path: Path) -> None:
    """The words in the form of libFuzzer, which takes up to 64 bytes each."""
    encoded = [w.encode("utf-8", "surrogatepass") for w in words]
    lines = ("".join(f"\\x{b:02x}" for b in w) for w in encoded if 0 < len(w) <= 64)
    path.write_text("".join(f'"{line}"\n' for line in lines))


def main() -> None:
    """Never returns: libFuzzer ends the process."""
    module, name, place, megabytes, *options = sys.argv[1:]
    folder = Path(place)
    atheris.instrument_imports(include=["bondgraph"]).__enter__()  # commands import late, too
    found = import_module(module)
    kind: Kind = found.KINDS[name]
    words = (*kind.words, *found.WORDS)
    dictionary(words, folder / "words")
    kind.read(kind.seeds()[0])  # what is made once belongs to no text
    reader = Reader(kind, folder)
    own = resource.getrlimit(resource.RLIMIT_AS)[1]
    resource.setrlimit(resource.RLIMIT_AS, (_ADDRESSES, own))
    limits = [f"-rss_limit_mb={round(reader.before) + int(megabytes)}", f"-max_len={LONGEST}"]
    # Texts of any length from the first one on, and each changed once: more changes, one upon
    # another, reach less.
    ways = ["-len_control=0", "-mutate_depth=1", f"-dict={folder / 'words'}"]
    # To merge, libFuzzer has a shell begin further processes by the first of these words.
    again = [sys.executable, "-m", "tests.fuzz.one_kind", module, name, place, megabytes]
    argv = [shlex.join(again), *limits, *ways, f"-artifact_prefix={folder}/", *options]
    atheris.Setup(argv, reader, custom_mutator=mutator(kind, words))
    atheris.Fuzz()


if __name__ == "__main__":
    main()
