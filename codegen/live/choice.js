// Which signals are shown: boxes to tick, by groups.
import { $, make } from "./dom.js";

export class Choice {
  constructor(changed) {
    this.changed = changed;
    this.kept = new Map(); // what somebody has chosen stays when the page hears everything anew
  }

  // Groups are (title, strips, whether they are shown at first).
  offer(groups) {
    this.strips = groups.flatMap(([, strips]) => strips);
    $("choice").replaceChildren(...groups.filter(([, strips]) => strips.length).map(([title, strips, on]) => {
      const boxes = strips.map((strip) => this.box(title, strip, on));
      const all = (wish) => () => boxes.forEach(({ input }) => { if (input.checked !== wish) input.click(); });
      return make("fieldset", {}, make("legend", {}, title),
        make("button", { type: "button", onclick: all(true), "aria-label": `All: ${title}` }, "all"), make("button", { type: "button", onclick: all(false), "aria-label": `None: ${title}` }, "none"),
        ...boxes.map(({ label }) => label));
    }));
    this.tell();
  }

  box(title, strip, on) {
    const key = `${title} ${strip.name}`;
    strip.choose(this.kept.get(key) ?? on);
    const input = make("input", { type: "checkbox", name: "signal", checked: strip.chosen, onchange: () => {
      this.kept.set(key, input.checked);
      strip.choose(input.checked);
      this.tell();
    } });
    return { input, label: make("label", {}, input, strip.name) };
  }

  tell() {
    for (const strip of this.strips) strip.box.parentElement.hidden = true;
    for (const strip of this.strips) if (strip.chosen) strip.box.parentElement.hidden = false;
    $("chosen").textContent = `${this.strips.filter((s) => s.chosen).length} of ${this.strips.length}`;
    this.changed();
  }
}
