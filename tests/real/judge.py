"""Compares every entry of every signature with what real trajectories of the plant do."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from fractions import Fraction
from random import Random
from typing import Any, NamedTuple

from flint import arb

from tests.real.plant import NoPoint, Plant, Point, Simulator, course, wrong
from tests.real.residual import Evaluator, NoValue, Residual, decides, residuals
from tests.real.series import constant, exact, prepare

HEALTHY = 1e-25  # of its terms: below this a residual vanishes
SEEN = 1e-20  # above this it has moved
_POINTS, _BRANCHED_POINTS = 4, 9
_FAR = 6  # the scale of every third point, beyond the ends of tables and of saturations
_SMALLEST, _FARTHEST = -1.5, 1.7  # powers of ten, of points added in search of an entry
_MOST_POINTS = 16  # where residuals have no value at most points
_STARTS = 12  # random starts for each of them
_SAID = 32  # trajectories with a fault, while an entry that is said to be seen is not
_PATIENT = 256  # the same, before an entry is called wrong
_UNSAID, _BRANCHED_UNSAID = 5, 12  # for entries that are said not to be seen
_LONGEST = 40  # coefficients


class Entry(NamedTuple):
    """A residual and a fault: `verdict` is right, wrong, off nominal, unconfirmed or a reason."""

    residual: str
    fault: str
    verdict: str
    detail: str = ""


class Judgement(NamedTuple):
    """What came of one answer; `unjudged` is why nothing could be said of it."""

    entries: tuple[Entry, ...] = ()
    broken: tuple[str, ...] = ()  # residuals that do not vanish on the healthy plant, and more
    unjudged: str = ""


def judge(plant: Plant, answer: Mapping[str, Any], seed: int = 1) -> Judgement:
    """The entries of an answer with residuals."""
    found = residuals(answer)
    highest = max(r.orders for r in found)
    room = 6 if any(r.integrates for r in found) else 3
    if highest + room + 6 > _LONGEST:
        return Judgement(unjudged=f"derivatives of order {highest}")
    judged = _Judge(plant, found, answer, highest + room, seed).run()
    doubted = {e.fault for e in judged.entries if e.verdict == "wrong"}
    if not judged.broken and not doubted:
        return judged
    # Once more, with more coefficients and other points: what is called wrong has to be so twice.
    other = _Judge(plant, found, answer, highest + room + 4, seed + 1000, _PATIENT)
    again = other.run(doubted or set(plant.faults))
    kept = tuple(e for e in judged.entries if again.entries and e.fault not in doubted)
    return again._replace(entries=(*kept, *again.entries))


def candidates(answer: Mapping[str, Any]) -> list[str]:
    return [*answer["undetectable"], *[f for group in answer["groups"] for f in group]]


class _World(NamedTuple):
    """A simulator and healthy points: at the start of a run, or anywhere in it."""

    simulator: Simulator
    points: list[Point]
    residuals: list[Evaluator]  # those that have a value at points of this kind


def start_name(state: str) -> str:
    """What the compiler calls the initial value of a state."""
    return f"{state}0" if "." in state else f"{state}.int.x0"


class _Judge:
    def __init__(
        self,
        plant: Plant,
        found: list[Residual],
        answer: Mapping[str, Any],
        length: int,
        seed: int,
        most: int = _SAID,
    ) -> None:
        self.plant = plant
        self.residuals = found
        self.answer = answer
        self.random = Random(f"judge {seed}")
        self.asked = length
        self.length = Simulator(plant, length).length
        prepare(self.length)
        self.evaluators = [Evaluator(r) for r in found]
        self.most = most
        self.count = 5 if any(r.integrates for r in found) else 3
        self.broken: dict[str, str] = {}
        branches = any(r.decides for r in found) or any(map(decides, plant.laws()))
        self.enough = _BRANCHED_POINTS if branches else _POINTS
        self.unsaid = _BRANCHED_UNSAID if branches else _UNSAID
        # Integrals begin at the start, where declared initial values hold. What has no integral
        # can be looked at anywhere in a run.
        self.worlds = [self.world(plant, length, self.evaluators)]
        if plant.starts:
            later = [e for e in self.evaluators if not e.residual.integrates]
            self.worlds.append(self.world(plant._replace(starts={}), length, later))

    def run(self, faults: Collection[str] | None = None) -> Judgement:
        """All entries, or those of some faults."""
        strange = {x for r in self.residuals for x in r.symbols} - {
            *self.plant.declared, *self.plant.inputs, *self.plant.sensors, *self.plant.sources
        }  # fmt: skip
        if strange:
            return Judgement(unjudged=f"symbols {sorted(strange)}")
        if not any(world.points for world in self.worlds):
            return Judgement(unjudged="no trajectory was found")
        if self.broken:
            return Judgement(broken=tuple(self.broken[name] for name in sorted(self.broken)))
        entries: list[Entry] = []
        listed = candidates(self.answer)
        for fault in self.plant.faults if faults is None else sorted(faults):
            seen, tried = self.told_apart(fault, self.plant.declared)
            for e in self.evaluators:
                name = e.residual.name
                entries.append(
                    self.entry(e.residual, fault, fault in listed, name in seen, tried[name])
                )
        return Judgement(tuple(entries))

    # ---------------------------------------------------------------------------- points

    def told(self, point: Point, declared: Mapping[str, Fraction]) -> dict[str, Any]:
        """What a residual is told: declared numbers, inputs and readings with their errors."""
        out = {x: constant(exact(v)) for x, v in declared.items()}
        out.update((x, constant(exact(Fraction(0)))) for x in self.plant.sources)
        for x in self.plant.inputs:
            out[x] = point.signals[x] + point.signals[wrong(x)]
        out.update((x, point.signals[x]) for x in self.plant.sensors)
        return out

    def point(
        self,
        simulator: Simulator,
        declared: Mapping[str, Fraction],
        sign: int = 0,
        scale: float = 1,
        near: Sequence[float] = (),
    ) -> Point | None:
        """A healthy trajectory; its inputs begin with a sign (0: any), all about at a scale."""
        for _ in range(_STARTS):
            try:
                known = simulator.known(declared, self.random, sign, scale, near)
                return simulator.solve(known, simulator.start(self.random, scale))
            except NoPoint:
                continue
        return None

    def rare(
        self, simulator: Simulator, declared: Mapping[str, Fraction], pool: list[Point]
    ) -> Point | None:
        """A point of any size and sign; some inputs near what sensors read at another one.

        Such an input keeps a controller between its limits.
        """
        scale = 10 ** self.random.uniform(_SMALLEST, _FARTHEST)
        sign = self.random.choice((-1, 0, 1))
        at = self.random.choice(pool)
        near = [float(at.signals[x][0].mid()) for x in self.plant.sensors]
        return self.point(simulator, declared, sign, scale, near)

    def world(self, plant: Plant, length: int, wanted: list[Evaluator]) -> _World:
        """Healthy points, at which residuals vanish; each residual has a value at some."""
        simulator = Simulator(plant, length)
        points: list[Point] = []
        valued: dict[str, int] = {e.residual.name: 0 for e in wanted}
        for turn in range(_MOST_POINTS):
            if not wanted or (turn >= self.enough and min(valued.values()) >= 2):
                break
            far = _FAR if turn % 3 == 2 else 1
            point = self.point(simulator, plant.declared, (1, -1, 1, 0)[turn % 4], far)
            if point is None:
                if not points and turn >= 3:
                    break
                continue
            told = self.told(point, plant.declared)
            before = sum(valued.values())
            for evaluator in wanted:
                name = evaluator.residual.name
                try:
                    value = evaluator(told, self.count)
                except NoValue:
                    continue
                valued[name] += 1
                if value.part() > HEALTHY:
                    self.broken[name] = f"{name} does not vanish: {value.part():.1e} of its terms"
            if sum(valued.values()) > before:
                points.append(point)
        return _World(simulator, points, [e for e in wanted if valued[e.residual.name]])

    # ---------------------------------------------------------------------------- faults

    def told_apart(
        self, fault: str, declared: Mapping[str, Fraction]
    ) -> tuple[set[str], dict[str, int]]:
        """The residuals that a fault moves, and at how many trajectories each had a value."""
        tried = {r.name: 0 for r in self.residuals}
        seen: set[str] = set()
        for number, world in enumerate(self.worlds):
            # Anywhere in a run a plant may be where it cannot get from its start: that speaks for
            # the compiler, never against it, unless the start itself cannot be simulated.
            wanted = [
                e
                for e in world.residuals
                if e.residual.name not in seen
                and (not number or self.said(e.residual, fault) or not tried[e.residual.name])
            ]
            seen |= self.seen(world, fault, declared, wanted, tried)
        return seen, tried

    def said(self, r: Residual, fault: str) -> bool:
        return fault in r.signature and fault not in r.only_off

    def seen(
        self,
        world: _World,
        fault: str,
        declared: Mapping[str, Fraction],
        wanted: list[Evaluator],
        tried: dict[str, int],
        hope: bool = False,
    ) -> set[str]:
        """The residuals among those wanted that some course of a fault moves."""
        seen: set[str] = set()
        pool = list(world.points)
        for turn in range(self.most if pool else 0):
            left = [e for e in wanted if e.residual.name not in seen]
            hoped = hope or any(self.said(e.residual, fault) for e in left)
            if not left or (turn >= self.unsaid and not hoped):
                break
            if turn >= 2 * self.enough and turn % 4 == 0:
                extra = self.rare(world.simulator, declared, pool)
                pool += [extra] if extra is not None else []
            healthy = pool[turn % len(pool)] if turn < 2 * self.enough else pool[-1]
            point = self.faulty(world.simulator, fault, declared, healthy, turn)
            if point is None:
                continue
            told = self.told(point, declared)
            for evaluator in left:
                try:
                    value = evaluator(told, self.count)
                except NoValue:
                    continue
                tried[evaluator.residual.name] += 1
                if value.part() > SEEN:
                    seen.add(evaluator.residual.name)
        return seen

    def entry(self, r: Residual, fault: str, listed: bool, seen: bool, tried: int) -> Entry:
        if not listed:
            return Entry(r.name, fault, "not a candidate", "seen" if seen else "")
        if not tried:
            return Entry(r.name, fault, "not judged: no trajectory on which it has a value")
        said = fault in r.signature
        if said and fault in r.only_off:
            return Entry(r.name, fault, "wrong", "said both seen and only off nominal")
        if said == seen and fault not in r.only_off:
            return Entry(r.name, fault, "unconfirmed" if fault in r.unconfirmed else "right")
        if fault in r.unconfirmed:
            return Entry(r.name, fault, "unconfirmed")
        if fault in r.only_off:
            if seen and not self.worlds[0].points:
                return Entry(r.name, fault, "not judged: the start of a run is not found")
            if seen:
                return Entry(r.name, fault, "wrong", "said only off nominal, seen at them")
            blind = self.blind_off_nominal(r, fault)
            if blind is None:
                return Entry(r.name, fault, "off nominal")
            return Entry(r.name, fault, "wrong", f"said off nominal, not seen with other {blind}")
        if said and r.integrates and r.decides:
            return Entry(r.name, fault, "not judged: branches that a run may reach later")
        return Entry(r.name, fault, "wrong", "seen, not said" if seen else "said, not seen")

    def faulty(
        self,
        simulator: Simulator,
        fault: str,
        declared: Mapping[str, Fraction],
        healthy: Point,
        turn: int,
    ) -> Point | None:
        """The same inputs with a random course of a fault, which may be large."""
        random = self.random
        size = 0.3 if turn == 0 else 10 ** random.uniform(-2, 1.3 if fault in declared else 2)
        if fault in declared:
            size *= abs(float(declared[fault])) or 1
        lead = size * random.choice((-1, 1))
        error = course(random, lead, self.length)
        known = dict(healthy.known)
        if fault in declared:
            known[fault] = known[fault] + error
        else:
            known[wrong(fault)] = error
        start = list(healthy.torn)
        if turn > 2 and random.random() < 0.4:
            other = simulator.start(random)
            start = [a + (b - a) * arb(0.3) for a, b in zip(start, other, strict=True)]
        try:
            return simulator.solve(known, start)
        except NoPoint:
            return None

    def blind_off_nominal(self, r: Residual, fault: str) -> str | None:
        """Which of the named numbers may differ without the fault being seen (None: no such).

        One of the names at a time is changed; all that are declared at once where none is named.
        """
        starts = {start_name(x): x for x in self.plant.starts}
        named = r.only_off[fault]
        for names in [[x] for x in named] or [[*self.plant.declared, *starts]]:
            declared, begun = dict(self.plant.declared), dict(self.plant.starts)
            for x in names:
                if x in declared:
                    declared[x] = self.other(declared[x])
                elif x in starts:
                    begun[starts[x]] = self.other(begun[starts[x]])
                else:
                    return f"{x}, which is no declared number"
            worlds = self.worlds
            if begun != self.plant.starts:
                plant = self.plant._replace(starts=begun)
                worlds = [self.world(plant, self.asked, self.evaluators)]
            if not any(self.seen_elsewhere(w, r, fault, declared) for w in worlds):
                return ", ".join(names)
        return None

    def other(self, number: Fraction) -> Fraction:
        """Another number of about the same size."""
        return number * Fraction(self.random.randint(60, 190), 100) or Fraction(3, 10)

    def seen_elsewhere(
        self, world: _World, r: Residual, fault: str, declared: Mapping[str, Fraction]
    ) -> bool:
        """Whether a fault is seen where other numbers are declared."""
        points = [self.point(world.simulator, declared) for _ in range(12)]
        there = world._replace(points=[p for p in points if p is not None])
        wanted = [e for e in world.residuals if e.residual is r]
        tried = {r.name: 0}
        return bool(self.seen(there, fault, declared, wanted, tried, hope=True))
