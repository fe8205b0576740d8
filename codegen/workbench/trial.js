// The simulation: sliders for inputs and parameters, faults to inject, and what the residuals then do.
import { $, make, number, percent } from "./dom.js";
import { Curves } from "./curves.js";

const CHANGES = { "*=": "times", "+=": "plus", stuck: "stuck", missing: "missing" };

export class Trial {
  // `send` asks for a run, `seen` is told what one has shown, `light` what is pointed at.
  constructor({ send, seen, light }) {
    Object.assign(this, { send, seen, light, found: null, faults: [], inputs: {}, parameters: {}, duration: 10, noise: 0.1, id: 0, asked: 0, due: false, open: false });
    this.curves = new Curves(make("div"));
    this.verdict = make("div", { class: "verdict", role: "status" });
    $("shown").append(this.verdict, this.curves.into);
  }

  // What can be set of a model; what was set stays where the names are still there.
  begin(found) {
    this.found = found;
    this.stop();
    const known = new Set(found.targets?.map((t) => t.name));
    this.faults = this.faults.filter((f) => known.has(f.target));
    this.build();
    this.wanted();
  }

  stop() { this.busy(""); this.asked = this.id; }

  shown(open) {
    this.open = open;
    if (open) this.wanted();
  }

  // ------------------------------------------------------------------------------- controls

  build() {
    const found = this.found;
    if (found.status === "wrong") { $("controls").replaceChildren(make("p", { class: "empty" }, found.message)); $("shown").hidden = true; return; }
    $("shown").hidden = false;
    const inputs = found.inputs.map((item) => this.input(item));
    const params = found.targets.filter((t) => t.kind === "param").map((t) => this.parameter(t));
    $("controls").replaceChildren(
      this.length(),
      this.injection(),
      make("h3", {}, "Inputs"), ...(inputs.length ? inputs : [make("p", { class: "note" }, "There are none.")]),
      make("h3", {}, "Parameters", make("button", { type: "button", class: "plain small", onclick: () => { this.parameters = {}; this.build(); this.wanted(); } }, "as in the model")), ...params);
  }

  length() {
    const field = make("input", { type: "number", id: "duration", min: "0.001", step: "any", value: String(this.duration), "aria-label": "Duration in s",
      onchange: () => { const s = Number(field.value); if (s > 0) { this.duration = s; this.wanted(); } } });
    const noise = make("input", { type: "number", min: "0", max: "100", step: "any", value: String(this.noise), "aria-label": "Noise of the sensors, in % of their largest reading", onchange: () => { this.noise = Number(noise.value); this.wanted(); } });
    return make("div", { class: "row first" }, make("label", {}, "for ", field, " s"), make("label", { title: "white noise of every sensor, in % of its largest reading" }, "noise ", noise, " %"), make("button", { type: "button", id: "run", onclick: () => this.wanted(true) }, "Run"),
      make("a", { class: "plain", href: "#", id: "scenario", download: "trial.toml", title: "These settings as a scenario for bondgraph simulate", onclick: (e) => { e.currentTarget.href = `data:application/toml;charset=utf-8,${encodeURIComponent(this.text(true))}`; } }, "scenario ↓"));
  }

  injection() {
    const targets = this.found.targets;
    const target = make("select", { id: "target", "aria-label": "What becomes faulty" }, ...targets.map((t) => new Option(t.name, t.name)));
    const change = make("select", { id: "change", "aria-label": "How it changes" });
    const size = make("input", { id: "size", type: "number", step: "any", value: "2", "aria-label": "By how much" });
    const unit = make("span", { class: "unit" });
    const at = make("input", { id: "at", type: "number", step: "any", min: "0", value: String(this.duration / 2), "aria-label": "When, in s" });
    const kinds = () => {
      const t = targets.find((x) => x.name === target.value), before = change.value;
      if (!t) return;
      const all = ["*=", "+=", ...(t.kind === "param" ? [] : ["stuck"]), ...(t.kind === "sensor" ? ["missing"] : [])];
      change.replaceChildren(...all.map((k) => new Option(CHANGES[k], k)));
      if (all.includes(before)) change.value = before;
      size.hidden = change.value === "stuck" || change.value === "missing";
      unit.textContent = change.value === "+=" && t.unit !== "1" ? t.unit : "";
    };
    target.onchange = kinds;
    change.onchange = kinds;
    kinds();
    const list = make("ul", { class: "faults" }, ...this.faults.map((f, k) => make("li", { onpointerenter: () => this.light({ fault: f.target }), onpointerleave: () => this.light({}) },
      make("span", {}, this.label(f)), make("button", { type: "button", class: "plain", "aria-label": `Take back ${this.label(f)}`, onclick: () => { this.faults.splice(k, 1); this.build(); this.wanted(); } }, "✕"))));
    const form = make("form", { id: "inject", class: "inject", onsubmit: (event) => {
      event.preventDefault();
      this.inject({ target: target.value, change: change.value, value: Number(size.value), at: Number(at.value) });
    } }, make("h3", {}, "Faults"), list, targets.length ? make("p", { class: "row" }, target, change, size, unit, make("label", {}, " at ", at, " s"), make("button", { type: "submit" }, "Inject")) : make("p", { class: "note" }, "Nothing can become faulty."));
    return form;
  }

