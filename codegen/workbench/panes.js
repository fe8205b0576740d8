// Panes: which one is looked at, how large they are, and how the keyboard gets from one to the next.
import { $ } from "./dom.js";

const TABS = ["text", "residuals", "signatures", "trial"];
const narrow = matchMedia("(max-width: 60rem)");
const changed = [];

export const onTab = (f) => changed.push(f);
export const tab = () => TABS.find((t) => $(`tab-${t}`).getAttribute("aria-selected") === "true");

export function show(name, focus = false) {
  const stacked = narrow.matches;
  if (name === "text" && !stacked) { $("editor").querySelector(".cm-content")?.focus(); return; }
  for (const t of TABS) {
    const on = t === name;
    $(`tab-${t}`).setAttribute("aria-selected", String(on));
    $(`tab-${t}`).tabIndex = on ? 0 : -1;
    $(t).hidden = t === "text" ? stacked && !on : !on;
  }
  if (focus) $(`tab-${name}`).focus();
  changed.forEach((f) => f(name));
}

export const isNarrow = () => narrow.matches;

function split(bar) {
  const upright = bar.classList.contains("upright"), name = bar.dataset.splits, root = document.documentElement;
  const set = (share) => {
    const kept = Math.min(80, Math.max(15, share));
    root.style.setProperty(name, `${kept}%`);
    bar.setAttribute("aria-valuenow", String(Math.round(kept)));
    try { localStorage.setItem(`bondgraph ${name}`, String(kept)); } catch { /* private */ }
  };
  const now = () => Number.parseFloat(getComputedStyle(root).getPropertyValue(name)) || 40;
  let kept = null;
  try { kept = localStorage.getItem(`bondgraph ${name}`); } catch { /* private */ }
  if (kept) set(Number(kept));
  bar.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    bar.setPointerCapture(event.pointerId);
    const box = document.querySelector("main").getBoundingClientRect();
    const move = (e) => set(100 * (upright ? (e.clientX - box.left) / box.width : (e.clientY - box.top) / box.height));
    bar.addEventListener("pointermove", move);
    bar.addEventListener("pointerup", () => bar.removeEventListener("pointermove", move), { once: true });
  });
  bar.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -2, ArrowUp: -2, ArrowRight: 2, ArrowDown: 2 }[event.key];
    if (step) { event.preventDefault(); set(now() + step); }
  });
}

export function start() {
  document.querySelectorAll(".splitter").forEach(split);
  const list = document.querySelector("[role=tablist]");
  list.addEventListener("click", (event) => {
    const button = event.target.closest("[role=tab]");
    if (button) show(button.id.slice(4));
  });
  list.addEventListener("keydown", (event) => {
    const own = TABS.filter((t) => isNarrow() || t !== "text"), at = own.indexOf(tab());
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: own.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    show(own[(to + own.length) % own.length], true);
  });
  addEventListener("keydown", (event) => {
    if (event.altKey && /^[1-4]$/.test(event.key)) { event.preventDefault(); show(TABS[event.key - 1]); }
    if (event.key === "F6") {
      event.preventDefault();
      const stops = [$("editor").querySelector(".cm-content"), $("drawing"), $(`tab-${tab()}`)].filter((e) => e && e.offsetParent !== null);
      const at = stops.findIndex((e) => e === document.activeElement || e.contains(document.activeElement));
      stops[(at + (event.shiftKey ? stops.length - 1 : 1)) % stops.length].focus();
    }
  });
  let before = "residuals";
  const fit = () => {
    const current = tab() || "residuals";
    if (current !== "text") before = current;
    show(narrow.matches ? "text" : before);
  };
  narrow.addEventListener("change", fit);
  fit();
}
