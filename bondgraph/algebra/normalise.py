"""Bring a residual to its normal form: a sum of coefficients times p**k times an atom.

This is the canonical linear form over (known signal, derivative order): everything that cancels
cancels here, and exactly (the backlash torque of a drive leaves the first residual). A large
residual is not expanded, it becomes a tape of polynomials in p (`Tape`).
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import comb
from types import MappingProxyType
from typing import TypeAlias

from bondgraph.algebra.derivative import differentiate
from bondgraph.algebra.record import record
from bondgraph.algebra.zero import Constants
from bondgraph.ir.expr import CONSTANTS, ZERO_START, Expr, Kind, Op, Pool, topological
from bondgraph.ir.functions import FUNCTIONS
from bondgraph.ir.nodes import constant, decided, rebuilt
from bondgraph.ir.normal import NormalForm, Term

#: A linear form: coefficient by (atom, order of p).
Form: TypeAlias = dict[tuple[Expr, int], Expr]

#: So many products of a coefficient with another are made before the residual is called large.
LIMIT = 1500

_PRODUCT_LIMIT = 24  # terms that a product with a derivative in it is multiplied out to
_NONE: Mapping[Expr, Expr] = MappingProxyType({})
_SHORT = 6  # terms of a sum that is merged into another
_MERGE_LIMIT = 400  # nodes that may stand inside a nonlinear atom for it to be rewritten


class _TooLarge(Exception):
    """The residual has more terms than can be written out."""


def normalise(
    pool: Pool,
    expr: Expr,
    limit: int = LIMIT,
    initials: Mapping[Expr, Expr] = _NONE,
    held: bool = False,
) -> NormalForm:
    """The normal form of an expression of known signals, parameters, D and Int.

    Integrals are split from their declared initial values, D(y, k) and Int(y) of the same atom
    are collected, coefficients that are exactly zero are dropped. y**n D(y) and a few functions
    of y times D(y) become total derivatives. Beyond `limit` coefficient operations the result is
    a tape. `initials` gives the values of initial values where they are known. `held` says that
    boolean inputs stay as they are: if(on, D(x), 0) is D(if(on, x, 0)) then, and can be filtered.

    >>> p = Pool(); y = p.symbol("y", Kind.SENSOR); a = p.symbol("a", Kind.PARAM)
    >>> form = normalise(p, p.add((1, p.der(p.mul(a, y))), (3, y)))
    >>> [(t.atom, t.order, t.coefficient) for t in form.terms]
    [(y, 0, 3), (y, 1, a)]
    """
    expr = _at_rest(pool, expr)
    work = _Normaliser(pool, limit, initials, held)
    try:
        form = work.form(expr)
    except _TooLarge:
        return NormalForm((), record(pool, expr))
    found: dict[Expr, dict[int, Expr]] = {}
    for (atom, order), coefficient in form.items():
        exact = work.simplified(coefficient)
        if exact is not pool.zero:
            found.setdefault(atom, {})[order] = exact
    return NormalForm(
        tuple(
            Term(atom, order, orders[order], static(atom))
            for atom, orders in found.items()
            for order in sorted(orders)
        )
    )


def rewritten(
    pool: Pool, expr: Expr, limit: int = LIMIT, initials: Mapping[Expr, Expr] = _NONE
) -> Expr:
    """The expression with the arguments of every nonlinear part in their own normal form.

    Integrals are then integrals of single signals or nonlinear parts, from zero. An expression
    that is too large comes back as it is.
    """
    expr = _at_rest(pool, expr)
    work = _Normaliser(pool, limit, initials)
    try:
        work.form(expr)
    except _TooLarge:
        return expr
    return work.canonical(expr)


def static(node: Expr) -> bool:
    """Whether a value follows from one sample of the known signals and running integrals."""
    stack, seen = [node], {node}
    while stack:
        node = stack.pop()
        if node.op is Op.DER:
            return False
        if node.op is Op.INT and node.args[0].op is Op.DER:
            node = node.args[0]  # the change of a value since the start
        stack += [a for a in node.args if a not in seen]
        seen.update(node.args)
    return True


def _at_rest(pool: Pool, expr: Expr) -> Expr:
    """The expression with the derivatives of constants set to zero."""
    memo: dict[Expr, bool] = {}
    constant(expr, memo)
    if not any(node.op is Op.DER and memo[node.args[0]] for node in memo):
        return expr  # as nearly all are

    def stilled(node: Expr, args: tuple[Expr, ...]) -> Expr | None:
        return pool.zero if node.op is Op.DER and constant(args[0], memo) else None

    return rebuilt(pool, [expr], stilled)[0]


class _Normaliser:
    def __init__(
        self, pool: Pool, limit: int, initials: Mapping[Expr, Expr], held: bool = False
    ) -> None:
        self.pool = pool
        self.held = held
        self.initials = initials
        self.limit = limit
        self.work = 0
        self.start = pool.symbol(ZERO_START, Kind.INITIAL)
        self.constants = Constants({self.start: pool.zero})
        self._forms: dict[Expr, Form] = {}
        self._constant: dict[Expr, bool] = {}

    def form(self, expr: Expr) -> Form:
        """The linear form of an expression and of everything in it."""
        for node in topological([expr], stop=self._forms.__contains__):
            if node in self._forms:
                continue
            fixed = node.op is not Op.INT and all(self._constant[a] for a in node.args)
            if node.op is Op.SYM:
                fixed = node.symbol.kind in CONSTANTS
            self._constant[node] = fixed
            form = {(self.pool.one, 0): node} if fixed else self._combine(node)
            self._forms[node] = form
            self.work += len(form)
            if self.work > self.limit:
                raise _TooLarge
        return self._forms[expr]

    def simplified(self, coefficient: Expr) -> Expr:
        """The coefficient, or the number that it is."""
        value = self.constants.number(coefficient)
        return coefficient if value is None else self.pool.num(value)

    def _combine(self, node: Expr) -> Form:
        match node.op:
            case Op.ADD:
                form: Form = {}
                for c, arg in node.terms:
                    self._add(form, self._forms[arg], self.pool.num(c))
                return form
            case Op.MUL:
                return self._product(node)
            case Op.DER:
                inner = self._forms[node.args[0]]
                return self._shift(inner)
            case Op.INT:
                return self._integral(node)
            case Op.IF if self.held and not static(node) and decided(node.args[0]):
                return self._choice(node)
            case _:
                args = tuple(self.canonical(a) for a in node.args)
                return {(self.pool.rebuild(node, args), 0): self.pool.one}

    def _add(self, into: Form, form: Form, factor: Expr) -> None:
        for key, coefficient in form.items():
            term = self.pool.mul(factor, coefficient)
            old = into.get(key)
            into[key] = term if old is None else self._sum(old, term)
        self.work += len(form)

    def _sum(self, left: Expr, right: Expr) -> Expr:
        """A sum of two coefficients; short ones are merged, because like terms then meet."""
        terms: list[tuple[Fraction | int, Expr]] = []
        for side in (left, right):
            if side.op is Op.ADD and len(side.args) <= _SHORT:
                terms += side.terms
            else:
                terms.append((1, side))
        return self.pool.add(*terms)

    def _shift(self, form: Form) -> Form:
        out: Form = {}
        for (atom, order), coefficient in form.items():
            if atom is self.pool.one and order == 0:
                continue
            if atom.op is Op.INT and order == 0:  # an integral that could not be taken apart
                self._add(out, self.form(atom.args[0]), coefficient)
            else:
                self._add(out, {(atom, order + 1): coefficient}, self.pool.one)
        return out

    def _integral(self, node: Expr) -> Form:
        out: Form = {}
        if node.data != self.start.data:
            start = self.pool.symbol(node.symbol.name, node.symbol.kind)
            out[self.pool.one, 0] = self.initials.get(start, start)
        for (atom, order), coefficient in self._forms[node.args[0]].items():
            key = atom, order - 1
            if order > 0:  # Int(D(y)) is y without its value at the start
                key = self.pool.integral(self.pool.der(atom, order), self.start), 0
            self._add(out, {key: coefficient}, self.pool.one)
        return out

    def _choice(self, node: Expr) -> Form:
        """A choice by boolean inputs: what each branch adds, behind a switch of its own."""
        pool, condition = self.pool, node.args[0]
        out: Form = {}
        for position in (1, 2):
            for (atom, order), coefficient in self._forms[node.args[position]].items():
                key = self._term(atom, min(order, 0))
                both = (key, pool.zero) if position == 1 else (pool.zero, key)
                self._add(out, {(pool.choose(condition, *both), max(order, 0)): coefficient},
                          pool.one)  # fmt: skip
        return out

    # ----------------------------------------------------------- products

    def _product(self, node: Expr) -> Form:
        pool = self.pool
        pairs = list(node.factors)
        factor = pool.mul(*[pool.power(a, e) for a, e in pairs if self._constant[a]])
        varying = [(a, e) for a, e in pairs if not self._constant[a]]
        if len(varying) == 1 and varying[0][1] == 1:
            form: Form = {}
            self._add(form, self._forms[varying[0][0]], factor)
            return form
        plain = [(self.canonical(a), e) for a, e in varying]
        if all(static(a) for a, _ in plain):
            return self._collected(pool.mul(*[pool.power(a, e) for a, e in plain]), factor)
        return self._expanded(varying, plain, factor)

    def _collected(self, product: Expr, factor: Expr) -> Form:
        """A product after rewriting its factors, which may have brought numbers to the front."""
        number, product = product.scaled
        factor = self.pool.scale(number, factor)
        if product.op is Op.NUM:
            return {(self.pool.one, 0): self.pool.mul(factor, product)}
        return {(product, 0): factor}

    def _expanded(
        self, varying: list[tuple[Expr, int]], plain: list[tuple[Expr, int]], factor: Expr
    ) -> Form:
        """A product that holds derivatives, multiplied out as far as sums allow."""
        pool = self.pool
        rest = pool.one
        sums: list[Form] = []
        size = 1
        for (node, exponent), (rewritten, _) in zip(varying, plain, strict=True):
            form = self._forms[node]
            size *= max(len(form), 1) ** max(exponent, 1)
            if exponent > 0:
                sums += [form] * exponent
            else:
                rest = pool.mul(rest, pool.power(rewritten, exponent))
        if size > _PRODUCT_LIMIT:
            return self._collected(pool.mul(*[pool.power(a, e) for a, e in plain]), factor)
        monomials: list[tuple[Expr, tuple[tuple[Expr, int], ...]]] = [(factor, ())]
        for form in sums:
            monomials = [
                (pool.mul(c, d), (*keys, key)) for c, keys in monomials for key, d in form.items()
            ]
        out: Form = {}
        for coefficient, keys in monomials:
            self._add(out, self._monomial(keys, rest), coefficient)
        return out

    def _monomial(self, keys: tuple[tuple[Expr, int], ...], rest: Expr) -> Form:
        pool = self.pool
        keys = tuple(k for k in keys if k != (pool.one, 0))
        if len(keys) == 1 and rest is pool.one:
            return {keys[0]: pool.one}
        moving = [atom for atom, order in keys if order == 1]
        still = pool.mul(rest, *[self._term(a, k) for a, k in keys if k <= 0])
        if len(moving) == 1 and all(order <= 1 for _, order in keys):
            whole = self._total(still, moving[0])
            if whole is not None:
                factor, primitive = whole
                return {(primitive, 1): pool.num(factor)}
        parts = self._by_parts(keys, rest)
        if parts is not None:
            return parts
        return self._collected(pool.mul(rest, *[self._term(a, k) for a, k in keys]), pool.one)

    def _by_parts(self, keys: tuple[tuple[Expr, int], ...], rest: Expr) -> Form | None:
        """a p**k b = sum_j (-1)**j C(k, j) p**(k-j) (a^(j) b), where every a^(j) is static.

        So it is where a depends on an angle whose speed is measured: a(Int(w)) D(b) becomes
        D(a b) - a'(Int(w)) w b.
        """
        pool = self.pool
        moving = [(atom, order) for atom, order in keys if order > 0]
        if len(moving) != 1 or not static(moving[0][0]):
            return None
        atom, order = moving[0]
        out: Form = {}
        factor = pool.mul(rest, *[self._term(a, k) for a, k in keys if k <= 0])
        for j in range(order + 1):
            if j:
                factor = differentiate(pool, factor)
            if not static(factor):
                return None
            form = self.form(pool.mul(factor, atom))
            for _ in range(order - j):
                form = self._shift(form)
            self._add(out, form, pool.num((-1) ** j * comb(order, j)))
        return out

    def _total(self, factor: Expr, atom: Expr) -> tuple[Fraction, Expr] | None:
        """`factor` * D(`atom`) as number * D(...), where the factor is a function of the atom."""
        pool = self.pool
        number, factor = factor.scaled
        own, powers = dict(atom.factors), dict(factor.factors)
        if own.keys() == powers.keys():
            ratio, *others = {Fraction(powers[a], own[a]) for a in own}
            if not others and ratio.denominator == 1 and ratio != -1:
                return Fraction(number) / (ratio + 1), pool.power(atom, int(ratio) + 1)
        if factor.op is Op.FN and factor.args == (atom,) and factor.name in FUNCTIONS:
            found = FUNCTIONS[factor.name].integral
            return None if found is None else (number * found[0], pool.fn(found[1], atom))
        return None

    # ---------------------------------------------------------- rewriting

    def _term(self, atom: Expr, order: int) -> Expr:
        atom = self.pool.der(atom, order)
        for _ in range(-order):
            atom = self.pool.integral(atom, self.start)
        return atom

    def canonical(self, node: Expr) -> Expr:
        """The argument of an atom written from its own linear form, so that equals are one."""
        form = self._forms[node]
        if self._constant[node] or len(form) > _MERGE_LIMIT:
            return node
        terms = []
        for (atom, order), coefficient in form.items():
            exact = self.simplified(coefficient)
            if exact is not self.pool.zero:
                terms.append((1, self.pool.mul(exact, self._term(atom, order))))
        return self.pool.add(*terms)
