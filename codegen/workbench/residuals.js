// The residuals as formulas, each with its causal path; what is pointed at lights up in the drawing.
import { $, make, markup } from "./dom.js";

const panel = $("residuals");

// `light` is told of nodes, and what of them matters most; `go` of a line.
export function show(found, { light, chip }) {
  $("tab-residuals").querySelector(".count").textContent = found.relations?.length || "";
  if (found.status === "wrong" || !found.relations?.length) {
    panel.replaceChildren(make("p", { class: "empty" }, found.message || "There are no residuals."), make("p", { class: "empty help" }, found.help || ""));
    return;
  }
  const parts = found.relations.map((relation) => article(relation, light, chip));
  const lost = found.missing.map(([name, why]) => make("p", { class: "note" }, make("b", {}, name), ` is missing: ${why}`));
  panel.replaceChildren(make("p", { class: "note lead" }, "Each is zero while the machine is as the model says. Point at one: its causal path lights up in the drawing."), ...parts, ...lost);
}

function article(relation, light, chip) {
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
  const sees = [["sees", relation.lasting], ["in transients only", relation.weak]].filter(([, some]) => some.length);
  const made = make("article", { class: "relation", tabindex: "0", "aria-label": `Residual ${name}`, data: { residual: name }, onpointerenter: on, onpointerleave: off, onfocus: on, onblur: off },
    make("h3", {}, name, make("small", {}, relation.closed_by)),
    relation.too_long ? make("p", { class: "note" }, relation.too_long) : formulas,
    make("p", { class: "sees" }, ...sees.flatMap(([word, some]) => [make("span", { class: "word" }, word), ...some.map((fault) => chip(fault))])),
    ...relation.notes.map((note) => make("p", { class: "note" }, note)),
    relation.path.length ? path : null);
  return made;
}

export function lightResidual(name) {
  panel.querySelectorAll(".relation").forEach((e) => e.classList.toggle("lit", e.dataset.residual === name));
}
