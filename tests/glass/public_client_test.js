#!/usr/bin/env node
// The client of the Debug Adapter Protocol that editors' own adapters are tested with (npm:
// @vscode/debugadapter-testsupport, looked for where NODE_PATH says) debugs a compute program and vkcube.
//
// usage: public_client_test.js VITRINE APPLICATION
//
// Exit status 77: the client is not installed.
'use strict';
const assert = require('assert');
const { spawn, spawnSync } = require('child_process');
const path = require('path');

let DebugClient;
try {
  ({ DebugClient } = require('@vscode/debugadapter-testsupport'));
} catch {
  console.log('the client is not installed (npm: @vscode/debugadapter-testsupport)');
  process.exit(77);
}

const [vitrine, application] = process.argv.slice(2);
const SHADER = path.resolve(__dirname, 'app/fill.comp');  // which the application names relative to the tree
const PATIENCE = 120000;  // milliseconds for one answer

/// Serves the program, calls test(client) once connected, and returns the server's exit status.
async function serve(command, test) {
  const server = spawn(command[0], command.slice(1), { stdio: ['ignore', 'pipe', 'pipe'], detached: true });
  const ended = new Promise((resolve) => server.on('exit', resolve));
  let port;
  try {
    port = await new Promise((resolve, reject) => {
      let text = '';
      const hear = (data) => {
        text += data;
        const found = /:(\d+)\s/.exec(text);
        if (found) resolve(Number(found[1]));
      };
      server.stderr.on('data', hear);
      server.stdout.on('data', hear);  // where xvfb-run has it
      ended.then(() => reject(new Error(`no port: ${text}`)));
    });
    const client = new DebugClient('node', 'no adapter of its own', 'vitrine');
    await client.start(port);
    client.defaultTimeout = PATIENCE;
    await test(client);
    return await ended;
  } finally {
    if (server.exitCode === null) process.kill(-server.pid);  // what it has started, too
  }
}

async function top(client, threadId) {
  const { body } = await client.stackTraceRequest({ threadId });
  return body.stackFrames[0];
}

async function move(client, request, threadId) {
  const [, stopped] = await Promise.all([client[request]({ threadId }), client.waitForEvent('stopped')]);
  return stopped.body;
}

/// Values by name.
async function variables(client, frameId) {
  const { body } = await client.scopesRequest({ frameId });
  const values = new Map();
  for (const scope of body.scopes) {
    const answer = await client.variablesRequest({ variablesReference: scope.variablesReference });
    for (const row of answer.body.variables) values.set(row.name, row.value);
  }
  return values;
}

/// Some lines forward and back: the same lines, and the same values.
async function walk(client, threadId) {
  const seen = [];
  for (let i = 0; i < 3; ++i) {
    const frame = await top(client, threadId);
    seen.push([frame.line, await variables(client, frame.id)]);
    await move(client, 'nextRequest', threadId);
  }
  for (const [line, values] of seen.reverse()) {
    await move(client, 'stepBackRequest', threadId);
    const frame = await top(client, threadId);
    assert.strictEqual(frame.line, line);
    assert.deepStrictEqual(await variables(client, frame.id), values);
  }
}

async function finish(client, request) {
  const over = Promise.all([client.waitForEvent('exited'), client.waitForEvent('terminated')]);
  await request();
  const [exited] = await over;
  assert.strictEqual(exited.body.exitCode, 0);
  await client.stop();
}

async function compute(client) {
  // The client's own checks: initialize, breakpoints, launch, configurationDone, the stop's reason and place.
  const changed = client.waitForEvent('breakpoint');
  await client.hitBreakpoint({ program: application }, { path: SHADER, line: 12, verified: false });
  assert.strictEqual((await changed).body.breakpoint.verified, true);
  const threads = (await client.threadsRequest()).body.threads;
  assert.strictEqual(threads.length, 16);

  const conditional = [{ line: 8, condition: 'i == 5' }];
  const set = await client.setBreakpointsRequest({ source: { path: SHADER }, breakpoints: conditional });
  assert.deepStrictEqual(set.body.breakpoints.map((breakpoint) => breakpoint.verified), [true]);
  const { reason, threadId } = await move(client, 'continueRequest', threads[0].id);
  assert.deepStrictEqual([reason, threadId], ['breakpoint', threads[5].id]);
  const frames = (await client.stackTraceRequest({ threadId })).body.stackFrames;
  assert.deepStrictEqual(frames.map((frame) => [frame.name, frame.line]), [['put', 8], ['main', 14]]);
  assert.strictEqual((await variables(client, frames[0].id)).get('i'), '5');
  const { body } = await client.evaluateRequest({ expression: 'i + 37u', frameId: frames[0].id });
  assert.strictEqual(body.result, '42');
  await assert.rejects(client.evaluateRequest({ expression: 'nobody', frameId: frames[0].id }));
  await move(client, 'stepBackRequest', threadId);
  assert.strictEqual((await top(client, threadId)).line, 14);
  await move(client, 'stepInRequest', threadId);
  assert.strictEqual((await top(client, threadId)).line, 8);
  await client.setBreakpointsRequest({ source: { path: SHADER }, breakpoints: [] });
  await finish(client, () => client.continueRequest({ threadId }));
}

async function cube(client) {
  assert.ok((await client.initializeRequest()).body.supportsStepBack);
  await client.setFunctionBreakpointsRequest({ breakpoints: [{ name: 'main' }] });
  const first = client.waitForEvent('stopped');
  await client.launchRequest({});
  await client.configurationDoneRequest();
  let stop = (await first).body;
  assert.match(stop.text, /vertex/);
  await walk(client, stop.threadId);
  for (let i = 0; i < 100 && !stop.text.includes('pixel ('); ++i)
    stop = await move(client, 'continueRequest', stop.threadId);
  assert.match(stop.text, /pixel \(/);
  await walk(client, stop.threadId);
  await client.setFunctionBreakpointsRequest({ breakpoints: [] });
  await finish(client, () => client.continueRequest({ threadId: stop.threadId }));
}

const installed = (name) => spawnSync('which', [name]).status === 0;

async function main() {
  const debug = [vitrine, 'debug', '--dap', '0', '--'];
  assert.strictEqual(await serve([...debug, application], compute), 0);
  console.log('a compute program: debugged to its end');
  if (!['xvfb-run', 'vkcube'].every(installed)) return console.log('xvfb-run or vkcube is not installed');
  assert.strictEqual(await serve(['xvfb-run', '-a', ...debug, 'vkcube', '--c', '5'], cube), 0);
  console.log('vkcube: debugged to its end');
}

process.exitCode = 1;  // an answer that never comes ends node with nothing to wait for
main().then(() => { process.exitCode = 0; }, (error) => console.error(error));
