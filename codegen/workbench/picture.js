// The bond graph: drawn anew at every key, moved to its new places, lit up, asked with pointer and keys.
import { $, make, markup } from "./dom.js";

const calm = matchMedia("(prefers-reduced-motion: reduce)");
const box = $("drawing"), card = $("card");

export class Picture {
  // `go` is told a place in the text, `point` the node that is pointed at, null for none; `more`
  // gives further lines about a node.
  constructor({ go, point, more }) {
    Object.assign(this, { go, point, more, svg: null, nodes: {}, bonds: [], view: null, size: [1, 1], zoomed: false, key: "" });
    box.addEventListener("pointermove", (e) => { if (!this.drag && e.pointerType !== "touch") this.over(e.target); });
    box.addEventListener("pointerleave", (e) => { if (e.pointerType !== "touch") this.over(null); });
    box.addEventListener("click", (e) => this.click(e));
    box.addEventListener("keydown", (e) => this.typed(e));
    box.addEventListener("blur", () => this.over(null));
    box.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
    this.pointers = new Map();
    box.addEventListener("pointerdown", (e) => this.pressed(e));
    for (const kind of ["pointerup", "pointercancel"]) addEventListener(kind, (e) => this.released(e));
    addEventListener("pointermove", (e) => this.moved(e));
    $("in").onclick = () => this.zoom(1.25);
    $("out").onclick = () => this.zoom(0.8);
    $("fit").onclick = () => this.fit();
    new ResizeObserver(() => { if (!this.zoomed) this.fit(); }).observe(box);
  }

  // A new drawing of the server; `nodes` and `bonds` are where they come from.
  show(text, nodes, bonds) {
    this.nodes = nodes;
    this.bonds = bonds;
    if (text === null) return;
    const svg = markup(text).find((n) => n.nodeName === "svg"), before = this.places();
    if (!svg) return;
    for (const title of svg.querySelectorAll("g > title, text > title")) {
      title.parentNode.dataset.tip = title.textContent;
      title.remove();
    }
    const about = svg.querySelector(":scope > desc");
    $("legend").textContent = about ? about.textContent : "";
    svg.querySelectorAll(":scope > title, :scope > desc").forEach((e) => e.remove());
    this.size = [svg.viewBox.baseVal.width, svg.viewBox.baseVal.height];
    svg.removeAttribute("width");
    svg.removeAttribute("height");
    box.replaceChildren(svg);
    this.svg = svg;
    this.by = new Map([...svg.querySelectorAll("[data-node]")].map((e) => [e.dataset.node, e]));
    this.wires = [...svg.querySelectorAll("[data-bond]")];
    if (this.zoomed) this.look(this.view); else this.fit();
    this.move(before);
    this.key = "";
  }

  stale(on) { box.classList.toggle("stale", on); }

  // -------------------------------------------------------------- from the old places to the new

  places() {
    const found = new Map();
    for (const [name, e] of this.by || []) found.set(name, [Number(e.getAttribute("x")), Number(e.getAttribute("y"))]);
    return found;
  }

  move(before) {
    if (calm.matches || !before.size) return;
    for (const [name, e] of this.by) {
      const old = before.get(name);
      if (!old) { e.animate([{ opacity: 0 }, { opacity: 1 }], 260); continue; }
      const dx = old[0] - e.getAttribute("x"), dy = old[1] - e.getAttribute("y");
      if (Math.abs(dx) + Math.abs(dy) > 0.5) e.animate([{ transform: `translate(${dx}px, ${dy}px)` }, { transform: "none" }], { duration: 220, easing: "ease-out" });
    }
    const moved = [...this.by].some(([name, e]) => { const old = before.get(name); return !old || Math.abs(old[0] - e.getAttribute("x")) + Math.abs(old[1] - e.getAttribute("y")) > 0.5; });
    if (moved) this.wires.forEach((e) => e.animate([{ opacity: 0 }, { opacity: 1 }], 240));
  }

  // --------------------------------------------------------------------------- what is looked at

