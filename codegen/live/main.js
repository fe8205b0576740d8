// The page: what the server says, and what people press.
import { Choice } from "./choice.js";
import { csv, saved } from "./csv.js";
import { $, make, number } from "./dom.js";
import { Graph } from "./graph.js";
import { Plane } from "./plane.js";
import { Record } from "./record.js";
import { Diagnosis } from "./said.js";
import { Residual, Sensor } from "./strips.js";
import { View } from "./view.js";

const names = ["desired", "virtual", "real"];
let hello = null, socket = null, tries = 0, frozen = false, chosen = false;
let strips = [], sensors = [], plane = null, record = new Record([]), newest = null, due = false;
const NOTHING = { residual: [null, null, null, false], sensor: [null, null, null] };
const view = new View(() => later());
const choice = new Choice(() => later());
const graph = new Graph(document.querySelector(".bondgraph"), $("suspects"));
const diagnosis = new Diagnosis($, (whose) => { if (!chosen) show(whose); else suspects(); });

const whose = () => document.querySelector("input[name=whose]:checked").value;
const send = (wish) => { if (socket && socket.readyState === 1) socket.send(JSON.stringify(wish)); };
const notice = (text) => { $("notice").textContent = text; $("notice").hidden = !text; };
const suspects = () => graph.show(diagnosis.found[whose()], whose());

function show(one) {
  document.querySelector(`input[name=whose][value=${one}]`).checked = true;
  strips.forEach((s) => s.turn(one));
  suspects();
  later();
}

// ---------------------------------------------------------------- what the server says

function begin(message) {
  const again = hello && same(hello, message);
  hello = message;
  graph.links = hello.links;
  $("real-name").textContent = `real: ${hello.monitored}` + (hello.lacking.real ? `, place unknown: ${hello.lacking.real}` : "");
  $("desired-name").textContent = "desired" + (hello.lacking.desired ? `: ${hello.lacking.desired}` : "");
  $("desired-name").closest("li").hidden = !hello.plane.length && !hello.wanted;
  $("pause").textContent = hello.pace ? "Pause" : "Freeze";
  if (!again) build();
  choices();
  const missed = goesOn(message.frames);
  restart(missed === null);
  $("active").textContent = "none is injected";
  for (const one of names) if (plane) plane.paths[one] = message.paths[one].slice();
  (missed ?? message.frames).forEach((f) => frame(f, false));
  message.verdicts.forEach(heard.verdict);
  heard.faults({ active: message.active });
  if (message.state.state) heard.state(message.state);
}

const same = (one, other) => ["residuals", "sensors", "plane", "wanted"].every((what) => JSON.stringify(one[what]) === JSON.stringify(other[what]));

// Of the past that the server tells, what this page has not heard; null if it is another one.
function goesOn(frames) {
  const k = newest ? frames.findIndex((f) => f.n === newest.n && f.t === newest.t) : -1;
  return k < 0 ? null : frames.slice(k + 1);
}

// What is there of this machine: a strip for each residual and each sensor.
function build() {
  const flat = hello.plane.length > 0, more = 8 * hello.residuals.length;
  $("plane").hidden = !flat;
  for (const one of ["plots", "beside"]) $(one).hidden = true;
  $("where-title").textContent = flat ? "In the plane" : "Sensors";
  plane = flat ? new Plane(document.querySelector("#plane svg"), hello.plane.length > 2) : null;
  [...strips, ...sensors].forEach((s) => s.end());
  newest = null;
  record = new Record([
    ...hello.residuals.flatMap(() => ["least", "most", "most", "most", "least", "most", "most", "most"]),
    ...hello.sensors.flatMap(() => ["swing", "swing", "swing"]),
  ]);
  const into = $(flat ? "beside" : "plots"), lacking = hello.wanted ? [] : ["desired"];
  $(flat ? "strips" : "plots").before($("times"));
  strips = hello.residuals.map(([name, unit], k) => new Residual($("strips"), name, unit, record, 8 * k, view, whose()));
  sensors = hello.sensors.map(([name, unit], k) => new Sensor(into, name, unit, record, more + 3 * k, view, lacking));
  choice.offer([["Residuals", strips, true], ["Sensors", sensors, !flat]]);
}

function restart(forget = true) {
  if (forget) {
    record.clear();
    newest = null;
    view.follow();
    $("time").textContent = "0.00";
  }
  [...strips, ...sensors].forEach((s) => { s.stale = true; });
  if (plane) plane.clear();
  diagnosis.clear();
  suspects();
  later();
}

