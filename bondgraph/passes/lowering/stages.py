"""The entry point that takes samples: every residual through one chain of first-order stages.

With H = 1/(1 + D/w) is D = w (1 - H)/H, so that D**k H**n = w**k H**(n-k) (1-H)**k: a residual
sum_k D**k g_k over (1 + D/w)**n is a polynomial in H whose coefficients are linear in the samples.
Horner's rule makes it r = H(v1 + H(v2 + ... + H vn)) + v0. What has the same order is summed first.

A stage is y = s + b u, then s = a y + b u (`Filter`). On the first sample s = 0, b = 1 and a is
minus what b is else: y = u, and what is kept is that of a stage at rest, so that `first` and `step`
are one and the same but for these numbers. D of a stage is the trapezoid rule: D T = 2
tanh(p T/2). Taken for p it is off by (p T)**2/12, and that is what remains of large terms that
cancel. But p = D (1 + (D T)**2/12) to fourth order, so that there is one filter F which all terms
pass, and each comes out as a polynomial in D:

    p**k F = D**k (1 - (K-k) (D T)**2/12),  F = 1 - K (D T)**2/12 + ...,

where K is the order of the residual: nothing of higher degree than n = K+1 is needed, so there is
neither a delay nor a memory more (docs/decisions/hold.md).
"""

from __future__ import annotations

from collections.abc import Callable

from bondgraph.ir.expr import Expr, Kind, Op
from bondgraph.ir.normal import Term
from bondgraph.ir.program import (
    Assign,
    Assignment,
    Const,
    Expression,
    Field,
    Product,
    Ref,
    Sum,
)
from bondgraph.ir.residuals import Residual
from bondgraph.passes.lowering.builder import Builder, Signal
from bondgraph.passes.lowering.exactly import label, total
from bondgraph.passes.lowering.filter import Filter
from bondgraph.passes.lowering.integrals import gathered
from bondgraph.passes.lowering.opening import Window
from bondgraph.passes.lowering.procedure import ONE, ZERO, Procedure, positive_part
from bondgraph.passes.lowering.program_names import Names, identifier, short

#: Says of a statement of `first` that it only empties the memory.
BEGIN = "nothing is remembered yet"


class Parts(dict[int, list[tuple[bool, Expression]]]):
    """Signed terms by a whole number: an order, a degree or a stage."""

    def add(self, at: int, sign: bool, value: Expression) -> None:
        """One term more."""
        self.setdefault(at, []).append((sign, value))


