"""Reads expressions, quantities, references and units."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Final

from bondgraph.frontend.cursor import Cursor, SyntaxProblem
from bondgraph.frontend.words import NOT_UNITS, RESERVED, say
from bondgraph.ir import syntax
from bondgraph.text.diagnostic import Label, replacing
from bondgraph.text.limits import BRACKETS, DIGITS, OPERATORS
from bondgraph.text.source import Span

_POWER: Final = r"(?:\^-?[0-9]++(?:\.[0-9]++)?+(?!\w))?+"
_FACTOR: Final = rf"(?:(?:°|[^\W\d])\w*+|1(?![\w]|\.[0-9])){_POWER}"
#: A unit as it stands in a text.
UNIT: Final = re.compile(rf"{_FACTOR}(?:[./]{_FACTOR})*+")

_LEVEL: Final = {
    "or": 1, "and": 2, "<": 4, "<=": 4, ">": 4, ">=": 4, "==": 4, "!=": 4, "<-": 4,
    "+": 5, "-": 5, "*": 6, "/": 6, "^": 8,
}  # fmt: skip
_NOT_LEVEL: Final = 3
_COMPARISON: Final = 4
_SUM: Final = 5
_SIGN_LEVEL: Final = 7
_POWER_LEVEL: Final = 8

_OPERAND_HELP: Final = "Write a number, a name, a call or brackets here."


class Expressions(Cursor):
    """The part of the parser that reads values."""

    #: whether `<-` outside brackets is an arrow: only in the value of a node
    arrow_ends = False
    #: operators above one another in the expression just read
    height = 0

    def expression(self) -> syntax.Expression:
        """Any expression; in it, `x<-1` is less-than, minus."""
        before, self.arrow_ends = self.arrow_ends, False
        try:
            return self._binary(1)
        finally:
            self.arrow_ends = before

    def node_value(self) -> syntax.Expression:
        """The value of a node, which an arrow may follow."""
        self.arrow_ends = True
        try:
            return self._binary(1)
        finally:
            self.arrow_ends = False

    def _binary(self, level: int, minus: bool = False) -> syntax.Expression:
        """Operators of `level` and above; `minus`: a leading minus has already been taken."""
        first = self.i
        words = self.words
        self.depth += 1
        if self.depth > BRACKETS:
            raise self.too_deep(first)
        if minus or words[first] == "-":
            if not minus:
                self.notes.signs.append(first)
                self.i = first + 1
            operand = self._binary(_SIGN_LEVEL)
            left: syntax.Expression = syntax.Unary(
                "-", operand, self.span(first - 1 if minus else first)
            )
            self.height += 1
        elif words[first] == "not" and level <= _NOT_LEVEL:
            self.i = first + 1
            left = syntax.Unary("not", self._binary(_NOT_LEVEL), self.span(first))
            self.height += 1
        else:
            left = self._primary()
        height = self.height
        while True:
            at = self.i
            op = words[at]
            power = _LEVEL.get(op, 0)
            if power < level or not power or (self.fresh[at] and not self.brackets):
                break
            if op == "<-":
                if self.arrow_ends and not self.brackets:
                    break
                self.notes.less_minus.append(at)
                op = "<"
                self.i = at + 1
                right = self._binary(_SUM, minus=True)
            else:
                self.i = at + 1
                right = self._binary(_SIGN_LEVEL if power == _POWER_LEVEL else power + 1)
            height = max(height, self.height) + 1
            if height > OPERATORS:
                raise self.too_deep(at)
            left = syntax.Binary(op, left, right, self._from(left, right))
            if power == _COMPARISON and _LEVEL.get(words[self.i]) == _COMPARISON:
                self._no_second_comparison()
        self.height = height
        self.depth -= 1
        return left

    def _from(self, left: syntax.Expression, right: syntax.Expression) -> Span:
        return Span(self.source, left.origin[1], max(right.origin[2], self._end()))

    def _end(self) -> int:
        last = self.i - 1
        return self.starts[last] + len(self.words[last])

    def _no_second_comparison(self) -> None:
        at = self.i
        if (self.fresh[at] and not self.brackets) or (
            self.words[at] == "<-" and self.arrow_ends and not self.brackets
        ):
            return
        raise self.problem(
            "comparison-chain",
            "A comparison cannot be compared again.",
            at,
            "a second comparison",
            help="Write `a < b and b < c`.",
        )

    def too_deep(self, at: int) -> SyntaxProblem:
        """The complaint about brackets in brackets in brackets."""
        return self.problem(
            "nesting-too-deep",
            f"Brackets or braces are nested more than {BRACKETS} deep, or more than {OPERATORS} "
            "operators stand in one expression.",
            at,
            "too deep from here on",
            help="Give parts of a long expression a name with `let`; split a model with so many "
            "braces.",
        )

    # -------------------------------------------------------------- operands

    def _primary(self) -> syntax.Expression:
        at = self.i
        word = self.words[at]
        if self.fresh[at] and word and (self.words[at + 1] == ":" or self.begins_statement(at)):
            raise self.unexpected("a value", _OPERAND_HELP)  # the next line is another statement
        if word.isidentifier():
            self.height = 0
            called = self.words[at + 1] == "(" and (self.brackets or not self.fresh[at + 1])
            if called and word not in RESERVED:
                return self._call()
            if word == "true" or word == "false":
                self.i = at + 1
                return syntax.Truth(word == "true", self.span(at))
            if word == "if" and not self.fresh[at]:
                from bondgraph.frontend.habits import choice  # only for a message

                after = self.words[at + 1]
                if after[:1].isalnum() or after == "-":  # `if` may be the name of a value
                    raise self.unexpected("a value", choice(self, at) or _OPERAND_HELP)
            if word in RESERVED:
                raise self.unexpected(
                    "a value",
                    f"Put brackets around it: `({word} ...)`." if word == "not" else _OPERAND_HELP,
                )
            return self.ref()
        first = word[:1]
        if first and first in "0123456789":
            self.height = 0
            return self.quantity()
        if first == "(":
            return self._bracketed()
        if first == '"' and len(word) > 1 and word[-1] == '"':
            self.height = 0
            self.i = at + 1
            return syntax.Text(word[1:-1], self.span(at))
        if first == "+" and len(word) == 1:
            raise self.unexpected("a value", "Leave out the plus sign: a value needs none.")
        raise self.unexpected("a value", _OPERAND_HELP)

    def _bracketed(self) -> syntax.Expression:
        opening = self.i
        self.notes.groups.append(opening)
        self.i += 1
        self.brackets += 1
        inner = self._binary(1)
        self.close(")", opening, "`)`")
        return inner

    def _call(self) -> syntax.Expression:
        at = self.i
        if self.careful:
            self.check_name(at)
        self.i = at + 2
        self.brackets += 1
        arguments: list[syntax.Expression] = []
        height = 0
        if self.words[self.i] != ")":
            while True:
                arguments.append(self._binary(1))
                height = max(height, self.height)
                if self.words[self.i] != ",":
                    break
                self.i += 1
        self.close(")", at + 1, "`,` or `)`")
        self.height = height + 1
        return syntax.Call(self.words[at], tuple(arguments), self.span(at))

    def close(self, bracket: str, opening: int, wanted: str) -> None:
        """Take the closing bracket of the one opened at word `opening`."""
        at = self.i
        if self.words[at] == bracket:
            self.i = at + 1
            self.brackets -= 1
            return
        opened = self.words[opening]
        odd = self.odd_word(at)
        if odd is not None:
            raise odd
        if self.fresh[at] or self.words[at] in ("", "{", "}", ";"):
            raise SyntaxProblem(
                "syntax-unclosed",
                f"The bracket `{opened}` is not closed.",
                (
                    Label(self.word_span(opening), "opened here"),
                    Label(self.word_span(at), f"{wanted} expected before this"),
                ),
                replacing(self.end_of(at - 1), bracket, f"Close it with `{bracket}`."),
                at,
            )
        here = say(self.words[at])
        from bondgraph.frontend.habits import choice, factor  # only for a message

        help = choice(self, at) or factor(self, at) or (
            f"Close the bracket with `{bracket}`, or check what stands before {here}."
        )
        raise self.unexpected(wanted, help, Label(self.word_span(opening), "opened here"))

    def ref(self) -> syntax.Ref:
        """A dotted reference, `m[1].el.Re`."""
        at = self.i
        words = self.words
        part = self.part("a name", "Write the name of a value, of a node or of a port.")
        if words[self.i] != ".":
            return syntax.Ref((part,), part.origin)
        parts = [part]
        while words[self.i] == "." and not (self.fresh[self.i] and not self.brackets):
            self.i += 1
            self.same_line("a name after the point", "Write for instance `rotor.f`.")
            parts.append(self.part("a name after the point", "Write for instance `rotor.f`."))
        return syntax.Ref(tuple(parts), self.span(at))

    def part(self, wanted: str, help: str) -> syntax.Part:
        """A name with or without an index."""
        at = self.i
        name = self.name(wanted, help)
        if self.words[at + 1] != "[" or (self.fresh[at + 1] and not self.brackets):
            return syntax.Part(name, None, None, self.span(at))
        height = self.height
        self.i += 1
        self.brackets += 1
        first = self._binary(1)
        last = None
        if self.words[self.i] == "..":
            self.i += 1
            last = self._binary(1)
        self.close("]", at + 1, "`]`")
        self.height = max(height, self.height) + 1
        return syntax.Part(name, first, last, self.span(at))

    # ------------------------------------------------------------- quantities

    def quantity(self) -> syntax.Number:
        """A number, with its unit if one follows after one space."""
        at = self.i
        word = self.words[at]
        if not word or word[0] not in "0123456789":
            raise self.unexpected("a number", "Write a number such as `0.5` or `3e-4`.")
        value = self._value(at)
        self.i = at + 1
        end = self.starts[at] + len(word)
        unit = None
        if self.starts[at + 1] == end + 1 and self.source.text[end] == " ":
            after = self.words[at + 1]
            if after.isidentifier():
                may_be = after not in NOT_UNITS or (after == "counts" and not self._counted(at + 2))
            else:
                may_be = not after.isascii() or (after == "1" and self.words[at + 2] in (".", "/"))
            if may_be:
                unit = self._unit()
        elif self.words[at + 1].isidentifier() and not self.fresh[at + 1]:
            glued = self.odd_word(at + 1)
            if glued is not None:
                raise glued
        return syntax.Number(value, unit, word, self.span(at))

    def _counted(self, at: int) -> bool:
        """Whether `counts` before word `at` begins the resolution of an encoder, and is no unit."""
        word = self.words[at]
        return (word[:1].isalnum() or word == "(") and not self.fresh[at]

    def _value(self, at: int) -> Fraction:
        word = self.words[at]
        if word.isdigit() and len(word) < DIGITS:
            return Fraction(int(word))
        mantissa, _, exponent = word.lower().partition("e")
        if len(mantissa) > DIGITS or len(exponent) > 9 or abs(int(exponent or "0")) > DIGITS:
            raise self.problem(
                "number-form",
                "This number has more digits or a larger exponent than any quantity of physics.",
                at,
                "this number",
                help=f"Exponents of ten go from -{DIGITS} to {DIGITS}.",
            )
        whole, _, digits = mantissa.partition(".")
        shift = int(exponent or "0") - len(digits)
        number = int(whole + digits)
        return Fraction(number * 10**shift) if shift >= 0 else Fraction(number, 10**-shift)

    def _unit(self) -> str | None:
        """The unit that begins at the cursor, without spaces in it; None if there is none."""
        first = self.i
        found = UNIT.match(self.source.text, self.starts[first])
        if found is None:
            return None
        end = found.end()
        at = first
        while self.words[at] and self.starts[at] < end:
            at += 1
        self.i = at
        self.notes.units.append((first, at))
        return found.group()

    def unit(self) -> str:
        """A unit that must be there, as after a colon."""
        word = self.words[self.i]
        if (word in NOT_UNITS and word != "counts") or (self.fresh[self.i] and not self.brackets):
            unit = None
        else:
            unit = self._unit()
        if unit is None:
            raise self.unexpected(
                "a unit", "Write a unit such as `V`, `N.m/rad` or `1` (for a plain number)."
            )
        return unit

    def tolerance(self) -> syntax.Tolerance | None:
        """`+- 5%` or `+- 2 Ohm` if it follows."""
        at = self.i
        if self.words[at] not in ("+-", "±") or self.fresh[at]:
            return None
        self.i = at + 1
        quantity = self.quantity()
        relative = False
        if quantity.unit is None:
            relative = self.keyword("%")
            if relative:
                quantity = quantity._replace(value=quantity.value / 100)
        return syntax.Tolerance(quantity, relative, self.span(at))
