// Machines in the plane: paths, bodies with their heading, names that keep clear of each other.
import { nice } from "./charts.js";

const SVG = "http://www.w3.org/2000/svg";
const ALL = ["desired", "real", "virtual"]; // the last is drawn on top
const MOST = 2400; // points of a path
const SEEN = 600; // the last ones, which names keep clear of
const make = (into, kind, attributes = {}) => {
  const made = document.createElementNS(SVG, kind);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  into.append(made);
  return made;
};
const metres = (x) => (x >= 1 ? `${Number(x.toPrecision(2))} m` : x >= 0.01 ? `${Number((x * 100).toPrecision(2))} cm` : `${Number((x * 1000).toPrecision(2))} mm`);

export class Plane {
  constructor(svg, heading) {
    svg.replaceChildren();
    this.svg = svg;
    this.heading = heading;
    this.grid = make(svg, "path", { class: "grid" });
    this.line = {}; this.body = {}; this.leader = {}; this.label = {}; this.spot = {}; this.with = {};
    for (const one of ALL) this.line[one] = make(svg, "path", { class: `path ${one}` });
    for (const one of ALL) this.body[one] = make(svg, "path", { class: `body ${one}` });
    for (const one of ALL) {
      this.leader[one] = make(svg, "path", { class: "leader" });
      this.label[one] = make(svg, "text", { class: "name" });
    }
    this.bar = make(svg, "path", { class: "scale" });
    this.length = make(svg, "text", { class: "length" });
    this.clear();
  }

  clear() {
    this.paths = { desired: [], virtual: [], real: [] };
    this.pose = {};
    this.view = null;
  }

  move(one, pose, walk) {
    if (pose.length < 2 || pose[0] === null || pose[1] === null) return;
    this.pose[one] = pose;
    const path = this.paths[one], last = path.at(-1);
    if (!walk || (last && last[0] === pose[0] && last[1] === pose[1])) return;
    path.push([pose[0], pose[1]]);
    if (path.length > MOST) this.paths[one] = path.filter((_, k) => k % 2 === 0);
  }

  // A view that holds everything, and moves only when it has to.
  fit(w, h) {
    let [a, b, c, d] = [Infinity, Infinity, -Infinity, -Infinity];
    for (const one of ALL) for (const [x, y] of [...this.paths[one], ...(this.pose[one] ? [this.pose[one]] : [])]) {
      a = Math.min(a, x); b = Math.min(b, y); c = Math.max(c, x); d = Math.max(d, y);
    }
    if (!(c >= a)) [a, b, c, d] = [-0.5, -0.5, 0.5, 0.5];
    const room = 46, scale = Math.min((w - 2 * room) / (c - a || 1e-9), (h - 2 * room) / (d - b || 1e-9), 4000);
    const old = this.view;
    const inside = old && old.w === w && old.h === h && old.x(a) > 14 && old.x(c) < w - 14 && old.y(d) > 14 && old.y(b) < h - 30 && old.scale < 1.7 * scale && old.scale > scale / 1.7;
    if (inside) return old;
    const k = scale / 1.15, mx = (a + c) / 2, my = (b + d) / 2;
    this.view = { w, h, scale: k, x: (x) => w / 2 + (x - mx) * k, y: (y) => h / 2 - 6 - (y - my) * k, mx, my };
    return this.view;
  }

  draw() {
    const { clientWidth: w, clientHeight: h } = this.svg;
    if (!w || !h) return;
    this.svg.setAttribute("viewBox", `0 0 ${w} ${h}`);
    const view = this.fit(w, h), taken = [];
    const at = ([x, y]) => `${view.x(x).toFixed(1)} ${view.y(y).toFixed(1)}`;
    for (const one of ALL) {
      const path = this.paths[one];
      this.line[one].setAttribute("d", path.length > 1 ? `M${path.map(at).join("L")}` : "");
      const pose = this.pose[one];
      this.body[one].setAttribute("d", pose ? this.outline(view, pose) : "");
      if (pose) taken.push([view.x(pose[0]) - 13, view.y(pose[1]) - 13, 26, 26]);
    }
    this.rule(view);
    taken.push([8, h - 36, 180, 30]);
    const lines = ALL.flatMap((one) => this.paths[one].slice(-SEEN).map(([x, y]) => [view.x(x), view.y(y)]));
    const groups = this.together(view);
    for (const one of ALL) this.name(one, groups.find((g) => g[0] === one), view, taken, lines);
  }

