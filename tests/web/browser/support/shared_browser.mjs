// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// node shared_browser.mjs begin FILE: starts a browser that stays when this program ends, and writes into the file where it can be reached;
// launchBrowser() connects to it when MCC_BROWSER names the file. node shared_browser.mjs end FILE: ends it.
import { spawn } from 'node:child_process';
import { existsSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { setTimeout } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { LAUNCH_OPTIONS } from './browser.mjs';

/** A browser that nobody has ended goes by itself, since those who use it may have been killed. */
const LIFE_MS = 30 * 60_000;

const [, , action, file] = process.argv;
if (action === 'begin') await begin();
else if (action === 'serve') await serve();
else if (action === 'end') rmSync(file);
else throw new Error('usage: shared_browser.mjs begin|end FILE');

async function begin() {
  rmSync(file, { force: true }); // of a run that was killed
  spawn(process.execPath, [fileURLToPath(import.meta.url), 'serve', file], { detached: true, stdio: 'ignore' }).unref();
  for (let waitedMs = 0; !existsSync(file); waitedMs += 50) {
    if (waitedMs > 50_000) throw new Error('the browser did not start; install chromium or name it in MCC_CHROMIUM');
    await setTimeout(50);
  }
}

/** Until the file is removed. */
async function serve() {
  const server = await chromium.launchServer(LAUNCH_OPTIONS);
  writeFileSync(`${file}.new`, JSON.stringify({ endpoint: server.wsEndpoint() }));
  renameSync(`${file}.new`, file);
  const beginMs = Date.now();
  while (existsSync(file) && Date.now() - beginMs < LIFE_MS) await setTimeout(200);
  await server.close();
  process.exit();
}
