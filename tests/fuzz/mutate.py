"""Makes broken texts: seeded; models from those at hand, from the grammar, and from noise; any
other text from one that was there, with bytes, words, lines and parts put in or left out."""

from __future__ import annotations

import random
import re
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parents[2]

#: How a text stands for the bytes of a file, even where they are no UTF-8.
ENCODING, BYTES = "utf-8", "surrogateescape"

LONGEST = 8_000  # bytes or letters of a text: longer ones take long and reach the same

_TOKEN = re.compile(r"\s+|#[^\n]*|\"[^\"\n]*\"|\d+(?:\.\d+)?(?:[eE][+-]?\d+)?|\w+|->|<-|\.\.|\+-|.")

_NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?")
_WORD = re.compile(rb"\w+")
_NUMBERS = tuple(
    b"0 1 -1 -0.0 2 0.5 1e3 2147483648 9223372036854775808 1e308 1e-320 1e999 NaN Infinity".split()
)

#: Words that the language knows, and some that it must not know.
LANGUAGE = (
    "bg model port in out param const input sensor let fault for if else when unknown bool int "
    "true false and or not counts turn import from 0 1 R C I TF GY Se Sf De Df MSe MTF MGY MR "
    "electrical rotation translation hydraulic thermal thermofluid chemical any e f q p e1 f1 e2 "
    "f2 tanh sqrt ssqrt abs der int if min max pow table atan2 -> <- -[7]-> <-[a]- = += *= +- ± "
    "+ - * / ^ < <= > >= == != ( ) { } [ ] , ; : . .. % Ohm N.m/A m^3/s.Pa^-0.5 kg.m^2 1/s V rad "
    '"file.csv" "a.bg" 1e999 1e-999 1e308 99999999999999999999 0.1 .5 5. 2 3 -1 __ a__b é Ω '
    "∫ \t \r \x00 \x0c \ufeff \u202e 'x' ! ? @ & | \\ ~ $ // /* */ ** :: -- => <-> x.e m[1] "
    "m[1..3] n+1"
).split(" ")

_NAMES = "a b i j k m n r x y u w R1 C1 left right shaft".split()
_KINDS = "0 1 R C I TF GY Se Sf De Df MSe MSf MTF MGY MR Part Gear Chain".split()
_DOMAINS = "electrical rotation translation hydraulic thermal any".split()


def corpus() -> list[str]:
    """The models of the checkout that make good starting points, the same ones in every run."""
    files = sorted(ROOT.glob("models/*.bg")) + sorted(ROOT.glob("tests/broken/*.bg"))
    return [f.read_text(encoding="utf-8") for f in files]


_FRAME = frozenset(("bg", "model", "port", "in", "out", "param"))

#: A model to which random statements are added, and sound ones that it may have too.
_SKELETON = ("Se:u -> 1:i", "i -> R:r = 2", "i -> 0:j", "j -> C:C1 = 1 F")
_SOUND = (
    "i -> Df:y", "j -> De:w", "i -> I:left = 3", "param k = 2 V", "let x = k*r.f",
    "i -> R:a { e = 2*f*abs(f) }", "j -> GY:b -> 1:m", "j -> R:right { 0 = e - 2*f^3 }",
    "m -> I:shaft = 3", "j -> TF:n { f1 = 2*f2 } -> R:load = 1", "fault break : r *= 2",
    "C:mic { port x; port y; x.e = x.q*y.q; y.e = x.q^2/2 }", "i -> mic.x", "j -> mic.y",
    "input on : bool", "1:gate when on { <- j; -> R:leak = 5 }", "Se:noise -> i",
    "sensor z : A.s = int(r.f, q0)", "param q0 = 0 A.s", "j -> Sf:pump = 2*r.f",
)  # fmt: skip


