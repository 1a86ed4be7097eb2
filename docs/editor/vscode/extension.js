'use strict';
// The editor's side of `cellc lsp`: it starts the server and hands on what it says. It needs no other package.
const { spawn } = require('child_process');
const vscode = require('vscode');

const SELECTOR = [{ language: 'yaml', scheme: 'file' }];
const SILENT = { 'window/logMessage': true, '$/progress': true, 'telemetry/event': true };
const CAPABILITIES = {
  general: { positionEncodings: ['utf-16'] },
  workspace: {
    workspaceEdit: { documentChanges: true, changeAnnotationSupport: { groupsOnLabel: true } },
  },
  textDocument: {
    synchronization: { didSave: true },
    publishDiagnostics: { relatedInformation: true, versionSupport: false },
    hover: { contentFormat: ['markdown'] },
    completion: { completionItem: { documentationFormat: ['markdown'] } },
    definition: {},
    references: {},
    documentSymbol: { hierarchicalDocumentSymbolSupport: true },
    codeAction: { isPreferredSupport: true, codeActionLiteralSupport: { codeActionKind: { valueSet: ['quickfix'] } } },
    formatting: {},
    rename: { prepareSupport: true, honorsChangeAnnotations: true },
  },
};

/** Requests, answers and notifications over the pipes of a process: JSON-RPC 2.0 with the header of LSP 3.17. */
class Connection {
  constructor(child, receive) {
    this.child = child;
    this.receive = receive;
    this.waiting = new Map();
    this.number = 0;
    this.received = Buffer.alloc(0);
    child.stdout.on('data', (data) => this.take(data));
    child.stdin.on('error', () => this.end('the server takes no more'));
  }

  take(data) {
    this.received = Buffer.concat([this.received, data]);
    for (;;) {
      const end = this.received.indexOf('\r\n\r\n');
      if (end < 0) return;
      const length = /content-length: *(\d+)/i.exec(this.received.toString('ascii', 0, end));
      const start = end + 4;
      const stop = start + Number(length ? length[1] : 0);
      if (this.received.length < stop) return;
      const text = this.received.toString('utf8', start, stop);
      this.received = this.received.subarray(stop);
      if (text) this.handle(JSON.parse(text));
    }
  }

  handle(message) {
    if (message.method && message.id !== undefined) {
      // The server asks: nothing that it needs is there.
      this.send({ id: message.id, error: { code: -32601, message: `${message.method} is not offered` } });
    } else if (message.method) {
      this.receive(message.method, message.params);
    } else if (this.waiting.has(message.id)) {
      const { resolve, reject } = this.waiting.get(message.id);
      this.waiting.delete(message.id);
      if (message.error) reject(new Error(message.error.message));
      else resolve(message.result);
    }
  }

  request(method, params, token) {
    const id = ++this.number;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      this.send({ id, method, params });
      if (token) {
        token.onCancellationRequested(() => {
          if (!this.waiting.delete(id)) return;
          this.notify('$/cancelRequest', { id });
          resolve(null);
        });
      }
    });
  }

  notify(method, params) {
    this.send({ method, params });
  }

  send(message) {
    if (!this.child.stdin.writable) return this.end('the server has ended');
    const body = Buffer.from(JSON.stringify({ jsonrpc: '2.0', ...message }), 'utf8');
    this.child.stdin.write(`Content-Length: ${body.length}\r\n\r\n`);
    this.child.stdin.write(body);
    return undefined;
  }

  end(reason) {
    const waiting = [...this.waiting.values()];
    this.waiting.clear();
    for (const { reject } of waiting) reject(new Error(reason));
  }
}

/** A server with the documents that are open. */
class Client {
  constructor(log) {
    this.log = log;
    this.found = vscode.languages.createDiagnosticCollection('cellc');
    this.connection = undefined;
    this.ready = Promise.resolve(false);
  }

  start() {
    const [command, ...args] = vscode.workspace.getConfiguration('cellc').get('command');
    const folder = (vscode.workspace.workspaceFolders || [])[0];
    const child = spawn(command, args, { cwd: folder && folder.uri.fsPath, stdio: ['pipe', 'pipe', 'pipe'] });
    const connection = new Connection(child, (method, params) => this.receive(method, params));
    this.connection = connection;
    child.stderr.on('data', (data) => this.log.append(String(data)));
    child.on('error', (problem) => this.ended(connection, `\`${command}\` cannot be started: ${problem.message}`));
    child.on('exit', (code) => this.ended(connection, `\`${command}\` ended with ${code}`));
    this.ready = this.greet(connection, folder).then(() => true, () => false);
    return this.ready;
  }

