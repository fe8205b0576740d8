"""The units that a model may use: their names, what they measure and their factor to SI."""

from __future__ import annotations

import re
from decimal import Context, Decimal
from fractions import Fraction
from functools import cache, lru_cache
from importlib import import_module
from math import lcm

from bondgraph.ir.unit import NONE, Dimension, Unit, raised, times, whole
from bondgraph.text.tuples import NamedTuple

#: The shortest decimal that is the double nearest to pi: products of it still print shortly.
PI = Fraction("3.141592653589793")

#: Name, the base units it stands for, the factor; a `+` after the name admits SI prefixes.
_TABLE = """
m+ m 1             |g+ kg 1e-3          |s+ s 1            |A+ A 1           |K+ K 1
mol+ mol 1         |cd+ cd 1            |rad+ 1 1          |sr+ 1 1          |Hz+ s^-1 1
N+ m.kg.s^-2 1     |Pa+ m^-1.kg.s^-2 1  |J+ m^2.kg.s^-2 1  |W+ m^2.kg.s^-3 1 |C+ s.A 1
V+ m^2.kg.s^-3.A^-1 1     |F+ m^-2.kg^-1.s^4.A^2 1  |Ohm+ m^2.kg.s^-3.A^-2 1
Ω+ m^2.kg.s^-3.A^-2 1     |S+ m^-2.kg^-1.s^3.A^2 1  |Wb+ m^2.kg.s^-2.A^-1 1
T+ kg.s^-2.A^-1 1         |H+ m^2.kg.s^-2.A^-2 1    |lm+ cd 1    |lx+ m^-2.cd 1
Bq+ s^-1 1         |Gy+ m^2.s^-2 1      |Sv+ m^2.s^-2 1    |kat+ s^-1.mol 1
degC K 1           |°C K 1              |degF K 5/9        |°F K 5/9         |degR K 5/9
min s 60           |h s 3600            |d s 86400         |day s 86400      |week s 604800
l+ m^3 1e-3        |L+ m^3 1e-3         |t+ kg 1000        |bar+ m^-1.kg.s^-2 1e5
eV+ m^2.kg.s^-2 1.602176634e-19         |u kg 1.66053906892e-27
Wh+ m^2.kg.s^-2 3600      |VA+ m^2.kg.s^-3 1        |var+ m^2.kg.s^-3 1  |Ah+ s.A 3600
cal+ m^2.kg.s^-2 4.184    |BTU m^2.kg.s^-2 1055.05585262         |ha m^2 1e4
atm m^-1.kg.s^-2 101325   |Torr m^-1.kg.s^-2 101325/760          |mmHg m^-1.kg.s^-2 133.322387415
psi m^-1.kg.s^-2 44482216152605/6451600000  |ksi m^-1.kg.s^-2 44482216152605/6451600
P+ m^-1.kg.s^-1 1/10      |St+ m^2.s^-1 1e-4        |dyn m.kg.s^-2 1e-5
kgf m.kg.s^-2 9.80665     |lbf m.kg.s^-2 4.4482216152605         |hp m^2.kg.s^-3 745.69987158227022
lb kg 0.45359237          |oz kg 0.028349523125     |slug kg 14.593902937206364829
inch m 0.0254      |ft m 0.3048         |yd m 0.9144       |mile m 1609.344  |nmi m 1852
mph m.s^-1 0.44704        |kmh m.s^-1 5/18          |kn m.s^-1 1852/3600 |gal m^3 0.003785411784
lpm m^3.s^-1 1/60000      |gpm m^3.s^-1 0.003785411784/60         |cc m^3 1e-6
% 1 1/100          |percent 1 1/100     |‰ 1 1/1000        |ppm 1 1e-6       |ppb 1 1e-9
turn 1 2pi         |rev 1 2pi           |cycle 1 2pi       |rpm s^-1 pi/30   |rps s^-1 2pi
count 1 1          |counts 1 1         |pulse 1 1         |pulses 1 1
deg 1 pi/180       |° 1 pi/180          |arcmin 1 pi/10800 |arcsec 1 pi/648000 |gon 1 pi/200
"""
_PREFIXES = {
    "da": 1, "Q": 30, "R": 27, "Y": 24, "Z": 21, "E": 18, "P": 15, "T": 12, "G": 9, "M": 6,
    "k": 3, "h": 2, "d": -1, "c": -2, "m": -3, "u": -6, "µ": -6, "μ": -6, "n": -9, "p": -12,
    "f": -15, "a": -18, "z": -21, "y": -24, "r": -27, "q": -30,
}  # fmt: skip
#: What a scale of temperatures calls zero, in K; that of K itself is 0.
_ZEROS = {
    "degC": Fraction("273.15"), "°C": Fraction("273.15"),
    "degF": Fraction("459.67") * 5 / 9, "°F": Fraction("459.67") * 5 / 9,
}  # fmt: skip
_BASE = ("m", "kg", "s", "A", "K", "mol", "cd")