  look([x, y, w, h]) {
    this.view = [x, y, w, h];
    this.svg?.setAttribute("viewBox", `${x} ${y} ${w} ${h}`);
  }

  // The whole drawing, not larger than it was made, in the middle.
  fit() {
    this.zoomed = false;
    const { clientWidth: w, clientHeight: h } = box;
    if (!this.svg || !w || !h) return;
    const scale = Math.min(w / this.size[0], h / this.size[1], 1.5);
    this.look([this.size[0] / 2 - w / scale / 2, this.size[1] / 2 - h / scale / 2, w / scale, h / scale]);
  }

  zoom(by, at = null) {
    if (!this.view) return;
    const [x, y, w, h] = this.view, scale = Math.min(Math.max(by, (w / this.size[0]) * 0.5), w / 60);
    const [px, py] = at || [x + w / 2, y + h / 2];
    this.zoomed = true;
    this.look([px - (px - x) / scale, py - (py - y) / scale, w / scale, h / scale]);
  }

  inside(event) {
    const r = box.getBoundingClientRect(), [x, y, w, h] = this.view;
    return [x + ((event.clientX - r.left) / r.width) * w, y + ((event.clientY - r.top) / r.height) * h];
  }

  wheel(event) {
    if (!this.view) return;
    event.preventDefault();
    if (event.ctrlKey || event.metaKey || !event.shiftKey) this.zoom(Math.exp(-event.deltaY * (event.ctrlKey ? 0.01 : 0.0015)), this.inside(event));
    else this.shift(event.deltaY, 0);
  }

  shift(dx, dy) {
    const [x, y, w, h] = this.view, scale = w / box.clientWidth;
    this.zoomed = true;
    this.look([x + dx * scale, y + dy * scale, w, h]);
  }

  pressed(event) {
    this.pointers.set(event.pointerId, event);
    this.drag = false;
  }

  moved(event) {
    const old = this.pointers.get(event.pointerId);
    if (!old || !this.view) return;
    const dx = event.clientX - old.clientX, dy = event.clientY - old.clientY;
    if (!this.drag && Math.hypot(dx, dy) < 5) return;
    this.drag = true;
    this.hide();
    if (this.pointers.size === 2) {
      const [a, b] = [...this.pointers.values()], other = a.pointerId === event.pointerId ? b : a;
      const far = (p) => Math.hypot(p.clientX - other.clientX, p.clientY - other.clientY) || 1;
      this.zoom(far(event) / far(old), this.inside({ clientX: (event.clientX + other.clientX) / 2, clientY: (event.clientY + other.clientY) / 2 }));
    } else this.shift(-dx, -dy);
    this.pointers.set(event.pointerId, event);
  }

  released(event) { this.pointers.delete(event.pointerId); }

  // ------------------------------------------------------------------------ what is pointed at

  target(from) { return from?.closest?.("[data-tip]") || null; }

  over(from) {
    const at = this.target(from);
    if (at === this.at) return;
    this.at = at;
    if (!at) { this.hide(); this.point(null); return; }
    this.tell(at);
    this.point(at.dataset.node ?? null);
  }

  place(at) { return at.dataset.node !== undefined ? this.nodes[at.dataset.node] : this.bonds[at.dataset.bond]?.[2]; }

  // What there is to say of an element or a bond, beside it.
  tell(at, touch = false) {
    const [first, ...rest] = (at.dataset.tip || "").split("\n"), place = this.place(at);
    const where = typeof place === "string" ? place : place ? `line ${place[0]}` : "";
    const lines = at.dataset.node !== undefined ? [...rest, ...this.more(at.dataset.node)] : rest;
    const link = touch && Array.isArray(place) ? make("button", { type: "button", class: "plain", onclick: () => { this.hide(); this.go(place); } }, `Go to ${where}`) : make("span", { class: "where" }, where);
    card.replaceChildren(make("p", { class: "head" }, make("b", {}, first), link), ...lines.filter(Boolean).map((l) => make("p", {}, l)));
    card.hidden = false;
    const r = at.getBoundingClientRect(), c = card.getBoundingClientRect(), edge = document.documentElement;
    const left = Math.min(Math.max(8, r.left + r.width / 2 - c.width / 2), edge.clientWidth - c.width - 8);
    const below = r.bottom + 10 + c.height < edge.clientHeight;
    card.style.left = `${left}px`;
    card.style.top = `${below ? r.bottom + 10 : Math.max(8, r.top - 10 - c.height)}px`;
  }

