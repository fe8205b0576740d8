// The page: what is typed goes to the server, what it finds goes into the drawing, tables and curves.
import { $, make } from "./dom.js";
import { Editor } from "./editor.js";
import { LanguageServer } from "./language.js";
import * as panes from "./panes.js";
import { Picture } from "./picture.js";
import * as residuals from "./residuals.js";
import * as signatures from "./signatures.js";
import { Trial } from "./trial.js";

let hello = null, socket = null, tries = 0, editor = null, server = null;
let version = 0, looked = 0, answered = 0, digest = "", saved = "", derived = null, sound = false;
let suspects = {}, pointed = {};
const times = []; // ms from a key to its drawing, and of the processor for its sketch: for who asks

const send = (wish) => { if (socket?.readyState === 1) socket.send(JSON.stringify(wish)); };
const dirty = () => editor !== null && editor.text !== saved;
const draft = () => `bondgraph draft ${hello.path}`;

// ------------------------------------------------------------------------------- what is lit

const picture = new Picture({
  go: (place) => { panes.show("text"); editor.go(place); },
  point: (node) => light(node === null ? {} : { now: [node], from: "picture" }),
  more: (node) => {
    const faults = derived?.links?.[node] || [];
    return faults.map((fault) => { const seen = derived.signatures?.groups.find((g) => g.rows.some((r) => r.fault === fault)); return `${fault}: ${seen ? `seen by ${seen.residuals.join(", ")}` : "not seen"}`; });
  },
});
const trial = new Trial({ send, seen: shown, light: (what) => light(what) });

function light(what) {
  pointed = what.fault && !what.nodes ? { ...what, nodes: signatures.elements(derived || {}, what.fault) } : what;
  relight();
}

function relight() {
  const { nodes = [], now = [], fault = null, residual = null, from = "" } = pointed;
  const line = editor?.line(), here = editor?.view.hasFocus ? Object.keys(picture.nodes).filter((n) => picture.nodes[n][0] === line) : [];
  picture.light({ nodes: from === "picture" ? [] : nodes, now: from === "picture" ? [] : now, suspects, here: from === "picture" ? [...here, ...now] : here });
  editor?.light([...nodes, ...now].map((n) => picture.nodes[n]).filter(Array.isArray).map((place) => place[0]));
  signatures.lightFault(fault, residual);
  residuals.lightResidual(residual);
}

// A run has shown something: what it makes suspicious stands out until the next one.
function shown(fired, injected, candidates) {
  signatures.suspect(fired, injected, candidates);
  suspects = {};
  for (const [fault, chance] of candidates) for (const node of signatures.elements(derived || {}, fault)) suspects[node] = Math.min(1, (suspects[node] || 0) + chance);
  relight();
}

const chip = (fault) => make("button", { type: "button", class: "chip", tabindex: "-1", onpointerenter: () => light({ fault }), onpointerleave: () => light({}), onclick: () => { panes.show("signatures"); document.querySelector(`tr[data-fault="${CSS.escape(fault)}"]`)?.focus(); } }, fault);

// --------------------------------------------------------------------- what the server says

const heard = {
  hello(message) {
    const first = hello === null;
    hello = message;
    if (first) begin();
    else if (message.digest !== digest) heard.disk(message);
    version++;
    look();
  },
  sketch(found) {
    answered = Math.max(answered, found.version);
    picture.show(found.svg, found.nodes, found.bonds);
    picture.stale(found.svg === null);
    if (began.has(found.version)) { times.push([performance.now() - began.get(found.version), found.took ?? 0]); began.clear(); }
    sound = found.sound;
    $("sum").textContent = found.sound ? found.message : "";
    models(found.models, found.model);
    document.body.dataset.sound = String(found.sound);
    if (found.version === version) state(found.sound ? "deriving" : "wrong", found.sound ? "deriving residuals" : "not sound yet");
    if (!found.sound) fade(true);
    relight();
    if (looked < version) look();
  },
  derived(found) {
    if (found.version !== version) return;
    derived = found;
    fade(false);
    residuals.show(found, { light, chip, derive: (name) => send({ do: "derive", name }) });
    signatures.show(found, { light, inject: (fault) => { panes.show("trial"); trial.suggest(fault); } });
    shown([], [], []);
    trial.begin(found);
    state(found.status === "wrong" ? "wrong" : "ready", found.status === "wrong" ? "no residuals" : found.message);
    relight();
  },
  derivation(found) { if (found.version === version) residuals.derived(found, light); },
  run(run) { trial.heard(run); },
  failed(message) {
    answered = Math.max(answered, message.version);
    if (looked < version) look();
    if (message.version === version) { state("wrong", "given up"); notice(message.message); }
    trial.stop();
  },
  saved(message) {
    const kept = editor.text === message.was;
    [saved, digest] = [message.text, message.digest];
    if (kept) editor.replace(message.text);
    forget();
    changed();
    notice("");
    state("ready", "saved");
  },
  unsaved(message) {
    notice(`Not saved: ${message.why}`);
  },
  conflict(message) { other(message, "Not saved: another program has changed the file meanwhile."); },
  disk(message) {
    if (message.digest === digest) return;
    if (!dirty()) { take(message); notice(message.digest ? "Another program has changed the file; this is what it says now." : "Another program has removed the file; the text here is what it said."); }
    else other(message, message.digest ? "Another program has changed the file, and the text here is not saved." : "Another program has removed the file.");
  },
};

function take(message) {
  if (!message.digest) { digest = ""; saved = ""; changed(); return; }
  [saved, digest] = [message.text, message.digest];
  editor.replace(message.text);
  changed();
}