_FACTOR = re.compile(r"(1|%|‰|°[CF]?|[^\W\d_]\w*)(?:\^(-?\d{1,20}(?:\.\d{1,20})?))?")
_LARGEST_EXPONENT = 24  # beyond any physics; keeps factors small whatever is typed
_LARGEST_ROOT = 12
_LONGEST_TEXT = 60  # letters of a unit for which a better spelling is looked for

#: Rounds a root that is not rational; a double keeps 17 digits.
_ROOT = Context(prec=20)

#: What `describe` says, the first of several units of one dimension.
_WRITTEN = """1 m kg s A K mol cd N N.m V W Pa C Ohm F H N.m/A T rad/s m/s m/s^2 m^2 m^3 m^3/s
kg.m^2 kg/s kg/m^3 kg.m/s N.s/m N.m.s N/m N/m^2 J/K W/K J/mol mol/s J/kg J/kg/K W/m/K W/m^2/K
Pa.s Pa.s/m^3 m^3/Pa m^3/s/Pa Pa.s^2/m^3 kg/m^4 m^3/s/Pa^0.5 V/s A/s N/s N/A A/N.m rad/s/V m/N
rad/N/m 1/Ohm K/W K/s W/s mol/m^3 V/m A/m m/s/V N/V V.s/m C/m m/C V/N A.s/m mol/J J.s/mol mol^2/J.s
1/m 1/m^2 1/m^3 1/kg 1/A 1/V 1/K 1/N 1/Pa 1/mol 1/F 1/H 1/s^2 m/s^3 Pa/s s^2 m/rad N/kg"""

_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")

_WORDS = {
    "volt": "V", "ampere": "A", "amp": "A", "watt": "W", "joule": "J", "newton": "N",
    "pascal": "Pa", "ohm": "Ohm", "farad": "F", "henry": "H", "henrie": "H", "hertz": "Hz",
    "weber": "Wb", "tesla": "T", "coulomb": "C", "siemen": "S", "kelvin": "K", "mole": "mol",
    "metre": "m", "meter": "m", "gram": "g", "kilogram": "kg", "kilo": "kg", "tonne": "t",
    "second": "s", "sec": "s", "minute": "min", "hour": "h", "hr": "h", "litre": "l",
    "liter": "l", "radian": "rad", "degree": "deg", "revolution": "rev", "tr": "turn",
    "celsius": "degC", "fahrenheit": "degF", "mhos": "S", "mho": "S", "in": "inch",
    "foot": "ft", "feet": "ft", "pound": "lb", "micron": "um", "millimeter": "mm",
    "millimetre": "mm", "millisecond": "ms", "kohm": "kOhm", "mohm": "mOhm", "pct": "%",
    "nms": "N.m.s",
}  # fmt: skip

_PREFIX_WORDS = {
    "nano": "n", "pico": "p", "micro": "u", "milli": "m", "centi": "c", "deci": "d", "hecto": "h",
    "kilo": "k", "mega": "M", "giga": "G",
}  # fmt: skip

_described: dict[Dimension, str] = {}
_written = iter(_WRITTEN.split())
_Entry = tuple[Dimension, Fraction]


class Domain(NamedTuple):
    """What effort and flow are in a domain; None where the domain leaves a unit open."""

    name: str
    effort: Dimension | None
    flow: Dimension | None
    effort_name: str
    flow_name: str
    effort_unit: str
    flow_unit: str


