"""Texts that are right and texts that are wrong, for several tests."""

from __future__ import annotations

from pathlib import Path

#: Bodies of models that are right.
RIGHT = [
    "sensor s =\n let counts 24/turn", "let a = b +\n param and c",
    "R:r(x = 1) =\n        2 {\n port x\n e = f\n}",
    "", "R:a", "Se:U -> R:r = 2 Ohm", "a -> b; b <- c", "a -[7]-> 1:j <-[x2]- Se:U",
    "1:i { -> a; <- b\n-> c }", "1:i {}", "out { -> C:Cs = line.C; -> De:Us }",
    "Se:U -> 1:i { -> I:L; -> R:r }", "a <- 0:n when on { <- b\n -> c }", "a -> m[1].p { }",
    "1:i { -> 0:n { -> C:c }; <- a -> m { } }", "for j in 1..2 { a -> 0:k[j] { -> b[j] } }",
    "0:n[3] { -> R:r[2] }", "1:sw when on and not off { -> R:r }", "port a : in electrical",
    "port port : out any", "param R = 17.6 Ohm +- 5%", "param R : N.m.s/rad",
    "const g = 9.81 m/s^2", "param a = -4", "param n[2] = 3", "param z : 1",
    "param R = 3 Ohm ± 2 Ohm", "input U : V", "input road : m/s unknown", "input on : bool",
    "input x unknown", "input Fx[2] : N", "input u",
    "sensor th : rad = int(crank.f) counts 24/turn", "sensor s = x.e", "let a = x<-1",
    "sensor s = x counts (n + 1)*2/turn", "sensor s = 2 counts 24/turn", "let b = not a < 1 or c",
    "let a = -x^-2*3", "let a = 2^3^2", "let a = if(x > 0, 1, ssqrt(x))", "let a = f()",
    'let y = table("file.csv", x)', "let a = 2 m^3/s.Pa^-0.5", "let a = 5 m/x", "let a = 5 m / x",
    "let a = 5 1/s", "let a = (b +\n c)", "let a = b +\n c", "let a =\n b", "let a = f(b,\n c\n)",
    "let a = true", "let a = false == b", "let if_ = if", "fault cable_cut : line.R += 100 Ohm",
    "fault stuck : m[1].el.Re = 0", "fault slow : k *= 0.5",
    "for j in 1..2 { Se:U0[j] -> m[j].a }", "for j in 1..n - 1 {\n a -> b\n}",
    "if n > 2 { R:r } else { R:s }", "if fast { }\nelse { }",
    "if n == 1 { R:r } else if n == 2 { R:s } else { R:t }", "if (n > 1) { R:r }",
    "1:i { if n > 1 { -> R:r } else { <- Se:U }; for j in 1..3 { -> R:q[j] } }",
    "1:i { param R = 1 Ohm; -> R:R; let x = i.f }", "Cell:cell[n](R = R/n, L = L/n, C = C/n)",
    "a -> cell[1..n] -> b", "Mechanical:me(w = -w)", "C:spring(q0 = 0 rad) = 1/K",
    "A:b(c.d[2] = 3,\n e = 4)", "fast -> TF:N { f1 = N*f2 } -> slow", "R:d { e = Fc*tanh(f/v0) }",
    "C:mic { port el; port mech; el.e = el.q*mech.q/eA; mech.e = el.q^2/(2*eA) }",
    "R:x {\n 0 = e - k*f*abs(f)\n}", "GY:k { e1 = k*f2; e2 = k*f1 }", "R:r = 2 +- 5 %",
    "R:r = 2 +- 1 Ohm", "port -> out; out -> model; model:x", "param -> b", "let { -> R:r }",
    "if -> b", "for:x", "sensor.a -> b", "input[1] -> b", "fault:fault", "port:port = port",
    "in:in -> const:const", "a ->\n b ->\n R:r", "x1 -> y_2", "R:a = 2 -> b", "R:a = x <- b",
    "R:a = -x -[3]-> b", "; ;R:a;\n;", "R:a # comment", "## doc\nR:a", "let a = x[1 .. 2]",
    "let a = x[i+1].y[2].f", "let a = 1e-3 + 2E5 + 0.5", "param p = 5 in",
    "let a = b == c and d != e", "MSe:w", "R : r = 1", "if not a { R:r }", "if -1 < a { R:r }",
    "let a = --b", "let a = b - -c", "let unknown = 1", "let counts = when",
    "Sf:when -> 1:counts", "1:in when a { }", "input : V", "if { -> r }", "else { -> R:r }",
    "else -> b", "let a = 3 m*x/y", "let a = (b)^(c)", "param d = 3 m +- 1 mm",
    "let a = 1/s + 1/2", "param k = 24 counts/turn", "sensor s : counts = k*x", "param n : counts",
    "let a = 3 counts - 2 counts", "R:a = 3 counts -> b",
    "sensor s = 2 counts (n)/turn", "sensor s = 2 counts\nlet a = 1",
]  # fmt: skip