class Chain:
    """Writes `first` and `step` of one residual; nothing is shared with another residual."""

    def __init__(
        self,
        builder: Builder,
        filter: Filter,
        residual: Residual,
        stages: int,
        window: Window | None = None,
    ) -> None:
        self.builder = builder
        self.pool = builder.pool
        self.filter = filter
        self.residual = residual
        self.name = identifier(residual.name)
        self.origin = residual.closing.origin
        self.stages = stages
        #: Time constants of the filter in front of laws until they begin, and what counts them.
        self.held, self.begins = 0.0, ""
        self.first: list[Assignment] = []
        self._begun = 0  # statements of `first` that only empty the memory
        self.step: list[Assignment] = []
        self.states: list[Field] = []
        self.names = Names() if window is None else window.names
        self._angles: dict[Expr, Expression] = {}
        self._areas: dict[tuple[Procedure, Expr], Expression] = {}
        self._atoms: dict[Expr, Expression] = {}
        self._speeds: dict[tuple[str, str], Expression] = {}
        #: What all stages share, once it is there; chains that run together may share it too.
        self.gains: dict[str, Ref] = {}
        self._static = self._procedure(self._sample)

    # ---------------------------------------------------------- statements

    def run(self, terms: tuple[Term, ...], text: str) -> None:
        """Append the statements of the residual, made of the given terms, all of them static."""
        self.highest = max([max(t.order, 0) for t in terms], default=0)
        self._both(Assign(Ref("residual", self.name), self._output(terms), text, self.origin))

    def _output(self, terms: tuple[Term, ...]) -> Expression:
        """The sum of terms that hold no derivative, filtered."""
        outside: list[tuple[bool, Expression]] = []
        orders, speeds, bare = Parts(), Parts(), Parts()
        integrals: dict[int, list[Term]] = {}
        by_atom: dict[Expr, list[Term]] = {}
        for term in terms:
            if term.atom is self.pool.one and term.order == 0:
                # filtered like all else, so that a parameter in it may change at any time
                orders.add(0, *self._signed(term.coefficient, "constant", "constant part"))
            elif term.order < 0:
                integrals.setdefault(-term.order, []).append(term)
            else:
                by_atom.setdefault(term.atom, []).append(term)
        self._prepare([*by_atom, *[t.atom for level in integrals.values() for t in level]])
        for atom, own in by_atom.items():
            for term in own:
                self._enter(atom, term, orders, speeds, outside)
        if integrals:
            self._integrated(integrals, orders, bare)
        self._turned(speeds, bare)
        return self._horner(self._bent(orders, bare), outside)

    def _both(self, statement: Assignment) -> None:
        self.first.append(statement)
        self.step.append(statement)

    def _local(self, wish: str, value: Expression, comment: str) -> Expression:
        target = Ref("local", self.names.new(f"{self.name}_{wish}"))
        self._both(Assign(target, value, comment, self.origin))
        return target

    def _state(self, wish: str, doc: str) -> Ref:
        name = self.names.new(f"{self.name}_{wish}")
        self.states.append(Field(name, "", "", doc, None, self.origin))
        return Ref("state", name)

    def _stage(self, entry: Expression, wish: str, comment: str) -> Expression:
        """One first-order stage: its output at this sample."""
        return self._through(self.filter, entry, wish, comment)

    def _through(self, filter: Filter, entry: Expression, wish: str, comment: str) -> Expression:
        """One first-order stage of some filter."""
        a, b = self._gains(filter)
        state = self._empty(f"s{wish}", f"memory of {comment}")
        output = Ref("local", self.names.new(f"{self.name}_y{wish}"))
        new = Product((b, entry))
        self._both(Assign(output, plus(state, new), comment, self.origin))
        kept = plus(Product((a, output)), new)
        self._both(Assign(state, kept, comment, self.origin))
        return output

    def _gains(self, filter: Filter) -> tuple[Ref, Ref]:
        """a and b of a stage: those of a stage at rest on the first sample."""
        names = f"{filter.of}a", f"{filter.of}b"
        if names[0] not in self.gains:
            a, b = filter.coefficients(self.builder)
            start: Expression = Product((Const(-1.0), b))
            pairs = zip(names, ((a, start), (b, ONE)), strict=True)
            for at, (name, (usual, at_first)) in enumerate(pairs):
                gain = self.gains[name] = Ref("local", self.names.new(f"{self.name}_{name}"))
                comment = f"{self.name}: a stage of the filter; on the first sample it is at rest"
                self.step.insert(at, Assign(gain, usual, comment, self.origin))
                self.first.insert(self._begun + at, Assign(gain, at_first, comment, self.origin))
        return self.gains[names[0]], self.gains[names[1]]

    def _empty(self, wish: str, doc: str) -> Ref:
        """A state that is 0 at the start."""
        state = self._state(wish, doc)
        self.first.insert(self._begun, Assign(state, ZERO, BEGIN, self.origin))
        self._begun += 1
        return state

    def _signed(self, value: Expr, wish: str, doc: str) -> tuple[bool, Expression]:
        sign, size = positive_part(self.pool, value)
        doc = f"{self.residual.name}: {doc}"
        return sign, self.builder.coef(size, f"{self.name}_{wish}", doc, self.origin)

    # -------------------------------------------------------- linear terms

    def _enter(
        self,
        atom: Expr,
        term: Term,
        orders: Parts,
        speeds: Parts,
        outside: list[tuple[bool, Expression]],
    ) -> None:
        """Add w**k c of an atom to the terms of order k; an encoder that turns to the `speeds`."""
        pool, signal, k = self.pool, self.builder.signals.get(atom), term.order
        words, told = label(self.builder, atom), short(atom, k)
        if signal is None or signal.scale is None:
            value = pool.mul(term.coefficient, pool.power(self.filter.rate, k))
            sign, factor = self._signed(value, f"w{k}_{words}" if k else words, f"factor of {told}")
            sample = self._static_value(atom)
            orders.add(k, sign, sample if factor == ONE else Product((factor, sample)))
        elif k:
            value = pool.mul(term.coefficient, pool.power(self.filter.rate, k - 1))
            sign, factor = self._signed(value, f"w{k}_{words}", f"factor of {told}")
            speed = self._speed(signal, self.filter)
            speeds.add(k, sign, speed if factor == ONE else Product((factor, speed)))
        else:
            scaled = pool.mul(term.coefficient, signal.scale)
            sign, factor = self._signed(scaled, signal.name, f"factor of the counts of {told}")
            self.builder.sampled[signal.name] = None
            orders.add(0, sign, Product((factor, Ref("total", signal.name))))
            if signal.offset is not None:
                value = pool.mul(term.coefficient, signal.offset)
                outside.append(self._signed(value, "offset", f"start of {told}"))

    def _turned(self, speeds: Parts, bare: Parts) -> None:
        """Add the terms of encoders, which have H D of their angle in place of the angle.

        w**(k-1) H**(n-k) (1-H)**(k-1) of that has a stage less: as H + (1-H) = 1, it is the sum of
        the terms of degree k-1 and k.
        """
        for k, parts in sorted(speeds.items()):
            value = self._named(parts, f"n{k}", f"{self.name}: encoders, order {k}")
            for degree in (k - 1, k):
                bare.add(degree, True, value)
            if k < self.highest:
                missed = self._missed(k, value)
                for degree in (k + 1, k + 2):
                    bare.add(degree, False, missed)

    def _bent(self, orders: Parts, bare: Parts) -> Parts:
        """All terms by their degree k in w**k H**(n-k) (1-H)**k, each as one value if k > 0.

        p**k F is the term of degree k less (K-k) (w T)**2/12 in that of degree k+2.
        """
        found, whole = Parts(), dict[int, tuple[bool, Expression]]()
        for k in range(self.highest + 2):
            parts = list(orders.get(k, []))
            if parts and k < self.highest:
                comment = f"{self.name}: terms of order {k}"
                parts = [self._one(parts, f"g{k}", comment)]
                whole[k] = parts[0]
            parts += bare.get(k, [])
            if k - 2 in whole:
                sign, value = whole[k - 2]
                parts.append((not sign, self._missed(k - 2, value)))
            if k and parts:
                parts = [self._one(parts, f"d{k}", f"{self.name}: degree {k}")]
            if parts:
                found[k] = parts
        return found

    def _within(self, wish: str, value: Expression, comment: str) -> Expression:
        """A value of the chain."""
        return self._local(wish, value, comment)

    def _missed(self, k: int, value: Expression) -> Expression:
        """(K-k) (w T)**2/12 of the terms of order k."""
        off = self.highest - k
        weight = self.pool.scale(off, self.filter.bend)
        doc = f"filter: {off} * (w*sample_time)^2/12"
        coef = self.builder.coef(weight, f"bend{off}", doc)
        return self._within(f"e{k}", Product((coef, value)), f"{self.name}: error of order {k}")

    def _one(
        self, parts: list[tuple[bool, Expression]], wish: str, comment: str
    ) -> tuple[bool, Expression]:
        """Terms as one value, with a sign before it where all of them are negative."""
        sign = any(positive for positive, _ in parts)
        return sign, self._named([(positive == sign, v) for positive, v in parts], wish, comment)

    def _named(self, parts: list[tuple[bool, Expression]], wish: str, comment: str) -> Expression:
        """A sum that is read more than once."""
        value = total(parts)
        return value if isinstance(value, Ref) else self._within(wish, value, comment)

    def _horner(
        self,
        degrees: Parts,
        outside: list[tuple[bool, Expression]],
        stage: Callable[[Expression, str, str], Expression] | None = None,
    ) -> Expression:
        """All stages: what comes out at this sample."""
        stage = stage or self._stage
        powers = self._powers_of_h(degrees)
        inputs = Parts({0: list(outside)})
        for at, terms in enumerate(powers, self.stages + 1 - len(powers)):
            inputs.setdefault(at, []).extend(terms)
        output: Expression | None = None
        for m in range(self.stages, 0, -1):
            parts = list(inputs.get(m, []))
            if output is not None:
                parts.insert(0, (True, output))
            if parts:
                entry = self._within(f"u{m}", total(parts), f"{self.name}: stage {m}")
                output = stage(entry, f"{m}", f"{self.name}: stage {m}")
        return total([*([] if output is None else [(True, output)]), *inputs[0]])

    def _powers_of_h(self, degrees: Parts) -> list[list[tuple[bool, Expression]]]:
        """The factors of H**0, H**1, ... in sum_k d_k H**(m-k) (1-H)**k, m the highest degree.

        Multiplied by 1-H and joined by d_k, from the highest to the lowest k, this takes additions
        and nothing else.
        """
        found: list[list[tuple[bool, Expression]]] = []
        for k in range(max(degrees, default=-1), -1, -1):
            above: list[list[tuple[bool, Expression]]] = []
            for i, terms in enumerate(found):
                if len(terms) > 1:
                    comment = f"{self.name}: the filter multiplied out"
                    terms = [(True, self._within(f"p{k + 1}_{i}", total(terms), comment))]
                above.append(terms)
            found = [
                [*now, *((not sign, value) for sign, value in before)]
                for now, before in zip([*above, degrees.get(k, [])], [[], *above], strict=True)
            ]
        return found

    def _speed(self, signal: Signal, filter: Filter) -> Expression:
        """H D of an encoder, from the counts of this sample: no position is formed."""
        assert signal.scale is not None
        found = self._speeds.get((filter.of, signal.name))
        if found is not None:
            return found
        coef, wish = self.builder.coef, f"{filter.of}{signal.name}"
        factor = self.pool.mul(filter.count, signal.scale)
        gain = coef(factor, f"{wish}_gain", f"speed of {signal.declared.name} for one count")
        a, _ = filter.coefficients(self.builder)
        state = self._empty(f"{wish}_speed", f"filtered speed of {signal.declared.name}")
        speed = Ref("local", self.names.new(f"{self.name}_{wish}_speed"))
        self.builder.sampled[signal.name] = None
        count = Ref("increment", signal.name)
        comment = f"filtered speed of {signal.declared.name}"
        value = plus(Product((a, state)), Product((gain, count)))
        self._both(Assign(speed, value, comment, self.origin))
        self._both(Assign(state, speed, comment, self.origin))
        self._speeds[filter.of, signal.name] = speed
        return speed

    # ----------------------------------------------------------- integrals

    def _integrated(self, levels: dict[int, list[Term]], orders: Parts, bare: Parts) -> None:
        """Add all integrals of the residual as one: what is integrated is summed first.

        The trapezoid rule is 1/D: an integral is that less T**2/12 times the slope of what is
        integrated (Euler and Maclaurin), which here is filtered.
        """
        value, rate = self._integrals(levels)
        orders.add(0, True, value)
        factor = self.pool.mul(self.filter.rate, self.filter.twelfth)
        weight = self.builder.coef(factor, "bend_int", "filter: w*sample_time^2/12")
        off = self._local("i", Product((weight, rate)), f"{self.name}: error of order -1")
        self._slope(off, bare)

    def _slope(self, rate: Expression, bare: Parts) -> None:
        """Take away D/w of what is integrated."""
        bare.add(1, False, rate)

    def _integrals(self, levels: dict[int, list[Term]]) -> tuple[Expression, Expression]:
        """The sum of all integrals by the trapezoid rule, and what is summed last."""
        inner: Expression | None = None
        rate: Expression | None = None
        for level in range(max(levels), 0, -1):
            parts: list[tuple[bool, Expression]] = []
            if inner is not None:
                parts.append((True, inner))
            for term in levels.get(level, []):
                words = label(self.builder, term.atom)
                sign, factor = self._signed(
                    term.coefficient, f"{words}_int", f"factor of {short(term.atom, -level)}"
                )
                sample = self._static_value(term.atom)
                if sample == ONE:
                    parts.append((sign, factor))
                else:
                    product = sample if factor == ONE else Product((factor, sample))
                    parts.append((sign, product))
            before, rate = rate, self._rate(total(parts), f"{self.name}: integral")
            inner = self._trapezoid(rate, f"{self.name}: integral")
            if before is not None:  # what this sum misses of the one inside, as it stands
                doc = "sample_time^2/12: what a sum of slopes misses"
                weight = self.builder.coef(self.filter.twelfth, "twelfth", doc)
                inner = Sum(((True, inner), (False, Product((weight, before)))))
        assert inner is not None and rate is not None
        return inner, rate

    def _rate(self, value: Expression, comment: str) -> Expression:
        """A value that is integrated, to be read twice."""
        if isinstance(value, Ref):
            return value
        return self._local("rate", value, f"{comment}, what is integrated")

    def _trapezoid(self, rate: Expression, comment: str) -> Expression:
        """The integral of a value since the start."""
        half = self.builder.coef(self.filter.half, "half_time", "half the sample time")
        state = self._state("q", f"memory of {comment}")
        value = Ref("local", self.names.new(f"{self.name}_area"))
        gain = Product((half, rate))
        comment = f"{self.name}: its integral since the start, by the trapezoid rule"
        self.step.append(Assign(value, plus(state, gain), comment, self.origin))
        self.first.append(Assign(value, ZERO, comment, self.origin))
        self._both(Assign(state, plus(value, gain), comment, self.origin))
        return value

    def _adams(self, rate: Expression, comment: str) -> Expression:
        """The integral since the start of what is given times sample_time/24, as it stands.

        That is the trapezoid rule less T**2/12 times the slope of the rate, which is T/24 times its
        difference backwards over three samples: together the implicit rule of Adams, of fourth
        order. The sum of rates is what that rule has next to them, so that it costs three products.
        """
        total = self._state("q", f"memory of {comment}")
        last = self._state("rate1", f"what is integrated in {self.name}, a sample before")
        before = self._state("rate2", f"what is integrated in {self.name}, two samples before")
        twelve, nine, four, all_of_it = (
            Product((_number(self, number), value))
            for number, value in ((-12, rate), (9, rate), (4, last), (24, rate))
        )
        note = f"{self.name}: the integral is 0 at the start"
        for state, value in ((total, twelve), (last, rate), (before, rate)):
            self.first.append(Assign(state, value, note, self.origin))
        target = Ref("local", self.names.new(f"{self.name}_integral"))
        value = Sum(((True, total), (True, nine), (True, four), (False, before)))
        note = f"{self.name}: its integral since the start, by the rule of Adams"
        self._both(Assign(target, value, note, self.origin))
        self._both(Assign(total, Sum(((True, total), (True, all_of_it))), note, self.origin))
        self._both(Assign(before, last, note, self.origin))
        self._both(Assign(last, rate, note, self.origin))
        return target

    def _change(self, value: Expression, comment: str) -> Expression:
        """A value minus what it was at the start."""
        state = self._state("start", f"memory of {comment}")
        change = Ref("local", self.names.new(f"{self.name}_change"))
        difference = Sum(((True, value), (False, state)))
        self.first.append(Assign(state, value, comment, self.origin))
        self._both(Assign(change, difference, comment, self.origin))
        return change

    # -------------------------------------------------------------- leaves

    def _procedure(self, leaf: Callable[[Expr], Expression | None]) -> Procedure:
        return Procedure(
            self.pool,
            leaf,
            self._both,
            self.names,
            f"{self.name}_",
            self.builder.hoist,
            self.builder.is_constant,
        )

    def _prepare(self, atoms: list[Expr]) -> None:
        """Write the static atoms together, so that what they share is computed once."""
        nonlinear = [a for a in dict.fromkeys(atoms) if a not in self.builder.signals]
        start = self.builder.zero_start
        values = self._static.values(
            [gathered(self.pool, a, start) for a in nonlinear], self.origin
        )
        for atom, value in zip(nonlinear, values, strict=True):
            if not isinstance(value, Ref) and value != ONE:
                value = self._local(label(self.builder, atom), value, short(atom))
            self._atoms[atom] = value

    def _static_value(self, atom: Expr) -> Expression:
        found = self._atoms.get(atom)
        return self._plain(atom) if found is None else found

    def _sample(self, node: Expr) -> Expression | None:
        """A leaf of a static value: a sample, or an integral of samples."""
        return self._leaf(node, self._plain, self._static)

    def _leaf(
        self, node: Expr, signal: Callable[[Expr], Expression], inside: Procedure
    ) -> Expression | None:
        """A signal, or an integral that is made once by the procedure for what is inside."""
        if node.op is Op.SYM and node in self.builder.signals:
            return self.builder.mode(node) if node.symbol.kind is Kind.MODE else signal(node)
        if node.op is not Op.INT:
            return None
        found = self._areas.get((inside, node))
        if found is None:
            found = self._areas[inside, node] = self._integral(node, inside)
        return found

    def _integral(self, node: Expr, procedure: Procedure) -> Expression:
        inner = node.args[0]
        words = short(inner)
        if inner.op is Op.DER:
            value = self._change(procedure.value(inner.args[0], self.origin), f"change of {words}")
        else:
            part = self.pool.add(
                *((c, self.pool.mul(self.filter.half_twelfth, term)) for c, term in inner.terms)
            )
            rate = procedure.value(gathered(self.pool, part, self.builder.zero_start), self.origin)
            value = self._adams(
                self._rate(rate, f"sample_time/24 times {words}"), f"integral of {words}"
            )
        if node.symbol == self.builder.zero_start.symbol:
            return value
        start = self.pool.symbol(node.symbol.name, node.symbol.kind)
        return plus(self.builder.hoist(start), value)

    def _plain(self, symbol: Expr) -> Expression:
        signal = self.builder.signals[symbol]
        self.builder.sampled[signal.name] = None
        if signal.scale is None:
            return Ref("known", signal.name)
        found = self._angles.get(symbol)
        if found is None:
            factor = self.builder.hoist(signal.scale)
            value: Expression = Product((factor, Ref("total", signal.name)))
            if signal.offset is not None:
                value = plus(self.builder.hoist(signal.offset), value)
            found = self._angles[symbol] = self._local(signal.name, value, short(symbol))
        return found


def _number(chain: Chain, value: int) -> Expression:
    return chain.builder.number(chain.pool.num(value))


def plus(left: Expression, right: Expression) -> Expression:
    """The sum of two values."""
    return Sum(((True, left), (True, right)))
