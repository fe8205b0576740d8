// The page: what the server says, and what people press.
import { Graph } from "./graph.js";
import { Plane } from "./plane.js";
import { Plot, Residual } from "./strips.js";
import { Diagnosis, amount } from "./said.js";

const $ = (id) => document.getElementById(id);
const names = ["desired", "virtual", "real"];
let hello = null, socket = null, tries = 0, frozen = false, chosen = false;
let strips = [], plots = [], plane = null, newest = null, due = false;
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
  hello = message;
  graph.links = hello.links;
  $("real-name").textContent = `real: ${hello.monitored}` + (hello.lacking.real ? `, place unknown: ${hello.lacking.real}` : "");
  $("desired-name").textContent = "desired" + (hello.lacking.desired ? `: ${hello.lacking.desired}` : "");
  $("desired-name").closest("li").hidden = !hello.plane.length && !hello.wanted;
  $("pause").textContent = hello.pace ? "Pause" : "Freeze";
  const flat = hello.plane.length > 0;
  $("plane").hidden = !flat;
  $("plots").hidden = flat;
  $("where-title").textContent = flat ? "In the plane" : "Sensors";
  plane = flat ? new Plane(document.querySelector("#plane svg"), hello.plane.length > 2) : null;
  $("strips").replaceChildren();
  $("plots").replaceChildren();
  strips = hello.residuals.map(([name, unit]) => new Residual($("strips"), name, unit, whose()));
  plots = flat ? [] : hello.sensors.map(([name, unit]) => new Plot($("plots"), name, unit));
  choices();
  restart();
  $("active").textContent = "none is injected";
  for (const one of names) if (plane) plane.paths[one] = message.paths[one].slice();
  message.frames.forEach((f) => frame(f, false));
  message.verdicts.forEach(heard.verdict);
  heard.faults({ active: message.active });
  if (message.state.state) heard.state(message.state);
}

function restart() {
  strips.forEach((s) => s.clear());
  plots.forEach((p) => p.clear());
  if (plane) plane.clear();
  diagnosis.clear();
  newest = null;
  suspects();
  $("time").textContent = "0.00";
  later();
}

function frame(f, walk = true) {
  newest = f;
  strips.forEach((s, k) => ["real", "virtual"].forEach((one) => f[one].r && s.add(one, f.t, f[one].r[k])));
  plots.forEach((p, k) => f.s && p.add(f.t, f.s[k]));
  if (plane) names.forEach((one) => plane.move(one, f[one].p, walk));
  diagnosis.warm(f);
  later();
}

const heard = {
  hello: begin,
  frame: (f) => { if (!frozen && hello) frame(f); },
  reset: restart,
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
    if (hello && hello.pace) pressed(m.state === "paused");
  },
};

function later() {
  if (due) return;
  due = true;
  requestAnimationFrame(() => {
    due = false;
    if (newest) $("time").textContent = newest.t.toFixed(2);
    [...strips, ...plots].forEach((s) => s.draw());
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
  $("scenario-faults").replaceChildren(...hello.faults.map((label, k) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = `Inject: ${label}`;
    button.onclick = () => send({ do: "inject", fault: k });
    return button;
  }));
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
  $("target").title = target.value === null ? "" : `${target.name} = ${amount(target.value)} ${target.unit}`;
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
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", later);
addEventListener("resize", later);
connect();
