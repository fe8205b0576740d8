// The server, asked by the library of which VS Code's client is made.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { createRequire } from "node:module";
import { test } from "node:test";

const { createProtocolConnection, StreamMessageReader, StreamMessageWriter } = createRequire(
  import.meta.url,
)("vscode-languageserver-protocol/node");

const command = JSON.parse(process.env.BONDGRAPH_COMMAND ?? "null");
const TEXT = "bg 1\nmodel M {\n    param R = 2 Ohm\n    1:j { <- Se:U; -> R:R; -> Df:i }\n}\n";

test("hover, a finding with its fix, and a drawing", { skip: !command && "no server is named" }, async () => {
  const server = spawn(command[0], command.slice(1));
  const connection = createProtocolConnection(
    new StreamMessageReader(server.stdout),
    new StreamMessageWriter(server.stdin),
  );
  let published = () => {};
  connection.onNotification("textDocument/publishDiagnostics", (params) => published(params));
  connection.listen();
  try {
    const hello = { processId: process.pid, rootUri: null, capabilities: {} };
    const { capabilities } = await connection.sendRequest("initialize", hello);
    for (const provider of ["hover", "definition", "references", "rename", "completion", "documentFormatting",
      "documentSymbol", "semanticTokens", "inlayHint", "codeLens", "codeAction"]) {
      assert.ok(capabilities[`${provider}Provider`], provider);
    }
    await connection.sendNotification("initialized", {});
    const uri = "untitled:Untitled-1";
    const opened = new Promise((resolve) => (published = resolve));
    await connection.sendNotification("textDocument/didOpen", {
      textDocument: { uri, languageId: "bondgraph", version: 1, text: TEXT },
    });
    assert.deepEqual((await opened).diagnostics, []);
    const textDocument = { uri };
    const hover = await connection.sendRequest("textDocument/hover", {
      textDocument, position: { line: 2, character: 10 },
    });
    assert.match(hover.contents.value, /unit `Ohm`/);
    const drawing = await connection.sendRequest("bondgraph/drawing", { uri });
    assert.match(drawing.svg, /^<svg/);
    const changed = new Promise((resolve) => (published = resolve));
    await connection.sendNotification("textDocument/didChange", {
      textDocument: { uri, version: 2 }, contentChanges: [{ text: TEXT.replace("param", "parm") }],
    });
    const [found] = (await changed).diagnostics;
    assert.equal(found.code, "unknown-statement");
    const [action] = await connection.sendRequest("textDocument/codeAction", {
      textDocument, range: found.range, context: { diagnostics: [found] },
    });
    assert.equal(action.edit.changes[uri][0].newText, "param");
    assert.equal(await connection.sendRequest("bondgraph/drawing", { uri }).then((d) => d.svg), null);
    await connection.sendRequest("shutdown");
    await connection.sendNotification("exit");
  } finally {
    connection.dispose();
    server.kill();
  }
});
