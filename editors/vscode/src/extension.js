// The client of the language server, and the drawing beside the text.

"use strict";

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");
const { Drawing } = require("./drawing");

let client;
let drawing;

/** Start the server that the settings name; where there is none, say how to get one. */
async function start() {
  const [command, ...args] = vscode.workspace.getConfiguration("bondgraph").get("command");
  client = new LanguageClient(
    "bondgraph",
    "Bond graph",
    { command, args },
    { documentSelector: [{ language: "bondgraph" }] },
  );
  try {
    await client.start();
  } catch (error) {
    const text = `The language server \`${[command, ...args].join(" ")}\` does not start: ${error.message ?? error}. Install it with pip install 'bondgraph-arr[editor]', or name it in the settings.`;
    const choice = await vscode.window.showErrorMessage(text, "Settings");
    if (choice) {
      vscode.commands.executeCommand("workbench.action.openSettings", "bondgraph.command");
    }
  }
}

async function stop() {
  const old = client;
  client = undefined;
  if (old && old.needsStop()) {
    await old.stop();
  }
}

async function activate(context) {
  drawing = new Drawing(vscode, (method, params) =>
    client && client.isRunning() ? client.sendRequest(method, params) : null,
  );
  context.subscriptions.push(
    drawing,
    vscode.commands.registerCommand("bondgraph.showDrawing", () =>
      drawing.show(vscode.window.activeTextEditor?.document),
    ),
    vscode.commands.registerCommand("bondgraph.restart", async () => {
      await stop();
      await start();
    }),
    vscode.workspace.onDidChangeTextDocument((event) => drawing.changed(event.document)),
    vscode.window.onDidChangeActiveTextEditor((editor) => drawing.follow(editor?.document)),
    vscode.workspace.onDidChangeConfiguration(async (event) => {
      if (event.affectsConfiguration("bondgraph.command")) {
        await stop();
        await start();
      }
    }),
  );
  await start();
}

async function deactivate() {
  await stop();
}

module.exports = { activate, deactivate };
