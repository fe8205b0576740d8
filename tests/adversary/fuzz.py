"""Random bond graphs as text and, independently, as equations."""

from __future__ import annotations

import random

from tests.adversary.plant import Plant


def generate(seed: int, nonlinear: bool = True) -> Plant:
    """Junctions in a random graph, elements on them, two-ports and bonds between them."""
    r = random.Random(seed)
    n = r.randint(1, 6)
    kinds = [r.choice("01") for _ in range(n)]
    lines: list[str] = []
    sums: dict[int, list[tuple[int, str, str]]] = {j: [] for j in range(n)}
    eqs: list[str] = []
    params: list[str] = []
    values: dict[str, float] = {}
    starts: dict[str, str] = {}
    inputs: list[str] = []
    unknown: list[str] = []
    sensors: dict[str, str] = {}
    bonds = 0
    head: list[str] = []

    def new_bond() -> tuple[str, str]:
        nonlocal bonds
        bonds += 1
        return f"e{bonds}", f"f{bonds}"

    def at(j: int, incoming: bool, e: str, f: str) -> None:
        sums[j].append((1 if incoming else -1, e, f))

    def param(stem: str) -> str:
        name = f"{stem}{len(params) + 1}"
        params.append(name)
        values[name] = round(r.uniform(0.4, 2.0), 2)
        head.append(f"  param {name} = {values[name]}")
        return name

    for j in range(n):
        lines.append(f"  {kinds[j]}:j{j}")
    links = [(r.randrange(j), j) for j in range(1, n)]
    for _ in range(r.choice([0, 0, 1, 1, 2, 3])):
        if n > 1:
            a, b = r.sample(range(n), 2)
            links.append((a, b))
    for k, (a, b) in enumerate(links):
        if r.random() < 0.5:
            a, b = b, a
        what = r.choice(["bond", "bond", "tf", "gy"]) if kinds[a] != kinds[b] else "other"
        if what == "other":
            what = r.choice(["bond", "tf", "gy", "gy"])
        if what == "bond":
            e, f = new_bond()
            lines.append(f"  j{a} -> j{b}" if r.random() < 0.5 else f"  j{b} <- j{a}")
            at(a, False, e, f)
            at(b, True, e, f)
            continue
        e1, f1 = new_bond()
        e2, f2 = new_bond()
        # port 1 is on a, port 2 on b
        style = r.choice(["through", "in", "out"])
        m = param("m")
        if what == "tf":
            law, eq = r.choice(
                [
                    ("f1 = {m}*f2", "{p}f1 - {m}*{q}f2; e2 - {m}*e1"),
                    ("f2 = {m}*f1", "{q}f2 - {m}*{p}f1; e1 - {m}*e2"),
                    ("e1 = {m}*e2", "{q}f2 - {m}*{p}f1; e1 - {m}*e2"),
                ]
            )
            node = f"TF:t{k} {{ {law.format(m=m)} }}"
        else:
            eq = "e1 - {m}*{q}f2; e2 - {m}*{p}f1"
            node = f"GY:g{k} = {m}"
        p = "(-1)*" if style == "out" else ""
        q = "(-1)*" if style == "in" else ""
        text = (
            eq.replace("e1", "E1_").replace("f1", "F1_").replace("e2", "E2_").replace("f2", "F2_")
        )
        text = text.format(m=m, p=p, q=q)
        for old, new in (("E1_", e1), ("F1_", f1), ("E2_", e2), ("F2_", f2)):
            text = text.replace(old, new)
        eqs.append(text)
        bare = f"t{k}" if what == "tf" else f"g{k}"
        if style == "through":
            lines.append(
                f"  j{a} -> {node} -> j{b}" if r.random() < 0.5 else f"  j{b} <- {node} <- j{a}"
            )
        else:
            arrow = "->" if style == "in" else "<-"
            lines += [f"  {node}", f"  j{a} {arrow} {bare}\n  j{b} {arrow} {bare}"]
        at(a, style == "out", e1, f1)
        at(b, style != "in", e2, f2)
    wanted = ["R"] * r.randint(1, 4) + ["C"] * r.randint(0, 3) + ["I"] * r.randint(0, 3)
    wanted += ["Se"] * r.randint(0, 1) + ["Sf"] * r.randint(0, 1) + [r.choice(["Se", "Sf"])]
    for k, kind in enumerate(wanted):
        j = r.randrange(n)
        if kind == "Se" and kinds[j] == "0" and r.random() < 0.8:
            kind = "Sf"
        if kind == "Sf" and kinds[j] == "1" and r.random() < 0.8:
            kind = "Se"
        e, f = new_bond()
        into = r.random() < 0.6  # arrow into the element
        at(j, not into, e, f)
        arrow = "->" if into else "<-"
        E, F = e, f
        if not into:
            E, F = (f"(-{e})", f) if kinds[j] == "1" else (e, f"(-{f})")
        name = f"x{k}"
        if kind in ("Se", "Sf"):
            u = f"u{k}"
            known = r.random() < 0.7
            (inputs if known else unknown).append(u)
            head.append(f"  input {u}" + ("" if known else " unknown"))
            lines.append(f"  j{j} {arrow} {kind}:{name} = {u}")
            eqs.append(f"{e if kind == 'Se' else f} - {u}")
            continue
        v = param(kind.lower())
        if kind == "R":
            laws = [(f"= {v}", f"{E} - {v}*{F}")] * 3
            if nonlinear:
                laws += [
                    (f"{{ f = {v}*ssqrt(e) }}", f"{F} - {v}*ssqrt({E})"),
                    (f"{{ e = {v}*f*abs(f) }}", f"{E} - {v}*{F}*abs({F})"),
                    (f"{{ e = {v}*f + f^3 }}", f"{E} - {v}*{F} - {F}**3"),
                    (f"{{ f = exp({v}*e) - 1 }}", f"{F} - exp({v}*{E}) + 1"),
                    (f"{{ e = tanh({v}*f) + f }}", f"{E} - tanh({v}*{F}) - {F}"),
                ]
            law, eq = r.choice(laws)
            eqs.append(eq)
            lines.append(f"  j{j} {arrow} R:{name} {law}")
            continue
        x = f"s{k}"
        rate, out = (F, E) if kind == "C" else (E, F)
        start = ""
        if r.random() < 0.5:
            start = f"({'q0' if kind == 'C' else 'p0'} = 0.5)"
            starts[x] = "0.5"
        if nonlinear and start and r.random() < 0.2:
            left, state = ("e", "q") if kind == "C" else ("f", "p")
            law, eq = f"{{ {left} = {state}/{v} + {state}^3 }}", f"{out} - {x}/{v} - {x}**3"
        else:
            law, eq = f"= {v}", f"{x} - {v}*{out}"
        eqs += [eq, f"D({x}) - {rate}"]
        lines.append(f"  j{j} {arrow} {kind}:{name}{start} {law}")
    for k in range(r.randint(1, 3)):
        j = r.randrange(n)
        y = f"y{k}"
        bare = f"w{j}"
        choice = r.random()
        if choice < 0.75:
            d = "De" if kinds[j] == "0" else "Df"
            lines.append(f"  j{j} {r.choice(['->', '<-'])} {d}:{y}")
            sensors[y] = bare
        elif choice < 0.9:
            other = r.randrange(n)
            lines.append(
                f"  sensor {y} = j{j}.{'e' if kinds[j] == '0' else 'f'} +"
                f" 2*j{other}.{'e' if kinds[other] == '0' else 'f'}"
            )
            sensors[y] = f"{bare} + 2*w{other}"
        else:
            lines.append(f"  sensor {y} = int(j{j}.{'e' if kinds[j] == '0' else 'f'})")
            eqs.append(f"D(z{k}) - {bare}")
            starts[f"z{k}"] = "0"
            sensors[y] = f"z{k}"
    for j in range(n):
        common, other = ("e", "f") if kinds[j] == "0" else ("f", "e")
        for _, e, f in sums[j]:
            eqs.append(f"{e if common == 'e' else f} - w{j}")
        balance = "".join(f" + ({s})*{f if other == 'f' else e}" for s, e, f in sums[j])
        eqs.append(balance or f"w{j}")
    r.shuffle(lines)
    text = "bg 1\nmodel F {\n" + "\n".join(head + lines) + "\n}\n"
    return Plant(
        f"fuzz{seed}",
        text,
        ";".join(eqs),
        sensors,
        0,
        params=" ".join(params),
        inputs=" ".join(inputs),
        unknown=" ".join(unknown),
        starts=starts,
        values=values,
    )
