// Makes the bundles in ../../codegen, each with the licenses of all that is in it: an editor, and charts.
import { build } from "esbuild";
import { existsSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";

const to = (name) => new URL(`../../codegen/${name}`, import.meta.url).pathname;

async function bundled(entry, name) {
  const made = await build({
    entryPoints: [entry],
    bundle: true,
    format: "esm",
    target: "es2022",
    minify: true,
    legalComments: "none",
    metafile: true,
    outfile: to(`${name}.js`),
  });
  const packages = new Set();
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
  const file = name.split("/").at(-1);
  const what = existsSync(to(`${name}.css`)) ? `${file}.js and ${file}.css` : `${file}.js`;
  writeFileSync(to(`${name}.LICENSES.txt`), `What is in ${what}, and under which terms.\n\n${texts.join(`\n${"-".repeat(78)}\n\n`)}`);
}

writeFileSync(to("pages/uplot.css"), readFileSync("node_modules/uplot/dist/uPlot.min.css"));
await bundled("uplot.js", "pages/uplot");
await bundled("editor.js", "workbench/vendored");
