// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// An application with the README's code for three.js, bundled by Vite: the bundle finds its worker and its WebAssembly.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { build } from 'vite';
import { ENGINES, LIBRARY } from '../support/paths.mjs';
import { convert, readSample } from '../support/program.mjs';
import { snippetOf } from '../support/readme.mjs';
import { launchBrowser, openPage } from './support/browser.mjs';
import { startServer } from './support/server.mjs';

const APPLICATION = {
  'index.html': '<!doctype html><script type="module" src="./main.js"></script>',
  'main.js': "import './scene.js'; import './snippet.js'; globalThis.isLoaded = true;",
  'scene.js': "import { Scene } from 'three'; globalThis.scene = new Scene();",
};

async function bundle(folder) {
  for (const [name, text] of Object.entries({ ...APPLICATION, 'snippet.js': await snippetOf('three.js') })) {
    writeFileSync(path.join(folder, name), text);
  }
  const alias = [
    { find: /^gltf-mcc\/(.*)$/, replacement: path.join(LIBRARY, '$1.mjs') },
    { find: /^three\/addons\//, replacement: path.join(ENGINES, 'three/examples/jsm/') },
    { find: /^three$/, replacement: path.join(ENGINES, 'three/build/three.module.js') },
  ];
  const options = { target: 'es2022', chunkSizeWarningLimit: 2000 };
  await build({ root: folder, base: '/bundle/', logLevel: 'warn', resolve: { alias }, build: options });
  const output = path.join(folder, 'dist');
  writeFileSync(path.join(output, 'model.glb'), convert(readSample('torus')));
  return output;
}

test('a bundle loads models, in workers, under a Content-Security-Policy', async (context) => {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'gltf-mcc-'));
  context.after(() => rmSync(folder, { recursive: true }));
  const server = await startServer(new Map(), await bundle(folder));
  context.after(() => server.close());
  const browser = await launchBrowser();
  context.after(() => browser.close());

  const { page, violations } = await openPage(browser, `${server.origin}/bundle/index.html`, () => globalThis.isLoaded);
  const counts = await page.evaluate(() => (
    globalThis.scene.getObjectsByProperty('isMesh', true).map(({ geometry }) => geometry.index.count)));
  assert.deepEqual(counts, [3 * 4096]);
  assert.ok(page.workers().length > 0);
  assert.deepEqual([violations(), server.missing], [[], []]);
});
