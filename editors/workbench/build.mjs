// Makes ../../codegen/workbench/vendored.{js,css} and the licenses of all that is in them.
import { build } from "esbuild";
import { existsSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";

const to = (name) => new URL(`../../codegen/workbench/${name}`, import.meta.url).pathname;
const made = await build({
  entryPoints: ["entry.js"],
  bundle: true,
  format: "esm",
  target: "es2022",
  minify: true,
  legalComments: "none",
  metafile: true,
  outfile: to("vendored.js"),
});
writeFileSync(to("vendored.css"), readFileSync("node_modules/uplot/dist/uPlot.min.css"));

const packages = new Set(["node_modules/uplot"]);
for (const file of Object.keys(made.metafile.inputs)) {
  let folder = dirname(file);
  while (folder.startsWith("node_modules/") && !existsSync(join(folder, "LICENSE")) && !existsSync(join(folder, "package.json"))) folder = dirname(folder);
  while (folder.startsWith("node_modules/") && !JSON.parse(readFileSync(join(folder, "package.json"), "utf8")).version) folder = dirname(folder);
  if (folder.startsWith("node_modules/")) packages.add(folder);
}
const texts = [...packages].sort().map((folder) => {
  const { name, version, license } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
  const file = readdirSync(folder).find((f) => /^licen[cs]e(\.md|\.txt)?$/i.test(f));
  return `${name} ${version} (${license})\n\n${file ? readFileSync(join(folder, file), "utf8").replace(/\r\n/g, "\n").trim() : ""}\n`;
});
writeFileSync(to("vendored.LICENSES.txt"), `What is in vendored.js and vendored.css, and under which terms.\n\n${texts.join(`\n${"-".repeat(78)}\n\n`)}`);