@cache
def parse_unit(text: str) -> Unit | None:
    """The unit that `text` spells (`N.m/A`, `m^3/s.Pa^-0.5`), or None where a name is unknown.

    Each `/` divides only by the factor right after it. Exponents are exact; a factor is exact
    unless pi (the double nearest to it) or an irrational root (20 digits) occurs in it.
    `degC` is a difference of temperatures, as everywhere in a bond graph.

    >>> parse_unit("N.m/A").dimension == parse_unit("V.s/rad").dimension
    True
    >>> parse_unit("uH").factor, parse_unit("furlongs per fortnight")
    (Fraction(1, 1000000), None)
    """
    dimension: Dimension = NONE
    powers: list[tuple[Fraction, Fraction]] = []
    at, sign = 0, 1
    while True:
        found = _FACTOR.match(text, at)
        if found is None:
            return None
        atom = _atom(found[1])
        exponent = sign * Fraction(found[2] or 1)
        if atom is None or abs(exponent) > _LARGEST_EXPONENT or exponent.denominator > 1000:
            return None
        dimension = times(dimension, raised(atom[0], whole(exponent)))
        powers.append((atom[1], exponent))
        at = found.end()
        if at == len(text):
            factor = _product(powers)
            dimension = tuple([whole(e) for e in dimension])
            return None if factor is None else Unit(text, dimension, factor)
        if text[at] not in "./" or len(powers) > _LARGEST_EXPONENT:
            return None
        sign = -1 if text[at] == "/" else 1
        at += 1


def scale(theirs: Unit, ours: Unit) -> tuple[Fraction, Fraction]:
    """Factor and offset from readings in one unit to readings in another of the same dimension.

    Those of a thermometer count from the zero of their scale, unlike differences of temperatures.

    >>> scale(parse_unit("degF"), parse_unit("degC"))  # 32 degF is 0 degC
    (Fraction(5, 9), Fraction(-160, 9))
    """
    zero = _ZEROS.get(theirs.text, Fraction(0)) - _ZEROS.get(ours.text, Fraction(0))
    return theirs.factor / ours.factor, zero / ours.factor


def describe(dimension: Dimension) -> str:
    """A unit that a person would write for `dimension`; `parse_unit` reads it back.

    A dimension has many names: of N.m, J and of V.s/rad, N.m/A this gives the mechanical one. An
    exponent that is no short decimal is written as (1/3), which is only for the eye.

    >>> describe((2, 1, -2, -1, 0, 0, 0)), describe((2, 1, 0, 0, 0, 0, 0)), describe(NONE)
    ('N.m/A', 'kg.m^2', '1')
    """
    while dimension not in _described:
        text = next(_written, None)  # no further than this dimension needs
        if text is None:
            _described[dimension] = _compose(dimension)
            break
        unit = parse_unit(text)
        if unit is not None:
            _described.setdefault(unit.dimension, text)
    return _described[dimension]


def suggest_unit(text: str) -> str | None:
    """The unit that `text`, which is none, was probably meant to be, spelt as it has to be.

    >>> suggest_unit("Nm/A"), suggest_unit("kg*m²"), suggest_unit("J/(kg.K)"), suggest_unit("ohms")
    ('N.m/A', 'kg.m^2', 'J/kg/K', 'Ohm')
    """
    if len(text) > _LONGEST_TEXT:  # nobody meant that
        return None
    flat = text.strip().strip("[]").translate(_SUPERSCRIPTS).replace("**", "^")
    flat = re.sub("[*·×⋅]| +", ".", flat)
    flat = re.sub(r"\(([^()]*)\)", _opened, flat)
    flat = re.sub(r"(?<=[^\W\d])\^?\+?(-?\d)", r"^\1", flat).strip(".")
    parts = re.split("([./])", flat)
    for place in range(0, len(parts), 2):
        name, power, exponent = parts[place].partition("^")
        known = name if _atom(name) else _respelt(name)
        if known is None:
            return None
        parts[place] = known + power + exponent
    result = "".join(parts)
    return result if result != text and parse_unit(result) else None


def _opened(found: re.Match[str]) -> str:
    """The inside of brackets; after a `/` every factor of it is a divisor."""
    if not found.string[: found.start()].endswith("/"):
        return found[1]
    return found[1].replace("/", "\0").replace(".", "/").replace("\0", ".")


