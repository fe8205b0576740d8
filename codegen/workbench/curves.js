// Curves over time: axes, a cursor with values, and zoom, by uPlot; residuals between their thresholds.
import { uPlot } from "./vendored.js";
import { colour, make, number } from "./dom.js";

const LINES = ["inertia", "resistor", "capacity", "source"], DASHES = [[], [7, 4], [2, 3], [9, 4, 2, 4]];
const FONT = '11px "Source Sans 3", "Segoe UI", "Helvetica Neue", "Liberation Sans", Arial, sans-serif';

// All times of some curves in order, and the curves at these: null where one has no point of its own.
function joined(curves) {
  const times = [...new Set(curves.flatMap((c) => c.t))].sort((a, b) => a - b);
  const place = new Map(times.map((t, k) => [t, k]));
  const rows = curves.map((c) => {
    const row = new Array(times.length).fill(undefined);
    c.t.forEach((t, k) => { row[place.get(t)] = c.v[k]; });
    return row;
  });
  return [times, ...rows];
}

function axes() {
  const faint = colour("faint"), line = colour("line");
  const own = { stroke: faint, font: FONT, ticks: { stroke: line, width: 1, size: 4 }, grid: { stroke: line, width: 1 } };
  return [
    { ...own, size: 26, gap: 3, values: (_, ticks) => ticks.map((t) => number(t)), space: 70 },
    { ...own, size: 58, gap: 4, values: (_, ticks) => ticks.map((t) => number(t, 3)), space: 26 },
  ];
}

// What happens at a moment: a dotted line, with its words above the first plot.
function marks(moments, words) {
  return { hooks: { draw: [(plot) => {
    const pen = plot.ctx, { top, height } = plot.bbox, dense = devicePixelRatio || 1;
    pen.save();
    pen.strokeStyle = colour("clash");
    pen.fillStyle = colour("clash");
    pen.setLineDash([2 * dense, 3 * dense]);
    pen.font = FONT.replace("11px", `${11 * dense}px`);
    for (const [t, text] of moments) {
      const x = plot.valToPos(t, "x", true);
      pen.beginPath();
      pen.moveTo(x, top);
      pen.lineTo(x, top + height);
      pen.stroke();
      if (words) { const left = x + pen.measureText(text).width + 8 * dense < plot.bbox.left + plot.bbox.width; pen.textAlign = left ? "left" : "right"; pen.setLineDash([]); pen.lineWidth = 4 * dense; pen.strokeStyle = colour("paper"); pen.strokeText(text, x + (left ? 5 : -5) * dense, top + 11 * dense); pen.fillText(text, x + (left ? 5 : -5) * dense, top + 11 * dense); }
    }
    pen.restore();
  }] } };
}

export class Curves {
  constructor(into) { this.into = into; this.made = []; this.last = null; this.width = 0; new ResizeObserver(() => this.sized()).observe(into); }

  clear() { this.made.forEach((p) => p.destroy()); this.made = []; this.into.replaceChildren(); }

  sized() {
    const width = this.into.clientWidth;
    if (!width || width === this.width) return;
    this.width = width;
    const own = this.columns();
    this.made.forEach((p) => p.setSize({ width: own, height: p.height }));
  }

  columns() { const w = this.into.clientWidth || 600, n = w > 1100 ? 2 : 1; this.into.style.setProperty("--columns", n); return Math.floor((w - (n - 1) * 20) / n); }

  // A run: residuals above, signals below, all at one cursor.
  show(run) {
    this.clear();
    this.last = run;
    if (!run) return;
    const width = this.columns(), sync = uPlot.sync("bondgraph");
    this.width = this.into.clientWidth;
    const group = (title, boxes) => { if (boxes.length) this.into.append(make("h3", {}, title), make("div", { class: "plots" }, ...boxes)); };
    const later = [];
    const box = (fired, lines, options, data) => {
      const words = lines.map(({ name, stroke, unit, series }, k) => ({ unit, series: series ?? k + 1, value: make("span", { class: "value" }, unit && unit !== "1" ? `in ${unit}` : ""), name: make("b", {}, name), stroke }));
      const place = make("div", { class: `plot${fired ? " fired" : ""}` }, make("p", {}, ...words.map((w) => make("span", {}, lines.length > 1 ? swatch(w.stroke) : null, w.name, " ", w.value)), fired ? make("span", { class: "mark" }, "▲ fired") : null));
      const tell = (plot) => words.forEach((w) => { w.value.textContent = at(plot, w.series, w.unit); });
      later.push(() => this.made.push(new uPlot({ width, ...options, plugins: [...options.plugins, { hooks: { setCursor: tell } }], legend: { show: false }, scales: { x: { time: false } }, cursor: { sync: { key: sync.key }, drag: { x: true, y: false }, points: { size: 6 } } }, data, place)));
      return place;
    };
    group("Residuals", run.residuals.map((r, k) => this.residual(r, run, k === 0, box)));
    group("Signals", run.signals.map((panel) => this.panel(panel, run, box)));
    later.forEach((f) => f());
  }

  residual(r, run, first, box) {
    const fired = run.fired.includes(r.name), stroke = colour(fired ? "clash" : "ink");
    const edge = { stroke: colour("faint"), width: 1, dash: [5, 4], points: { show: false } };
    return box(fired, [{ name: r.name, stroke, unit: r.unit, series: 3 }], {
      height: 140, axes: axes(), plugins: [marks(run.marks, first)], bands: [{ series: [1, 2], fill: colour("band") }],
      series: [{}, edge, edge, { stroke, width: 1.5, points: { show: false } }], // the last one is on top
    }, [r.t, r.bound, r.bound.map((b) => (b === null ? null : -b)), r.v]);
  }

  panel(panel, run, box) {
    const lines = panel.lines.map((l, k) => ({ name: l.name, stroke: colour(LINES[k % 4]), unit: panel.unit, dash: DASHES[k % 4] }));
    return box(false, lines, {
      height: 150, axes: axes(), plugins: [marks(run.marks, false)],
      series: [{}, ...lines.map(({ stroke, dash }) => ({ stroke, dash, width: 1.6, spanGaps: false, points: { show: false } }))],
    }, joined(panel.lines));
  }
}

// The value of a curve at the cursor: of a point of its own, not after it.
function at(plot, series, unit) {
  const end = plot.cursor.idx;
  if (end === null || end === undefined) return unit && unit !== "1" ? `in ${unit}` : "";
  let k = end;
  while (k > 0 && plot.data[series][k] === undefined) k--;
  return `${number(plot.data[series][k])}${unit && unit !== "1" ? ` ${unit}` : ""} at ${number(plot.data[0][end])} s`;
}

function swatch(stroke) {
  const made = make("i", { class: "swatch", "aria-hidden": "true" });
  made.style.borderColor = stroke;
  return made;
}
