// Signals over time: a residual in the band between its thresholds, or a sensor of three machines.
import { BAND, EDGE, KEY, chart, ink, line, named, roomy, swatch, withUnit } from "./charts.js";
import { make, number } from "./dom.js";

const HIGH = 132; // px
const MACHINES = [["real", "trace", [], 3.4], ["virtual", "inertia", [7, 5], 1.8], ["desired", "resistor", [2, 3], 1.8]];
const write = (element, text) => { if (element.textContent !== text) element.textContent = text; };

class Strip {
  constructor(into, name, unit, record, view) {
    Object.assign(this, { name, unit, record, view, near: true, chosen: true, stale: true, drawn: [0, 0] });
    this.head = make("p", {}, make("b", { class: "name" }, name));
    this.values = make("p");
    this.place = make("div", { class: "chart" });
    this.box = make("div", { class: "strip" }, this.head, this.values, this.place);
    into.append(this.box);
    this.sight = new IntersectionObserver((seen) => { this.near = seen.at(-1).isIntersecting; if (this.near) this.view.changed(); });
    this.sight.observe(this.box);
    this.width = new ResizeObserver(() => this.sized());
    this.width.observe(this.place);
  }

  begin(series, options, hooks = {}) {
    const { view } = this, cursor = {
      // All charts show the same time, so the cursor is at the same place; that one zooms which is dragged over.
      sync: { key: KEY, scales: [null, null], filters: { pub: (type) => type !== "mousedown" && type !== "mouseup" } },
      drag: { x: true, y: false, setScale: false },
      bind: {
        dblclick: () => () => view.follow(),
        mousedown: (_, over, does) => (event) => { if (event.button === 0 && event.target === over) { view.held = true; does(event); } },
      },
    };
    const zoom = (plot) => {
      const { left, width } = plot.select;
      if (width > 2) view.zoom(plot.posToVal(left, "x"), plot.posToVal(left + width, "x"));
      if (width) plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    };
    const tell = () => this.tell();
    this.plot = chart(this.place, {
      width: this.place.clientWidth || 300, height: HIGH, unit: this.unit, series, cursor, ...options,
      hooks: { ...hooks, setSelect: [zoom], setCursor: [tell], draw: [tell] },
    }, series.map(() => []));
    this.plot.root.setAttribute("role", "img");
  }

  end() {
    this.sight.disconnect();
    this.width.disconnect();
    this.plot?.destroy();
    this.box.remove();
  }

  sized() {
    const width = this.place.clientWidth;
    if (this.plot && width && width !== this.plot.width) this.plot.setSize({ width, height: HIGH });
  }

  choose(on) {
    this.chosen = on;
    this.box.hidden = !on;
    this.stale = true;
  }

  // A picture that would differ by less than half a pixel is not drawn.
  draw([from, to]) {
    if (!this.chosen || !this.near) return;
    const pixel = (to - from) / this.plot.width, moved = Math.max(Math.abs(from - this.drawn[0]), Math.abs(to - this.drawn[1]));
    const end = Math.min(to, this.record.last);
    if (!this.stale && moved < pixel / 2 && Math.abs(end - this.until) < pixel / 2) { this.tell(); return; }
    Object.assign(this, { stale: false, drawn: [from, to], until: end });
    this.plot.batch(() => {
      this.plot.setData(this.rows(this.record.picture([from, to], this.places, this.plot.width / 2)), false);
      this.plot.setScale("x", { min: from, max: to });
    });
  }

  // Which point of the picture is under the cursor; null: none is.
  get pointed() {
    const { plot, view } = this, left = plot.cursor.left ?? -1, on = left >= 0 && plot.data[0].length > 0;
    const k = on ? plot.posToIdx(left) : null;
    if (this.near && this.chosen) view.cursor(on ? plot.data[0][k] : null);
    return k;
  }
}

export class Residual extends Strip {
  constructor(into, name, unit, record, first, view, whose) {
    super(into, name, unit, record, view);
    this.first = first;
    this.size = 1;
    this.whose = whose;
    for (const kind of ["limit", "mark", "value", "ratio"]) this[kind] = make("span", { class: kind }, kind === "mark" ? "▲ fired" : "");
    this.head.append(this.limit, this.mark);
    this.values.append(this.value, this.ratio);
    const out = line("clash", 1.5), inside = line("ink", 1);
    this.begin([{}, EDGE, EDGE, inside, inside, out, out], {
      bands: [BAND, { series: [4, 3], fill: () => ink("ink") }, { series: [6, 5], fill: () => ink("clash") }],
      scales: { y: { range: () => [-this.size, this.size] } },
    }, { drawAxes: [(plot) => this.zero(plot)] });
  }