#: Bodies of models with one error each.
WRONG = [
    "a", "a.b", "-> b", "<- b", "a -> ", "a -> -> b", "a b", "a => b", "R:", ":r", "R:2", "2:j",
    "R:r =", "R:r = 2 3", "R:r = 2Ohm", "R:r = 2  Ohm", "R:r = .5", "R:r = 5.", "R:r { }",
    "R:r { e }", "R:r { e = f, f = e }", "R:r { -> b }", "R:r { port a }", "R:r { e = f = q }",
    "0:j = 3", "1:j(a = 1)", "a -> 1:j { -> b } -> c", "1:j when a", "j when a { }", "1:i { -> }",
    "1:i { -> a <- }", "1:i { a }", "1:i -> { }", "port a", "port a : electrical", "port a : in",
    "port a : inn electrical", "port : in electrical", "port a[2] : in electrical", "param R",
    "param R : Ohm = 5 Ohm", "param = 3", "param R = 3 +- ", "param R = 3 +- 5%%",
    "param R = 3 +- x", "param R = 3 Ohm +- 5 Ohm%", "param R : 5", "param R : N m",
    "input x : V known", "input x = 3", "sensor s", "sensor s : rad", "sensor s = x counts 24",
    "sensor s = x counts", "sensor s = x counts 24/turns", "let a", "let a =", "let a = b +- c",
    "let a : V = b", "let a = b < c < d", "let a = b +", "let a = + b", "let a = b + + c",
    "let a = (b", "let a = b)", "let a = f(b,)", "let a = f(,)", "let a = m[]", "let a = m[1",
    "let a = m[1..]", "let a = x.", "let a = x..y", "let a = ()", "let a = b not c",
    "let a = 2 + not b", "let a = and", "let a = b or", "let not = 1", "let a__b = 1",
    "let a = 2 sin(x)", "let a = 2(x)", "let a = x y", 'let a = "b', "let a = 'b'",
    "let a = b && c", "let a = b ** c", "let a = b ? c", "let a = {b}", "let a = b @ c",
    "fault x", "fault x : R", "fault x = 3", "fault x : R -= 1", "fault x : 3 = 3",
    "for j in 1..2", "for j in 1:2 { }", "for j in 1..2..3 { }", "for in 1..2 { a -> b }",
    "for j on 1..2 { }", "for j in 1 { }", "if n R:r", "if n { R:r } else R:s",
    "if n { } else if { }", "for j in 1..2 { -> b }", "if a { -> b }", "Cell:c()", "Cell:c(3)",
    "Cell:c(n = 1,)", "Cell:c(n)", "Cell:c(n = 1", "Cell:c(n : 1)", "C:s(q0 = 0 = 1)", "a[1 -> b",
    "a -[7-> b", "a -[7]- b", "a -[]-> b", "a <- [7] b", "model N { }", 'import A from "x"',
    "1:i { -> b", "R:r = 1 }", "R:a R:b", "1:a { } 1:b { }", "param x = 1 param y = 2",
    "R:a, R:b", "R:a = 2, 3", "%", "a -> b.", "R:a(b = 1)(c = 2)", "R:a = 1 { e = f } = 2",
    "R:a = 1(b = 2)", "x = 3", "x : y : z", "1:i:j",
]  # fmt: skip


def whole(body: str) -> str:
    """A file with one model of this body."""
    return "bg 1\nmodel M {\n" + body + "\n}\n"


#: Whole files that are right.
FILES_RIGHT = [
    "bg 1", "bg 1\n", "# hi\nbg 1 # there\n", "bg 1; model M {}",
    "bg 1 model M { R:r } model N {}", 'bg 1\nimport A from "x.bg"',
    'bg 1\nimport A,\n B from "x.bg"\nmodel M { A:a }',
    "bg 1\nmodel M(n : int = 1, fast : bool) { }", "bg 1\nmodel M(\n n : int\n) {\n}\n",
    "bg 1\nmodel model { }", "## doc\nbg 1\n## more\nmodel M { }",
]  # fmt: skip
#: Whole files that are wrong.
FILES_WRONG = [
    "model M { }", "bg 2\nmodel M { }", "bg\nmodel M { }", "bg 1 2", "bg 1\nmodel",
    "bg 1\nmodel M", "bg 1\nmodel M {", "bg 1\nmodel M { }}", "bg 1\nR:r", "bg 1\nmodel M() { }",
    "bg 1\nmodel 2 { }", "bg 1\nmodel M(n) { }", "bg 1\nmodel M(n : real) { }",
    "bg 1\nmodel M(n : int = ) { }", "bg 1\nimport A", "bg 1\nimport A from x",
    'bg 1\nimport from "x"', 'bg 1\nimport A B from "x"', 'bg 1\nimport A, from "x"',
    "bg 1\nmodel M(n : int { }", "bg 1\n}", "", "# nothing",
]  # fmt: skip


def sample() -> str:
    """The paper's model, as the language was first written down."""
    return (Path(__file__).parent / "sample.bg").read_text(encoding="utf-8")
