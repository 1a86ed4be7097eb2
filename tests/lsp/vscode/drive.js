'use strict';
// Drives the extension as VS Code does, with the real server behind it; what it shows goes to standard output as JSON.
const fs = require('fs');
const Module = require('module');
const { vscode, registered, heard, found, messages, settings, TextDocument } = require('./stub.js');

const load = Module._load;
Module._load = (name, ...more) => (name === 'vscode' ? vscode : load(name, ...more));
const extension = require(process.env.CELLC_EXTENSION);
const never = { onCancellationRequested() {} };

/** The next findings of a document that hold a code, or no code where none is given. */
function findings(document, code) {
  const uri = document.uri.toString();
  const fits = () => found[uri] && (code === undefined || found[uri].some((one) => one.code === code));
  return new Promise((resolve) => {
    heard.found = () => fits() && resolve(found[uri]);
  });
}

async function main() {
  const file = process.argv[2];
  const right = fs.readFileSync(file, 'utf8');
  const document = new TextDocument(file, right);
  const context = { subscriptions: [] };
  const shown = {};
  const first = findings(document);
  await extension.activate(context);
  shown.subscriptions = context.subscriptions.length;
  shown.first = await first;
  const ask = (name, method, ...more) => registered[name].provider[method](document, ...more, never);

  shown.hover = await ask('hover', 'provideHover', document.at('0.01', ' rad'));
  shown.definition = await ask('definition', 'provideDefinition', document.at('device: ar', 'm'));
  shown.references = await ask('references', 'provideReferences', document.at('device: ar', 'm'), { includeDeclaration: true });
  shown.prepared = await ask('rename', 'prepareRename', document.at('device: ar', 'm'));
  shown.renamed = (await ask('rename', 'provideRenameEdits', document.at('device: ar', 'm'), 'robot')).edits;
  shown.refused = await ask('rename', 'provideRenameEdits', document.at('device: ar', 'm'), 'gripper').catch((problem) => problem.message);
  shown.nothing = await ask('rename', 'prepareRename', document.at('mod', 'el:')).catch((problem) => problem.message);
  shown.symbols = await ask('symbols', 'provideDocumentSymbols');

  const wrong = right.replace('device: arm', 'device: amr');
  const told = findings(document, 'unknown-device');
  document.change(wrong);
  const diagnostics = await told;
  const unknown = diagnostics.find((one) => one.code === 'unknown-device');
  shown.wrong = unknown;
  shown.actions = await ask('actions', 'provideCodeActions', unknown.range, { diagnostics: [unknown] });

  document.change(right.replace('parent: arm/tool0', 'parent: arm/'));
  shown.completion = await ask('completion', 'provideCompletionItems', document.at('parent: arm/'));
  document.change(right.replace('device: arm', 'device:   arm'));
  shown.formatted = await ask('formatting', 'provideDocumentFormattingEdits', { tabSize: 2, insertSpaces: true });

  await registered['cellc.restart']();
  document.change(right);
  shown.restarted = (await findings(document)).length;
  shown.stderr = messages.splice(0);
  await extension.deactivate();
  settings['cellc.command'] = ['cellc-that-is-not-there'];
  await registered['cellc.restart']();
  shown.missing = messages.splice(0);
  process.stdout.write(JSON.stringify(shown));
}

main().catch((problem) => {
  process.stderr.write(`${problem.stack}\n`);
  process.exitCode = 1;
});
