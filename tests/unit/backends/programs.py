"""Residual programs written by hand, one for each thing that a program can contain."""

from __future__ import annotations

from collections.abc import Callable

from bondgraph.ir.program import (
    Assign,
    Choice,
    Compare,
    Condition,
    Const,
    Dot,
    DotTerm,
    Expression,
    Field,
    Function,
    Known,
    Logic,
    Mode,
    PolynomialTape,
    Product,
    Program,
    Ref,
    ResidualInfo,
    Statement,
    Sum,
    TapeOp,
    TapeOutput,
)
from bondgraph.text.source import Source, Span

_SOURCE = Source("models/motor.bg", "bg 1\nmodel Motor {\n    1:i { <- Se:U; -> R:R }\n}\n")


def line(number: int) -> Span:
    """A place in the model."""
    start = sum(len(text) + 1 for text in _SOURCE.text.split("\n")[: number - 1])
    return Span(_SOURCE, start, start + 1)


def ref(text: str) -> Ref:
    """`coef:a`, `known:y:1`: a value by space, name and order."""
    space, name, *order = text.split(":")
    return Ref(space, name, int(order[0]) if order else 0)  # type: ignore[arg-type]


def plus(*terms: Expression) -> Sum:
    return Sum(tuple((True, t) for t in terms))


def minus(left: Expression, right: Expression) -> Sum:
    return Sum(((True, left), (False, right)))


def times(*factors: Expression) -> Product:
    return Product(factors)


def over(above: Expression, *below: Expression) -> Product:
    return Product((above,), below)


def put(target: str, value: Expression, comment: str = "", at: int | None = 3) -> Assign:
    return Assign(ref(target), value, comment, line(at) if at else None)


def known(name: str, highest: int = 0, **more: object) -> Known:
    base = Known(name, name, "V", f"signal {name}", "sensor", highest, False, None, line(3))
    return base._replace(**more)  # type: ignore[arg-type]


def program(name: str, residuals: tuple[ResidualInfo, ...], **parts: object) -> Program:
    base = Program(
        name=name,
        title=f"A model called {name}",
        source="motor.bg",
        digest="0123456789abcdef",
        params=(),
        knowns=(),
        coefs=(),
        states=(),
        residuals=residuals,
        configure=(),
        exact=(),
        first=(),
        step=(),
        dropped=(),
        rate=1000.0,
        bandwidth=20.0,
        warmup=5.0,
        tables=(),
    )
    return base._replace(**parts)  # type: ignore[arg-type]


def residual(name: str, faults: tuple[str, ...] = (), settle: float = 5.0) -> ResidualInfo:
    return ResidualInfo(name, name, "U - R*i - L*i'", 1, 2, faults, (), line(3), settle)


def first_order(prefix: str, value: Expression) -> tuple[list[Assign], list[Assign], list[Field]]:
    """One stage of a low-pass filter: r = x + (1 - a) * (value - x)."""
    state = f"state:{prefix}_x"
    first = [put(state, value, "filter at rest"), put(f"residual:{prefix}", value, "filter")]
    step = [
        put(f"local:{prefix}_v", value, "the sum of the terms"),
        put(
            state,
            plus(ref(state), times(ref("coef:b"), minus(ref(f"local:{prefix}_v"), ref(state)))),
            "first-order stage",
        ),
        put(f"residual:{prefix}", ref(state), "first-order stage"),
    ]
    return first, step, [Field(f"{prefix}_x", "", "", f"filter of {prefix}", None, line(3))]


_FILTER: tuple[Statement, ...] = (
    put(
        "local:phase",
        times(ref("option:bandwidth"), ref("option:sample_time")),
        "angle of the filter in one sample",
        None,
    ),
    put(
        "coef:b",
        minus(Const(1.0), Function("exp", (Sum(((False, ref("local:phase")),)),))),
        "gain of a first-order stage",
        None,
    ),
)
_B = Field("b", "", "", "gain of a first-order stage")