function frame(f, walk = true) {
  newest = f;
  record.add(f.t, [
    ...strips.flatMap((_, k) => ["real", "virtual"].flatMap((one) => f[one].r?.[k] ?? NOTHING.residual)),
    ...sensors.flatMap((_, k) => f.s?.[k] ?? NOTHING.sensor),
  ]);
  if (plane) names.forEach((one) => plane.move(one, f[one].p, walk));
  diagnosis.warm(f);
  later();
}

const heard = {
  hello: begin,
  frame: (f) => { if (!frozen && hello) frame(f); },
  reset: () => restart(),
  verdict: (v) => { diagnosis.add(v); later(); },
  refused: (m) => notice(m.message),
  faults: (m) => {
    $("active").textContent = m.active.length ? `injected: ${m.active.join(", ")}` : "none is injected";
    $("clear").disabled = !m.active.length;
  },
  state: (m) => {
    const words = { waiting: "waiting", running: "connected", slow: "connected", paused: "paused", ended: "ended" };
    $("connection").dataset.state = m.state;
    $("connection").textContent = words[m.state] || m.state;
    $("pace").textContent = m.state === "slow" ? m.text : m.pace ? `× ${m.pace}` : "";
    if (m.state !== "paused" && m.state !== "slow") notice(m.state === "running" || m.state === "waiting" ? "" : m.text);
    if (m.state === "ended") diagnosis.courses.ended();
    if (hello && hello.pace) pressed(m.state === "paused");
  },
};

function later() {
  if (due) return;
  due = true;
  requestAnimationFrame(() => {
    due = false;
    if (newest) $("time").textContent = newest.t.toFixed(2);
    const seen = view.window(record);
    [...strips, ...sensors].forEach((s) => s.draw(seen));
    if (plane) plane.draw();
  });
}

function connect() {
  const address = new URL("ws", location.href); // beside the page, under the token that it has
  address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
  socket = new WebSocket(address);
  socket.onmessage = (event) => {
    const message = JSON.parse(event.data);
    tries = 0;
    heard[message.type](message);
  };
  socket.onclose = () => {
    $("connection").dataset.state = "lost";
    $("connection").textContent = "no connection";
    notice("The server does not answer. This page tries again by itself.");
    setTimeout(connect, Math.min(5000, 300 * 2 ** tries++));
  };
}

// --------------------------------------------------------------------- what people press

function pressed(on) {
  $("pause").setAttribute("aria-pressed", String(on));
}

function choices() {
  $("scenario-faults").replaceChildren(...hello.faults.map((label, k) => make("button", { type: "button", onclick: () => send({ do: "inject", fault: k }) }, `Inject: ${label}`)));
  $("target").replaceChildren(...hello.targets.map((t) => new Option(t.name, t.name)));
  kinds();
}

function kinds() {
  const target = hello.targets.find((t) => t.name === $("target").value);
  if (!target) { $("inject").hidden = true; return; }
  const before = $("change").value;
  const all = [["*=", "times"], ["+=", "plus"]];
  if (target.kind !== "param") all.push(["stuck", "stuck"]);
  if (target.kind === "sensor") all.push(["missing", "missing"]);
  $("change").replaceChildren(...all.map(([value, text]) => new Option(text, value)));
  if (all.some(([value]) => value === before)) $("change").value = before;
  const change = $("change").value;
  $("size-label").hidden = change === "stuck" || change === "missing";
  $("unit").textContent = change === "+=" && target.unit !== "1" ? target.unit : "";
  $("target").title = target.value === null ? "" : `${target.name} = ${number(target.value, 3)} ${target.unit}`;
}

$("target").onchange = kinds;
$("change").onchange = kinds;
$("inject").onsubmit = (event) => {
  event.preventDefault();
  notice("");
  send({ do: "inject", target: $("target").value, change: $("change").value, value: Number($("size").value) });
};
$("clear").onclick = () => send({ do: "clear" });
$("reset").onclick = () => { chosen = false; send({ do: "reset" }); };
$("pause").onclick = () => {
  const on = $("pause").getAttribute("aria-pressed") !== "true";
  if (hello && hello.pace) send({ do: on ? "pause" : "go" });
  else { frozen = on; pressed(on); }
};
document.querySelectorAll("input[name=whose]").forEach((i) => { i.onchange = () => { chosen = true; show(whose()); }; });
$("export").onclick = () => saved(`${document.title}.csv`, csv(record, view.window(record), [...strips, ...sensors].filter((s) => s.chosen).flatMap((s) => s.table())));
document.querySelectorAll(".strips").forEach((group) => {
  group.onkeydown = (event) => { const on = [...strips, ...sensors].find((s) => s.chosen && s.near && group.contains(s.box)); if (on) view.key(event, on.plot); };
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { [...strips, ...sensors].forEach((s) => { s.stale = true; }); later(); });
addEventListener("resize", later);
connect();
