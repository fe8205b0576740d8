"""Compares every entry of every signature with what real trajectories of the plant do."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from random import Random
from typing import Any, NamedTuple

from flint import arb, arb_series, ctx

from tests.real.plant import NoPoint, Plant, Point, Simulator, course, wrong
from tests.real.residual import Evaluator, NoValue, Residual, residuals
from tests.real.series import constant, exact, prepare

HEALTHY = 1e-25  # of its terms: below this a residual vanishes
SEEN = 1e-20  # above this it has moved
_POINTS = 4
_STARTS = 25  # random starts for each of them
_SAID = 48  # trajectories with a fault, while an entry that is said to be seen is not
_UNSAID = 8  # for entries that are said not to be seen
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
    if judged.broken or any(e.verdict == "wrong" for e in judged.entries):
        # once more with more coefficients and other points
        return _Judge(plant, found, answer, highest + room + 4, seed + 1000).run()
    return judged


def candidates(answer: Mapping[str, Any]) -> list[str]:
    return [*answer["undetectable"], *[f for group in answer["groups"] for f in group]]


class _Judge:
    def __init__(
        self,
        plant: Plant,
        found: list[Residual],
        answer: Mapping[str, Any],
        length: int,
        seed: int,
    ) -> None:
        self.plant = plant
        self.residuals = found
        self.answer = answer
        self.random = Random(f"judge {seed}")
        self.simulator = Simulator(plant, length)
        prepare(self.simulator.length)
        self.evaluators = [Evaluator(r) for r in found]
        self.count = 5 if any(r.integrates for r in found) else 3
        self.points: list[Point] = []
        self.failures = 0

    def run(self) -> Judgement:
        strange = {x for r in self.residuals for x in r.symbols} - {
            *self.plant.declared, *self.plant.inputs, *self.plant.sensors
        }  # fmt: skip
        if strange:
            return Judgement(unjudged=f"symbols {sorted(strange)}")
        broken = self.healthy()
        if len(self.points) < 2:
            return Judgement(broken=tuple(broken), unjudged="no trajectory was found")
        if broken:
            return Judgement(broken=tuple(broken))
        entries: list[Entry] = []
        listed = candidates(self.answer)
        for fault in self.plant.faults:
            entries += self.fault(fault, fault in listed)
        return Judgement(tuple(entries))

    # ---------------------------------------------------------------------------- points

    def told(self, point: Point, declared: Mapping[str, Fraction]) -> dict[str, Any]:
        """What a residual is told: declared numbers, inputs and readings with their errors."""
        out = {x: constant(exact(v)) for x, v in declared.items()}
        for x in self.plant.inputs:
            out[x] = point.signals[x] + point.signals[wrong(x)]
        out.update((x, point.signals[x]) for x in self.plant.sensors)
        return out

    def point(self, declared: Mapping[str, Fraction], starts: int = _STARTS) -> Point | None:
        """A healthy trajectory."""
        for _ in range(starts):
            try:
                known = self.simulator.known(declared, self.random)
                return self.simulator.solve(known, self.simulator.start(self.random))
            except NoPoint:
                continue
        return None

    def healthy(self) -> list[str]:
        """Finds points where all residuals have values; those that do not vanish there."""
        broken: dict[str, str] = {}
        valued: set[str] = set()
        for _ in range(3 * _POINTS):
            if len(self.points) >= _POINTS:
                break
            point = self.point(self.plant.declared)
            if point is None:
                break
            told = self.told(point, self.plant.declared)
            some = False
            for evaluator in self.evaluators:
                name = evaluator.residual.name
                try:
                    value = evaluator(told, self.count)
                except NoValue:
                    continue
                some = True
                valued.add(name)
                if value.part() > HEALTHY:
                    broken[name] = f"{name} does not vanish: {value.part():.1e} of its terms"
            if some:
                self.points.append(point)
        self.valued = valued
        return [broken[name] for name in sorted(broken)]

    # ---------------------------------------------------------------------------- faults

    def fault(self, fault: str, listed: bool) -> Iterator[Entry]:
        """The entries of one fault."""
        seen, tried = self.seen(fault, self.plant.declared, self.points)
        for r in self.residuals:
            yield self.entry(r, fault, listed, r.name in seen, tried)

    def entry(self, r: Residual, fault: str, listed: bool, seen: bool, tried: int) -> Entry:
        if not listed:
            return Entry(r.name, fault, "not a candidate", "seen" if seen else "")
        if r.name not in self.valued:
            return Entry(r.name, fault, "not judged: no value on a healthy plant")
        if not tried:
            return Entry(r.name, fault, "not judged: no faulty trajectory")
        said = fault in r.signature
        if said == seen and fault not in r.only_off:
            return Entry(r.name, fault, "unconfirmed" if fault in r.unconfirmed else "right")
        if fault in r.unconfirmed:
            return Entry(r.name, fault, "unconfirmed")
        if fault in r.only_off and not said:
            if seen:
                return Entry(r.name, fault, "wrong", "said only off nominal, seen at them")
            blind = self.blind_off_nominal(r, fault)
            if blind is None:
                return Entry(r.name, fault, "off nominal")
            return Entry(r.name, fault, "wrong", f"said off nominal, not seen with other {blind}")
        detail = "seen, not said" if seen else "said, not seen"
        return Entry(r.name, fault, "wrong", detail)

    def seen(
        self,
        fault: str,
        declared: Mapping[str, Fraction],
        points: list[Point],
        only: Residual | None = None,
    ) -> tuple[set[str], int]:
        """The residuals that some course of a fault moves, and how many trajectories it had."""
        wanted = [e for e in self.evaluators if only is None or e.residual is only]
        seen: set[str] = set()
        tried = 0
        pool = list(points)
        for turn in range(_SAID):
            left = [e for e in wanted if e.residual.name not in seen]
            hoped = [
                e for e in left if only is not None
                or (fault in e.residual.signature and fault not in e.residual.only_off)
            ]  # fmt: skip
            if not left or (turn >= _UNSAID and not hoped):
                break
            if turn >= 2 * _POINTS and turn % 4 == 0:
                extra = self.point(declared, 3)
                pool += [extra] if extra is not None else []
            point = self.faulty(fault, declared, pool[turn % len(pool)], turn)
            if point is None:
                continue
            told = self.told(point, declared)
            valued = False
            for evaluator in left:
                try:
                    value = evaluator(told, self.count)
                except NoValue:
                    continue
                valued = True
                if value.part() > SEEN:
                    seen.add(evaluator.residual.name)
            tried += valued
        return seen, tried

    def faulty(
        self, fault: str, declared: Mapping[str, Fraction], healthy: Point, turn: int
    ) -> Point | None:
        """The same inputs with a random course of a fault, which may be large."""
        random = self.random
        size = 0.3 if turn == 0 else 10 ** random.uniform(-2, 1.3)
        if fault in declared:
            size *= abs(float(declared[fault])) or 1
        lead = size * random.choice((-1, 1))
        error = course(random, lead, self.simulator.length)
        known = dict(healthy.known)
        if fault in declared:
            known[fault] = known[fault] + error
        else:
            known[wrong(fault)] = error
        start = list(healthy.torn)
        if turn > 2 and random.random() < 0.4:
            start = [a + (b - a) * arb(0.3) for a, b in zip(
                start, self.simulator.start(random), strict=True)]  # fmt: skip
        try:
            return self.simulator.solve(known, start)
        except NoPoint:
            self.failures += 1
            return None

    def blind_off_nominal(self, r: Residual, fault: str) -> str | None:
        """Which of the named numbers may differ without the fault being seen (None: no such).

        One of the names at a time is changed; all that are declared at once where none is named.
        """
        named = r.only_off[fault]
        for names in [[x] for x in named] or [list(self.plant.declared)]:
            declared = dict(self.plant.declared)
            for x in names:
                if x not in declared:
                    return f"{x}, which is no declared number"
                factor = Fraction(self.random.randint(60, 190), 100)
                declared[x] = declared[x] * factor or Fraction(3, 10)
            points = [p for p in (self.point(declared) for _ in range(3)) if p is not None]
            if not points or r.name not in self.seen(fault, declared, points, only=r)[0]:
                return ", ".join(names)
        return None


def random_series(random: Random) -> Any:
    """A series for tests."""
    return arb_series([arb(random.uniform(0.5, 2)) for _ in range(ctx.cap)], ctx.cap)
