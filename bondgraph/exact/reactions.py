"""Which symbols move an expression: at free signals, and on trajectories of the plant.

A derivative along a fault that is not zero on a healthy trajectory proves the fault seen; what
has none is tried with faults of finite size. Parameters are functions of time here, so that a
fault is found whatever its course.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Hashable, Iterator, Mapping, Sequence, Set
from functools import partial
from operator import attrgetter
from typing import NamedTuple, TypeVar

from bondgraph.exact.assembly import Assembly
from bondgraph.exact.dependence import Forward, Sensitivity, Side, sensitivities
from bondgraph.exact.evaluate import evaluate, terms_needed
from bondgraph.exact.free import FreeSample
from bondgraph.exact.from_start import from_start
from bondgraph.exact.outline import Outline, highest_order, outline
from bondgraph.exact.plant import Plant
from bondgraph.exact.plant_equations import has_sides
from bondgraph.exact.signal_algebra import Mixed
from bondgraph.exact.switch_modes import assignments, modes_of
from bondgraph.exact.trajectory import ExactUnavailable, Trajectory
from bondgraph.field.numbers import CUT, DividedByZero, Undefined
from bondgraph.ir.expr import Expr, Kind, Op, symbols

T = TypeVar("T")
_ID = attrgetter("id")

#: Points at which a relation is tried: one is enough for one without branches (it errs with a
#: probability of about its degree / 2**61 in a field, less over the reals), a branch not taken at
#: one point is taken at another.
_POINTS, _POINTS_WITH_BRANCHES = 1, 12
_ROUNDS = 4  # so many times as many points where a branch was not met: it may have none
_TURNS = 8  # points at which faults act, where laws of the plant have branches
_COMPARED = 3  # times as many for what is compared: one that turns no decision over has no slope
_FEW = 8  # faults that are tried one by one where there are branches
_TRIES = 40  # a point where a square root has no value is drawn again
_LATER_TRIES = 4  # the same where it has divided by zero at all of so many points before
_NO_POINT = "no point was found at which all its laws hold"


class Reactions:
    """What expressions of known signals react to in one plant, in given modes or in any."""

    def __init__(self, plant: Plant, seed: int, modes: Mapping[Expr, int] | None = None) -> None:
        self.plant = plant
        self._structure = plant.structure
        self.seed = seed
        self.modes = modes
        graph = plant.graph
        whole = self._structure.assembly  # a command that saturates is a reading, not a law
        told = [*whole.readings, *whole.shown]
        roots = [law for _, law in whole.laws] + [r.value for r in whole.rates]
        roots += [e for _, _, e in told]
        self.turns = _turns(roots, dict.fromkeys(self._structure.modes, 0))
        self.symbols = graph.fault_symbols()
        self.faults = {symbol: name for name, symbol in self.symbols.items()}
        switches = {symbol: symbol.symbol.name for symbol in modes or ()}
        self._acting = {**self.faults, **switches}  # all that `moves` may be asked for
        self._divided: set[Hashable] = set()  # what divided by zero wherever it was tried
        self._faulty_parameters = [s for s in self.faults if s.symbol.kind is Kind.PARAM]

    def at_free_signals(self, expr: Expr) -> Sensitivity:
        """What the relation depends on when its signals are independent of each other."""
        none = dict.fromkeys(outline(expr).symbols, False)
        found = Sensitivity(none, {}, frozenset(), (), frozenset())
        for point in range(_points([expr], None)):
            try:
                here = self.draw(
                    lambda n: sensitivities(expr, FreeSample.of(expr, n), jumps=True),
                    1000 * self.seed + point,
                )
            except ExactUnavailable:
                return _by_presence(expr)
            found = _union(found, here) if point else here
        return found

    def agree_at_free_signals(self, expr: Expr, other: Expr) -> bool:
        """Whether two relations have the same value where their signals are independent."""
        apart = self.plant.graph.pool.sub(expr, other)

        def moves(number: int) -> bool:
            sample = FreeSample.of(apart, number)
            return bool(sample.algebra.moves(evaluate([apart], sample)[0]))

        try:
            points = range(_points([apart], None))
            return not any(self.draw(moves, 1000 * self.seed + point) for point in points)
        except ExactUnavailable:
            return expr is other

    def sensed(
        self,
        exprs: list[Expr],
        lost: Sequence[Sequence[Expr]] = (),
        wanted: Set[Expr] | None = None,
    ) -> list[set[Expr]]:
        """The symbols that each relation reacts to, over enough points to meet every branch.

        Where the modes are not given, they take all their values in turn; one in which the plant
        has no behaviour is passed over. `lost` are for each relation symbols that have cancelled
        out of it. Where only some symbols are `wanted` no others are looked for. Raises
        `ExactUnavailable` where the plant has no behaviour at all.
        """
        reacts: list[set[Expr]] = [set() for _ in exprs]
        lasting: list[set[Expr]] = [set() for _ in exprs]
        hopeless: list[Mapping[Expr, int] | None] = []
        settings = self.settings(exprs)
        unmet = _sides(exprs, settings)
        for point, modes in enumerate(settings * _ROUNDS):
            if point >= len(settings) and not unmet:
                break
            if wanted is not None and all(wanted <= seen for seen in lasting):
                break
            if modes in hopeless:
                continue
            try:
                attempt = partial(self.at_trajectory, exprs, modes)
                number = 1000 * self.seed + point
                parts, met = self.draw(attempt, number, in_modes(exprs, modes))
            except ExactUnavailable:  # no trajectory, or no slope where a machine rests
                hopeless.append(modes)
                continue
            unmet -= met
            for seen, sure, part in zip(reacts, lasting, parts, strict=True):
                seen.update(s for s, hit in part.depends.items() if hit)
                sure.update(s for s in seen if s.symbol.kind is not Kind.PARAM)
                sure.update(part.lasting)
        gone = lost or [()] * len(exprs)
        for seen, sure, expr, others in zip(reacts, lasting, exprs, gone, strict=True):
            # told a parameter that moves, a relation may show what no plant would make it show
            seen.intersection_update(sure)
            unseen = [s for s in dict.fromkeys((*outline(expr).symbols, *others)) if s not in seen]
            asked = self.faults if wanted is None else wanted
            seen.update(self.movers(expr, dict.fromkeys(s for s in unseen if s in asked)))
        return reacts

    def movers(
        self, expr: Expr, candidates: Mapping[Expr, object], but: Set[Expr] = frozenset()
    ) -> list[Expr]:
        """Those of the faults, some left out, that move a relation.

        Asked one by one only if all together do. Most are far away, so that what is near is asked
        for first: that does not take longer the more faults a plant has.
        """
        if not candidates or self._unmoved_nearby(expr, candidates, but):
            return []
        tried = {s: None for s in candidates if s not in but}
        if not tried:
            return []
        if len(tried) == 1:
            return list(tried) if self._moves_anywhere(expr, tried) else []
        try:
            alone = self.turns > 1 or _turns([expr], self.modes) > 1  # each in branches of its own
            if not (alone and len(tried) <= _FEW) and not self._moves_anywhere(expr, tried):
                return []
        except ExactUnavailable:
            pass  # so many faults at once leave no plant to speak of
        return [s for s in tried if self.moves(expr, s)]

    def at_trajectory(
        self, exprs: list[Expr], modes: Mapping[Expr, int] | None, number: int
    ) -> tuple[list[Sensitivity], set[Side]]:
        """Derivatives of all relations at one healthy trajectory, and the branches it takes.

        What a trajectory shows that leaves a law out, the plant may not show.
        """
        sample = self.plant.sample(exprs, number, terms_needed(exprs), modes=modes)
        if isinstance(sample, Trajectory) and sample.part is not self._structure.part_for(exprs):
            raise ExactUnavailable(_NO_POINT)
        forward = Forward(exprs, sample)
        found = [sensitivities(expr, sample, forward=forward) for expr in exprs]
        return found, forward.taken(exprs, sample.algebra)

    def settings(self, exprs: list[Expr]) -> list[Mapping[Expr, int] | None]:
        """The modes at each of the points that are tried."""
        free = [] if self.modes is not None else modes_of(self.plant.graph, exprs)
        if not free:
            return [self.modes] * _points(exprs, self.modes)
        tried = assignments(free)
        rounds = -(-_POINTS_WITH_BRANCHES // len(tried))
        return [*tried] * rounds

    def moves(self, expr: Expr, *acting: Expr) -> bool:
        """Whether faults of the plant that act at once, none of them small, move a relation.

        A machine at rest, without any input, hides a parameter from the derivative that a change
        of finite size shows; and a parameter may cancel out of a relation only while it is
        constant. A switch of the given modes is a fault as well: it is in the other position.
        """
        if self._unmoved_nearby(expr, acting):
            return False
        return self._moves_anywhere(expr, acting)

    def _moves_anywhere(self, expr: Expr, acting: Container[Expr]) -> bool:
        """Whether faults move a relation on the whole part of the plant that shows its signals."""
        faults = self._within(self._structure.part_for([expr]), acting)
        if not faults:
            return False
        size = terms_needed([expr])

        def value(
            modes: Mapping[Expr, int] | None, turned: bool, acting: tuple[str, ...], number: int
        ) -> bool:
            sample = self.plant.sample(
                [expr], number, size, faults=acting, modes=modes, turned=turned
            )
            found = evaluate([expr], sample, size)[0]
            moved = sample.algebra.moves(found)
            if isinstance(sample, Trajectory) and sample.still and moved:
                raise ExactUnavailable(_NO_POINT)
            return moved

        free = [] if self.modes is not None else modes_of(self.plant.graph, [expr])
        failure: ExactUnavailable | None = None
        met = False
        known = assignments(free) if free else [self.modes]
        turns = max(self.turns, _turns([expr], self.modes))
        if any(s in acting for s in _compared(expr)):
            turns *= _COMPARED
        turns = max(1, turns // len(known))
        for turn, modes in [(turn, modes) for turn in range(turns) for modes in known]:
            try:
                attempt = partial(value, modes, turn % 2 > 0)
                found = self.draw(
                    partial(attempt, faults), 3000 * self.seed + turn, in_modes([expr], modes),
                    partial(attempt, ()),
                )  # fmt: skip
            except ExactUnavailable as reason:
                failure = reason
                continue
            met = True
            if found:
                return True
        if not met and failure is not None:
            raise failure
        return False

    def _within(
        self, part: Assembly, candidates: Container[Expr], but: Container[Expr] = ()
    ) -> tuple[str, ...]:
        """The names of the faults that can act in a part of the plant, some left out."""
        reached = [s for s in self._structure.reached(part) if s in candidates and s not in but]
        return tuple(self._acting[s] for s in sorted(reached, key=_ID) if s in self._acting)

    def _unmoved_nearby(
        self, expr: Expr, candidates: Container[Expr], but: Container[Expr] = ()
    ) -> bool:
        """Whether faults leave a relation unmoved where it is all that the equations say.

        And so on the plant. Where nothing has branches: one point then stands for all.
        """
        if self.turns > 1 or self.modes or _turns([expr], None) > 1 or self._structure.modes:
            return False
        size, part = terms_needed([expr]), self._structure.part_for([expr])
        changed = any(s in candidates and s not in but for s in self._faulty_parameters)
        if changed or not self.plant.many([expr], size, part):
            part = self._structure.cone(expr)  # else the whole moves as it does without the faults
        acting = self._within(part, candidates, but)

        def moved(number: int) -> bool:
            sample = self.plant.sample([expr], number, size, faults=acting, part=part)
            found = evaluate([expr], sample, size)[0]
            return sample.algebra.moves(found) or (isinstance(sample, Trajectory) and sample.still)

        try:
            return not self.draw(moved, 3000 * self.seed, (expr, id(part)))
        except (ExactUnavailable, Mixed):
            return False

    def draw(
        self,
        attempt: Callable[[int], T],
        number: int,
        of: Hashable = None,
        healthy: Callable[[int], object] | None = None,
    ) -> T:
        """The result at a random point; points where something has no value are drawn again.

        `of` names what may be asked for again, with other faults perhaps. Where it divided by zero
        at all of `_TRIES` points, and without faults (`healthy`, where the attempt has some) as
        well, a few tries are enough later: it does so in the whole mode, and a fault that takes the
        divisor away from zero does so at nearly every point. One that does so in a small part of
        what the machine does may be missed. Raises `ExactUnavailable` where all tries are in vain.
        """
        reasons, known = [], of is None or of in self._divided
        for turn in range(_LATER_TRIES if of in self._divided else _TRIES):
            try:
                return attempt(number + 100_000 * turn)
            except Undefined as reason:
                reasons.append(reason)
        always = not known and all(isinstance(reason, DividedByZero) for reason in reasons)
        if always and (healthy is None or _divides(healthy, number)):
            self._divided.add(of)
        raise ExactUnavailable("no point was found at which every law has a value")


def _divides(attempt: Callable[[int], object], number: int) -> bool:
    """Whether something divides by zero at each of `_TRIES` points."""
    for turn in range(_TRIES):
        try:
            attempt(number + 100_000 * turn)
        except DividedByZero:
            continue
        except (Undefined, ExactUnavailable):
            return False
        return False
    return True


def _by_presence(expr: Expr) -> Sensitivity:
    """What a relation may depend on, where it has no value at any random point."""
    inside = outline(expr).symbols
    signals = [s for s in inside if s.symbol.kind in (Kind.INPUT, Kind.SENSOR, Kind.READING)]
    order = highest_order([expr])
    orders = dict.fromkeys(signals, order)
    everything = frozenset(inside)
    return Sensitivity(dict.fromkeys(inside, True), orders, frozenset(), (), everything)


def in_modes(exprs: Sequence[Expr], modes: Mapping[Expr, int] | None) -> Hashable:
    """What relations are called that are drawn in some modes, see `Reactions.draw`."""
    return tuple(exprs), tuple((modes or {}).items())


def branches(exprs: Sequence[Expr], modes: Mapping[Expr, int] | None = None) -> bool:
    """Whether an expression takes branches that the modes do not decide."""
    return any(_branches(outline(expr), modes) for expr in exprs)


def _branches(expr: Outline, modes: Mapping[Expr, int] | None) -> bool:
    known = modes or {}
    if any(s.symbol.kind is Kind.MODE and s not in known for s in expr.symbols):
        return True
    if expr.ops.isdisjoint((Op.IF, Op.FN, Op.ROOT)):
        return False
    decided: dict[Expr, bool] = {}
    for n in expr.nodes:
        decided[n] = n in known if n.op is Op.SYM else all(decided[a] for a in n.args)
        if (n.op is Op.IF and not decided[n.args[0]]) or _branching(n):
            return True
    return False


def _turns(exprs: Sequence[Expr], modes: Mapping[Expr, int] | None) -> int:
    """Points at which faults of finite size are tried; every second one turns their signs."""
    if branches(exprs, modes):
        return _TURNS
    called = [n for e in exprs if Op.FN in outline(e).ops for n in outline(e).nodes]
    return 2 if any(n.op is Op.FN and n.name in CUT for n in called) else 1


def _compared(expr: Expr) -> list[Expr]:
    """The symbols that decide on which side of a limit a relation is."""
    if outline(expr).ops.isdisjoint((Op.CMP, Op.FN)):
        return []
    return symbols(*[n for n in outline(expr).nodes if n.op is Op.CMP or has_sides(n)])


def _points(exprs: Sequence[Expr], modes: Mapping[Expr, int] | None) -> int:
    """Several points where an expression takes branches that the modes do not decide."""
    return _POINTS_WITH_BRANCHES if branches(exprs, modes) else _POINTS


def _branching(node: Expr) -> bool:
    """Whether a node is a function of several branches, or iteration goes through one."""
    if node.op is Op.ROOT:
        inside = outline(node.root.zero).nodes
        return any(n.op is Op.IF or _branching(n) for n in inside)
    return has_sides(node)


def _sides(exprs: Sequence[Expr], settings: Sequence[Mapping[Expr, int] | None]) -> set[Side]:
    """The branches of relations that points may take, where the modes do not say which."""
    known = {mode for modes in settings for mode in modes or {}}
    return {
        (node, side)
        for expr in exprs
        if Op.IF in outline(expr).ops
        for node in outline(expr).nodes
        if node.op is Op.IF and not known.issuperset(symbols(node.args[0]))
        for side in (True, False)
    }


class Entries(NamedTuple):
    """The faults that one relation sees at the declared numbers.

    `apart` has those that it sees only elsewhere: the declared constants of which any one would
    have to differ, none where it takes several. `reason` says why no trajectory confirms this.
    """

    seen: frozenset[Expr]
    apart: dict[Expr, tuple[Expr, ...]]
    reason: str


def entries(
    plant: Plant, seed: int, relations: Sequence[tuple[Expr, Sequence[Expr]]]
) -> list[Entries]:
    """What each relation sees; with each the symbols that have cancelled out of it."""
    if not relations:
        return []
    exprs, lost = [e for e, _ in relations], [gone for _, gone in relations]
    declared = Reactions(from_start(plant), seed)
    try:
        found = declared.sensed(exprs, lost)
    except ExactUnavailable as reason:
        if len(relations) == 1:
            return [_unconfirmed(plant, seed, exprs[0], lost[0], str(reason))]
        return [entries(plant, seed, [relation])[0] for relation in relations]
    return [
        Entries(frozenset(own), _apart(plant, declared, expr, own), "")
        for expr, own in zip(exprs, found, strict=True)
    ]


def _apart(
    plant: Plant, declared: Reactions, expr: Expr, seen: set[Expr]
) -> dict[Expr, tuple[Expr, ...]]:
    """The faults in a relation that only other numbers let it see, and which numbers.

    Initial values are among them where `declared` holds states that never leave theirs.
    """
    unseen = {s for s in outline(expr).symbols if s in declared.faults and s not in seen}
    seed = declared.seed
    if not unseen:
        return {}
    try:
        elsewhere = Reactions(plant.apart(), seed).sensed([expr], wanted=unseen)[0]
        hidden = unseen & elsewhere
        found: dict[Expr, list[Expr]] = {s: [] for s in outline(expr).symbols if s in hidden}
        held = declared.plant.structure.held
        for start in held if hidden else []:
            other = Reactions(from_start(plant, seed, start), seed)
            for symbol in hidden & other.sensed([expr], wanted=hidden)[0]:
                found[symbol].append(start)

        def seen_with(constants: Sequence[Expr], wanted: Set[Expr]) -> Set[Expr]:
            other = plant.apart(constants)
            other = from_start(other, seed) if held else other
            return wanted & Reactions(other, seed).sensed([expr], wanted=wanted)[0]

        for constant, shown in _singly(seen_with, plant.structure.numbered(expr), hidden):
            for symbol in shown:
                found[symbol].append(constant)
    except ExactUnavailable:
        return {}
    return {symbol: tuple(constants) for symbol, constants in found.items()}


def _singly(
    seen_with: Callable[[Sequence[Expr], Set[Expr]], Set[Expr]],
    constants: Sequence[Expr],
    wanted: Set[Expr],
) -> Iterator[tuple[Expr, Set[Expr]]]:
    """The constants of which each alone, at another number, lets some of the wanted be seen.

    Half of them at a time: what many at any numbers do not show, none of them shows alone. To
    show something takes a point, and to show nothing takes all of them.
    """
    if not wanted or not constants:
        return
    try:
        wanted = seen_with(constants, wanted)
    except ExactUnavailable:
        if len(constants) == 1:
            raise
    if len(constants) == 1:
        yield constants[0], wanted
        return
    middle = len(constants) // 2
    yield from _singly(seen_with, constants[:middle], wanted)
    yield from _singly(seen_with, constants[middle:], wanted)


def _unconfirmed(plant: Plant, seed: int, expr: Expr, lost: Sequence[Expr], reason: str) -> Entries:
    """What a relation sees where the machine has no trajectory at the declared numbers.

    At other numbers, or else with signals that are independent of each other.
    """
    try:
        seen = Reactions(plant.apart(), seed).sensed([expr], [lost])[0]
        return Entries(frozenset(seen), {}, f"{reason} at the declared numbers")
    except ExactUnavailable:
        depends = Reactions(plant, seed).at_free_signals(expr).depends
        return Entries(frozenset(s for s, hit in depends.items() if hit), {}, reason)


def _union(a: Sensitivity, b: Sensitivity) -> Sensitivity:
    return Sensitivity(
        {s: hit or b.depends[s] for s, hit in a.depends.items()},
        {s: max(a.orders.get(s, -2), b.orders.get(s, -2)) for s in {**a.orders, **b.orders}},
        a.dead & b.dead,
        tuple(dict.fromkeys((*a.starts, *b.starts))),
        a.lasting | b.lasting,
    )
