// All that was said: an entry for each alarm, with its course and what became of it; else a line.
import { $, make, number, percent } from "./dom.js";
import { named } from "./charts.js";

const KEPT = 300; // entries
const LONG = 100; // lines of a course
const moment = (t) => (t === null ? "" : `${t.toFixed(2)} s`);

// A candidate with its size, or where it stands that does not follow any more.
export const sized = ([fault, size, unit, , stands]) => {
  const known = size ?? stands ?? null, sign = size === null ? "stands at " : size > 0 ? "+" : "";
  return [fault, known === null ? "" : `${sign}${number(known, 3)}${named(unit) ? ` ${unit}` : ""}`];
};

const line = (v) => make("li", { class: v.event }, make("span", { class: "at" }, moment(v.time)), make("span", { class: "whose" }, v.whose), make("span", { class: "event" }, v.event),
  make("div", { class: "text" }, v.message, candidates(v)));

function candidates(v) {
  if (!v.candidates.length) return null;
  return make("ul", { class: "among" }, ...v.candidates.map((c) => { const [fault, size] = sized(c); return make("li", {}, fault, size ? make("small", {}, ` ${size}`) : null, ` ${percent(c[3])}`); }));
}

class Alarm {
  constructor(v) {
    this.since = v.since ?? v.time;
    this.updates = 0;
    this.left = make("li", { class: "left", hidden: true }, make("span", { class: "text" }));
    this.course = make("ol", { class: "course" }, this.left);
    this.what = make("span", { class: "text" });
    this.fate = make("span", { class: "fate" });
    this.entry = make("li", { class: "alarm", data: { state: "there" } }, make("details", {},
      make("summary", {}, make("span", { class: "at" }, moment(v.time)), make("span", { class: "whose" }, v.whose), make("span", { class: "event" }, "fault"), this.what, this.fate), this.course));
    this.add(v);
  }

  add(v) {
    this.course.append(line(v));
    const over = ++this.updates - LONG;
    if (over > 0) { // the first line stays, and the last ones
      this.left.hidden = false;
      this.left.lastChild.textContent = `${over} more`;
      if (over === 1) this.course.children[1].after(this.left);
      this.left.nextSibling.remove();
    }
    if (v.event === "cleared") {
      this.entry.dataset.state = "cleared";
      this.fate.textContent = v.time === null || this.since === null ? "cleared" : `cleared at ${moment(v.time)}, after ${moment(v.time - this.since)}`;
      return;
    }
    if (v.finding) this.what.textContent = v.finding;
    this.fate.textContent = "still there";
  }
}

export class Courses {
  constructor() { this.clear(); }

  clear() {
    this.open = { real: null, virtual: null };
    $("verdicts").replaceChildren();
  }

  // `finding`, if this says that a fault is there, is what it is in a few words.
  add(v, finding) {
    const told = { ...v, finding }, open = this.open[v.whose];
    if (open) open.add(told);
    else if (finding) {
      this.open[v.whose] = new Alarm(told);
      $("verdicts").prepend(this.open[v.whose].entry);
    } else $("verdicts").prepend(line(v));
    if (v.event === "cleared") this.open[v.whose] = null;
    while ($("verdicts").children.length > KEPT) $("verdicts").lastChild.remove();
  }

  // No more samples come.
  ended() {
    for (const alarm of Object.values(this.open)) if (alarm) alarm.fate.textContent = "still there at the end";
  }
}
