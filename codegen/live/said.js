// What the watches of the real and of the virtual machine say, in words.
import { percent } from "./graph.js";

const KEPT = 300;
const element = (kind, className, text) => {
  const made = document.createElement(kind);
  if (className) made.className = className;
  if (text !== undefined) made.textContent = text;
  return made;
};
export const amount = (x) => String(Number(x.toPrecision(3))).replace("-", "−");

export class Diagnosis {
  constructor($, changed) {
    this.$ = $;
    this.changed = changed;
    this.clear();
  }

  clear() {
    this.found = { real: new Map(), virtual: new Map() };
    this.state = { real: "", virtual: "" };
    this.$("verdicts").replaceChildren();
    for (const one of ["real", "virtual"]) this.now(one, "wait", "waiting for samples");
  }

  // Until the first verdict: whether residuals can be believed yet.
  warm(frame) {
    for (const one of ["real", "virtual"]) {
      const r = frame[one].r;
      if (!r || !["", "wait", "learn"].includes(this.state[one])) continue;
      if (r.every((x) => x[1] === null)) this.now(one, "wait", "residuals are warming up");
      else if (r.some((x) => x[1] !== null && x[2] === null)) this.now(one, "learn", "learning what noise does");
      else this.now(one, "well", "no fault seen");
    }
  }

  add(v) {
    const line = element("li", v.event);
    line.append(element("span", "at", `${v.time === null ? "" : v.time.toFixed(2)} s`), element("span", "whose", v.whose), element("span", "event", v.event), element("span", "text", v.message));
    this.$("verdicts").prepend(line);
    while (this.$("verdicts").children.length > KEPT) this.$("verdicts").lastChild.remove();
    if (v.event === "fault" || v.event === "update" || (v.event === "resumed" && v.candidates.length)) {
      const since = v.since === null ? "" : ` since ${v.since.toFixed(2)} s`;
      const [first] = v.candidates, many = v.message.includes("more than one fault") || v.message.startsWith("no single fault");
      const which = many ? "more than one, or not in the model" : first && first[3] >= 0.75 ? `most likely ${first[0]}` : v.group.length ? v.group.join(" or ") : first ? "one of these" : "not known which";
      const sure = `fault${since}: ${which}`, shown = many ? [] : v.candidates;
      this.found[v.whose] = new Map(shown.map((c) => [c[0], c[3]]));
      this.now(v.whose, "fault", sure, shown);
      this.changed(v.whose);
    } else if (v.event === "cleared") {
      this.found[v.whose] = new Map();
      this.now(v.whose, "well", "no fault any more");
      this.changed(v.whose);
    } else if (v.event === "warm-up" && this.state[v.whose] !== "fault") this.now(v.whose, "well", "no fault seen");
    else if (v.event === "invalid" && v.message.includes("stands still")) this.now(v.whose, "still", v.message);
    else if (/(is|are) blind\b/.test(v.message) && this.state[v.whose] !== "fault") this.now(v.whose, "still", v.message);
    else if (v.message.startsWith("samples come again") && this.state[v.whose] === "still") this.now(v.whose, "well", "no fault seen");
  }

  now(whose, state, text, candidates = []) {
    const box = this.$(`now-${whose}`);
    if (this.state[whose] === state && box.querySelector(".finding").textContent === text && !candidates.length) return;
    this.state[whose] = box.dataset.state = state;
    box.querySelector(".finding").textContent = text;
    box.querySelector(".candidates").replaceChildren(...candidates.slice(0, 6).map(([fault, size, unit, chance]) => {
      const line = element("li");
      const name = element("span", "name", fault);
      if (size !== null) name.append(" ", element("small", "", `${size > 0 ? "+" : ""}${amount(size)}${unit && unit !== "1" ? ` ${unit}` : ""}`));
      const share = element("span", "share"), part = element("i");
      part.style.width = `${100 * chance}%`;
      share.append(part);
      share.setAttribute("aria-hidden", "true");
      line.append(name, share, element("span", "amount", percent(chance)));
      return line;
    }), ...(candidates.length > 6 ? [element("li", "", `and ${candidates.length - 6} more`)] : []));
  }
}
