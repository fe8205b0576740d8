// The words of files as VS Code's own engine (vscode-textmate, Oniguruma) colours them.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

const require = createRequire(import.meta.url);
const textmate = require("vscode-textmate");
const oniguruma = require("vscode-oniguruma");
const wasm = readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
await oniguruma.loadWASM(wasm.buffer.slice(wasm.byteOffset, wasm.byteOffset + wasm.byteLength));

const file = (name) => fileURLToPath(new URL(`../syntaxes/${name}`, import.meta.url));
const GRAMMARS = {
  "source.bondgraph": file("bondgraph.tmLanguage.json"),
  "markdown.bondgraph.codeblock": file("markdown.tmLanguage.json"),
};
const registry = new textmate.Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  }),
  loadGrammar: async (scope) =>
    GRAMMARS[scope]
      ? textmate.parseRawGrammar(readFileSync(GRAMMARS[scope], "utf8"), GRAMMARS[scope])
      : null,
});

/** Every word that has a scope, in order: its line, its column, its text, its innermost scope. */
export async function tokens(text, scope = "source.bondgraph") {
  const grammar = await registry.loadGrammar(scope);
  const found = [];
  let stack = textmate.INITIAL;
  for (const [number, line] of text.split("\n").entries()) {
    const result = grammar.tokenizeLine(line, stack);
    stack = result.ruleStack;
    for (const token of result.tokens) {
      const piece = line.slice(token.startIndex, token.endIndex);
      const inner = token.scopes.at(-1);
      if (piece.trim() && token.scopes.length > 1) {
        const start = token.startIndex + piece.length - piece.trimStart().length;
        found.push({ line: number, column: start, text: piece.trim(), scope: inner });
      }
    }
  }
  return found;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const every = {};
  for (const path of process.argv.slice(2)) {
    every[path] = await tokens(readFileSync(path, "utf8"));
  }
  process.stdout.write(JSON.stringify(every));
}
