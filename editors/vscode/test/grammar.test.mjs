import assert from "node:assert/strict";
import { test } from "node:test";

import { tokens } from "./tokens.mjs";

/** The words of a line that have a scope that begins so. */
async function words(line, scope) {
  const found = await tokens(line);
  return found.filter((t) => t.scope.startsWith(scope)).map((t) => t.text);
}

test("a parameter: keyword, name, number, unit, tolerance", async () => {
  const line = "param k = 3.51e-3 N.m/A +- 2%  # of the motor";
  assert.deepEqual(await words(line, "keyword.declaration"), ["param"]);
  assert.deepEqual(await words(line, "constant.numeric"), ["3.51e-3", "2"]);
  assert.deepEqual(await words(line, "support.type.unit"), ["N.m/A"]);
  assert.deepEqual(await words(line, "keyword.operator.tolerance"), ["+-", "%"]);
  assert.deepEqual(await words(line, "comment"), ["# of the motor"]);
});

test("a chain: types, names, numbered arrows, a law", async () => {
  const line = "Se:U0 -[14]-> TF:N { f1 = N*f2 } <- 1:hub; hub -> R:b = 2*a";
  assert.deepEqual(await words(line, "entity.name.type"), ["Se", "TF", "1", "R"]);
  assert.deepEqual(await words(line, "keyword.operator.arrow"), ["-[14]->", "<-", "->"]);
});

test("keywords are names where they stand as names", async () => {
  assert.deepEqual(await words("let in = 3*port", "keyword"), ["let", "=", "*"]);
  assert.deepEqual(await words("port out : out electrical", "keyword.declaration"), ["port", "out"]);
  assert.deepEqual(await words("1:port { -> R:for = 1 }", "keyword.declaration"), []);
});

test("a unit follows after one space, and words are no units", async () => {
  assert.deepEqual(await words("x = if(a > 3 and b, 1 V, 2)", "support.type.unit"), ["V"]);
  assert.deepEqual(await words("sensor p : rad = int(r.f) counts 24/turn", "support.type.unit"), ["rad"]);
  assert.deepEqual(await words("input d : m/s unknown", "support.type.unit"), ["m/s"]);
  assert.deepEqual(await words("input on : bool", "keyword.declaration"), ["input", "bool"]);
});

test("a fence in Markdown", async () => {
  const text = "Text\n```bg\nbg 1\nparam R = 2 Ohm\n```\nparam R = 2 Ohm";
  const found = await tokens(text, "markdown.bondgraph.codeblock");
  const units = found.filter((t) => t.scope.startsWith("support.type.unit"));
  assert.deepEqual(units.map((t) => t.line), [3]);
});
