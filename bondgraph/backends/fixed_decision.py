"""What `diagnose` decides by in whole numbers: limits at the scale of each residual, or a refusal.

What is compared is exact but for the rounding of the limits; nothing overflows for any residual of
32 bits and any limits of `whole_limit`: off is below 2^32 and what its bound leaves of it below
2^33, a factor is at most 2^30, a root is cut off at 2^31 before it is squared, and a sum of 64 bits
is kept within 32 of them.
"""

from __future__ import annotations

import math

from bondgraph.backends import decision, listing
from bondgraph.backends.decision import EIGHTH, FIRST, Tuned
from bondgraph.backends.target import Target
from bondgraph.ir.fixed_program import (
    ROOT_BITS,
    SUM_BITS,
    Deviation,
    FixedProgram,
    WholeLimit,
)
from bondgraph.ir.residual_limit import NEVER, OVERSHOOT, SHARE, ResidualLimit
from bondgraph.text.diagnostic import Report

#: A residual that rounds by more of its level than this is not decided by: that would be a quarter
#: of the deviation of its noise, where half of one is what a sum forgives.
ROUGH = 1.0 / 16.0
EIGHTH_BITS = 28
_ANY = (1 << 32) - 1  # a level that no residual of 32 bits exceeds
_MOST = (1 << 31) - 1
_FACTOR_BITS, _SHIFT = 30, 62
_OVERSHOOT = round(math.ldexp(OVERSHOOT, SUM_BITS))
#: Heights of sums are below; twice a height has to fit in 31 bits.
HIGHEST = math.ldexp(1 << 30, -SUM_BITS) - 2.0 * OVERSHOOT
_DOUBLE = "without `--real fixed` the code decides in double or float."


def fixed_limits(fixed: FixedProgram, tuned: Tuned, report: Report) -> FixedProgram | None:
    """The program with the limits of a tuning; None, with all reasons in the report, without some.

    >>> from bondgraph.backends.decision import UNTUNED
    >>> import bondgraph
    >>> ranges = {"load": (-1e-3, 1e-3), "U": (-12, 12), "current": (-1, 1), "speed": (0, 300)}
    >>> c = bondgraph.compile("models/dc_motor.bg", real="fixed", ranges=ranges)
    >>> fixed_limits(c.fixed_program, UNTUNED, Report()).limits
    ()
    """
    if not tuned.source:
        return fixed
    found = []
    for info in fixed.program.residuals:
        limit, scale = tuned.limits.get(info.name, NEVER), fixed.residuals.get(info.name)
        if limit.level >= NEVER.level or scale is None:
            found.append(_NEVER)
            continue
        cannot = _cannot(limit, scale)
        if cannot is not None:
            why, remedy = cannot
            report.error(
                "no-fixed-point",
                f"The residual `{info.name}` {why}: `diagnose` is not to be had in fixed point.",
                *([info.origin] if info.origin is not None else []),
                help=f"{remedy}; {_DOUBLE}",
            )
        found.append(whole_limit(limit, scale.bits))
    return None if report.failed else fixed._replace(limits=tuple(found))


def _cannot(limit: ResidualLimit, scale: Deviation) -> tuple[str, str] | None:
    """Why whole numbers do not decide as double does, and what to do; None if they do."""
    rough = max(scale.fixed, math.ldexp(1.0, -scale.bits))
    if rough > ROUGH * limit.level:
        return (
            f"is right to {rough:.2g} in whole numbers, and its level in the tuning is"
            f" {limit.level:.2g}",
            "Narrower ranges of its signals (`--range`) round less",
        )
    if abs(limit.mean) > scale.largest:
        return (
            f"stands at {limit.mean:.2g} in the log of the tuning, and samples within their ranges"
            f" make it {scale.largest:.2g} at most",
            "Ranges (`--range`, `--ranges`) have to hold the log of the tuning",
        )
    if HIGHEST < limit.height < NEVER.height:
        return (
            f"has sums up to {limit.height:.3g} while the machine is well, above {HIGHEST:.0f}",
            "A log in which it is as loud all the time makes lower sums",
        )
    return None


def whole_limit(limit: ResidualLimit, bits: int) -> WholeLimit:
    """A limit in whole numbers, of a residual that is times 2**`bits`.

    >>> whole_limit(ResidualLimit(0.0, 3.5, 0.0, 0.0, 0.5, 1e30, 0.25), 2)[:3]
    (0, 14, 1)
    """
    unit, unit_shift = _factor(limit.unit, SUM_BITS - bits)
    loud, loud_shift = _factor(math.sqrt(limit.loud), ROOT_BITS - bits)
    never = limit.height >= NEVER.height
    return WholeLimit(
        max(-_MOST, min(_MOST, round(_times(limit.mean, bits)))),
        min(_ANY, math.floor(_times(limit.level, bits))),
        min(_ANY, round(_times(limit.bound, bits))),
        unit,
        loud,
        min(_MOST, round(_times(limit.drift, SUM_BITS))),
        _MOST if never else min(_MOST, round(_times(limit.height, SUM_BITS))),
        unit_shift,
        loud_shift,
    )


#: That of a residual that never is in alarm.
_NEVER = WholeLimit(0, _ANY, 0, 0, 0, 1 << (SUM_BITS - 1), _MOST, 0, 0)


def _times(value: float, bits: int) -> float:
    return math.ldexp(min(max(value, -1e60), 1e60), bits)


def _factor(value: float, bits: int) -> tuple[int, int]:
    """A number times 2**bits as a whole number of 30 bits and how far its products are shifted."""
    if value <= 0.0:
        return 0, 0
    shift = max(0, min(_SHIFT, _FACTOR_BITS - bits - math.frexp(value)[1]))
    return min(1 << _FACTOR_BITS, round(math.ldexp(value, bits + shift))), shift


def c_holes(fixed: FixedProgram, tuned: Tuned, target: Target) -> dict[str, object]:
    """The holes of the templates of `diagnose` in whole numbers."""
    eighths = [f"{round(math.ldexp(EIGHTH**n, EIGHTH_BITS))}," for n in range(8)]
    rows = [[*map(str, own[:1]), *(f"{x}u" for x in own[1:3]), *map(str, own[3:7]),
             *(f"{x}u" for x in own[7:])] for own in fixed.limits]  # fmt: skip
    return {
        **decision.c_holes(fixed.program, tuned, target),
        "limits": decision.limit_lines(rows, target),
        "sum_type": "int32_t",
        "peak_type": "uint8_t",
        "level_type": "uint32_t",
        "wide": "int64_t",
        "wrap": "\n    ",
        "level": "(int64_t)limit->level",
        "not_quiet": "2 * out >= (int64_t)limit->level",
        "peak_code": "(int)d->peak[k]",
        "no_peak": "0u",
        "sum_bits": SUM_BITS,
        "half": 1 << (SUM_BITS - 1),
        "overshoot": _OVERSHOOT,
        "share": round(math.ldexp(SHARE, 32)),
        "square_shift": 2 * ROOT_BITS - SUM_BITS,
        "eighth": listing.table_lines(eighths, target, 4),
        "eighth_bits": EIGHTH_BITS,
        "eighth_shift": EIGHTH_BITS - round(math.log2(FIRST)),
    }
