// The residuals as formulas, each with its causal path and its derivation; what is pointed at lights
// up in the drawing.
import { $, make, markup } from "./dom.js";

const panel = $("residuals");

// `light` is told of nodes, and what of them matters most; `derive` asks for a derivation.
export function show(found, { light, chip, derive }) {
  $("tab-residuals").querySelector(".count").textContent = found.relations?.length || "";
  if (found.status === "wrong" || !found.relations?.length) {
    panel.replaceChildren(make("p", { class: "empty" }, found.message || "There are no residuals."), make("p", { class: "empty help" }, found.help || ""));
    return;
  }
  const parts = found.relations.map((relation) => article(relation, light, chip, derive));
  const lost = found.missing.map(([name, why]) => make("p", { class: "note" }, make("b", {}, name), ` is missing: ${why}`));
  panel.replaceChildren(make("p", { class: "note lead" }, "Each is zero while the machine is as the model says. Point at one: its causal path lights up in the drawing."), ...parts, ...lost);
}

function article(relation, light, chip, derive) {
  const { name, nodes } = relation;
  const on = () => light({ nodes, residual: name }), off = () => light({});
  const formulas = make("div", { class: "formulas" }, ...relation.html.flatMap((line) => markup(line)));
  const steps = relation.path.map((step) => {
    const own = step.node ? [step.node] : [];
    return make("li", { class: step.leaves ? "against" : "", onpointerenter: () => light({ nodes, now: own, residual: name }), onpointerleave: on },
      ...markup(step.html), " ", make("span", { class: "why" }, `${step.why}, ${step.place}`, step.leaves ? make("b", {}, " against the strokes") : null));
  });
  if (relation.closing_html) {
    steps.push(make("li", { class: "last", onpointerenter: () => light({ nodes, now: relation.closed_at ? [relation.closed_at] : [], residual: name }), onpointerleave: on },
      ...markup(relation.closing_html), " ", make("span", { class: "why" }, `left over: ${relation.closed_by}`)));
  }
  const path = make("details", {}, make("summary", {}, `Causal path of ${name}, ${relation.path.length} steps from the known signals`), make("ol", { class: "path" }, ...steps));
  const derivation = make("details", { class: "derivation", data: { of: name }, ontoggle: (event) => { if (event.target.open && !event.target.dataset.asked) { event.target.dataset.asked = "1"; derive(name); } } },
    make("summary", {}, `Derivation of ${name}, step by step`), make("p", { class: "note", role: "status" }, "SymPy replays it …"));
  const sees = [["sees", relation.lasting], ["in transients only", relation.weak]].filter(([, some]) => some.length);
  const made = make("article", { class: "relation", tabindex: "0", "aria-label": `Residual ${name}`, data: { residual: name }, onpointerenter: on, onpointerleave: off, onfocus: on, onblur: off },
    make("h3", {}, name, make("small", {}, relation.closed_by)),
    relation.too_long ? make("p", { class: "note" }, relation.too_long) : formulas,
    make("p", { class: "sees" }, ...sees.flatMap(([word, some]) => [make("span", { class: "word" }, word), ...some.map((fault) => chip(fault))])),
    ...relation.notes.map((note) => make("p", { class: "note" }, note)),
    relation.path.length ? path : null, derivation);
  return made;
}

// A derivation has come: its steps from the equations of the bond graph to the residual.
export function derived({ name, parts, message }, light) {
  const box = panel.querySelector(`.derivation[data-of="${CSS.escape(name)}"]`);
  if (!box) return;
  const nodes = parts.flatMap((part) => part.steps.map((step) => step.node)).filter(Boolean);
  const told = parts.flatMap((part) => [
    parts.length > 1 ? make("p", { class: "note" }, part.title) : null,
    make("ol", { class: "path" }, ...part.steps.map((step) => make("li", { onpointerenter: () => light({ nodes, now: step.node ? [step.node] : [], residual: name }), onpointerleave: () => light({ nodes, residual: name }) },
      make("span", { class: "why" }, step.words), ...step.html.map((line) => make("div", {}, ...markup(line))), step.remark ? make("span", { class: "why" }, step.remark) : null))),
    make("p", { class: "note" }, part.ending)]);
  box.replaceChildren(box.querySelector("summary"), ...(parts.length ? told.filter(Boolean) : [make("p", { class: "note" }, message || "There is none.")]));
}

export function lightResidual(name) {
  panel.querySelectorAll(".relation").forEach((e) => e.classList.toggle("lit", e.dataset.residual === name));
}
