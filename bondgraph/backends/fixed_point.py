"""Fixed-point scaling: a residual program in 32-bit integers, with proof and bound of its error.

Each value gets the largest range that it can have while the samples are in theirs: what is a sum of
samples past and present by its peak gains, what a function makes of that by interval arithmetic.
Its scale is the finest power of two at which that range, and every sum on the way there, fits. Each
rounding is then one more input of the same recursion, and its peak gains say what it does to a
residual (Lopez, Hilaire and Didier, 2014). What is not bounded, or has no form, is refused.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from hashlib import sha256

from bondgraph.backends.blocks import blocks
from bondgraph.backends.fixed_errors import Errors
from bondgraph.backends.fixed_ranges import Ranges
from bondgraph.backends.fixed_scales import Scales, sample_bits
from bondgraph.backends.nominal_coefficients import nominal
from bondgraph.backends.parts import begun, step_part
from bondgraph.backends.straight_line import Unrepresentable
from bondgraph.ir.fixed_program import SAMPLE_BITS, Deviation, FixedProgram, Limits
from bondgraph.ir.program import Known, Program, Ref
from bondgraph.text.diagnostic import Report
from bondgraph.text.numerals import joined


def fixed_point(
    program: Program, ranges: Mapping[str, tuple[float, float]], report: Report
) -> FixedProgram | None:
    """`step` of a program in integers; `ranges` by path of a signal, or by name of an integral.

    None, with all reasons in the report, where it cannot be had or a range is missing.
    """
    part = begun(step_part(program))
    try:
        _check_program(part)
    except Unrepresentable as error:
        _refuse(error, f"The residuals of {program.name}", report)
        return None
    samples = _samples(part, ranges, report)
    return None if report.failed else _fixed(part, samples, ranges, report)


def _refuse(error: Unrepresentable, whose: str, report: Report) -> None:
    labels = [error.origin] if error.origin is not None else []
    report.error(
        "no-fixed-point",
        f"{whose} {error.why}: not to be had in fixed point.",
        *labels,
        help=error.remedy or "Without `--real fixed` the code computes it in double or float.",
    )


def _samples(
    part: Program, ranges: Mapping[str, tuple[float, float]], report: Report
) -> dict[str, Limits]:
    """The limits of all signals that are read; the report says which have no range."""
    read = {name for block in blocks(part) for name in block.knowns}
    found = {}
    for known in part.knowns:
        if known.name in read:
            try:
                found[known.name] = _limits(known, ranges)
            except Unrepresentable as error:
                _refuse(error, f"The signal `{known.path}`", report)
    return found


def _fixed(
    part: Program,
    samples: dict[str, Limits],
    ranges: Mapping[str, tuple[float, float]],
    report: Report,
) -> FixedProgram | None:
    known = nominal(part)
    if known is None:
        wanting = Unrepresentable("have parameters without a value, or too many coefficients")
        _refuse(wanting, f"The residuals of {part.name}", report)
        return None
    coefficients = {
        Ref("coef", field.name, k): value
        for field, values in zip(part.coefs, known.coefficients, strict=True)
        for k, value in enumerate(values)
    }
    origins = {r.name: r.origin for r in part.residuals}
    found = []
    residuals: dict[str, Deviation] = {}
    bits = sample_bits(samples)
    for block in blocks(part):
        try:
            own = Ranges(part, block, coefficients, samples, ranges)
            scales = Scales(own)
            found.append(scales.block())
        except Unrepresentable as error:
            error.origin = error.origin or origins[block.residuals[0]]
            _refuse(error, f"The residual {joined([f'`{r}`' for r in block.residuals])}", report)
            continue
        errors = Errors(own, scales)
        for name in block.residuals:
            residuals[name] = errors.deviation(Ref("residual", name))
        bits |= scales.bits
    if report.failed:
        return None
    scaled = f"{part.digest} {sorted(samples.items())}".encode()
    part = part._replace(digest=sha256(scaled).hexdigest()[: len(part.digest)])
    return FixedProgram(part, tuple(found), samples, residuals, bits, known.settle)


def _check_program(part: Program) -> None:
    for known in part.knowns:
        if known.kind == "mode":
            raise Unrepresentable(f"read the switch `{known.path}`", known.origin)
    for what, there in (
        ("remember past samples for a delay", part.delayed),
        ("start anew where switches turn", part.openings),
        ("solve equations at each sample", part.roots),
    ):
        if there:
            raise Unrepresentable(what)
    if not blocks(part):
        raise Unrepresentable("are none that `step` ever has")


def _limits(known: Known, ranges: Mapping[str, tuple[float, float]]) -> Limits:
    """What a sample may be: where it has both signs, to the next power of two."""
    path, unit = known.path, known.unit
    if known.counts is not None:
        unit = "counts from one sample to the next"
    if path not in ranges:
        raise Unrepresentable(
            "has no range",
            known.origin,
            f"Say `--range {path}=LOW..HIGH`{f' in {unit}' if unit else ''}, or give a log in"
            " which it is not always 0 with `--ranges LOG`.",
        )
    low, high = ranges[path]
    largest = max(abs(low), abs(high))
    if known.counts is not None:
        if largest > 2.0**SAMPLE_BITS:
            raise Unrepresentable(f"has a range of more than 2^{SAMPLE_BITS} counts", known.origin)
        bits = SAMPLE_BITS - math.frexp(largest)[1]
        return Limits(bits, math.ceil(low), math.floor(high), low, high)
    power = math.frexp(largest)[1] - (math.frexp(largest)[0] == 0.5)
    bits = SAMPLE_BITS - power
    if low < 0.0 < high:
        size = 2.0**power
        return Limits(bits, -(1 << SAMPLE_BITS), (1 << SAMPLE_BITS) - 1, -size, size)
    least, most = math.ceil(math.ldexp(low, bits)), math.floor(math.ldexp(high, bits))
    return Limits(bits, least, most, low, high)