def motor() -> Program:
    """Two residuals that share nothing; the second is a difference of two signals."""
    relation = Sum(
        (
            (True, ref("known:U")),
            (False, times(ref("coef:R"), ref("known:i"))),
        )
    )
    exact = Sum((*relation.terms, (False, times(ref("coef:L"), ref("known:i:1")))))
    one, one_step, one_states = first_order("r1", relation)
    two, two_step, two_states = first_order("r2", minus(ref("known:y"), ref("known:y2")))
    params = (
        Field("R", "el.R", "Ohm", "resistance", 17.6, line(3)),
        Field("L", "el.L", "H", "inductance of the armature, which is small", 3e-4, line(2)),
    )
    return program(
        "Motor",
        (residual("r1", ("U", "R", "L", "i")), residual("r2", ("y", "y2"))),
        params=params,
        knowns=(known("U", kind="input"), known("i", 1, unit="A"), known("y"), known("y2")),
        coefs=(Field("R", "", "", "R"), Field("L", "", "", "L"), _B),
        states=(*one_states, *two_states),
        configure=(
            put("coef:R", ref("param:R"), "R"),
            put("coef:L", ref("param:L"), "L"),
            *_FILTER,
        ),
        exact=(
            put("residual:r1", exact, "U - R*i - L*i'"),
            put("residual:r2", minus(ref("known:y"), ref("known:y2")), "y - y2"),
        ),
        first=(*one, *two),
        step=(*one_step, *two_step),
    )


def encoder() -> Program:
    """An encoder, a mode, a symbolic parameter, integrals and names that are words of C."""
    speed = times(ref("coef:scale"), ref("increment:int"))
    angle = times(ref("coef:scale"), ref("total:int"))
    value = Sum(
        (
            (True, angle),
            (True, Choice(Mode("register"), speed, Const(0.0))),
            (False, ref("known:class")),
        )
    )
    first, step, states = first_order("r1", value)
    exact = Sum(
        (
            (True, minus(ref("known:int"), ref("start:int"))),
            (True, Choice(Mode("register"), ref("known:int:-1"), ref("integral:double"))),
            (False, times(ref("known:class:-1"), ref("coef:scale"))),
            (True, times(Const(0.125), ref("known:class:-2"))),
            (True, times(Const(-2.0), ref("time:time"))),
        )
    )
    return program(
        "RobotArm",
        (residual("r1", ("int", "class")),),
        params=(Field("lambda", "lambda", "rad", "angle of a count", None, line(2)),),
        knowns=(
            known("int", 0, counts=24.0, unit="rad", integral=True, lowest=-1, start=True),
            known("class", -1, integral=True, lowest=-2),
            known("register", 0, kind="mode", unit=""),
        ),
        coefs=(Field("scale", "", "", "angle of one count"), _B),
        states=tuple(states),
        configure=(put("coef:scale", ref("param:lambda"), "angle of one count"), *_FILTER),
        exact=(put("residual:r1", exact, "the relation"),),
        first=tuple(first),
        step=tuple(step),
        integrals=(Field("double", "", "", "integral of something nonlinear", None, line(3)),),
    )


_UNARY = (
    "abs sign sqrt cbrt ssqrt ssq exp log sin cos tan asin acos atan sinh cosh tanh asinh atanh"
).split()


def functions() -> Program:
    """Every function, table and condition, on signals between 0 and 1."""
    y, z = ref("known:y"), ref("known:z")
    small = times(Const(0.5), y)
    terms: list[Expression] = [Function(name, (small,)) for name in _UNARY]
    terms += [
        Function("acosh", (plus(Const(1.5), y),)),
        Function("pow", (y, Const(1.5))),
        Function("pow", (y, Const(3.0))),
        Function("pow", (minus(y, z), Const(-2.0))),
        Function("pow", (plus(y, z), Const(7.0))),
        Function("min", (y, z)),
        Function("max", (y, z)),
        Function("atan2", (y, z)),
        Function("table:pump", (times(Const(3.0), y),)),
        Function("table:constant.csv", (y,)),
    ]
    conditions: list[Condition] = [
        Compare("<", y, z),
        Compare("<=", y, plus(z, Const(0.25))),
        Compare("==", y, z),
        Logic("not", (Compare("==", y, z),)),
        Logic("and", (Compare("<", y, z), Logic("or", (Mode("on"), Compare("<", z, y))))),
        Logic("not", (Logic("or", (Mode("on"), Compare("<", z, y))),)),
        Logic("not", (Mode("on"),)),
    ]
    terms += [Choice(c, times(Const(float(k)), y), z) for k, c in enumerate(conditions)]
    terms.append(Choice(Mode("on"), Choice(Compare("<", y, z), y, Const(-1.0)), Const(-0.5)))
    exact = [put(f"local:t{k}", term, f"term {k}") for k, term in enumerate(terms)]
    total = plus(*[ref(f"local:t{k}") for k in range(len(terms))])
    values = {f"t{k}": term for k, term in enumerate(terms)}
    first, step, states = first_order("r1", plus(*values.values()))
    return program(
        "Laws",
        (residual("r1", ("y", "z")),),
        knowns=(known("y"), known("z"), known("on", kind="mode")),
        coefs=(_B,),
        states=tuple(states),
        configure=_FILTER,
        exact=(*exact, put("residual:r1", total, "all of it")),
        first=tuple(first),
        step=tuple(step),
        tables=(
            ("pump", ((0.0, 0.0), (0.5, 2.0), (1.25, 1.0), (2.5, -1.0))),
            ("constant.csv", ((0.0, 3.5),)),
        ),
    )