class Mutator:
    """A stream of texts that depends on the seed alone."""

    def __init__(self, seed: int, texts: Sequence[str]) -> None:
        self.random = random.Random(seed)
        # Small models show the same errors as large ones, in less time.
        self.texts = sorted(texts, key=len)
        self.weights = [1 / (200 + len(t)) for t in self.texts]

    def text(self) -> str:
        """The next broken model (some are sound)."""
        kind = self.random.random()
        if kind < 0.03:
            return self._noise()
        text = self._grown() if kind < 0.35 else self._picked()
        return self.changed(text, 60 if kind > 0.99 else None)

    def changed(self, text: str, times: int | None = None) -> str:
        """Another text, changed so many times, mostly once or twice; half of them still parse."""
        changes = _MUTATIONS if self.random.random() < 0.5 else _GENTLE
        if times is None:
            times = self.random.choice((0, 1, 1, 1, 2, 2, 3, 5, 8))
        for _ in range(times):
            text = self.random.choice(changes)(self, text)
        return text[:LONGEST]

    def _picked(self) -> str:
        return self.random.choices(self.texts, self.weights)[0]

    def _noise(self) -> str:
        size = self.random.randrange(200)
        if self.random.random() < 0.5:
            return "".join(self.random.choices(LANGUAGE, k=size))
        raw = bytes(self.random.randrange(256) for _ in range(size))
        return (self.random.choice((b"", b"\xff\xfe", b"bg 1\n")) + raw).decode(ENCODING, BYTES)

    # ----------------------------------------------------- changes to a text

    def swap_word(self, text: str) -> str:
        """Another word of the language, or of the same text, in place of one."""
        words = _TOKEN.findall(text) or [""]
        at = self._solid(words)
        words[at] = self.random.choice(LANGUAGE if self.random.random() < 0.5 else words)
        return "".join(words)

    def rename(self, text: str) -> str:
        """Another name where a name stood: the mistakes that only elaboration can see."""
        names = [m for m in re.finditer(r"\b[A-Za-z_]\w*\b", text) if m[0] not in _FRAME]
        if not names:
            return text
        one, other = self.random.choice(names), self.random.choice(names)
        return text[: one.start()] + other[0] + text[one.end() :]

    def drop_words(self, text: str) -> str:
        """A run of words left out."""
        words = _TOKEN.findall(text) or [""]
        at = self._solid(words)
        del words[at : at + self.random.choice((1, 1, 1, 2, 5, 20))]
        return "".join(words)

    def add_word(self, text: str) -> str:
        """A word too many, sometimes very often."""
        words = _TOKEN.findall(text) or [""]
        times = self.random.choice((1,) * 20 + (3, 300))
        words.insert(self._solid(words), self.random.choice(LANGUAGE) * times)
        return "".join(words)

    def number(self, text: str) -> str:
        """Another number: zero, negative, broken, huge."""
        numbers = [m for m in re.finditer(r"\d+(\.\d+)?", text)]
        if not numbers:
            return text
        one = self.random.choice(numbers)
        new = self.random.choice("0 1 7 -1 2.5 1e400 1e-400 90000000 30000 1/0".split())
        return text[: one.start()] + new + text[one.end() :]

    def drop_line(self, text: str) -> str:
        """A line left out."""
        lines = text.split("\n")
        del lines[min(self._inside(lines), len(lines) - 1)]
        return "\n".join(lines)

    def repeat_line(self, text: str) -> str:
        """A line said twice, or moved elsewhere."""
        lines = text.split("\n")
        line = self.random.choice(lines)
        lines.insert(self._inside(lines), line)
        return "\n".join(lines)

    def join(self, text: str) -> str:
        """Some lines of another model."""
        lines, others = text.split("\n"), self._picked().split("\n")
        start = self.random.randrange(len(others))
        at = self._inside(lines)
        lines[at:at] = others[start : start + self.random.randrange(1, 6)]
        return "\n".join(lines)

    def cut(self, text: str) -> str:
        """The text up to somewhere, or from somewhere."""
        at = self.random.randrange(len(text) + 1)
        return text[:at] if self.random.random() < 0.8 else text[at:]

    def character(self, text: str) -> str:
        """One character changed."""
        at = self.random.randrange(len(text) + 1)
        new = chr(self.random.choice((self.random.randrange(128), self.random.randrange(0x3000))))
        return text[:at] + new + text[at + self.random.randrange(2) :]

    def statement(self, text: str) -> str:
        """A random statement in a random line."""
        lines = text.split("\n")
        lines.insert(self._inside(lines), self._statement())
        return "\n".join(lines)

    def _inside(self, lines: list[str]) -> int:
        """A place between lines, mostly one inside a model."""
        models = [n for n, line in enumerate(lines) if line.startswith("model ")]
        if not models or self.random.random() < 0.05:
            return self.random.randrange(len(lines) + 1)
        first = self.random.choice(models) + 1
        ends = [n for n in range(first, len(lines)) if lines[n].startswith("}")]
        return self.random.randrange(first, max(ends[0] if ends else len(lines), first) + 1)

    def _solid(self, words: list[str]) -> int:
        for _ in range(5):
            at = self.random.randrange(len(words))
            if words[at].strip():
                return at
        return at

    # ------------------------------------------------- texts from the grammar

    def _grown(self) -> str:
        """A file of random statements that mostly parses."""
        lines = self.random.sample(_SOUND, self.random.randrange(len(_SOUND) + 1))
        lines = [*_SKELETON, *lines] if self.random.random() < 0.8 else []
        lines += [self._statement() for _ in range(self.random.choice((0, 1, 1, 2, 3, 6)))]
        if self.random.random() < 0.5:
            self.random.shuffle(lines)
        statements = "\n    ".join(lines)
        part = f"""model Part {{
    port a : in {self.random.choice(_DOMAINS)}
    port b : out {self.random.choice(_DOMAINS)}
    param r = 2
    a -> 1:i
    i -> {self._node(2)}
    i -> b
}}
model Chain(n : int = {self._expression(2)}) {{
    port a : in any
    port b : out any
    Part:p[n]
    a -> p[1..n] -> b
}}
"""
        part = part if self.random.random() < 0.5 else ""
        return f"bg 1\n{part}model M {{\n    {statements}\n}}\n"

    def _statement(self) -> str:
        choose, name = self.random.choice, self._name()
        value = self._expression(3)
        return choose((
            f"param {name} = {value}",
            f"const {name} = {value} +- 5%",
            f"param {name} : {choose(('V', 'Ohm', 'N.m/A', 'bool', '1'))}",
            f"input {name} : {choose(('V', 'A', 'bool', 'V unknown'))}",
            f"let {name} = {value}",
            f"sensor {name} : {choose(('V', 'A', 'rad', 'm/s'))} = {value}",
            f"sensor {name} = int({self._ref()}) counts 24/turn",
            f"fault {name} : {self._ref()} {choose(('=', '+=', '*='))} {value}",
            f"port {name} : {choose(('in', 'out'))} {choose(_DOMAINS)}",
            f"for {name} in 1..{self._expression(1)} {{ {self._chain()} }}",
            f"if {value} {{ {self._chain()} }} else {{ {self._chain()} }}",
            f"{choose('01')}:{name} {{ -> {self._node(2)}; <- {self._node(2)} }}",
            f"{choose('01')}:{name} when {value} {{ -> {self._node(2)} }}",
            f"{name} {{ -> {self._node(2)} }}",
            *[self._chain() for _ in range(10)],
        ))  # fmt: skip

    def _chain(self) -> str:
        out = self._node(2)
        for _ in range(self.random.choice((1, 1, 1, 2, 3))):
            arrow = self.random.choice(("->", "->", "->", "<-", "-[3]->"))
            out += f" {arrow} {self._node(2)}"
        return out

    def _node(self, depth: int) -> str:
        choose = self.random.choice
        if self.random.random() < 0.45:
            return self._ref()
        kind = choose(_KINDS)
        value = self._expression(depth)
        law = choose(("", "", f" = {value}", f" {{ e = {value} }}", f" {{ f = {value} }}",
                      f" {{ f1 = {value}*f2 }}", f"(q0 = {self._expression(1)})",
                      f"[{self._expression(1)}]", " { 0 = e - 2*f*abs(f) }",
                      " { port x; port y; x.e = x.q; y.e = y.q }"))  # fmt: skip
        return f"{kind}:{self._name()}{law}"

    def _ref(self) -> str:
        tail = ("", "", "", "", ".e", ".f", ".q", ".p", ".e1", ".a", ".b", "[1]", "[1..2]", "[n]")
        return self._name() + self.random.choice(tail)

    def _name(self) -> str:
        return self.random.choice(_NAMES)

    def _expression(self, depth: int) -> str:
        choose = self.random.choice
        if depth <= 0 or self.random.random() < 0.3:
            return choose((self._ref(), choose("e f q p".split()), "0", "1", "2", "3 V", "2 Ohm",
                           "1e-3", "2.5 A", "true", "5 %", '"x.csv"'))  # fmt: skip
        left, right = self._expression(depth - 1), self._expression(depth - 1)
        operator = choose("+ - * / ^ < <= == != and or".split())
        function = choose("tanh sqrt ssqrt abs der int sin exp log min max pow sign".split())
        return choose((f"{left} {operator} {right}", f"{left} {operator} {right}", f"-{left}",
                       f"({left})", f"{function}({left})", f"{function}({left}, {right})",
                       f"if({left} < {right}, {right}, {left})", f"not {left}"))  # fmt: skip


