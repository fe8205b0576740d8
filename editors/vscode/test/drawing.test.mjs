import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { test } from "node:test";

const { Drawing, page } = createRequire(import.meta.url)("../src/drawing.js");

/** As much of VS Code as the drawing asks for. */
function editor() {
  const panel = { webview: { html: "" }, onDidDispose: (f) => (panel.close = f), dispose: () => panel.close() };
  return {
    panel,
    ViewColumn: { Beside: -2 },
    window: { createWebviewPanel: () => panel },
    workspace: { getConfiguration: () => ({ get: () => 0 }) },
  };
}
const document = { languageId: "bondgraph", uri: { path: "/a/m.bg", toString: () => "file:///a/m.bg" } };

test("the last picture stays over a mistake", async () => {
  const vscode = editor();
  const answers = [{ svg: "<svg>one</svg>" }, null, { problem: "no" }, { svg: "<svg>two</svg>" }];
  const drawing = new Drawing(vscode, async () => answers.shift());
  await drawing.show(document);
  assert.match(vscode.panel.webview.html, /one/);
  await drawing.draw();
  await drawing.draw();
  assert.match(vscode.panel.webview.html, /one/);
  await drawing.draw();
  assert.match(vscode.panel.webview.html, /two/);
});

test("an answer that comes late is not shown over a newer one", async () => {
  const vscode = editor();
  let late;
  const answers = [new Promise((f) => (late = f)), Promise.resolve({ svg: "<svg>new</svg>" })];
  const drawing = new Drawing(vscode, () => answers.shift());
  const first = drawing.show(document);
  await drawing.draw();
  late({ svg: "<svg>old</svg>" });
  await first;
  assert.match(vscode.panel.webview.html, /new/);
});

test("nothing is drawn into a panel that is closed", async () => {
  const vscode = editor();
  const drawing = new Drawing(vscode, async () => ({ svg: "<svg/>" }));
  await drawing.show(document);
  vscode.panel.webview.html = "";
  drawing.dispose();
  drawing.changed(document);
  await new Promise((f) => setTimeout(f, 5));
  assert.equal(vscode.panel.webview.html, "");
});

test("the page runs nothing", () => {
  assert.match(page("<svg/>"), /default-src 'none'/);
  assert.doesNotMatch(page("<svg/>"), /script/);
});