  // Machines at about the same place have one label; who has shared one goes on to for a while.
  together(view) {
    const groups = [];
    const near = (a, b, far) => Math.hypot(...[0, 1].map((k) => this.pose[a][k] - this.pose[b][k])) * view.scale < far;
    for (const one of ALL.filter((o) => this.pose[o])) {
      const group = groups.find((g) => near(g[0], one, this.with[one] === g[0] ? 22 : 14));
      if (group) group.push(one); else groups.push([one]);
      this.with[one] = group ? group[0] : one;
    }
    return groups;
  }

  outline(view, [x, y, heading]) {
    const [u, v] = [view.x(x), view.y(y)];
    if (!this.heading || heading === null || heading === undefined) return `M${u - 6} ${v}a6 6 0 1 0 12 0a6 6 0 1 0 -12 0`;
    const [c, s] = [Math.cos(heading), -Math.sin(heading)];
    return `M${[[12, 0], [-8, 7], [-4, 0], [-8, -7]].map(([p, q]) => `${(u + p * c - q * s).toFixed(1)} ${(v + p * s + q * c).toFixed(1)}`).join("L")}Z`;
  }

  // The grid, and a bar that says how long something is.
  rule(view) {
    const long = nice(130 / view.scale), step = long * view.scale;
    let d = "";
    for (let x = view.x(0) % step; x < view.w; x += step) d += `M${x.toFixed(1)} 0V${view.h}`;
    for (let y = view.y(0) % step; y < view.h; y += step) d += `M0 ${y.toFixed(1)}H${view.w}`;
    this.grid.setAttribute("d", d);
    this.bar.setAttribute("d", `M14 ${view.h - 18}v8h${step.toFixed(1)}v-8`);
    this.length.setAttribute("x", 20 + step);
    this.length.setAttribute("y", view.h - 10);
    this.length.textContent = metres(long);
  }

  // The name of machines, beside them where nothing else is; where it was, if that is as good.
  name(one, group, view, taken, lines) {
    const pose = this.pose[one], label = this.label[one];
    label.style.display = group ? "" : "none";
    this.leader[one].setAttribute("d", "");
    if (!group) return;
    label.textContent = group.join(", ");
    const w = label.getComputedTextLength() + 6, h = 18, [u, v] = [view.x(pose[0]), view.y(pose[1])];
    const spots = [];
    for (const far of [17, 30, 48, 66]) for (const turn of [0, -1, 1, -2, 2, -3, 3, 4]) {
      const angle = (turn * Math.PI) / 4;
      spots.push([far * Math.cos(angle), far * Math.sin(angle)]);
    }
    const box = ([dx, dy]) => [dx < -1 ? u + dx - w : dx > 1 ? u + dx : u - w / 2, v + dy - h / 2, w, h];
    const meet = ([x, y, bw, bh], [p, q, r, s]) => x < p + r && p < x + bw && y < q + s && q < y + bh;
    const cost = (spot) => {
      const own = box(spot), [x, y, bw, bh] = own;
      const out = x <= 2 || y <= 2 || x + bw >= view.w - 2 || y + bh >= view.h - 2;
      const crossed = lines.filter(([p, q]) => x < p && p < x + bw && y < q && q < y + bh).length;
      return (out ? 1e4 : 0) + 1e3 * taken.filter((t) => meet(own, t)).length + 6 * Math.min(crossed, 40) + Math.hypot(...spot);
    };
    let spot = spots.reduce((best, s) => { const c = cost(s); return c < best[0] ? [c, s] : best; }, [Infinity, spots[0]])[1];
    if (this.spot[one] && cost(this.spot[one]) < cost(spot) + 25) spot = this.spot[one];
    const [x, y] = box(spot);
    this.spot[one] = spot;
    taken.push(box(spot));
    label.setAttribute("x", x + 3);
    label.setAttribute("y", y + 13.5);
    if (Math.hypot(...spot) > 20) this.leader[one].setAttribute("d", `M${u} ${v}L${u + spot[0]} ${v + spot[1]}`);
  }
}
