// Charts over time, by uPlot: axes with units, one cursor over all charts, lines with their names.
import { uPlot } from "./uplot.js";
import { colour, make, number } from "./dom.js";

export const FONT = '11px "Source Sans 3", "Segoe UI", "Helvetica Neue", "Liberation Sans", Arial, sans-serif';
export const KEY = "bondgraph"; // of charts that share a cursor

// A colour of the page, asked for once in a picture: light and dark may change between two.
const kept = new Map();
export function ink(name) {
  if (!kept.size) requestAnimationFrame(() => kept.clear());
  if (!kept.has(name)) kept.set(name, colour(name));
  return kept.get(name);
}

export const named = (unit) => (unit && unit !== "1" ? unit : "");
export const withUnit = (x, unit, digits) => `${number(x, digits)}${named(unit) ? ` ${unit}` : ""}`;

// As many digits as tell a tick from the next one, however far they are from zero.
function told(ticks, step) {
  const most = Math.max(...ticks.map(Math.abs), step);
  const digits = Math.min(12, 3 + Math.floor(Math.log10(most / step)));
  return ticks.map((x) => number(Math.abs(x) < step / 1e6 ? 0 : x, digits));
}

export function axes(unit) {
  const grid = { stroke: () => ink("line"), width: 1 };
  const own = { stroke: () => ink("faint"), font: FONT, ticks: { ...grid, size: 4 }, grid };
  const label = named(unit) ? { label: unit, labelFont: FONT, labelSize: 15, labelGap: 0 } : {};
  return [
    { ...own, size: 26, gap: 3, space: 70, values: (_, ticks, __, ___, step) => told(ticks, step).map((t) => `${t} s`) },
    { ...own, ...label, size: 54, gap: 4, space: 26, values: (_, ticks, __, ___, step) => told(ticks, step) },
  ];
}

// Ends of an axis that do not tremble with what is between them.
export function roomy(least, most) {
  if (least === null || most === null) return [-1, 1];
  const wide = Math.max(most - least, 1e-6 * Math.max(Math.abs(least), Math.abs(most))) || 1, step = nice(wide / 4);
  return [Math.floor((least - wide / 20) / step) * step, Math.ceil((most + wide / 20) / step) * step];
}

// The largest of 1, 2, 5 times a power of ten that is not above.
export const nice = (x) => { const p = 10 ** Math.floor(Math.log10(x)); return [1, 2, 5].map((m) => m * p).findLast((s) => s <= x) ?? p; };

// uPlot remembers where a chart is until the window scrolls; a page that moves it otherwise has to say so.
const here = (plot, _, does) => (event) => { plot.syncRect(); does(event); };

// A chart of some lines; all charts of a page share the cursor.
export function chart(into, { unit, scales = {}, cursor = {}, ...options }, data) {
  return new uPlot({
    ...options,
    axes: axes(unit),
    legend: { show: false },
    scales: { ...scales, x: { time: false, ...scales.x } },
    cursor: { y: false, sync: { key: KEY }, drag: { x: true, y: false }, points: { size: 6 }, ...cursor, bind: { mousemove: here, mouseenter: here, ...cursor.bind } },
  }, data, into);
}

export const line = (name, width, dash = []) => ({ stroke: () => ink(name), width, dash, spanGaps: false, points: { show: false } });

// A threshold, and the band between the first two series, if these are thresholds.
export const EDGE = line("faint", 1, [5, 4]);
export const BAND = { series: [1, 2], fill: () => ink("band") };

// How a line looks, beside its name.
export function swatch(name, dash = [], width = 2.5) {
  const made = make("i", { class: "swatch", "aria-hidden": "true" });
  made.style.borderTop = `${width}px ${!dash.length ? "solid" : dash[0] > 4 ? "dashed" : "dotted"} var(--${name})`;
  return made;
}
