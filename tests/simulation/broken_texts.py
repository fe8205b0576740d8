"""Makes broken scenarios: seeded, from sound ones, by changing words and lines."""

from __future__ import annotations

import random
import re

MOTOR = """
doc = "A motor with everything that a scenario can say"
name = "all"
duration = "0.05 s"
seed = 3
spread = "uniform"
method = "auto"
tolerance = 1e-6
quasi_static = ["L"]
record = ["brake.f"]

[parameters]
R = "2 Ohm"
J = 0.01

[initial]
"J.p" = "0.1 N.m.s"

[inputs]
load = { table = [[0, 0], ["20 ms", "1 mN.m"], [0.04, 0]], hold = "previous" }

[sampling]
rate = "1 kHz"
jitter = 0.1
lost = 0.01

[sensors.all]
noise = 0.01

[sensors."speed"]
step = "0.05 rad/s"
bias = 0.1
rate = "100 Hz"

[[controller]]
input = "U"
measures = "speed"
setpoint = "20*(1 + 0.1*sin(2*pi*t))"
kp = "0.1 V.s/rad"
ki = 1
kd = 0.001
period = "2 ms"
limits = [-5, "5 V"]
speed = false

[[fault]]
of = "R"
change = "+= 10 Ohm"
at = "10 ms"
ramp = "5 ms"

[[fault]]
of = "current"
change = "stuck"
at = 0.02
until = 0.03
period = "4 ms"
duty = 0.25
label = "a loose wire"

[desired]
speed = 20
"""

OVEN = """
duration = 2
sampling.rate = 20
inputs.P = "if(t > 1, 100*abs(sin(3*t)), min(t, 2)*1 W) "
inputs.on = "t > 0.5 and not (t >= 1.5)"
inputs.Ta = 290
[initial]
'Ch.q' = 300.0
"Co.q" = "100 J"
[[fault]]
of = 'To'
change = "missing"
[[fault]]
of = 'Gh'
change = "= 3 W/K"
at = 1
[[fault]]
of = 'on'
change = "= true"
at = 1
period = 0.5
"""

#: Whole values, most of them wrong in most places.
_VALUES = """0|1|-1|1e400|nan|inf|-inf|1e-300|99999999999999999999|true|false|""|"t"|"5 V"|"5 N"
"3 s"|"1 kHz"|"1/0"|"sqrt(-1)"|"log(t-1)"|"x"|"R"|"R/0"|"if(t>1,2"|"if(t>1,2,3)"|"t^999"|"(("|"é"
"\\n"|"1 V + 1 A"|"table(1,t)"|"int(t)"|"der(t)"|"speed"|"L.f"|"stuck"|"missing"|"+= "|"*= 0"
"= 1e999"|"-= 1 Ohm"|"+= R"|"*= 1 Ohm"|"t > 1"|"t == t"|"sign(t-1e-9)"|"exp(1e6*t)"|"1/(t-0.5)"
[]|[1]|[[0,0]]|[[1,0],[0,1]]|[[0,0],[1]]|{}|{table=[[0,1]]}|{table=[["1 s","1"],["2 s",2]]}
{file="no.csv"}|{file="no.csv",column="U"}|{hold="previous"}|{table=3}|{table=[[nan,1],[nan,2]]}
1979-05-27|07:32:00|0x1F|1_000|'U'|["L", 1]|[nan, nan]|[5, -5]|["U", "U"]""".replace(
    "\n", "|"
).split("|")

#: Pieces of the notation, for anywhere.
_WORDS = (
    "= [ ] { } # . , ' [[fault]] [[controller]] [inputs] [sensors.all] [plane] [fault] event of "
    "change at until ramp period duty kp ki limits speed measures setpoint input noise step bias "
    "rate table file column U load current seed duration method \x00 \ufeff \t"
).split(" ")

_TOKEN = re.compile(r'\s+|"[^"\n]*"|\'[^\'\n]*\'|[\w.+-]+|.')


def broken(seed: int, text: str) -> str:
    """A scenario with some words or lines changed, the same one for the same seed."""
    draw = random.Random(seed)
    for _ in range(draw.choice((1, 1, 1, 2, 2, 3, 6))):
        text = draw.choice((_value, _value, _value, _swap, _name, _word, _line, _cut))(draw, text)
    return text


def _value(draw: random.Random, text: str) -> str:
    """A value that may be of another kind."""
    pairs = list(re.finditer(r"= *(.+)", text))
    if not pairs:
        return text
    one = draw.choice(pairs)
    word = draw.choice(_VALUES)
    return text[: one.start(1)] + word + text[one.end(1) :]


def _name(draw: random.Random, text: str) -> str:
    """A key or a table of another name."""
    found = list(re.finditer(r"(?<=\n)[\[\w\"'.]+", text))
    if not found:
        return text
    one, other = draw.choice(found), draw.choice(found)
    name = draw.choice((other[0], one[0][:-1], one[0] + "x"))
    return text[: one.start()] + name + text[one.end() :]


def _word(draw: random.Random, text: str) -> str:
    words = _TOKEN.findall(text)
    if not words:
        return text
    k = draw.randrange(len(words))
    words[k] = draw.choice(("", draw.choice(_WORDS), draw.choice(words), words[k] + words[k]))
    return "".join(words)


def _line(draw: random.Random, text: str) -> str:
    lines = text.splitlines(keepends=True)
    k = draw.randrange(len(lines) + 1)
    if draw.random() < 0.5 and k < len(lines):
        del lines[k]
    else:
        lines.insert(k, draw.choice([*lines, f"{draw.choice(_WORDS)} = {draw.choice(_WORDS)}\n"]))
    return "".join(lines)


def _swap(draw: random.Random, text: str) -> str:
    """The value of another key."""
    pairs = list(re.finditer(r"= *(.+)", text))
    if len(pairs) < 2:
        return text
    one, other = draw.sample(pairs, 2)
    return text[: one.start(1)] + other[1] + text[one.end(1) :]


def _cut(draw: random.Random, text: str) -> str:
    k = draw.randrange(len(text) + 1)
    return text[:k] + text[k + draw.randrange(12) :]
