// The bond graph with the elements that are suspected: framed, coloured, and with their probability.
import { percent } from "./dom.js";

const SVG = "http://www.w3.org/2000/svg";
const apart = (a, b) => a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y;

export class Graph {
  constructor(svg, words) {
    this.svg = svg;
    if (svg) svg.style.minWidth = `${Math.min(svg.width.baseVal.value, 704)}px`; // then it scrolls
    this.words = words;
    this.links = {};
    this.made = [];
    this.key = "";
  }

  // `found` maps faults to probabilities.
  show(found, whose) {
    const nodes = [];
    for (const [node, faults] of Object.entries(this.links)) {
      const chance = faults.reduce((sum, f) => sum + (found.get(f) || 0), 0);
      if (chance > 0) nodes.push([node, Math.min(1, chance), faults.filter((f) => found.has(f))]);
    }
    nodes.sort((a, b) => b[1] - a[1]);
    const key = JSON.stringify([whose, nodes, [...found.keys()]]);
    if (key === this.key) return;
    this.key = key;
    this.made.forEach((e) => e.remove());
    this.made = [];
    this.svg?.querySelectorAll(".suspected").forEach((e) => e.classList.remove("suspected"));
    const drawn = nodes.filter(([node, chance, faults]) => this.mark(node, chance, faults));
    const list = drawn.map(([node, chance]) => `${node} ${percent(chance)}`).join(", ");
    const rest = [...found.keys()].filter((f) => !drawn.some((n) => n[2].includes(f)));
    this.words.textContent = found.size ? `Suspected in the ${whose} one: ${[list, rest.length ? `not in the picture: ${rest.join(", ")}` : ""].filter(Boolean).join("; ")}.` : `No element of the ${whose} one is suspected.`;
  }

  mark(node, chance, faults) {
    const label = [...(this.svg?.querySelectorAll("[data-node]") || [])].find((e) => e.dataset.node === node);
    if (!label) return false;
    const box = label.getBBox();
    const frame = document.createElementNS(SVG, "rect");
    frame.setAttribute("class", "suspect");
    for (const [name, value] of [["x", box.x - 5], ["y", box.y - 2], ["width", box.width + 10], ["height", box.height + 4], ["rx", 5]]) frame.setAttribute(name, value);
    frame.style.fillOpacity = String(0.35 + 0.65 * chance);
    label.before(frame);
    const text = document.createElementNS(SVG, "text");
    text.setAttribute("class", "chance");
    text.textContent = percent(chance);
    const hint = document.createElementNS(SVG, "title");
    hint.textContent = `${node}: ${faults.join(", ")}`;
    text.append(hint);
    label.after(text);
    this.place(text, box, label);
    this.made.push(frame, text);
    label.querySelectorAll("tspan").forEach((t) => t.classList.add("suspected"));
    return true;
  }

  // Beside the label where no other text is.
  place(text, box, label) {
    const others = [...this.svg.querySelectorAll("text")].filter((e) => e !== text && e !== label).map((e) => e.getBBox());
    const middle = box.x + box.width / 2, own = text.getBBox();
    const spots = [[middle, box.y - 5], [middle, box.y + box.height + 13], [box.x + box.width + own.width / 2 + 9, box.y + box.height / 2 + 4], [box.x - own.width / 2 - 9, box.y + box.height / 2 + 4], [middle, box.y - 18], [middle, box.y + box.height + 26]];
    for (const [x, y] of spots) {
      text.setAttribute("x", x);
      text.setAttribute("y", y);
      const mine = text.getBBox(), view = this.svg.viewBox.baseVal;
      const inside = mine.x > 0 && mine.x + mine.width < view.width && mine.y > -view.y && mine.y + mine.height < view.height;
      if (inside && others.every((o) => apart(mine, o))) return;
    }
    text.setAttribute("x", spots[0][0]);
    text.setAttribute("y", spots[0][1]);
  }
}
