// The language server behind the editor: findings, completions, what stands under the pointer.
import * as cm from "./vendored.js";

const FIXED = 20; // findings whose remedies are asked for
const PLAIN = new Set(["P", "CODE", "PRE", "EM", "STRONG", "UL", "OL", "LI", "BR", "HR", "H1", "H2", "H3", "H4", "SPAN", "TABLE", "THEAD", "TBODY", "TR", "TH", "TD", "BLOCKQUOTE"]);

// Markup of a comment of the model: only what sets text, without any attribute; the rest is text.
function plain(html) {
  return html.replace(/<(\/?)([a-z][a-z0-9]*)?[^<>]*>?/gi, (tag, end, name) => (name && tag.endsWith(">") && PLAIN.has(name.toUpperCase()) ? `<${end}${name}>` : tag.replaceAll("<", "&lt;")));
}

export class LanguageServer {
  // `tell` gets the findings of the newest text.
  constructor(editor, uri, tell) {
    Object.assign(this, { editor, uri, tell, client: null, tries: 0 });
    this.connect();
  }

  connect() {
    const address = new URL("lsp", location.href);
    address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(address), heard = new Set();
    socket.onmessage = (event) => heard.forEach((f) => f(event.data));
    socket.onopen = () => {
      this.tries = 0;
      this.client = new cm.LSPClient({
        timeout: 15000,
        sanitizeHTML: plain,
        notificationHandlers: { "textDocument/publishDiagnostics": (client, found) => this.found(client, found) },
        extensions: [cm.serverCompletion(), cm.hoverTooltips({ hoverTime: 350 }), cm.signatureHelp(), cm.keymap.of([...cm.jumpToDefinitionKeymap, ...cm.findReferencesKeymap]),
          { clientCapabilities: { textDocument: { publishDiagnostics: { versionSupport: true, relatedInformation: true } } } }],
      });
      this.client.connect({ send: (text) => socket.send(text), subscribe: (f) => heard.add(f), unsubscribe: (f) => heard.delete(f) });
      this.editor.plug(this.client.plugin(this.uri, "bondgraph"));
    };
    socket.onclose = () => {
      this.editor.plug([]);
      this.client = null;
      setTimeout(() => this.connect(), Math.min(10000, 500 * 2 ** this.tries++));
    };
  }

  // What was typed goes there at once, not after a while.
  sync() { this.client?.sync(); }

  found(client, { uri, version, diagnostics }) {
    const file = client.workspace.getFile(uri);
    if (!file || (version !== undefined && version !== null && version !== file.version)) return true;
    this.tell(diagnostics, uri);
    const shown = this.shown = {};
    for (const [k, d] of diagnostics.slice(0, FIXED).entries()) {
      client.request("textDocument/codeAction", { textDocument: { uri }, range: d.range, context: { diagnostics: [d] } }).then((actions) => {
        const own = (actions || []).filter((a) => a.edit && Object.keys(a.edit.changes || {}).join() === uri && (a.diagnostics || [d]).some((o) => o.message === d.message));
        if (this.shown === shown && own.length) this.editor.offer(k, own.map((a) => [a.title, a.edit.changes[uri]]));
      }, () => {});
    }
    return true;
  }
}