@lru_cache(10_000)  # the same ends of a name are met again and again
def _respelt(name: str) -> str | None:
    lower = name.lower()
    if lower in _WORDS:
        return _WORDS[lower]
    if lower.endswith("s") and len(name) > 3:
        singular = _respelt(name[:-1]) if lower[:-1] not in _entries() else lower[:-1]
        if singular is not None and "." not in singular:
            return singular
    for known in _entries():
        if known.lower() == lower:
            return known
    from difflib import get_close_matches  # only for a message

    typo = get_close_matches(name, list(_entries()), 1, 0.85)
    if typo:
        return typo[0]
    prefixed = _with_prefix(name)
    if prefixed:
        return prefixed
    word = get_close_matches(lower, list(_WORDS), 1, 0.85) if len(name) > 3 else []
    if word:
        return _WORDS[word[0]]
    for length in range(len(name) - 1, 0, -1):  # Nm, As, kgm: two names without the dot
        if _atom(name[:length]):
            rest = name[length:]
            second = rest if _atom(rest) else _respelt(rest) if len(rest) > 1 else None
            if second:
                return f"{name[:length]}.{second}"
    close = get_close_matches(name, list(_entries()), 1, 0.75)
    return close[0] if close and len(name) > 2 else None


def _with_prefix(name: str) -> str | None:
    """A unit whose prefix or whose name is a word, `mHenry` or `microF`; never without its prefix.

    >>> _with_prefix("mHenry"), _with_prefix("microF"), _with_prefix("kilonewtons")
    ('mH', 'uF', 'kN')
    """
    found = [(p, s) for p, s in _PREFIX_WORDS.items() if name.lower().startswith(p)]
    found += [(p, p) for p in _PREFIXES if name.startswith(p)]
    for prefix, symbol in found:
        rest = name[len(prefix) :]
        known = _WORDS.get(rest.lower()) or _WORDS.get(rest.lower().removesuffix("s"))
        for unit in (symbol + rest, symbol + (known or "")):
            if unit != symbol and _atom(unit):
                return unit
    return None


def _compose(dimension: Dimension) -> str:
    """As few factors as possible: one derived unit, the rest in base units."""
    best: tuple[float, str] | None = None
    for name in ("1", "N", "V", "W", "Pa", "A", "K", "Ohm", "mol", "N.m"):
        unit = parse_unit(name)
        assert unit is not None
        for power in (1,) if "." in name else (1, -1, 2, -2, 3, -3):
            rest = times(dimension, raised(unit.dimension, -power))
            factors = [(name, Fraction(power))] if name != "1" else []
            factors += [(b, Fraction(e)) for b, e in zip(_BASE, rest, strict=True) if e]
            above = [_factor(n, e) for n, e in factors if e > 0]
            below = ["/" + _factor(n, -e) for n, e in factors if e < 0]
            text = (".".join(above) or "1") + "".join(below)
            cost = len(factors) + sum(float(abs(e)) for _, e in factors) / 8
            if best is None or cost < best[0]:
                best = cost, text
    assert best is not None
    return best[1]


def _factor(name: str, exponent: Fraction) -> str:
    if exponent == 1:
        return name
    text = str(exponent.numerator if exponent.denominator == 1 else float(exponent))
    return f"{name}^{text if Fraction(text) == exponent else f'({exponent})'}"


@cache
def _atom(name: str) -> _Entry | None:
    if name == "1":
        return NONE, Fraction(1)
    name = name.replace("\N{OHM SIGN}", "Ω")
    if name in _entries():
        return _entry(name)
    for length in (1, 2):
        prefix, rest = name[:length], name[length:]
        if prefix in _PREFIXES and rest in _entries() and _entries()[rest][2]:
            dimension, factor = _entry(rest)
            return dimension, factor * Fraction(10) ** _PREFIXES[prefix]
    return _from_pint(name)


@cache
def _entries() -> dict[str, tuple[str, str, bool]]:
    """By name: a product of base units, the factor to it, and whether prefixes are allowed."""
    rows = [item.split() for item in _TABLE.replace("\n", "|").split("|") if item]
    return {n.removesuffix("+"): (base, factor, n[-1] == "+") for n, base, factor in rows}


