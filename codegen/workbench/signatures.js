// The fault signature matrix: a row lights its elements, a column its residual; suspects of a run stand out.
import { $, make, percent } from "./dom.js";

const panel = $("signatures");
const SAID = { strong: "shows as long as it lasts", weak: "shows only while signals change", unsaid: "shows", "": "is not seen" };

export function show(found, { light, inject }) {
  const signatures = found.signatures;
  const count = signatures ? signatures.groups.reduce((n, g) => n + g.rows.length, 0) : 0;
  $("tab-signatures").querySelector(".count").textContent = count || "";
  if (!signatures || (!count && !signatures.undetectable.length)) {
    panel.replaceChildren(make("p", { class: "empty" }, found.message || "There are no signatures."));
    return;
  }
  const of = (residual) => found.relations.find((r) => r.name === residual)?.nodes || [];
  const head = make("tr", {}, make("th", { scope: "col" }, "fault"),
    ...signatures.residuals.map((r) => make("th", { scope: "col", data: { residual: r }, onpointerenter: () => light({ nodes: of(r), residual: r }), onpointerleave: () => light({}) }, r)),
    make("th", { scope: "col", class: "chance" }), make("th", {}));
  const bodies = signatures.groups.map((group) => make("tbody", {}, ...group.rows.map((row) => line(row, signatures.residuals, found, light, inject))));
  const table = make("table", { class: "matrix" }, make("thead", {}, head), ...bodies);
  const blind = signatures.undetectable.map(([why, faults]) => make("div", {}, make("dt", {}, faults.join(", ")), make("dd", {}, why)));
  panel.replaceChildren(
    make("p", { class: "key" }, cell("strong"), ` ${SAID.strong}. `, cell("weak"), ` ${SAID.weak}. Faults between two lines cannot be told apart. Enter injects a fault.`),
    make("div", { class: "scroll" }, table),
    blind.length ? make("h3", {}, "What no residual sees") : "", blind.length ? make("dl", { class: "groups" }, ...blind) : "");
}

function cell(kind) { return make("span", { class: `cell ${kind}` }, make("i")); }

function line(row, residuals, found, light, inject) {
  const on = () => light({ nodes: elements(found, row.fault), fault: row.fault }), off = () => light({});
  const known = found.targets.some((t) => t.name === row.fault);
  const button = known ? make("button", { type: "button", class: "plain inject", tabindex: "-1", title: `Inject ${row.fault} in a run`, onclick: () => inject(row.fault) }, "inject") : null;
  return make("tr", { tabindex: "0", data: { fault: row.fault }, onpointerenter: on, onpointerleave: off, onfocus: on, onblur: off, onkeydown: (e) => keys(e, row.fault, known ? inject : null) },
    make("th", { scope: "row", title: found.docs[row.fault] || "" }, row.fault),
    ...row.cells.map((kind, k) => make("td", { class: kind ? `cell ${kind}` : "", data: { residual: residuals[k] } }, kind ? make("i") : "", kind ? make("span", { class: "said" }, SAID[kind.split(" ")[0]]) : "")),
    make("td", { class: "chance" }), make("td", {}, button));
}

function keys(event, fault, inject) {
  const rows = [...panel.querySelectorAll("tr[data-fault]")], at = rows.indexOf(event.currentTarget);
  const to = { ArrowDown: at + 1, ArrowUp: at - 1 }[event.key];
  if (to !== undefined) { event.preventDefault(); rows[to]?.focus(); }
  if (event.key === "Enter" && inject) { event.preventDefault(); inject(fault); }
}

// The elements that a fault is a fault of.
export const elements = (found, fault) => Object.entries(found.links || {}).filter(([, faults]) => faults.includes(fault)).map(([node]) => node);

export function lightFault(fault, residual) {
  panel.querySelectorAll("tr[data-fault]").forEach((e) => e.classList.toggle("lit", e.dataset.fault === fault));
  panel.querySelectorAll("[data-residual]").forEach((e) => e.classList.toggle("lit", e.dataset.residual === residual));
}

// What a run has shown: the residuals that fired, the faults that were injected and those suspected.
export function suspect(fired, injected, candidates) {
  const chance = new Map(candidates);
  panel.querySelectorAll("th[data-residual]").forEach((e) => e.classList.toggle("fired", fired.includes(e.dataset.residual)));
  panel.querySelectorAll("tr[data-fault]").forEach((e) => {
    const p = chance.get(e.dataset.fault);
    e.classList.toggle("suspected", p !== undefined);
    e.classList.toggle("injected", injected.includes(e.dataset.fault));
    e.querySelector(".chance").textContent = p === undefined ? "" : percent(p);
  });
}
