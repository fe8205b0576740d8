// The bond graph of the text beside it, drawn anew as one types; the last one stays over mistakes.

"use strict";

class Drawing {
  /** `ask(method, params)` sends a request to the server and gives its answer, or null. */
  constructor(vscode, ask) {
    this.vscode = vscode;
    this.ask = ask;
    this.panel = undefined;
    this.document = undefined;
    this.timer = undefined;
    this.asked = 0;
  }

  async show(document) {
    if (!this.panel) {
      const { window, ViewColumn } = this.vscode;
      const column = { viewColumn: ViewColumn.Beside, preserveFocus: true };
      this.panel = window.createWebviewPanel("bondgraph.drawing", "Drawing", column, {
        enableScripts: false,
      });
      this.panel.onDidDispose(() => {
        this.panel = undefined;
      });
    }
    await this.follow(document);
  }

  async follow(document) {
    if (document?.languageId === "bondgraph" && this.panel) {
      this.document = document;
      this.panel.title = `Drawing of ${document.uri.path.split("/").pop()}`;
      await this.draw();
    }
  }

  changed(document) {
    if (this.panel && document === this.document) {
      clearTimeout(this.timer);
      const delay = this.vscode.workspace.getConfiguration("bondgraph").get("drawing.delay");
      this.timer = setTimeout(() => this.draw(), delay);
    }
  }

  async draw() {
    const own = ++this.asked;
    const uri = this.document.uri.toString();
    const answer = await this.ask("bondgraph/drawing", { uri });
    if (answer?.svg && this.panel && own === this.asked) {
      this.panel.webview.html = page(answer.svg);
    }
  }

  dispose() {
    clearTimeout(this.timer);
    this.panel?.dispose();
  }
}

/** A page that holds a picture and runs nothing. */
function page(svg) {
  return `<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:;">
<style>body { margin: 0; background: #fff; } svg { width: 100%; height: auto; max-height: 100vh; }</style>
</head><body>${svg}</body></html>`;
}

module.exports = { Drawing, page };