  label(f) {
    const t = this.found.targets.find((x) => x.name === f.target), unit = f.change === "+=" && t?.unit && t.unit !== "1" ? ` ${t.unit}` : "";
    const what = { "*=": ` × ${number(f.value)}`, "+=": ` ${f.value < 0 ? "−" : "+"} ${number(Math.abs(f.value))}${unit}` }[f.change] ?? ` ${f.change}`;
    return `${f.target}${what} from ${number(f.at)} s`;
  }

  inject(fault) {
    this.faults.push(fault);
    this.build();
    this.wanted();
  }

  // A row of the matrix asks for its fault: twice what it is, or one unit more where that is nothing.
  suggest(name) {
    const t = this.found?.targets.find((x) => x.name === name);
    if (!t) return;
    const twice = t.kind === "param" ? t.value !== 0 : false;
    this.inject({ target: name, change: twice ? "*=" : "+=", value: twice ? 2 : this.sizeOf(t), at: this.duration / 2 });
  }

  // What one unit of a signal is may be little: as much as it was at most in the last run, a tenth of it.
  sizeOf(t) {
    const line = this.curves.last?.signals.flatMap((p) => p.lines).find((l) => l.name === t.name);
    const most = line ? Math.max(...line.v.map((v) => Math.abs(v ?? 0))) : 0;
    return most ? Number((most / (t.factor * 5)).toPrecision(2)) : 1;
  }

  input(item) {
    const now = this.inputs[item.name] ??= item.first;
    const field = make("input", { type: "text", value: now, spellcheck: "false", "aria-label": `${item.name}: a value or an expression of t`, title: "a value, or an expression of the time t: 12*(1 + 0.2*sin(2*pi*t))",
      onchange: () => { this.inputs[item.name] = field.value; slide(); this.wanted(); } });
    const range = make("input", { type: "range", min: "-1", max: "1", step: "0.01", "aria-label": item.name, oninput: () => { field.value = this.inputs[item.name] = String(Number((Number(range.value) * this.reach(item.name)).toPrecision(3))); this.wanted(); } });
    const slide = () => { const x = Number(field.value); range.disabled = !Number.isFinite(x); if (Number.isFinite(x)) { this.reaches[item.name] = Math.max(this.reach(item.name), 2 * Math.abs(x)); range.value = String(x / this.reach(item.name)); } };
    slide();
    return make("div", { class: "row slide", title: item.doc }, make("span", { class: "name" }, item.name), item.mode ? make("span") : range, field, make("span", { class: "unit" }, item.unit));
  }

  reaches = {};

  reach(name) { return this.reaches[name] || 10; }

  // Ten times less to ten times more, evenly on a scale of powers.
  parameter(t) {
    const set = this.parameters[t.name], nominal = t.value, now = set ?? nominal;
    const out = make("input", { type: "number", step: "any", value: now === null ? "" : plainly(now, 6), "aria-label": `${t.name} in ${t.unit}`,
      onchange: () => { if (out.value === "") delete this.parameters[t.name]; else this.parameters[t.name] = Number(out.value); place(); this.wanted(); } });
    const range = make("input", { type: "range", min: "-1", max: "1", step: "0.01", "aria-label": t.name, disabled: !nominal,
      oninput: () => { const v = nominal * 10 ** Number(range.value); if (Number(range.value) === 0) delete this.parameters[t.name]; else this.parameters[t.name] = v; out.value = plainly(v, 4); row.classList.toggle("set", t.name in this.parameters); this.wanted(); },
      ondblclick: () => { delete this.parameters[t.name]; out.value = plainly(nominal, 6); range.value = "0"; row.classList.remove("set"); this.wanted(); } });
    const place = () => { const v = this.parameters[t.name] ?? nominal; range.value = nominal && v / nominal > 0 ? String(Math.log10(v / nominal)) : "0"; row.classList.toggle("set", t.name in this.parameters); };
    const row = make("div", { class: "row slide", title: this.found.docs[t.name] || "", onpointerenter: () => this.light({ fault: t.name }), onpointerleave: () => this.light({}) },
      make("span", { class: "name" }, t.name), range, out, make("span", { class: "unit" }, t.unit === "1" ? "" : t.unit));
    place();
    return row;
  }

  // -------------------------------------------------------------------------------- running

