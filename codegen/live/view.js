// Which time is seen: the last seconds, or what somebody has zoomed into; and where the cursor is.
import { $, number } from "./dom.js";

const STEP = 8; // px that a key moves the cursor

export class View {
  constructor(changed) {
    this.changed = changed;
    this.zoomed = null;
    this.held = false;
    $("span").onchange = () => this.follow();
    $("follow").onclick = () => this.follow();
    addEventListener("pointerup", () => { this.held = false; changed(); });
  }

  get span() { return Number($("span").value) || Infinity; }

  // From when to when; nothing moves while somebody drags.
  window(record) {
    if (this.zoomed) return this.zoomed;
    if (this.held && this.now) return this.now;
    const { first, last } = record, long = this.span === Infinity ? Math.max(1, last - first) : this.span;
    this.now = [Math.max(first, last - long), Math.max(first, last - long) + long];
    return this.now;
  }

  zoom(from, to) {
    if (!(to > from)) return;
    this.zoomed = [from, to];
    this.held = false;
    this.tell();
  }

  follow() {
    this.zoomed = this.now = null;
    this.tell();
  }

  tell() {
    $("follow").setAttribute("aria-pressed", String(!this.zoomed));
    const span = $("span").selectedOptions[0].textContent;
    $("seen").textContent = this.zoomed ? this.zoomed.map((t) => t.toFixed(2)).join(" to ") + " s" : `follows, ${span}`;
    this.changed();
  }

  cursor(time) {
    const text = time === null ? "" : `cursor at ${number(time, 6)} s`;
    if ($("cursor").textContent !== text) $("cursor").textContent = text;
  }

  // Arrows move the cursor, + and − zoom around it, Home follows again.
  key(event, plot) {
    const wide = plot.over.clientWidth, at = plot.cursor.left >= 0 ? plot.cursor.left : wide;
    const { min, max } = plot.scales.x, time = plot.posToVal(at, "x");
    const zoom = (by) => this.zoom(time - (time - min) * by, time + (max - time) * by);
    // Where moments are far apart (a network that lagged), a step goes to the next one, not a few pixels.
    const move = (by) => {
      const times = plot.data[0], from = plot.posToIdx(at), next = times[from + Math.sign(by)];
      const left = plot.posToIdx(at + by) === from && next !== undefined ? plot.valToPos(next, "x") : at + by;
      plot.setCursor({ left: Math.min(wide, Math.max(0, left)), top: 10 }, true, true);
    };
    const does = { ArrowLeft: () => move(-STEP), ArrowRight: () => move(STEP), "+": () => zoom(0.5), "-": () => zoom(2), Home: () => this.follow() }[event.key];
    if (!does || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    does();
  }
}
