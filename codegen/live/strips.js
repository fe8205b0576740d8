// Signals that scroll: a residual in the band between its thresholds, or a sensor of three machines.
const LONG = 20; // s
const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
const short = (x) => (x === 0 ? "0" : Math.abs(x) >= 1e4 || Math.abs(x) < 1e-2 ? x.toExponential(1) : String(Number(x.toPrecision(3)))).replace("e+", "e").replace("-", "−");

class Strip {
  constructor(into, parts) {
    this.box = document.createElement("div");
    this.box.className = "strip";
    const head = document.createElement("p");
    for (const [kind, text] of parts) {
      const part = document.createElement(kind === "name" ? "b" : "span");
      part.className = kind;
      part.textContent = text;
      head.append(part);
      this[kind] = part;
    }
    this.canvas = document.createElement("canvas");
    this.canvas.setAttribute("role", "img");
    this.box.append(head, this.canvas);
    into.append(this.box);
    this.size = 0;
  }

  // The canvas in pixels of the screen, and where a time and a value are on it.
  paper(end, least, most) {
    const { clientWidth: w, clientHeight: h } = this.canvas, dense = devicePixelRatio || 1;
    if (this.canvas.width !== Math.round(w * dense) || this.canvas.height !== Math.round(h * dense)) {
      this.canvas.width = Math.round(w * dense);
      this.canvas.height = Math.round(h * dense);
    }
    const pen = this.canvas.getContext("2d");
    pen.setTransform(dense, 0, 0, dense, 0, 0);
    pen.clearRect(0, 0, w, h);
    pen.lineJoin = "round";
    const x = (t) => w - ((end - t) / LONG) * w;
    const y = (v) => h - 4 - ((v - least) / (most - least || 1)) * (h - 8);
    return { pen, x, y, w, h };
  }
}

const recent = (points) => { while (points.length > 2 && points[1][0] < points.at(-1)[0] - LONG) points.shift(); };

export class Residual extends Strip {
  constructor(into, name, unit, whose) {
    super(into, [["name", name], ["limit", ""], ["ratio", ""], ["mark", "▲ fired"]]);
    this.title = name;
    this.unit = unit === "1" ? "" : unit;
    this.whose = whose;
    this.clear();
  }

  clear() { this.points = { real: [], virtual: [] }; }

  turn(whose) { this.whose = whose; }

  add(whose, t, [low, high, limit, out]) {
    const points = this.points[whose];
    points.push([t, low, high, limit, out]);
    recent(points);
  }

  draw() {
    const points = this.points[this.whose], last = points.at(-1);
    let most = 0;
    for (const [, low, high, limit] of points) most = Math.max(most, -(low ?? 0), high ?? 0, limit ?? 0);
    // A scale that does not tremble: the next of 1, 2, 5 times a power of ten.
    const power = 10 ** Math.floor(Math.log10(most || 1));
    this.size = [1, 1.5, 2, 3, 5, 7.5, 10].map((m) => m * power).find((s) => s >= most * 1.02) || 10 * power;
    const { pen, x, y, w } = this.paper(last ? last[0] : 0, -this.size, this.size);
    const band = points.filter((p) => p[3] !== null);
    if (band.length) {
      pen.beginPath();
      band.forEach((p) => pen.lineTo(x(p[0]), y(p[3])));
      band.slice().reverse().forEach((p) => pen.lineTo(x(p[0]), y(-p[3])));
      pen.fillStyle = style("band");
      pen.fill();
      pen.strokeStyle = style("faint");
      pen.lineWidth = 1;
      pen.setLineDash([5, 4]);
      for (const sign of [1, -1]) {
        pen.beginPath();
        band.forEach((p) => pen.lineTo(x(p[0]), y(sign * p[3])));
        pen.stroke();
      }
      pen.setLineDash([]);
    }
    pen.strokeStyle = style("box");
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(0, y(0));
    pen.lineTo(w, y(0));
    pen.stroke();
    const out = last && last[4];
    pen.strokeStyle = style(out ? "clash" : "ink");
    pen.lineWidth = out ? 2 : 1.3;
    pen.beginPath();
    let on = false;
    for (const [t, low, high] of points) {
      if (low === null) { on = false; continue; }
      if (on) pen.lineTo(x(t), y(low)); else pen.moveTo(x(t), y(low));
      pen.lineTo(x(t), y(high));
      on = true;
    }
    pen.stroke();
    this.tell(last, out);
  }

  tell(last, out) {
    const known = last && last[3] !== null;
    const unit = this.unit ? ` ${this.unit}` : "";
    this.limit.textContent = !last ? "" : last[1] === null ? "warming up" : known ? `threshold ±${short(last[3])}${unit}` : `learning its threshold, ±${short(this.size)}${unit} shown`;
    const ratio = known && last[1] !== null ? Math.max(-last[1], last[2]) / last[3] : 0;
    this.ratio.textContent = known && last[1] !== null ? `${ratio.toFixed(ratio < 10 ? 1 : 0)} × threshold` : "";
    this.box.classList.toggle("fired", Boolean(out));
    this.canvas.setAttribute("aria-label", `${this.title}: ${this.limit.textContent} ${this.ratio.textContent}`);
  }
}

const LINES = [["trace", [], 3.4], ["inertia", [7, 5], 1.8], ["resistor", [2, 3], 1.8]]; // real, virtual, desired

export class Plot extends Strip {
  constructor(into, name, unit) {
    super(into, [["name", name], ["ratio", ""]]);
    this.unit = unit === "1" ? "" : unit;
    this.clear();
  }

  clear() { this.points = []; }

  add(t, values) {
    this.points.push([t, ...values]);
    recent(this.points);
  }

  draw() {
    const all = this.points.flatMap((p) => p.slice(1)).filter((v) => v !== null);
    const least = Math.min(0, ...all), most = Math.max(0, ...all, least + 1e-300), last = this.points.at(-1);
    const { pen, x, y } = this.paper(last ? last[0] : 0, least, most);
    LINES.forEach(([colour, dash, width], k) => {
      pen.strokeStyle = style(colour);
      pen.lineWidth = width;
      pen.setLineDash(dash);
      pen.beginPath();
      for (const p of this.points) if (p[k + 1] !== null) pen.lineTo(x(p[0]), y(p[k + 1]));
      pen.stroke();
    });
    pen.setLineDash([]);
    if (last) this.ratio.textContent = `${short(last[1] ?? NaN)} ${this.unit}, from ${short(least)} to ${short(most)}`;
  }
}