_GENTLE = (
    Mutator.rename, Mutator.rename, Mutator.number, Mutator.drop_line, Mutator.repeat_line,
    Mutator.statement,
)  # fmt: skip
_MUTATIONS = (
    Mutator.swap_word, Mutator.swap_word, Mutator.rename, Mutator.rename, Mutator.rename,
    Mutator.drop_words, Mutator.add_word, Mutator.number, Mutator.drop_line, Mutator.repeat_line,
    Mutator.join, Mutator.cut, Mutator.character, Mutator.statement,
)  # fmt: skip


def changed(rng: random.Random, text: bytes, kept: Sequence[bytes], words: Sequence[str]) -> bytes:
    """Another text: words of the kind, bytes, lines and parts of others put in or left out."""
    for _ in range(rng.choice((1, 1, 2, 3, 6))):
        size = len(text)
        a = rng.randrange(size + 1)
        b = min(size, a + rng.choice((0, 1, 1, 2, 4, 16, 100)))
        match rng.randrange(13):
            case 0:
                text = text[:a] + bytes([rng.randrange(256)]) + text[b:]
            case 1:
                text = text[:a] + text[b:]
            case 2:
                word = rng.choice(words).encode("utf-8", "surrogatepass")
                text = text[:a] + word + text[b:]
            case 3:
                text = text[:b] + text[a:b] * rng.choice((1, 2, 50)) + text[b:]
            case 4:
                other = rng.choice(kept)
                c = rng.randrange(len(other) + 1)
                text = text[:a] + other[c : c + rng.choice((4, 20, 200))] + text[b:]
            case 5:
                lines = text.split(b"\n")
                lines.insert(rng.randrange(len(lines)), rng.choice(lines))
                text = b"\n".join(lines)
            case 6:
                lines = text.split(b"\n")
                del lines[rng.randrange(len(lines))]
                text = b"\n".join(lines)
            case 7:
                text = text[:a] + rng.choice(_NUMBERS) + text[b:]
            case 8 | 9:
                text = _replaced(rng, text, _NUMBER, rng.choice(_NUMBERS))
            case 10 | 11:
                word = rng.choice(words).encode("utf-8", "surrogatepass")
                text = _replaced(rng, text, _WORD, word)
            case _:
                text = text[: max(a, 1)]
    return text[:LONGEST]


def _replaced(rng: random.Random, text: bytes, what: re.Pattern[bytes], by: bytes) -> bytes:
    """With one of what matches replaced, at random."""
    found = list(what.finditer(text))
    if not found:
        return text
    one = rng.choice(found)
    return text[: one.start()] + by + text[one.end() :]