function other(message, words) {
  notice(words,
    ["Take what is on the disk", () => { take(message); notice(""); }],
    ["Keep this text", () => { digest = message.digest; saved = message.text; changed(); notice("The next save replaces what is on the disk."); }]);
}

function begin() {
  picture.stale(false);
  let kept = null;
  try { kept = JSON.parse(localStorage.getItem(draft())); } catch { /* private, or damaged */ }
  editor = new Editor(hello.words, typed, relight);
  server = new LanguageServer(editor, hello.uri, (found, uri) => editor.tell(found, uri), (why) => notice(why));
  [saved, digest] = [hello.text, hello.digest];
  editor.replace(hello.text);
  if (kept && kept.digest === digest && kept.text !== saved && typeof kept.text === "string") {
    editor.replace(kept.text);
    notice("This is the text of last time, which was not saved.", ["Take what is on the disk", () => { editor.replace(saved); notice(""); }]);
  }
  $("starts").querySelector("ul").replaceChildren(...hello.starts.map((s) => make("li", {}, make("button", { type: "button", class: "plain", data: { start: s.name }, onclick: () => from(s) }, make("b", {}, s.name), make("span", {}, s.doc)))));
  changed();
  if (!digest && !editor.text) $("starts").showModal();
  else if (!panes.isNarrow()) editor.view.focus();
}

function from(start) {
  editor.replace(start.text);
  $("starts").close();
  panes.show("text");
  const at = start.name === "empty" ? start.text.indexOf("{\n") + 2 : 0;
  editor.view.dispatch({ selection: { anchor: at } });
  editor.view.focus();
}

function models(names, current) {
  const select = $("model"), own = names || [];
  $("model-label").hidden = own.length < 2;
  const key = JSON.stringify(own);
  if (select.dataset.key !== key) {
    select.dataset.key = key;
    const before = select.value;
    select.replaceChildren(...own.map((n) => new Option(n, n)));
    select.value = own.includes(before) && select.dataset.chosen ? before : current || "";
  } else if (!select.dataset.chosen && current) select.value = current;
}

// ------------------------------------------------------------------------------ what is typed

const began = new Map(); // version -> when it was typed

function typed() {
  if (hello === null) return;
  version++;
  began.set(version, performance.now());
  changed();
  look();
}

// One text at a time: what is typed meanwhile is looked at when the drawing is back.
function look() {
  if (looked > answered && socket?.readyState === 1) return;
  looked = version;
  server?.sync();
  send({ do: "look", version, text: editor.text, model: $("model").dataset.chosen ? $("model").value : "", derivative: document.querySelector("input[name=causality]:checked").value === "derivative" });
}

function again() { version++; look(); }

function changed() {
  $("dirty").hidden = !dirty();
  document.title = `${dirty() ? "● " : ""}${hello.file} · bondgraph`;
  try {
    if (dirty()) localStorage.setItem(draft(), JSON.stringify({ digest, text: editor.text }));
    else forget();
  } catch { /* private */ }
}

function forget() { try { localStorage.removeItem(draft()); } catch { /* private */ } }

function save() { if (hello !== null) send({ do: "save", text: editor.text, seen: digest }); }

// ------------------------------------------------------------------------------------- words

function state(name, text) { $("state").dataset.state = name; $("state").textContent = text; }

function notice(text, ...choices) {
  $("notice").hidden = !text;
  $("notice").querySelector("p").textContent = text;
  const own = choices.length ? choices : [["Close", () => notice("")]];
  $("notice").querySelector(".buttons").replaceChildren(...own.map(([label, act]) => make("button", { type: "button", onclick: act }, label)));
}

// What is known of an older text is grey until that of the newest is there.
function fade(on) { for (const id of ["residuals", "signatures", "controls"]) $(id).classList.toggle("stale", on); }

function connect() {
  const address = new URL("ws", location.href); // beside the page, under the token that it has
  address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
  socket = new WebSocket(address);
  socket.onmessage = (event) => {
    const message = JSON.parse(event.data);
    tries = 0;
    heard[message.type]?.(message);
  };
  socket.onclose = () => {
    state("lost", "no connection");
    answered = looked;
    trial.stop();
    setTimeout(connect, Math.min(5000, 300 * 2 ** tries++));
  };
}

function theme(name) {
  if (name) document.documentElement.dataset.theme = name;
  trial.curves.show(trial.curves.last);
}

$("save").onclick = save;
$("new").onclick = () => $("starts").showModal();
$("starts-close").onclick = () => $("starts").close();
$("theme").onclick = () => {
  const dark = document.documentElement.dataset.theme ? document.documentElement.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  try { localStorage.setItem("bondgraph theme", dark ? "light" : "dark"); } catch { /* private */ }
  theme(dark ? "light" : "dark");
};
$("model").onchange = () => { $("model").dataset.chosen = "1"; again(); };
document.querySelectorAll("input[name=causality]").forEach((i) => { i.onchange = again; });
addEventListener("keydown", (event) => {
  if ((event.ctrlKey || event.metaKey) && event.key === "s") { event.preventDefault(); save(); }
  if (event.altKey && event.key.toLowerCase() === "n") { event.preventDefault(); $("starts").showModal(); }
  if (event.key === "Escape") light({});
});
addEventListener("beforeunload", (event) => { if (dirty() && socket?.readyState !== 1) event.preventDefault(); });
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => theme(""));
panes.onTab((name) => trial.shown(name === "trial"));
try { const kept = localStorage.getItem("bondgraph theme"); if (kept) theme(kept); } catch { /* private */ }
panes.start();
globalThis.workbench = { times, get text() { return editor?.text; }, get version() { return version; }, get answered() { return answered; } };
connect();
