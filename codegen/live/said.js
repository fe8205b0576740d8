// What the watches of the real and of the virtual machine say, in words.
import { make, percent } from "./dom.js";
import { Courses, sized } from "./courses.js";

export class Diagnosis {
  constructor($, changed) {
    this.$ = $;
    this.changed = changed;
    this.courses = new Courses();
    this.clear();
  }

  clear() {
    this.found = { real: new Map(), virtual: new Map() };
    this.state = { real: "", virtual: "" };
    this.courses.clear();
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
    this.courses.add(v, this.finding(v));
  }

  // What this says of a machine now; a fault in a few words.
  finding(v) {
    if (v.event === "fault" || v.event === "update" || (v.event === "resumed" && v.candidates.length)) {
      const since = v.since === null ? "" : ` since ${v.since.toFixed(2)} s`;
      const [first] = v.candidates, many = v.message.includes("more than one fault") || v.message.startsWith("no single fault");
      const which = many ? "more than one, or not in the model" : first && first[3] >= 0.75 ? `most likely ${first[0]}` : v.group.length ? v.group.join(" or ") : first ? "one of these" : "not known which";
      const sure = `fault${since}: ${which}`, shown = many ? [] : v.candidates;
      this.found[v.whose] = new Map(shown.map((c) => [c[0], c[3]]));
      this.now(v.whose, "fault", sure, shown);
      this.changed(v.whose);
      return which;
    }
    if (v.event === "cleared") {
      this.found[v.whose] = new Map();
      this.now(v.whose, "well", "no fault any more");
      this.changed(v.whose);
    } else if (v.event === "warm-up" && this.state[v.whose] !== "fault") this.now(v.whose, "well", "no fault seen");
    else if (v.event === "invalid" && v.message.includes("stands still")) this.now(v.whose, "still", v.message);
    else if (/(is|are) blind\b/.test(v.message) && this.state[v.whose] !== "fault") this.now(v.whose, "still", v.message);
    else if (v.message.startsWith("samples come again") && this.state[v.whose] === "still") this.now(v.whose, "well", "no fault seen");
    return "";
  }

  now(whose, state, text, candidates = []) {
    const box = this.$(`now-${whose}`);
    if (this.state[whose] === state && box.querySelector(".finding").textContent === text && !candidates.length) return;
    this.state[whose] = box.dataset.state = state;
    box.querySelector(".finding").textContent = text;
    box.querySelector(".candidates").replaceChildren(...candidates.slice(0, 6).map((candidate) => {
      const [fault, size] = sized(candidate), chance = candidate[3], part = make("i");
      part.style.width = `${100 * chance}%`;
      return make("li", {}, make("span", { class: "name" }, fault, size ? make("small", {}, ` ${size}`) : null),
        make("span", { class: "share", "aria-hidden": "true" }, part), make("span", { class: "amount" }, percent(chance)));
    }), ...(candidates.length > 6 ? [make("li", {}, `and ${candidates.length - 6} more`)] : []));
  }
}
