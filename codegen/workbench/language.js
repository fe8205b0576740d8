// The language server behind the editor: findings, completions, names, what stands under the pointer.
import * as cm from "./vendored.js";
import { $ } from "./dom.js";

const FIXED = 20; // findings whose remedies are asked for
const PLAIN = new Set(["P", "CODE", "PRE", "EM", "STRONG", "UL", "OL", "LI", "BR", "HR", "H1", "H2", "H3", "H4", "SPAN", "TABLE", "THEAD", "TBODY", "TR", "TH", "TD", "BLOCKQUOTE"]);

// Markup of a comment of the model: only what sets text, without any attribute; the rest is text.
function plain(html) {
  return html.replace(/<(\/?)([a-z][a-z0-9]*)?[^<>]*>?/gi, (tag, end, name) => (name && tag.endsWith(">") && PLAIN.has(name.toUpperCase()) ? `<${end}${name}>` : tag.replaceAll("<", "&lt;")));
}

export class LanguageServer {
  // `tell` gets the findings of the newest text, `refuse` why a name cannot be another one.
  constructor(editor, uri, tell, refuse) {
    Object.assign(this, { editor, uri, tell, refuse, client: null, tries: 0 });
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
        extensions: [cm.serverCompletion(), cm.hoverTooltips({ hoverTime: 350 }), cm.signatureHelp(), cm.keymap.of([...cm.jumpToDefinitionKeymap, ...cm.findReferencesKeymap, { key: "F2", preventDefault: true, run: () => { this.rename(); return true; } }]),
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

  // Asks for another name of what stands at the cursor, and puts it at all its places.
  async rename() {
    const { client, editor, uri } = this, textDocument = { uri }, position = editor.position();
    client.sync();
    const range = await client.request("textDocument/prepareRename", { textDocument, position }).catch(() => null);
    if (!range) { this.refuse("Nothing that has a name stands at the cursor."); return; }
    const input = $("rename").querySelector("input"), old = editor.view.state.sliceDoc(editor.at(range.start), editor.at(range.end));
    input.value = old;
    $("rename").returnValue = "";
    $("rename").onclose = async () => {
      editor.view.focus();
      const newName = input.value.trim();
      if ($("rename").returnValue !== "ok" || newName === old) return;
      client.sync();
      try {
        const { changes = {} } = (await client.request("textDocument/rename", { textDocument, position, newName })) || {};
        const others = Object.keys(changes).filter((other) => other !== uri).map((other) => decodeURIComponent(other.split("/").at(-1)));
        if (others.length) this.refuse(`Not renamed: ${old} stands in ${others.join(", ")} as well, which this page does not write.`);
        else editor.put(changes[uri] || []);
      } catch (error) { this.refuse(`Not renamed: ${error.message}`); }
    };
    $("rename").showModal();
    input.select();
  }

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
