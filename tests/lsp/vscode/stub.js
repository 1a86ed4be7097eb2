'use strict';
// As much of the module `vscode` as the extension calls, without a window: what it registers can be asked.
const path = require('path');

class Position {
  constructor(line, character) { this.line = line; this.character = character; }
}
class Range {
  constructor(startLine, startCharacter, endLine, endCharacter) {
    this.start = new Position(startLine, startCharacter);
    this.end = new Position(endLine, endCharacter);
  }
  isEqual(other) { return JSON.stringify(this) === JSON.stringify(other); }
}
class Uri {
  constructor(url) { this.url = new URL(url); this.scheme = this.url.protocol.slice(0, -1); }
  static parse(text) { return new Uri(text); }
  get fsPath() { return decodeURIComponent(this.url.pathname); }
  toString() { return this.url.href; }
}
class Holder { constructor(...values) { this.values = values; } }
class Location { constructor(uri, range) { this.uri = uri.toString(); this.range = range; } }
class TextEdit { constructor(range, newText) { this.range = range; this.newText = newText; } }
class MarkdownString { constructor(value) { this.value = value; } }
class Hover { constructor(contents, range) { this.contents = contents; this.range = range; } }
class CompletionItem { constructor(label, kind) { this.label = label; this.kind = kind; } }
class CodeAction { constructor(title, kind) { this.title = title; this.kind = kind; } }
class Diagnostic {
  constructor(range, message, severity) { this.range = range; this.message = message; this.severity = severity; }
}
class DocumentSymbol {
  constructor(name, detail, kind, range, selectionRange) { Object.assign(this, { name, detail, kind, range, selectionRange }); }
}
class WorkspaceEdit {
  constructor() { this.edits = []; }
  replace(uri, range, newText, note) { this.edits.push({ uri: uri.toString(), range, newText, note }); }
}

const settings = { 'cellc.command': JSON.parse(process.env.CELLC_COMMAND) };
const registered = {};
const heard = {};
const found = {};
const messages = [];
const disposable = { dispose() {} };
const keep = (name) => (selector, provider, ...more) => { registered[name] = { selector, provider, more }; return disposable; };
const hear = (name) => (listener) => { heard[name] = listener; return disposable; };

const vscode = {
  Position, Range, Uri, Location, TextEdit, MarkdownString, Hover, CompletionItem, CodeAction, Diagnostic,
  DocumentSymbol, WorkspaceEdit, DiagnosticRelatedInformation: Holder,
  CodeActionKind: { QuickFix: 'quickfix' },
  workspace: {
    workspaceFolders: [{ uri: Uri.parse(`file://${process.env.CELLC_FOLDER}`) }],
    textDocuments: [],
    getConfiguration: (section) => ({ get: (key) => settings[`${section}.${key}`] }),
    onDidOpenTextDocument: hear('open'),
    onDidChangeTextDocument: hear('change'),
    onDidSaveTextDocument: hear('save'),
    onDidCloseTextDocument: hear('close'),
  },
  window: {
    createOutputChannel: () => ({ append: (text) => messages.push(text), appendLine: (text) => messages.push(text), ...disposable }),
    showErrorMessage: (text, ...buttons) => { messages.push(text); return Promise.resolve(buttons.find((one) => one === settings.press)); },
    showInformationMessage: (text) => { messages.push(text); return Promise.resolve(); },
  },
  commands: { registerCommand: (name, run) => { registered[name] = run; return disposable; } },
  languages: {
    createDiagnosticCollection: () => ({
      set: (uri, list) => { found[uri.toString()] = list; if (heard.found) heard.found(uri.toString()); },
      clear: () => Object.keys(found).forEach((key) => delete found[key]),
      ...disposable,
    }),
    registerHoverProvider: keep('hover'),
    registerCompletionItemProvider: keep('completion'),
    registerDefinitionProvider: keep('definition'),
    registerReferenceProvider: keep('references'),
    registerRenameProvider: keep('rename'),
    registerCodeActionsProvider: keep('actions'),
    registerDocumentSymbolProvider: keep('symbols'),
    registerDocumentFormattingEditProvider: keep('formatting'),
  },
};

/** A document of the editor: what is typed goes to whom it concerns. */
class TextDocument {
  constructor(file, text) {
    this.uri = Uri.parse(`file://${path.resolve(file)}`);
    this.languageId = 'yaml';
    this.version = 1;
    this.text = text;
    vscode.workspace.textDocuments.push(this);
  }
  getText() { return this.text; }
  change(text) {
    this.text = text;
    this.version += 1;
    heard.change({ document: this });
  }
  /** The place between two texts. */
  at(before, after = '') {
    const index = this.text.indexOf(before + after);
    if (index < 0) throw new Error(`there is no ${before}${after}`);
    const lines = this.text.slice(0, index + before.length).split('\n');
    return new Position(lines.length - 1, lines[lines.length - 1].length);
  }
}

module.exports = { vscode, registered, heard, found, messages, settings, TextDocument };
