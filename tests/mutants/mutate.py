"""Small semantic mutants of Python code: one operator, constant, condition or statement is changed.

Nothing that a test need not see is touched: docstrings, annotations, assertions, `raise`,
`__repr__`, texts (of messages, too), what only a type checker reads, and numbers that have a name
as they are a matter of choice (`_FEW = 3`).
"""

from __future__ import annotations

import ast
import copy
import hashlib
from collections import Counter
from collections.abc import Callable, Iterator
from typing import NamedTuple

_COMPARED: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
    ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
_COMPUTED: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
}  # fmt: skip
_RENAMED = {"min": "max", "max": "min", "any": "all", "all": "any", "reversed": "iter"}
_REMOVED = {
    "add", "append", "appendleft", "clear", "discard", "extend", "heappush", "insert", "pop",
    "remove", "setdefault", "sort", "update",
}  # fmt: skip
#: What makes words for people: what stands in its arguments is not mutated.
_WORDS = {"Diagnostic", "CompileError", "Label", "ValueError", "error", "info", "warning"}
_UNTOUCHED = {"__repr__", "__str__"}

#: Constants up to this are counts, indices and orders; larger ones are limits somebody chose.
_SMALL = 9


class Mutant(NamedTuple):
    """One change of one module; `line` counts from 1, `start` and `end` are bytes of the source."""

    module: str
    function: str
    line: int
    text: str
    change: str
    start: int
    end: int
    new: str

    @property
    def key(self) -> tuple[str, str, str]:
        """What tells mutants apart however the lines move: module, text of the line, change."""
        return self.module, self.text, self.change

    def rank(self, seed: int) -> str:
        """Where a draw by chance puts this mutant; other mutants do not count."""
        return hashlib.sha256(repr((seed, self.function, *self.key)).encode()).hexdigest()

    def applied(self, source: bytes) -> bytes:
        """The module with the change."""
        return source[: self.start] + self.new.encode() + source[self.end :]


def mutants(module: str, source: bytes) -> list[Mutant]:
    """All mutants of a module, in the order of its text.

    >>> [m.change for m in mutants("m.py", b"def f(a, b):\\n    return a < b\\n")]
    ['return a < b -> return None', 'a < b -> a <= b']
    """
    lines = source.splitlines(keepends=True)
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line))
    found: dict[tuple[int, int, str], Mutant] = {}
    times: Counter[tuple[str, str]] = Counter()
    for function, (old, new) in _changes(ast.parse(source)):
        assert old.end_lineno is not None and old.end_col_offset is not None
        start = starts[old.lineno - 1] + old.col_offset
        end = starts[old.end_lineno - 1] + old.end_col_offset
        text = ast.unparse(new)
        change = f"{_short(ast.unparse(old))} -> {_short(text)}"
        written = f"({text})" if isinstance(new, ast.expr) else text
        here = lines[old.lineno - 1].decode().strip()
        if source[start:end] == text.encode() or (start, end, text) in found:
            continue
        times[here, change] += 1
        if times[here, change] > 1:  # the same change elsewhere in the same line, or a like one
            change += f" #{times[here, change]}"
        mutant = Mutant(module, function, old.lineno, here, change, start, end, written)
        found[start, end, text] = mutant
    return list(found.values())


def _short(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= 70 else text[:50] + " ... " + text[-15:]


_Node = ast.expr | ast.stmt
_Change = tuple[_Node, _Node]


def _changes(
    node: ast.AST, path: tuple[str, ...] = (), local: bool = False
) -> Iterator[tuple[str, _Change]]:
    """The function and what is put in whose place, of a node and of all below it."""
    if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
        path = (*path, *(["<locals>"] if local else []), node.name)
        local = isinstance(node, ast.FunctionDef)
        if node.name in _UNTOUCHED or _only_says(node):
            return
    if _left_alone(node):
        return
    for mutation in MUTATIONS:
        for change in mutation(node):
            yield ".".join(path) or "<module>", change
    for name, value in ast.iter_fields(node):
        if name not in ("annotation", "returns", "decorator_list", "bases", "pattern"):
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST):
                    yield from _changes(child, path, local)


def _only_says(node: ast.FunctionDef | ast.ClassDef) -> bool:
    """Whether a function does nothing: docstring, `...` and `raise` are all that it has."""
    return all(
        isinstance(s, (ast.Raise, ast.Pass))
        or (isinstance(s, ast.Expr) and isinstance(s.value, ast.Constant))
        for s in node.body
    )


def _left_alone(node: ast.AST) -> bool:
    """What changes nothing that is computed, or only what an error says."""
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return True
    if isinstance(node, (ast.Assert, ast.Raise, ast.JoinedStr, ast.Import, ast.ImportFrom)):
        return True
    if isinstance(node, ast.AugAssign) and _is_text(node.value):
        return True
    if isinstance(node, ast.keyword) and node.arg == "strict":  # of zip: an assertion
        return True
    if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant):
        return isinstance(node.targets[0], ast.Name) and node.targets[0].id.isupper()
    if isinstance(node, ast.If) and isinstance(node.test, ast.Name):
        return node.test.id == "TYPE_CHECKING"
    return isinstance(node, ast.Call) and _name(node) in _WORDS