  async greet(connection, folder) {
    const root = folder ? folder.uri.toString() : null;
    await connection.request('initialize', { processId: process.pid, rootUri: root, capabilities: CAPABILITIES });
    connection.notify('initialized', {});
    for (const document of vscode.workspace.textDocuments) this.opened(document, connection);
  }

  ended(connection, reason) {
    connection.end(reason);
    if (this.connection !== connection) return; // it was stopped, or another one took its place
    this.connection = undefined;
    this.found.clear();
    this.log.appendLine(reason);
    const again = 'Restart';
    const answer = vscode.window.showErrorMessage(`cellc: ${reason}. Set cellc.command, or install cellc[lsp].`, again);
    Promise.resolve(answer).then((pressed) => pressed === again && this.start());
  }

  async stop() {
    const connection = this.connection;
    this.connection = undefined;
    this.found.clear();
    if (!connection) return;
    try {
      await connection.request('shutdown', null);
      connection.notify('exit', null);
    } catch {
      connection.child.kill();
    }
  }

  receive(method, params) {
    if (method === 'textDocument/publishDiagnostics') {
      this.found.set(vscode.Uri.parse(params.uri), params.diagnostics.map(diagnosticOf));
    } else if (method === 'window/showMessage') {
      vscode.window.showInformationMessage(`cellc: ${params.message}`);
    } else if (!SILENT[method]) {
      this.log.appendLine(method);
    }
  }

  opened(document, connection = this.connection) {
    if (!isOurs(document) || !connection) return;
    const { version } = document;
    const item = { uri: document.uri.toString(), languageId: 'yaml', version, text: document.getText() };
    connection.notify('textDocument/didOpen', { textDocument: item });
  }

  tell(method, document, more = {}) {
    if (!isOurs(document) || !this.connection) return;
    const textDocument = { uri: document.uri.toString(), version: document.version };
    this.connection.notify(method, { textDocument, ...more });
  }

  /** Ask of a document; null where no server runs. */
  async ask(method, document, more, token) {
    if (!(await this.ready) || !this.connection) return null;
    const params = { textDocument: { uri: document.uri.toString() }, ...more };
    return this.connection.request(`textDocument/${method}`, params, token);
  }
}

const isOurs = (document) => document.languageId === 'yaml' && document.uri.scheme === 'file';

// From the protocol to the editor. Both count lines and UTF-16 units from 0.
const rangeOf = ({ start, end }) => new vscode.Range(start.line, start.character, end.line, end.character);
const locationOf = ({ uri, range }) => new vscode.Location(vscode.Uri.parse(uri), rangeOf(range));
const editOf = ({ range, newText }) => new vscode.TextEdit(rangeOf(range), newText);
const markdownOf = (content) => new vscode.MarkdownString(typeof content === 'string' ? content : content.value);

function diagnosticOf(answer) {
  const found = new vscode.Diagnostic(rangeOf(answer.range), answer.message, answer.severity - 1);
  found.code = answer.code;
  found.source = answer.source;
  found.relatedInformation = (answer.relatedInformation || []).map(
    ({ location, message }) => new vscode.DiagnosticRelatedInformation(locationOf(location), message),
  );
  return found;
}

function itemOf(answer) {
  const item = new vscode.CompletionItem(answer.label, answer.kind - 1);
  item.detail = answer.detail;
  item.sortText = answer.sortText;
  item.filterText = answer.filterText;
  if (answer.documentation) item.documentation = markdownOf(answer.documentation);
  item.insertText = answer.textEdit ? answer.textEdit.newText : answer.insertText || answer.label;
  if (answer.textEdit) item.range = rangeOf(answer.textEdit.range);
  return item;
}

function symbolOf(answer) {
  const place = rangeOf(answer.range);
  const symbol = new vscode.DocumentSymbol(answer.name, answer.detail || '', answer.kind - 1, place, rangeOf(answer.selectionRange));
  symbol.children = (answer.children || []).map(symbolOf);
  return symbol;
}

function workspaceEditOf(answer) {
  const edit = new vscode.WorkspaceEdit();
  const notes = answer.changeAnnotations || {};
  const changes = answer.documentChanges || Object.entries(answer.changes || {}).map(
    ([uri, edits]) => ({ textDocument: { uri }, edits }),
  );
  for (const { textDocument, edits } of changes) {
    const uri = vscode.Uri.parse(textDocument.uri);
    for (const { range, newText, annotationId } of edits) {
      edit.replace(uri, rangeOf(range), newText, annotationId === undefined ? undefined : notes[annotationId]);
    }
  }
  return edit;
}