  turn(whose) {
    this.whose = whose;
    this.stale = true;
  }

  // Where the least and the largest value, the threshold, and whether it is outside are.
  get places() { const k = this.first + (this.whose === "virtual" ? 4 : 0); return [k, k + 1, k + 2, k + 3]; }

  rows([t, low, high, limit, out]) {
    const red = out.map((o, k) => o || out[k - 1] || out[k + 1]), only = (v, k) => (red[k] ? v : null);
    let most = 0;
    for (let k = 0; k < low.length; k++) most = Math.max(most, -(low[k] ?? 0), high[k] ?? 0, limit[k] ?? 0);
    // A scale that does not tremble: the next of some parts of a power of ten.
    const power = 10 ** Math.floor(Math.log10(most || 1));
    this.size = [1, 1.5, 2, 3, 5, 7.5, 10].map((m) => m * power).find((s) => s >= most * 1.02) || 10 * power;
    return [t, limit, limit.map((v) => (v === null ? null : -v)), low, high, low.map(only), high.map(only)];
  }

  zero(plot) {
    const pen = plot.ctx, { left, width } = plot.bbox, y = Math.round(plot.valToPos(0, "y", true)) + 0.5;
    pen.save();
    pen.strokeStyle = ink("faint");
    pen.lineWidth = devicePixelRatio || 1;
    pen.beginPath();
    pen.moveTo(left, y);
    pen.lineTo(left + width, y);
    pen.stroke();
    pen.restore();
  }

  tell() {
    const k = this.pointed, newest = this.places.map((p) => this.record.columns[p].at(-1) ?? null);
    const [low, high, limit] = k === null ? newest : [3, 4, 1].map((s) => this.plot.data[s][k]);
    const known = low !== null && limit !== null, ratio = known ? Math.max(-low, high) / limit : 0;
    write(this.limit, !this.record.t.length ? "" : low === null ? "warming up" : limit === null ? "learning its threshold" : `threshold ±${withUnit(limit, this.unit, 3)}`);
    const same = low !== null && number(low, 3) === number(high, 3);
    write(this.value, low === null ? "" : same ? withUnit(low, this.unit, 3) : `${number(low, 3)} to ${withUnit(high, this.unit, 3)}`);
    write(this.ratio, known ? `${ratio.toFixed(ratio < 10 ? 1 : 0)} × threshold` : "");
    this.value.classList.toggle("out", ratio > 1);
    this.box.classList.toggle("fired", Boolean(newest[3]));
    this.plot.root.setAttribute("aria-label", `${this.name} of the ${this.whose} one: ${this.limit.textContent}`);
  }

  // For a table: what a column is called, and its values.
  table() {
    const [low, high, limit] = this.places.map((k) => this.record.columns[k]), unit = named(this.unit) ? ` [${this.unit}]` : "";
    return [["least", low], ["largest", high], ["threshold", limit]].map(([what, column]) => [`${this.name} ${this.whose} ${what}${unit}`, column]);
  }
}

export class Sensor extends Strip {
  constructor(into, name, unit, record, first, view, lacking) {
    super(into, name, unit, record, view);
    this.first = first;
    this.machines = MACHINES.filter(([one]) => !lacking.includes(one));
    if (named(unit)) this.head.append(make("span", { class: "limit" }, `in ${unit}`));
    this.told = this.machines.map(([one, colour, dash, width]) => {
      const value = make("span", { class: "value" });
      this.values.append(make("span", { class: "which" }, swatch(colour, dash, Math.min(3, width)), `${one} `, value));
      return value;
    });
    this.begin([{}, ...this.machines.map(([, colour, dash, width]) => line(colour, width, dash))], { scales: { y: { range: (_, least, most) => roomy(least, most) } } });
    this.plot.root.setAttribute("aria-label", `${name}: ${this.machines.map(([one]) => one).join(", ")}`);
  }

  get places() { return this.machines.map(([one]) => this.first + MACHINES.findIndex((m) => m[0] === one)); }

  rows(picture) { return picture; }

  tell() {
    const k = this.pointed;
    this.places.forEach((p, which) => write(this.told[which], number(k === null ? this.record.columns[p].at(-1) : this.plot.data[which + 1][k], 4)));
  }

  table() {
    const unit = named(this.unit) ? ` [${this.unit}]` : "";
    return this.places.map((p, which) => [`${this.name} ${this.machines[which][0]}${unit}`, this.record.columns[p]]);
  }
}
