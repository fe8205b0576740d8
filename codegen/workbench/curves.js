// Curves over time: axes, a cursor with values, and zoom, by uPlot; residuals between their thresholds.
import { BAND, EDGE, FONT, chart, line, named, swatch, withUnit } from "./charts.js";
import { colour, make, number } from "./dom.js";

const LINES = ["inertia", "resistor", "capacity", "source"], DASHES = [[], [7, 4], [2, 3], [9, 4, 2, 4]];

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
    const width = this.columns();
    this.width = this.into.clientWidth;
    const group = (title, boxes) => { if (boxes.length) this.into.append(make("h3", {}, title), make("div", { class: "plots" }, ...boxes)); };
    const later = [];
    const box = (fired, lines, options, data) => {
      const words = lines.map(({ name, stroke, dash, unit, series }, k) => ({ unit, series: series ?? k + 1, value: make("span", { class: "value" }, named(unit) ? `in ${unit}` : ""), name: make("b", {}, name), stroke, dash }));
      const place = make("div", { class: `plot${fired ? " fired" : ""}` }, make("p", {}, ...words.map((w) => make("span", {}, lines.length > 1 ? swatch(w.stroke, w.dash) : null, w.name, " ", w.value)), fired ? make("span", { class: "mark" }, "▲ fired") : null));
      const tell = (plot) => words.forEach((w) => { w.value.textContent = at(plot, w.series, w.unit); });
      later.push(() => this.made.push(chart(place, { width, unit: lines[0].unit, ...options, plugins: [...options.plugins, { hooks: { setCursor: tell } }] }, data)));
      return place;
    };
    group("Residuals", run.residuals.map((r, k) => this.residual(r, run, k === 0, box)));
    group("Signals", run.signals.map((panel) => this.panel(panel, run, box)));
    later.forEach((f) => f());
  }

  residual(r, run, first, box) {
    const fired = run.fired.includes(r.name), stroke = fired ? "clash" : "ink";
    return box(fired, [{ name: r.name, stroke, unit: r.unit, series: 3 }], {
      height: 140, plugins: [marks(run.marks, first)], bands: [BAND],
      series: [{}, EDGE, EDGE, line(stroke, 1.5)], // the last one is on top
    }, [r.t, r.bound, r.bound.map((b) => (b === null ? null : -b)), r.v]);
  }

  panel(panel, run, box) {
    const lines = panel.lines.map((l, k) => ({ name: l.name, stroke: LINES[k % 4], unit: panel.unit, dash: DASHES[k % 4] }));
    return box(false, lines, {
      height: 150, plugins: [marks(run.marks, false)],
      series: [{}, ...lines.map(({ stroke, dash }) => line(stroke, 1.6, dash))],
    }, joined(panel.lines));
  }
}

// The value of a curve at the cursor: of a point of its own, not after it.
function at(plot, series, unit) {
  const end = plot.cursor.idx;
  if (end === null || end === undefined) return named(unit) ? `in ${unit}` : "";
  let k = end;
  while (k > 0 && plot.data[series][k] === undefined) k--;
  return `${withUnit(plot.data[series][k], unit)} at ${number(plot.data[0][end])} s`;
}