function actionOf(answer, diagnostics) {
  const action = new vscode.CodeAction(answer.title, vscode.CodeActionKind.QuickFix);
  action.isPreferred = answer.isPreferred;
  action.edit = workspaceEditOf(answer.edit);
  action.diagnostics = diagnostics.filter(
    (found) => (answer.diagnostics || []).some((one) => one.code === found.code && rangeOf(one.range).isEqual(found.range)),
  );
  return action;
}

// From the editor to the protocol.
const placeOf = ({ line, character }) => ({ position: { line, character } });
const plainRange = ({ start, end }) => ({
  start: { line: start.line, character: start.character },
  end: { line: end.line, character: end.character },
});
const plainDiagnostic = ({ range, message, severity, code, source }) => ({
  range: plainRange(range), message, severity: severity + 1, code, source,
});

function providers(client) {
  const { languages } = vscode;
  const all = (answers, of) => (answers || []).map(of);
  return [
    languages.registerHoverProvider(SELECTOR, {
      async provideHover(document, position, token) {
        const answer = await client.ask('hover', document, placeOf(position), token);
        return answer && new vscode.Hover(markdownOf(answer.contents), answer.range && rangeOf(answer.range));
      },
    }),
    languages.registerCompletionItemProvider(SELECTOR, {
      provideCompletionItems: async (document, position, token) =>
        all(await client.ask('completion', document, placeOf(position), token), itemOf),
    }, ':', ' ', '{', '[', '/'),
    languages.registerDefinitionProvider(SELECTOR, {
      async provideDefinition(document, position, token) {
        const answer = await client.ask('definition', document, placeOf(position), token);
        return answer && locationOf(answer);
      },
    }),
    languages.registerReferenceProvider(SELECTOR, {
      async provideReferences(document, position, context, token) {
        const more = { ...placeOf(position), context: { includeDeclaration: context.includeDeclaration } };
        return all(await client.ask('references', document, more, token), locationOf);
      },
    }),
    languages.registerRenameProvider(SELECTOR, {
      async prepareRename(document, position, token) {
        const answer = await client.ask('prepareRename', document, placeOf(position), token);
        return answer && { range: rangeOf(answer.range), placeholder: answer.placeholder };
      },
      async provideRenameEdits(document, position, newName, token) {
        const answer = await client.ask('rename', document, { ...placeOf(position), newName }, token);
        return answer && workspaceEditOf(answer);
      },
    }),
    languages.registerCodeActionsProvider(SELECTOR, {
      async provideCodeActions(document, range, context, token) {
        const diagnostics = context.diagnostics.filter((found) => found.source === 'cellc');
        const asked = { range: plainRange(range), context: { diagnostics: diagnostics.map(plainDiagnostic) } };
        return all(await client.ask('codeAction', document, asked, token), (answer) => actionOf(answer, diagnostics));
      },
    }, { providedCodeActionKinds: [vscode.CodeActionKind.QuickFix] }),
    languages.registerDocumentSymbolProvider(SELECTOR, {
      provideDocumentSymbols: async (document, token) =>
        all(await client.ask('documentSymbol', document, {}, token), symbolOf),
    }),
    languages.registerDocumentFormattingEditProvider(SELECTOR, {
      provideDocumentFormattingEdits: async (document, options, token) =>
        all(await client.ask('formatting', document, { options }, token), editOf),
    }),
  ];
}

let running;

async function activate(context) {
  const log = vscode.window.createOutputChannel('cellc');
  const client = new Client(log);
  running = client;
  const { workspace } = vscode;
  context.subscriptions.push(
    log,
    client.found,
    ...providers(client),
    workspace.onDidOpenTextDocument((document) => client.opened(document)),
    workspace.onDidChangeTextDocument(({ document }) =>
      client.tell('textDocument/didChange', document, { contentChanges: [{ text: document.getText() }] })),
    workspace.onDidSaveTextDocument((document) => client.tell('textDocument/didSave', document)),
    workspace.onDidCloseTextDocument((document) => client.tell('textDocument/didClose', document)),
    vscode.commands.registerCommand('cellc.restart', () => client.stop().then(() => client.start())),
  );
  await client.start();
}

function deactivate() {
  return running ? running.stop() : undefined;
}

module.exports = { activate, deactivate };