  hide() { card.hidden = true; this.at = null; }

  click(event) {
    const at = this.target(event.target);
    if (this.drag) return;
    if (!at) { this.hide(); this.point(null); return; }
    const place = this.place(at);
    if (event.pointerType === "touch") { this.at = at; this.tell(at, true); this.point(at.dataset.node ?? null); }
    else if (Array.isArray(place)) { this.hide(); this.go(place); }
  }

  // Arrow keys go to the nearest element in that direction.
  typed(event) {
    const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }, way = ways[event.key];
    if (event.key === "Escape") { this.over(null); return; }
    if (event.key === "+" || event.key === "=") { this.zoom(1.25); return; }
    if (event.key === "-") { this.zoom(0.8); return; }
    if (event.key === "0") { this.fit(); return; }
    if (event.key === "Enter" && this.at) { event.preventDefault(); const place = this.place(this.at); if (Array.isArray(place)) { this.hide(); this.go(place); } return; }
    if (!way || !this.by?.size) return;
    event.preventDefault();
    const where = (e) => [Number(e.getAttribute("x")), Number(e.getAttribute("y"))];
    const now = this.at?.dataset.node !== undefined ? where(this.at) : null;
    let best = null, least = Infinity;
    for (const e of this.by.values()) {
      if (e === this.at) continue;
      const [x, y] = where(e);
      const along = now ? (x - now[0]) * way[0] + (y - now[1]) * way[1] : x + y, aside = now ? Math.abs((x - now[0]) * way[1]) + Math.abs((y - now[1]) * way[0]) : 0;
      if (now && along <= 1) continue;
      if (along + 2 * aside < least) { least = along + 2 * aside; best = e; }
    }
    if (best) this.over(best);
  }

  // ---------------------------------------------------------------------------------- lighting

  // What is behind a label that stands out.
  halo(e, looks, chance) {
    if (!e.halo) {
      const b = e.getBBox(), halo = document.createElementNS("http://www.w3.org/2000/svg", "rect");
      for (const [name, value] of [["x", b.x - 5], ["y", b.y - 1.5], ["width", b.width + 10], ["height", b.height + 3], ["rx", 5]]) halo.setAttribute(name, value);
      e.before(halo);
      e.halo = halo;
    }
    e.halo.setAttribute("class", ["halo", ...looks].join(" "));
    e.halo.style.setProperty("--chance", `${Math.round(6 + 16 * (chance || 0))}%`);
  }

  // `nodes` stand out from the rest; `now` is the one that matters most; `suspects` maps nodes to
  // probabilities; `lines` are those where the cursor is.
  light({ nodes = [], now = [], suspects = {}, here = [] }) {
    const key = JSON.stringify([nodes, now, suspects, here]);
    if (key === this.key || !this.svg) return;
    this.key = key;
    const lit = new Set([...nodes, ...now]), most = new Set(now), at = new Set(here);
    this.svg.classList.toggle("focused", lit.size > 0);
    for (const [name, e] of this.by) {
      const looks = [lit.has(name) && "lit", most.has(name) && "now", at.has(name) && "here", Object.hasOwn(suspects, name) && "suspect"].filter(Boolean);
      e.classList.toggle("lit", lit.has(name));
      if (looks.length || e.halo) this.halo(e, looks, suspects[name]);
    }
    for (const e of this.wires) {
      const [tail, head] = this.bonds[e.dataset.bond] || [];
      e.classList.toggle("lit", lit.has(tail) && lit.has(head));
    }
  }
}
