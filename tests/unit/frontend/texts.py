"""Hypothesis strategies for right models, laid out in odd ways."""

from __future__ import annotations

import re
from random import Random

from hypothesis import strategies as st

names = st.sampled_from(
    "a b R1 el x_y port in out model if for let when counts unknown theta else int turn".split()
)
types = st.sampled_from("R C I TF GY Se MSe De Cell port".split())
units = st.sampled_from(["m", "Ohm", "N.m.s/rad", "m^3/s.Pa^-0.5", "1/s", "kg.m^2", "s^-1", "°C"])
numbers = st.sampled_from(["0", "1", "2", "0.5", "3.51e-3", "1E5", "25"])
quantities = numbers | st.builds("{} {}".format, numbers, units)


def _join(
    separator: str, low: int, high: int, part: st.SearchStrategy[str]
) -> st.SearchStrategy[str]:
    return st.lists(part, min_size=low, max_size=high).map(separator.join)


def _optional(part: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    return st.just("") | part


def _deeper(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    return st.one_of(
        st.builds("({})".format, inner),
        st.builds(
            "{}({})".format, st.sampled_from(["sin", "if", "table"]), _join(", ", 0, 3, inner)
        ),
        st.builds("{}[{}].f".format, names, inner),
        st.builds(
            "({}){}({})".format,
            inner,
            st.sampled_from([" + ", " - ", "*", "/", "^", " < ", "<-", " == ", " and ", " or "]),
            inner,
        ),
        st.builds("-({})".format, inner),
        st.builds("(not ({}))".format, inner),
        st.builds("x - {}*y/{}".format, quantities, quantities),
        st.builds("{} / x^-{}".format, quantities, numbers),
        st.builds("-{}^2 <= - -z".format, names),
    )


refs = st.builds(
    "{}{}".format, names, st.sampled_from(["", ".e", "[1].f", "[1..2]", "[i - 1].q.x"])
)
values = st.recursive(
    quantities | refs | st.just('"a # b.csv"') | st.just("true"), _deeper, max_leaves=6
)
sums = st.builds("{} + {}".format, values.map("({})".format), values.map("({})".format))
tolerances = _optional(
    st.builds(" +- {}{}".format, numbers, st.sampled_from(["%", " %", " m", ""]))
)
arguments = _optional(
    _join(", ", 1, 3, st.builds("{} = {}".format, refs, values)).map("({})".format)
)
laws = _optional(
    _join("; ", 1, 2, st.builds("{} = {}".format, values, values)).map(" {{ port x; {} }}".format)
    | _join("\n", 1, 2, st.builds("{} = {}".format, values, values)).map(" {{\n{}\n}}".format)
)
nodes = st.one_of(
    refs,
    st.builds("{}:{}".format, st.sampled_from("01"), names),
    st.builds("{}:{}{}{}".format, types, names, arguments, laws),
    st.builds("{}:{}{} = ({}){}{}".format, types, names, arguments, values, tolerances, laws),
)
arrows = st.sampled_from([" -> ", " <- ", "->", "<-", " -[7]-> ", " <-[ a1 ]- ", " ->\n\n "])
bonds = st.lists(st.tuples(arrows, nodes), min_size=1, max_size=4).map(
    lambda pairs: "".join(a + n for a, n in pairs)
)
chains = st.builds("{}{}".format, nodes, bonds)
plain = st.one_of(
    chains,
    st.builds(
        "{} {} = {}{}".format, st.sampled_from(["param", "const"]), names, values, tolerances
    ),
    st.builds("param {} : {}".format, names, units),
    st.builds("input {}[2] : {} unknown".format, names, units),
    st.builds("input {} : bool".format, names),
    st.builds("sensor {} : {} = {} counts ({})/turn".format, names, units, values, values),
    st.builds("let {} =\n {}".format, names, sums),
    st.builds(
        "fault {} : {} {} {}".format, names, refs, st.sampled_from(["=", "+=", "*="]), values
    ),
    st.builds("port {} : {} {}".format, names, st.sampled_from(["in", "out"]), names),
)
separators = st.sampled_from(
    [
        "\n",
        "\n",
        "; ",
        ";",
        "\n\n\n",
        "\n \t\n",
        " # why\n",
        "\n## doc\n",
        "\n# own\n\n# more\n",
        "  ## x\n",
    ]
)
openings = st.sampled_from([" {", " { ", " {\n", " { # opened\n", " {\n\n# first\n\n"])
closings = st.sampled_from(["}", " }", "\n}", "\n\n}", "; }", "\n# last\n}", " # last\n}"])


@st.composite
def _bodies(draw: st.DrawFn, part: st.SearchStrategy[str]) -> str:
    body = draw(openings)
    for number, statement in enumerate(draw(st.lists(part, max_size=3))):
        body += (draw(separators) if number else "") + statement
    return body + draw(closings)


def _blocks(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    body = _bodies(inner)
    free = _bodies(inner | bonds)
    return st.one_of(
        st.builds("1:{}{}".format, names, free),
        st.builds("0:{} when {}{}".format, names, values, free),
        st.builds("x[{}].j{}".format, values, free),
        st.builds("{}{} -> 1:{}{}".format, nodes, bonds, names, free),
        st.builds("{} <- m[{}].j{}".format, nodes, values, free),
        st.builds("a ->\n 0:{} when {}{}".format, names, values, free),
        st.builds("1:{} {{ -> 0:{}{} }}".format, names, names, free),
        st.builds("for j in {}..{}{}".format, sums, values, body),
        st.builds("if ({}){} else{}".format, values, body, body),
        st.builds("if ({}){}\nelse if (a){}".format, values, body, body),
    )


statements = st.recursive(plain, _blocks, max_leaves=6)


@st.composite
def models(draw: st.DrawFn) -> str:
    """A right file: anything the language allows, laid out as carelessly as it allows."""
    text = draw(st.sampled_from(["bg 1\n", "## doc\nbg 1 # one\n\n\n", "bg 1; "]))
    text += draw(st.sampled_from(["", 'import A,\n B from "x.bg"\n']))
    for name in draw(st.lists(names, min_size=1, max_size=2)):
        text += draw(st.sampled_from(["", "## Of it.\n", "\n# c\n"])) if text[-1] == "\n" else ""
        generics = draw(st.sampled_from(["", "(n : int = 1)", "(n:int,\n fast : bool = a<-1)"]))
        text += f"model {name}{generics}" + draw(_bodies(statements)) + draw(_ends)
    return _blur(text, draw(st.randoms(use_true_random=False)))


_ends = st.sampled_from(["\n", "\n\n\n", " # end\n"])


def _blur(text: str, chance: Random) -> str:
    """The text with other blanks, line ends and comments where they mean nothing."""
    blanks = [" ", " ", "  ", "\n", "\n\n    ", " # note\n", "\t", "\n# own line\n"]
    pieces = re.split(r'((?<=[,+=]) (?![^"\n]*"))', text)
    return "".join(chance.choice(blanks) if p == " " else p for p in pieces)