  // The settings as a scenario; a whole one has the faults as well.
  text(whole = false) {
    const rate = Math.min(1000, 10 ** Math.floor(Math.log10(20000 / this.duration)));
    const key = (name) => JSON.stringify(name), si = (name, v) => { const t = this.found.targets.find((x) => x.name === name); return v * (t?.factor ?? 1); };
    const lines = [`duration = ${float(this.duration)}`, "", "[sampling]", `rate = ${float(rate)}`];
    const course = (item) => { const text = (this.inputs[item.name] ?? "").trim(); return text === "true" || text === "false" ? text : JSON.stringify(item.unit && /^[-+\d.eE\s]+$/.test(text) ? `${text.trim()} ${item.unit}` : text || "0"); };
    if (this.found.inputs.length) lines.push("", "[inputs]", ...this.found.inputs.map((item) => `${key(item.name)} = ${course(item)}`));
    const set = Object.entries(this.parameters).filter(([name]) => this.found.targets.some((t) => t.name === name));
    if (set.length) lines.push("", "[parameters]", ...set.map(([name, v]) => `${key(name)} = ${float(si(name, v))}`));
    const noise = Object.entries((whole && this.curves.last?.noise) || {});
    for (const [name, v] of noise) lines.push("", `[sensors.${key(name)}]`, `noise = ${float(v)}`);
    for (const f of whole ? this.faults : []) {
      const t = this.found.targets.find((x) => x.name === f.target), unit = f.change === "+=" && t?.unit && t.unit !== "1" ? ` ${t.unit}` : "";
      lines.push("", "[[fault]]", `of = ${key(f.target)}`, `change = ${JSON.stringify(CHANGES[f.change] === f.change ? f.change : `${f.change} ${f.value}${unit}`)}`, `at = ${float(f.at)}`);
    }
    return `${lines.join("\n")}\n`;
  }

  // A run is due. One at a time: what is set meanwhile is run when that one is back.
  wanted(anyway = false) {
    if (!this.found || this.found.status === "wrong" || (!this.open && !anyway && !this.faults.length)) return;
    if (this.asked !== this.id) { this.due = true; return; }
    this.due = false;
    this.id++;
    this.busy("simulating");
    this.send({ do: "run", id: this.id, scenario: this.text(), faults: this.faults, noise: this.noise / 100 });
  }

  heard(run) {
    if (run.id !== this.id) return;
    this.asked = run.id;
    this.busy("");
    if (this.due) this.wanted(true);
    if (run.message) {
      this.verdict.dataset.state = "wrong";
      this.verdict.replaceChildren(make("p", {}, run.message));
      this.curves.clear();
      this.seen([], [], []);
      return;
    }
    this.curves.show(run);
    this.tell(run);
  }

  busy(text) { $("busy").textContent = text; $("busy").dataset.on = text ? "1" : ""; }

  tell(run) {
    const last = run.verdicts.filter((v) => v.event !== "cleared").at(-1);
    const candidates = last ? (last.candidates.length ? last.candidates : last.group.map((f) => [f, 1 / last.group.length])) : [];
    const injected = this.faults.map((f) => f.target);
    const state = run.fired.length || last ? "fault" : "well";
    this.verdict.dataset.state = state;
    const rows = candidates.slice(0, 6).map(([fault, chance]) => make("li", { data: { fault }, class: injected.includes(fault) ? "injected" : "", onpointerenter: () => this.light({ fault }), onpointerleave: () => this.light({}) },
      make("span", { class: "name" }, fault), this.cells(fault, run.fired), make("span", { class: "share", "aria-hidden": "true" }, bar(chance)), make("span", { class: "amount" }, percent(chance))));
    const words = last ? [`${last.message}.`]
      : run.fired.length ? ["Beyond thresholds: ", make("b", {}, run.fired.join(", ")), ", without a verdict."]
        : [this.faults.length ? "No residual has fired." : "Healthy: every residual stays between its thresholds."];
    this.verdict.replaceChildren(make("p", {}, ...words), rows.length ? make("ol", { class: "candidates" }, ...rows) : "");
    this.seen(run.fired, injected, candidates);
  }

  // The row of a fault, small: which residuals see it, and which of these have fired.
  cells(fault, fired) {
    const signatures = this.found.signatures, row = signatures?.groups.flatMap((g) => g.rows).find((r) => r.fault === fault);
    return make("span", { class: "cells" }, ...(row ? row.cells.map((kind, k) => make("span", { class: `cell ${kind || "none"}${fired.includes(signatures.residuals[k]) ? " fired" : ""}`, title: signatures.residuals[k] }, make("i"))) : []));
  }
}

// A number that a field takes, without a row of zeros.
function plainly(x, digits) {
  const plain = String(Number(x.toPrecision(digits)));
  return plain.length > Math.max(7, digits) ? x.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e") : plain;
}

const float = (x) => (Number.isInteger(x) ? `${x}.0` : String(x));

function bar(share) {
  const part = make("i");
  part.style.width = `${100 * share}%`;
  return part;
}
