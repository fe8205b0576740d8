// The signals that are shown, in the time that is shown, as a table of a file.
import { make } from "./dom.js";

const cell = (text) => (/[",\r\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);

export function csv(record, [from, to], columns) {
  const lines = [["t [s]", ...columns.map(([name]) => name)].map(cell).join(",")];
  for (let k = record.at(from); k < record.t.length && record.t[k] <= to; k++) lines.push([record.t[k], ...columns.map(([, column]) => column[k] ?? "")].join(","));
  return `${lines.join("\n")}\n`;
}

export function saved(name, text) {
  const address = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  make("a", { href: address, download: name.replace(/[^\w.-]+/g, "_") }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1e4);
}