def ladder(cells: int = 5) -> Program:
    """A chain of RC cells: its polynomial by a tape, its residual by loops.

    With i = the current and v = the voltage behind a cell, in front of it
    v' = v + R*i and i' = i + C*p*v'; the tape keeps v in row 0 and i in row 1.
    """
    length = cells + 1
    ops = [TapeOp(1, 0, 0, 2, 1, True)]
    for cell in range(cells):
        size = min(length, cell + 1)
        ops.append(TapeOp(0, 1, 0, 0, size, False))
        ops.append(TapeOp(1, 0, 1, 1, min(size, length - 1), False))
    tape = PolynomialTape(
        "r1",
        length,
        2,
        (ref("local:cell_R"), times(ref("param:C"), ref("option:time_unit")), Const(0.0)),
        tuple(ops),
        (TapeOutput("y_polynomial", 0, length), TapeOutput("one", 0, 1)),
        "the transfer function of the chain",
        line(3),
    )
    exact = Dot(
        ref("local:chain"),
        (DotTerm("y_polynomial", "y", length), DotTerm("one", "U", 1)),
        "all derivatives",
        line(3),
    )
    first, step, states = first_order("r1", minus(ref("known:U"), ref("known:y")))
    return program(
        "Ladder",
        (residual("r1", ("U", "R", "C", "y")),),
        params=(
            Field("R", "R", "Ohm", "of all cells", 3.2, line(2)),
            Field("C", "C", "F", "of a cell", 1.1e-2, line(2)),
        ),
        knowns=(known("U", kind="input"), known("y", cells)),
        coefs=(
            Field("y_polynomial", "", "", "polynomial of y", None, line(3), length),
            Field("one", "", "", "polynomial of U", None, line(3), 1),
            _B,
        ),
        states=tuple(states),
        configure=(
            put("local:cell_R", over(ref("param:R"), Const(float(cells))), "R of a cell"),
            tape,
            *_FILTER,
        ),
        exact=(exact, put("residual:r1", minus(ref("known:U"), ref("local:chain")), "r1")),
        first=tuple(first),
        step=tuple(step),
        time_unit=0.5,
    )


def silent() -> Program:
    """A residual that step cannot give, and no parameters at all."""
    return program(
        "Silent",
        (residual("r1", ("y",))._replace(unavailable="its order is too high"),),
        knowns=(known("y", sampled=False),),
        exact=(put("residual:r1", times(Const(-1.0), ref("known:y")), "-y"),),
    )


def unwritten() -> Program:
    """A residual that exact does not have, beside one that it has."""
    return program(
        "Unwritten",
        (residual("r1", ("y",)), residual("r2", ("y",))._replace(unwritten="it is too long")),
        knowns=(known("y"),),
        exact=(put("residual:r1", times(Const(2.0), ref("known:y")), "2 y"),),
        first=(put("residual:r1", ref("known:y")), put("residual:r2", ref("known:y"))),
        step=(put("residual:r1", ref("known:y")), put("residual:r2", ref("known:y"))),
    )


ALL = (motor, encoder, functions, ladder, silent, unwritten)

Maker = Callable[[], Program]