def _entry(name: str) -> _Entry:
    base, factor, _ = _entries()[name]
    dimension = [0] * len(_BASE)
    for part in [] if base == "1" else base.split("."):
        symbol, _, exponent = part.partition("^")
        dimension[_BASE.index(symbol)] += int(exponent or 1)
    above, _, below = factor.partition("/")
    value = Fraction(1)
    if above.endswith("pi"):
        value, above = PI, above.removesuffix("pi") or "1"
    return tuple(dimension), value * Fraction(above) / Fraction(below or 1)


def _product(powers: list[tuple[Fraction, Fraction]]) -> Fraction | None:
    """The product of all base^exponent, exact where it is rational; None beyond any double."""
    whole_part, rooted = Fraction(1), [p for p in powers if p[1].denominator != 1 and p[0] != 1]
    for base, exponent in powers:
        if exponent.denominator == 1:
            whole_part *= base**exponent.numerator
    if not Fraction(1, 10**300) < whole_part < 10**300:
        return None
    if not rooted:
        return whole_part
    root = lcm(*[e.denominator for _, e in rooted])
    if root <= _LARGEST_ROOT:
        radicand = Fraction(1)
        for base, exponent in rooted:
            radicand *= base ** int(exponent * root)
        above = _exact_root(radicand.numerator, root)
        below = _exact_root(radicand.denominator, root)
        if above is not None and below is not None:
            return whole_part * Fraction(above, below)
    result = Decimal(1)
    for base, exponent in rooted:
        number = _ROOT.divide(Decimal(base.numerator), Decimal(base.denominator))
        power = _ROOT.divide(Decimal(exponent.numerator), Decimal(exponent.denominator))
        result = _ROOT.multiply(result, _ROOT.power(number, power))
    factor = whole_part * Fraction(result)
    return factor if Fraction(1, 10**300) < factor < 10**300 else None


def _exact_root(value: int, root: int) -> int | None:
    """The integer whose power `root` is `value`, or None."""
    low, high = 0, 1 << (value.bit_length() // root + 1)
    while low < high:
        middle = (low + high) // 2
        if middle**root < value:
            low = middle + 1
        else:
            high = middle
    return low if low**root == value else None


def _from_pint(name: str) -> _Entry | None:
    """A unit of Pint where that is installed; short names are constants there (`c`, `R`)."""
    if len(name) < 3 or not name.isalpha():
        return None
    try:
        pint = import_module("pint")
    except ImportError:
        return None
    known = {"meter": 0, "kilogram": 1, "second": 2, "ampere": 3, "kelvin": 4, "mole": 5,
             "candela": 6, "radian": -1}  # fmt: skip
    try:
        factor, units = pint.UnitRegistry(non_int_type=Fraction).get_base_units(name)
    except Exception:  # Pint fails in a dozen ways on a text that is no unit
        return None
    dimension: list[Fraction | int] = [0] * len(_BASE)
    for base, exponent in units._units.items():
        place = known.get(base)
        if place is None:
            return None
        if place >= 0:
            dimension[place] += whole(Fraction(exponent))
    value = Fraction(factor)
    return (tuple(dimension), value) if value > 0 else None


def _domain(name: str, effort: str, flow: str, effort_name: str, flow_name: str) -> Domain:
    first, second = parse_unit(effort), parse_unit(flow)
    return Domain(
        name,
        first and first.dimension,
        second and second.dimension,
        effort_name,
        flow_name,
        effort,
        flow,
    )


#: Effort and flow of each domain. `thermal` is the true bond graph (their product is power);
#: `thermofluid` is the usual pseudo bond graph of heat and enthalpy flow.
DOMAINS: dict[str, Domain] = {
    d.name: d
    for d in (
        _domain("electrical", "V", "A", "voltage", "current"),
        _domain("rotation", "N.m", "rad/s", "torque", "angular velocity"),
        _domain("translation", "N", "m/s", "force", "velocity"),
        _domain("hydraulic", "Pa", "m^3/s", "pressure", "volume flow"),
        _domain("thermal", "K", "W/K", "temperature", "entropy flow"),
        _domain("thermofluid", "K", "W", "temperature", "heat flow"),
        _domain("chemical", "J/mol", "mol/s", "chemical potential", "molar flow"),
        _domain("any", "", "", "effort", "flow"),
    )
}