def _name(call: ast.Call) -> str:
    if isinstance(call.func, ast.Attribute):
        return call.func.attr
    return call.func.id if isinstance(call.func, ast.Name) else ""


def _is_text(node: ast.AST) -> bool:
    """Whether an operand is seen to be no number, so that another operator would only crash."""
    if isinstance(node, ast.BinOp):
        return _is_text(node.left) or _is_text(node.right)
    if isinstance(node, ast.Constant):
        return isinstance(node.value, str | bytes)
    return isinstance(node, (ast.JoinedStr, ast.List, ast.Tuple, ast.ListComp, ast.Dict))


def comparison(node: ast.AST) -> Iterator[_Change]:
    """`<` and `<=`, `==` and `!=`, `is` and `is not`, `in` and `not in` are swapped."""
    if isinstance(node, ast.Compare):
        for i, op in enumerate(node.ops):
            new = copy.deepcopy(node)
            new.ops[i] = _COMPARED[type(op)]()
            yield node, new


def arithmetic(node: ast.AST) -> Iterator[_Change]:
    """`+` and `-` are swapped, `*` and `/`; also in `+=`."""
    if isinstance(node, ast.BinOp) and type(node.op) in _COMPUTED:
        if not (_is_text(node.left) or _is_text(node.right)):
            yield node, ast.BinOp(node.left, _COMPUTED[type(node.op)](), node.right)
    elif isinstance(node, ast.AugAssign) and type(node.op) in _COMPUTED:
        yield node, ast.AugAssign(node.target, _COMPUTED[type(node.op)](), node.value)


def connective(node: ast.AST) -> Iterator[_Change]:
    """`and` and `or` are swapped."""
    if isinstance(node, ast.BoolOp):
        other = ast.Or() if isinstance(node.op, ast.And) else ast.And()
        yield node, ast.BoolOp(other, node.values)


def constant(node: ast.AST) -> Iterator[_Change]:
    """A small number becomes one more, an index 0 the last, True False."""
    if isinstance(node, ast.Subscript):
        index = ast.unparse(node.slice)
        of_node = isinstance(node.value, ast.Attribute) and node.value.attr == "args"
        if index in ("0", "-1") and not of_node:  # most nodes have one argument, first and last
            other = ast.parse("-1" if index == "0" else "0", mode="eval").body
            yield node, ast.Subscript(node.value, other, node.ctx)
    elif isinstance(node, ast.Constant):
        value = node.value
        if isinstance(value, bool):
            yield node, ast.Constant(not value)
        elif isinstance(value, int | float) and abs(value) <= _SMALL and value == int(value):
            yield node, ast.Constant(value + 1)


def condition(node: ast.AST) -> Iterator[_Change]:
    """What is asked by `if` or `while`, also inside of expressions, is negated."""
    tests: list[ast.expr] = []
    if isinstance(node, (ast.If, ast.While, ast.IfExp)):
        tests = [node.test]
    elif isinstance(node, ast.comprehension):
        tests = node.ifs
    elif isinstance(node, ast.match_case) and node.guard is not None:
        tests = [node.guard]
    for test in tests:
        if not (isinstance(test, ast.UnaryOp) or _has_opposite(test)):
            yield test, ast.UnaryOp(ast.Not(), test)


def _has_opposite(test: ast.expr) -> bool:
    """Whether a swapped comparison is the negation already."""
    if not isinstance(test, ast.Compare) or len(test.ops) > 1:
        return False
    return not isinstance(test.ops[0], (ast.Lt, ast.LtE, ast.Gt, ast.GtE))


def sign(node: ast.AST) -> Iterator[_Change]:
    """`-x` and `not x` become `x`."""
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.Not)):
        yield node, node.operand


def call(node: ast.AST) -> Iterator[_Change]:
    """`min` and `max`, `any` and `all` are swapped; `reversed` is left out."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in _RENAMED:
        name = ast.Name(_RENAMED[node.func.id], ast.Load())
        yield node, ast.Call(name, node.args, node.keywords)


def returned(node: ast.AST) -> Iterator[_Change]:
    """A function returns nothing."""
    if isinstance(node, ast.Return) and not isinstance(node.value, ast.Constant | None):
        yield node, ast.Return(ast.Constant(None))


def removed(node: ast.AST) -> Iterator[_Change]:
    """`continue`, `break`, `+=` are left out, and what puts something into a collection."""
    if isinstance(node, (ast.Continue, ast.Break, ast.AugAssign)):
        yield node, ast.Pass()
    elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        if _name(node.value) in _REMOVED:
            yield node, ast.Pass()
    elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Subscript):
        yield node, ast.Pass()


MUTATIONS: tuple[Callable[[ast.AST], Iterator[_Change]], ...] = (
    comparison, arithmetic, connective, constant, condition, sign, call, returned, removed,
)  # fmt: skip
