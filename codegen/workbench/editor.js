// The text: CodeMirror with the words of the language, findings, and the lines of what is pointed at.
import * as cm from "./vendored.js";
import { $, make } from "./dom.js";

const nonce = document.querySelector("meta[name=nonce]").content;

const SEVERITY = [null, "error", "warning", "info", "hint"];

// Colours of elements are those of the drawing.
const looks = {};
for (const name of ["source", "inertia", "capacity", "resistor", "detector", "ink"]) looks[name] = cm.Tag.define();

function language(words) {
  const keywords = new Set([...words.keywords, "in", "out", "unknown", "counts", "when", "else", "from", "elsewhere"]), reserved = new Set(words.reserved);
  return cm.StreamLanguage.define({
    name: "bondgraph",
    startState: () => ({ value: false }),
    token(stream) {
      if (stream.sol() && stream.match(/^\s*##.*/)) return "docComment";
      if (stream.match(/^#.*/)) return "comment";
      if (stream.eatSpace()) return null;
      if (stream.match(/^"[^"\n]*"?/)) return "string";
      if (stream.match(/^(-\[[^\]\n]*\]->|<-\[[^\]\n]*\]-|->|<-)/)) return "arrow";
      if (stream.match(/^[01](?=:)/)) return "junction";
      if (stream.match(/^\d+(\.\d+)?([eE][+-]?\d+)?/)) return "number";
      const word = stream.match(/^[\p{L}_][\p{L}\p{N}_]*/u);
      if (word) {
        if (Object.hasOwn(words.kinds, word[0]) && stream.peek() === ":") return words.kinds[word[0]];
        if (keywords.has(word[0])) return "keyword";
        if (reserved.has(word[0])) return "operatorKeyword";
        return "variableName";
      }
      stream.next();
      return null;
    },
    tokenTable: { ...looks, arrow: cm.tags.operator, junction: cm.tags.strong },
    languageData: { commentTokens: { line: "#" }, closeBrackets: { brackets: ["(", "[", "{", '"'] }, indentOnInput: /^\s*\}$/ },
    indent: (state, after, context) => {
      const line = context.lineAt(context.pos, -1), before = context.state.doc.lineAt(Math.max(0, line.from - 1));
      const depth = /^\s*/.exec(before.text)[0].length + (/\{\s*(#.*)?$/.test(before.text) ? 4 : 0);
      return Math.max(0, depth - (/^\s*\}/.test(after) ? 4 : 0));
    },
  });
}

const highlight = cm.HighlightStyle.define([
  { tag: cm.tags.keyword, color: "var(--keyword)", fontWeight: "600" },
  { tag: cm.tags.operatorKeyword, color: "var(--keyword)" },
  { tag: cm.tags.comment, color: "var(--faint)", fontStyle: "italic" },
  { tag: cm.tags.docComment, color: "var(--faint)" },
  { tag: cm.tags.string, color: "var(--capacity)" },
  { tag: cm.tags.number, color: "var(--number)" },
  { tag: cm.tags.operator, color: "var(--faint)", fontWeight: "600" },
  { tag: cm.tags.strong, fontWeight: "700" },
  ...Object.entries(looks).map(([name, tag]) => ({ tag, color: `var(--${name})`, fontWeight: "700" })),
]);

// A block that begins at the end of a line can be folded.
const folds = cm.foldService.of((state, from, to) => {
  if (!/\{\s*(#.*)?$/.test(state.doc.sliceString(from, to))) return null;
  const own = /^\s*/.exec(state.doc.sliceString(from, to))[0].length;
  for (let k = state.doc.lineAt(from).number + 1; k <= state.doc.lines; k++) {
    const line = state.doc.line(k);
    if (line.text.trim() && /^\s*/.exec(line.text)[0].length <= own) return line.text.trim().startsWith("}") ? { from: to, to: line.from + own } : null;
  }
  return null;
});

// Lines of what is pointed at in the drawing or in a table.
const setLines = cm.StateEffect.define();
const lines = cm.StateField.define({
  create: () => cm.Decoration.none,
  update(found, transaction) {
    found = found.map(transaction.changes);
    for (const effect of transaction.effects) {
      if (effect.is(setLines)) found = cm.Decoration.set(effect.value.map((at) => cm.Decoration.line({ class: "cm-lit" }).range(at)));
    }
    return found;
  },
  provide: (field) => cm.EditorView.decorations.from(field),
});

export class Editor {
  // `typed` is told of every change, `moved` the line where the cursor is.
  constructor(words, typed, moved) {
    this.more = new cm.Compartment();
    this.view = new cm.EditorView({
      parent: $("editor"),
      state: cm.EditorState.create({
        doc: "",
        extensions: [
          cm.EditorView.cspNonce.of(nonce),
          cm.lintGutter(), cm.lineNumbers(), cm.foldGutter(), folds, cm.highlightSpecialChars(), cm.history(), cm.drawSelection(), cm.dropCursor(),
          cm.EditorState.allowMultipleSelections.of(true), cm.EditorState.tabSize.of(4), cm.indentUnit.of("    "),
          cm.indentOnInput(), cm.bracketMatching(), cm.closeBrackets(), cm.autocompletion({ selectOnOpen: false }), cm.rectangularSelection(), cm.crosshairCursor(),
          cm.highlightActiveLine(), cm.highlightActiveLineGutter(), cm.highlightSelectionMatches(),
          language(words), cm.syntaxHighlighting(highlight), lines,
          cm.keymap.of([{ key: "F8", run: cm.nextDiagnostic, shift: cm.previousDiagnostic }, ...cm.closeBracketsKeymap, ...cm.defaultKeymap, ...cm.searchKeymap, ...cm.historyKeymap, ...cm.foldKeymap, ...cm.completionKeymap, cm.indentWithTab]),
          cm.EditorView.contentAttributes.of({ "aria-label": "Text of the model", spellcheck: "false", autocapitalize: "off" }),
          cm.EditorView.updateListener.of((update) => {
            if (update.docChanged) typed(update.transactions.some((t) => t.isUserEvent("input") || t.isUserEvent("delete")));
            if (update.selectionSet || update.docChanged) moved(this.line());
          }),
          this.more.of([]),
        ],
      }),
    });
  }

  get text() { return this.view.state.doc.toString(); }

  line() { return this.view.state.doc.lineAt(this.view.state.selection.main.head).number; }

  // Another text: only what differs is replaced, so that cursor and history stay.
  replace(text) {
    const now = this.text;
    if (now === text) return;
    let from = 0, end = 0;
    const most = Math.min(now.length, text.length);
    while (from < most && now[from] === text[from]) from++;
    while (end < most - from && now[now.length - 1 - end] === text[text.length - 1 - end]) end++;
    this.view.dispatch({ changes: { from, to: now.length - end, insert: text.slice(from, text.length - end) } });
  }

  // Lines and columns count from 1, columns in characters; the editor counts in UTF-16.
  offset(line, column) {
    const doc = this.view.state.doc, at = doc.line(Math.min(Math.max(line, 1), doc.lines));
    let units = 0;
    for (const letter of at.text) {
      if (--column < 1) break;
      units += letter.length;
    }
    return at.from + units;
  }

  go(place) {
    const [line, column, endLine, endColumn] = place;
    this.select(this.offset(line, column), this.offset(endLine, endColumn));
  }

  select(from, to) {
    this.view.dispatch({ selection: { anchor: from, head: to }, effects: cm.EditorView.scrollIntoView(from, { y: "center" }) });
    this.view.focus();
  }

  light(numbers) {
    const doc = this.view.state.doc;
    const starts = [...new Set(numbers)].filter((n) => n >= 1 && n <= doc.lines).sort((a, b) => a - b).map((n) => doc.line(n).from);
    this.view.dispatch({ effects: setLines.of(starts) });
  }

  // What else belongs to the editor: the language server.
  plug(extension) { this.view.dispatch({ effects: this.more.reconfigure(extension) }); }

  // A position as editors tell it: lines from 0, characters in UTF-16.
  at({ line, character }) {
    const doc = this.view.state.doc, found = doc.line(Math.min(line + 1, doc.lines));
    return Math.min(found.from + character, found.to);
  }

  // Where the cursor is, in the same way.
  position() {
    const { head } = this.view.state.selection.main, line = this.view.state.doc.lineAt(head);
    return { line: line.number - 1, character: head - line.from };
  }

  // Changes of the text, as editors tell them.
  put(edits) {
    this.view.dispatch({ changes: edits.map((e) => ({ from: this.at(e.range.start), to: this.at(e.range.end), insert: e.newText })), userEvent: "input" });
  }

  // Findings as `check` has them: marked in the text, and listed below it.
  tell(diagnostics, uri) {
    const marks = [];
    for (const d of diagnostics) {
      const [message, ...help] = d.message.split("\n"), code = make("p", { class: "code" }, String(d.code ?? ""));
      const mark = (range, severity, markClass, text, ...more) => marks.push({ from: this.at(range.start), to: this.at(range.end), severity, markClass, message: text, renderMessage: () => make("div", { class: "finding" }, make("p", {}, text), ...more, code.cloneNode(true)) });
      mark(d.range, SEVERITY[d.severity], "", message, help.length ? make("p", { class: "help" }, help.join("\n")) : null);
      for (const also of d.relatedInformation || []) if (also.location.uri === uri) mark(also.location.range, "hint", "cm-also", also.message === "here" ? message : also.message);
    }
    marks.sort((a, b) => a.from - b.from || a.to - b.to);
    this.view.dispatch(cm.setDiagnostics(this.view.state, marks));
    this.list(diagnostics);
  }

  // Remedies of the k-th finding that are changes of the text: a button each.
  offer(k, remedies) {
    const item = $("problems").querySelectorAll("li")[k];
    if (!item) return;
    item.append(make("p", { class: "remedies" }, ...remedies.map(([title, edits]) => make("button", { type: "button", class: "chip", onclick: () => {
      this.put(edits);
      this.view.focus();
    } }, title))));
  }

  list(diagnostics) {
    const count = (severity) => diagnostics.filter((d) => SEVERITY[d.severity] === severity).length;
    const words = [["error", "error"], ["warning", "warning"], ["info", "note"]].map(([s, w]) => [count(s), w]).filter(([n]) => n).map(([n, w]) => `${n} ${w}${n > 1 ? "s" : ""}`);
    const box = $("problems");
    box.dataset.worst = count("error") ? "error" : count("warning") ? "warning" : words.length ? "info" : "none";
    box.querySelector(".sum").textContent = words.length ? words.join(", ") : "no findings";
    box.querySelector("ul").replaceChildren(...diagnostics.map((d) => {
      const [message, ...help] = d.message.split("\n");
      const go = () => { this.select(this.at(d.range.start), this.at(d.range.end)); };
      return make("li", {}, make("button", { type: "button", class: `plain ${SEVERITY[d.severity]}`, onclick: go },
        make("span", { class: "where" }, `line ${d.range.start.line + 1}`), make("span", { class: "what" }, message), help.length ? make("span", { class: "help" }, help.join("\n")) : null));
    }));
  }
}
